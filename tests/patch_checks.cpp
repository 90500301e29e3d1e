// SPDX-License-Identifier: BSD-3-Clause
#include "tests/patch_checks.h"

#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/oracle/limit.h"
#include "tests/oracle/subdivide.h"

namespace patches {

using namespace lcl;

Surface::Surface(const shapes::Shape& shape_, const SchemeOptions& options_)
    : shape(shape_),
      options(options_),
      topology(build_topology(shape.mesh)),
      features(find_features(shape.mesh, topology, shape.features)),
      table(build_patch_table(topology, features, options)),
      control_(control_points(table, shape.mesh.positions, 3)) {}

PatchPlace Surface::locate(const At& at) const {
    const double uv[2] = {at.u, at.v};
    PatchPlace place;
    lcl::locate(table, {1, &at.face, &at.corner, uv}, 0, 1, &place);
    return place;
}

Jet Surface::jet(const At& at) const {
    const SurfaceJet found = reference_jet(table, control_, locate(at));
    Jet jet;
    for (int row = 0; row < 6; ++row) jet.row(row) << found[row][0], found[row][1], found[row][2];
    return jet;
}

void check_limits(const Surface& surface, int levels) {
    for (int level = 0; level <= levels; ++level) {
        std::vector<SurfaceLocation> locations;
        const Refinement refined = refine(surface.shape.mesh, surface.shape.features, surface.options, level, &locations);
        const oracle::Surface fine = oracle::make_surface(refined.mesh, refined.features);
        const SchemeOptions options = level == 0 ? surface.options : oracle::after_first_step(surface.options);
        const Eigen::MatrixXd points = oracle::positions(refined.mesh);
        for (Index v = 0; v < refined.mesh.vertex_count; ++v) {
            const SurfaceLocation& at = locations[v];
            if (at.face < 0) continue;
            const Eigen::RowVector3d limit = oracle::limit_row(fine, options, v) * points;
            const Eigen::RowVector3d found = surface.jet({at.face, at.corner, at.u, at.v}).row(0);
            if ((limit - found).norm() < 1e-13) continue;
            CAPTURE(surface.shape.name, level, v, at.face, at.corner, at.u, at.v, limit);
            REQUIRE(found == limit);
        }
    }
}

void check_derivatives(const Surface& surface, const At& at, double reach) {
    const Jet jet = surface.jet(at);
    const auto point = [&](double x, double y) -> Eigen::RowVector3d { return surface.jet({at.face, at.corner, at.u + x * reach, at.v + y * reach}).row(0); };
    // Central differences of second order at steps h and h/2, extrapolated: exact for polynomials of degree 4 in the first derivatives and of degree 5 in the
    // second ones, so on a regular patch or inside a cell only rounding is left.
    const auto richardson = [](const Eigen::RowVector3d& wide, const Eigen::RowVector3d& narrow) -> Eigen::RowVector3d { return (4 * narrow - wide) / 3; };
    const auto first = [&](double x, double y, double h) -> Eigen::RowVector3d { return (point(h * x, h * y) - point(-h * x, -h * y)) / (2 * h * reach); };
    const auto second = [&](double x, double y, double h) -> Eigen::RowVector3d {
        return (point(h * x, h * y) - 2 * point(0, 0) + point(-h * x, -h * y)) / (h * h * reach * reach);
    };
    const Eigen::RowVector3d u = richardson(first(1, 0, 1), first(1, 0, 0.5)), v = richardson(first(0, 1, 1), first(0, 1, 0.5));
    const Eigen::RowVector3d uu = richardson(second(1, 0, 1), second(1, 0, 0.5)), vv = richardson(second(0, 1, 1), second(0, 1, 0.5));
    const Eigen::RowVector3d both = richardson(second(1, 1, 1), second(1, 1, 0.5));
    CAPTURE(surface.shape.name, at.face, at.corner, at.u, at.v, reach, jet);

    REQUIRE((u - jet.row(1)).norm() < 1e-13 / reach);
    REQUIRE((v - jet.row(2)).norm() < 1e-13 / reach);
    REQUIRE((uu - jet.row(3)).norm() < 1e-13 / (reach * reach));
    REQUIRE((vv - jet.row(5)).norm() < 1e-13 / (reach * reach));
    REQUIRE((both - jet.row(3) - 2 * jet.row(4) - jet.row(5)).norm() < 2e-13 / (reach * reach));
}

void check_table(const PatchTable& table) {
    REQUIRE(table.kind.size() == static_cast<std::size_t>(table.patch_count()));
    std::vector<int> uses(table.kinds.size(), 0);
    bool fits = true;
    for (Index patch = 0; patch < table.patch_count(); ++patch) {
        const std::int32_t kind = table.kind[patch];
        if (kind >= 0) ++uses[kind];
        fits &= (table.patch_begin[patch + 1] - table.patch_begin[patch] == (kind < 0 ? regular_point_count(table.scheme) : table.kinds[kind].point_count));
    }
    REQUIRE(fits);
    REQUIRE(std::count(uses.begin(), uses.end(), 0) == 0);
    REQUIRE(table.control.size() == static_cast<std::size_t>(table.patch_begin.back()));
    const auto are_below = [](const auto& points, Index count) {
        return std::all_of(points.begin(), points.end(), [&](Index point) { return point >= 0 && point < count; });
    };
    REQUIRE(are_below(table.control, table.control_count()));
    REQUIRE(are_below(table.ghosts.indices, table.refined_count()));
    for (const PatchKind& kind : table.kinds) {
        REQUIRE((kind.step.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-15 * kind.point_count);
        for (const Eigen::MatrixXd& cell : kind.cells) REQUIRE((cell.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-15 * kind.point_count);
    }
}

Jet turned(const Jet& jet, double ua, double ub, double va, double vb) {
    Jet out;
    out.row(0) = jet.row(0);
    out.row(1) = ua * jet.row(1) + va * jet.row(2);
    out.row(2) = ub * jet.row(1) + vb * jet.row(2);
    out.row(3) = ua * ua * jet.row(3) + 2 * ua * va * jet.row(4) + va * va * jet.row(5);
    out.row(4) = ua * ub * jet.row(3) + (ua * vb + ub * va) * jet.row(4) + va * vb * jet.row(5);
    out.row(5) = ub * ub * jet.row(3) + 2 * ub * vb * jet.row(4) + vb * vb * jet.row(5);
    return out;
}

bool is_same(const Jet& a, const Jet& b, double distance) {
    const Eigen::VectorXd difference = (a - b).rowwise().norm(), size = a.rowwise().norm();
    const double first = size.segment(1, 2).maxCoeff(), second = size.segment(3, 3).maxCoeff();
    return difference[0] < 1e-14 && difference.segment(1, 2).maxCoeff() < 1e-12 * (1 + first) &&
           difference.segment(3, 3).maxCoeff() < 1e-12 * (1 + second) + 1e-14 * first / distance;
}

}  // namespace patches
