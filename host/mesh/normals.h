// SPDX-License-Identifier: BSD-3-Clause
// Normals of faces and vertices.
#pragma once

#include <array>
#include <vector>

#include "host/mesh/topology.h"

namespace lcl {

using Vector = std::array<double, 3>;

/// Newell's normal of a face: along its normal, twice its area long. positions: vertex_count x 3, the mesh's own or others.
Vector newell_normal(const PolygonMesh& mesh, const std::vector<double>& positions, Index f);

/// Angle in radians; 0 where a vector is zero, so that faces without area make no crease.
double angle_between(const Vector& a, const Vector& b);

/// Unit normals of the vertices: the sum of the normals of the faces round each, by their areas; 0 where that is 0.
std::vector<Vector> vertex_normals(const PolygonMesh& mesh, const Topology& topology, const std::vector<double>& positions);

}  // namespace lcl
