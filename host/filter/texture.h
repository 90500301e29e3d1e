// SPDX-License-Identifier: BSD-3-Clause
// Procedural texture by interpolated octaves of noise (mesh expansion paper, section 5).
#pragma once

#include <cstdint>
#include <vector>

#include "host/apply/noise.h"
#include "host/refine/refine.h"
#include "host/solve/solve.h"

namespace lcl {

struct TextureOptions {
    int octaves = 4;       ///< 1 to most_octaves
    int levels = 3;        ///< K, octaves - 1 at least
    double frequency = 8;  ///< F, noise cells across the diagonal in the first octave
    std::uint32_t seed = 0;
    SolveOptions solve;  ///< of every octave: precision, tolerance (relative to the range of its noise), max_iterations, keep_going, progress
};

struct Texture {
    Refinement refined;         ///< G_K with its vertices at their limit points; no stencils, no parents
    std::vector<double> noise;  ///< t in [0, 1], one a vertex
    FurtherChannels further;    ///< at the limit points
    SolveReport report;         ///< of the worst solve: one that failed, else the one with the largest error for its tolerance. Lengths are values of noise
    bool is_given = false;      ///< false where a solve failed and options do not say to keep going: then only the report is filled
};

/// G_0 is `mesh`, read with `features` (no crease angle); `coarsest` is its system, whose scheme holds alpha and lambda and which may have a subset.
/// - N_i = f(2^i p)/2^i at the vertices of G_i, 0 <= i < octaves, p = F (x - centre)/diagonal + noise_offset(seed), with the bounding box of G_0.
/// - A_i P_i = N_i. All octaves are added as control values of finer meshes, which is exact, as refinement is linear: C_0 = P_0, C_(i+1) = R C_i + P_(i+1).
/// - N = A_K C_K, and t = (N - min)/(max - min) over the vertices that a face uses, 1/2 where all N are one to rounding.
/// Costs `octaves` solves of one channel, K refinements and one pass on G_K.
/// Errors: OutOfMemory, before anything large is made, with the number; Cancelled; those of make_limit_system, refine and solve_host.
Texture make_texture(LimitSystem& coarsest, const PolygonMesh& mesh, const FeatureOptions& features, FurtherChannels further, const TextureOptions& options);

}  // namespace lcl
