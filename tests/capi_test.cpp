// SPDX-License-Identifier: BSD-3-Clause
// What holds for every function of the C API: versions, statuses and sentences, options structs of older and newer callers, lives of handles, threads,
// contexts.
#include <algorithm>
#include <cstddef>
#include <thread>
#include <utility>

#include "tests/capi_support.h"
#include "tests/device_support.h"

using namespace capi_test;

namespace {

/// A struct at the end of its memory, as a caller with an older, shorter header has it; what is behind its size must not change.
template <class Struct>
struct Prefix {
    alignas(Struct) unsigned char bytes[sizeof(Struct)];

    Prefix(const Struct& initial, std::size_t size) {
        std::memset(bytes, 0xA5, sizeof bytes);
        std::memcpy(bytes, &initial, size);
        const auto stated = static_cast<uint32_t>(size);
        std::memcpy(bytes, &stated, sizeof stated);
    }
    Struct* get() { return reinterpret_cast<Struct*>(bytes); }
    bool rest_is_untouched(std::size_t size) const {
        return std::all_of(bytes + size, bytes + sizeof bytes, [](unsigned char byte) { return byte == 0xA5; });
    }
};

/// The same struct with fields behind it that this library does not know.
template <class Struct>
struct Longer {
    Struct known;
    unsigned char unknown[64];

    explicit Longer(const Struct& initial) : known(initial) {
        known.struct_size = sizeof(Longer);
        std::memset(unknown, 0x5A, sizeof unknown);
    }
    bool unknown_is_untouched() const {
        return std::all_of(std::begin(unknown), std::end(unknown), [](unsigned char byte) { return byte == 0x5A; });
    }
};

struct Log {
    std::vector<std::pair<int, std::string>> messages;
    static void write(void* user, int32_t level, const char* message) { static_cast<Log*>(user)->messages.emplace_back(level, message); }
};

const shapes::Shape octahedron = shapes::octahedron();
const std::vector<double>& octahedron_points = octahedron.mesh.positions;

}  // namespace

TEST_CASE("the library's version is the header's", "[capi]") {
    CHECK(lcl_version() == LCL_VERSION_MAJOR * 10000 + LCL_VERSION_MINOR * 100 + LCL_VERSION_PATCH);
    const std::string expected = std::to_string(LCL_VERSION_MAJOR) + "." + std::to_string(LCL_VERSION_MINOR) + "." + std::to_string(LCL_VERSION_PATCH);
    CHECK(lcl_version_string() == expected);
    CHECK_THAT(lcl_build_string(), Catch::Matchers::Contains("compiler"));
}

TEST_CASE("every status has a name", "[capi]") {
#define NAMED(status) std::make_pair(status, #status)
    const auto [status, name] = GENERATE(values<std::pair<int, const char*>>(
        {NAMED(LCL_OK), NAMED(LCL_ERROR_INVALID_ARGUMENT), NAMED(LCL_ERROR_BAD_INPUT), NAMED(LCL_ERROR_UNSUPPORTED), NAMED(LCL_ERROR_FILE),
         NAMED(LCL_ERROR_WRITE), NAMED(LCL_ERROR_NO_DEVICE), NAMED(LCL_ERROR_MEMORY), NAMED(LCL_ERROR_CANCELLED), NAMED(LCL_ERROR_INTERNAL),
         NAMED(LCL_ERROR_SINGULAR), NAMED(LCL_ERROR_INDEFINITE), NAMED(LCL_ERROR_NOT_CONVERGED), NAMED(CL_OUT_OF_RESOURCES), NAMED(CL_INVALID_KERNEL_ARGS),
         NAMED(CL_DEVICE_NOT_FOUND)}));
#undef NAMED
    CHECK(std::string(lcl_status_string(status)) == name);
    CHECK(lcl_status_string(-123456) != nullptr);
    CHECK(lcl_status_string(7) != nullptr);
}

TEST_CASE("an options struct without a size is refused", "[capi]") {
    const Mesh mesh = make_mesh(octahedron);
    const Operator A = make_operator(octahedron);
    const MeshArrays arrays(octahedron.mesh);
    lcl_mesh_data data = arrays.data;
    lcl_context_options context_options = LCL_CONTEXT_OPTIONS_INIT;
    lcl_scheme_options scheme_options = LCL_SCHEME_OPTIONS_INIT;
    lcl_solve_options solve_options = LCL_SOLVE_OPTIONS_INIT;
    lcl_refine_options refine_options = LCL_REFINE_OPTIONS_INIT;
    lcl_features features = LCL_FEATURES_INIT;
    data.struct_size = context_options.struct_size = scheme_options.struct_size = solve_options.struct_size = refine_options.struct_size =
        features.struct_size = 0;
    lcl_mesh made = nullptr;
    lcl_context context = nullptr;
    lcl_operator B = nullptr;
    double P[18];
    const auto expect = [](lcl_status status) { refuse(status, LCL_ERROR_INVALID_ARGUMENT, "struct_size is not set"); };
    expect(lcl_mesh_create(&data, &made));
    expect(lcl_context_create(&context_options, &context));
    expect(lcl_operator_create(default_context(), mesh.get(), &scheme_options, &B));
    expect(lcl_interpolate(A.get(), octahedron_points.data(), 0, 3, &solve_options, P, 0, nullptr));
    expect(lcl_mesh_refine(mesh.get(), nullptr, &refine_options, &made));
    expect(lcl_mesh_refine(mesh.get(), &scheme_options, nullptr, &made));
    expect(lcl_mesh_add_features(mesh.get(), &features));
}

TEST_CASE("a result struct without a size is refused before any work is done", "[capi]") {
    const Mesh mesh = make_mesh(octahedron);
    const Operator A = make_operator(octahedron);
    lcl_device_info device{};
    lcl_mesh_info info{};
    lcl_defect defect{};
    lcl_suitability suitability{};
    lcl_diagnosis diagnosis{};
    lcl_scheme_options scheme_options{};
    lcl_solve_report report{};
    const Mesh folded = make_mesh(shapes::zero_area_face());
    std::vector<double> P(18, 7.0);
    const auto expect = [](lcl_status status) { refuse(status, LCL_ERROR_INVALID_ARGUMENT, "struct_size is not set"); };
    expect(lcl_context_get_device(default_context(), &device));
    expect(lcl_device_get_info(0, &device));
    expect(lcl_mesh_get_info(mesh.get(), &info));
    expect(lcl_mesh_get_defect(folded.get(), 0, &defect));
    expect(lcl_mesh_check_scheme(mesh.get(), nullptr, &suitability));
    expect(lcl_operator_diagnose(A.get(), &diagnosis));
    expect(lcl_operator_get_scheme(A.get(), &scheme_options));
    expect(lcl_interpolate(A.get(), octahedron_points.data(), 0, 3, nullptr, P.data(), 0, &report));
    CHECK(P == std::vector<double>(18, 7.0));
}

TEST_CASE("options of an older caller end where its header ended, and the rest has defaults", "[capi]") {
    const Mesh mesh = make_mesh(shapes::cube());
    lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK, 0.5);
    options.lambda = 77;  // an error if it were read
    Prefix<lcl_scheme_options> older(options, offsetof(lcl_scheme_options, lambda));
    const Operator A = make_operator(default_context(), mesh.get(), older.get());
    lcl_scheme_options in_use = LCL_SCHEME_OPTIONS_INIT;
    succeed(lcl_operator_get_scheme(A.get(), &in_use));
    CHECK(in_use.alpha == 0.5);
    CHECK(in_use.lambda == 0);

    lcl_solve_options solve = LCL_SOLVE_OPTIONS_INIT;
    solve.solver = LCL_SOLVER_PIA;
    solve.max_iterations = 3;
    Prefix<lcl_solve_options> older_solve(solve, offsetof(lcl_solve_options, exact_sweeps));
    const Operator B = make_operator(shapes::icosphere(1));
    const std::vector<double> M = shapes::icosphere(1).mesh.positions;
    std::vector<double> P(M.size());
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    refuse(lcl_interpolate(B.get(), M.data(), 0, 3, older_solve.get(), P.data(), 0, &report), LCL_ERROR_NOT_CONVERGED, "after 3 iterations");
    CHECK(report.solver == LCL_SOLVER_PIA);
}

TEST_CASE("results are written as far as the caller's struct goes and not beyond", "[capi]") {
    const Mesh mesh = make_mesh(shapes::grid_quads(3, 2));
    SECTION("shorter: counts") {
        Prefix<lcl_mesh_info> older(LCL_MESH_INFO_INIT, offsetof(lcl_mesh_info, boundary_edges));
        succeed(lcl_mesh_get_info(mesh.get(), older.get()));
        CHECK(older.get()->struct_size == offsetof(lcl_mesh_info, boundary_edges));
        CHECK(older.get()->vertices == 12);
        CHECK(older.get()->edges == 17);
        CHECK(older.rest_is_untouched(offsetof(lcl_mesh_info, boundary_edges)));
    }
    SECTION("longer: counts") {
        Longer<lcl_mesh_info> newer(LCL_MESH_INFO_INIT);
        succeed(lcl_mesh_get_info(mesh.get(), &newer.known));
        CHECK(newer.known.struct_size == sizeof newer);
        CHECK(newer.known.boundary_edges == 10);
        CHECK(newer.unknown_is_untouched());
    }
    SECTION("shorter: the report of a solve, without the array of residuals") {
        const Operator A = make_operator(octahedron);
        std::vector<double> P(18);
        Prefix<lcl_solve_report> older(LCL_SOLVE_REPORT_INIT, offsetof(lcl_solve_report, residuals));
        succeed(lcl_interpolate(A.get(), octahedron_points.data(), 0, 3, nullptr, P.data(), 0, older.get()));
        CHECK(older.get()->converged == 1);
        CHECK(older.get()->iterations > 0);
        CHECK(older.rest_is_untouched(offsetof(lcl_solve_report, residuals)));
    }
    SECTION("longer: the report and the options of a solve") {
        const Operator A = make_operator(octahedron);
        std::vector<double> P(18);
        Longer<lcl_solve_report> report(LCL_SOLVE_REPORT_INIT);
        Longer<lcl_solve_options> options(LCL_SOLVE_OPTIONS_INIT);
        succeed(lcl_interpolate(A.get(), octahedron_points.data(), 0, 3, &options.known, P.data(), 0, &report.known));
        CHECK(report.known.converged == 1);
        CHECK(report.unknown_is_untouched());
    }
    SECTION("shorter: a device") {
        Prefix<lcl_device_info> older(LCL_DEVICE_INFO_INIT, offsetof(lcl_device_info, version));
        succeed(lcl_context_get_device(default_context(), older.get()));
        CHECK(older.get()->name[0] != '\0');
        CHECK(older.rest_is_untouched(offsetof(lcl_device_info, version)));
    }
}

TEST_CASE("handles may be released in any order", "[capi][field]") {
    Context context = open_context();
    Mesh mesh = make_mesh(octahedron);
    Operator A = make_operator(context.get(), mesh.get());
    FieldHandle x = make_field(A.get(), octahedron_points), y = make_field(A.get());
    SECTION("the operator outlives mesh and context, a field all three") {
        mesh.reset();
        context.reset();
        CHECK(lcl_operator_vertex_count(A.get()) == 6);
        succeed(lcl_operator_apply(A.get(), x.get(), y.get()));
        A.reset();
        x.reset();
        const double alpha_4 = 24.0 / 55.0;  // Loop PIA paper; the neighbours of an octahedron's vertex add up to zero
        std::vector<double> expected = octahedron_points;
        for (double& value : expected) value *= alpha_4;
        CHECK(largest_difference(download(y.get(), 6), expected) <= 1e-15);
    }
    SECTION("a handle lives as long as one reference") {
        lcl_operator_retain(A.get());
        lcl_operator_retain(A.get());
        lcl_operator_release(A.get());
        lcl_operator_release(A.get());
        CHECK(lcl_operator_row_count(A.get()) == 6);
        lcl_field_retain(x.get());
        lcl_field_release(x.get());
        CHECK(download(x.get(), 6) == octahedron_points);
        lcl_mesh_retain(mesh.get());
        lcl_mesh_release(mesh.get());
        CHECK(lcl_mesh_face_count(mesh.get()) == 8);
        lcl_context_retain(context.get());
        lcl_context_release(context.get());
        succeed(lcl_context_finish(context.get()));
    }
}

TEST_CASE("what is released gives all device memory back", "[capi][field]") {
    const Context context = open_context();
    CHECK(lcl_context_allocated_bytes(context.get()) == 0);
    {
        const shapes::Shape shape = shapes::torus_quads(9, 7);
        const Operator A = make_operator(context.get(), make_mesh(shape).get());
        const uint64_t of_operator = lcl_context_allocated_bytes(context.get());
        CHECK(of_operator > 0);
        {
            const FieldHandle field = make_field(A.get(), 3, LCL_PRECISION_DOUBLE);
            CHECK(lcl_context_allocated_bytes(context.get()) == of_operator + 63 * 4 * sizeof(double));  // rows of three channels have four components
        }
        CHECK(lcl_context_allocated_bytes(context.get()) == of_operator);
        std::vector<double> P(shape.mesh.positions.size());
        for (const lcl_solver solver : {LCL_SOLVER_AUTO, LCL_SOLVER_GS, LCL_SOLVER_GS_COLOURED, LCL_SOLVER_CG}) {
            lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
            options.solver = solver;
            options.certify = 1;
            succeed(lcl_interpolate(A.get(), shape.mesh.positions.data(), 0, 3, &options, P.data(), 0, nullptr));
        }
        const uint64_t after_once = lcl_context_allocated_bytes(context.get());
        succeed(lcl_interpolate(A.get(), shape.mesh.positions.data(), 0, 3, nullptr, P.data(), 0, nullptr));
        CHECK(lcl_context_allocated_bytes(context.get()) == after_once);  // a solve leaves nothing behind
    }
    succeed(lcl_context_finish(context.get()));
    CHECK(lcl_context_allocated_bytes(context.get()) == 0);
    CHECK(lcl_context_compile_seconds(context.get()) > 0);
}

TEST_CASE("each thread has its own last error", "[capi][thread]") {
    refuse(lcl_mesh_validate(nullptr), LCL_ERROR_INVALID_ARGUMENT, "mesh is NULL");
    std::string at_first = "unset", later;
    std::thread([&] {
        at_first = lcl_last_error();
        lcl_context_finish(nullptr);
        later = lcl_last_error();
    }).join();
    CHECK(at_first.empty());
    CHECK(later == "context is NULL");
    CHECK(std::string(lcl_last_error()) == "mesh is NULL");
    CHECK(lcl_version() > 0);
    succeed(lcl_mesh_validate(make_mesh(octahedron).get()));
    CHECK(std::string(lcl_last_error()) == "mesh is NULL");  // success leaves it
}

TEST_CASE("a failure without places clears those of the one before", "[capi]") {
    const Mesh bad = make_mesh(shapes::face_with_index_out_of_range());
    refuse(lcl_mesh_validate(bad.get()), LCL_ERROR_BAD_INPUT, "face 3 uses vertex 905");
    CHECK(last_error_faces() == std::vector<int32_t>{3});
    CHECK(last_error_vertices() == std::vector<int32_t>{905});
    int32_t untouched = 5;
    CHECK(lcl_last_error_faces(&untouched, 0) == 1);
    CHECK(untouched == 5);
    CHECK(lcl_last_error_vertices(nullptr, 10) == 1);
    CHECK(lcl_mesh_validate(nullptr) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_last_error_faces(nullptr, 0) == 0);
    CHECK(lcl_last_error_vertices(nullptr, 0) == 0);
}

TEST_CASE("every listed device opens by its index and tells the same of itself", "[capi][device]") {
    const int32_t count = lcl_device_count();
    REQUIRE(count >= 1);
    for (int32_t i = 0; i < count; ++i) {
        lcl_device_info listed = LCL_DEVICE_INFO_INIT, opened = LCL_DEVICE_INFO_INIT;
        succeed(lcl_device_get_info(i, &listed));
        const Context context = open_context(std::to_string(i).c_str());
        succeed(lcl_context_get_device(context.get(), &opened));
        CHECK(listed.index == i);
        CHECK(std::memcmp(&listed, &opened, sizeof listed) == 0);
        CHECK(listed.name[0] != '\0');
        CHECK(listed.compute_units > 0);
        CHECK(listed.memory_bytes >= listed.max_allocation_bytes);
    }
    lcl_device_info info = LCL_DEVICE_INFO_INIT;
    refuse(lcl_device_get_info(count, &info), LCL_ERROR_INVALID_ARGUMENT, "device index is " + std::to_string(count));
    refuse(lcl_device_get_info(-1, &info), LCL_ERROR_INVALID_ARGUMENT, "device index is -1");
}

TEST_CASE("a device that is not there is told with what there is and how to get one", "[capi][device]") {
    lcl_context_options options = LCL_CONTEXT_OPTIONS_INIT;
    lcl_context context = nullptr;
    options.device = "no such accelerator";
    refuse(lcl_context_create(&options, &context), LCL_ERROR_NO_DEVICE, "no OpenCL device answers to 'no such accelerator'");
    CHECK_THAT(lcl_last_error(), Catch::Matchers::Contains("0 = ") && Catch::Matchers::Contains("install"));
    options.device = "4711";
    refuse(lcl_context_create(&options, &context), LCL_ERROR_NO_DEVICE, "'4711'");
    options.device = nullptr;
    const device_test::Environment wish("LIMITCL_DEVICE", "nothing like it");
    refuse(lcl_context_create(&options, &context), LCL_ERROR_NO_DEVICE, "LIMITCL_DEVICE");
    CHECK(context == nullptr);
    options.device = "0";  // rules over the environment
    succeed(lcl_context_create(&options, &context));
    lcl_context_release(context);
}

TEST_CASE("the log gets messages up to its level", "[capi][device]") {
    Log log;
    lcl_context_options options = LCL_CONTEXT_OPTIONS_INIT;
    options.log = Log::write;
    options.log_user = &log;
    options.log_level = GENERATE(LCL_LOG_WARNING, LCL_LOG_INFO);
    lcl_context raw = nullptr;
    succeed(lcl_context_create(&options, &raw));
    const Context context(raw);
    lcl_device_info device = LCL_DEVICE_INFO_INIT;
    succeed(lcl_context_get_device(raw, &device));
    lcl_scheme_options automatic = scheme(LCL_SCHEME_CATMULL_CLARK);
    automatic.alpha_auto = 1;
    make_operator(raw, make_mesh(shapes::cube()).get(), &automatic);
    for (const auto& message : log.messages) CHECK(message.first <= options.log_level);
    REQUIRE(log.messages.size() == (options.log_level == LCL_LOG_WARNING ? 0 : 2));
    if (log.messages.empty()) return;
    CHECK_THAT(log.messages[0].second, Catch::Matchers::Contains(device.name));
    CHECK_THAT(log.messages[1].second, Catch::Matchers::Contains("alpha 0.5"));
}

TEST_CASE("two threads with a context each work at once, also on one mesh", "[capi][device][thread]") {
    const shapes::Shape shape = shapes::torus_quads(11, 8);
    const Mesh mesh = make_mesh(shape);
    const int32_t devices = lcl_device_count();
    std::vector<std::vector<double>> results(3, std::vector<double>(shape.mesh.positions.size()));
    std::vector<lcl_status> status(results.size(), -1);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < results.size(); ++i)
        threads.emplace_back([&, i] {
            lcl_context_options options = LCL_CONTEXT_OPTIONS_INIT;
            const std::string index = std::to_string(i % devices);
            options.device = index.c_str();
            lcl_context context = nullptr;
            lcl_operator A = nullptr;
            status[i] = lcl_context_create(&options, &context);
            if (status[i] == LCL_OK) status[i] = lcl_operator_create(context, mesh.get(), nullptr, &A);
            if (status[i] == LCL_OK) status[i] = lcl_interpolate(A, shape.mesh.positions.data(), 0, 3, nullptr, results[i].data(), 0, nullptr);
            lcl_operator_release(A);
            lcl_context_release(context);
        });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < results.size(); ++i) {
        CHECK(status[i] == LCL_OK);
        CHECK(results[i] == results[0]);  // devices of one kind, the same bits
    }
}
