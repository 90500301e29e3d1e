// SPDX-License-Identifier: BSD-3-Clause
#include "tests/shapes/clouds.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace shapes {
namespace {

double length(const Point& p) { return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]); }

/// An m by n grid of triangles, closed in the first direction, and in the second one or not.
std::vector<Face> ring_faces(int m, int n, bool closed) {
    std::vector<Face> faces;
    for (int j = 0; j < (closed ? n : n - 1); ++j)
        for (int i = 0; i < m; ++i) {
            const int a = j * m + i, b = j * m + (i + 1) % m, c = (j + 1) % n * m + (i + 1) % m, d = (j + 1) % n * m + i;
            faces.push_back({a, b, c});
            faces.push_back({a, c, d});
        }
    return faces;
}

double box_distance(const Point& p, double radius) {
    Point beyond;
    double inside = -1;
    for (int c = 0; c < 3; ++c) {
        const double q = std::fabs(p[c]) - (1 - radius);
        beyond[c] = std::max(q, 0.0);
        inside = c == 0 ? q : std::max(inside, q);
    }
    return length(beyond) + std::min(inside, 0.0) - radius;
}

/// The profile r(z) of two unit spheres at z = -0.7 and 0.7, melted by r^2 = log(exp(k a) + exp(k b)) / k of theirs.
double blend_profile(double z) {
    constexpr double k = 6;
    const double a = 1 - (z - 0.7) * (z - 0.7), b = 1 - (z + 0.7) * (z + 0.7);
    return std::sqrt(std::max(0.0, std::log(std::exp(k * a) + std::exp(k * b)) / k - 0.05));
}

}  // namespace

SampledShape sphere_cloud(int levels) {
    return {icosphere(levels), [](const Point& p) { return length(p) - 1; }};
}

SampledShape torus_cloud(int m, int n) {
    std::vector<Point> points;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i) {
            const double u = 2 * M_PI * i / m, v = 2 * M_PI * j / n, r = 1 + 0.4 * std::cos(v);
            points.push_back({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)});
        }
    return {make("torus_cloud", points, ring_faces(m, n, true)), [](const Point& p) { return std::hypot(std::hypot(p[0], p[1]) - 1, p[2]) - 0.4; }};
}

SampledShape rounded_box_cloud(int n, double radius) {
    std::map<Point, int> number;
    std::vector<Point> points;
    std::vector<Face> faces;
    const auto at = [&](int axis, int sign, int i, int j) {
        Point p;
        p[axis] = sign;
        p[(axis + 1) % 3] = -1 + 2.0 * i / (n - 1);
        p[(axis + 2) % 3] = -1 + 2.0 * j / (n - 1);
        Point core, way;
        for (int c = 0; c < 3; ++c) core[c] = std::clamp(p[c], radius - 1, 1 - radius), way[c] = p[c] - core[c];
        const double size = length(way);
        for (int c = 0; c < 3; ++c) p[c] = size > 0 ? core[c] + radius * way[c] / size : p[c];
        const auto [found, is_new] = number.try_emplace(p, static_cast<int>(points.size()));
        if (is_new) points.push_back(p);
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int sign : {-1, 1})
            for (int i = 0; i + 1 < n; ++i)
                for (int j = 0; j + 1 < n; ++j) {
                    const int a = at(axis, sign, i, j), b = at(axis, sign, i + 1, j), c = at(axis, sign, i + 1, j + 1), d = at(axis, sign, i, j + 1);
                    faces.push_back(sign > 0 ? Face{a, b, c} : Face{a, c, b});
                    faces.push_back(sign > 0 ? Face{a, c, d} : Face{a, d, c});
                }
    return {make("rounded_box_cloud", points, faces), [radius](const Point& p) { return box_distance(p, radius); }};
}

SampledShape blend_cloud(int m, int n) {
    double top = 1;
    while (blend_profile(top) > 0) top += 1e-4;
    std::vector<Point> points;
    for (int j = 1; j <= n; ++j) {
        const double z = -top * std::cos(M_PI * j / (n + 1)), r = blend_profile(z);
        for (int i = 0; i < m; ++i) points.push_back({r * std::cos(2 * M_PI * i / m), r * std::sin(2 * M_PI * i / m), z});
    }
    std::vector<Face> faces = ring_faces(m, n, false);
    const int bottom = m * n;
    points.push_back({0, 0, -top});
    points.push_back({0, 0, top});
    for (int i = 0; i < m; ++i) {
        faces.push_back({bottom, (i + 1) % m, i});
        faces.push_back({bottom + 1, m * (n - 1) + i, m * (n - 1) + (i + 1) % m});
    }
    std::vector<std::array<double, 2>> profile;
    for (int i = 0; i <= 4000; ++i) {
        const double z = -top * std::cos(M_PI * i / 4000);
        profile.push_back({blend_profile(z), z});
    }
    const auto distance = [profile](const Point& p) {
        const double r = std::hypot(p[0], p[1]);
        double least = 1e30;
        for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
            const double dr = profile[i + 1][0] - profile[i][0], dz = profile[i + 1][1] - profile[i][1], r0 = r - profile[i][0], z0 = p[2] - profile[i][1];
            const double t = std::clamp((r0 * dr + z0 * dz) / (dr * dr + dz * dz), 0.0, 1.0);
            least = std::min(least, std::hypot(r0 - t * dr, z0 - t * dz));
        }
        return std::fabs(p[2]) <= -profile[0][1] && r < blend_profile(p[2]) ? -least : least;
    };
    return {make("blend_cloud", points, faces), distance};
}

SampledShape wave_cloud(int n) {
    const auto height = [](double x, double y) { return 0.1 * std::sin(3 * x) * std::cos(3 * y); };
    std::vector<Point> points;
    std::vector<Face> faces;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double x = -1 + 2.0 * i / (n - 1), y = -1 + 2.0 * j / (n - 1);
            points.push_back({x, y, height(x, y)});
            const int a = j * n + i;
            if (i + 1 == n || j + 1 == n) continue;
            faces.push_back({a, a + 1, a + n + 1});
            faces.push_back({a, a + n + 1, a + n});
        }
    // Along z divided by the largest slope's part: no more than the distance, and as small.
    return {make("wave_cloud", points, faces), [height](const Point& p) { return (p[2] - height(p[0], p[1])) / std::sqrt(1 + 0.09); }};
}

Shape two_parts(const Shape& first, const Shape& second, const Point& away) {
    std::vector<Point> points = points_of(first.mesh);
    std::vector<Face> faces = faces_of(first.mesh);
    const int before = first.mesh.vertex_count;
    for (Point p : points_of(second.mesh)) {
        for (int c = 0; c < 3; ++c) p[c] += away[c];
        points.push_back(p);
    }
    for (Face face : faces_of(second.mesh)) {
        for (int& corner : face) corner += before;
        faces.push_back(face);
    }
    return make("two_parts", points, faces);
}

void add_noise(Shape& shape, double size, std::uint64_t seed) {
    Random random(seed);
    for (double& coordinate : shape.mesh.positions) coordinate += size / std::sqrt(3.0) * random.symmetric();
}

KnownEngine::KnownEngine(const Shape& shape) : triangles(shape.mesh.face_vertices) {
    engine_.struct_size = sizeof engine_;
    engine_.name = "known";
    engine_.description = "the triangles that the points were sampled with";
    engine_.licence = "BSD-3-Clause";
    engine_.options = "fail=0  1: says that it failed";
    engine_.run = run;
    engine_.user = this;
}

std::int32_t KnownEngine::run(void* user, const lcl_engine_points* points, const lcl_engine_option* options, std::size_t option_count,
                              const lcl_engine_sink* sink) {
    KnownEngine& known = *static_cast<KnownEngine*>(user);
    known.seen_options.clear();
    for (std::size_t i = 0; i < option_count; ++i) {
        known.seen_options += std::string(options[i].key) + "=" + options[i].value + ";";
        if (std::string(options[i].key) == "fail") {
            sink->fail(sink->self, "it was told to fail");
            return LCL_ENGINE_FAILED;
        }
        if (std::string(options[i].key) != "key") {
            sink->fail(sink->self, "there is no such option: fail and key are all");
            return LCL_ENGINE_OPTION;
        }
    }
    if (sink->progress(sink->self, 0.5) == 0) return LCL_ENGINE_CANCELLED;
    if (!known.outliers.empty()) sink->leave_out(sink->self, static_cast<std::int32_t>(known.outliers.size()), known.outliers.data());
    const bool has_own = !known.own_points.empty();
    sink->give(sink->self, has_own ? static_cast<std::int32_t>(known.own_points.size() / 3) : points->count, has_own ? known.own_points.data() : nullptr,
               static_cast<std::int32_t>(known.triangles.size() / 3), known.triangles.data());
    return LCL_ENGINE_OK;
}

}  // namespace shapes
