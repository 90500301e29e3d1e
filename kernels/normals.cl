// SPDX-License-Identifier: BSD-3-Clause
// Limit points and limit normals in one pass: y = A x, and n = t1 x t2 / |t1 x t2| with the limit tangents t1, t2 (left eigenvectors of the subdivision round a vertex: two-phase paper, L1 and
// L2 of equation 15, for Catmull-Clark; sums of cos(2 pi j/n) and sin(2 pi j/n) over the ring for Loop and Doo-Sabin).
//
// A ring row of a smooth vertex takes its tangents from the same neighbours as A x, by two weights a neighbour that all rows of a valence share. All other rows (curves, corners, darts, polygons) come
// after it in a launch of their own, from stored stencils: one normal for each sector between sharp edges, and their normalised mean. Rows and sectors belong to one work-item each, so writes
// cannot collide and results do not depend on scheduling.
// Differences of points are taken before anything is weighted, so that float weights cost no more than the rounding of the points themselves (6e-8 of the model's size over the length of an edge, as
// an angle); the weights of a tangent add up to about 2^20, which keeps the squares of tiny tangents within float. With pairs of floats tangents are summed as pairs, normals are floats.
#undef LCL_WIDTH
#define LCL_WIDTH 4 /* positions */
#include "rows.cl.h"
#include "normals.cl.h"

inline realn lcl_minus_row(realn a, realn b) { return lcl_add(a, lcl_minus(b)); }

#ifdef LCL_PAIR
typedef floatn lcl_tangent;
#define LCL_TANGENT(sum) lcl_narrow(sum)
#define LCL_NORMAL(n) lcl_widen(n)
#else
typedef realn lcl_tangent;
#define LCL_TANGENT(sum) (sum)
#define LCL_NORMAL(n) (n)
#endif

/// Of length 1, or 0 where there is no direction.
inline lcl_tangent lcl_unit(lcl_tangent n) {
    const real square = dot(n, n);
    return square > 0 ? n * rsqrt(square) : (lcl_tangent)(0);
}

/// Difference of two neighbours.
#define LCL_APART(x, a, b) lcl_minus_row(LCL_ROW_AT(x, a), LCL_ROW_AT(x, b))
/// t1 += cosine d, t2 += sine d with the weights of neighbour j.
#define LCL_TURN_FIRST(j, d) { const realn d_ = d; t1 = lcl_scale(turn[2 * (j)], d_); t2 = lcl_scale(turn[2 * (j) + 1], d_); }
#define LCL_TURN(j, d) { const realn d_ = d; t1 = lcl_add(t1, lcl_scale(turn[2 * (j)], d_)); t2 = lcl_add(t2, lcl_scale(turn[2 * (j) + 1], d_)); }
// Opposite neighbours of an even ring have opposite weights; an odd one is seen from its vertex, whose weight is 0.
#define LCL_TURN_RING_4(x, n) t1 = lcl_scale(turn[0], LCL_APART(x, LCL_N0, LCL_N2)); t2 = lcl_scale(turn[3], LCL_APART(x, LCL_N1, LCL_N3));
#define LCL_TURN_RING_5(x, n)                                                                                                                                  \
    LCL_TURN_FIRST(0, LCL_APART(x, (n)[0], self)) LCL_TURN(1, LCL_APART(x, (n)[1], self)) LCL_TURN(2, LCL_APART(x, (n)[2], self))                              \
    LCL_TURN(3, LCL_APART(x, (n)[3], self)) LCL_TURN(4, LCL_APART(x, (n)[4], self))
#define LCL_TURN_RING_6(x, n) LCL_TURN_FIRST(0, LCL_APART(x, LCL_N0, LCL_N3)) LCL_TURN(1, LCL_APART(x, LCL_N1, LCL_N4)) LCL_TURN(2, LCL_APART(x, LCL_N2, LCL_N5))
#define LCL_TURN_RING_7(x, n)                                                                                                                                  \
    LCL_TURN_RING_5(x, n) LCL_TURN(5, LCL_APART(x, (n)[5], self)) LCL_TURN(6, LCL_APART(x, (n)[6], self))
#define LCL_TURN_FULL_3(x, n)                                                                                                                                  \
    LCL_TURN_FIRST(0, LCL_APART(x, LCL_N0, self)) LCL_TURN(1, LCL_APART(x, LCL_N1, self)) LCL_TURN(2, LCL_APART(x, LCL_N2, self))                              \
    LCL_TURN(3, LCL_APART(x, LCL_N3, self)) LCL_TURN(4, LCL_APART(x, LCL_N4, self)) LCL_TURN(5, LCL_APART(x, LCL_N5, self))
#define LCL_TURN_FULL_4(x, n)                                                                                                                                  \
    LCL_TURN_RING_4(x, n)                                                                                                                                      \
    const realn diagonal_0 = LCL_APART(x, LCL_N4, LCL_N6), diagonal_1 = LCL_APART(x, LCL_N5, LCL_N7);                                                          \
    t1 = lcl_add(t1, lcl_scale(turn[8], lcl_minus_row(diagonal_0, diagonal_1)));                                                                               \
    t2 = lcl_add(t2, lcl_scale(turn[8], lcl_add(diagonal_0, diagonal_1)));
#define LCL_TURN_FULL_5(x, n)                                                                                                                                  \
    LCL_TURN_FIRST(0, LCL_APART(x, LCL_N0, self)) LCL_TURN(1, LCL_APART(x, LCL_N1, self)) LCL_TURN(2, LCL_APART(x, LCL_N2, self))                              \
    LCL_TURN(3, LCL_APART(x, LCL_N3, self)) LCL_TURN(4, LCL_APART(x, LCL_N4, self)) LCL_TURN(5, LCL_APART(x, LCL_N5, self))                                    \
    LCL_TURN(6, LCL_APART(x, LCL_N6, self)) LCL_TURN(7, LCL_APART(x, LCL_N7, self)) LCL_TURN(8, LCL_APART(x, LCL_N8, self))                                    \
    LCL_TURN(9, LCL_APART(x, LCL_N9, self))
#define LCL_TURN_FULL_6(x, n)                                                                                                                                  \
    LCL_TURN_RING_6(x, n) LCL_TURN(6, LCL_APART(x, LCL_N6, LCL_N9)) LCL_TURN(7, LCL_APART(x, LCL_N7, LCL_N10)) LCL_TURN(8, LCL_APART(x, LCL_N8, LCL_N11))
#define LCL_TURN_LOOP_OF(count, x, n)                                                                                                                          \
    LCL_TURN_FIRST(0, LCL_APART(x, (n)[0], self))                                                                                                              \
    for (int j = 1; j < (count); ++j) LCL_TURN(j, LCL_APART(x, (n)[j], self))
#define LCL_TURN_RING_LOOP(x, n) LCL_TURN_LOOP_OF(run.edges, x, n)
#define LCL_TURN_FULL_LOOP(x, n) LCL_TURN_LOOP_OF(2 * run.edges, x, n)

/// Ring rows of one run with their tangents: STORE(row, ax, t1, t2).
#define LCL_TURN_ROWS(stride, RING, TURN, x, STORE)                                                                                                            \
    for (int i = lane; i < run.count; i += LCL_GROUP) {                                                                                                        \
        const __global uint *restrict neighbours = indices + run.index_offset + (uint)i * (stride);                                                            \
        const uint self = 2 * (uint)(run.first + i);                                                                                                           \
        realn ring, t1, t2;                                                                                                                                    \
        RING(x, neighbours)                                                                                                                                    \
        TURN(x, neighbours)                                                                                                                                    \
        (void)self;                                                                                                                                            \
        STORE(run.first + i, lcl_add(lcl_scale(vertex_weight, LCL_ROW(x[run.first + i])), ring), t1, t2)                                                       \
    }

/// STORE for the ring rows of `block` that have tangents, STORE_POINT(row, ax, own) for its other rows.
#define LCL_FOR_EACH_TANGENT_ROW(block, x, STORE, STORE_POINT)                                                                                                 \
    for (int index = block.first_run; index < block.first_run + block.run_count; ++index) {                                                                    \
        const lcl_run run = runs[index];                                                                                                                       \
        const weight vertex_weight = run_weights[3 * index], edge_weight = run_weights[3 * index + 1], diagonal_weight = run_weights[3 * index + 2];           \
        const int first_turn = run_turns[index];                                                                                                               \
        const __global weight *restrict turn = turns + max(first_turn, 0);                                                                                     \
        switch (first_turn < 0 ? -1 : run.shape * 16 + (run.edges < 16 ? run.edges : 0)) {                                                                     \
            case LCL_SHAPE_RING * 16 + 4: LCL_TURN_ROWS(4, LCL_RING_4, LCL_TURN_RING_4, x, STORE) break;                                                       \
            case LCL_SHAPE_RING * 16 + 5: LCL_TURN_ROWS(5, LCL_RING_5, LCL_TURN_RING_5, x, STORE) break;                                                       \
            case LCL_SHAPE_RING * 16 + 6: LCL_TURN_ROWS(6, LCL_RING_6, LCL_TURN_RING_6, x, STORE) break;                                                       \
            case LCL_SHAPE_RING * 16 + 7: LCL_TURN_ROWS(7, LCL_RING_7, LCL_TURN_RING_7, x, STORE) break;                                                       \
            case LCL_SHAPE_FULL_RING * 16 + 3: LCL_TURN_ROWS(6, LCL_FULL_3, LCL_TURN_FULL_3, x, STORE) break;                                                  \
            case LCL_SHAPE_FULL_RING * 16 + 4: LCL_TURN_ROWS(8, LCL_FULL_4, LCL_TURN_FULL_4, x, STORE) break;                                                  \
            case LCL_SHAPE_FULL_RING * 16 + 5: LCL_TURN_ROWS(10, LCL_FULL_5, LCL_TURN_FULL_5, x, STORE) break;                                                 \
            case LCL_SHAPE_FULL_RING * 16 + 6: LCL_TURN_ROWS(12, LCL_FULL_6, LCL_TURN_FULL_6, x, STORE) break;                                                 \
            case -1:                                                                                                                                           \
                if (run.shape == LCL_SHAPE_RING) {                                                                                                             \
                    LCL_RING_ROWS(run.edges, LCL_RING_LOOP, x, STORE_POINT)                                                                                    \
                } else if (run.shape == LCL_SHAPE_FULL_RING) {                                                                                                 \
                    LCL_RING_ROWS(2 * run.edges, LCL_FULL_LOOP, x, STORE_POINT)                                                                                \
                } else if (run.shape == LCL_SHAPE_WEIGHTED) {                                                                                                  \
                    LCL_WEIGHTED_ROWS(x, STORE_POINT)                                                                                                          \
                } else {                                                                                                                                       \
                    for (int i = lane; i < run.count; i += LCL_GROUP) { STORE_POINT(run.first + i, LCL_ROW(x[run.first + i]), vertex_weight); }                \
                }                                                                                                                                              \
                break;                                                                                                                                         \
            default:                                                                                                                                           \
                if (run.shape == LCL_SHAPE_RING) {                                                                                                             \
                    LCL_TURN_ROWS(run.edges, LCL_RING_LOOP, LCL_TURN_RING_LOOP, x, STORE)                                                                      \
                } else {                                                                                                                                       \
                    LCL_TURN_ROWS(2 * run.edges, LCL_FULL_LOOP, LCL_TURN_FULL_LOOP, x, STORE)                                                                  \
                }                                                                                                                                              \
        }                                                                                                                                                      \
    }

/// run_turns: a run's place in turns, or -1. turns: cosine and sine weight of each neighbour of a ring.
#define LCL_TURNS const __global int *restrict run_turns, const __global weight *restrict turns

#define LCL_STORE_POINT(row, ax, own) y[row] = ax
#define LCL_NO_POINT(row, ax, own) (void)(ax)
#define LCL_STORE_NORMAL(row, ax, t1, t2) (void)(ax); normals[row] = LCL_NORMAL(lcl_unit(cross(LCL_TANGENT(t1), LCL_TANGENT(t2))));
#define LCL_STORE_BOTH(row, ax, t1, t2) y[row] = ax; LCL_STORE_NORMAL(row, ax, t1, t2)
/// The first tangent at right angles to n (which it is already where there is one sector), and the third side of the frame.
#define LCL_STORE_FRAME_OF(row, n, first)                                     \
    {                                                                         \
        const lcl_tangent t_ = lcl_unit(first), u_ = lcl_unit(t_ - dot(t_, n) * n); \
        normals[row] = LCL_NORMAL(n);                                         \
        tangents[row] = LCL_NORMAL(u_);                                       \
        bitangents[row] = LCL_NORMAL(cross(n, u_));                           \
    }
#define LCL_STORE_FRAME(row, ax, t1, t2)                                                   \
    {                                                                                      \
        (void)(ax);                                                                        \
        const lcl_tangent a_ = LCL_TANGENT(t1), n_ = lcl_unit(cross(a_, LCL_TANGENT(t2))); \
        LCL_STORE_FRAME_OF(row, n_, a_)                                                    \
    }

#define LCL_SWEEP __kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void

/// first_block: block of work-group 0. x: n x 4, read. y, normals: the same shape, written; none of them is another. y: all rows of the blocks; normals: their ring rows of smooth vertices.
LCL_SWEEP lcl_limit_normals(const int first_block, LCL_STENCILS, LCL_TURNS, const __global realn *restrict x, __global realn *restrict y, __global realn *restrict normals) {
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    LCL_FOR_EACH_TANGENT_ROW(block, x, LCL_STORE_BOTH, LCL_STORE_POINT)
}

/// The same without y.
LCL_SWEEP lcl_normals(const int first_block, LCL_STENCILS, LCL_TURNS, const __global realn *restrict x, __global realn *restrict normals) {
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    LCL_FOR_EACH_TANGENT_ROW(block, x, LCL_STORE_NORMAL, LCL_NO_POINT)
}

/// The same with orthonormal frames: tangents, the limit of the direction to E_0; bitangents, normal x tangent. Both n x 4, written like normals.
LCL_SWEEP lcl_frames(const int first_block, LCL_STENCILS, LCL_TURNS, const __global realn *restrict x, __global realn *restrict normals, __global realn *restrict tangents,
                     __global realn *restrict bitangents) {
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    LCL_FOR_EACH_TANGENT_ROW(block, x, LCL_STORE_FRAME, LCL_NO_POINT)
}

/// rows: count, the stored rows. sector_offsets: count + 1. entry_offsets: sectors + 1. columns: entries. stored_weights: 3 an entry.
#define LCL_SECTORS                                                                                                                                            \
    const int count, const int side_count, const __global int *restrict rows, const __global uint *restrict sector_offsets,                                    \
        const __global uint *restrict entry_offsets, const __global int *restrict columns, const __global weight *restrict stored_weights

/// Normal n of sector s at `row` and its first tangent; the spare one takes the second's place where that is parallel to the first.
#define LCL_SECTOR_NORMAL                                                                                                                                      \
    const realn own = LCL_ROW(x[row]);                                                                                                                         \
    realn sum_0 = lcl_zero(), sum_1 = lcl_zero(), sum_2 = lcl_zero();                                                                                          \
    for (uint k = entry_offsets[s]; k < entry_offsets[s + 1]; ++k) {                                                                                           \
        const realn apart = lcl_minus_row(LCL_ROW(x[columns[k]]), own);                                                                                        \
        sum_0 = lcl_add(sum_0, lcl_scale(stored_weights[3 * k], apart));                                                                                       \
        sum_1 = lcl_add(sum_1, lcl_scale(stored_weights[3 * k + 1], apart));                                                                                   \
        sum_2 = lcl_add(sum_2, lcl_scale(stored_weights[3 * k + 2], apart));                                                                                   \
    }                                                                                                                                                          \
    const lcl_tangent t1 = lcl_unit(LCL_TANGENT(sum_0)), t2 = lcl_unit(LCL_TANGENT(sum_1));                                                                    \
    lcl_tangent n = cross(t1, t2);                                                                                                                             \
    if (dot(n, n) <= LCL_PARALLEL) n = cross(t1, lcl_unit(LCL_TANGENT(sum_2)));                                                                                \
    n = lcl_unit(n);

/// One work-item a stored row. x: n x 4, read. normals: the same shape, the stored rows written. sides: side_count x 4, the normals of the first sectors, written.
__kernel void lcl_sector_normals(LCL_SECTORS, const __global realn *restrict x, __global realn *restrict normals, __global realn *restrict sides) {
    const int item = get_global_id(0);
    if (item >= count) return;
    const int row = rows[item];
    const uint end = sector_offsets[item + 1];
    lcl_tangent mean = (lcl_tangent)(0);
    for (uint s = sector_offsets[item]; s < end; ++s) {
        LCL_SECTOR_NORMAL
        if (s < (uint)side_count) sides[s] = LCL_NORMAL(n);
        mean += n;
    }
    normals[row] = LCL_NORMAL(lcl_unit(mean));
}

/// The same with the frame of the first sector's first tangent.
__kernel void lcl_sector_frames(LCL_SECTORS, const __global realn *restrict x, __global realn *restrict normals, __global realn *restrict tangents, __global realn *restrict bitangents,
                                __global realn *restrict sides) {
    const int item = get_global_id(0);
    if (item >= count) return;
    const int row = rows[item];
    const uint begin = sector_offsets[item], end = sector_offsets[item + 1];
    lcl_tangent mean = (lcl_tangent)(0), first = (lcl_tangent)(0);
    for (uint s = begin; s < end; ++s) {
        LCL_SECTOR_NORMAL
        if (s < (uint)side_count) sides[s] = LCL_NORMAL(n);
        if (s == begin) first = t1;
        mean += n;
    }
    mean = lcl_unit(mean);
    LCL_STORE_FRAME_OF(row, mean, first)
}
