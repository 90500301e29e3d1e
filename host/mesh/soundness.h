// SPDX-License-Identifier: BSD-3-Clause
// What building the topology and finding its defects share. Internal to host/mesh.
#pragma once

#include "host/mesh/topology.h"

namespace lcl {

/// No index out of range, no face with fewer than three corners or with a vertex twice, offsets that fit.
bool corners_are_sound(const PolygonMesh& mesh);

/// Fills `topology` from a mesh with sound corners. False where it is no consistently oriented manifold; `topology` is then unfinished.
bool connect(const PolygonMesh& mesh, Topology& topology);

}  // namespace lcl
