// SPDX-License-Identifier: BSD-3-Clause
// Rows of the limit operator against brute-force subdivision, and what holds for all of them.
#include <cmath>
#include <map>

#include <catch2/catch.hpp>

#include "host/operator/limit_rows.h"
#include "host/operator/suitability.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

// The oracle is right to 2e-14 a weight; a row of ours sums at most some 100 products, each rounded once.
constexpr double tolerance = 3e-14;
const double pi = std::acos(-1.0);

Eigen::MatrixXd rows_of(const Prepared& mesh, const SchemeOptions& scheme, const std::vector<std::uint8_t>& subset = {}) {
    const std::vector<std::uint8_t> owned;
    LimitRows rows(mesh.topology, mesh.features, scheme, subset, owned);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(mesh.vertex_count(), mesh.vertex_count());
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const LimitRow row = rows.row(v);
        for (std::size_t k = 0; k < row.columns.size(); ++k) a(v, row.columns[k]) += row.weights[k];
    }
    return a;
}

Eigen::MatrixXd oracle_rows(const shapes::Shape& shape, const SchemeOptions& scheme) { return oracle::limit_rows(shape.mesh, shape.features, scheme); }

/// Two polygons of so many sides and a belt of quads.
shapes::Shape prism(int sides) {
    std::vector<shapes::Point> points;
    std::vector<shapes::Face> faces(2);
    for (int i = 0; i < 2 * sides; ++i) points.push_back({std::cos(2 * pi * i / sides), std::sin(2 * pi * i / sides), i < sides ? -1.0 : 1.0});
    for (int i = 0; i < sides; ++i) {
        faces[0].insert(faces[0].begin(), i);
        faces[1].push_back(sides + i);
        faces.push_back({i, (i + 1) % sides, sides + (i + 1) % sides, sides + i});
    }
    return shapes::make("prism_" + std::to_string(sides), points, faces);
}

/// Two vertices of valence n over a ring of n vertices of valence 4.
shapes::Shape bipyramid(int n) {
    std::vector<shapes::Point> points{{0, 0, 1}, {0, 0, -1}};
    std::vector<shapes::Face> faces;
    for (int i = 0; i < n; ++i) {
        const int a = 2 + i, b = 2 + (i + 1) % n;
        points.push_back({std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0});
        faces.push_back({0, a, b});
        faces.push_back({1, b, a});
    }
    return shapes::make("bipyramid_" + std::to_string(n), points, faces);
}

std::vector<double> several_ratios(Index vertex_count) {
    std::vector<double> ratios(vertex_count);
    for (Index v = 0; v < vertex_count; ++v) ratios[v] = (v * 7 % 5) * 0.25;  // 0 and 1 among them
    return ratios;
}

Eigen::VectorXd scaling_of(const Prepared& mesh, const SchemeOptions& scheme) {
    Eigen::VectorXd d(mesh.vertex_count());
    for (Index v = 0; v < mesh.vertex_count(); ++v) d[v] = symmetric_scaling(scheme.scheme, mesh.topology.vertex_face_count[v], scheme.lambda_at(v));
    return d;
}

}  // namespace

TEST_CASE("limit rows equal brute-force subdivision on every shape, with every scheme", "[operator]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            INFO(shape.name << ", " << scheme.name);
            CHECK(largest(rows_of(mesh, scheme.options) - oracle_rows(shape, scheme.options)) < tolerance);
        }
    }
}

TEST_CASE("limit rows equal brute-force subdivision with one blend ratio a vertex", "[operator][two-phase]") {
    for (const auto& shape : shapes::all_shapes())
        for (const double alpha : {0.0, 0.5}) {
            INFO(shape.name << ", alpha " << alpha);
            SchemeOptions scheme = catmull_clark(alpha);
            scheme.lambda_per_vertex = several_ratios(shape.mesh.vertex_count);
            CHECK(largest(rows_of(Prepared(shape), scheme) - oracle_rows(shape, scheme)) < tolerance);
        }
}

TEST_CASE("limit rows equal brute-force subdivision under every boundary rule", "[operator][boundary]") {
    auto list = shapes::boundary_shapes();
    list.push_back(shapes::grid_with_creases());
    list.push_back(shapes::grid_triangles_with_creases());
    for (auto& shape : list)
        for (const BoundaryRule rule : {BoundaryRule::edge_and_corner, BoundaryRule::edge_only, BoundaryRule::fixed}) {
            shape.features.boundary = rule;
            const Prepared mesh(shape);
            for (const auto& scheme : {catmull_clark(), catmull_clark(0.5, 0.25), loop(), doo_sabin(), doo_sabin(DooSabinMask::classic)}) {
                if (!suits(shape, scheme)) continue;
                INFO(shape.name << ", boundary rule " << static_cast<int>(rule) << ", " << scheme_name(scheme.scheme));
                CHECK(largest(rows_of(mesh, scheme) - oracle_rows(shape, scheme)) < tolerance);
            }
        }
}

TEST_CASE("limit rows equal brute-force subdivision at valences 3 to 20 and 60, on triangles, quads and polygons", "[operator][valence]") {
    std::vector<int> valences{60};
    for (int n = 3; n <= 20; ++n) valences.push_back(n);
    for (const int n : valences) {
        for (const auto& shape : {bipyramid(n), shapes::disk_pole_quads(n), prism(n)}) {
            const Prepared mesh(shape);
            const oracle::Surface surface = oracle::make_surface(shape.mesh, shape.features);
            for (const auto& scheme : {catmull_clark(), catmull_clark(0.3), loop(), doo_sabin(), doo_sabin(DooSabinMask::classic)}) {
                if (!suits(shape, scheme)) continue;
                INFO(shape.name << ", " << scheme_name(scheme.scheme) << ", alpha " << scheme.alpha);
                CHECK(largest(rows_of(mesh, scheme).row(0) - oracle::limit_row(surface, scheme, 0)) < tolerance);
            }
        }
    }
}

TEST_CASE("darts have exact rows at every valence", "[operator][crease]") {
    for (const int n : {3, 4, 5, 6, 7, 9, 12, 20, 60}) {
        auto triangles = bipyramid(n), quads = shapes::disk_pole_quads(n), polygons = shapes::dual_of(prism(n));
        triangles.features.creases = {{0, 3}};
        quads.features.creases = {{0, 3}};
        polygons.features.creases = {{polygons.mesh.face_vertices[0], polygons.mesh.face_vertices[1]}};
        for (const auto& shape : {triangles, quads, polygons}) {
            const Prepared mesh(shape);
            const Index dart = shape.features.creases[0][0];
            const oracle::Surface surface = oracle::make_surface(shape.mesh, shape.features);
            for (const auto& scheme : {catmull_clark(), catmull_clark(0.5), catmull_clark(1, 0.25), loop(), doo_sabin()}) {
                if (!suits(shape, scheme)) continue;
                INFO(shape.name << ", valence " << n << ", " << scheme_name(scheme.scheme) << ", alpha " << scheme.alpha);
                CHECK(largest(rows_of(mesh, scheme).row(dart) - oracle::limit_row(surface, scheme, dart)) < tolerance);
            }
        }
    }
}

TEST_CASE("limit rows sum to one and have no negative entry", "[operator]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            INFO(shape.name << ", " << scheme.name);
            const Eigen::MatrixXd a = rows_of(mesh, scheme.options);
            CHECK(largest(a.rowwise().sum().array() - 1) < 1e-14);
            CHECK(a.minCoeff() >= -1e-16);
            CHECK(a.diagonal().minCoeff() > 0.2);
        }
    }
}

TEST_CASE("the scaled operator is symmetric between smooth vertices", "[operator][spectrum]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (auto scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            if (scheme.name == "two-phase 1/3") {  // with its own ratio at every vertex, none of them 1
                scheme.options.lambda_per_vertex = several_ratios(shape.mesh.vertex_count);
                for (double& ratio : scheme.options.lambda_per_vertex) ratio *= 0.9;
            }
            INFO(shape.name << ", " << scheme.name);
            const Eigen::MatrixXd s = scaling_of(mesh, scheme.options).asDiagonal() * rows_of(mesh, scheme.options);
            double worst = 0;
            for (Index i = 0; i < mesh.vertex_count(); ++i)
                for (Index j = 0; j < i; ++j)
                    if (mesh.features.kind[i] == VertexKind::smooth && mesh.features.kind[j] == VertexKind::smooth)
                        worst = std::max(worst, std::abs(s(i, j) - s(j, i)));
            CHECK(worst < 1e-14 * (1 + largest(s)));
        }
    }
}

TEST_CASE("vertices outside the subset keep their place, the others keep their rows", "[operator][subset]") {
    for (const auto& shape : {shapes::polygons_mixed(60, 4), shapes::grid_with_creases(), shapes::torus_triangles(5, 4)}) {
        const Prepared mesh(shape);
        std::vector<std::uint8_t> subset(shape.mesh.vertex_count);
        std::vector<int> chosen;
        for (Index v = 0; v < shape.mesh.vertex_count; ++v)
            if (v % 3 != 1) subset[v] = 1, chosen.push_back(v);
        for (const auto& scheme : {catmull_clark(0.3), loop(), doo_sabin()}) {
            if (!suits(shape, scheme)) continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme));
            CHECK(largest(rows_of(mesh, scheme, subset) - oracle::with_identity_rows(oracle_rows(shape, scheme), chosen)) < tolerance);
        }
    }
}

TEST_CASE("vertex and face order do not matter", "[operator]") {
    for (const auto& plain : shapes::all_shapes()) {
        const shapes::Shape shape = shapes::rough(plain, 1e-3, 5);  // no two vertices in one place
        const shapes::Shape other = shapes::shuffled(shape, 8);
        std::map<shapes::Point, Index> number;
        const auto points = shapes::points_of(shape.mesh), other_points = shapes::points_of(other.mesh);
        for (Index v = 0; v < other.mesh.vertex_count; ++v) number[other_points[v]] = v;
        REQUIRE(static_cast<Index>(number.size()) == shape.mesh.vertex_count);
        const Prepared mesh(shape), other_mesh(other);
        for (const auto& scheme : {catmull_clark(), catmull_clark(0.5), loop(), doo_sabin(), doo_sabin(DooSabinMask::classic)}) {
            if (!suits(shape, scheme)) continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme));
            const Eigen::MatrixXd a = rows_of(mesh, scheme), b = rows_of(other_mesh, scheme);
            double worst = 0;
            for (Index i = 0; i < shape.mesh.vertex_count; ++i)
                for (Index j = 0; j < shape.mesh.vertex_count; ++j) worst = std::max(worst, std::abs(a(i, j) - b(number[points[i]], number[points[j]])));
            CHECK(worst < tolerance);
        }
    }
}

TEST_CASE("isolated, marked and outside vertices have identity rows, ghosts have none", "[operator]") {
    const Prepared mesh(shapes::with_isolated_vertex(shapes::grid_with_marked_corner(), 3));
    std::vector<std::uint8_t> subset(mesh.vertex_count(), 1), owned(mesh.vertex_count(), 1);
    subset[7] = 0;
    owned[8] = 0;
    SchemeOptions scheme = catmull_clark();
    const LimitRows rows(mesh.topology, mesh.features, scheme, subset, owned);
    for (const Index v : {3, 7, mesh.shape.features.corners[0]}) {
        CHECK(rows.classify(v).kind == RowKind::fixed);
        CHECK(rows.classify(v).shape == RowShape::identity);
    }
    CHECK(rows.classify(8).kind == RowKind::ghost);
    scheme.lambda = 1;  // the two-phase paper's other end: the polyhedron itself
    const Eigen::MatrixXd a = rows_of(mesh, scheme);
    CHECK(largest(a - Eigen::MatrixXd::Identity(a.rows(), a.cols())) == 0);
}

TEST_CASE("a vertex that is met several times gets the sum of its weights in one entry", "[operator]") {
    for (const auto& shape : {shapes::neighbour_also_diagonal(), shapes::torus_quads(3, 3), shapes::cylinder_open(3, 1), shapes::valence_2_pole()}) {
        const Prepared mesh(shape);
        const std::vector<std::uint8_t> all;
        const SchemeOptions scheme = catmull_clark(0.3);
        LimitRows rows(mesh.topology, mesh.features, scheme, all, all);
        for (Index v = 0; v < mesh.vertex_count(); ++v) {
            const LimitRow row = rows.row(v);
            INFO(shape.name << ", vertex " << v);
            CHECK(std::adjacent_find(row.columns.begin(), row.columns.end(), [](Index a, Index b) { return a >= b; }) == row.columns.end());
        }
    }
    const Eigen::MatrixXd a = rows_of(Prepared(shapes::neighbour_also_diagonal()), catmull_clark());
    // Vertex 0 has valence 3, faces of 3, 3 and 6 sides; vertex 1 is a neighbour over two triangles and a corner of the hexagon: (2 + 4/3 + 4/3 + 4/6)/24.
    CHECK(a(0, 1) == Approx((2 + 8.0 / 3 + 4.0 / 6) / 24).margin(1e-16));
}

TEST_CASE("schemes that do not fit a mesh are refused with the faces", "[operator][refused]") {
    const Topology cube = build_topology(shapes::cube().mesh);
    const Objection objection = scheme_objection(cube, loop());
    CHECK(objection.message == "face 0 has 4 sides, and Loop subdivision takes triangles only: use catmull-clark or doo-sabin, or triangulate the mesh");
    CHECK(objection.faces == std::vector<Index>{0, 1, 2, 3, 4, 5});
    CHECK(scheme_objection(cube, catmull_clark()).message.empty());
    CHECK(scheme_objection(build_topology(shapes::octahedron().mesh), loop()).message.empty());
}
