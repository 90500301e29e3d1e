// SPDX-License-Identifier: BSD-3-Clause
// Loop patches: kinds, places, control points.
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "host/evaluate/loop_walk.h"
#include "tests/modes_support.h"
#include "tests/patch_checks.h"

using namespace lcl;
using patches::At;
using patches::Jet;
using patches::Surface;

namespace {

const double turn = 2 * std::acos(-1.0);

SchemeOptions loop() {
    SchemeOptions options;
    options.scheme = Scheme::loop;
    return options;
}

/// Vertices 0 and 1 are poles of valence n, 2 .. n + 1 lie between them.
shapes::Shape double_pyramid(int n) {
    std::vector<shapes::Point> points{{0, 0, 0.7}, {0, 0, -0.5}};
    std::vector<shapes::Face> faces;
    for (int i = 0; i < n; ++i) {
        points.push_back({std::cos(turn * i / n), std::sin(turn * i / n), 0.1 * std::cos(2.0 * i)});
        faces.push_back({0, 2 + i, 2 + (i + 1) % n});
        faces.push_back({1, 2 + (i + 1) % n, 2 + i});
    }
    return shapes::rough(shapes::make("double_pyramid_" + std::to_string(n), points, faces), 0.1, n);
}

/// Vertex 0 with k triangles, on the boundary, as are all others.
shapes::Shape fan(int k) {
    std::vector<shapes::Point> points{{0, 0, 0.2}};
    std::vector<shapes::Face> faces;
    for (int i = 0; i <= k; ++i) points.push_back({std::cos(turn * i / (k + 3)), std::sin(turn * i / (k + 3)), 0.1 * i});
    for (int i = 0; i < k; ++i) faces.push_back({0, 1 + i, 2 + i});
    return shapes::rough(shapes::make("fan_" + std::to_string(k), points, faces), 0.1, k);
}

/// Every way in which sharp features can lie round the poles of a double pyramid.
std::vector<shapes::Shape> with_sharp_poles(int n) {
    std::vector<shapes::Shape> all;
    const auto add = [&](const char* what, std::vector<std::array<Index, 2>> creases, std::vector<Index> corners) {
        all.push_back(double_pyramid(n));
        all.back().name += what;
        all.back().features.creases = std::move(creases);
        all.back().features.corners = std::move(corners);
    };
    add("_darts", {{0, 2}, {1, 3}}, {});
    add("_curves", {{0, 2}, {0, 4}, {1, 2}, {1, 3}}, {});
    add("_smooth_corner", {}, {0});
    add("_slit", {{0, 2}, {1, 4}}, {0, 1, 4});
    add("_corners", {{0, 2}, {0, 3}, {0, 4}}, {1});
    return all;
}

/// (u, v) by (x, y), x along the edge from corner k to the next one, y towards the third.
Jet jet_from_corner(const Surface& surface, Index face, int k, double x, double y) {
    switch (k) {
        case 0: return surface.jet({face, 0, x, y});
        case 1: return patches::turned(surface.jet({face, 0, 1 - x - y, x}), -1, -1, 1, 0);
        default: return patches::turned(surface.jet({face, 0, y, 1 - x - y}), 0, 1, -1, -1);
    }
}

/// Both sides of an edge agree: over smooth ones up to second derivatives, over sharp ones along the edge. The error of derivatives is that of positions times
/// the weights' size, which near a tip is that of 4^depth.
void check_continuity(const Surface& surface) {
    const Topology& topology = surface.topology;
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index h = topology.edge_half_edge[e], twin = topology.twin[h];
        if (twin < 0) continue;
        for (const double x : {0.03, 0.25, 0.4, 0.5, 0.8, 0.96875}) {
            const Jet here = jet_from_corner(surface, h / 3, h % 3, x, 0);
            const Jet there = patches::turned(jet_from_corner(surface, twin / 3, twin % 3, 1 - x, 0), -1, 0, 0, -1);
            const Eigen::VectorXd difference = (here - there).rowwise().norm();
            const bool is_sharp = surface.features.edge_is_sharp[e] != 0, along = difference[0] < 1e-14 && difference[1] < 1e-12 && difference[3] < 1e-10;
            if (along && (is_sharp || (difference[2] < 1e-12 && difference[4] < 1e-10 && difference[5] < 1e-10))) continue;
            CAPTURE(surface.shape.name, e, h / 3, twin / 3, x, is_sharp);
            REQUIRE(here == there);
        }
    }
}

void check_all(const shapes::Shape& shape, int levels) {
    const Surface surface(shape, loop());
    patches::check_table(surface.table);
    patches::check_limits(surface, levels);
    check_continuity(surface);
}

}  // namespace

TEST_CASE("Loop patches go through the limits of refined vertices and fit together, at every valence", "[evaluate][loop]") {
    for (int n = 3; n <= 12; ++n) check_all(double_pyramid(n), n == 3 || n == 7 ? 3 : 2);
}

TEST_CASE("Loop patches are right at darts, creases and corners", "[evaluate][loop]") {
    for (const int n : {4, 5, 6, 7, 8})
        for (const auto& shape : with_sharp_poles(n)) check_all(shape, 2);
    for (const auto& shape : shapes::triangles_only(shapes::feature_shapes())) check_all(shape, 1);
}

TEST_CASE("Loop patches are right at boundaries with any number of faces", "[evaluate][loop]") {
    for (int k = 1; k <= 8; ++k) {
        shapes::Shape shape = fan(k);
        check_all(shape, 2);
        shape.features.corners = {0};
        check_all(shape, 2);
        shape.features = {};
        shape.features.boundary = BoundaryRule::edge_only;
        check_all(shape, 2);
        shape.features.boundary = BoundaryRule::fixed;
        check_all(shape, 2);
    }
    for (const auto& shape : shapes::triangles_only(shapes::boundary_shapes())) check_all(shape, 1);
}

TEST_CASE("Loop derivatives are those of the positions, by the face's own parameters", "[evaluate][loop]") {
    for (const auto& shape : {double_pyramid(5), fan(4), with_sharp_poles(4)[0], with_sharp_poles(7)[1]}) {
        const Surface surface(shape, loop());
        for (Index face = 0; face < shape.mesh.face_count(); ++face)
            for (const At& at : {At{face, 0, 0.05, 0.17}, {face, 0, 0.8, 0.13}, {face, 0, 0.16, 0.71}, {face, 0, 0.3, 0.37}, {face, 0, 0.02, 0.007}})
                patches::check_derivatives(surface, at, 0.002);
    }
}

TEST_CASE("Loop patches deep at their tip are those of the refined mesh", "[evaluate][loop]") {
    // Three explicit refinements against three more powers of the kind's step: (u, v) of a face is (8u, 8v) of its child at the first corner.
    std::vector<shapes::Shape> all{fan(2), fan(5)};
    for (int n = 3; n <= 12; ++n) all.push_back(double_pyramid(n));
    for (const int n : {4, 6, 9})
        for (const auto& shape : with_sharp_poles(n)) all.push_back(shape);
    for (const auto& shape : all) {
        const Refinement refined = refine(shape.mesh, shape.features, loop(), 3);
        const Surface surface(shape, loop()), fine({shape.name, refined.mesh, refined.features}, loop());
        for (Index face = 0; face < shape.mesh.face_count(); ++face) {
            for (const double scale : {0.1, 1e-3, 1e-6}) {
                for (const auto& [u, v] : {std::array<double, 2>{0.8, 0.1}, {0.45, 0.4}, {0.1, 0.8}, {0, 0.6}}) {
                    const Jet whole = surface.jet({face, 0, scale * u, scale * v});
                    const Jet child = patches::turned(fine.jet({64 * face, 0, 8 * scale * u, 8 * scale * v}), 8, 0, 0, 8);
                    if (patches::is_same(whole, child, scale)) continue;
                    CAPTURE(shape.name, face, scale, u, v);
                    REQUIRE(whole == child);
                }
            }
        }
    }
}

TEST_CASE("regular Loop patches at sharp features need no kinds", "[evaluate][loop]") {
    // Three faces between two sharp edges, one at a corner, six at smooth vertices.
    const Surface triangle(shapes::single_triangle(), loop());
    CHECK(triangle.table.kinds.empty());
    CHECK(triangle.table.patch_count() == 4);
    const Surface torus(shapes::torus_triangles(4, 4), loop());
    CHECK(torus.table.kinds.empty());
    CHECK(torus.table.ghosts.indices.empty());
    shapes::Shape creased = double_pyramid(6);
    creased.features.creases = {{0, 2}, {0, 5}, {1, 3}, {1, 6}};
    for (const PatchKind& kind : Surface(creased, loop()).table.kinds) CHECK(kind.point_count != 12);
    // The place of the face in its sector counts: 4 faces, seen from both ends and the middle ones.
    shapes::Shape four = fan(4);
    four.features.corners = {1, 5};
    CHECK(Surface(four, loop()).table.kinds.size() >= 4);
}

TEST_CASE("the eigenstructure of every closed Loop kind is found, valence 3 with its chain", "[evaluate][loop][modes]") {
    for (int n = 3; n <= 50; ++n) {
        if (n == 6) continue;
        const PatchKind kind = loop_kind({LoopRound::smooth, n, 0});
        const std::optional<Modes> modes = find_modes(kind);
        CAPTURE(n);
        REQUIRE(modes);
        modes_support::check_kind(kind);
        modes_support::check_modes(kind, *modes);
        bool has_chain = false;
        for (const std::uint8_t power : modes->powers) has_chain |= power == 1;
        CHECK(has_chain == (n == 3));
    }
}

TEST_CASE("Loop places that do not exist are refused by number", "[evaluate][loop]") {
    const Surface surface(shapes::octahedron(), loop());
    const auto refuses = [&](const At& at, const char* message) {
        const Index faces[] = {0, at.face}, corners[] = {0, at.corner};
        const double uv[] = {0.25, 0.5, at.u, at.v};
        PatchPlace places[2];
        REQUIRE_THROWS_WITH(locate(surface.table, {2, faces, corners, uv}, 0, 2, places), Catch::Contains(message));
    };
    refuses({8, 0, 0, 0}, "place 1: face 8 does not exist, the mesh has 8 faces (0 to 7)");
    refuses({-1, 0, 0, 0}, "place 1: face -1 does not exist");
    refuses({2, 1, 0, 0}, "place 1: corner 1 of face 2 does not exist");
    refuses({2, 0, 0.75, 0.5}, "place 1: (u, v) = (0.750000, 0.500000) is not on the face");
    refuses({2, 0, -1e-11, 0.5}, "is not on the face");
    refuses({2, 0, std::nan(""), 0.5}, "is not on the face");
    refuses({2, 0, 0, -std::numeric_limits<double>::infinity()}, "is not on the face");
    // Barycentric weights that rounding moves over the edge are taken.
    const PatchPlace over = surface.locate({2, 0, -1e-13, 1 + 1e-13});
    CHECK((over.s == 0 && over.t == 0 && over.patch == 10));
    const PatchPlace beside = surface.locate({2, 0, 0.7, 0.3 + 1e-13});
    CHECK((beside.s >= 0 && beside.t == 0));
}

TEST_CASE("Loop patches refuse other faces than triangles", "[evaluate][loop]") {
    REQUIRE_THROWS_WITH(Surface(shapes::cube(), loop()), Catch::Contains("Loop refines triangles only"));
}
