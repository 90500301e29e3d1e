// SPDX-License-Identifier: BSD-3-Clause
// Closest points on limit surfaces, against a dense sampling of the surface and against what closest means: the way to the point is normal to the surface.
#include <limits>

#include "tests/capi_support.h"
#include "tests/shapes/clouds.h"

using namespace capi_test;

namespace {

LimitSurface make_surface(const shapes::Shape& shape, lcl_scheme which, lcl_precision precision = LCL_PRECISION_DOUBLE) {
    const lcl_scheme_options options = scheme(which);
    lcl_limit_surface surface = nullptr;
    succeed(lcl_limit_surface_create(default_context(), make_mesh(shape).get(), &options, precision, &surface));
    return LimitSurface(surface);
}

/// Places on the surface with what is known of them.
struct Found {
    std::vector<int32_t> faces, corners;
    std::vector<double> uv, points, normals, distances, du, dv;

    explicit Found(std::size_t count)
        : faces(count), corners(count), uv(2 * count), points(3 * count), normals(3 * count), distances(count), du(3 * count), dv(3 * count) {}
    std::size_t count() const { return faces.size(); }
    void evaluate(lcl_limit_surface surface) {
        lcl_surface_values values = LCL_SURFACE_VALUES_INIT;
        values.points = points.data(), values.normals = normals.data(), values.du = du.data(), values.dv = dv.data();
        succeed(lcl_limit_surface_evaluate(surface, count(), faces.data(), corners.data(), uv.data(), &values));
    }
};

Found closest(lcl_limit_surface surface, const std::vector<double>& points) {
    Found found(points.size() / 3);
    lcl_closest_points out = LCL_CLOSEST_POINTS_INIT;
    out.faces = found.faces.data(), out.corners = found.corners.data(), out.uv = found.uv.data();
    out.points = found.points.data(), out.normals = found.normals.data(), out.distances = found.distances.data();
    succeed(lcl_limit_surface_closest(surface, found.count(), points.data(), 0, &out));
    return found;
}

/// A grid of places on every patch.
Found dense_sampling(lcl_limit_surface surface, const shapes::Shape& shape, lcl_scheme which, int grid) {
    std::vector<std::array<double, 4>> places;
    for (lcl::Index f = 0; f < shape.mesh.face_count(); ++f) {
        const int degree = shape.mesh.degree(f), patches = which == LCL_SCHEME_LOOP || (which == LCL_SCHEME_CATMULL_CLARK && degree == 4) ? 1 : degree;
        for (int corner = 0; corner < patches; ++corner)
            for (int i = 0; i <= grid; ++i)
                for (int j = 0; j <= (which == LCL_SCHEME_LOOP ? grid - i : grid); ++j)
                    places.push_back({double(f), double(corner), double(i) / grid, double(j) / grid});
    }
    Found found(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        found.faces[i] = static_cast<int32_t>(places[i][0]);
        found.corners[i] = static_cast<int32_t>(places[i][1]);
        found.uv[2 * i] = places[i][2];
        found.uv[2 * i + 1] = places[i][3];
    }
    found.evaluate(surface);
    return found;
}

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double distance(const double* a, const double* b) {
    return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

std::vector<double> points_round(const shapes::Shape& shape, int count) {
    shapes::Random random(7);
    std::vector<double> points = shape.mesh.positions;  // and the vertices themselves, above extraordinary points
    for (int i = 0; i < 3 * count; ++i) points.push_back(1.5 * random.symmetric());
    return points;
}

struct Scene {
    shapes::Shape shape;
    lcl_scheme scheme;
};

std::vector<Scene> scenes() {
    return {{shapes::cube(), LCL_SCHEME_CATMULL_CLARK},
            {shapes::rough(shapes::torus_quads(7, 5), 0.1, 3), LCL_SCHEME_CATMULL_CLARK},
            {shapes::dodecahedron(), LCL_SCHEME_CATMULL_CLARK},
            {shapes::grid_quads(3, 4), LCL_SCHEME_CATMULL_CLARK},
            {shapes::icosahedron(), LCL_SCHEME_LOOP},
            {shapes::grid_triangles(3, 3), LCL_SCHEME_LOOP},
            {shapes::cube(), LCL_SCHEME_DOO_SABIN},
            {shapes::dodecahedron(), LCL_SCHEME_DOO_SABIN}};
}

}  // namespace

TEST_CASE("closest points are nearer than every point of a dense sampling, and lie where their parameters say", "[closest]") {
    const Scene scene = GENERATE(from_range(scenes()));
    INFO(scene.shape.name << ", scheme " << scene.scheme);
    const LimitSurface surface = make_surface(scene.shape, scene.scheme);
    const std::vector<double> points = points_round(scene.shape, 100);
    Found found = closest(surface.get(), points);
    const Found dense = dense_sampling(surface.get(), scene.shape, scene.scheme, 16);
    for (std::size_t i = 0; i < found.count(); ++i) {
        const double* p = &points[3 * i];
        CHECK_THAT(distance(p, &found.points[3 * i]), Catch::Matchers::WithinAbs(std::abs(found.distances[i]), 1e-14));
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < dense.count(); ++k) nearest = std::min(nearest, distance(p, &dense.points[3 * k]));
        CHECK(std::abs(found.distances[i]) <= nearest + 1e-12);
    }
    const std::vector<double> told = found.points;
    found.evaluate(surface.get());
    CHECK(largest_difference(found.points, told) < 1e-13);
}

TEST_CASE("the way to the closest point is normal to the surface", "[closest]") {
    const Scene scene = GENERATE(from_range(scenes()));
    INFO(scene.shape.name << ", scheme " << scene.scheme);
    const bool is_closed = scene.shape.name.find("grid") == std::string::npos;
    const LimitSurface surface = make_surface(scene.shape, scene.scheme);
    const std::vector<double> points = points_round(scene.shape, 100);
    Found found = closest(surface.get(), points);
    found.evaluate(surface.get());
    for (std::size_t i = 0; i < found.count(); ++i) {
        double way[3];
        for (int c = 0; c < 3; ++c) way[c] = points[3 * i + c] - found.points[3 * i + c];
        const double u = dot(way, &found.du[3 * i]) / std::sqrt(dot(&found.du[3 * i], &found.du[3 * i])),
                     v = dot(way, &found.dv[3 * i]) / std::sqrt(dot(&found.dv[3 * i], &found.dv[3 * i]));
        const double lowest = std::min(found.uv[2 * i], found.uv[2 * i + 1]), highest = std::max(found.uv[2 * i], found.uv[2 * i + 1]),
                     across = scene.scheme == LCL_SCHEME_LOOP ? found.uv[2 * i] + found.uv[2 * i + 1] : highest;
        const bool on_boundary = !is_closed && (lowest <= 0 || across >= 1 - 1e-12);
        // The search ends when a step is shorter than 1e-12 of the size; cancellation in the way leaves the square root of the rounding of the square.
        if (!on_boundary) CHECK(std::max(std::abs(u), std::abs(v)) < 1e-6);
        if (!on_boundary && std::abs(found.distances[i]) > 1e-6) CHECK(dot(way, &found.normals[3 * i]) * found.distances[i] > 0);
    }
}

TEST_CASE("points moved off the surface along its normals come back to their places", "[closest]") {
    const auto precision = GENERATE(LCL_PRECISION_DOUBLE, LCL_PRECISION_SINGLE);
    const shapes::Shape shape = shapes::rough(shapes::icosphere_quads(1), 0.02, 5);
    const LimitSurface surface = make_surface(shape, LCL_SCHEME_CATMULL_CLARK, precision);
    shapes::Random random(11);
    Found places(500);
    for (std::size_t i = 0; i < places.count(); ++i) {
        places.faces[i] = random.below(shape.mesh.face_count());
        places.uv[2 * i] = random.next();
        places.uv[2 * i + 1] = random.next();
    }
    places.evaluate(surface.get());
    std::vector<double> points;
    const auto height = [](std::size_t i) { return i % 2 == 0 ? 0.03 : -0.02; };
    for (std::size_t i = 0; i < 3 * places.count(); ++i) points.push_back(places.points[i] + height(i / 3) * places.normals[i]);
    const Found found = closest(surface.get(), points);
    // Single: control points and weights are rounded to 2^-24 of the size, some 3.5; the normal of a hundred times shorter edge moves more than the point.
    const double tolerance = precision == LCL_PRECISION_SINGLE ? 2e-5 : 1e-9;
    CHECK(largest_difference(found.points, places.points) < 10 * tolerance);
    for (std::size_t i = 0; i < found.count(); ++i) CHECK_THAT(found.distances[i], Catch::Matchers::WithinAbs(height(i), tolerance));
}

TEST_CASE("points beside an open surface come to its boundary curve", "[closest]") {
    const LimitSurface surface = make_surface(shapes::grid_quads(4, 4), LCL_SCHEME_CATMULL_CLARK);
    const Found everything = dense_sampling(surface.get(), shapes::grid_quads(4, 4), LCL_SCHEME_CATMULL_CLARK, 8);
    double left = everything.points[0], right = left;
    for (std::size_t i = 0; i < everything.points.size(); i += 3) left = std::min(left, everything.points[i]), right = std::max(right, everything.points[i]);
    const double middle = everything.points[3 * everything.count() / 2 + 1];
    const Found found = closest(surface.get(), {left - 1, middle, 0.1, right + 2, middle, -0.1});
    CHECK_THAT(found.points[0], Catch::Matchers::WithinAbs(left, 1e-12));
    CHECK_THAT(found.points[3], Catch::Matchers::WithinAbs(right, 1e-12));
}

TEST_CASE("closest points follow new control points", "[closest]") {
    const shapes::Shape shape = shapes::cube(), larger = shapes::transformed(shapes::cube(), 3, 1e6);
    const LimitSurface surface = make_surface(shape, LCL_SCHEME_CATMULL_CLARK);
    const Found before = closest(surface.get(), {5, 0.1, 0.2});
    succeed(lcl_limit_surface_set_points(surface.get(), larger.mesh.positions.data(), 0));
    const Found after = closest(surface.get(), {3 * 5.0 + 1e6, 3 * 0.1 + 1e6, 3 * 0.2 + 1e6});
    CHECK_THAT(after.distances[0], Catch::Matchers::WithinAbs(3 * before.distances[0], 1e-9));
}

TEST_CASE("closest points do not need the mesh any more, whatever becomes of it", "[closest]") {
    const Mesh mesh = make_mesh(shapes::cube());
    lcl_limit_surface made = nullptr;
    succeed(lcl_limit_surface_create(default_context(), mesh.get(), nullptr, LCL_PRECISION_DOUBLE, &made));
    const LimitSurface surface(made);
    const std::vector<double> point = {2, 0.1, 0.2};
    const Found before = closest(surface.get(), point);
    lcl_features features = LCL_FEATURES_INIT;
    features.crease_angle_degrees = 30;
    succeed(lcl_mesh_add_features(mesh.get(), &features));
    CHECK(closest(surface.get(), point).distances == before.distances);
}

TEST_CASE("closest points are found on surfaces of any size", "[closest]") {
    const double scale = GENERATE(1e25, 1e-25);
    const LimitSurface surface = make_surface(shapes::transformed(shapes::cube(), scale, 0), LCL_SCHEME_CATMULL_CLARK),
                       unit = make_surface(shapes::cube(), LCL_SCHEME_CATMULL_CLARK);
    std::vector<double> points = points_round(shapes::cube(), 20), large = points;
    for (double& coordinate : large) coordinate *= scale;
    const Found expected = closest(unit.get(), points), found = closest(surface.get(), large);
    for (std::size_t i = 0; i < found.count(); ++i) CHECK_THAT(found.distances[i] / scale, Catch::Matchers::WithinAbs(expected.distances[i], 1e-12));
}

TEST_CASE("closest points refuse points that are not finite", "[closest]") {
    const LimitSurface surface = make_surface(shapes::cube(), LCL_SCHEME_CATMULL_CLARK);
    const double points[6] = {0, 0, 0, std::numeric_limits<double>::quiet_NaN(), 0, 0};
    lcl_closest_points out = LCL_CLOSEST_POINTS_INIT;
    refuse(lcl_limit_surface_closest(surface.get(), 2, points, 0, &out), LCL_ERROR_BAD_INPUT, "point 1 is not finite");
    const double far[3] = {0, 1e30, 0};
    refuse(lcl_limit_surface_closest(surface.get(), 1, far, 0, &out), LCL_ERROR_BAD_INPUT, "point 0 is more than 1e12 times as far away");
    refuse(lcl_limit_surface_closest(surface.get(), 2, nullptr, 0, &out), LCL_ERROR_INVALID_ARGUMENT, "points is NULL");
    succeed(lcl_limit_surface_closest(surface.get(), 0, nullptr, 0, &out));
}

TEST_CASE("the limit points of the vertices lie on the surface", "[closest]") {
    const lcl_scheme which = GENERATE(LCL_SCHEME_DOO_SABIN, LCL_SCHEME_CATMULL_CLARK, LCL_SCHEME_LOOP);
    std::vector<shapes::Shape> all = {shapes::wave_cloud(7).shape, shapes::sphere_cloud(2).shape, shapes::octahedron()};
    all.push_back(all[0]);  // every vertex of the boundary a corner
    all.back().features.boundary = lcl::BoundaryRule::fixed;
    all.push_back(all[1]);  // long thin faces beside short ones
    for (std::size_t i = 0; i < all.back().mesh.positions.size(); i += 3) all.back().mesh.positions[i + 2] = 20 * std::pow(all.back().mesh.positions[i + 2], 3);
    all.push_back(all[2]);  // all edges of one face sharp
    all.back().features.creases = {{all[2].mesh.face_vertices[0], all[2].mesh.face_vertices[1]}, {all[2].mesh.face_vertices[1], all[2].mesh.face_vertices[2]}};
    for (const shapes::Shape& shape : all) {
        CAPTURE(shape.name, which);
        const lcl_scheme_options options = scheme(which);
        std::vector<double> limit(shape.mesh.positions.size());
        succeed(lcl_limit_points(make_operator(shape, &options).get(), shape.mesh.positions.data(), 0, 3, LCL_PRECISION_DOUBLE, limit.data(), 0));
        const Found found = closest(make_surface(shape, which).get(), limit);
        for (std::size_t v = 0; v < found.count(); ++v) CHECK(std::fabs(found.distances[v]) <= 1e-5 * diagonal_of(shape));  // slow convergence at high valence
    }
}

TEST_CASE("closest points are found on a surface that has shrunk to a line", "[closest]") {
    shapes::Shape line = shapes::grid_quads(60, 60);
    for (std::size_t i = 0; i < line.mesh.positions.size(); i += 3) line.mesh.positions[i + 1] = line.mesh.positions[i + 2] = 0;
    const LimitSurface surface = make_surface(line, LCL_SCHEME_CATMULL_CLARK);
    const double x = line.mesh.positions[3 * static_cast<std::size_t>(line.mesh.vertex_count / 2)];
    const Found found = closest(surface.get(), {x, 0.5, 0});
    CHECK_THAT(found.distances[0], Catch::Matchers::WithinAbs(0.5, 0.05));  // along the line it may stop anywhere near
}
