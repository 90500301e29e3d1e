// SPDX-License-Identifier: BSD-3-Clause
// Meshes that the checks of input have to refuse.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tests/shapes/shapes.h"

namespace shapes {

namespace {

Shape with_position(std::string name, double value) {
    Shape shape = cube();
    shape.name = std::move(name);
    shape.mesh.positions[3 * 5 + 1] = value;
    return shape;
}

const std::vector<Point> five_points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};

}  // namespace

Shape face_with_index_out_of_range() {
    return make("face_with_index_out_of_range", points_of(tetrahedron().mesh), {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 905}});
}

Shape face_with_negative_index() { return make("face_with_negative_index", points_of(tetrahedron().mesh), {{0, 2, 1}, {0, -1, 3}, {0, 3, 2}}); }
Shape repeated_vertex_in_face() { return make("repeated_vertex_in_face", five_points, {{0, 1, 2}, {1, 4, 2, 3, 2}}); }
Shape two_sided_face() { return make("two_sided_face", five_points, {{0, 1, 2}, {2, 1, 4}, {3, 4}}); }
Shape edge_with_three_faces() { return make("edge_with_three_faces", five_points, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}); }
Shape bow_tie_vertex() { return make("bow_tie_vertex", five_points, {{0, 1, 2}, {2, 3, 4}}); }

Shape closed_bow_tie() {
    auto points = points_of(tetrahedron().mesh);
    auto faces = faces_of(tetrahedron().mesh);
    for (int v = 1; v < 4; ++v) points.push_back({2 - points[v][0], 2 - points[v][1], 2 - points[v][2]});
    for (Face face : faces_of(tetrahedron().mesh)) {
        for (int& v : face) v += v > 0 ? 3 : 0;
        std::reverse(face.begin(), face.end());  // a mirror image
        faces.push_back(face);
    }
    return make("closed_bow_tie", points, faces);
}

Shape inconsistent_orientation() {
    auto faces = faces_of(cube().mesh);
    std::reverse(faces[1].begin(), faces[1].end());
    return make("inconsistent_orientation", points_of(cube().mesh), faces);
}

// Vertices 2 i and 2 i + 1 are the ends of rung i; after the last quad the ends change places.
Shape moebius_strip() {
    const int rungs = 8;
    const double pi = std::acos(-1.0);
    std::vector<Point> points;
    std::vector<Face> faces;
    for (int i = 0; i < rungs; ++i) {
        const double around = 2 * pi * i / rungs;
        for (const double side : {-0.3, 0.3}) {
            const double r = 1 + side * std::cos(around / 2);
            points.push_back({r * std::cos(around), r * std::sin(around), side * std::sin(around / 2)});
        }
        const bool is_last = i + 1 == rungs;
        const int next = is_last ? 0 : 2 * (i + 1);
        faces.push_back({2 * i, is_last ? next + 1 : next, is_last ? next : next + 1, 2 * i + 1});
    }
    return make("moebius_strip", points, faces);
}

Shape with_nan() { return with_position("with_nan", std::numeric_limits<double>::quiet_NaN()); }
Shape with_infinity() { return with_position("with_infinity", -std::numeric_limits<double>::infinity()); }
Shape no_faces() { return make("no_faces", five_points, {}); }
Shape zero_area_face() { return make("zero_area_face", {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}, {2, 1, 3}}); }

}  // namespace shapes
