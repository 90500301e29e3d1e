// SPDX-License-Identifier: BSD-3-Clause
// What the mesh alone says of a scheme on it: whether it fits, and whether A P = M can be solved.
#pragma once

#include <string>
#include <vector>

#include "host/mesh/features.h"
#include "host/scheme/scheme.h"

namespace lcl {

/// Why a scheme does not fit a mesh; empty message if it does.
struct Objection {
    std::string message;
    std::vector<Index> vertices, faces;  ///< the first ten
};

/// Loop on faces that are no triangles.
Objection scheme_objection(const Topology& topology, const SchemeOptions& options);

/// Exact criterion: Catmull-Clark with alpha = lambda = 0 is singular exactly when a closed smooth component, all of it interpolated, has only valence 3 and a
/// bipartite edge graph (cube, even prisms, truncated octahedron, hexagonal tori): +1/-1 on the two classes is then a null vector. The message names the
/// component's vertices and the cure. Linear time.
Objection find_singular_component(const Topology& topology, const Features& features, const SchemeOptions& options, const std::vector<std::uint8_t>& subset);

}  // namespace lcl
