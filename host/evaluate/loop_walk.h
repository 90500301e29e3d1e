// SPDX-License-Identifier: BSD-3-Clause
// Control points of Loop patches, by the half-edges of the refined mesh. Internal to host/evaluate.
//
// The refined mesh needs no topology of its own: it follows from that of the mesh which is refined. Child k < 3 of face f is (V_k, e_k, e_(k-1)), e_k the point
// of the edge that begins at V_k, child 3 is (e_0, e_1, e_2), and the half-edges of child k are 12 f + 3 k + 0 .. 2.
//
// A patch is given by the half-edge h from its first vertex V to its second one, A; the third is B. On the lattice of the patch V = (0, 0), A = (1, 0),
// B = (0, 1). A and B are regular: six triangles round them, or three between the two edges of a sharp curve.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>

#include "host/evaluate/patch_kind.h"
#include "host/mesh/features.h"
#include "host/mesh/topology.h"
#include "host/refine/refine.h"

namespace lcl {

/// What a patch's first vertex is. Sectors, of curves and corners, are the triangles from one sharp edge to the next; a corner with one sharp edge has one
/// sector, from both its sides.
enum class LoopRound : std::uint8_t {
    regular,  ///< six triangles, three of a curve, or the one of a corner
    smooth,
    dart,
    corner,  ///< without sharp edges
    curve_sector,
    corner_sector
};

/// Where a patch lies round its first vertex.
///
/// Closed rings, K = count + 6: V; E_0 .. E_(count-1), the ends of its edges from A on; then the outer points (2,-1), (2,0), (1,1), (0,2), (-1,2). `place` is
/// that of the dart's sharp edge.
///
/// Sectors: V; E_0 .. E_count, with A = E_place; then the outer points, the first of them only where place > 0 and the last where place < count - 1: beyond
/// sharp edges there is nothing.
struct LoopPlace {
    LoopRound round = LoopRound::regular;
    Index count = 0;  ///< triangles
    Index place = 0;

    bool is_sector() const { return round == LoopRound::curve_sector || round == LoopRound::corner_sector; }
    int point_count() const {
        if (round == LoopRound::regular) return 12;
        return is_sector() ? count + 5 + static_cast<int>(place > 0) + static_cast<int>(place < count - 1) : count + 6;
    }
    bool operator<(const LoopPlace& other) const { return std::tie(round, count, place) < std::tie(other.round, other.count, other.place); }
};

/// A mesh of triangles refined once: next to nothing is stored.
class RefinedTriangles {
public:
    RefinedTriangles(const Topology& topology, const Features& features) : topology_(topology), features_(features) {}

    Index half_edge_count() const { return 4 * topology_.half_edge_count(); }
    Index vertex_count() const { return topology_.vertex_count + topology_.edge_count; }
    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
    Index origin(Index h) const;
    Index destination(Index h) const { return origin(next(h)); }
    Index twin(Index h) const;
    Index rotate(Index h) const { return twin(previous(h)); }
    bool is_sharp(Index h) const;
    bool has_sharp_edges() const { return topology_.boundary_edge_count > 0 || features_.crease_count > 0; }
    VertexKind kind(Index v) const;
    Index face_count(Index v) const { return v < topology_.vertex_count ? topology_.vertex_face_count[v] : 6; }
    /// The control points of the patch at h, the first half-edge of a child, where its three vertices are smooth and have six triangles: what most patches are.
    std::array<Index, 12> smooth_points(Index h) const;

private:
    std::array<Index, 12> smooth_corner_points(Index h) const;
    std::array<Index, 12> smooth_middle_points(Index face) const;
    Index edge_point(Index coarse) const { return topology_.vertex_count + topology_.half_edge_edge[coarse]; }

    const Topology& topology_;
    const Features& features_;
};

class LoopWalk {
public:
    /// Topology and features of the mesh that is refined. Ghosts, which follow the refined vertices: for each half-edge ab on a sharp edge, of face abc, the
    /// point a + b - c across it; and where the face is the only one between two sharp edges, the point that continues the edge beyond their common end.
    LoopWalk(const Topology& topology, const Features& features);

    const Stencils& ghosts() const { return ghosts_; }

    LoopPlace place(Index h) const;
    /// The place().point_count() control points of patch h.
    void points(Index h, const LoopPlace& place, Index* out) const;
    void regular_points(Index h, Index* out) const;

private:
    struct Sector {
        Index first = 0;   ///< outgoing half-edge of the first triangle
        Index before = 0;  ///< triangles before that of h
        Index count = 0;
    };

    bool has_sharp_edge(Index h) const;
    bool is_smooth(Index h) const;
    Sector sector_of(Index h) const;
    void six_round(Index h, Index* six) const;
    void six_round_sector(Index h, Index* six) const;
    Index* ring(Index h, const LoopPlace& place, Index* out) const;
    void number_ghosts();

    RefinedTriangles fine_;
    std::vector<Index> first_ghost_;  ///< per refined half-edge: -1 where not sharp; empty where no edge is. Across, then beyond the end
    Stencils ghosts_;
};

/// The kind of an irregular place. Orbits where the ring is smooth.
PatchKind loop_kind(const LoopPlace& place);

}  // namespace lcl
