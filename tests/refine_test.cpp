// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "host/refine/refine.h"
#include "tests/oracle/limit.h"
#include "tests/oracle/subdivide.h"
#include "tests/shapes/shapes.h"

using namespace lcl;
using shapes::Face;
using shapes::Point;

namespace {

SchemeOptions scheme_of(Scheme scheme, DooSabinMask mask = DooSabinMask::catmull) {
    SchemeOptions options;
    options.scheme = scheme;
    options.mask = mask;
    return options;
}

SchemeOptions catmull_clark(double alpha, double lambda = 0) {
    SchemeOptions options;
    options.alpha = alpha;
    options.lambda = lambda;
    return options;
}

const SchemeOptions loop_scheme = scheme_of(Scheme::loop);
const SchemeOptions doo_sabin = scheme_of(Scheme::doo_sabin);

Refinement refine_once_with(const shapes::Shape& shape, const SchemeOptions& options) {
    const Topology topology = build_topology(shape.mesh);
    return refine_once(shape.mesh, topology, find_features(shape.mesh, topology, shape.features), options);
}

shapes::Shape with_rule(shapes::Shape shape, BoundaryRule rule) {
    shape.features.boundary = rule;
    return shape;
}

Point point(const PolygonMesh& mesh, Index v) { return shapes::points_of(mesh)[v]; }

void check_point(const Point& is, const Point& expected, double tolerance = 1e-15) {
    for (int c = 0; c < 3; ++c) CHECK_THAT(is[c], Catch::Matchers::WithinAbs(expected[c], tolerance));
}

/// Positions differ by rounding of rows of up to some tens of entries on coordinates of a few units.
constexpr double rounding = 1e-13;

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

std::vector<SchemeOptions> options_for(const shapes::Shape& shape) {
    std::vector<SchemeOptions> all{catmull_clark(0), catmull_clark(0.5), catmull_clark(0, 0.3), catmull_clark(0.25, 0.6)};
    if (shape.name.find("valence_2") == std::string::npos && shape.name.find("split_edges") == std::string::npos) {
        all.push_back(doo_sabin);
        all.push_back(scheme_of(Scheme::doo_sabin, DooSabinMask::classic));
    }
    if (shapes::is_triangle_mesh(shape.mesh)) all.push_back(loop_scheme);
    return all;
}

/// Of a corner of a fixed boundary Doo-Sabin makes boundary points that are plain curve points, as Catmull-Clark and Loop do.
oracle::Surface surface_of(const PolygonMesh& mesh, const FeatureOptions& features) {
    oracle::Surface surface = oracle::make_surface(mesh, features);
    surface.boundary_is_fixed = false;
    return surface;
}

void check_against_oracle(const shapes::Shape& shape, const Refinement& refined, const oracle::Step& expected) {
    const PolygonMesh mesh = oracle::to_mesh(expected.surface, expected.weights * oracle::positions(shape.mesh));
    REQUIRE(refined.mesh.vertex_count == mesh.vertex_count);
    CHECK(largest_difference(refined.mesh.positions, mesh.positions) < rounding);
    const bool same_faces = oracle::sorted_faces(refined.mesh) == oracle::sorted_faces(mesh);  // not spelt out where it fails
    CHECK(same_faces);
    const oracle::Surface found = surface_of(refined.mesh, refined.features);
    const bool same_sharp_edges = found.sharp == expected.surface.sharp;
    CHECK(same_sharp_edges);
    CHECK(found.corners == expected.surface.corners);
}

std::vector<shapes::Shape> shapes_with_all_rules() {
    auto all = shapes::all_shapes();
    for (const auto& shape : shapes::boundary_shapes())
        for (const BoundaryRule rule : {BoundaryRule::edge_only, BoundaryRule::fixed}) all.push_back(with_rule(shape, rule));
    for (const auto& shape : {shapes::grid_with_creases(), shapes::grid_triangles_with_creases(), shapes::grid_with_marked_corner()})
        all.push_back(with_rule(shape, BoundaryRule::edge_only));
    for (auto& shape : all) shape = shapes::rough(std::move(shape), 0.1, 3);
    return all;
}

const auto two_quads = [] {
    // 3 -- 4 -- 5
    // 0 -- 1 -- 2
    return shapes::make("two quads", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}, {{0, 1, 4, 3}, {1, 2, 5, 4}});
};

}  // namespace

TEST_CASE("a cube refined by Catmull-Clark has the points worked out by hand", "[refine][catmull-clark]") {
    std::vector<Point> points;
    for (const double z : {-1.0, 1.0}) points.insert(points.end(), {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}});
    const auto cube = shapes::make("cube", points, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
    const Refinement plain = refine_once_with(cube, catmull_clark(0));
    REQUIRE(plain.mesh.vertex_count == 8 + 12 + 6);
    check_point(point(plain.mesh, 6), {5.0 / 9, 5.0 / 9, 5.0 / 9});
    check_point(point(plain.mesh, 8), {-3.0 / 4, 0, -3.0 / 4});  // edge 0-3
    check_point(point(plain.mesh, 8 + 12 + 1), {0, 0, 1});
    check_point(point(refine_once_with(cube, catmull_clark(1)).mesh, 6), {7.0 / 9, 7.0 / 9, 7.0 / 9});
}

TEST_CASE("Catmull-Clark numbers vertices, edges, faces, and children begin at their old vertex", "[refine][catmull-clark]") {
    const Refinement refined = refine_once_with(two_quads(), catmull_clark(0));
    // edges 6: 0-1, 7: 1-4, 8: 4-3, 9: 3-0, 10: 1-2, 11: 2-5, 12: 5-4; faces 13, 14
    CHECK(shapes::faces_of(refined.mesh) ==
          std::vector<Face>{{0, 6, 13, 9}, {1, 7, 13, 6}, {4, 8, 13, 7}, {3, 9, 13, 8}, {1, 10, 14, 7}, {2, 11, 14, 10}, {5, 12, 14, 11}, {4, 7, 14, 12}});
    CHECK(refined.face_parent == std::vector<Index>{0, 0, 0, 0, 1, 1, 1, 1});
    check_point(point(refined.mesh, 0), {0, 0, 0});
    check_point(point(refined.mesh, 1), {1, 0, 0});
    check_point(point(refined.mesh, 7), {1, 0.5, 0});
    check_point(point(refined.mesh, 14), {1.5, 0.5, 0});
}

TEST_CASE("boundary curves of Catmull-Clark and Loop use 1 6 1 and midpoints, corners stay", "[refine]") {
    const auto triangle = shapes::make("triangle", {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}, {{0, 1, 2}});
    for (const auto& options : {catmull_clark(0), loop_scheme}) {
        const Refinement kept = refine_once_with(triangle, options);
        check_point(point(kept.mesh, 1), {8, 0, 0});
        check_point(point(kept.mesh, 4), {4, 4, 0});
        const Refinement round = refine_once_with(with_rule(triangle, BoundaryRule::edge_only), options);
        check_point(point(round.mesh, 1), {6, 1, 0});
        check_point(point(round.mesh, 0), {1, 1, 0});
        CHECK(round.features.boundary == BoundaryRule::edge_only);
    }
}

TEST_CASE("a tetrahedron refined by Loop has the points and faces worked out by hand", "[refine][loop]") {
    const auto shape = shapes::make("tetrahedron", {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
    const Refinement refined = refine_once_with(shape, loop_scheme);
    REQUIRE(refined.mesh.vertex_count == 10);
    check_point(point(refined.mesh, 0), {0.25, 0.25, 0.25});  // beta_3 = 3/16: 7/16 V - 3/16 V
    check_point(point(refined.mesh, 4), {0, 0.5, 0});         // edge 0-2: (3/8 - 1/8)(V_0 + V_2)
    // edges 4: 0-2, 5: 2-1, 6: 1-0, 7: 1-3, 8: 3-0, 9: 3-2
    CHECK(shapes::faces_of(refined.mesh) == std::vector<Face>{{0, 4, 6},
                                                              {2, 5, 4},
                                                              {1, 6, 5},
                                                              {4, 5, 6},
                                                              {0, 6, 8},
                                                              {1, 7, 6},
                                                              {3, 8, 7},
                                                              {6, 7, 8},
                                                              {0, 8, 4},
                                                              {3, 9, 8},
                                                              {2, 4, 9},
                                                              {8, 9, 4},
                                                              {1, 5, 7},
                                                              {2, 9, 5},
                                                              {3, 7, 9},
                                                              {5, 9, 7}});
    CHECK(refined.face_parent == std::vector<Index>{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3});
}

TEST_CASE("a quad refined by Doo-Sabin has the points, faces and kept corners worked out by hand", "[refine][doo-sabin]") {
    const auto quad = shapes::make("quad", {{0, 0, 0}, {16, 0, 0}, {16, 16, 0}, {0, 16, 0}}, {{0, 1, 2, 3}});
    for (const DooSabinMask mask : {DooSabinMask::catmull, DooSabinMask::classic}) {
        const Refinement refined = refine_once_with(quad, scheme_of(Scheme::doo_sabin, mask));
        REQUIRE(refined.mesh.vertex_count == 4 + 8 + 4);
        check_point(point(refined.mesh, 0), {4, 4, 0}, 1e-14);
        check_point(point(refined.mesh, 2), {12, 12, 0}, 1e-14);
        check_point(point(refined.mesh, 4), {4, 0, 0});  // 3/4 and 1/4 on edge 0-1
        check_point(point(refined.mesh, 5), {12, 0, 0});
        check_point(point(refined.mesh, 11), {0, 4, 0});  // the last point of edge 3-0
        check_point(point(refined.mesh, 13), {16, 0, 0});
        CHECK(shapes::faces_of(refined.mesh) ==
              std::vector<Face>{
                  {0, 1, 2, 3}, {0, 4, 5, 1}, {1, 6, 7, 2}, {2, 8, 9, 3}, {3, 10, 11, 0}, {0, 11, 12, 4}, {1, 5, 13, 6}, {2, 7, 14, 8}, {3, 9, 15, 10}});
        CHECK(refined.face_parent == std::vector<Index>{0, -1, -1, -1, -1, -1, -1, -1, -1});
        CHECK(refined.features.corners.empty());  // found again: the only boundary vertices with one face
        CHECK(refined.features.boundary == BoundaryRule::edge_and_corner);
    }
    const Refinement round = refine_once_with(with_rule(quad, BoundaryRule::edge_only), doo_sabin);
    CHECK(round.mesh.vertex_count == 12);
    CHECK(shapes::faces_of(round.mesh)[5] == Face{0, 11, 4});
}

TEST_CASE("the two Doo-Sabin masks are those of their papers on a pentagon and a triangle", "[refine][doo-sabin]") {
    // The first corner alone is raised, so its row's weights show as heights.
    const auto raised = [](int sides) {
        std::vector<Point> points(sides, Point{0, 0, 0});
        points[0][2] = 1;
        Face face(sides);
        for (int i = 0; i < sides; ++i) face[i] = i;
        return shapes::make("raised", points, {face});
    };
    const auto heights = [&](int sides, DooSabinMask mask) {
        std::vector<double> z;
        const Refinement refined = refine_once_with(raised(sides), scheme_of(Scheme::doo_sabin, mask));
        for (int i = 0; i < sides; ++i) z.push_back(point(refined.mesh, i)[2]);
        return z;
    };
    const double c1 = (std::sqrt(5.0) - 1) / 4, c2 = -(std::sqrt(5.0) + 1) / 4;  // cos 72, cos 144 degrees
    const std::vector<double> catmull5{0.55, 0.175, 0.05, 0.05, 0.175}, catmull3{7.0 / 12, 5.0 / 24, 5.0 / 24};
    const std::vector<double> classic5{0.5, (3 + 2 * c1) / 20, (3 + 2 * c2) / 20, (3 + 2 * c2) / 20, (3 + 2 * c1) / 20}, classic3{8.0 / 12, 2.0 / 12, 2.0 / 12};
    CHECK(largest_difference(heights(5, DooSabinMask::catmull), catmull5) < 1e-15);
    CHECK(largest_difference(heights(3, DooSabinMask::catmull), catmull3) < 1e-15);
    CHECK(largest_difference(heights(5, DooSabinMask::classic), classic5) < 1e-15);
    CHECK(largest_difference(heights(3, DooSabinMask::classic), classic3) < 1e-15);
}

TEST_CASE("a Doo-Sabin crease is cut: both sides have boundary points of their own at the same places", "[refine][doo-sabin][crease]") {
    shapes::Shape cube = shapes::cube_with_crease_loop();
    const Refinement refined = refine_once_with(cube, doo_sabin);
    const Topology topology = build_topology(refined.mesh);
    CHECK(boundary_loops(topology).size() == 2);
    Index components = 0;
    connected_components(topology, components);
    CHECK(components == 2);
    CHECK(refined.mesh.vertex_count == 24 + 4 * 4);
    for (Index v = 24; v < 40; v += 4) {  // edge by edge: a pair of its first half-edge, a pair of its twin in the other direction
        check_point(point(refined.mesh, v), point(refined.mesh, v + 3));
        check_point(point(refined.mesh, v + 1), point(refined.mesh, v + 2));
    }
    CHECK(refined.features.creases.empty());
}

TEST_CASE("Doo-Sabin keeps a marked corner inside the surface by a fan of triangles", "[refine][doo-sabin]") {
    shapes::Shape shape = shapes::octahedron();
    shape.features.corners = {2};
    const Refinement refined = refine(shape.mesh, shape.features, doo_sabin, 2);
    const Topology topology = build_topology(refined.mesh);
    REQUIRE(refined.features.corners.size() == 1);
    const Index kept = refined.features.corners[0];
    check_point(point(refined.mesh, kept), point(shape.mesh, 2));
    CHECK(topology.vertex_face_count[kept] == 4);
    CHECK(topology.vertex_count - topology.edge_count + topology.face_count == 2);
}

TEST_CASE("the two-phase mesh has the numbers, faces and points worked out by hand", "[refine][two-phase]") {
    const auto quad = shapes::make("quad", {{0, 0, 0}, {16, 0, 0}, {16, 16, 0}, {0, 16, 0}}, {{0, 1, 2, 3}});
    SchemeOptions options = catmull_clark(0, 0.5);
    const Refinement refined = refine_once_with(quad, options);
    REQUIRE(refined.mesh.vertex_count == 4 + 8 + 4);
    CHECK(
        shapes::faces_of(refined.mesh) ==
        std::vector<Face>{
            {12, 13, 14, 15}, {4, 5, 13, 12}, {6, 7, 14, 13}, {8, 9, 15, 14}, {10, 11, 12, 15}, {0, 4, 12, 11}, {1, 6, 13, 5}, {2, 8, 14, 7}, {3, 10, 15, 9}});
    check_point(point(refined.mesh, 1), {16, 0, 0});
    check_point(point(refined.mesh, 4), {4, 0, 0});  // next to 0 on edge 0-1: half 0, half the midpoint
    check_point(point(refined.mesh, 5), {12, 0, 0});
    check_point(point(refined.mesh, 13), {12, 4, 0});  // corner 1 drawn half of the way to the centre
    CHECK(refined.face_parent == std::vector<Index>(9, 0));
    const Refinement round = refine_once_with(with_rule(quad, BoundaryRule::edge_only), options);
    check_point(point(round.mesh, 1), {15, 1, 0});  // half of 1, half of (6, 1, 1)/8
    options.lambda_per_vertex = {0.5, 1, 0.25, 0};
    const Refinement mixed = refine_once_with(quad, options);
    check_point(point(mixed.mesh, 13), {16, 0, 0});
    check_point(point(mixed.mesh, 14), {10, 10, 0});
    check_point(point(mixed.mesh, 15), {8, 8, 0});
}

TEST_CASE("one refinement has the points, faces and features of plain subdivision", "[refine][oracle]") {
    for (const auto& shape : shapes_with_all_rules()) {
        for (const SchemeOptions& options : options_for(shape)) {
            CAPTURE(shape.name, scheme_name(options.scheme), options.alpha, options.lambda, int(shape.features.boundary));
            check_against_oracle(shape, refine_once_with(shape, options), oracle::subdivide(surface_of(shape.mesh, shape.features), options));
        }
    }
}

TEST_CASE("later refinements are plain subdivision of the refined mesh as its own features say", "[refine][oracle]") {
    for (const auto& shape : shapes_with_all_rules()) {
        if (shape.mesh.vertex_count > 40) continue;  // the oracle's dense rows grow with the square
        for (const SchemeOptions& options : options_for(shape)) {
            if (options.alpha == 0.25) continue;
            CAPTURE(shape.name, scheme_name(options.scheme), options.alpha, options.lambda, int(shape.features.boundary));
            const Refinement once = refine(shape.mesh, shape.features, options, 1);
            const shapes::Shape refined{shape.name, once.mesh, once.features};
            check_against_oracle(refined, refine(shape.mesh, shape.features, options, 2),
                                 oracle::subdivide(surface_of(once.mesh, once.features), oracle::after_first_step(options)));
        }
    }
}

TEST_CASE("stencils are affine, convex, without repeated vertices, and give the positions", "[refine][stencils]") {
    for (const auto& shape : shapes_with_all_rules()) {
        for (const SchemeOptions& options : options_for(shape)) {
            CAPTURE(shape.name, scheme_name(options.scheme), options.alpha, options.lambda);
            const Refinement refined = refine_once_with(shape, options);
            const Stencils& stencils = refined.stencils;
            REQUIRE(stencils.offsets.size() == static_cast<std::size_t>(refined.mesh.vertex_count) + 1);
            double lowest = 0, worst_sum = 0;
            bool repeats = false;
            for (Index i = 0; i < refined.mesh.vertex_count; ++i) {
                double sum = 0;
                std::set<Index> met;
                for (std::size_t j = stencils.offsets[i]; j < stencils.offsets[i + 1]; ++j) {
                    sum += stencils.weights[j];
                    lowest = std::min(lowest, stencils.weights[j]);
                    repeats |= !met.insert(stencils.indices[j]).second;
                }
                worst_sum = std::max(worst_sum, std::abs(sum - 1));
            }
            CHECK(lowest == 0);
            CHECK(worst_sum < 1e-14);
            CHECK_FALSE(repeats);
            CHECK(largest_difference(apply_stencils(stencils, shape.mesh.positions, 3), refined.mesh.positions) == 0);
            CHECK(largest_difference(refine(shape.mesh, shape.features, options, 1).mesh.positions, refined.mesh.positions) < rounding);
        }
    }
}

TEST_CASE("stencils apply to any number of channels", "[refine][stencils]") {
    Stencils stencils;
    stencils.offsets = {0, 2, 3};
    stencils.indices = {0, 2, 1};
    stencils.weights = {0.25, 0.75, 1};
    CHECK(apply_stencils(stencils, {4, 8, 16}, 1) == std::vector<double>{13, 8});
    CHECK(apply_stencils(stencils, {4, 0, 8, 1, 16, 2}, 2) == std::vector<double>{13, 1.5, 8, 1});
}

TEST_CASE("the alpha rule in the first step alone gives the paper's limit mask", "[refine][catmull-clark]") {
    const double alpha = 0.5;
    for (const auto& shape : {shapes::rough(shapes::cube(), 0.2, 1), shapes::polygons_mixed(60, 5), shapes::icosphere_quads(1)}) {
        CAPTURE(shape.name);
        const Topology topology = build_topology(shape.mesh);
        const Refinement refined = refine_once_with(shape, catmull_clark(alpha));
        const Topology fine = build_topology(refined.mesh);
        for (Index v = 0; v < topology.vertex_count; ++v) {
            const double n = topology.vertex_face_count[v];
            Point mask{}, limit{};
            const auto add = [](Point& sum, const PolygonMesh& mesh, Index i, double weight) {
                for (int c = 0; c < 3; ++c) sum[c] += weight * mesh.positions[3 * i + c];
            };
            add(mask, shape.mesh, v, n * (n - 1 + alpha));
            add(limit, refined.mesh, v, n * n);
            Index h = topology.vertex_half_edge[v], g = fine.vertex_half_edge[v];
            for (int j = 0; j < n; ++j, h = topology.rotate(h), g = fine.rotate(g)) {
                add(mask, shape.mesh, topology.destination(h), 2 - alpha);
                const Index face = topology.half_edge_face[h];
                for (Index c = topology.face_offsets[face]; c < topology.face_offsets[face + 1]; ++c)
                    add(mask, shape.mesh, topology.face_vertices[c], 4.0 / topology.degree(face));
                add(limit, refined.mesh, fine.destination(g), 4);
                add(limit, refined.mesh, fine.destination(fine.next(g)), 1);
            }
            for (int c = 0; c < 3; ++c) REQUIRE(mask[c] / (n * (n + 5)) == Approx(limit[c] / (n * (n + 5))).margin(1e-13));
        }
    }
}

TEST_CASE("refinement does not move the limit of an old vertex", "[refine][oracle]") {
    for (const auto& shape : shapes_with_all_rules()) {
        if (shape.mesh.vertex_count > 40) continue;
        for (const SchemeOptions& options : options_for(shape)) {
            if (options.scheme == Scheme::doo_sabin) continue;  // its old vertices have no refined number
            CAPTURE(shape.name, scheme_name(options.scheme), options.alpha, options.lambda);
            const Refinement refined = refine(shape.mesh, shape.features, options, 1);
            const oracle::Surface coarse = oracle::make_surface(shape.mesh, shape.features), fine = oracle::make_surface(refined.mesh, refined.features);
            const Eigen::MatrixXd coarse_points = oracle::positions(shape.mesh), fine_points = oracle::positions(refined.mesh);
            for (Index v = 0; v < shape.mesh.vertex_count; v += 3) {
                const Eigen::RowVector3d before = oracle::limit_row(coarse, options, v) * coarse_points;
                const Eigen::RowVector3d after = oracle::limit_row(fine, oracle::after_first_step(options), v) * fine_points;
                REQUIRE((before - after).norm() < 1e-12);
            }
        }
    }
}

TEST_CASE("every scheme keeps the Euler characteristic, and its refined valences or degrees are regular", "[refine]") {
    for (const auto& shape : shapes::closed_shapes()) {
        if (shape.mesh.vertex_count > 200) continue;
        const Topology old = build_topology(shape.mesh);
        const Index euler = old.vertex_count - old.edge_count + old.face_count;
        for (const SchemeOptions& options : options_for(shape)) {
            CAPTURE(shape.name, scheme_name(options.scheme), options.lambda);
            const Topology fine = build_topology(refine(shape.mesh, {}, options, 1).mesh);
            CHECK(fine.vertex_count - fine.edge_count + fine.face_count == euler);
            if (options.scheme == Scheme::doo_sabin) {
                CHECK(std::count(fine.vertex_face_count.begin(), fine.vertex_face_count.end(), 4) == fine.vertex_count);
            } else {
                CHECK(std::equal(old.vertex_face_count.begin(), old.vertex_face_count.end(), fine.vertex_face_count.begin()));
            }
            if (options.scheme == Scheme::catmull_clark && !options.is_two_phase()) CHECK(fine.half_edge_count() == 4 * fine.face_count);
        }
    }
}

TEST_CASE("isolated vertices are kept, and features follow the refinement", "[refine]") {
    shapes::Shape shape = shapes::with_isolated_vertex(shapes::cube_with_crease(), 2);
    const Point lonely = point(shape.mesh, 2);
    check_point(point(refine_once_with(shape, catmull_clark(0)).mesh, 2), lonely);
    check_point(point(refine_once_with(shape, catmull_clark(0, 0.3)).mesh, 2), lonely);
    const Refinement dual = refine_once_with(shape, doo_sabin);
    check_point(point(dual.mesh, dual.mesh.vertex_count - 1), lonely);
    CHECK(refine(shape.mesh, shape.features, catmull_clark(0), 2).features.creases.size() == 12);
    CHECK(refine(shape.mesh, shape.features, catmull_clark(0, 0.3), 2).features.creases.size() == 18);
    const Refinement fixed = refine_once_with(with_rule(shapes::grid_quads(2, 2), BoundaryRule::fixed), catmull_clark(0));
    CHECK(fixed.features.boundary == BoundaryRule::edge_and_corner);
    CHECK(fixed.features.corners.size() == 4);  // the other four have one face and are found again
}

TEST_CASE("no level gives a copy with named creases, and parents reach back over all levels", "[refine]") {
    const auto box = shapes::box_with_crease_angle();
    std::vector<SurfaceLocation> locations;
    const Refinement copy = refine(box.mesh, box.features, catmull_clark(0), 0, &locations);
    CHECK(copy.mesh.positions == box.mesh.positions);
    CHECK(copy.mesh.face_vertices == box.mesh.face_vertices);
    CHECK(copy.features.creases.size() == 36);
    CHECK(copy.features.crease_angle_degrees < 0);
    REQUIRE(locations.size() == static_cast<std::size_t>(box.mesh.vertex_count));
    for (Index v = 0; v < box.mesh.vertex_count; ++v) {
        const int corner = locations[v].u == 0 ? (locations[v].v == 0 ? 0 : 3) : (locations[v].v == 0 ? 1 : 2);
        CHECK(box.mesh.face_vertices[box.mesh.face_offsets[locations[v].face] + corner] == v);
    }
    const Refinement twice = refine(two_quads().mesh, {}, catmull_clark(0), 2);
    CHECK(std::count(twice.face_parent.begin(), twice.face_parent.end(), 0) == 16);
    CHECK(std::count(twice.face_parent.begin(), twice.face_parent.end(), 1) == 16);
}

TEST_CASE("what a scheme cannot refine is refused in one sentence", "[refine][errors]") {
    const auto cube = shapes::cube();
    CHECK_THROWS_WITH(refine(cube.mesh, {}, loop_scheme, 1),
                      "face 0 has 4 corners, Loop refines triangles only: triangulate the mesh or choose another scheme");
    CHECK_THROWS_AS(refine(shapes::cube_split_edges().mesh, {}, doo_sabin, 1), BadInput);
    CHECK_THROWS_WITH(refine(shapes::valence_2_pole().mesh, {}, doo_sabin, 1), Catch::Matchers::Contains("has only two faces all round it"));
    CHECK_THROWS_AS(refine(cube.mesh, {}, catmull_clark(0), -1), InvalidArgument);
    SchemeOptions blend = loop_scheme;
    blend.lambda = 0.5;
    CHECK_THROWS_AS(refine(shapes::octahedron().mesh, {}, blend, 1), InvalidArgument);
    SchemeOptions short_list;
    short_list.lambda_per_vertex = {0.5};
    CHECK_THROWS_WITH(refine(cube.mesh, {}, short_list, 1), "there are 1 blend ratios for 8 vertices: give one for each vertex");
    CHECK_THROWS_AS(refine(shapes::no_faces().mesh, {}, catmull_clark(0), 1), BadInput);
}

TEST_CASE("the size of a refined mesh is foretold", "[refine]") {
    for (const auto& shape : shapes_with_all_rules())
        for (const SchemeOptions& options : options_for(shape))
            for (const int levels : {0, 1, 3}) {
                const Topology topology = build_topology(shape.mesh);
                const RefinedSize size = refined_size(topology, find_features(shape.mesh, topology, shape.features), options, levels);
                const PolygonMesh refined = refine(shape.mesh, shape.features, options, levels).mesh;
                INFO(shape.name << ", " << levels << " levels");
                CHECK(size.vertices == refined.vertex_count);
                CHECK(size.edges == build_topology(refined).edge_count);
                CHECK(size.faces == refined.face_count());
                CHECK(size.corners == refined.corner_count());
            }
}

TEST_CASE("levels that cannot be numbered or held are refused at once with the number", "[refine][errors]") {
    // A cube has 6 4^k quads, that is 24 4^k corners, after k levels: 2^31 is passed by the corners at level 14, the memory before that on small machines.
    CHECK_THROWS_AS(refine(shapes::cube().mesh, {}, catmull_clark(0), 40), OutOfMemory);
    CHECK_THROWS_AS(refine(shapes::octahedron().mesh, {}, loop_scheme, 40), OutOfMemory);
    CHECK_THROWS_AS(refine(shapes::single_quad().mesh, {}, doo_sabin, 40), OutOfMemory);
    CHECK_THROWS_WITH(refine(shapes::cube().mesh, {}, catmull_clark(0), 40),
                      Catch::Matchers::Contains("refinement level") && Catch::Matchers::EndsWith("use fewer levels"));
}
