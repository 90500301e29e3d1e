// SPDX-License-Identifier: BSD-3-Clause
// The benchmark's meshes: closed, all faces triangles or all quads, in the order that repeated splitting gives.
#ifndef LIMITCL_BENCH_SHAPES_H
#define LIMITCL_BENCH_SHAPES_H

#include <cstdint>
#include <string>
#include <vector>

namespace bench {

struct Shape {
    int degree = 4;                   ///< sides of every face
    std::vector<std::int32_t> faces;  ///< face_count x degree, counter-clockwise
    std::vector<double> points;       ///< vertex_count x 3

    std::int32_t vertex_count() const { return static_cast<std::int32_t>(points.size() / 3); }
    std::int32_t face_count() const { return static_cast<std::int32_t>(faces.size() / degree); }
};

/// An icosahedron split `level` times, 10 x 4^level + 2 vertices on the unit sphere, moved by bump().
Shape icosphere(int level);
/// The same with every triangle split into three quads: 60 x 4^level + 2 vertices of valence 3 to 6; corners first, then edge midpoints, then face points.
Shape quad_sphere(int level);
/// A regular grid of quads, rings x sides, radii 1 and 0.4, moved by bump().
Shape torus(int rings, int sides);
/// "icosphere LEVEL", "quad-sphere LEVEL" or "torus LEVEL" (of about the size of the quad sphere). std::runtime_error for others.
Shape make_shape(const std::string& name, int level);

double diagonal(const Shape& shape);  ///< of the bounding box

}  // namespace bench

#endif
