// SPDX-License-Identifier: BSD-3-Clause
// The row gather that the kernels share: A x for every row of a block, without stored weights on ring rows (weights follow from valence and face degree; mesh expansion paper, Loop PIA
// paper, Doo-Sabin paper), with stored ones on weighted rows.
//
// One work-group of LCL_GROUP work-items sweeps one block; each row belongs to one work-item, so writes to that row cannot collide and results do not depend on scheduling.
#ifndef LCL_ROWS_CL_H
#define LCL_ROWS_CL_H

#include "types.cl.h"

/// blocks, runs: the plan's. run_weights: 3 a run (vertex, edge, diagonal). indices: neighbours of ring rows, each number doubled. weighted_*: offsets (count + 1), columns and weights of weighted rows.
#define LCL_STENCILS                                                                                                                                           \
    const __global lcl_block *restrict blocks, const __global lcl_run *restrict runs, const __global weight *restrict run_weights,                             \
        const __global uint *restrict indices, const __global uint *restrict weighted_offsets, const __global int *restrict weighted_indices,                   \
        const __global weight *restrict weighted_weights

/// Row of a field by twice its number: the half sizes of rows are factors that a CPU's addressing applies for nothing.
#define LCL_ROW_AT(x, twice) LCL_ROW(*(const __global fieldn *)((const __global char *)(x) + (ulong)(twice) * (sizeof(fieldn) / 2)))

// Sums of `count` rows, written out: OpenCL compilers do not all unroll loops (PoCL 3.1: 1.5 times the time of a sweep).
#define LCL_SUM_2(x, n) lcl_add(LCL_ROW_AT(x, (n)[0]), LCL_ROW_AT(x, (n)[1]))
#define LCL_SUM_3(x, n) lcl_add(LCL_SUM_2(x, n), LCL_ROW_AT(x, (n)[2]))
#define LCL_SUM_4(x, n) lcl_add(LCL_SUM_2(x, n), LCL_SUM_2(x, (n) + 2))
#define LCL_SUM_5(x, n) lcl_add(LCL_SUM_3(x, n), LCL_SUM_2(x, (n) + 3))
#define LCL_SUM_6(x, n) lcl_add(LCL_SUM_3(x, n), LCL_SUM_3(x, (n) + 3))
#define LCL_SUM_7(x, n) lcl_add(LCL_SUM_4(x, n), LCL_SUM_3(x, (n) + 4))
#define LCL_SUM_WRITTEN_OUT(sum, x, n, count) sum = LCL_JOIN(LCL_SUM_, count)(x, n);
#define LCL_SUM_LOOP(sum, x, n, count)   \
    sum = LCL_ROW_AT(x, (n)[0]);         \
    for (int j = 1; j < (count); ++j) sum = lcl_add(sum, LCL_ROW_AT(x, (n)[j]));

/// Ring rows of one run, `edges` edge ends and (full) as many diagonals.
#define LCL_RING_ROWS(edges, full, SUM, x, UPDATE)                                                                                                             \
    for (int i = lane; i < run.count; i += LCL_GROUP) {                                                                                                        \
        const __global uint *restrict neighbours = indices + run.index_offset + (uint)i * ((full) ? 2 * (edges) : (edges));                                    \
        realn edge_sum, diagonal_sum;                                                                                                                          \
        SUM(edge_sum, x, neighbours, edges)                                                                                                                    \
        realn ax = lcl_add(lcl_scale(vertex_weight, LCL_ROW(x[run.first + i])), lcl_scale(edge_weight, edge_sum));                                             \
        if (full) {                                                                                                                                            \
            SUM(diagonal_sum, x, neighbours + (edges), edges)                                                                                                  \
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
            ax = lcl_add(ax, lcl_scale(weighted_weights[k], LCL_ROW(x[column])));                                                                              \
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
            case LCL_SHAPE_RING * 16 + 2: LCL_RING_ROWS(2, 0, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                           \
            case LCL_SHAPE_RING * 16 + 4: LCL_RING_ROWS(4, 0, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                           \
            case LCL_SHAPE_RING * 16 + 5: LCL_RING_ROWS(5, 0, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                           \
            case LCL_SHAPE_RING * 16 + 6: LCL_RING_ROWS(6, 0, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                           \
            case LCL_SHAPE_RING * 16 + 7: LCL_RING_ROWS(7, 0, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                           \
            case LCL_SHAPE_FULL_RING * 16 + 3: LCL_RING_ROWS(3, 1, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                      \
            case LCL_SHAPE_FULL_RING * 16 + 4: LCL_RING_ROWS(4, 1, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                      \
            case LCL_SHAPE_FULL_RING * 16 + 5: LCL_RING_ROWS(5, 1, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                      \
            case LCL_SHAPE_FULL_RING * 16 + 6: LCL_RING_ROWS(6, 1, LCL_SUM_WRITTEN_OUT, x, UPDATE) break;                                                      \
            default:                                                                                                                                           \
                if (run.shape == LCL_SHAPE_RING) {                                                                                                             \
                    LCL_RING_ROWS(run.edges, 0, LCL_SUM_LOOP, x, UPDATE)                                                                                       \
                } else if (run.shape == LCL_SHAPE_FULL_RING) {                                                                                                 \
                    LCL_RING_ROWS(run.edges, 1, LCL_SUM_LOOP, x, UPDATE)                                                                                       \
                } else if (run.shape == LCL_SHAPE_WEIGHTED) {                                                                                                  \
                    LCL_WEIGHTED_ROWS(x, UPDATE)                                                                                                               \
                } else {                                                                                                                                       \
                    for (int i = lane; i < run.count; i += LCL_GROUP) UPDATE(run.first + i, LCL_ROW(x[run.first + i]), vertex_weight);                         \
                }                                                                                                                                              \
        }                                                                                                                                                      \
    }

#endif
