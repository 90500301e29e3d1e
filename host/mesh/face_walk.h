// SPDX-License-Identifier: BSD-3-Clause
// Steps round a face. Meshes of quads or triangles alone need no look-up for them, which inner loops over all corners make use of.
#pragma once

#include "host/mesh/topology.h"

namespace lcl {

struct QuadWalk {
    Index next(Index h) const { return (h & ~3) | ((h + 1) & 3); }
    Index previous(Index h) const { return (h & ~3) | ((h + 3) & 3); }
    Index face(Index h) const { return h / 4; }
};

struct TriangleWalk {
    Index next(Index h) const { return h % 3 == 2 ? h - 2 : h + 1; }
    Index previous(Index h) const { return h % 3 == 0 ? h + 2 : h - 1; }
    Index face(Index h) const { return h / 3; }
};

struct PolygonWalk {
    const Topology& topology;
    Index next(Index h) const { return topology.next(h); }
    Index previous(Index h) const { return topology.previous(h); }
    Index face(Index h) const { return topology.half_edge_face[h]; }
};

/// body(walk) with the walk that suits the faces of the topology.
template <class Body>
auto with_face_walk(const Topology& topology, const Body& body) {
    if (topology.uniform_degree == 4) return body(QuadWalk{});
    if (topology.uniform_degree == 3) return body(TriangleWalk{});
    return body(PolygonWalk{topology});
}

}  // namespace lcl
