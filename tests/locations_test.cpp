// SPDX-License-Identifier: BSD-3-Clause
// Where refined vertices lie on the original surface, in the parameters of `limitcl evaluate`.
#include <array>
#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

#include "host/refine/refine.h"
#include "tests/oracle/limit.h"
#include "tests/oracle/subdivide.h"
#include "tests/shapes/shapes.h"

using namespace lcl;
using Vector = Eigen::RowVector3d;

namespace {

SchemeOptions scheme_of(Scheme scheme, double lambda = 0) {
    SchemeOptions options;
    options.scheme = scheme;
    options.lambda = lambda;
    return options;
}

/// A ring of m by n quads with random points: face i * n + j is (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1). Closed in i; closed in j too (a torus) or open
/// with n + 1 points (a cylinder).
struct Ring {
    int m, n;
    bool closed;
    shapes::Shape shape;

    Ring(int m_, int n_, bool closed_) : m(m_), n(n_), closed(closed_) {
        shapes::Random random(17);
        std::vector<shapes::Point> points;
        std::vector<shapes::Face> faces;
        for (int i = 0; i < m * columns(); ++i) points.push_back({random.symmetric(), random.symmetric(), random.symmetric()});
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < n; ++j) faces.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
        shape = shapes::make("ring", points, faces);
    }
    int columns() const { return closed ? n : n + 1; }
    int index(int i, int j) const {
        return (i + m) % m * columns() + (closed ? (j + n) % n : std::min(std::max(j, 0), n));
    }  // open: the ghost row equals the boundary row
    Vector at(int i, int j) const { return oracle::positions(shape.mesh).row(index(i, j)); }
};

double cubic(double t) {  // uniform cubic B-spline centred at 0
    const double a = std::abs(t);
    return a >= 2 ? 0 : a >= 1 ? std::pow(2 - a, 3) / 6 : 2.0 / 3 - a * a + a * a * a / 2;
}

double quadratic(double t) {  // uniform quadratic B-spline centred at 0
    const double a = std::abs(t);
    return a >= 1.5 ? 0 : a >= 0.5 ? (1.5 - a) * (1.5 - a) / 2 : 0.75 - a * a;
}

/// The tensor-product spline at (x, y), control points at the integers.
Vector spline(const Ring& ring, double x, double y, double (*basis)(double)) {
    Vector sum = Vector::Zero();
    const int i0 = static_cast<int>(std::floor(x)), j0 = static_cast<int>(std::floor(y));
    for (int i = i0 - 2; i <= i0 + 3; ++i)
        for (int j = j0 - 2; j <= j0 + 3; ++j) sum += basis(x - i) * basis(y - j) * ring.at(i, j);
    return sum;
}

/// (u, v) turned from the corner's own directions to those of the face's first vertex, in units where the face is [0,1]^2 and a patch half of it.
std::array<double, 2> turned(int corner, double u, double v) {
    switch (corner) {
        case 0: return {u, v};
        case 1: return {1 - v, u};
        case 2: return {1 - u, 1 - v};
        default: return {v, 1 - u};
    }
}

void check_limits(const Refinement& refined, const SchemeOptions& options, const std::vector<SurfaceLocation>& locations,
                  const std::function<Vector(const SurfaceLocation&)>& surface) {
    REQUIRE(locations.size() == static_cast<std::size_t>(refined.mesh.vertex_count));
    const oracle::Surface fine = oracle::make_surface(refined.mesh, refined.features);
    const Eigen::MatrixXd points = oracle::positions(refined.mesh);
    for (Index v = 0; v < refined.mesh.vertex_count; ++v) {
        CAPTURE(v, locations[v].face, locations[v].corner, locations[v].u, locations[v].v);
        const Vector limit = oracle::limit_row(fine, options, v) * points;
        REQUIRE((limit - surface(locations[v])).norm() < 1e-12);
    }
}

Vector corner_point(const PolygonMesh& mesh, Index face, Index k) {
    const Index degree = mesh.degree(face), v = mesh.face_vertices[mesh.face_offsets[face] + (k + degree) % degree];
    return {mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
}

/// The flat image of a location: bilinear on quads and on the sub-quads of other faces, linear on Loop's triangles.
Vector flat(const PolygonMesh& mesh, const SurfaceLocation& at, bool triangles) {
    const auto p = [&](Index k) { return corner_point(mesh, at.face, k); };
    if (triangles) return (1 - at.u - at.v) * p(0) + at.u * p(1) + at.v * p(2);
    const auto bilinear = [&](const Vector& a, const Vector& b, const Vector& c, const Vector& d) -> Vector {
        return (1 - at.v) * ((1 - at.u) * a + at.u * b) + at.v * ((1 - at.u) * d + at.u * c);
    };
    if (mesh.degree(at.face) == 4) return bilinear(p(0), p(1), p(2), p(3));
    Vector centre = Vector::Zero();
    for (Index k = 0; k < mesh.degree(at.face); ++k) centre += p(k) / mesh.degree(at.face);
    const Index k = at.corner;
    return bilinear(p(k), (p(k) + p(k + 1)) / 2, centre, (p(k) + p(k - 1)) / 2);
}

/// Positions of the next level when every point stays in the middle of what it is made from.
Eigen::MatrixXd split_flat(const PolygonMesh& mesh, const Eigen::MatrixXd& points, bool with_faces) {
    const Topology topology = build_topology(mesh);
    Eigen::MatrixXd fine(topology.vertex_count + topology.edge_count + (with_faces ? topology.face_count : 0), 3);
    fine.topRows(topology.vertex_count) = points;
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index h = topology.edge_half_edge[e];
        fine.row(topology.vertex_count + e) = (points.row(topology.origin(h)) + points.row(topology.destination(h))) / 2;
    }
    for (Index f = 0; with_faces && f < topology.face_count; ++f) {
        Vector centre = Vector::Zero();
        for (Index h = topology.face_offsets[f]; h < topology.face_offsets[f + 1]; ++h) centre += points.row(topology.face_vertices[h]) / topology.degree(f);
        fine.row(topology.vertex_count + topology.edge_count + f) = centre;
    }
    return fine;
}

double longest_edge(const PolygonMesh& mesh, const Eigen::MatrixXd& points) {
    const Topology topology = build_topology(mesh);
    double longest = 0;
    for (Index h = 0; h < topology.half_edge_count(); ++h)
        longest = std::max(longest, (points.row(topology.origin(h)) - points.row(topology.destination(h))).norm());
    return longest;
}

}  // namespace

TEST_CASE("Catmull-Clark vertices lie where the bicubic spline says", "[refine][locations]") {
    const Ring ring(5, 4, true);
    for (const int levels : {0, 1, 2}) {
        std::vector<SurfaceLocation> locations;
        const Refinement refined = refine(ring.shape.mesh, {}, scheme_of(Scheme::catmull_clark), levels, &locations);
        check_limits(refined, scheme_of(Scheme::catmull_clark), locations, [&](const SurfaceLocation& at) {
            REQUIRE(at.corner == 0);
            return spline(ring, at.face / ring.n + at.u, at.face % ring.n + at.v, cubic);
        });
    }
}

TEST_CASE("Doo-Sabin vertices lie where the biquadratic spline says, on boundary curves too", "[refine][locations]") {
    for (const bool closed : {true, false}) {
        const Ring ring(5, 3, closed);
        for (const int levels : {0, 1, 2}) {
            CAPTURE(closed, levels);
            std::vector<SurfaceLocation> locations;
            const Refinement refined = refine(ring.shape.mesh, {}, scheme_of(Scheme::doo_sabin), levels, &locations);
            check_limits(refined, scheme_of(Scheme::doo_sabin), locations, [&](const SurfaceLocation& at) {
                const auto [x, y] = turned(at.corner, at.u / 2, at.v / 2);
                return spline(ring, at.face / ring.n + x, at.face % ring.n + y, quadratic);
            });
        }
    }
}

TEST_CASE("Doo-Sabin corners are named by their outer parameters and creases by their side's curve", "[refine][locations]") {
    std::vector<SurfaceLocation> locations;
    const auto quad = shapes::single_quad();
    const Refinement refined = refine(quad.mesh, {}, scheme_of(Scheme::doo_sabin), 1, &locations);
    for (Index k = 0; k < 4; ++k) {
        CHECK((locations[k].corner == k && locations[k].u == 0.5 && locations[k].v == 0.5));
        CHECK((locations[4 + 2 * k].corner == k && locations[4 + 2 * k].u == 0.5 && locations[4 + 2 * k].v == -1));
        CHECK((locations[5 + 2 * k].corner == (k + 1) % 4 && locations[5 + 2 * k].u == -1 && locations[5 + 2 * k].v == 0.5));
        CHECK((locations[12 + k].corner == k && locations[12 + k].u == -1 && locations[12 + k].v == -1));
    }
    refine(quad.mesh, {}, scheme_of(Scheme::doo_sabin), 0, &locations);
    for (Index k = 0; k < 4; ++k) CHECK((locations[k].corner == k && locations[k].u == -1 && locations[k].v == -1));
    const auto cube = shapes::cube_with_crease_loop();
    refine(cube.mesh, cube.features, scheme_of(Scheme::doo_sabin), 1, &locations);
    for (std::size_t i = 24; i < 40; i += 4) {
        CHECK(locations[i].face == locations[i + 1].face);
        CHECK(locations[i + 2].face == locations[i + 3].face);
        CHECK(locations[i].face != locations[i + 2].face);
        CHECK((locations[i].v == -1 && locations[i + 2].v == -1));
    }
}

TEST_CASE("locations on polygons and triangles follow their flat subdivision", "[refine][locations]") {
    for (const auto& shape : {shapes::polygons_mixed(20, 3), shapes::grid_with_creases(), shapes::grid_triangles_with_creases(), shapes::single_hexagon()}) {
        for (const Scheme scheme : {Scheme::catmull_clark, Scheme::loop}) {
            const bool is_loop = scheme == Scheme::loop;
            if (is_loop && !shapes::is_triangle_mesh(shape.mesh)) continue;
            CAPTURE(shape.name, scheme_name(scheme));
            PolygonMesh mesh = shape.mesh;
            Eigen::MatrixXd expected = oracle::positions(mesh);
            for (int levels = 1; levels <= 3; ++levels) {
                expected = split_flat(mesh, expected, !is_loop);
                std::vector<SurfaceLocation> locations;
                mesh = refine(shape.mesh, shape.features, scheme_of(scheme), levels, &locations).mesh;
                double largest = 0;
                for (Index v = 0; v < mesh.vertex_count; ++v) largest = std::max(largest, (flat(shape.mesh, locations[v], is_loop) - expected.row(v)).norm());
                CHECK(largest < 1e-13);
            }
        }
    }
}

TEST_CASE("locations of the two-phase mesh cut edges in thirds and follow its refinements", "[refine][locations][two-phase]") {
    for (const auto& shape : {shapes::single_hexagon(), shapes::single_quad(), shapes::icosahedron(), shapes::cube()}) {
        CAPTURE(shape.name);
        std::vector<SurfaceLocation> locations;
        PolygonMesh mesh = refine(shape.mesh, {}, scheme_of(Scheme::catmull_clark, 0.3), 1, &locations).mesh;
        Eigen::MatrixXd expected(mesh.vertex_count, 3);
        for (Index v = 0; v < mesh.vertex_count; ++v) expected.row(v) = flat(shape.mesh, locations[v], false);
        const Topology topology = build_topology(shape.mesh);
        const auto old_point = [&](Index v) { return Vector(oracle::positions(shape.mesh).row(v)); };
        for (Index v = 0; v < topology.vertex_count; ++v) REQUIRE((expected.row(v) - old_point(v)).norm() < 1e-14);
        for (Index e = 0; e < topology.edge_count; ++e) {
            const Index h = topology.edge_half_edge[e], first = topology.vertex_count + 2 * e;
            const Vector a = old_point(topology.origin(h)), b = old_point(topology.destination(h));
            REQUIRE((expected.row(first) - (2 * a + b) / 3).norm() < 1e-14);
            REQUIRE((expected.row(first + 1) - (a + 2 * b) / 3).norm() < 1e-14);
        }
        double edge = longest_edge(mesh, expected);
        for (int levels = 2; levels <= 4; ++levels) {
            expected = split_flat(mesh, expected, true);
            mesh = refine(shape.mesh, {}, scheme_of(Scheme::catmull_clark, 0.3), levels, &locations).mesh;
            Eigen::MatrixXd found(mesh.vertex_count, 3);
            for (Index v = 0; v < mesh.vertex_count; ++v) found.row(v) = flat(shape.mesh, locations[v], false);
            // On quads the flat images are split in the middle. Other faces bend between their sub-quads, so there it is continuity that is looked at.
            if (shape.mesh.degree(0) == 4) CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-13);
            CHECK(longest_edge(mesh, found) < 0.7 * edge);
            edge = longest_edge(mesh, found);
        }
    }
}

TEST_CASE("isolated vertices have no location", "[refine][locations]") {
    const auto shape = shapes::with_isolated_vertex(shapes::octahedron(), 3);
    for (const Scheme scheme : {Scheme::catmull_clark, Scheme::loop, Scheme::doo_sabin}) {
        for (const int levels : {0, 1, 2}) {
            std::vector<SurfaceLocation> locations;
            const Refinement refined = refine(shape.mesh, {}, scheme_of(scheme), levels, &locations);
            const Index isolated = scheme == Scheme::doo_sabin && levels > 0 ? refined.mesh.vertex_count - 1 : 3;
            for (Index v = 0; v < refined.mesh.vertex_count; ++v) REQUIRE((locations[v].face < 0) == (v == isolated));
        }
    }
}
