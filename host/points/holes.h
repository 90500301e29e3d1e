// SPDX-License-Identifier: BSD-3-Clause
// Filling of small holes.
#pragma once

#include "host/mesh/polygon_mesh.h"

namespace lcl {

constexpr int most_hole_edges = 1000;

/// Fills every boundary loop of at most so many edges by the triangles of least area on its vertices (Barequet & Sharir 1995); a loop that only triangles on
/// edges which are there already could fill stays open, and so does a sheet without inner vertices, which would be closed on itself. Written here, since no
/// library at hand that could be linked does it. The mesh is sound and of triangles. Time is the cube of a loop's length (1000: a second). Returns the number
/// of loops filled.
Index fill_holes(PolygonMesh& mesh, int most_edges);

}  // namespace lcl
