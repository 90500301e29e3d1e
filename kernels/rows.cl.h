// SPDX-License-Identifier: BSD-3-Clause
// The row gather that the kernels share: A x for every row of a block, without stored weights on ring rows (weights follow from valence and face degree; mesh expansion paper, Loop PIA
// paper, Doo-Sabin paper), with stored ones on weighted rows.
//
// One work-group of LCL_GROUP work-items sweeps one block; each row belongs to one work-item, so writes to that row cannot collide and results do not depend on scheduling.
#ifndef LCL_ROWS_CL_H
#define LCL_ROWS_CL_H

#include "types.cl.h"

/// blocks, runs: the plan's. run_weights: 3 a run (vertex, edge, diagonal). indices: neighbours of ring rows. weighted_*: offsets (count + 1), columns and weights of weighted rows.
#define LCL_STENCILS                                                                                                                                           \
    const __global lcl_block *restrict blocks, const __global lcl_run *restrict runs, const __global weight *restrict run_weights,                             \
        const __global int *restrict indices, const __global uint *restrict weighted_offsets, const __global int *restrict weighted_indices,                   \
        const __global weight *restrict weighted_weights

/// Ring rows of one run, `edges` edge ends and (full) as many diagonals; constants for `edges` and `full` let the compiler unroll the loops.
#define LCL_RING_ROWS(edges, full, x, UPDATE)                                                                                                                  \
    for (int i = lane; i < run.count; i += LCL_GROUP) {                                                                                                        \
        const __global int *restrict neighbours = indices + run.index_offset + (uint)i * ((full) ? 2 * (edges) : (edges));                                     \
        realn edge_sum = x[neighbours[0]];                                                                                                                     \
        for (int j = 1; j < (edges); ++j) edge_sum = lcl_add(edge_sum, x[neighbours[j]]);                                                                      \
        realn ax = lcl_add(lcl_scale(vertex_weight, x[run.first + i]), lcl_scale(edge_weight, edge_sum));                                                      \
        if (full) {                                                                                                                                            \
            realn diagonal_sum = x[neighbours[edges]];                                                                                                         \
            for (int j = 1; j < (edges); ++j) diagonal_sum = lcl_add(diagonal_sum, x[neighbours[(edges) + j]]);                                                \
            ax = lcl_add(ax, lcl_scale(diagonal_weight, diagonal_sum));                                                                                        \
        }                                                                                                                                                      \
        UPDATE(run.first + i, ax, vertex_weight);                                                                                                              \
    }

#define LCL_WEIGHTED_ROWS(x, UPDATE)                                                                                                                           \
    for (int i = lane; i < run.count; i += LCL_GROUP) {                                                                                                        \
        realn ax = lcl_zero();                                                                                                                                 \
        weight own = vertex_weight;                                                                                                                            \
        const uint row_end = weighted_offsets[run.index_offset + i + 1];                                                                                       \
        for (uint k = weighted_offsets[run.index_offset + i]; k < row_end; ++k) {                                                                              \
            const int column = weighted_indices[k];                                                                                                            \
            if (column == run.first + i) own = weighted_weights[k];                                                                                            \
            ax = lcl_add(ax, lcl_scale(weighted_weights[k], x[column]));                                                                                       \
        }                                                                                                                                                      \
        (void)own; /* most updates do without */                                                                                                               \
        UPDATE(run.first + i, ax, own);                                                                                                                        \
    }

/// UPDATE(row, ax, a_ii) for every row of `block`, by work-item `lane` of its group.
#define LCL_FOR_EACH_ROW(block, x, UPDATE)                                                                                                                     \
    for (int index = block.first_run; index < block.first_run + block.run_count; ++index) {                                                                    \
        const lcl_run run = runs[index];                                                                                                                       \
        const weight vertex_weight = run_weights[3 * index], edge_weight = run_weights[3 * index + 1], diagonal_weight = run_weights[3 * index + 2];           \
        switch (run.shape * 16 + (run.edges < 16 ? run.edges : 0)) {                                                                                           \
            case LCL_SHAPE_RING * 16 + 2: LCL_RING_ROWS(2, 0, x, UPDATE) break;                                                                                \
            case LCL_SHAPE_RING * 16 + 4: LCL_RING_ROWS(4, 0, x, UPDATE) break;                                                                                \
            case LCL_SHAPE_RING * 16 + 5: LCL_RING_ROWS(5, 0, x, UPDATE) break;                                                                                \
            case LCL_SHAPE_RING * 16 + 6: LCL_RING_ROWS(6, 0, x, UPDATE) break;                                                                                \
            case LCL_SHAPE_RING * 16 + 7: LCL_RING_ROWS(7, 0, x, UPDATE) break;                                                                                \
            case LCL_SHAPE_FULL_RING * 16 + 3: LCL_RING_ROWS(3, 1, x, UPDATE) break;                                                                           \
            case LCL_SHAPE_FULL_RING * 16 + 4: LCL_RING_ROWS(4, 1, x, UPDATE) break;                                                                           \
            case LCL_SHAPE_FULL_RING * 16 + 5: LCL_RING_ROWS(5, 1, x, UPDATE) break;                                                                           \
            case LCL_SHAPE_FULL_RING * 16 + 6: LCL_RING_ROWS(6, 1, x, UPDATE) break;                                                                           \
            default:                                                                                                                                           \
                if (run.shape == LCL_SHAPE_RING) {                                                                                                             \
                    LCL_RING_ROWS(run.edges, 0, x, UPDATE)                                                                                                     \
                } else if (run.shape == LCL_SHAPE_FULL_RING) {                                                                                                 \
                    LCL_RING_ROWS(run.edges, 1, x, UPDATE)                                                                                                     \
                } else if (run.shape == LCL_SHAPE_WEIGHTED) {                                                                                                  \
                    LCL_WEIGHTED_ROWS(x, UPDATE)                                                                                                               \
                } else {                                                                                                                                       \
                    for (int i = lane; i < run.count; i += LCL_GROUP) UPDATE(run.first + i, x[run.first + i], vertex_weight);                                  \
                }                                                                                                                                              \
        }                                                                                                                                                      \
    }

#endif
