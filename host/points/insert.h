// SPDX-License-Identifier: BSD-3-Clause
// Points of the cloud become vertices where the surface is too far from them.
#pragma once

#include <vector>

#include "host/points/fit_mesh.h"

namespace lcl {

/// A point that is too far from the surface, and the face that the surface comes nearest to it in.
struct FarPoint {
    Index point = 0, face = 0;
    double distance = 0;
};

struct InsertOptions {
    double most_turn_degrees = 60;  ///< of a face's normal by a point that is put into it
    std::size_t max_vertices = 0;   ///< of the mesh; 0: no matter how many
    double feature_degrees = 30;    ///< edges whose faces differ by more are not flipped
};

/// Puts the farthest point of each face into it, the farthest of all first: on the nearest edge, or inside, where it lies there. Faces that have
/// changed wait for the next round. No point is put where it would turn a face's normal by more than most_turn_degrees: such points lie off the surface. Edges
/// round the new vertices are flipped where that makes them Delaunay (the angles opposite to them sum to no more than 180 degrees). points: of the cloud, n
/// x 3. Returns the number of new vertices.
std::size_t insert_points(FitMesh& mesh, std::vector<FarPoint> far, const std::vector<double>& points, const InsertOptions& options);

}  // namespace lcl
