// SPDX-License-Identifier: BSD-3-Clause
// Stencils of the limit tangents at one vertex at a time, in double and in the caller's numbering: one pair for each of its sectors.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "host/mesh/features.h"
#include "host/mesh/topology.h"
#include "host/scheme/tangent_masks.h"

namespace lcl {

/// Faces round a vertex between two sharp edges, or all of them where it has fewer than two.
struct TangentSector {
    Index first = -1;  ///< outgoing half-edge of its first face, in face order
    int faces = 0;
    bool closed = false;
};

/// Three tangents over the same columns. The normal is first x second, but first x spare where these two are parallel (the two edges of a corner that form a
/// straight line): the next term of the surface's expansion. The spare one may be 0.
struct TangentRow {
    struct Entry {
        Index column;
        std::array<double, 3> weights;
    };
    std::vector<Entry> entries;  ///< every column once, ascending; the weights of each tangent sum to 0
};

/// Sums of absolute weights of a tangent: what floats hold with tangents of tiny faces, whose squares are squared again, in the middle of their range.
constexpr double tangent_scale = 1 << 20;

/// Gives tangents for a sound mesh that the scheme fits. Keeps references to its arguments. Not for several threads at once (masks are cached by valence).
///
/// What is a limit and what a choice (math: doc of the C API, lcl_tangents):
/// - no sharp edge, darts: first and second eigenvector round the vertex; choices at two faces, at Doo-Sabin's darts (the tip of its slit), at corners without
/// sharp edges (spikes).
/// - sectors of one face, Loop's corners of two, Doo-Sabin's corners: E_0 - V and E_k - V.
/// - others: E_0 - E_k along the curve, and the tangent across it; choices at corners of other sectors, and above four faces (Loop: six).
class TangentRows {
public:
    TangentRows(const Topology& topology, const Features& features, const SchemeOptions& options);

    /// In face order from the vertex's own half-edge on; none at an isolated vertex.
    void sectors(Index v, std::vector<TangentSector>& out) const;
    /// Into memory that is used again.
    void row(Index v, const TangentSector& sector, TangentRow& row);

private:
    bool is_sharp(Index half_edge) const { return features_.edge_is_sharp[topology_.half_edge_edge[half_edge]] != 0; }
    const TangentMasks& closed_masks(int n, bool dart);
    void set_edges(const TangentSector& sector);
    void add_closed(Index v, TangentRow& row);
    void add_ends(Index v, TangentRow& row);
    void add_spare(Index v, TangentRow& row);
    void add_curve(Index v, TangentRow& row);
    void add_mask(Index v, const TangentMask& mask, int tangent, TangentRow& row);
    void add_refined(Index v, const TangentMask& mask, int tangent, TangentRow& row);
    void add_refined_vertex(Index v, double weight, int tangent, TangentRow& row);
    void add_mean(Index half_edge, double weight, int tangent, TangentRow& row) const;
    void add_doo_sabin_point(Index half_edge, double weight, int tangent, TangentRow& row) const;
    void add_doo_sabin_across(Index v, TangentRow& row) const;

    const Topology& topology_;
    const Features& features_;
    const SchemeOptions& options_;
    std::map<int, TangentMasks> smooth_masks_, dart_masks_;  // by valence
    // of the sector at hand
    TangentSector sector_;
    std::vector<Index> half_edges_;    // outgoing, one a face
    std::vector<Index> ends_;          // E_0 .., one more than faces where it is open
    std::vector<std::uint8_t> sharp_;  // of these
};

}  // namespace lcl
