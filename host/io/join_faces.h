// SPDX-License-Identifier: BSD-3-Clause
// Faces that were read in parts.
#pragma once

#include <limits>

#include "host/mesh/polygon_mesh.h"

namespace lcl {

template <class T>
void append(std::vector<T>& whole, std::vector<T>& part, std::ptrdiff_t skipped = 0) {
    whole.insert(whole.end(), part.begin() + skipped, part.end());
    part = {};
}

/// True if the corners of both can be numbered.
inline bool fit_together(const PolygonMesh& whole, const PolygonMesh& part) {
    return whole.face_vertices.size() + part.face_vertices.size() <= static_cast<std::size_t>(std::numeric_limits<Index>::max());
}

/// Appends the faces of a part, which loses them.
inline void append_faces(PolygonMesh& whole, PolygonMesh& part) {
    const Index corners = whole.corner_count();
    for (Index& offset : part.face_offsets) offset += corners;
    append(whole.face_offsets, part.face_offsets, 1);
    append(whole.face_vertices, part.face_vertices);
}

}  // namespace lcl
