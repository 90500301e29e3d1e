// SPDX-License-Identifier: BSD-3-Clause
// The kinds of irregular Catmull-Clark patches. Internal to host/evaluate.
#pragma once

#include "host/evaluate/patch_kind.h"

namespace lcl {

/// Where a patch lies at its first vertex V: quads all round, every other vertex of the patch regular.
///
/// Closed (whole rings, also with one sharp edge): N = faces, place 0. Control points, K = 2N + 8: V; E_0 .. E_(N-1), the ends of its edges; F_0 .. F_(N-1),
/// F_j the diagonal between E_j and E_(j+1), the patch's face that of F_0; then on the lattice of the patch with V = (0, 0), E_0 = (1, 0), E_1 = (0, 1) the
/// outer points (2,-1), (2,0), (2,1), (2,2), (1,2), (0,2), (-1,2).
///
/// Sectors (the faces between two sharp edges): V; E_0 .. E_k; F_0 .. F_(k-1), k = faces, the patch's face that of F_place; then the outer points, the first of
/// them only where place > 0 and the last where place < k - 1: beyond sharp edges there is nothing.
struct CatmullClarkPlace {
    enum class Ring { closed, sector };
    Ring ring = Ring::closed;
    bool is_corner = false;  ///< V stays; else smooth, a dart, or on a curve
    int faces = 0, place = 0;
    int sharp_edge = -1;  ///< closed: the sharp edge at V, -1 for none
};

/// Orbits where the ring is closed and smooth.
PatchKind catmull_clark_kind(const CatmullClarkPlace& place);

}  // namespace lcl
