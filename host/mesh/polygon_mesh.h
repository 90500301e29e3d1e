// SPDX-License-Identifier: BSD-3-Clause
// A polygon mesh as plain arrays: what readers make, what topology is built from, what refinement gives back.
#pragma once

#include <vector>

#include "host/error.h"

namespace lcl {

/// Faces as offsets + indices; face f has corners face_offsets[f] .. face_offsets[f + 1] - 1.
struct PolygonMesh {
    Index vertex_count = 0;
    std::vector<Index> face_offsets{0};  ///< face_count + 1
    std::vector<Index> face_vertices;    ///< zero-based vertex of every corner, faces one after the other
    std::vector<double> positions;       ///< vertex_count x 3, model units

    Index face_count() const { return static_cast<Index>(face_offsets.size()) - 1; }
    Index corner_count() const { return static_cast<Index>(face_vertices.size()); }
    Index degree(Index face) const { return face_offsets[face + 1] - face_offsets[face]; }
};

}  // namespace lcl
