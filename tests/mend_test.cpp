// SPDX-License-Identifier: BSD-3-Clause
// What becomes of an engine's triangles: manifold, oriented alike, outwards; holes filled.
#include "host/points/mend.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/mesh/nearest_points.h"
#include "host/mesh/topology.h"
#include "host/mesh/volume.h"
#include "host/points/cloud.h"
#include "host/points/holes.h"
#include "tests/shapes/clouds.h"

using namespace lcl;

namespace {

RawTriangles raw_of(const shapes::Shape& shape) { return {shape.mesh.positions, shape.mesh.face_vertices}; }

void turn_every_third(RawTriangles& raw) {
    for (std::size_t t = 0; t < raw.triangles.size() / 3; t += 3) std::swap(raw.triangles[3 * t], raw.triangles[3 * t + 1]);
}

double enclosed_volume(const PolygonMesh& mesh) {
    double sum = 0;
    for (const double volume : component_volumes(mesh, build_topology(mesh), mesh.positions)) sum += volume;
    return sum;
}

int euler(const Topology& topology) { return topology.vertex_count - topology.edge_count + topology.face_count; }

std::string refusal(const PointCloud& cloud) {
    try {
        distinct_points(cloud);
    } catch (const BadInput& failure) {
        return failure.what();
    }
    return "";
}

using Catch::Matchers::Contains;

}  // namespace

TEST_CASE("triangles that are a mesh stay as they are", "[mend]") {
    const shapes::Shape shape = shapes::icosphere(2);
    const MendedMesh out = mend(raw_of(shape), "known");
    CHECK(out.dropped_faces == 0);
    CHECK(out.split_vertices == 0);
    CHECK(out.mesh.face_vertices == shape.mesh.face_vertices);
    CHECK(out.mesh.positions == shape.mesh.positions);
    for (Index v = 0; v < out.mesh.vertex_count; ++v) CHECK(out.source[v] == v);
}

TEST_CASE("neighbouring triangles come to run against each other, and closed parts outwards", "[mend]") {
    for (const shapes::Shape& shape : {shapes::icosphere(2), shapes::torus_triangles(9, 7)}) {
        RawTriangles raw = raw_of(shape);
        turn_every_third(raw);
        MendedMesh out = mend(raw, "known");
        CHECK(out.dropped_faces == 0);
        for (const bool inside_out : {false, true}) {
            if (inside_out)
                for (std::size_t t = 0; t < out.mesh.face_vertices.size(); t += 3) std::swap(out.mesh.face_vertices[t], out.mesh.face_vertices[t + 1]);
            orient(out.mesh, {});
            const Topology topology = build_topology(out.mesh);  // refuses edges that run alike
            CHECK(topology.is_closed());
            CHECK(euler(topology) == euler(build_topology(shape.mesh)));
            CHECK(enclosed_volume(out.mesh) > 0);
        }
    }
}

TEST_CASE("degenerate, double and third triangles are dropped", "[mend]") {
    RawTriangles raw = raw_of(shapes::octahedron());
    const std::vector<Index> sound = raw.triangles;
    const Index a = sound[0], b = sound[1], c = sound[2];
    raw.points.insert(raw.points.end(), {0, 0, 9});
    const Index far = static_cast<Index>(raw.points.size() / 3) - 1;
    raw.triangles.insert(raw.triangles.end(), {a, a, b, c, b, a, a, b, far});
    const MendedMesh out = mend(raw, "known");
    CHECK(out.dropped_faces == 3);
    CHECK(out.mesh.face_vertices == sound);
    CHECK(out.mesh.vertex_count == far);  // which no triangle uses now
}

TEST_CASE("parts that touch in a point are separated there", "[mend]") {
    // Two tetrahedra with one vertex in common.
    const RawTriangles raw{{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1},
                           {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 0, 5, 4, 0, 4, 6, 0, 6, 5, 4, 5, 6}};
    MendedMesh out = mend(raw, "known");
    CHECK(out.split_vertices == 1);
    CHECK(out.mesh.vertex_count == 8);
    CHECK(std::count(out.source.begin(), out.source.end(), 0) == 2);
    orient(out.mesh, {});
    Index parts = 0;
    connected_components(build_topology(out.mesh), parts);
    CHECK(parts == 2);
    CHECK(enclosed_volume(out.mesh) == Approx(2.0 / 6));
}

TEST_CASE("a one-sided band loses the triangle where it closes", "[mend]") {
    const int n = 12;
    std::vector<shapes::Point> points;
    for (int i = 0; i < n; ++i)
        for (const double side : {-0.3, 0.3}) {
            const double u = 2 * M_PI * i / n, r = 1 + side * std::cos(u / 2);
            points.push_back({r * std::cos(u), r * std::sin(u), side * std::sin(u / 2)});
        }
    std::vector<shapes::Face> faces;
    for (int i = 0; i < n; ++i) {
        const int a = 2 * i, b = a + 1, c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
        faces.push_back({a, c, b});
        faces.push_back({b, c, d});
    }
    const MendedMesh out = mend(raw_of(shapes::make("band", points, faces)), "known");
    CHECK(out.dropped_faces >= 1);
    CHECK(out.dropped_faces <= 2);
    CHECK_NOTHROW(build_topology(out.mesh));
}

TEST_CASE("open parts are oriented by the normals of their points", "[mend]") {
    PolygonMesh mesh = shapes::wave_cloud(8).shape.mesh;
    std::vector<double> normals;
    for (Index v = 0; v < mesh.vertex_count; ++v) normals.insert(normals.end(), {0, 0, -1});
    const std::vector<Index> before = mesh.face_vertices;
    orient(mesh, normals);
    CHECK(mesh.face_vertices != before);
    for (double& value : normals) value = -value;
    orient(mesh, normals);
    CHECK(mesh.face_vertices == before);
}

TEST_CASE("numbers that an engine must not give are refused by its name", "[mend]") {
    RawTriangles raw = raw_of(shapes::octahedron());
    raw.triangles[4] = 6;
    CHECK_THROWS_WITH(mend(raw, "known"), Contains("engine known") && Contains("triangle 1") && Contains("vertex 6"));
    raw.triangles[4] = 0;
    raw.points[5] = NAN;
    CHECK_THROWS_WITH(mend(raw, "known"), Contains("vertex 1 is not finite"));
}

TEST_CASE("holes of few edges are filled, larger ones stay", "[mend][holes]") {
    PolygonMesh mesh = shapes::icosphere(2).mesh;
    // Takes away the faces round two vertices: a hole of five or six edges, and one of a face alone.
    const auto drop = [&](const auto& is_dropped) {
        PolygonMesh kept = mesh;
        kept.face_vertices.clear();
        kept.face_offsets = {0};
        for (Index f = 0; f < mesh.face_count(); ++f) {
            const Index* const corners = &mesh.face_vertices[3 * static_cast<std::size_t>(f)];
            if (is_dropped(f, corners)) continue;
            kept.face_vertices.insert(kept.face_vertices.end(), corners, corners + 3);
            kept.face_offsets.push_back(kept.corner_count());
        }
        mesh = kept;
    };
    const Index last = mesh.vertex_count - 1;
    drop([&](Index f, const Index* c) { return f == 0 || c[0] == last || c[1] == last || c[2] == last; });
    REQUIRE(boundary_loops(build_topology(mesh)).size() == 2);
    PolygonMesh small = mesh;
    CHECK(fill_holes(small, 3) == 1);
    CHECK(boundary_loops(build_topology(small)).size() == 1);
    CHECK(fill_holes(mesh, 6) == 2);
    const Topology topology = build_topology(mesh);
    CHECK(topology.is_closed());
    CHECK(euler(topology) == 2 + 1);  // the vertex in the middle of the larger hole is isolated
    CHECK(enclosed_volume(mesh) > 0);
}

TEST_CASE("a sheet is not closed on itself", "[mend][holes]") {
    PolygonMesh triangle{3, {0, 3}, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 0, 1, 0}}, square{4, {0, 3, 6}, {0, 1, 2, 0, 2, 3}, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}};
    CHECK(fill_holes(triangle, 10) == 0);
    CHECK(fill_holes(square, 10) == 0);
    CHECK(square.face_count() == 2);
}

TEST_CASE("a hole in a plane is filled without folds", "[mend][holes]") {
    PolygonMesh mesh = shapes::wave_cloud(9).shape.mesh;
    for (std::size_t v = 0; v < mesh.positions.size(); v += 3) mesh.positions[v + 2] = 0;
    PolygonMesh holed = mesh;
    holed.face_vertices.clear();
    holed.face_offsets = {0};
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const int i = f / 2 % 8, j = f / 16;
        if (i >= 3 && i < 5 && j >= 3 && j < 5) continue;
        holed.face_vertices.insert(holed.face_vertices.end(), &mesh.face_vertices[3 * static_cast<std::size_t>(f)],
                                   &mesh.face_vertices[3 * static_cast<std::size_t>(f)] + 3);
        holed.face_offsets.push_back(holed.corner_count());
    }
    CHECK(fill_holes(holed, 8) == 1);
    double area = 0;
    for (Index f = 0; f < holed.face_count(); ++f) {
        const auto at = [&](int k, int c) {
            return holed.positions[3 * static_cast<std::size_t>(holed.face_vertices[3 * static_cast<std::size_t>(f) + k]) + c];
        };
        const double twice = (at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) - (at(1, 1) - at(0, 1)) * (at(2, 0) - at(0, 0));
        CHECK(twice >= -1e-12);
        area += twice / 2;
    }
    CHECK(area == Approx(4));
}

TEST_CASE("points at the place of an earlier one are dropped, with their normals", "[cloud]") {
    PointCloud cloud;
    cloud.points = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0};
    cloud.normals = {0, 0, 2, 0, 0, 3, 0, 1, 0, 0, 4, 0, 5, 0, 0, 0, 6, 0};
    const DistinctPoints out = distinct_points(cloud);
    CHECK(out.duplicate_count == 2);
    CHECK(out.cloud.points == std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    CHECK(out.cloud.normals == std::vector<double>{0, 0, 1, 0, 0, 1, 0, 1, 0, 1, 0, 0});
}

TEST_CASE("clouds without a surface are refused in one sentence", "[cloud]") {
    PointCloud cloud;
    CHECK_THAT(refusal(cloud), Contains("no points"));
    cloud.points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    CHECK_THAT(refusal(cloud), Contains("3 points are too few"));
    for (int i = 0; i < 1000; ++i) cloud.points.insert(cloud.points.end(), {0, 1, 0});
    CHECK_THAT(refusal(cloud), Contains("3 different ones of 1003 points"));
    cloud.points.insert(cloud.points.end(), {1, 1, 0, 0.3, 0.2, 0});
    CHECK_THAT(refusal(cloud), Contains("in a plane"));
    for (std::size_t i = 0; i < cloud.points.size(); i += 3) cloud.points[i + 1] = 2 * cloud.points[i];
    cloud.points.insert(cloud.points.end(), {7, 14, 0, 8, 16, 0});
    CHECK_THAT(refusal(cloud), Contains("on a line"));
}

TEST_CASE("the nearest point is found for every place", "[cloud]") {
    const std::vector<double> points = shapes::icosphere(2).mesh.positions, queries = shapes::torus_triangles(7, 5).mesh.positions;
    std::vector<Index> all(points.size() / 3);
    std::iota(all.begin(), all.end(), 0);
    const std::vector<Index> nearest = nearest_points(points, all, queries);
    const auto square = [&](std::size_t q, std::size_t p) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c) sum += std::pow(queries[3 * q + c] - points[3 * p + c], 2);
        return sum;
    };
    for (std::size_t q = 0; q < nearest.size(); ++q)
        for (std::size_t p = 0; p < points.size() / 3; ++p) CHECK(square(q, static_cast<std::size_t>(nearest[q])) <= square(q, p));
}
