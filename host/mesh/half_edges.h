// SPDX-License-Identifier: BSD-3-Clause
// What building the topology and finding its defects share. Internal to host/mesh.
#pragma once

#include <vector>

#include "host/mesh/topology.h"

namespace lcl {

/// Half-edges in buckets by their lower vertex; inside a bucket in ascending order. A bucket plus one mark per vertex finds all half-edges of an edge in
/// linear time, also at a pole of any valence and without hashing.
struct HalfEdgeBuckets {
    struct Entry {
        Index half_edge;
        Index higher;  ///< the other, higher vertex
    };
    std::vector<Index> offsets;  ///< vertex_count + 1
    std::vector<Entry> entries;
};

/// Buckets of all half-edges of faces with skip[face] == 0 (an empty skip: of all). Their vertices must be in range.
HalfEdgeBuckets bucket_half_edges(const PolygonMesh& mesh, const std::vector<char>& skip);

/// No index out of range, no face with fewer than three corners or with a vertex twice, offsets that fit.
bool corners_are_sound(const PolygonMesh& mesh);

/// Every coordinate is finite.
bool positions_are_finite(const PolygonMesh& mesh);

/// Fills `topology` from a mesh with sound corners. False where it is no consistently oriented manifold; `topology` is then unfinished.
bool connect(const PolygonMesh& mesh, Topology& topology);

}  // namespace lcl
