// SPDX-License-Identifier: BSD-3-Clause
// Rows of the limit operator A, one vertex at a time, in double and in the caller's numbering. Masks: mesh expansion, Loop PIA, two-phase and Doo-Sabin papers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "host/mesh/features.h"
#include "host/mesh/topology.h"
#include "host/scheme/masks.h"
#include "host/scheme/scheme.h"

namespace lcl {

/// What the solver has to know of a row.
enum class RowKind : std::uint8_t {
    fixed,   ///< identity: corners, isolated vertices, vertices outside the subset, blend ratio 1
    curve,   ///< on a boundary or crease curve: depends on two neighbours on it
    dart,    ///< one sharp edge, or a caller's row without a scaling: exact row, without a symmetric form
    smooth,  ///< interior: symmetric under the scaling D
    ghost    ///< no row: the value comes from elsewhere
};

/// How the weights of a row are had.
enum class RowShape : std::uint8_t {
    identity,
    ring,       ///< weights of RingWeights on [edge ends]
    full_ring,  ///< weights of RingWeights on [edge ends, face diagonals]
    weighted    ///< own weights: polygons, darts, one blend ratio a vertex
};

struct RowClass {
    RowKind kind = RowKind::smooth;
    RowShape shape = RowShape::weighted;
    int edges = 0;  ///< number of edge ends of a ring
};

/// Entries of one row.
struct LimitRow {
    std::vector<Index> columns;
    std::vector<double> weights;
};

/// Gives rows of A for a sound mesh. Keeps references to its arguments. Not for several threads at once (dart weights are cached).
class LimitRows {
public:
    /// subset: empty, or 1 for each vertex that is interpolated; owned: empty, or 1 for each vertex that gets a row.
    LimitRows(const Topology& topology, const Features& features, const SchemeOptions& options, const std::vector<std::uint8_t>& subset,
              const std::vector<std::uint8_t>& owned);

    RowClass classify(Index v) const;
    /// Neighbours of a ring row: edge ends E_0 .. in face order, then for full_ring the diagonals F_0 ... `out` has room for edges or 2 edges. walk: of
    /// face_walk.h.
    template <class Walk>
    void ring_neighbours(const Walk& walk, Index v, const RowClass& row, Index* out) const {
        if (row.kind == RowKind::curve) {
            std::copy(features_.curve_neighbours[v].begin(), features_.curve_neighbours[v].end(), out);
            return;
        }
        const Index* const fan = topology_.fan_half_edges.data() + topology_.fan_offsets[v];
        for (int i = 0; i < row.edges; ++i) {
            const Index next = walk.next(fan[i]);
            out[i] = topology_.face_vertices[next];
            if (row.shape == RowShape::full_ring) out[row.edges + i] = topology_.face_vertices[walk.next(next)];
        }
    }
    /// The whole row, every column once, in ascending order.
    LimitRow row(Index v);
    /// The same into memory that is used again.
    void row(Index v, LimitRow& row);
    /// Weights of all ring rows with so many edge ends.
    RingWeights ring_weights(const RowClass& row) const;

private:
    /// Degree of all faces at v, 0 where they differ.
    Index common_degree(Index v) const;
    void add_smooth(Index v, LimitRow& row) const;
    void add_dart(Index v, LimitRow& row);
    void add_catmull_clark_dart(Index v, Index first, const std::vector<double>& weights, LimitRow& row) const;

    const Topology& topology_;
    const Features& features_;
    const SchemeOptions& options_;
    const std::vector<std::uint8_t>& subset_;
    const std::vector<std::uint8_t>& owned_;
    std::map<int, std::vector<double>> dart_weights_;  // by valence
};

}  // namespace lcl
