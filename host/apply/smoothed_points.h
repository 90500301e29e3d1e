// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "host/mesh/features.h"

namespace lcl {

/// The points of a mesh, centred and scaled to a bounding box with a diagonal of about 1, after `times` applications of D A, D = E - (E - A)^3, A the
/// limit operator of Loop for triangles and of Catmull-Clark for other meshes (mesh expansion paper, eq. 8 with m = 2): for directions. D alone needs five
/// times as many passes to give directions as true. In double on the host.
std::vector<double> smoothed_points(const PolygonMesh& mesh, const Topology& topology, const Features& features, int times);

}  // namespace lcl
