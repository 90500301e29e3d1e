// SPDX-License-Identifier: BSD-3-Clause
// Masks of limit tangents, as functions of valence alone: left eigenvectors of the subdivision matrix of a vertex's surroundings for its largest eigenvalues
// below 1. Lengths of tangents mean nothing. Around a vertex V in face order: face F_j lies between the edges E_j and E_(j+1).
#pragma once

#include <array>
#include <vector>

#include "host/scheme/scheme.h"

namespace lcl {

/// Weights of one tangent on an umbrella: V, E_0 .. and F_0 ... They sum to 0. Catmull-Clark: on the umbrella after the first refinement; Loop (no faces): on
/// any, the mesh's own too.
struct TangentMask {
    double vertex = 0;
    std::vector<double> edges, faces;
};
/// first x second looks outwards.
using TangentMasks = std::array<TangentMask, 2>;

/// Smooth vertex with n faces all round it (two-phase paper, L1 and L2 of equation 15 as cosine and sine): edges A_n cos(j t), faces cos(j t) + cos((j+1) t), t
/// = 2 pi/n, A_n = 1 + cos t + cos(pi/n) sqrt(2 (9 + cos t)). n = 2: E_0 - E_1 and F_0 - F_1, a choice, since the surface has no tangent plane there.
TangentMasks catmull_clark_tangents(int n);
/// sum cos(j t) E_j and sum sin(j t) E_j. n = 2: the second is 0.
TangentMasks loop_tangents(int n);

/// Vertex with one sharp edge, E_0: symmetric to it (the eigenvector is found by inverse iteration, O(n^3)) and antisymmetric, as at a smooth vertex.
TangentMasks catmull_clark_dart_tangents(int n);
TangentMasks loop_dart_tangents(int n);

/// Curve vertex with k faces between its two sharp edges E_0 and E_k: the tangent across the curve, into the faces; E_0 - E_k is the one along it. k >= 2. A
/// limit for k up to 4 (Catmull-Clark) and 6 (Loop); beyond, other modes decay more slowly than the curve's, and this is a choice.
TangentMask catmull_clark_across(int k);
TangentMask loop_across(int k);

/// Ring of a smooth vertex whose faces are all quads (has_diagonals) or all triangles: cosine and sine weight of each of E_0 .. E_(n-1), then of each of F_0 ..
/// F_(n-1), on the mesh itself. Alpha and the blend ratio have no effect. n >= 3.
std::vector<double> ring_tangent_weights(const SchemeOptions& options, int n, bool has_diagonals);

}  // namespace lcl
