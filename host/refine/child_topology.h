// SPDX-License-Identifier: BSD-3-Clause
// Topology of a refined mesh by arithmetic on the half-edges of its parent (Dupuy and Vanhoey, "A Halfedge Refinement Rule for Parallel Catmull-Clark
// Subdivision", 2021, and the same for Loop), with limitcl's numbers: to the number what build_topology and find_features give for that mesh, in a fraction of
// the time. Children of half-edge h:
// - Catmull-Clark: 4h from the corner's old vertex to the edge point of h, 4h + 1 on to the face point, 4h + 2 on to the edge point before, 4h + 3 back.
// - Loop, h = 3f + k: 12f + 3k from the corner's old vertex to the edge point of h, 12f + 3k + 1 on to the edge point before, 12f + 3k + 2 back; 12f + 9 + k in
//   the middle triangle, from the edge point of h to that of the next one.
// Internal to host/refine.
#pragma once

#include "host/mesh/features.h"
#include "host/mesh/topology.h"

namespace lcl {

enum class TopologyPart : std::uint8_t {
    faces,  ///< counts (of edges too), uniform_degree and face_vertices alone: what the last level is made for
    all
};

Topology catmull_clark_topology(const Topology& parent, TopologyPart part);
/// Triangles only.
Topology loop_topology(const Topology& parent, TopologyPart part);

/// Features of the mesh that catmull_clark_topology or loop_topology made (all of it) of a parent with these.
Features child_features(const Topology& parent, const Features& features, const Topology& child);

}  // namespace lcl
