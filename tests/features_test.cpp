// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "host/mesh/features.h"
#include "tests/shapes/shapes.h"

using namespace lcl;
using Pair = std::array<Index, 2>;

namespace {

Features features_of(const shapes::Shape& shape) { return find_features(shape.mesh, build_topology(shape.mesh), shape.features); }

Features features_of(const PolygonMesh& mesh, const FeatureOptions& options) { return find_features(mesh, build_topology(mesh), options); }

std::ptrdiff_t number_of(const Features& features, VertexKind kind) { return std::count(features.kind.begin(), features.kind.end(), kind); }

FeatureOptions with_boundary(BoundaryRule rule) {
    FeatureOptions options;
    options.boundary = rule;
    return options;
}

}  // namespace

TEST_CASE("a closed mesh without features is smooth", "[mesh][features]") {
    for (const auto& shape : shapes::closed_shapes()) {
        CAPTURE(shape.name);
        const Features features = features_of(shape.mesh, {});
        CHECK(number_of(features, VertexKind::smooth) == shape.mesh.vertex_count);
        CHECK(std::count(features.edge_is_sharp.begin(), features.edge_is_sharp.end(), 1) == 0);
        CHECK(features.crease_count == 0);
        CHECK(features.corner_count == 0);
        CHECK(features.curve_neighbours.empty());
    }
}

TEST_CASE("the boundary rule decides which boundary vertices are corners", "[mesh][features]") {
    const PolygonMesh mesh = shapes::grid_quads(3, 2).mesh;  // 12 vertices, 10 on the boundary, 4 with one face
    const Features both = features_of(mesh, with_boundary(BoundaryRule::edge_and_corner));
    CHECK(number_of(both, VertexKind::corner) == 4);
    CHECK(number_of(both, VertexKind::curve) == 6);
    CHECK(both.corner_count == 4);
    CHECK(both.crease_count == 0);
    const Features edges = features_of(mesh, with_boundary(BoundaryRule::edge_only));
    CHECK(number_of(edges, VertexKind::corner) == 0);
    CHECK(number_of(edges, VertexKind::curve) == 10);
    const Features fixed = features_of(mesh, with_boundary(BoundaryRule::fixed));
    CHECK(number_of(fixed, VertexKind::corner) == 10);
    CHECK(number_of(fixed, VertexKind::smooth) == 2);
}

TEST_CASE("curve neighbours at a boundary are E_0 and E_k in face order", "[mesh][features]") {
    // 3 -- 4 -- 5
    // |    |    |     the outgoing boundary half-edge of 1 ends in 2, the last edge comes from 0
    // 0 -- 1 -- 2
    const auto mesh = shapes::make("two quads", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}, {{0, 1, 4, 3}, {1, 2, 5, 4}}).mesh;
    const Features features = features_of(mesh, with_boundary(BoundaryRule::edge_only));
    CHECK(features.curve_neighbours == Array<Pair>{{1, 3}, {2, 0}, {5, 1}, {0, 4}, {3, 5}, {4, 2}});
}

TEST_CASE("sharp edges make darts, curve vertices and corners", "[mesh][features]") {
    const Features chain = features_of(shapes::cube_with_crease());  // 4-5-6-7
    CHECK(chain.crease_count == 3);
    CHECK(chain.kind[4] == VertexKind::dart);
    CHECK(chain.kind[5] == VertexKind::curve);
    CHECK(chain.kind[6] == VertexKind::curve);
    CHECK(chain.kind[7] == VertexKind::dart);
    CHECK(chain.curve_neighbours[4] == Pair{5, 5});
    CHECK(std::minmax(chain.curve_neighbours[5][0], chain.curve_neighbours[5][1]) == std::minmax(Index{4}, Index{6}));
    CHECK(chain.curve_neighbours[7] == Pair{6, 6});
    CHECK(number_of(features_of(shapes::cube_with_crease_loop()), VertexKind::curve) == 4);
    const auto cube = shapes::cube();
    const Index v = 6;
    FeatureOptions star;
    const Topology topology = build_topology(cube.mesh);
    for (Index h = 0; h < topology.half_edge_count(); ++h)
        if (topology.origin(h) == v) star.creases.push_back({topology.destination(h), v});
    const Features corner = features_of(cube.mesh, star);
    CHECK(corner.crease_count == 3);
    CHECK(corner.corner_count == 1);
    CHECK(corner.kind[v] == VertexKind::corner);
    CHECK(corner.curve_neighbours[v] == Pair{-1, -1});
    CHECK(number_of(corner, VertexKind::dart) == 3);
}

TEST_CASE("a crease that meets the boundary makes a corner there", "[mesh][features]") {
    const auto grid = shapes::grid_quads(2, 2);  // 9 vertices, 4 in the middle
    FeatureOptions options;
    const Topology topology = build_topology(grid.mesh);
    Index middle = 0;
    while (topology.is_boundary(middle)) ++middle;
    const Index h = topology.vertex_half_edge[middle];
    options.creases = {{middle, topology.destination(h)}};
    const Features features = features_of(grid.mesh, options);
    CHECK(features.kind[middle] == VertexKind::dart);
    CHECK(features.kind[topology.destination(h)] == VertexKind::corner);
    CHECK(features.corner_count == 5);
}

TEST_CASE("marked corners stay, isolated vertices remain isolated", "[mesh][features]") {
    const auto shape = shapes::with_isolated_vertex(shapes::cube(), 2);
    FeatureOptions options;
    options.corners = {0, 2};
    const Features features = features_of(shape.mesh, options);
    CHECK(features.kind[0] == VertexKind::corner);
    CHECK(features.kind[2] == VertexKind::isolated);
    CHECK(features.corner_count == 1);
}

TEST_CASE("boundary edges given as creases are no creases", "[mesh][features]") {
    const auto quad = shapes::single_quad();
    FeatureOptions options;
    options.creases = {{quad.mesh.face_vertices[1], quad.mesh.face_vertices[0]}};
    const Features features = features_of(quad.mesh, options);
    CHECK(features.crease_count == 0);
    CHECK(features.edge_is_sharp == std::vector<std::uint8_t>{1, 1, 1, 1});
}

TEST_CASE("the crease angle compares Newell normals", "[mesh][features]") {
    const auto box = shapes::box_with_crease_angle();
    const Features features = features_of(box);
    CHECK(features.crease_count == 36);
    CHECK(features.corner_count == 8);
    CHECK(number_of(features, VertexKind::curve) == 24);
    FeatureOptions options;
    options.crease_angle_degrees = 89.99;
    CHECK(features_of(box.mesh, options).crease_count == 36);
    options.crease_angle_degrees = 90.01;
    CHECK(features_of(box.mesh, options).crease_count == 0);
    SECTION("far from the origin of space too") {
        options.crease_angle_degrees = 89.99;
        CHECK(features_of(shapes::transformed(box, 1, 1e6).mesh, options).crease_count == 36);
    }
    SECTION("two faces folded on each other differ by 180 degrees") {
        const auto fold = shapes::make("fold", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 1, 2}, {1, 0, 3}});
        options.crease_angle_degrees = 179;
        CHECK(features_of(fold.mesh, options).crease_count == 1);
    }
    SECTION("a face without area makes no crease") {
        options.crease_angle_degrees = 1;
        CHECK(features_of(shapes::zero_area_face().mesh, options).crease_count == 0);
    }
}

TEST_CASE("features that are not of the mesh are refused by name", "[mesh][features]") {
    const auto cube = shapes::cube();
    const auto refuse = [&](const FeatureOptions& options, const std::string& message, const Where& where) {
        try {
            features_of(cube.mesh, options);
            FAIL("accepted");
        } catch (const BadInput& error) {
            CHECK(std::string(error.what()) == message);
            CHECK(error.where.vertices == where.vertices);
        }
    };
    FeatureOptions crease, far_crease, corner;
    crease.creases = {{0, 6}};
    far_crease.creases = {{0, 8}};
    corner.corners = {-1};
    refuse(crease, "the crease 0-6 is no edge of the mesh: name the two ends of an edge", {{0, 6}, {}});
    refuse(far_crease, "a crease uses vertex 8, the mesh has 8: correct the index", {{8}, {}});
    refuse(corner, "the list of corners uses vertex -1, the mesh has 8: correct the index", {{-1}, {}});
    const auto isolated = shapes::with_isolated_vertex(cube, 8);
    FeatureOptions to_isolated;
    to_isolated.creases = {{8, 0}};
    CHECK_THROWS_WITH(features_of(isolated.mesh, to_isolated), Catch::Matchers::StartsWith("the crease 8-0 is no edge"));
}

TEST_CASE("every spoke of a large pole as a crease takes linear time", "[mesh][features]") {
    const int n = 50000;
    std::vector<shapes::Face> faces;
    FeatureOptions options;
    for (int i = 0; i < n; ++i) {
        faces.push_back({0, 1 + i, 1 + (i + 1) % n});
        options.creases.push_back({0, 1 + i});
    }
    const auto shape = shapes::make("pole", std::vector<shapes::Point>(n + 1), faces);
    const Features features = features_of(shape.mesh, options);
    CHECK(features.crease_count == n);
    CHECK(features.kind[0] == VertexKind::corner);
}
