// SPDX-License-Identifier: BSD-3-Clause
#include "shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <unordered_map>

namespace bench {
namespace {

constexpr double noise = 1e-3;  // of the radius, at most: white noise in [-noise, noise]

/// The midpoint of each edge, made where it is met first.
class Midpoints {
public:
    explicit Midpoints(std::vector<double>& points) : points_(points) {}
    std::int32_t of(std::int32_t a, std::int32_t b) {
        const std::uint64_t key = static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
        const auto [place, is_new] = number_.try_emplace(key, static_cast<std::int32_t>(points_.size() / 3));
        if (is_new)
            for (int c = 0; c < 3; ++c) points_.push_back((points_[3 * a + c] + points_[3 * b + c]) / 2);
        return place->second;
    }

private:
    std::vector<double>& points_;
    std::unordered_map<std::uint64_t, std::int32_t> number_;
};

void put_on_sphere(std::vector<double>& points) {
    for (std::size_t i = 0; i < points.size(); i += 3) {
        const double length = std::hypot(points[i], points[i + 1], points[i + 2]);
        for (int c = 0; c < 3; ++c) points[i + c] /= length;
    }
}

Shape icosahedron() {
    const double g = (1 + std::sqrt(5.0)) / 2;
    return {3,
            {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
             3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1},
            {-1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, 0, 0, -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, g, 0, -1, g, 0, 1, -g, 0, -1, -g, 0, 1}};
}

void split_in_four(Shape& shape) {
    Midpoints midpoints(shape.points);
    std::vector<std::int32_t> faces;
    for (std::size_t f = 0; f < shape.faces.size(); f += 3) {
        const std::int32_t a = shape.faces[f], b = shape.faces[f + 1], c = shape.faces[f + 2];
        const std::int32_t ab = midpoints.of(a, b), bc = midpoints.of(b, c), ca = midpoints.of(c, a);
        for (const std::int32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) faces.push_back(v);
    }
    shape.faces.swap(faces);
    put_on_sphere(shape.points);
}

Shape smooth_icosphere(int level) {
    Shape shape = icosahedron();
    put_on_sphere(shape.points);
    for (int i = 0; i < level; ++i) split_in_four(shape);
    return shape;
}

/// 1, give or take some 5 % in smooth waves over the direction p, and the noise.
double radius_factor(const double* p, std::mt19937& random) {
    const double waves = std::sin(5 * p[0] + 1) * std::sin(4 * p[1]) + 0.6 * std::sin(9 * p[2] + 2 * p[0]) + 0.3 * std::sin(17 * p[1] - 6 * p[2]);
    const double uniform = random() / 4294967295.0;  // the same numbers with every standard library
    return 1 + 0.03 * waves + noise * (2 * uniform - 1);
}

void bump(std::vector<double>& points) {
    std::mt19937 random(1);
    for (std::size_t i = 0; i < points.size(); i += 3) {
        const double factor = radius_factor(&points[i], random);
        for (int c = 0; c < 3; ++c) points[i + c] *= factor;
    }
}

}  // namespace

Shape icosphere(int level) {
    Shape shape = smooth_icosphere(level);
    bump(shape.points);
    return shape;
}

Shape quad_sphere(int level) {
    Shape shape = smooth_icosphere(level);
    std::vector<std::int32_t> edge_points;  // of the three edges of each triangle
    Midpoints midpoints(shape.points);
    for (std::size_t f = 0; f < shape.faces.size(); f += 3)
        for (int k = 0; k < 3; ++k) edge_points.push_back(midpoints.of(shape.faces[f + k], shape.faces[f + (k + 1) % 3]));
    std::vector<std::int32_t> quads;
    for (std::size_t f = 0; f < shape.faces.size(); f += 3) {
        const std::int32_t centre = shape.vertex_count();
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) sum += shape.points[3 * shape.faces[f + k] + c];
            shape.points.push_back(sum / 3);
        }
        for (int k = 0; k < 3; ++k)
            for (const std::int32_t v : {shape.faces[f + k], edge_points[f + k], centre, edge_points[f + (k + 2) % 3]}) quads.push_back(v);
    }
    put_on_sphere(shape.points);
    bump(shape.points);
    return {4, quads, shape.points};
}

Shape torus(int rings, int sides) {
    Shape shape;
    std::mt19937 random(1);
    const double tau = 8 * std::atan(1.0);
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            const double u = tau * i / rings, v = tau * j / sides;
            const double direction[] = {std::cos(u), std::sin(u), std::sin(v)};
            const double tube = 0.4 * radius_factor(direction, random);
            for (const double x : {(1 + tube * std::cos(v)) * std::cos(u), (1 + tube * std::cos(v)) * std::sin(u), tube * std::sin(v)})
                shape.points.push_back(x);
            const int next_i = (i + 1) % rings, next_j = (j + 1) % sides;
            for (const int corner : {i * sides + j, next_i * sides + j, next_i * sides + next_j, i * sides + next_j}) shape.faces.push_back(corner);
        }
    return shape;
}

Shape make_shape(const std::string& name, int level) {
    if (name == "icosphere") return icosphere(level);
    if (name == "quad-sphere") return quad_sphere(level);
    if (name == "torus") return torus(8 << level, (15 << level) / 2);  // 60 x 4^level vertices
    throw std::runtime_error("no shape is called " + name);
}

double diagonal(const Shape& shape) {
    std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (std::size_t i = 0; i < shape.points.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], shape.points[i]);
        high[i % 3] = std::max(high[i % 3], shape.points[i]);
    }
    return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

}  // namespace bench
