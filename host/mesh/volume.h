// SPDX-License-Identifier: BSD-3-Clause
// Volumes that closed meshes enclose.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/mesh/topology.h"

namespace lcl {

/// Volume inside each component of a closed mesh: faces as fans round the mean of their corners, positive where they look outwards. BadInput for a mesh with a
/// boundary. positions: vertex_count x 3.
std::vector<double> component_volumes(const PolygonMesh& mesh, const Topology& topology, const std::vector<double>& positions);

/// Moves the vertices of each component along their normals (area-weighted), all by one distance, until it encloses the volume that it has with `before`;
/// is_fixed marks vertices that stay. Returns a sentence for each component that is left as it is, because that volume is none or cannot be reached.
std::vector<std::string> match_volumes(const PolygonMesh& mesh, const Topology& topology, const std::vector<double>& before,
                                       const std::vector<std::uint8_t>& is_fixed, std::vector<double>& positions);

}  // namespace lcl
