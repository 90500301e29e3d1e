// SPDX-License-Identifier: BSD-3-Clause
// Limit points by OpenSubdiv, in double: an implementation of the masks that shares nothing with this project's.
#ifndef LIMITCL_BENCH_OPENSUBDIV_LIMIT_H
#define LIMITCL_BENCH_OPENSUBDIV_LIMIT_H

#include <array>
#include <vector>

namespace bench {

struct SharpMesh {
    std::vector<double> points;               ///< vertex_count x 3
    std::vector<int> face_degrees;            ///< face_count
    std::vector<int> face_vertices;           ///< sum of the degrees
    std::vector<std::array<int, 2>> creases;  ///< infinitely sharp edges
    std::vector<int> corners;                 ///< infinitely sharp vertices
    bool boundary_edge_only = false;          ///< else vertices with one face are corners
};

/// How a limit point was found.
enum class Found {
    by_mask,        ///< OpenSubdiv's limit mask (for Catmull-Clark after one refinement, whose faces are quads)
    by_refinement,  ///< darts and their neighbours: 60 refinements of the one-ring; OpenSubdiv's mask takes a dart for smooth
    left_out        ///< interior valence 2, where OpenSubdiv takes another mask; isolated vertices, which it does not know
};

struct LimitPoints {
    std::vector<double> points;  ///< vertex_count x 3
    std::vector<Found> found;    ///< vertex_count
};

/// Limit points of a sound mesh under Loop (triangles only) or Catmull-Clark. Throws std::runtime_error if OpenSubdiv refuses it.
LimitPoints opensubdiv_limit(const SharpMesh& mesh, bool loop);

}  // namespace bench

#endif
