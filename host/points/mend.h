// SPDX-License-Identifier: BSD-3-Clause
// Triangles of an engine become a mesh: manifold, consistently oriented, outwards.
#pragma once

#include <string>
#include <vector>

#include "host/mesh/polygon_mesh.h"

namespace lcl {

/// What an engine gives: unchecked.
struct RawTriangles {
    std::vector<double> points;    ///< n x 3
    std::vector<Index> triangles;  ///< count x 3
};

struct MendedMesh {
    PolygonMesh mesh;           ///< triangles; every vertex has one
    std::vector<Index> source;  ///< vertex_count: the engine's vertex that stands there
    Index dropped_faces = 0;    ///< degenerate, double, third ones at an edge, or those where a one-sided surface closes on itself
    Index split_vertices = 0;   ///< vertices that came to stand twice, where parts of the surface touched in a point
};

/// A triangle is taken while none of its edges has two already. Then neighbours are oriented alike, and vertices whose triangles hang together only there are
/// split. Linear time but for a sort. Error "engine NAME is defective: ..." where a number is out of range or a point is not finite.
MendedMesh mend(const RawTriangles& raw, const std::string& engine);

/// Turns every component: outwards by its volume about its centre; open ones, where normals are given, so that most of their area agrees with them. The inner
/// wall of a hollow solid is turned outwards too. Every vertex has a face. normals: vertex_count x 3, or empty.
void orient(PolygonMesh& mesh, const std::vector<double>& normals);

}  // namespace lcl
