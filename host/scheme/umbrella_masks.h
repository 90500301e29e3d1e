// SPDX-License-Identifier: BSD-3-Clause
// Masks of the umbrella of a vertex all of whose faces are quads, on a Catmull-Clark mesh: limit point and limit tangents as weights of the vertex, its edge
// neighbours and the far corners of its faces. In the mesh M^1 of the two-phase scheme every old vertex has such an umbrella, and no two share a vertex.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/error.h"

namespace lcl {

/// Where in its sharp edges an umbrella lies.
enum class UmbrellaKind : std::uint8_t {
    smooth,    ///< n faces all round, no sharp edge
    boundary,  ///< n faces between the sharp edges E_0 and E_n, a curve vertex
    crease,    ///< n faces all round, sharp edges E_0 and E_second, a curve vertex
    dart,      ///< n faces all round, sharp edge E_0
    fixed      ///< a corner or an isolated vertex: the limit point is the vertex
};

/// Weights in the order V, E_0 .. E_(m - 1), F_0 .. F_(n - 1), F_j between E_j and E_(j + 1); m = n, at a boundary n + 1, in face order. Each entry holds the
/// weights of the limit point (they sum to 1) and of two tangents (their sums are 0), whose cross product looks to the side from which the order is
/// counter-clockwise.
struct UmbrellaMask {
    std::vector<std::array<double, 3>> weights;
    double inverse_square = 0;             ///< of the limit point's weights: 1 / sum a^2
    std::array<double, 6> inverse_gram{};  ///< of the three masks: (0,0) (0,1) (0,2) (1,1) (1,2) (2,2); 0 without tangents
    bool has_tangents = false;
};

/// n: faces (of `fixed`: 0). second: of `crease`. Limit points are exact; tangents:
/// - smooth, n >= 3: two-phase paper, section 3.4: L1 and, instead of its L2, the same with sines for cosines: the two are orthogonal, and
///   L2 = cos(2 pi/n) L1 + sin(2 pi/n) L1' leaves plane and side as they are. (Source slip: the scanned text gives L1 and L2 equal weights on the edges.)
/// - boundary, 2 <= n <= 4: E_0 - E_n along the curve, and the eigenvector across it. For n >= 5 there is no tangent plane, for n = 1 none in general.
/// - others: none here.
UmbrellaMask umbrella_mask(UmbrellaKind kind, Index n, Index second = 0);

}  // namespace lcl
