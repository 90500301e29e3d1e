// SPDX-License-Identifier: BSD-3-Clause
// Weights of the limit masks, as functions of valence and face degree alone.
#pragma once

#include <vector>

#include "host/scheme/scheme.h"

namespace lcl {

/// Limit mask of a vertex whose one-ring is all triangles or all quads: one weight for the vertex, one for each edge end, one for each face diagonal.
/// vertex + n * edge + n * diagonal = 1.
struct RingWeights {
    double vertex = 1, edge = 0, diagonal = 0;
};

/// Smooth interior vertex of valence n, all faces quads (has_diagonals) or all triangles. The blend ratio is not in it.
/// Catmull-Clark: mesh expansion paper (generalised by alpha). Loop: Loop PIA paper, alpha_n. Doo-Sabin: centroid of the new vertex-face.
RingWeights smooth_ring_weights(const SchemeOptions& options, int n, bool has_diagonals);

/// Loop: alpha_n = 3 / (11 - 8 (3/8 + (3/8 + cos(2 pi/n)/4)^2)), weight of the vertex in its limit mask.
double loop_limit_vertex_weight(int n);

/// Loop: beta_n = (1/n) (5/8 - (3/8 + cos(2 pi/n)/4)^2), weight of a neighbour in the refined vertex. Source slip, Loop PIA paper: the square was lost.
double loop_refined_edge_weight(int n);

/// Doo-Sabin: weight, in the new point of a corner, of the corner j steps away in its face of m sides.
double doo_sabin_weight(DooSabinMask mask, int m, int j);

/// Boundary or crease curve: (L + 4 V + R)/6 for Catmull-Clark and Loop (cubic B-spline), (L + 6 V + R)/8 for Doo-Sabin (quadratic).
RingWeights curve_weights(Scheme scheme);

/// (lambda E + (1 - lambda) A): the two-phase paper's blend (its equation 5 for alpha = 0).
RingWeights blend(const RingWeights& weights, double lambda);

/// The factor D_ii of a smooth row that makes D A symmetric: n (n + 5), n / (1 - alpha_n), n; divided by 1 - lambda. lambda < 1.
double symmetric_scaling(Scheme scheme, int n, double lambda);

/// Lower bound that a smooth vertex of valence n gives for the spectrum: lambda_min is at least the smallest of all.
/// Catmull-Clark (n - 3 + 2 alpha)/(n + 5), Loop (3 alpha_n - 1)/2, Doo-Sabin 1/4; two-phase: lambda + (1 - lambda) of it. n >= 3.
double lambda_min_bound(const SchemeOptions& options, int n, double lambda);

/// Catmull-Clark vertex with one sharp edge (dart), smooth vertex rule and midpoint on that edge: weights of the limit point on the umbrella after the first
/// refinement, [V, E_0 .. E_(n-1), F_0 .. F_(n-1)] with E_0 the sharp edge: the left eigenvector, for the eigenvalue 1, of the umbrella's subdivision matrix.
std::vector<double> catmull_clark_dart_weights(int n);

/// Loop dart: the same on [V, E_0 .. E_(n-1)], before any refinement.
std::vector<double> loop_dart_weights(int n);

}  // namespace lcl
