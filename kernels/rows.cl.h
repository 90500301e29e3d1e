// SPDX-License-Identifier: BSD-3-Clause
// The row gather that the kernels share: A x for every row of a block, without stored weights on ring rows (weights follow from valence and face degree; mesh expansion paper, Loop PIA
// paper, Doo-Sabin paper), with stored ones on weighted rows.
//
// One work-group of LCL_GROUP work-items sweeps one block; each row belongs to one work-item, so writes to that row cannot collide and results do not depend on scheduling.
#ifndef LCL_ROWS_CL_H
#define LCL_ROWS_CL_H

#include "types.cl.h"

/// blocks, runs: the plan's. run_weights: 3 a run (vertex, edge, diagonal). indices: neighbours of ring rows, each number doubled, those of a run from an even place on. weighted_*: offsets (count + 1), columns and weights of weighted rows.
#define LCL_STENCILS                                                                                                                                           \
    const __global lcl_block *restrict blocks, const __global lcl_run *restrict runs, const __global weight *restrict run_weights,                             \
        const __global uint *restrict indices, const __global uint *restrict weighted_offsets, const __global int *restrict weighted_indices,                   \
        const __global weight *restrict weighted_weights

/// Row of a field by twice its number: the half sizes of rows are factors that a CPU's addressing applies for nothing.
#define LCL_ROW_AT(x, twice) LCL_ROW(*(const __global fieldn *)((const __global char *)(x) + (ulong)(twice) * (sizeof(fieldn) / 2)))

// Indices are loaded in pairs, which are aligned: a ring of an even number begins at an even place. (Loads bound a sweep in cache: 1.3 times faster than one by one.)
#ifdef __ENDIAN_LITTLE__
#define LCL_FIRST(pair) ((uint)(pair))
#define LCL_SECOND(pair) ((uint)((pair) >> 32))
#else
#define LCL_FIRST(pair) ((uint)((pair) >> 32))
#define LCL_SECOND(pair) ((uint)(pair))
#endif
#define LCL_PAIRS(n) const __global ulong *restrict pairs = (const __global ulong *)(n);
#define LCL_PAIRS_2(n) LCL_PAIRS(n) const ulong p0 = pairs[0];
#define LCL_PAIRS_4(n) LCL_PAIRS_2(n) const ulong p1 = pairs[1];
#define LCL_PAIRS_6(n) LCL_PAIRS_4(n) const ulong p2 = pairs[2];
#define LCL_PAIRS_8(n) LCL_PAIRS_6(n) const ulong p3 = pairs[3];
#define LCL_PAIRS_10(n) LCL_PAIRS_8(n) const ulong p4 = pairs[4];
#define LCL_PAIRS_12(n) LCL_PAIRS_10(n) const ulong p5 = pairs[5];
#define LCL_N0 LCL_FIRST(p0)
#define LCL_N1 LCL_SECOND(p0)
#define LCL_N2 LCL_FIRST(p1)
#define LCL_N3 LCL_SECOND(p1)
#define LCL_N4 LCL_FIRST(p2)
#define LCL_N5 LCL_SECOND(p2)
#define LCL_N6 LCL_FIRST(p3)
#define LCL_N7 LCL_SECOND(p3)
#define LCL_N8 LCL_FIRST(p4)
#define LCL_N9 LCL_SECOND(p4)
#define LCL_N10 LCL_FIRST(p5)
#define LCL_N11 LCL_SECOND(p5)

// Sums of rows of x, written out: OpenCL compilers do not all unroll loops (PoCL 3.1: 1.5 times the time of a sweep).
#define LCL_SUM_2(x, a, b) lcl_add(LCL_ROW_AT(x, a), LCL_ROW_AT(x, b))
#define LCL_SUM_3(x, a, b, c) lcl_add(LCL_SUM_2(x, a, b), LCL_ROW_AT(x, c))
#define LCL_SUM_4(x, a, b, c, d) lcl_add(LCL_SUM_2(x, a, b), LCL_SUM_2(x, c, d))
#define LCL_SUM_5(x, a, b, c, d, e) lcl_add(LCL_SUM_3(x, a, b, c), LCL_SUM_2(x, d, e))
#define LCL_SUM_6(x, a, b, c, d, e, f) lcl_add(LCL_SUM_3(x, a, b, c), LCL_SUM_3(x, d, e, f))
#define LCL_SUM_7(x, a, b, c, d, e, f, g) lcl_add(LCL_SUM_4(x, a, b, c, d), LCL_SUM_3(x, e, f, g))

/// What the neighbours n of a ring row add to A x.
#define LCL_RING_2(x, n) LCL_PAIRS_2(n) ring = lcl_scale(edge_weight, LCL_SUM_2(x, LCL_N0, LCL_N1));
#define LCL_RING_4(x, n) LCL_PAIRS_4(n) ring = lcl_scale(edge_weight, LCL_SUM_4(x, LCL_N0, LCL_N1, LCL_N2, LCL_N3));
#define LCL_RING_5(x, n) ring = lcl_scale(edge_weight, LCL_SUM_5(x, (n)[0], (n)[1], (n)[2], (n)[3], (n)[4]));
#define LCL_RING_6(x, n) LCL_PAIRS_6(n) ring = lcl_scale(edge_weight, LCL_SUM_6(x, LCL_N0, LCL_N1, LCL_N2, LCL_N3, LCL_N4, LCL_N5));
#define LCL_RING_7(x, n) ring = lcl_scale(edge_weight, LCL_SUM_7(x, (n)[0], (n)[1], (n)[2], (n)[3], (n)[4], (n)[5], (n)[6]));
#define LCL_BOTH(edges, diagonals) ring = lcl_add(lcl_scale(edge_weight, edges), lcl_scale(diagonal_weight, diagonals));
#define LCL_FULL_3(x, n) LCL_PAIRS_6(n) LCL_BOTH(LCL_SUM_3(x, LCL_N0, LCL_N1, LCL_N2), LCL_SUM_3(x, LCL_N3, LCL_N4, LCL_N5))
#define LCL_FULL_4(x, n) LCL_PAIRS_8(n) LCL_BOTH(LCL_SUM_4(x, LCL_N0, LCL_N1, LCL_N2, LCL_N3), LCL_SUM_4(x, LCL_N4, LCL_N5, LCL_N6, LCL_N7))
#define LCL_FULL_5(x, n)                                                                                                                                       \
    LCL_PAIRS_10(n) LCL_BOTH(LCL_SUM_5(x, LCL_N0, LCL_N1, LCL_N2, LCL_N3, LCL_N4), LCL_SUM_5(x, LCL_N5, LCL_N6, LCL_N7, LCL_N8, LCL_N9))
#define LCL_FULL_6(x, n)                                                                                                                                       \
    LCL_PAIRS_12(n)                                                                                                                                            \
    LCL_BOTH(LCL_SUM_6(x, LCL_N0, LCL_N1, LCL_N2, LCL_N3, LCL_N4, LCL_N5), LCL_SUM_6(x, LCL_N6, LCL_N7, LCL_N8, LCL_N9, LCL_N10, LCL_N11))
#define LCL_SUM_LOOP(sum, x, n)                                                                     \
    realn sum = LCL_ROW_AT(x, (n)[0]);                                                              \
    for (int j = 1; j < run.edges; ++j) sum = lcl_add(sum, LCL_ROW_AT(x, (n)[j]));
#define LCL_RING_LOOP(x, n) LCL_SUM_LOOP(edges, x, n) ring = lcl_scale(edge_weight, edges);
#define LCL_FULL_LOOP(x, n) LCL_SUM_LOOP(edges, x, n) LCL_SUM_LOOP(diagonals, x, (n) + run.edges) LCL_BOTH(edges, diagonals)

/// Ring rows of one run, `stride` neighbours each.
#define LCL_RING_ROWS(stride, RING, x, UPDATE)                                                                                                                 \
    for (int i = lane; i < run.count; i += LCL_GROUP) {                                                                                                        \
        const __global uint *restrict neighbours = indices + run.index_offset + (uint)i * (stride);                                                            \
        realn ring;                                                                                                                                            \
        RING(x, neighbours)                                                                                                                                    \
        const realn ax = lcl_add(lcl_scale(vertex_weight, LCL_ROW(x[run.first + i])), ring);                                                                   \
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
            case LCL_SHAPE_RING * 16 + 2: LCL_RING_ROWS(2, LCL_RING_2, x, UPDATE) break;                                                                       \
            case LCL_SHAPE_RING * 16 + 4: LCL_RING_ROWS(4, LCL_RING_4, x, UPDATE) break;                                                                       \
            case LCL_SHAPE_RING * 16 + 5: LCL_RING_ROWS(5, LCL_RING_5, x, UPDATE) break;                                                                       \
            case LCL_SHAPE_RING * 16 + 6: LCL_RING_ROWS(6, LCL_RING_6, x, UPDATE) break;                                                                       \
            case LCL_SHAPE_RING * 16 + 7: LCL_RING_ROWS(7, LCL_RING_7, x, UPDATE) break;                                                                       \
            case LCL_SHAPE_FULL_RING * 16 + 3: LCL_RING_ROWS(6, LCL_FULL_3, x, UPDATE) break;                                                                  \
            case LCL_SHAPE_FULL_RING * 16 + 4: LCL_RING_ROWS(8, LCL_FULL_4, x, UPDATE) break;                                                                  \
            case LCL_SHAPE_FULL_RING * 16 + 5: LCL_RING_ROWS(10, LCL_FULL_5, x, UPDATE) break;                                                                 \
            case LCL_SHAPE_FULL_RING * 16 + 6: LCL_RING_ROWS(12, LCL_FULL_6, x, UPDATE) break;                                                                 \
            default:                                                                                                                                           \
                if (run.shape == LCL_SHAPE_RING) {                                                                                                             \
                    LCL_RING_ROWS(run.edges, LCL_RING_LOOP, x, UPDATE)                                                                                         \
                } else if (run.shape == LCL_SHAPE_FULL_RING) {                                                                                                 \
                    LCL_RING_ROWS(2 * run.edges, LCL_FULL_LOOP, x, UPDATE)                                                                                     \
                } else if (run.shape == LCL_SHAPE_WEIGHTED) {                                                                                                  \
                    LCL_WEIGHTED_ROWS(x, UPDATE)                                                                                                               \
                } else {                                                                                                                                       \
                    for (int i = lane; i < run.count; i += LCL_GROUP) UPDATE(run.first + i, LCL_ROW(x[run.first + i]), vertex_weight);                         \
                }                                                                                                                                              \
        }                                                                                                                                                      \
    }

#endif
