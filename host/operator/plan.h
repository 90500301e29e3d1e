// SPDX-License-Identifier: BSD-3-Clause
// The plan of a limit operator: its rows in an order that is fast to sweep, as plain arrays, made without a device.
#pragma once

#include <cstdint>
#include <vector>

#include "host/operator/limit_rows.h"

namespace lcl {

/// Consecutive rows of one shape. Ring rows share their weights; weighted rows have their own.
struct Run {
    Index first = 0, count = 0;
    RowShape shape = RowShape::identity;
    int edges = 0;                   ///< edge ends of a ring row
    std::uint32_t index_offset = 0;  ///< ring: place of the first row's neighbours in `indices`; weighted: number of the first row among the weighted ones
    RingWeights weights;

    int stride() const { return shape == RowShape::ring ? edges : shape == RowShape::full_ring ? 2 * edges : 0; }
};

/// Consecutive rows that one work-group sweeps; blocks never cross a part.
struct Block {
    Index first_run = 0, run_count = 0, first_row = 0, row_count = 0;
};

/// Rows of one kind, as ranges of rows and of blocks.
struct Part {
    Index first_row = 0, row_count = 0, first_block = 0, block_count = 0;
    Index end_row() const { return first_row + row_count; }
    Index end_block() const { return first_block + block_count; }
};

struct PlanOptions {
    Index block_rows = 4096;           ///< rows a block holds at most: 4096 suit a CPU's cache
    std::vector<std::uint8_t> subset;  ///< empty, or 1 for each vertex that is interpolated
    std::vector<std::uint8_t> owned;   ///< empty, or 1 for each vertex that gets a row; the others are ghosts
};

/// Everything is in the plan's numbering: fixed rows, curves, darts, smooth rows, then ghosts without rows. Inside a part rows follow a breadth-first order of
/// the vertices, and inside a block rows of equal shape stand together, so that sweeps find neighbours in cache and take no branch a row. Rows that are not of
/// a scheme are fixed where they are identity rows, else smooth where a scaling makes them symmetric, else they stand where darts do: exact, without a
/// symmetric form.
struct Plan {
    Index vertex_count = 0, row_count = 0;
    Array<Index> vertex_of_row;  ///< vertex_count: caller's vertex; ghosts at the end
    Array<Index> row_of_vertex;  ///< the inverse
    Part fixed, curves, darts, smooth;
    Index reach = 0;           ///< smooth rows depend on smooth rows of blocks at most so many before or after their own
    Index isolated_count = 0;  ///< the first rows of the fixed part: vertices without a face, left out of sizes and norms
    std::vector<Run> runs;
    std::vector<Block> blocks;
    Array<Index> indices;                            ///< neighbours of ring rows, Run::stride() a row: edge ends, then diagonals; runs begin at even places
    std::vector<std::uint32_t> weighted_offsets{0};  ///< weighted_count + 1
    std::vector<Index> weighted_indices;
    std::vector<double> weighted_weights;
    /// row_count: D_ii that makes D A symmetric on the smooth part; elsewhere the same formula with n the number of faces, which weights sums over the mesh. 0
    /// for isolated vertices and blend ratios of 1.
    std::vector<double> scaling;
    bool has_scaling = true;       ///< false: rows that came without one; all of `scaling` is 0
    bool rows_sum_to_one = true;   ///< A maps a constant to itself
    std::vector<double> diagonal;  ///< row_count: A_ii
    double lambda_min_bound = 0;   ///< proven lower bound of the smooth part's spectrum (of rows without a scaling: of all eigenvalues); NaN if none is known
    bool has_valence_2 = false;    ///< a smooth vertex with fewer than three faces

    bool has_darts() const { return darts.row_count > 0; }
    Part all_rows() const { return {0, row_count, 0, static_cast<Index>(blocks.size())}; }
};

/// Builds the plan in linear time. OutOfMemory where neighbour lists would pass 2^32 - 1 entries.
Plan build_plan(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options, const PlanOptions& plan_options);

/// body(column, weight) for every entry of a row, in the order of the arrays; columns in the plan's numbering.
template <class Body>
void for_each_entry(const Plan& plan, const Run& run, Index row, const Body& body) {
    if (run.shape == RowShape::weighted) {
        const Index k = run.index_offset + (row - run.first);
        for (std::uint32_t e = plan.weighted_offsets[k]; e < plan.weighted_offsets[k + 1]; ++e) body(plan.weighted_indices[e], plan.weighted_weights[e]);
        return;
    }
    body(row, run.weights.vertex);
    const int stride = run.stride();
    const Index* neighbours = plan.indices.data() + run.index_offset + static_cast<std::size_t>(row - run.first) * stride;
    for (int i = 0; i < stride; ++i) body(neighbours[i], i < run.edges ? run.weights.edge : run.weights.diagonal);
}

/// Entries (columns in the plan's numbering, weights) of one row, in the order of the arrays.
LimitRow plan_row(const Plan& plan, const Run& run, Index row);

/// The run that holds a row.
const Run& run_of_row(const Plan& plan, Index row);

}  // namespace lcl
