// SPDX-License-Identifier: BSD-3-Clause
// Control points of Doo-Sabin patches by the half-edges of the mesh before the last refinement. Internal to host/evaluate.
//
// A refined vertex is a corner of an old face, that is a half-edge h, a point on a boundary edge, or a kept corner. Its patch is the square between the centres
// of the four refined faces round it; across a boundary the boundary row stands once more. On the lattice round the vertex of h, with the face that the old
// face becomes in the quadrant (+, +): (1, 0) is next(h), (0, 1) previous(h); below lies the face of h's edge, to the left that of the edge before, at (-1, -1)
// that of the old vertex, always with four sides: old vertices have four faces, boundary points two and kept corners one.
#pragma once

#include <array>
#include <vector>

#include "host/evaluate/patch_kind.h"
#include "host/refine/steps.h"

namespace lcl {

class DooSabinWalk {
public:
    using Nine = std::array<Index, 9>;  ///< in the order of a regular patch

    /// The vertices of the mesh that are kept corners are numbered from first_kept on.
    DooSabinWalk(const Topology& topology, const DooSabinLayout& layout, Index first_kept) : topology_(topology), layout_(layout), first_kept_(first_kept) {}

    /// The patch of half-edge h, of a face with four sides, turned by `quarters` counter-clockwise: its face in the quadrant (+, +), (-, +), (-, -), (+, -).
    Nine of_corner(Index h, int quarters) const;
    /// The patch of half-edge h with the centre of its face of n sides at (s, t) = (0, 0), in the order of the irregular kinds: the points of the face from h
    /// on; then on the lattice of the patch (1,-1), (1,0), (1,1), (0,1), (-1,1).
    void of_irregular_corner(Index h, Index n, Index* out) const;
    /// The patches of the two points of boundary half-edge h, and of the kept corner where h, of the one face there, begins: the curve at t = 0, s along it.
    Nine of_near_point(Index h) const;
    Nine of_far_point(Index h) const;
    Nine of_kept(Index h) const;

    Index near_point(Index h) const { return layout_.point(topology_, h); }     ///< next to the origin of h
    Index far_point(Index h) const { return layout_.point(topology_, h) + 1; }  ///< next to its destination
    Index kept(Index vertex) const { return layout_.kept_begin + vertex - first_kept_; }

private:
    Index diagonal(Index h) const;

    const Topology& topology_;
    const DooSabinLayout& layout_;
    Index first_kept_;
};

/// The kind of the patches at a face of n sides. K = n + 5.
PatchKind doo_sabin_kind(int n, DooSabinMask mask);

}  // namespace lcl
