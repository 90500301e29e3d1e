// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <numeric>

#include <catch2/catch.hpp>

#include "host/mesh/topology.h"
#include "tests/shapes/shapes.h"

using namespace lcl;
using Indices = std::vector<Index>;

namespace {

/// The one defect of a shape; the topology must be refused with the same words and places.
Defect only_defect(const shapes::Shape& shape) {
    CAPTURE(shape.name);
    const auto defects = find_defects(shape.mesh);
    REQUIRE(defects.size() == 1);
    try {
        build_topology(shape.mesh);
        FAIL("the topology was built");
    } catch (const BadInput& error) {
        CHECK(error.what() == defects[0].message);
        CHECK(error.where.vertices == defects[0].where.vertices);
        CHECK(error.where.faces == defects[0].where.faces);
    }
    return defects[0];
}

std::vector<std::string> kinds(const PolygonMesh& mesh) {
    std::vector<std::string> names;
    for (const Defect& defect : find_defects(mesh)) names.push_back(defect_name(defect.kind));
    return names;
}

}  // namespace

TEST_CASE("sound meshes have no defects", "[mesh][defects]") {
    for (const auto& shape : shapes::all_shapes()) {
        CAPTURE(shape.name);
        CHECK(find_defects(shape.mesh).empty());
    }
    CHECK(find_defects(PolygonMesh{}).empty());
}

TEST_CASE("an index out of range is named with its face", "[mesh][defects]") {
    const Defect high = only_defect(shapes::face_with_index_out_of_range());
    CHECK(high.kind == DefectKind::index_range);
    CHECK(high.count == 1);
    CHECK(high.where.vertices == Indices{905});
    CHECK(high.where.faces == Indices{3});
    CHECK(high.message == "face 3 uses vertex 905, the mesh has 4: correct the index or remove the face");
    const Defect low = only_defect(shapes::face_with_negative_index());
    CHECK(low.where.vertices == Indices{-1});
    CHECK(low.where.faces == Indices{1});
}

TEST_CASE("a repeated vertex is named with its face, in small faces and large ones", "[mesh][defects]") {
    const Defect small = only_defect(shapes::repeated_vertex_in_face());
    CHECK(small.kind == DefectKind::repeated_vertex);
    CHECK(small.where.vertices == Indices{2});
    CHECK(small.where.faces == Indices{1});
    CHECK(small.message == "face 1 uses vertex 2 more than once: remove the corner or the face");
    shapes::Face large(40);
    std::iota(large.begin(), large.end(), 0);
    large[33] = 7;
    const Defect in_large = only_defect(shapes::make("large", std::vector<shapes::Point>(40), {large}));
    CHECK(in_large.where.vertices == Indices{7});
    CHECK(in_large.where.faces == Indices{0});
}

TEST_CASE("a face of two sides is too short", "[mesh][defects]") {
    const Defect defect = only_defect(shapes::two_sided_face());
    CHECK(defect.kind == DefectKind::short_face);
    CHECK(defect.where.faces == Indices{2});
    CHECK(defect.message == "face 2 has 2 corners, fewer than 3: remove the face");
}

TEST_CASE("an edge with three faces names its ends and its faces", "[mesh][defects]") {
    const Defect defect = only_defect(shapes::edge_with_three_faces());
    CHECK(defect.kind == DefectKind::edge_with_three_faces);
    CHECK(defect.count == 1);
    CHECK(defect.where.vertices == Indices{0, 1});
    CHECK(defect.where.faces == Indices{0, 1, 2});
    CHECK(defect.message ==
          "edge 0-1 belongs to 3 faces (0, 1, 2), a manifold mesh has at most two at an edge: "
          "remove faces or give them their own copies of the edge's vertices");
}

TEST_CASE("fans that share a vertex alone are a non-manifold vertex, open or closed", "[mesh][defects]") {
    const Defect open = only_defect(shapes::bow_tie_vertex());
    CHECK(open.kind == DefectKind::non_manifold_vertex);
    CHECK(open.where.vertices == Indices{2});
    CHECK(open.where.faces == Indices{0, 1});
    CHECK(open.message ==
          "vertex 2 joins 2 fans of faces that share no edge there, with faces 0 and 1 in different ones: give each fan its own copy of the vertex");
    const Defect closed = only_defect(shapes::closed_bow_tie());
    CHECK(closed.kind == DefectKind::non_manifold_vertex);
    CHECK(closed.where.vertices == Indices{0});
    // A closed fan and an open one: one boundary half-edge leaves the vertex, so only the walk round it can tell.
    auto points = shapes::points_of(shapes::tetrahedron().mesh);
    auto faces = shapes::faces_of(shapes::tetrahedron().mesh);
    points.push_back({5, 0, 0});
    points.push_back({5, 1, 0});
    faces.push_back({3, 4, 5});
    CHECK(only_defect(shapes::make("mixed fans", points, faces)).where.vertices == Indices{3});
}

TEST_CASE("faces that disagree in orientation are counted by their edges", "[mesh][defects]") {
    const Defect defect = only_defect(shapes::inconsistent_orientation());
    CHECK(defect.kind == DefectKind::orientation);
    CHECK(defect.count == 4);
    CHECK(defect.where.faces.size() == 5);
    CHECK(std::count(defect.where.faces.begin(), defect.where.faces.end(), 1) == 1);
    CHECK_THAT(defect.message, Catch::Matchers::Contains("in the same direction, so their orientations disagree (the first of 4 such edges): reverse"));
    const Defect strip = only_defect(shapes::moebius_strip());
    CHECK(strip.kind == DefectKind::orientation);
    CHECK(strip.count == 1);
    CHECK(strip.where.faces == Indices{0, 7});
    CHECK(strip.where.vertices == Indices{0, 1});
}

TEST_CASE("coordinates that are not finite are named by vertex and axis", "[mesh][defects]") {
    const Defect nan = only_defect(shapes::with_nan());
    CHECK(nan.kind == DefectKind::not_finite);
    CHECK(nan.where.vertices == Indices{5});
    CHECK(nan.message == "vertex 5 has y = nan, which is not finite: correct the coordinate");
    CHECK(only_defect(shapes::with_infinity()).message == "vertex 5 has y = -inf, which is not finite: correct the coordinate");
}

TEST_CASE("faces without area are listed but accepted, at any scale", "[mesh][defects]") {
    const auto shape = shapes::zero_area_face();
    const auto defects = find_defects(shape.mesh);
    REQUIRE(defects.size() == 1);
    CHECK(defects[0].kind == DefectKind::zero_area);
    CHECK(defects[0].count == 2);
    CHECK(defects[0].where.faces == Indices{0, 1});
    CHECK(build_topology(shape.mesh).face_count == 2);
    for (const double scale : {1e-150, 1.0, 1e150}) {
        CAPTURE(scale);
        CHECK(find_defects(shapes::transformed(shapes::cube(), scale, 0).mesh).empty());
        const auto line = shapes::make("line", {{0, 0, 0}, {scale, scale / 3, scale / 7}, {2 * scale, 2 * scale / 3, 2 * scale / 7}}, {{0, 1, 2}});
        CHECK(kinds(line.mesh) == std::vector<std::string>{"zero-area"});
    }
}

TEST_CASE("all defects of a mesh are found at once, those that refuse it first", "[mesh][defects]") {
    // face 0 index, 1 repeated, 2 short, 3..5 on edge 0-1, 6 and 7 run alike along 5-6, 8 touches 5 .. 7 at vertex 7 alone, 9 without area, vertex 11 not
    // finite
    std::vector<shapes::Point> points;
    for (int i = 0; i < 14; ++i) points.push_back({double(i), double(i * i), double(i * i * i)});
    points[11][2] = std::numeric_limits<double>::quiet_NaN();
    points[13] = points[12];
    const auto mesh =
        shapes::make("everything", points, {{0, 1, 99}, {2, 3, 2}, {4, 5}, {0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {5, 6, 7}, {5, 6, 8}, {7, 9, 10}, {12, 13, 10}})
            .mesh;
    CHECK(kinds(mesh) == std::vector<std::string>{"index-range", "repeated-vertex", "short-face", "edge-with-three-faces", "non-manifold-vertex", "orientation",
                                                  "not-finite", "zero-area"});
    for (const Defect& defect : find_defects(mesh)) {
        CAPTURE(defect.message);
        if (defect.kind == DefectKind::non_manifold_vertex) CHECK(defect.where.vertices == Indices{7, 10});
        else CHECK(defect.count == 1);
    }
    CHECK_THROWS_WITH(build_topology(mesh), Catch::Matchers::StartsWith("face 0 uses vertex 99"));
}

TEST_CASE("ten places are kept, all are counted", "[mesh][defects]") {
    std::vector<shapes::Face> faces;
    for (int i = 0; i < 25; ++i) faces.push_back({0, 1, 100 + i});
    const auto defects = find_defects(shapes::make("many", std::vector<shapes::Point>(2), faces).mesh);
    REQUIRE(defects.size() == 1);
    CHECK(defects[0].count == 25);
    CHECK(defects[0].where.vertices.size() == 10);
    CHECK(defects[0].where.faces == Indices{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    CHECK(defects[0].message == "face 0 uses vertex 100, the mesh has 2 (the first of 25 such corners): correct the index or remove the face");
}

TEST_CASE("offsets that do not fit the corners are refused, not followed", "[mesh][defects]") {
    PolygonMesh mesh = shapes::single_triangle().mesh;
    SECTION("past the end") { mesh.face_offsets = {0, 4}; }
    SECTION("falling") { mesh.face_offsets = {0, 5, 3}; }
    SECTION("negative") { mesh.face_offsets = {-1, 3}; }
    SECTION("too short") { mesh.face_offsets = {0}, mesh.face_vertices = {0, 1, 2}; }
    CHECK_FALSE(find_defects(mesh).empty());
    CHECK_THROWS_AS(build_topology(mesh), BadInput);
}

TEST_CASE("faces without area are found by their area against their extent, whatever the size of the model", "[mesh][defects][large]") {
    // Thin triangles: half the height over the width against 1e-14. Two in three have area; all others are listed, on all cores.
    for (const double size : {1e-170, 1e-60, 1.0, 1e60, 1e140}) {
        CAPTURE(size);
        std::vector<shapes::Point> points;
        std::vector<shapes::Face> faces;
        Index flat = 0;
        const double heights[] = {1e-15, 1.9e-14, 2.1e-14, 1e-13, 1e-12, 0.5};
        for (int i = 0; i < 40000; ++i) {
            const double height = heights[i % 6];
            flat += height / 2 < 1e-14;
            const int first = static_cast<int>(points.size());
            points.insert(points.end(), {{0, 0, 0}, {size, 0, 0}, {0, height * size, 0}});
            faces.push_back({first, first + 1, first + 2});
        }
        const auto shape = shapes::make("slivers", points, faces);
        for (const auto& defects : {find_defects(shape.mesh), find_defects_of_sound_mesh(shape.mesh)}) {
            REQUIRE(defects.size() == 1);
            CHECK(defects[0].kind == DefectKind::zero_area);
            CHECK(defects[0].count == flat);
            CHECK(defects[0].where.faces == std::vector<Index>{0, 1, 6, 7, 12, 13, 18, 19, 24, 25});
        }
    }
}
