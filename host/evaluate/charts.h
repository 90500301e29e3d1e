// SPDX-License-Identifier: BSD-3-Clause
// Charts of a limit surface, and walking from one into the next.
//
// Catmull-Clark and Doo-Sabin: one unit square for each corner of each face, (0, 0) at (Doo-Sabin: near) the vertex, a along the edge to the next vertex, b
// along the one to the previous vertex, (1, 1) at the face's centre. Loop: one triangle for each face, (a, b) = (u, v). Doo-Sabin's squares reach on to -1
// where the edge that they begin at is sharp.
#pragma once

#include <array>

#include "host/evaluate/patch_table.h"

namespace lcl {

struct ChartPlace {
    Index corner = 0;  ///< of the mesh; Loop: the first one of the face
    double a = 0, b = 0;
};

/// A place as limitcl.h has it, with (u, v) by (a, b): u = .. + ua a + ub b, v likewise.
struct SurfacePlace {
    Index face = 0, corner = 0;
    double u = 0, v = 0;
    double ua = 1, ub = 0, va = 0, vb = 1;
};

class Charts {
public:
    /// Keeps a reference.
    explicit Charts(const PatchTable& table) : table_(table), topology_(table.refiner->steps().front().topology) {}

    bool are_triangles() const { return table_.scheme == Scheme::loop; }
    Index count() const { return are_triangles() ? topology_.face_count : topology_.half_edge_count(); }
    ChartPlace place(Index chart, double a, double b) const { return {are_triangles() ? topology_.face_offsets[chart] : chart, a, b}; }
    SurfacePlace surface_place(const ChartPlace& place) const;
    /// The other way: of a place as limitcl.h has it.
    ChartPlace chart_place(Index face, Index corner, double u, double v) const;
    /// Goes (da, db) on from a place, into neighbouring charts where that leads across their borders, along the boundary where it would lead outside.
    ChartPlace move(ChartPlace place, double da, double db) const;
    /// Which of the steps -a, -b and (Loop) a + b lead out of the surface here.
    std::array<bool, 3> walls(const ChartPlace& place) const;

    /// Where a chart begins: 0, or -1 beyond a sharp edge (Doo-Sabin).
    double low_a(Index corner) const;
    double low_b(Index corner) const;
    /// Whether it has a square where both are below 0.
    bool has_square_beyond_both(Index corner) const { return table_.square_beyond(corner, 2) >= 0; }

private:
    /// The next corner at the same vertex, across the edge to the next vertex (side 0) or to the previous one (1).
    Index across(Index corner, int side) const { return side == 0 ? topology_.next(topology_.twin[corner]) : topology_.twin[topology_.previous(corner)]; }
    Index end_of_sector(Index corner, int side) const;
    Index kept_square(Index corner) const;
    bool step_beyond_edges(ChartPlace& place) const;
    bool is_in_wide_corner(const ChartPlace& place) const;
    void leave_kept_square(ChartPlace& place) const;
    bool step_square(ChartPlace& place) const;
    bool step_triangle(ChartPlace& place) const;

    const PatchTable& table_;
    const Topology& topology_;
};

}  // namespace lcl
