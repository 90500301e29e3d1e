// SPDX-License-Identifier: BSD-3-Clause
// Sharp features: which edges are sharp (boundary and creases) and what that makes of each vertex.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/mesh/topology.h"

namespace lcl {

enum class BoundaryRule : std::uint8_t {
    edge_and_corner,  ///< boundary curves; vertices with one face are corners
    edge_only,        ///< boundary curves everywhere
    fixed             ///< every boundary vertex is a corner
};

enum class VertexKind : std::uint8_t {
    smooth,   ///< no sharp edge
    dart,     ///< one sharp edge
    curve,    ///< two sharp edges
    corner,   ///< three or more, or marked: stays where it is
    isolated  ///< no face: stays where it is
};

/// What a caller asks for, beside the boundary itself.
struct FeatureOptions {
    BoundaryRule boundary = BoundaryRule::edge_and_corner;
    std::vector<std::array<Index, 2>> creases;  ///< vertex pairs; a pair that is no edge is BadInput
    std::vector<Index> corners;                 ///< vertices; out of range is BadInput
    double crease_angle_degrees = -1;           ///< edges whose two face normals (Newell) differ by more are creases; below 0: off
};

struct Features {
    std::vector<std::uint8_t> edge_is_sharp;  ///< edge_count, 1 for boundary edges and creases
    Array<VertexKind> kind;                   ///< vertex_count
    /// vertex_count: for curve vertices the other ends of the two sharp edges, for darts that of the one (twice), else {-1, -1}.
    /// At a boundary: [0] the end of the outgoing boundary half-edge (E_0), [1] the last edge's (E_k). Empty where no edge is sharp and no vertex marked.
    Array<std::array<Index, 2>> curve_neighbours;
    Index crease_count = 0;  ///< sharp edges off the boundary
    Index corner_count = 0;  ///< vertices that stay, isolated ones not counted
};

/// Classifies edges and vertices. Positions (mesh) are used for the crease angle alone. Linear time.
Features find_features(const PolygonMesh& mesh, const Topology& topology, const FeatureOptions& options);

/// Fills curve_neighbours of features whose edges and vertices are classified.
void find_curve_neighbours(const Topology& topology, Features& features);

}  // namespace lcl
