// SPDX-License-Identifier: BSD-3-Clause
// Rows of patches against plain evaluation, in regular patches and in one patch of every kind that a shape has.
#include <algorithm>
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "host/error.h"
#include "host/evaluate/patch_rows.h"
#include "host/evaluate/reference.h"
#include "tests/patch_checks.h"
#include "tests/solver_support.h"

using namespace lcl;

namespace {

class RowsCheck {
public:
    RowsCheck(const shapes::Shape& shape, const SchemeOptions& options)
        : table_(make_table(shape, options)), rows_(table_), control_(control_points(table_, shapes::rough(shape, 0.1, 2).mesh.positions, 3)) {}

    void check() {
        std::vector<Index> patches;
        for (std::size_t kind = 0; kind < table_.kinds.size(); ++kind)
            patches.push_back(static_cast<Index>(std::find(table_.kind.begin(), table_.kind.end(), static_cast<std::int32_t>(kind)) - table_.kind.begin()));
        for (int i = 0; i < 10; ++i) patches.push_back(random_.below(table_.patch_count()));
        for (const Index patch : patches) check_patch(patch);
    }

private:
    static PatchTable make_table(const shapes::Shape& shape, const SchemeOptions& options) {
        const Topology topology = build_topology(shape.mesh);
        return build_patch_table(topology, find_features(shape.mesh, topology, shape.features), options);
    }

    void check_patch(Index patch) {
        double s = random_.next(), t = random_.next();
        if (table_.scheme == Scheme::loop && s + t > 1) s = 1 - s, t = 1 - t;
        const std::int32_t turn = random_.below(static_cast<int>(table_.turns.size()));
        for (const double size : {1.0, std::ldexp(1, -3), std::ldexp(1, -20), 0.0}) check_place({size * s, size * t, patch, turn});
        check_place({1, 0, patch, turn});
        check_place({0, 1, patch, turn});
    }

    /// Control points are within 2 of the origin. Weights of first derivatives by (u, v) add up to at most 8 in size (patches are a half or a quarter of a
    /// face), of second ones to 64. Towards an extraordinary point at distance r they grow like r^(-1/3) at most (2 lambda < 2^(1/3) for all valences), second
    /// ones like r^(-4/3). 300 roundings: sums of up to 70 products, twice (projection, cell).
    void check_place(const PatchPlace& place) const {
        const Index begin = table_.patch_begin[place.patch], K = rows_.point_count(place.patch);
        Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> rows(6, K);
        rows_.write(place, 6, rows.data());
        Eigen::Matrix<double, Eigen::Dynamic, 3> points(K, 3);
        for (Index i = 0; i < K; ++i) points.row(i) = Eigen::Map<const Eigen::RowVector3d>(&control_[3 * static_cast<std::size_t>(table_.control[begin + i])]);
        const Eigen::Matrix<double, 6, 3> values = rows * points;
        const SurfaceJet right = reference_jet(table_, control_, place);
        const bool is_irregular = table_.kind[place.patch] >= 0, is_tip = is_irregular && place.s == 0 && place.t == 0;
        const double ring = is_irregular && !is_tip ? std::cbrt(1 / std::max(place.s, place.t)) : 1;
        CAPTURE(place.patch, table_.kind[place.patch], place.s, place.t, place.turn);
        for (int q = 0; q < 6; ++q) {
            if (is_tip && q > 0) {
                REQUIRE(rows.row(q).array().isNaN().all());
                continue;
            }
            const double scale = 2 * (q == 0 ? 1 : q < 3 ? 8 : 64) * std::pow(ring, q == 0 ? 0 : q < 3 ? 1 : 4);
            CAPTURE(q);
            REQUIRE((values.row(q) - Eigen::RowVector3d(right[q][0], right[q][1], right[q][2])).norm() / scale <= std::ldexp(300, -53));
            REQUIRE(std::abs(rows.row(q).sum() - (q == 0 ? 1 : 0)) / scale <= std::ldexp(300, -53));
        }
        check_fewer(place, rows);
    }

    /// Fewer rows are the first ones of all.
    void check_fewer(const PatchPlace& place, const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>& rows) const {
        for (const int count : {1, 3}) {
            std::vector<double> fewer(count * rows.cols());
            rows_.write(place, count, fewer.data());
            const auto is_same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
            REQUIRE(std::equal(fewer.begin(), fewer.end(), rows.data(), is_same));
        }
    }

    PatchTable table_;
    PatchRows rows_;
    std::vector<double> control_;
    mutable shapes::Random random_{1};
};

}  // namespace

TEST_CASE("rows times control points are what plain evaluation gives", "[patch_rows]") {
    const auto options = GENERATE(solver_test::catmull_clark(), solver_test::catmull_clark(0.5), solver_test::loop(), solver_test::doo_sabin(),
                                  solver_test::doo_sabin(DooSabinMask::classic));
    std::vector<shapes::Shape> all = shapes::closed_shapes();
    for (const auto& more : {shapes::boundary_shapes(), shapes::feature_shapes()}) all.insert(all.end(), more.begin(), more.end());
    int checked = 0;
    for (const shapes::Shape& shape : all) {
        if (!solver_test::suits(shape, options)) continue;
        CAPTURE(shape.name, static_cast<int>(options.scheme));
        try {
            RowsCheck(shape, options).check();
            ++checked;
        } catch (const Unsupported&) {  // Doo-Sabin at a corner without sharp edges
        }
    }
    CHECK(checked > 10);
}
