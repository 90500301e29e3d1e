// SPDX-License-Identifier: BSD-3-Clause
// The brute-force evaluation that exact evaluation is compared with, against closed forms, other oracles, and itself. No library code is involved.
#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

#include "tests/oracle/evaluate.h"
#include "tests/oracle/limit.h"
#include "tests/oracle/subdivide.h"
#include "tests/shapes/shapes.h"

using oracle::Place;
using oracle::SurfacePoint;
using oracle::Vector;

namespace {

using Real = long double;
const double pi = std::acos(-1.0);

lcl::SchemeOptions scheme(lcl::Scheme which, double alpha = 0, lcl::DooSabinMask mask = lcl::DooSabinMask::catmull) {
    lcl::SchemeOptions options;
    options.scheme = which;
    options.alpha = alpha;
    options.mask = mask;
    return options;
}

const lcl::SchemeOptions catmull_clark = scheme(lcl::Scheme::catmull_clark), loop = scheme(lcl::Scheme::loop), doo_sabin = scheme(lcl::Scheme::doo_sabin);
const lcl::SchemeOptions classic = scheme(lcl::Scheme::doo_sabin, 0, lcl::DooSabinMask::classic), blended = scheme(lcl::Scheme::catmull_clark, 0.5);

std::vector<lcl::SchemeOptions> options_for(const shapes::Shape& shape) {
    std::vector<lcl::SchemeOptions> list{catmull_clark, blended, doo_sabin, classic};
    if (shapes::is_triangle_mesh(shape.mesh)) list.push_back(loop);
    return list;
}

oracle::LimitSurface surface_of(const shapes::Shape& shape, const lcl::SchemeOptions& options) {
    return {oracle::make_surface(shape.mesh, shape.features), oracle::positions(shape.mesh), options};
}

/// A monomial x^i y^j, i + j <= 3, as control values of a spline with the given moments, and as a function with its derivatives.
struct Monomial {
    int i, j;
    static Real power(Real x, int n) { return n < 0 ? 0 : std::pow(x, static_cast<Real>(n)); }

    /// The spline with control values q has the mean of q(x - X) over its basis function, which has mean 0 and no third moments.
    Real control(Real x, Real y, Real variance, Real covariance) const {
        Real value = power(x, i) * power(y, j);
        value -= variance / 2 * (i * (i - 1) * power(x, i - 2) * power(y, j) + j * (j - 1) * power(x, i) * power(y, j - 2));
        return value - covariance * i * j * power(x, i - 1) * power(y, j - 1);
    }
    std::array<Real, 6> values(Real x, Real y) const {
        return {power(x, i) * power(y, j),
                i * power(x, i - 1) * power(y, j),
                j * power(x, i) * power(y, j - 1),
                i * (i - 1) * power(x, i - 2) * power(y, j),
                i * j * power(x, i - 1) * power(y, j - 1),
                j * (j - 1) * power(x, i) * power(y, j - 2)};
    }
};

std::array<Vector, 6> values_of(const SurfacePoint& at) { return {at.point, at.du, at.dv, at.duu, at.duv, at.dvv}; }

Real largest(const Vector& vector) { return vector.cwiseAbs().maxCoeff(); }

/// A grid of n x n quads or twice as many triangles at whole numbers, z the control values of a monomial.
shapes::Shape monomial_grid(int n, bool triangles, const Monomial& monomial, Real variance, Real covariance) {
    shapes::Shape shape = triangles ? shapes::grid_triangles(n, n) : shapes::grid_quads(n, n);
    for (int v = 0; v < shape.mesh.vertex_count; ++v) {
        const int x = v % (n + 1), y = v / (n + 1);
        const Real z = monomial.control(x, y, variance, covariance);
        for (int c = 0; c < 3; ++c) shape.mesh.positions[3 * v + c] = c == 0 ? x : c == 1 ? y : static_cast<double>(z);
    }
    return shape;
}

const std::vector<Monomial> cubics{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}};

}  // namespace

TEST_CASE("regular Catmull-Clark and Doo-Sabin patches reproduce polynomials with all derivatives", "[oracle][evaluate]") {
    for (const bool cubic : {true, false})
        for (const Monomial& monomial : cubics) {
            if (!cubic && monomial.i + monomial.j > 2) continue;
            CAPTURE(cubic, monomial.i, monomial.j);
            // A uniform B-spline of degree d is the density of a sum of d + 1 uniform numbers, of variance 1/12 each.
            const auto grid = monomial_grid(5, false, monomial, cubic ? 4 / Real(12) : 3 / Real(12), 0);
            const auto surface = surface_of(grid, cubic ? catmull_clark : doo_sabin);
            const int face = 12;  // from (2, 2) to (3, 3)
            for (const auto& [u, v] : {std::pair{0.25, 0.625}, std::pair{0.0, 1.0}, std::pair{0.8125, 0.4375}}) {
                const Real scale = cubic ? 1 : 0.5L;  // a Doo-Sabin patch is a quarter of a face
                const auto at = values_of(surface.at({face, 0, u, v}));
                const auto exact = monomial.values(2 + scale * u, 2 + scale * v);
                const std::array<Real, 6> scales{1, scale, scale, scale * scale, scale * scale, scale * scale};
                CHECK(std::abs(static_cast<double>(at[0].x() - (2 + scale * u))) < 1e-17);
                CHECK(std::abs(static_cast<double>(at[0].y() - (2 + scale * v))) < 1e-17);
                for (int k = 0; k < 6; ++k)
                    CHECK(std::abs(static_cast<double>(at[k].z() - scales[k] * exact[k])) < 1e-14);  // control values are doubles up to 27
            }
        }
}

TEST_CASE("regular Loop patches reproduce cubics with all derivatives, in both kinds of triangles", "[oracle][evaluate]") {
    for (const Monomial& monomial : cubics) {
        CAPTURE(monomial.i, monomial.j);
        // The box spline of the directions (1, 0), (0, 1), (1, 1), each twice.
        const auto grid = monomial_grid(6, true, monomial, 4 / Real(12), 2 / Real(12));
        const auto surface = surface_of(grid, loop);
        for (const bool upper : {false, true})
            for (const auto& [u, v] : {std::pair{0.25, 0.625}, std::pair{0.0, 1.0}, std::pair{0.125, 0.125}, std::pair{0.75, 0.1875}}) {
                const int face = 2 * (2 * 6 + 2) + (upper ? 1 : 0);  // at (2, 2): below the diagonal {a, a + x, a + x + y}, above it {a, a + x + y, a + y}
                const auto at = values_of(surface.at({face, 0, u, v}));
                const Real x = 2 + u + (upper ? 0 : v), y = 2 + v + (upper ? u : 0);
                const auto& [value, fx, fy, fxx, fxy, fyy] = monomial.values(x, y);
                const std::array<Real, 6> lower_values{value, fx, fx + fy, fxx, fxx + fxy, fxx + 2 * fxy + fyy};
                const std::array<Real, 6> upper_values{value, fx + fy, fy, fxx + 2 * fxy + fyy, fxy + fyy, fyy};
                CHECK(std::abs(static_cast<double>(at[0].x() - x)) < 1e-17);
                for (int k = 0; k < 6; ++k) CHECK(std::abs(static_cast<double>(at[k].z() - (upper ? upper_values : lower_values)[k])) < 1e-13);
            }
    }
}

TEST_CASE("boundary patches of regular grids are splines with natural or doubled ends", "[oracle][evaluate]") {
    // Along x a cubic B-spline with ghosts 2 P_0 - P_1 and a corner at its end; a straight line along y.
    auto grid = shapes::grid_quads(4, 3);
    const std::vector<double> heights{1, -2, 0.5, 3, 1.5};
    for (int v = 0; v < grid.mesh.vertex_count; ++v) {
        const int x = v % 5, y = v / 5;
        for (int c = 0; c < 3; ++c) grid.mesh.positions[3 * v + c] = c == 0 ? x : c == 1 ? y : heights[x];
    }
    const double t = 0.375, b0 = std::pow(1 - t, 3) / 6, b1 = (3 * t * t * t - 6 * t * t + 4) / 6, b2 = (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6,
                 b3 = t * t * t / 6;
    const SurfacePoint cubic = surface_of(grid, catmull_clark).at({0, 0, t, 0.25});
    CHECK(static_cast<double>(cubic.point.z()) ==
          Approx(b0 * (2 * heights[0] - heights[1]) + b1 * heights[0] + b2 * heights[1] + b3 * heights[2]).margin(1e-15));
    CHECK(static_cast<double>(cubic.point.x()) == Approx(t).margin(1e-15));
    CHECK(static_cast<double>(cubic.point.y()) == Approx(0.25).margin(1e-15));
    CHECK(cubic.levels == 0);
    // Doo-Sabin: patches of half the size, the points at the boundary doubled.
    const auto surface = surface_of(grid, doo_sabin);
    const double q0 = heights[0], q1 = 0.75 * heights[0] + 0.25 * heights[1];
    const SurfacePoint quadratic = surface.at({0, 0, -1 + t, 0.5});
    CHECK(static_cast<double>(quadratic.point.z()) == Approx((1 - t) * (1 - t) / 2 * q0 + (-2 * t * t + 2 * t + 1) / 2 * q0 + t * t / 2 * q1).margin(1e-15));
    CHECK(static_cast<double>(surface.at({0, 0, -1, -1}).point.norm() - std::abs(heights[0])) == Approx(0).margin(1e-15));
    CHECK(static_cast<double>(surface.at({0, 0, -1, 0.5}).du.norm()) == Approx(0).margin(1e-15));  // across the boundary the derivative vanishes
    // Loop: a + b - c keeps a plane's own parameters.
    auto triangles = shapes::grid_triangles(4, 4);
    for (int v = 0; v < triangles.mesh.vertex_count; ++v)
        for (int c = 0; c < 3; ++c) triangles.mesh.positions[3 * v + c] = c == 0 ? v % 5 : c == 1 ? v / 5 : v % 5 + 2 * (v / 5);
    for (const int face : {2, 3}) {
        const SurfacePoint flat = surface_of(triangles, loop).at({face, 0, 0.25, 0.5});
        CHECK(flat.levels == 0);
        CHECK(static_cast<double>(flat.point.z() - flat.point.x() - 2 * flat.point.y()) == Approx(0).margin(1e-15));
        CHECK(static_cast<double>(largest(flat.duu) + largest(flat.dvv)) == Approx(0).margin(1e-15));
    }
}

TEST_CASE("the oracle is affine invariant everywhere, depths included", "[oracle][evaluate]") {
    for (auto shape : {shapes::disk_pole_triangles(7), shapes::disk_pole_quads(5), shapes::polygons_mixed(20, 3), shapes::grid_with_creases(),
                       shapes::cube_with_dart(), shapes::grid_triangles_with_creases()}) {
        for (int v = 0; v < shape.mesh.vertex_count; ++v)
            shape.mesh.positions[3 * v + 2] = 2 * shape.mesh.positions[3 * v] - 0.5 * shape.mesh.positions[3 * v + 1] + 3;
        for (const auto& options : options_for(shape)) {
            CAPTURE(shape.name, static_cast<int>(options.scheme));
            const auto surface = surface_of(shape, options);
            for (const int face : {0, shape.mesh.face_count() / 2})
                for (const auto& [u, v] : {std::pair{0.0, 0.0}, std::pair{0x1p-20, 0x3p-21}, std::pair{0.375, 0.5}, std::pair{1.0, 0.0}}) {
                    const SurfacePoint found = surface.at({face, 0, u, v});
                    const auto at = values_of(found);
                    // z is rounded to 4e-16 as a double, and rough values have derivatives of some 10 times the size of smooth ones.
                    for (int k = 0; k < 3; ++k) {
                        if (found.is_extraordinary && k > 0) continue;
                        CHECK(std::abs(static_cast<double>(at[k].z() - 2 * at[k].x() + 0.5L * at[k].y() - (k == 0 ? 3 : 0))) <
                              1e-14 * std::max(Real(1), largest(at[k])));
                    }
                }
        }
    }
}

TEST_CASE("limit points at vertices are those of the limit rows", "[oracle][evaluate]") {
    std::vector<shapes::Shape> list{
        shapes::tetrahedron(),          shapes::icosahedron(),       shapes::polygons_mixed(20, 4),         shapes::cube_with_crease(),
        shapes::cube_with_dart(),       shapes::grid_with_creases(), shapes::grid_triangles_with_creases(), shapes::disk_pole_quads(5),
        shapes::disk_pole_triangles(3), shapes::single_hexagon()};
    for (const auto& shape : list)
        for (const auto& options : options_for(shape)) {
            CAPTURE(shape.name, static_cast<int>(options.scheme), options.alpha);
            const auto flat = oracle::make_surface(shape.mesh, shape.features);
            const auto surface = surface_of(shape, options);
            const bool is_doo_sabin = options.scheme == lcl::Scheme::doo_sabin;
            for (int face = 0; face < shape.mesh.face_count(); face += 1 + shape.mesh.face_count() / 12) {
                const auto& vertices = flat.faces[face];
                const int d = static_cast<int>(vertices.size());
                for (int corner = 0; corner < d; ++corner) {
                    const int vertex = vertices[corner];
                    const bool next_is_sharp = flat.sharp.count(oracle::edge_of(vertex, vertices[(corner + 1) % d])) != 0;
                    const bool previous_is_sharp = flat.sharp.count(oracle::edge_of(vertex, vertices[(corner + d - 1) % d])) != 0;
                    bool is_smooth = !flat.corners.count(vertex);
                    for (const auto& edge : flat.sharp) is_smooth = is_smooth && edge.first != vertex && edge.second != vertex;
                    const bool is_corner = flat.corners.count(vertex) && next_is_sharp && previous_is_sharp;
                    if (is_doo_sabin && !is_smooth && !is_corner) continue;
                    Place place{face, is_doo_sabin || (options.scheme == lcl::Scheme::catmull_clark && d != 4) ? corner : 0, 0, 0};
                    if (is_doo_sabin && is_corner) place.u = place.v = -1;
                    if (options.scheme == lcl::Scheme::loop) place.u = corner == 1, place.v = corner == 2;
                    if (options.scheme == lcl::Scheme::catmull_clark && d == 4) place.u = corner == 1 || corner == 2, place.v = corner >= 2;
                    const Eigen::RowVector3d limit = oracle::limit_row(flat, options, vertex) * oracle::positions(shape.mesh);
                    CAPTURE(face, corner, vertex);
                    CHECK((surface.point(place).cast<double>() - limit.transpose()).norm() < 2e-14);  // as exact as limit rows are
                }
            }
        }
}

TEST_CASE("a child of a face has the face's surface", "[oracle][evaluate]") {
    // Turned frames as oracle::subdivide orders them: child k of a quad begins at corner k, of a triangle likewise; the library's documents say the same.
    const std::array<std::array<Real, 6>, 4> quad{{{0, 0.5, 0, 0, 0, 0.5}, {1, 0, -0.5, 0, 0.5, 0}, {1, -0.5, 0, 1, 0, -0.5}, {0, 0, 0.5, 1, -0.5, 0}}};
    const std::array<std::array<Real, 6>, 4> triangle{
        {{0, 0.5, 0, 0, 0, 0.5}, {1, -0.5, -0.5, 0, 0.5, 0}, {0, 0, 0.5, 1, -0.5, -0.5}, {0.5, 0, -0.5, 0, 0.5, 0.5}}};
    for (const auto& shape : {shapes::rough(shapes::cube_with_crease(), 0.3, 1), shapes::rough(shapes::icosahedron(), 0.3, 2), shapes::grid_with_creases(),
                              shapes::grid_triangles_with_creases()})
        for (const auto& options : options_for(shape)) {
            if (options.scheme == lcl::Scheme::doo_sabin) continue;
            const bool is_loop = options.scheme == lcl::Scheme::loop;
            const auto flat = oracle::make_surface(shape.mesh, shape.features);
            if (!is_loop && flat.faces[0].size() != 4) continue;
            const auto fine = oracle::subdivide(flat, options);
            const oracle::LimitSurface whole = surface_of(shape, options),
                                       child(fine.surface, fine.weights * oracle::positions(shape.mesh), oracle::after_first_step(options));
            for (int f = 0; f < shape.mesh.face_count(); f += 5)
                for (int k = 0; k < 4; ++k) {
                    CAPTURE(shape.name, f, k, is_loop);
                    const auto& [u0, us, ut, v0, vs, vt] = (is_loop ? triangle : quad)[k];
                    const Real s = 0.34L, t = 0.17L;
                    const SurfacePoint a = whole.at({f, 0, u0 + us * s + ut * t, v0 + vs * s + vt * t}), b = child.at({4 * f + k, 0, s, t});
                    CHECK(largest(a.point - b.point) < 1e-15);  // the refined points are doubles
                    CHECK(largest(us * a.du + vs * a.dv - b.du) < 1e-14);
                    CHECK(largest(ut * a.du + vt * a.dv - b.dv) < 1e-14);
                    CHECK(largest(us * us * a.duu + 2 * us * vs * a.duv + vs * vs * a.dvv - b.duu) < 1e-13);
                    CHECK(largest(us * ut * a.duu + (us * vt + ut * vs) * a.duv + vs * vt * a.dvv - b.duv) < 1e-13);
                }
        }
}

TEST_CASE("derivatives are the differences of points", "[oracle][evaluate]") {
    for (const auto& shape : {shapes::rough(shapes::random_triangle_mesh(30, 5), 0.1, 1), shapes::polygons_mixed(20, 5), shapes::grid_with_creases(),
                              shapes::torus_triangles_with_dart()})
        for (const auto& options : options_for(shape)) {
            CAPTURE(shape.name, static_cast<int>(options.scheme), options.alpha, static_cast<int>(options.mask));
            const auto surface = surface_of(shape, options);
            for (int f = 0; f < shape.mesh.face_count(); f += 7) {
                const Real u = 0.0123L, v = 0.0057L, h = 1e-6L;
                const auto at = [&](Real du, Real dv) { return surface.at({f, 0, u + du * h, v + dv * h}); };
                const SurfacePoint middle = at(0, 0);
                // Central differences leave h^2 S''' / 6 with S''' of the order of S' / 0.01^2 here: 2e-9 of S'.
                const double size = static_cast<double>(largest(middle.du) + largest(middle.dv)), bend = size / 0.005;
                CHECK(largest((at(1, 0).point - at(-1, 0).point) / (2 * h) - middle.du) < 1e-6 * size);
                CHECK(largest((at(0, 1).point - at(0, -1).point) / (2 * h) - middle.dv) < 1e-6 * size);
                CHECK(largest((at(1, 0).du - at(-1, 0).du) / (2 * h) - middle.duu) < 1e-6 * bend);
                CHECK(largest((at(0, 1).du - at(0, -1).du) / (2 * h) - middle.duv) < 1e-6 * bend);
                CHECK(largest((at(0, 1).dv - at(0, -1).dv) / (2 * h) - middle.dvv) < 1e-6 * bend);
            }
        }
}

TEST_CASE("tangents at smooth vertices are those of the eigenvectors", "[oracle][evaluate]") {
    for (const int n : {3, 4, 5, 6, 7, 9, 12}) {
        CAPTURE(n);
        const auto triangles = shapes::rough(shapes::disk_pole_triangles(n), 0.1, 3);
        const Eigen::MatrixXd points = oracle::positions(triangles.mesh);
        const SurfacePoint at = surface_of(triangles, loop).at({0, 0, 0, 0});
        CHECK(at.is_extraordinary == (n != 6));
        Eigen::RowVector3d first = Eigen::RowVector3d::Zero(), second = first;  // along the edges to vertices 1 and 2
        for (int j = 0; j < n; ++j) {
            first += std::cos(2 * pi * j / n) * points.row(1 + j);
            second += std::cos(2 * pi * (j - 1) / n) * points.row(1 + j);
        }
        CHECK((at.du.normalized().cast<double>() - first.normalized().transpose()).norm() < 1e-13);
        CHECK((at.dv.normalized().cast<double>() - second.normalized().transpose()).norm() < 1e-13);
        // Catmull-Clark on quads (mesh expansion paper's mask as two-phase paper writes it): A_n cos(j t) on edges, cos(j t) + cos((j + 1) t) on diagonals.
        const auto quads = shapes::rough(shapes::disk_pole_quads(n), 0.1, 3);
        const Eigen::MatrixXd corners = oracle::positions(quads.mesh);
        const SurfacePoint of_quads = surface_of(quads, catmull_clark).at({0, 0, 0, 0});
        const double t = 2 * pi / n, a = 1 + std::cos(t) + std::cos(pi / n) * std::sqrt(2 * (9 + std::cos(t)));
        Eigen::RowVector3d side = Eigen::RowVector3d::Zero();
        for (int j = 0; j < n; ++j) side += a * std::cos(j * t) * corners.row(1 + 2 * j) + (std::cos(j * t) + std::cos((j + 1) * t)) * corners.row(2 + 2 * j);
        CHECK((of_quads.du.normalized().cast<double>() - side.normalized().transpose()).norm() < 1e-13);
    }
}

TEST_CASE("what the oracle does not offer it refuses", "[oracle][evaluate]") {
    auto fixed = shapes::grid_quads(3, 3);
    fixed.features.boundary = lcl::BoundaryRule::fixed;
    CHECK_THROWS_AS(surface_of(fixed, doo_sabin).at({0, 0, 0.5, 0.5}), std::invalid_argument);
    const auto marked = shapes::grid_with_marked_corner();
    CHECK_THROWS_AS(surface_of(marked, doo_sabin).at({10, 0, 0.25, 0.25}), std::invalid_argument);
}
