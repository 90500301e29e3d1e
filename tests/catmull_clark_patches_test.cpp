// SPDX-License-Identifier: BSD-3-Clause
// Catmull-Clark patches: control points, kinds and places against refined meshes and their limit points.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "tests/modes_support.h"
#include "tests/oracle/limit.h"
#include "tests/patch_checks.h"
#include "tests/shapes/shapes.h"

using namespace lcl;
using Vector = Eigen::RowVector3d;

namespace {

SchemeOptions catmull_clark(double alpha = 0) {
    SchemeOptions options;
    options.alpha = alpha;
    return options;
}

/// A mesh with the table of its surface.
struct Surface {
    shapes::Shape shape;
    Topology topology;
    Features features;
    PatchTable table;
    std::vector<double> control;

    explicit Surface(const shapes::Shape& shape_, double alpha = 0) : shape(shape_) {
        topology = build_topology(shape.mesh);
        features = find_features(shape.mesh, topology, shape.features);
        table.point_count = shape.mesh.vertex_count;
        add_catmull_clark_patches(topology, features, catmull_clark(alpha), table);
        control = control_points(table, shape.mesh.positions, 3);
    }

    PatchPlace find(Index face, Index corner, double u, double v) const {
        const double uv[2] = {u, v};
        PatchPlace place;
        locate_catmull_clark(table, {1, &face, &corner, uv}, 0, 1, &place);
        return place;
    }
    std::vector<Vector> jet(Index face, Index corner, double u, double v) const {
        std::vector<Vector> rows;
        for (const auto& row : reference_jet(table, control, find(face, corner, u, v))) rows.push_back(Vector(row[0], row[1], row[2]));
        return rows;
    }
};

/// A vertex with k quads, vertex 0, in an open fan: a boundary with k faces, or a corner.
shapes::Shape fan(int k, bool is_corner) {
    std::vector<shapes::Point> points{{0, 0, 0.3}};
    std::vector<shapes::Face> faces;
    for (int i = 0; i <= 2 * k; ++i) points.push_back({std::cos(0.7 * i), std::sin(0.7 * i), 0.2 * i});
    for (int i = 0; i < k; ++i) faces.push_back({0, 1 + 2 * i, 2 + 2 * i, 3 + 2 * i});
    auto shape = shapes::make("fan_" + std::to_string(k) + (is_corner ? "_corner" : ""), points, faces);
    shape.features.boundary = BoundaryRule::edge_only;
    if (is_corner) shape.features.corners = {0};
    return shape;
}

/// A closed ring of n quads round vertex 0 with creases along some of its edges.
shapes::Shape ring(int n, const std::vector<int>& sharp_edges, bool is_corner) {
    auto shape = shapes::disk_pole_quads(n);
    shape.name += is_corner ? "_corner" : "";
    for (const int j : sharp_edges) {
        shape.features.creases.push_back({0, 1 + 2 * j});
        shape.name += "_crease_" + std::to_string(j);
    }
    if (is_corner) shape.features.corners = {0};
    return shapes::rough(shape, 0.1, 5);
}

std::vector<shapes::Shape> every_kind() {
    std::vector<shapes::Shape> list;
    for (int n = 3; n <= 12; ++n) list.push_back(ring(n, {}, false));
    for (int k = 1; k <= 5; ++k) list.push_back(fan(k, false));
    for (int k = 1; k <= 3; ++k) list.push_back(fan(k, true));
    for (const int n : {3, 4, 5}) list.push_back(ring(n, {0}, false));                                         // darts
    for (const int n : {3, 4}) list.push_back(ring(n, {}, true));                                              // corners without sharp edges
    list.push_back(ring(4, {1}, true));                                                                        // with one
    for (const auto& sharp : {std::vector<int>{0, 2}, {0, 1}, {1, 4}}) list.push_back(ring(5, sharp, false));  // creases
    list.push_back(ring(6, {0, 1, 3}, false));                                                                 // a corner of three sectors
    return list;
}

std::vector<shapes::Shape> meshes() {
    using namespace shapes;
    return {cube(),
            torus_quads(4, 5),
            grid_quads(3, 2),
            cylinder_open(5, 3),
            valence_2_pole(),
            cube_with_crease(),
            cube_with_dart(),
            torus_with_dart(),
            tetrahedron(),
            single_triangle(),
            single_hexagon(),
            disk_pole_triangles(5),
            cube_with_crease_loop(),
            grid_with_marked_corner(),
            polygons_mixed(16, 3),
            with_isolated_vertex(cube(), 3),
            grid_with_hole(),
            two_components()};
}

/// Limit points of some vertices, evenly spread, and of the first ones, which are the mesh's own.
void check_positions(const Surface& surface, double alpha, int levels, int wanted) {
    std::vector<SurfaceLocation> locations;
    const Refinement refined = refine(surface.shape.mesh, surface.shape.features, catmull_clark(alpha), levels, &locations);
    const oracle::Surface fine = oracle::make_surface(refined.mesh, refined.features);
    const Eigen::MatrixXd points = oracle::positions(refined.mesh);
    const Index step = std::max(1, refined.mesh.vertex_count / wanted);
    double largest = 0;
    for (Index v = 0; v < refined.mesh.vertex_count; v += step) {
        const SurfaceLocation& at = locations[v];
        if (at.face < 0) continue;
        const Vector limit = oracle::limit_row(fine, catmull_clark(), v) * points;
        const double error = (surface.jet(at.face, at.corner, at.u, at.v)[0] - limit).norm();
        if (error > largest) largest = error;
    }
    // Points of size 1, sums of a few hundred rounded terms.
    CHECK(largest < 1e-13);
}

/// Vertices of a refined mesh by where they lie on the mesh.
using VertexAt = std::map<std::tuple<Index, Index, double, double>, Index>;

/// In the middle of a face (or sub-quad) the refined mesh is a regular grid: first and second derivatives of the bicubic spline at its points.
void check_derivatives(const Surface& surface, double alpha, int levels) {
    std::vector<SurfaceLocation> locations;
    const Refinement refined = refine(surface.shape.mesh, surface.shape.features, catmull_clark(alpha), levels, &locations);
    const Eigen::MatrixXd points = oracle::positions(refined.mesh);
    VertexAt vertex_at;
    for (Index v = 0; v < refined.mesh.vertex_count; ++v) vertex_at[{locations[v].face, locations[v].corner, locations[v].u, locations[v].v}] = v;
    const bool all_quads = surface.topology.uniform_degree == 4;
    int checked = 0;
    double largest = 0;
    for (const auto& [key, middle] : vertex_at) {
        const SurfaceLocation& at = locations[middle];
        if (at.face < 0) continue;
        const double h = std::ldexp(1.0, -levels + (surface.shape.mesh.degree(at.face) == 4 ? 0 : 1));
        Eigen::Matrix<double, 9, 3> grid;
        bool is_inside = at.u >= 2 * h && at.v >= 2 * h;  // the ring of an old vertex is not regular
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
                const auto found = vertex_at.find({at.face, at.corner, at.u + (i - 1) * h, at.v + (j - 1) * h});
                if (found == vertex_at.end()) is_inside = false;
                else grid.row(3 * j + i) = points.row(found->second);
            }
        if (!is_inside) continue;
        ++checked;
        const Eigen::RowVector3d b(1.0 / 6, 4.0 / 6, 1.0 / 6), d(-0.5, 0, 0.5), dd(1, -2, 1);
        const auto spline = [&](const Eigen::RowVector3d& across, const Eigen::RowVector3d& along) {
            Vector sum = Vector::Zero();
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i) sum += across[j] * along[i] * grid.row(3 * j + i);
            return sum;
        };
        const std::vector<Vector> expected{spline(b, b),           spline(b, d) / h,       spline(d, b) / h, spline(b, dd) / (h * h),
                                           spline(d, d) / (h * h), spline(dd, b) / (h * h)};
        const std::vector<Vector> found = surface.jet(at.face, at.corner, at.u, at.v);
        for (int q = 0; q < 6; ++q) largest = std::max(largest, (found[q] - expected[q]).norm());
    }
    CHECK(checked >= (all_quads ? 1 : 0));
    // Second derivatives of size 10 from differences of points of size 1 over h^2.
    CHECK(largest < 1e-15 * std::ldexp(32.0, 2 * levels));
}

/// (corner, u, v) of the point at x in [0, 1] of the way along edge k of a face.
struct OnFace {
    Index corner;
    double u, v;
};
OnFace on_edge(int degree, int k, double x) {
    if (degree == 4) return std::array<OnFace, 4>{OnFace{0, x, 0}, {0, 1, x}, {0, 1 - x, 1}, {0, 0, 1 - x}}[k];
    return x <= 0.5 ? OnFace{k, 2 * x, 0} : OnFace{(k + 1) % degree, 0, 2 * (1 - x)};
}

Vector normal(const std::vector<Vector>& jet) { return jet[1].cross(jet[2]).normalized(); }

void check_continuity(const Surface& surface) {
    const Topology& topology = surface.topology;
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
        const Index twin = topology.twin[h];
        if (twin < h) continue;
        for (const double x : {0.0, 0.0625, 0.25, 0.45, 0.75, 1 - 1e-3, 1.0}) {
            const auto jet_of = [&](Index side, double at) {
                const Index face = topology.half_edge_face[side];
                const OnFace place = on_edge(topology.degree(face), side - topology.face_offsets[face], at);
                return surface.jet(face, place.corner, place.u, place.v);
            };
            const auto here = jet_of(h, x), there = jet_of(twin, 1 - x);
            REQUIRE((here[0] - there[0]).norm() < 1e-13);
            if (surface.features.edge_is_sharp[topology.half_edge_edge[h]] || x == 0 || x == 1) continue;
            REQUIRE((normal(here) - normal(there)).norm() < 1e-9);
        }
    }
}

}  // namespace

TEST_CASE("Catmull-Clark patches pass through the limit points of refined meshes", "[evaluate][catmull-clark]") {
    for (const double alpha : {0.0, 0.5})
        for (const auto& shape : meshes()) {
            CAPTURE(shape.name, alpha);
            const Surface surface(shape, alpha);
            for (const int levels : {1, 2, 3}) check_positions(surface, alpha, levels, 24);
        }
}

TEST_CASE("patches of every kind pass through limit points and have the grid's derivatives", "[evaluate][catmull-clark]") {
    for (const auto& shape : every_kind()) {
        CAPTURE(shape.name);
        const Surface surface(shape);
        check_positions(surface, 0, 3, 40);
        check_derivatives(surface, 0, 3);
    }
}

TEST_CASE("Catmull-Clark patches deep at their tip are those of the refined mesh", "[evaluate][catmull-clark]") {
    // Three explicit refinements against three more powers of the kind's step: (u, v) of a face is (8u, 8v) of its child at the first corner.
    for (const auto& shape : every_kind()) {
        const Refinement refined = refine(shape.mesh, shape.features, catmull_clark(), 3);
        const patches::Surface surface(shape, catmull_clark()), fine({shape.name, refined.mesh, refined.features}, catmull_clark());
        for (Index face = 0; face < shape.mesh.face_count(); ++face) {
            for (const double scale : {0.1, 1e-3, 1e-6}) {
                for (const auto& [u, v] : {std::array<double, 2>{0.9, 0.1}, {0.7, 0.8}, {0.2, 0.8}, {0, 0.6}}) {
                    const patches::Jet whole = surface.jet({face, 0, scale * u, scale * v});
                    const patches::Jet child = patches::turned(fine.jet({64 * face, 0, 8 * scale * u, 8 * scale * v}), 8, 0, 0, 8);
                    if (patches::is_same(whole, child, scale)) continue;
                    CAPTURE(shape.name, face, scale, u, v);
                    REQUIRE(whole == child);
                }
            }
        }
    }
}

TEST_CASE("Catmull-Clark derivatives are those of the grid inside of faces", "[evaluate][catmull-clark]") {
    for (const auto& shape : meshes()) {
        CAPTURE(shape.name);
        check_derivatives(Surface(shape, 0.5), 0.5, 4);
    }
}

TEST_CASE("Catmull-Clark surfaces are continuous, and smooth but for creases", "[evaluate][catmull-clark]") {
    auto list = meshes();
    const auto kinds = every_kind();
    list.insert(list.end(), kinds.begin(), kinds.end());
    for (const auto& shape : list) {
        CAPTURE(shape.name);
        check_continuity(Surface(shape));
    }
}

TEST_CASE("rows of Catmull-Clark patches are affine and use what there is", "[evaluate][catmull-clark]") {
    auto list = meshes();
    const auto kinds = every_kind();
    list.insert(list.end(), kinds.begin(), kinds.end());
    for (const auto& shape : list) {
        CAPTURE(shape.name);
        const Surface surface(shape);
        const PatchTable& table = surface.table;
        const bool all_quads = surface.topology.uniform_degree == 4;
        CHECK(table.levels() == (all_quads ? 1 : 2));
        CHECK(table.patch_count() == surface.topology.half_edge_count() * (all_quads ? 1 : 4));
        for (const double x : control_points(table, std::vector<double>(table.point_count, 1.0), 1)) REQUIRE(std::abs(x - 1) < 1e-14);
        std::set<std::int32_t> used;
        std::vector<char> ghost_is_used(table.control_count() - table.refined_count(), 0);
        for (Index p = 0; p < table.patch_count(); ++p) {
            const Index size = table.patch_begin[p + 1] - table.patch_begin[p];
            REQUIRE(size == (table.kind[p] < 0 ? 16 : table.kinds[table.kind[p]].point_count));
            if (table.kind[p] >= 0) used.insert(table.kind[p]);
            for (Index i = table.patch_begin[p]; i < table.patch_begin[p + 1]; ++i) {
                REQUIRE((table.control[i] >= 0 && table.control[i] < table.control_count()));
                if (table.control[i] >= table.refined_count()) ghost_is_used[table.control[i] - table.refined_count()] = 1;
            }
        }
        CHECK(used.size() == table.kinds.size());
        CHECK(std::count(ghost_is_used.begin(), ghost_is_used.end(), 0) == 0);
        for (const PatchKind& kind : table.kinds) modes_support::check_kind(kind);
    }
}

TEST_CASE("regular patches need no kinds, and neighbours share their ghost points", "[evaluate][catmull-clark]") {
    const Surface torus(shapes::torus_quads(4, 5));
    CHECK(torus.table.kinds.empty());
    CHECK(torus.table.control_count() == torus.table.refined_count());
    // A sheet of 3 by 2 quads under edge-and-corner: corners of one face, curves of two. One ghost a point of the refined boundary, and one a corner more each
    // way.
    const Surface sheet(shapes::grid_quads(3, 2));
    CHECK(sheet.table.kinds.empty());
    CHECK(sheet.table.control_count() - sheet.table.refined_count() == 2 * (3 + 2) * 2 + 4 + 4);
}

TEST_CASE("places are found by arithmetic: quarters of quads and of sub-quads, turned", "[evaluate][catmull-clark]") {
    const Surface quads(shapes::cube());
    const auto check = [](const PatchPlace& place, Index patch, double s, double t, std::int32_t turn) {
        CAPTURE(place.patch, place.s, place.t, place.turn);
        CHECK((place.patch == patch && place.s == s && place.t == t && place.turn == turn));
    };
    check(quads.find(2, 0, 0.125, 0.25), 8, 0.25, 0.5, 0);
    check(quads.find(2, 0, 0.875, 0.125), 9, 0.25, 0.25, 1);
    check(quads.find(2, 0, 0.75, 0.875), 10, 0.5, 0.25, 2);
    check(quads.find(2, 0, 0.125, 0.75), 11, 0.5, 0.25, 3);
    check(quads.find(0, 0, 1, 1), 2, 0, 0, 2);
    // Triangles: child `corner` of the first refinement, then its quarter.
    const Surface triangles(shapes::tetrahedron());
    check(triangles.find(1, 2, 0.125, 0.25), 4 * 5, 0.25, 0.5, 0);
    check(triangles.find(1, 2, 0.875, 0.125), 4 * 5 + 1, 0.25, 0.25, 1);
    // Quads among other faces: two quarters, turns add up.
    const Surface prism(shapes::triangular_prism());
    Index quad = 0;
    while (prism.shape.mesh.degree(quad) != 4) ++quad;
    const Index first = prism.shape.mesh.face_offsets[quad];
    check(prism.find(quad, 0, 0.125, 0.0625), 4 * first, 0.5, 0.25, 4);
    check(prism.find(quad, 0, 0.9375, 0.375), 4 * (first + 1) + 1, 0.25, 0.5, 6);
    CHECK((prism.table.turns[4].su == 4 && prism.table.turns[1].tu == -2));
}

TEST_CASE("places that do not exist are named", "[evaluate][catmull-clark]") {
    using Catch::Matchers::Contains;
    const Surface cube(shapes::cube()), hexagon(shapes::single_hexagon());
    const auto find = [](const Surface& surface, Index face, Index corner, double u, double v) {
        // The third of four places, the others being good.
        const std::vector<Index> faces{0, 0, face, 0}, corners{0, 0, corner, 0};
        const std::vector<double> uv{0.5, 0.5, 0, 1, u, v, 1, 0};
        std::vector<PatchPlace> out(4);
        locate_catmull_clark(surface.table, {4, faces.data(), corners.data(), uv.data()}, 0, 4, out.data());
    };
    find(cube, 5, 0, 1, 0);
    find(hexagon, 0, 5, 1, 0);
    CHECK_THROWS_WITH(find(cube, 6, 0, 0, 0), "place 2: face 6 does not exist, the mesh has 6 faces (0 to 5)");
    CHECK_THROWS_WITH(find(hexagon, -1, 0, 0, 0), Contains("face -1 does not exist, the mesh has 1 face (0)"));
    CHECK_THROWS_WITH(find(cube, 3, 1, 0, 0), Contains("place 2: corner 1 of face 3 does not exist: on a quad the corner is 0"));
    CHECK_THROWS_WITH(find(hexagon, 0, 6, 0, 0), Contains("corner 6 of face 0 does not exist, it has 6 corners (0 to 5)"));
    CHECK_THROWS_WITH(find(hexagon, 0, -1, 0, 0), Contains("corner -1"));
    CHECK_THROWS_WITH(find(cube, 0, 0, 1.25, 0), Contains("place 2: (u, v) = (1.25, 0) does not lie on face 0: both run from 0 to 1"));
    for (const double bad : {-1e-300, 1 + 1e-15, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        CHECK_THROWS_AS(find(cube, 0, 0, bad, 0), BadInput);
        CHECK_THROWS_AS(find(hexagon, 0, 0, 0, bad), BadInput);
    }
}
