// SPDX-License-Identifier: BSD-3-Clause
// Normals of faces and vertices, and angles between them.
#pragma once

#include <array>
#include <vector>

#include "host/mesh/topology.h"

namespace lcl {

using Vector = std::array<double, 3>;
constexpr double radians_per_degree = 0.017453292519943295;

/// Newell's normal of a face, twice its area long. points: x, y, z of every vertex.
Vector newell_normal(const Topology& topology, Index face, const std::vector<double>& points);

/// Angle in radians; 0 where a normal is zero: what has no direction makes no angle.
double angle_between(const Vector& a, const Vector& b);

/// For each vertex the sum of the Newell normals of its faces, which weights them by area; zero for isolated vertices.
Array<Vector> vertex_normals(const Topology& topology, const std::vector<double>& points);

}  // namespace lcl
