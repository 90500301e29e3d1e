// SPDX-License-Identifier: BSD-3-Clause
// Limit normals against the normals of faces that are refined until they no longer change, and the kernels against the plain host normals.
#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>

#include "host/apply/device_tangents.h"
#include "host/apply/host_normals.h"
#include "tests/oracle/normals.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

const double pi = std::acos(-1.0);

using Vector = Eigen::Vector3d;

/// Vertex 0 in the middle of `faces` faces of the given degrees (in turn), E_i = 1 + i; round it closed, or through `angle`. Rough, but nowhere folded.
shapes::Shape fan(int faces, bool closed, const std::vector<int>& degrees, double angle, double roughness, std::uint64_t seed) {
    shapes::Random random(seed);
    const auto point = [&](double turn, double radius) -> shapes::Point {
        radius *= 1 + 0.3 * roughness * random.symmetric();
        return {radius * std::cos(turn), radius * std::sin(turn), roughness * (0.3 * random.symmetric() + 0.2 * std::sin(2 * turn))};
    };
    const double step = closed ? 2 * pi / faces : angle / faces;
    std::vector<shapes::Point> points{{0.05 * roughness, -0.08 * roughness, 0.1 * roughness}};
    const int edges = closed ? faces : faces + 1;
    for (int i = 0; i < edges; ++i) points.push_back(point(i * step, 1));
    std::vector<shapes::Face> list;
    for (int i = 0; i < faces; ++i) {
        const int degree = degrees[i % degrees.size()];
        shapes::Face face{0, 1 + i};
        for (int j = 1; j + 2 < degree; ++j) {
            face.push_back(static_cast<int>(points.size()));
            points.push_back(point((i + j / (degree - 2.0)) * step, 1.4));
        }
        face.push_back(1 + (i + 1) % edges);
        list.push_back(face);
    }
    return shapes::make("fan of " + std::to_string(faces) + (closed ? " round" : " open"), points, list);
}

shapes::Shape with_creases(shapes::Shape shape, const std::vector<int>& ends) {
    for (const int end : ends) shape.features.creases.push_back({0, end});
    shape.name += ", " + std::to_string(ends.size()) + " creases";
    return shape;
}

/// Normals of a shape by the host's plan, in the caller's numbering.
struct Found {
    Eigen::MatrixXd normals;                 // vertex_count x 3
    std::vector<std::pair<int, int>> sides;  // vertex, first face
    std::vector<Vector> side_normals;

    Vector at(int v) const { return normals.row(v); }
    /// Of the vertex's sector that begins with a face; its only one where it has no sides.
    Vector of_sector(int v, int face) const {
        bool has_sides = false;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            if (sides[i] == std::pair(v, face)) return side_normals[i];
            has_sides = has_sides || sides[i].first == v;
        }
        return has_sides ? Vector(Vector::Constant(NAN)) : at(v);
    }
};

Found find_normals(const shapes::Shape& shape, const SchemeOptions& scheme) {
    const Prepared mesh(shape);
    const Plan plan = mesh.plan(scheme);
    const TangentPlan tangents = build_tangent_plan(plan, mesh.topology, mesh.features, scheme);
    std::vector<double> x(3 * mesh.vertex_count());
    for (Index row = 0; row < plan.vertex_count; ++row) std::copy_n(&shape.mesh.positions[3 * plan.vertex_of_row[row]], 3, &x[3 * row]);
    const Normals normals = host_normals(plan, tangents, x);
    Found found{Eigen::MatrixXd(mesh.vertex_count(), 3), {}, {}};
    for (Index row = 0; row < plan.vertex_count; ++row)
        found.normals.row(plan.vertex_of_row[row]) = Eigen::Map<const Eigen::RowVector3d>(&normals.vertices[3 * row]);
    for (Index s = 0; s < tangents.side_count(); ++s) {
        found.sides.emplace_back(tangents.side_vertices[s], tangents.side_faces[s]);
        found.side_normals.push_back(Eigen::Map<const Vector>(&normals.sides[3 * s]));
    }
    return found;
}

/// Where each sector of a vertex begins, by plain search: its faces whose edge to the next vertex is sharp; without two of them, any.
std::vector<int> first_faces(const oracle::Surface& surface, int v) {
    std::vector<int> first, all;
    for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f) {
        const auto& face = surface.faces[f];
        const auto at = std::find(face.begin(), face.end(), v);
        if (at == face.end()) continue;
        all.push_back(f);
        const int next = at + 1 == face.end() ? face.front() : *(at + 1);
        if (surface.sharp.count(oracle::edge_of(v, next))) first.push_back(f);
    }
    return first.empty() ? all : first;
}

/// All normals at one vertex are the limits of its refined faces.
void check_vertex(const shapes::Shape& shape, const SchemeOptions& scheme, const Found& found, int v) {
    const oracle::Surface surface = oracle::make_surface(shape.mesh, shape.features);
    const std::vector<int> first = first_faces(surface, v);
    Vector sum = Vector::Zero();
    std::size_t sectors = 0;
    for (const oracle::FaceNormal& limit : oracle::limit_normals(surface, scheme, oracle::positions(shape.mesh), v)) {
        if (std::find(first.begin(), first.end(), limit.face) == first.end()) continue;
        INFO(shape.name << ", vertex " << v << ", face " << limit.face << ", oracle's own error " << limit.error);
        REQUIRE(limit.error < 1e-6);  // there is a limit, and it was reached
        const bool only_one = found.of_sector(v, limit.face) == found.at(v);
        CHECK((found.of_sector(v, limit.face) - limit.normal).norm() <= 1e-9 + 30 * limit.error);
        if (only_one && sectors > 0) continue;  // seen from another face
        sum += limit.normal;
        ++sectors;
    }
    REQUIRE(sectors > 0);
    INFO(shape.name << ", vertex " << v);
    CHECK((found.at(v) - sum.normalized()).norm() <= 1e-6);
}

std::vector<NamedScheme> schemes_for(const std::vector<int>& degrees) {
    std::vector<NamedScheme> schemes{{"Catmull-Clark", catmull_clark()},
                                     {"alpha 0.7", catmull_clark(0.7)},
                                     {"two-phase 0.3, alpha 0.4", catmull_clark(0.4, 0.3)},
                                     {"Doo-Sabin", doo_sabin()},
                                     {"classic Doo-Sabin", doo_sabin(DooSabinMask::classic)}};
    if (degrees == std::vector<int>{3}) schemes.push_back({"Loop", loop()});
    return schemes;
}

const std::vector<std::vector<int>> face_degrees = {{4}, {3}, {4, 3, 5, 6, 4}};

void check_fan(const shapes::Shape& shape, const NamedScheme& scheme) {
    INFO(scheme.name);
    check_vertex(shape, scheme.options, find_normals(shape, scheme.options), 0);
}

bool is_doo_sabin(const NamedScheme& scheme) { return scheme.options.scheme == Scheme::doo_sabin; }

}  // namespace

TEST_CASE("limit normals of smooth vertices and darts are those that refined faces tend to", "[normals]") {
    for (const auto& degrees : face_degrees)
        for (const NamedScheme& scheme : schemes_for(degrees))
            for (const int n : {3, 4, 5, 6, 7, 8, 9, 12}) {
                const shapes::Shape round = fan(n, true, degrees, 0, 1, 3 * n + degrees.size());
                check_fan(round, scheme);
                if (!is_doo_sabin(scheme)) check_fan(with_creases(round, {2}), scheme);  // the tip of a slit has no tangent plane
            }
}

TEST_CASE("limit normals on curves are those that refined faces tend to", "[normals]") {
    for (const auto& degrees : face_degrees)
        for (const NamedScheme& scheme : schemes_for(degrees)) {
            // Faces of a sector for which the limit is there, and is not approached like 1/level.
            const std::vector<int> faces = is_doo_sabin(scheme)    ? std::vector<int>{1, 2, 3, 5, 8}
                                           : scheme.name == "Loop" ? std::vector<int>{1, 2, 3, 4, 5}
                                                                   : std::vector<int>{2, 3};
            for (const int k : faces) {
                shapes::Shape open = fan(k, false, degrees, pi, 1, 100 + k);
                open.features.boundary = BoundaryRule::edge_only;
                check_fan(open, scheme);
                for (const int other : faces)
                    if (k + other > 2) check_fan(with_creases(fan(k + other, true, degrees, 0, 1, 7 * k + other), {1, 1 + k}), scheme);
            }
        }
}

TEST_CASE("limit normals at corners are those that refined faces tend to", "[normals]") {
    for (const auto& degrees : face_degrees)
        for (const NamedScheme& scheme : schemes_for(degrees)) {
            const std::vector<int> faces = is_doo_sabin(scheme)    ? std::vector<int>{1, 2, 3, 5}
                                           : scheme.name == "Loop" ? std::vector<int>{1, 2}
                                                                   : std::vector<int>{1};
            for (const int k : faces) {
                shapes::Shape open = fan(k, false, degrees, 0.5 * pi, 1, 200 + k);
                open.features.corners = {0};
                check_fan(open, scheme);
                check_fan(with_creases(fan(3 * k, true, degrees, 0, 1, 300 + k), {1, 1 + k, 1 + 2 * k}), scheme);
            }
            // A straight line: what the surface leaves it by.
            shapes::Shape straight = fan(faces.back(), false, degrees, pi, 1, 5);
            straight.features.corners = {0};
            std::vector<double>& p = straight.mesh.positions;
            const int last = 3 * (1 + faces.back());
            for (int c = 0; c < 3; ++c) p[last + c] = p[c] - 0.75 * (p[3 + c] - p[c]);
            const bool can_leave = degrees != std::vector<int>{3} || faces.back() > 1;  // one triangle would have no area
            if (can_leave) check_fan(straight, scheme);
        }
}

// At these the tangents' eigenvalues meet with others: errors fall like 1/level, and an extrapolation of that takes their place.
TEST_CASE("limit normals that are approached slowly agree with extrapolated ones", "[normals]") {
    struct Slow {
        SchemeOptions scheme;
        int faces, degree;
    };
    for (const auto& [scheme, faces, degree] : {Slow{catmull_clark(), 1, 4}, Slow{catmull_clark(), 4, 4}, Slow{loop(), 6, 3}}) {
        shapes::Shape open = fan(faces, false, {degree}, pi, 0.5, 11);
        open.features.boundary = BoundaryRule::edge_only;
        const oracle::Surface surface = oracle::make_surface(open.mesh, open.features);
        const auto at_level = [&, rules = scheme](int level) {
            return oracle::limit_normals(surface, rules, oracle::positions(open.mesh), 0, level).front().normal;
        };
        // Neville's scheme in 1/level; at 44 levels the smaller tangent is still 1e-13 of the larger one, far above rounding.
        const std::vector<int> levels{20, 24, 30, 36, 44};
        std::vector<Vector> table;
        for (const int level : levels) table.push_back(at_level(level));
        for (std::size_t order = 1; order < levels.size(); ++order)
            for (std::size_t i = 0; i + order < levels.size(); ++i)
                table[i] = (levels[i + order] * table[i + 1] - levels[i] * table[i]) / (levels[i + order] - levels[i]);
        INFO(scheme_name(scheme.scheme) << ", " << faces << " faces");
        const Vector expected = find_normals(open, scheme).at(0);
        const double near = (at_level(20) - expected).norm(), extrapolated = (table[0].normalized() - expected).norm();
        CHECK(extrapolated <= 0.02);
        CHECK(extrapolated < near);
    }
}

TEST_CASE("limit normals of whole meshes are those that refined faces tend to", "[normals]") {
    for (const shapes::Shape& plain : {shapes::icosahedron(), shapes::polygons_mixed(40, 5), shapes::cube_with_crease(), shapes::torus_with_dart(),
                                       shapes::cylinder_open(5, 3), shapes::icosphere_quads(0), shapes::torus_triangles_with_dart()})
        for (const NamedScheme& scheme : all_schemes()) {
            if (!suits(plain, scheme.options)) continue;
            const shapes::Shape shape = shapes::rough(shapes::shuffled(plain, 3), 0.1, 9);
            const Prepared mesh(shape);
            const Found found = find_normals(shape, scheme.options);
            for (Index v = 0; v < shape.mesh.vertex_count; v += 3) {
                const VertexKind kind = mesh.features.kind[v];
                const bool tip = kind == VertexKind::dart && scheme.options.scheme == Scheme::doo_sabin;
                const bool slow_curve =
                    kind == VertexKind::curve && scheme.options.scheme == Scheme::catmull_clark && shape.name.find("cube") != std::string::npos;  // one face
                if (tip || slow_curve) continue;
                INFO(scheme.name);
                check_vertex(shape, scheme.options, found, v);
            }
        }
}

TEST_CASE("normals of flat meshes look upwards at every kind of vertex, chosen ones too", "[normals]") {
    std::vector<shapes::Shape> flat{shapes::grid_quads(4, 3),    shapes::grid_triangles(3, 4),      shapes::grid_with_hole(),
                                    shapes::grid_with_creases(), shapes::grid_with_marked_corner(), shapes::grid_triangles_with_creases(),
                                    shapes::single_hexagon()};
    for (const auto& degrees : face_degrees)
        for (const int n : {2, 3, 4, 5, 8, 13}) {
            if (n > 2) flat.push_back(fan(n, true, degrees, 0, 0, 1));
            if (n > 2) flat.push_back(with_creases(fan(n, true, degrees, 0, 0, 1), {1}));
            flat.push_back(fan(n, false, degrees, pi, 0, 1));
            flat.push_back(fan(n, false, degrees, 0.6 * pi, 0, 1));
            if (n > 2) flat.push_back(with_creases(fan(n, true, degrees, 0, 0, 1), {1, 3}));
        }
    for (shapes::Shape& shape : flat)
        for (std::size_t z = 2; z < shape.mesh.positions.size(); z += 3) shape.mesh.positions[z] = 0;
    const std::size_t curves = flat.size();
    for (std::size_t i = 0; i < curves; ++i)
        for (const BoundaryRule rule : {BoundaryRule::edge_only, BoundaryRule::fixed}) {
            flat.push_back(flat[i]);
            flat.back().features.boundary = rule;
            if (rule == BoundaryRule::fixed) flat.back().features.corners.push_back(0);
        }
    for (const shapes::Shape& shape : flat)
        for (const NamedScheme& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            const Prepared mesh(shape);
            const Found found = find_normals(shape, scheme.options);
            for (Index v = 0; v < shape.mesh.vertex_count; ++v) {
                // Loop's and Doo-Sabin's surfaces fold over in hollow corners, where they lie in the plane of the two edges.
                const bool can_fold = mesh.features.kind[v] == VertexKind::corner && scheme.options.scheme != Scheme::catmull_clark;
                INFO(shape.name << ", " << scheme.name << ", boundary rule " << static_cast<int>(shape.features.boundary) << ", vertex " << v);
                const double z = can_fold ? std::abs(found.at(v).z()) : found.at(v).z();
                if (!can_fold || z != 0) CHECK(std::abs(z - 1) <= 1e-12);  // sides that look up and down have no mean
            }
        }
}
