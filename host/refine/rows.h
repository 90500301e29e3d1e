// SPDX-License-Identifier: BSD-3-Clause
// Two receivers for the rows of a refinement: the rules are written once and give either stencils or rows through sums. Internal to host/refine.
// Both offer begin(), add(vertex, weight), add_mean(face, weight), add_harmonic(corner, weight), end().
#pragma once

#include <vector>

#include "host/mesh/topology.h"
#include "host/refine/refine.h"

namespace lcl {

/// cos(2 pi j / m) for j = 0 .. m - 1, exact at quarter turns.
std::vector<double> cosines_of_turn(Index m);

/// Rows with stored weights that go through sums: means of faces, and the two sums of classic Doo-Sabin, are computed once and then taken as further points. So
/// they are linear in the mesh, also at faces and vertices of any degree.
struct SparseRows {
    Stencils sums;               ///< over the old vertices
    Stencils rows;               ///< over the old vertices, and behind them the sums
    std::vector<Index> targets;  ///< the refined vertex of each row; empty where row i is that of vertex i

    Index row_count() const { return static_cast<Index>(rows.offsets.size()) - 1; }
    Index sum_count() const { return static_cast<Index>(sums.offsets.size()) - 1; }
};

/// Makes them.
class SummedRows {
public:
    explicit SummedRows(const Topology& topology) : topology_(topology) {}

    void begin() {}
    void add(Index vertex, double weight);
    void add_mean(Index face, double weight);
    void add_harmonic(Index corner, double weight);
    void end() { out_.rows.offsets.push_back(out_.rows.indices.size()); }

    /// One row, of refined vertex `target`.
    template <class Add>
    void add_row_of(Index target, const Add& add_entries) {
        out_.targets.push_back(target);
        add_entries();
        end();
    }

    SparseRows take() { return std::move(out_); }

private:
    Index sums_of_face(std::vector<Index>& first, Index face);
    void add_sum_entry(Index corner, double weight);
    void end_sum() { out_.sums.offsets.push_back(out_.sums.indices.size()); }

    const Topology& topology_;
    SparseRows out_;
    std::vector<Index> mean_of_face_, harmonic_of_face_;  ///< numbers of sums, -1 where there is none yet
    std::vector<double> cosines_;
};

/// Rows kept as stencils; a vertex that is met several times in a row becomes one entry.
class StencilRows {
public:
    StencilRows(const Topology& topology, std::size_t row_count);

    void begin() { row_begin_ = stencils_.indices.size(); }
    void add(Index vertex, double weight);
    void add_mean(Index face, double weight);
    void add_harmonic(Index corner, double weight);
    void end() { stencils_.offsets.push_back(stencils_.indices.size()); }

    Stencils take() { return std::move(stencils_); }

private:
    const Topology& topology_;
    Stencils stencils_;
    std::size_t row_begin_ = 0;
    std::vector<std::size_t> entry_of_;  ///< per old vertex: its latest entry, of this row if it is not before row_begin_
    std::vector<double> cosines_;
};

}  // namespace lcl
