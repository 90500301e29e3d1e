// SPDX-License-Identifier: BSD-3-Clause
// The self-test through the C API: what a person runs first on a new device must pass here and name what it did.
#include <set>

#include "host/selftest/selftest.h"
#include "tests/capi_support.h"
#include "tests/solver_support.h"

using namespace capi_test;

namespace {

struct Results {
    std::set<std::string> kernels;
    int count = 0, failed = 0;
    static void note(void* user, const char* kernel, const char* what, double difference, double tolerance, int32_t passed) {
        auto& own = *static_cast<Results*>(user);
        INFO(kernel << ", " << what);
        CHECK(what[0] != '\0');
        CHECK(difference >= 0);
        CHECK(tolerance > 0);
        CHECK((passed != 0) == (difference <= tolerance));
        own.kernels.insert(kernel);
        ++own.count;
        own.failed += !passed;
    }
};

}  // namespace

TEST_CASE("every kernel agrees with the plain host operator on every device", "[selftest][capi][device]") {
    for (int32_t i = 0; i < lcl_device_count(); ++i) {
        const Context context = open_context(std::to_string(i).c_str());
        Results results;
        succeed(lcl_context_selftest(context.get(), Results::note, &results));
        CHECK(results.failed == 0);
        CHECK(results.count > 20);
        for (const char* kernel : {"lcl_limit_points",
                                   "lcl_relax",
                                   "lcl_relax_three_term",
                                   "lcl_residual",
                                   "lcl_correct",
                                   "lcl_relax_phase",
                                   "lcl_relax_rows",
                                   "lcl_cg_apply",
                                   "lcl_cg_update",
                                   "lcl_cg_direction",
                                   "lcl_import_points",
                                   "lcl_export_points",
                                   "lcl_gather_rows",
                                   "lcl_scatter_rows",
                                   "lcl_noise",
                                   "lcl_series",
                                   "lcl_series_sums",
                                   "lcl_filter",
                                   "lcl_morph",
                                   "lcl_morph_blend",
                                   "lcl_morph_difference",
                                   "lcl_umbrella_repair",
                                   "lcl_umbrella_scale",
                                   "lcl_fair_laplacian",
                                   "lcl_fair_apply",
                                   "lcl_fair_update",
                                   "lcl_fair_turn",
                                   "lcl_limit_normals",
                                   "lcl_normals",
                                   "lcl_frames",
                                   "lcl_sector_normals",
                                   "lcl_sector_frames",
                                   "lcl_evaluate",
                                   "lcl_expand_cells",
                                   "lcl_refine_faces",
                                   "lcl_refine_edges",
                                   "lcl_refine_vertices",
                                   "lcl_refine_rows",
                                   "lcl_refine_loop_edges",
                                   "lcl_refine_loop_vertices"}) {
            INFO(kernel);
            CHECK(results.kernels.count(kernel) == 1);
        }
        CHECK(lcl_context_allocated_bytes(context.get()) == 0);
    }
}

TEST_CASE("the self-test needs no callback", "[selftest][capi][device]") {
    const Context context = open_context();
    succeed(lcl_context_selftest(context.get(), nullptr, nullptr));
}

TEST_CASE("the self-test passes on a device without double precision", "[selftest][device][pair]") {
    int count = 0;
    CHECK(run_selftest(solver_test::context_without_double(), [&](const lcl::SelftestResult& result) {
        INFO(result.kernel << ", " << result.what << ": " << result.difference << " of " << result.tolerance);
        CHECK(result.passed());
        ++count;
    }));
    CHECK(count > 20);
}
