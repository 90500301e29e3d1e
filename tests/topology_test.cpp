// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "host/mesh/topology.h"
#include "tests/shapes/shapes.h"

using namespace lcl;

namespace {

Index loop_count(const Topology& topology) { return static_cast<Index>(boundary_loops(topology).size()); }

Index used_vertices(const Topology& topology) {
    return static_cast<Index>(std::count_if(topology.vertex_half_edge.begin(), topology.vertex_half_edge.end(), [](Index h) { return h >= 0; }));
}

/// A torus of m by n quads; with m or n = 2 its faces meet in more than one edge.
PolygonMesh torus(int m, int n) {
    std::vector<shapes::Point> points;
    std::vector<shapes::Face> faces;
    for (int i = 0; i < m; ++i) {
        for (int j = 0; j < n; ++j) {
            points.push_back({double(i), double(j), double(i * j)});
            const int i2 = (i + 1) % m, j2 = (j + 1) % n;
            faces.push_back({i * n + j, i2 * n + j, i2 * n + j2, i * n + j2});
        }
    }
    return shapes::make("torus", points, faces).mesh;
}

/// Meshes that all cores share: of quads, of triangles with a boundary, of polygons, with isolated vertices, and poles of few and of many faces.
std::vector<shapes::Shape> large_shapes() {
    return {shapes::torus_quads(300, 200),
            shapes::shuffled(shapes::torus_triangles(250, 150), 1),
            shapes::shuffled(shapes::grid_triangles(200, 190), 2),
            shapes::with_isolated_vertex(shapes::with_isolated_vertex(shapes::grid_quads(210, 200), 0), 30000),
            shapes::shuffled(shapes::polygons_mixed(36000, 3), 4),
            shapes::combined(shapes::disk_pole_triangles(20000), shapes::disk_pole_quads(9)),
            shapes::combined(shapes::torus_quads(200, 170), shapes::disk_pole_quads(70))};
}

/// Twins by looking each half-edge up in the other direction.
std::vector<Index> plain_twins(const PolygonMesh& mesh) {
    std::map<std::pair<Index, Index>, Index> from_to;
    std::vector<std::pair<Index, Index>> ends;
    for (Index f = 0; f < mesh.face_count(); ++f)
        for (Index k = 0; k < mesh.degree(f); ++k) {
            const Index *corners = &mesh.face_vertices[mesh.face_offsets[f]], next = (k + 1) % mesh.degree(f);
            from_to[{corners[k], corners[next]}] = static_cast<Index>(ends.size());
            ends.emplace_back(corners[k], corners[next]);
        }
    std::vector<Index> twins;
    for (const auto& [a, b] : ends) {
        const auto found = from_to.find({b, a});
        twins.push_back(found == from_to.end() ? -1 : found->second);
    }
    return twins;
}

template <class Numbers>
std::vector<Index> list(const Numbers& numbers) {
    return {numbers.begin(), numbers.end()};
}

}  // namespace

TEST_CASE("the topology that all cores build equals a plain construction", "[mesh][topology][large]") {
    for (const auto& shape : large_shapes()) {
        CAPTURE(shape.name);
        const Topology topology = build_topology(shape.mesh);
        const std::vector<Index> twins = plain_twins(shape.mesh);
        REQUIRE(list(topology.twin) == twins);
        CHECK(topology.boundary_edge_count == std::count(twins.begin(), twins.end(), -1));
        std::vector<Index> first(shape.mesh.vertex_count, -1), faces(shape.mesh.vertex_count, 0), edge(twins.size()), edge_half_edge;
        for (Index h = 0; h < static_cast<Index>(twins.size()); ++h) {
            Index& chosen = first[shape.mesh.face_vertices[h]];
            if (chosen < 0 || twins[h] < 0) chosen = h;
            ++faces[shape.mesh.face_vertices[h]];
            edge[h] = twins[h] >= 0 && twins[h] < h ? edge[twins[h]] : static_cast<Index>(edge_half_edge.size());
            if (edge[h] == static_cast<Index>(edge_half_edge.size())) edge_half_edge.push_back(h);
        }
        CHECK(list(topology.vertex_half_edge) == first);
        CHECK(list(topology.vertex_face_count) == faces);
        CHECK(list(topology.half_edge_edge) == edge);
        CHECK(list(topology.edge_half_edge) == edge_half_edge);
        CHECK(list(topology.face_vertices) == shape.mesh.face_vertices);
        CHECK(list(topology.face_offsets) == shape.mesh.face_offsets);
    }
}

TEST_CASE("a vertex's fan is what rotating gives", "[mesh][topology][large]") {
    std::vector<shapes::Shape> all = shapes::all_shapes(), large = large_shapes();
    all.insert(all.end(), large.begin(), large.end());
    for (const auto& shape : all) {
        CAPTURE(shape.name);
        const Topology topology = build_topology(shape.mesh);
        std::vector<Index> walked, offsets{0};
        for (Index v = 0; v < topology.vertex_count; ++v) {
            Index h = topology.vertex_half_edge[v];
            for (Index i = 0; i < topology.vertex_face_count[v]; ++i, h = topology.rotate(h)) walked.push_back(h);
            offsets.push_back(static_cast<Index>(walked.size()));
        }
        CHECK(list(topology.fan_half_edges) == walked);
        CHECK(list(topology.fan_offsets) == offsets);
    }
}

TEST_CASE("all faces' degree is known where it is one", "[mesh][topology]") {
    CHECK(build_topology(shapes::torus_quads(4, 5).mesh).uniform_degree == 4);
    CHECK(build_topology(shapes::grid_triangles(3, 3).mesh).uniform_degree == 3);
    CHECK(build_topology(shapes::dodecahedron().mesh).uniform_degree == 5);
    CHECK(build_topology(shapes::triangular_prism().mesh).uniform_degree == 0);
}

TEST_CASE("one bad place is found anywhere in a large mesh", "[mesh][topology][large][refused]") {
    const PolygonMesh sound = shapes::torus_quads(300, 200).mesh;
    for (const Index f : {Index{0}, Index{29999}, Index{30000}, Index{59999}}) {
        CAPTURE(f);
        struct Damage {
            DefectKind kind;
            std::function<void(PolygonMesh&)> make;
        };
        const auto corners = [&](PolygonMesh& mesh) { return &mesh.face_vertices[4 * f]; };
        const auto add_face = [](PolygonMesh& mesh, std::initializer_list<Index> face) {
            mesh.face_vertices.insert(mesh.face_vertices.end(), face);
            mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
        };
        const Damage damages[] = {
            {DefectKind::index_range, [&](PolygonMesh& mesh) { corners(mesh)[2] = mesh.vertex_count; }},
            {DefectKind::index_range, [&](PolygonMesh& mesh) { corners(mesh)[1] = -1; }},
            {DefectKind::repeated_vertex, [&](PolygonMesh& mesh) { corners(mesh)[3] = corners(mesh)[1]; }},
            {DefectKind::not_finite, [&](PolygonMesh& mesh) { mesh.positions[3 * f + 2] = std::nan(""); }},
            {DefectKind::orientation, [&](PolygonMesh& mesh) { std::reverse(corners(mesh), corners(mesh) + 4); }},
            {DefectKind::edge_with_three_faces,
             [&](PolygonMesh& mesh) {
                 mesh.vertex_count += 1;
                 mesh.positions.insert(mesh.positions.end(), {0, 0, 0});
                 add_face(mesh, {corners(mesh)[0], corners(mesh)[1], mesh.vertex_count - 1});
             }},
            {DefectKind::non_manifold_vertex,
             [&](PolygonMesh& mesh) {
                 mesh.vertex_count += 2;
                 mesh.positions.insert(mesh.positions.end(), 6, 0.0);
                 add_face(mesh, {corners(mesh)[0], mesh.vertex_count - 2, mesh.vertex_count - 1});
             }},
        };
        for (const Damage& damage : damages) {
            PolygonMesh mesh = sound;
            damage.make(mesh);
            const std::vector<Defect> defects = find_defects(mesh);
            REQUIRE(!defects.empty());
            CHECK(defects[0].kind == damage.kind);
            CHECK_THROWS_WITH(build_topology(mesh), defects[0].message);
            CHECK(!topology_if_sound(mesh));
        }
    }
}

TEST_CASE("two fans of many faces at one vertex are refused, however their half-edges are numbered", "[mesh][topology][refused]") {
    for (const int faces : {1, 3, 4, 9, 100}) {
        std::vector<shapes::Face> both;
        for (int fan = 0; fan < 2; ++fan)
            for (int i = 0; i < faces; ++i) {
                const int first = 1 + fan * (faces + 1) + i;
                both.push_back({0, first, first + 1});
            }
        const auto shape = shapes::make("two fans", std::vector<shapes::Point>(2 * faces + 3), both);
        CAPTURE(faces);
        for (const int seed : {0, 1, 2}) CHECK(find_defects(shapes::shuffled(shape, seed).mesh).front().kind == DefectKind::non_manifold_vertex);
    }
}

TEST_CASE("two quads side by side have the half-edges worked out by hand", "[mesh][topology]") {
    // 3 -- 4 -- 5     half-edges 0: 0-1, 1: 1-4, 2: 4-3, 3: 3-0
    // |    |    |                4: 1-2, 5: 2-5, 6: 5-4, 7: 4-1
    // 0 -- 1 -- 2
    const auto mesh = shapes::make("two quads", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}, {{0, 1, 4, 3}, {1, 2, 5, 4}}).mesh;
    const Topology topology = build_topology(mesh);
    CHECK(topology.edge_count == 7);
    CHECK(topology.twin == Array<Index>{-1, 7, -1, -1, -1, -1, -1, 1});
    CHECK(topology.half_edge_edge == Array<Index>{0, 1, 2, 3, 4, 5, 6, 1});
    CHECK(topology.edge_half_edge == Array<Index>{0, 1, 2, 3, 4, 5, 6});
    CHECK(topology.half_edge_face == Array<Index>{0, 0, 0, 0, 1, 1, 1, 1});
    CHECK(topology.vertex_half_edge == Array<Index>{0, 4, 5, 3, 2, 6});
    CHECK(topology.vertex_face_count == Array<Index>{1, 2, 1, 1, 2, 1});
    CHECK(topology.rotate(4) == 1);
    CHECK(topology.rotate(1) == -1);
    CHECK(topology.valence(1) == 3);
    CHECK(topology.valence(0) == 2);
    const auto loops = boundary_loops(topology);
    REQUIRE(loops.size() == 1);
    CHECK(loops[0] == std::vector<Index>{0, 4, 5, 6, 2, 3});
}

TEST_CASE("twins are opposite, edges numbered by first appearance, and every vertex walks through all of its faces", "[mesh][topology]") {
    for (const auto& shape : shapes::all_shapes()) {
        CAPTURE(shape.name);
        const Topology topology = build_topology(shape.mesh);
        std::set<std::pair<Index, Index>> seen;
        Index next_edge = 0;
        for (Index h = 0; h < topology.half_edge_count(); ++h) {
            const Index a = topology.origin(h), b = topology.destination(h), twin = topology.twin[h];
            REQUIRE(topology.next(topology.previous(h)) == h);
            REQUIRE(topology.half_edge_face[topology.next(h)] == topology.half_edge_face[h]);
            if (twin >= 0) {
                REQUIRE(topology.twin[twin] == h);
                REQUIRE(topology.origin(twin) == b);
                REQUIRE(topology.destination(twin) == a);
                REQUIRE(topology.half_edge_edge[twin] == topology.half_edge_edge[h]);
            }
            if (seen.insert(std::minmax(a, b)).second) {
                REQUIRE(topology.half_edge_edge[h] == next_edge);
                REQUIRE(topology.edge_half_edge[next_edge++] == h);
            }
        }
        CHECK(topology.edge_count == next_edge);
        for (Index v = 0; v < topology.vertex_count; ++v) {
            if (topology.is_isolated(v)) continue;
            std::set<Index> faces;
            Index h = topology.vertex_half_edge[v];
            do {
                REQUIRE(topology.origin(h) == v);
                faces.insert(topology.half_edge_face[h]);
                h = topology.rotate(h);
            } while (h >= 0 && h != topology.vertex_half_edge[v]);
            REQUIRE(static_cast<Index>(faces.size()) == topology.vertex_face_count[v]);
            REQUIRE((h < 0) == topology.is_boundary(v));
        }
    }
}

TEST_CASE("Euler characteristic, boundary loops and components of known surfaces", "[mesh][topology]") {
    struct Known {
        shapes::Shape shape;
        Index euler, loops, components;
    };
    const Known known[] = {
        {shapes::cube(), 2, 0, 1},
        {shapes::torus_quads(4, 5), 0, 0, 1},
        {shapes::hexagonal_torus(4, 4), 0, 0, 1},
        {shapes::single_hexagon(), 1, 1, 1},
        {shapes::grid_with_hole(), 0, 2, 1},
        {shapes::cylinder_open(6, 2), 0, 2, 1},
        {shapes::two_components(), 4, 0, 2},
        {shapes::icosphere_quads(1), 2, 0, 1},
        {shapes::random_triangle_mesh(300, 7), 2, 0, 1},
        {shapes::with_isolated_vertex(shapes::two_components(), 3), 4, 0, 2},
    };
    for (const auto& [shape, euler, loops, components] : known) {
        CAPTURE(shape.name);
        const Topology topology = build_topology(shape.mesh);
        CHECK(used_vertices(topology) - topology.edge_count + topology.face_count == euler);
        CHECK(loop_count(topology) == loops);
        Index count = -1;
        connected_components(topology, count);
        CHECK(count == components);
    }
}

TEST_CASE("boundary loops follow the boundary and hold each boundary half-edge once", "[mesh][topology]") {
    const Topology topology = build_topology(shapes::grid_with_hole().mesh);
    std::set<Index> met;
    for (const auto& loop : boundary_loops(topology)) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            CHECK(topology.twin[loop[i]] == -1);
            CHECK(met.insert(loop[i]).second);
            CHECK(topology.destination(loop[i]) == topology.origin(loop[(i + 1) % loop.size()]));
        }
    }
    CHECK(met.size() == 20 + 4);
}

TEST_CASE("components are numbered by their smallest vertex and isolated vertices have none", "[mesh][topology]") {
    // Faces 0: vertices 4 5 6, 1: vertices 0 2 3; vertex 1 is isolated.
    const auto mesh = shapes::make("pieces", std::vector<shapes::Point>(7), {{4, 5, 6}, {0, 2, 3}}).mesh;
    const Topology topology = build_topology(mesh);
    Index count = 0;
    CHECK(connected_components(topology, count) == std::vector<Index>{0, -1, 0, 0, 1, 1, 1});
    CHECK(count == 2);
    CHECK(topology.is_isolated(1));
    CHECK(topology.valence(1) == 0);
    CHECK_FALSE(topology.is_boundary(1));
}

TEST_CASE("the bounding box counts only vertices that a face uses", "[mesh][topology]") {
    auto shape = shapes::make("a triangle and a far vertex", {{0, 0, 0}, {3, 0, 0}, {3, 4, 12}, {1000, 0, 0}}, {{0, 1, 2}});
    CHECK(bounding_box_diagonal(shape.mesh) == Approx(13).epsilon(1e-15));
    CHECK(bounding_box_diagonal(shape.mesh, build_topology(shape.mesh)) == bounding_box_diagonal(shape.mesh));
    CHECK(bounding_box_diagonal(shapes::no_faces().mesh) == 0);
}

TEST_CASE("small closed surfaces whose faces meet in several edges are connected rightly", "[mesh][topology]") {
    SECTION("two triangles back to back") {
        const Topology topology = build_topology(shapes::make("pillow", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}).mesh);
        CHECK(topology.edge_count == 3);
        CHECK(topology.twin == Array<Index>{4, 3, 5, 1, 0, 2});
        CHECK(topology.vertex_face_count == Array<Index>{2, 2, 2});
    }
    SECTION("a torus of 3 by 3 quads") {
        const Topology topology = build_topology(torus(3, 3));
        CHECK(topology.edge_count == 18);
        CHECK(std::count(topology.twin.begin(), topology.twin.end(), -1) == 0);
    }
    SECTION("a torus of 2 by 3 quads has edges with the same ends and is refused") {
        // The edges between the rows 0 and 1 join the same vertices twice: four half-edges each.
        CHECK_THROWS_WITH(build_topology(torus(2, 3)), Catch::Matchers::Contains("edge 0-3 belongs to 4 faces (0, 2, 3, 5)"));
        CHECK_THROWS_AS(build_topology(torus(2, 2)), BadInput);
    }
    SECTION("the same face twice is refused") {
        CHECK_THROWS_WITH(build_topology(shapes::make("doubled", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}}).mesh),
                          Catch::Matchers::Contains("run along edge 0-1 in the same direction"));
    }
}

TEST_CASE("a pole with a hundred thousand faces takes linear time", "[mesh][topology]") {
    const int n = 100000;
    for (const bool pole_is_first : {true, false}) {
        std::vector<shapes::Face> faces;
        const int pole = pole_is_first ? 0 : n, ring = pole_is_first ? 1 : 0;
        for (int i = 0; i < n; ++i) faces.push_back({pole, ring + i, ring + (i + 1) % n});
        const Topology topology = build_topology(shapes::make("pole", std::vector<shapes::Point>(n + 1), faces).mesh);
        CHECK(topology.vertex_face_count[pole] == n);
        CHECK(topology.edge_count == 2 * n);
        CHECK(loop_count(topology) == 1);
    }
}

TEST_CASE("a mesh without faces is refused", "[mesh][topology]") {
    CHECK_THROWS_WITH(build_topology(shapes::no_faces().mesh), "the mesh has no faces: a surface needs at least one");
    CHECK_THROWS_AS(build_topology(PolygonMesh{}), BadInput);
}
