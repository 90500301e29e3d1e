// SPDX-License-Identifier: BSD-3-Clause
// One fused sweep, y = a x + (b + b_jacobi / A_ii) (m - A x) + c d, with the largest squared row norm of m - A x: PIA (a = b = 1; mesh expansion paper), W-PIA (b = w; Loop PIA paper),
// Jacobi (b_jacobi = 1; two-phase paper, eq. 6), Chebyshev in three terms (d = the field before x), residual (a = 0, b = 1).
//
// One work-group owns one block of rows and writes one norm; x and y differ, so a sweep never reads what it writes. d may be y: each row of d is read before that row of y is written.
// The result does not depend on scheduling. A float sweep leaves a residual of some 1e-7 of the field's size.
#include "chain.cl.h"
#include "reduce.cl.h"

#define LCL_RELAX_PLUS(row, ax, own, third_term)                                            \
    {                                                                                       \
        const realn residual = m[row] - (ax);                                               \
        LCL_NORM_TAKE(LCL_LARGER_SQUARE, residual)                                          \
        y[row] = a * x[row] + (b + b_jacobi * lcl_inverse(own)) * residual third_term;      \
    }
#define LCL_RELAX(row, ax, own) LCL_RELAX_PLUS(row, ax, own, )
#define LCL_RELAX_THREE_TERM(row, ax, own) LCL_RELAX_PLUS(row, ax, own, +c * d[row])

/// first_block: block of work-group 0. m, x: n x LCL_WIDTH, read. y: the same shape, rows of the blocks written. norms: largest squared row norm of each block, at the block's number (reduce.cl.h).
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_relax(const int first_block, LCL_STENCILS, const real a, const real b, const real b_jacobi,
                                                                              const __global realn *restrict m, const __global realn *restrict x,
                                                                              __global realn *restrict y, __global real *restrict norms) {
    LCL_SCRATCH(real, scratch)
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    LCL_NORM(square_bits)
    LCL_FOR_EACH_ROW(block, x, LCL_RELAX)
    LCL_NORM_STORE(LCL_SQUARE, scratch, norms, first_block + get_group_id(0))
}

/// The same with + c d; d: n x LCL_WIDTH, read; it may be y.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_relax_three_term(const int first_block, LCL_STENCILS, const real a, const real b, const real b_jacobi, const real c,
                                                                                         const __global realn *restrict m, const __global realn *restrict x,
                                                                                         const __global realn *d, __global realn *y, __global real *restrict norms) {
    LCL_SCRATCH(real, scratch)
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    LCL_NORM(square_bits)
    LCL_FOR_EACH_ROW(block, x, LCL_RELAX_THREE_TERM)
    LCL_NORM_STORE(LCL_SQUARE, scratch, norms, first_block + get_group_id(0))
}

/// One phase of a chain of sweeps (chain.cl.h), three-term: each sweep's d is what it overwrites. chain: a, b, b_jacobi, c of each sweep. norms: norm_stride a sweep, at the block's number.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_relax_phase(LCL_PHASE, const int norm_stride, LCL_STENCILS, const __global real *restrict chain,
                                                                                    const __global realn *restrict m, __global realn *even, __global realn *odd,
                                                                                    __global real *restrict norms) {
    LCL_SCRATCH(real, scratch)
    LCL_PHASE_BLOCK
    const real a = chain[4 * sweep], b = chain[4 * sweep + 1], b_jacobi = chain[4 * sweep + 2], c = chain[4 * sweep + 3];
    const __global realn *x = sweep % 2 == 0 ? even : odd;
    __global realn *y = sweep % 2 == 0 ? odd : even;
    const __global realn *d = y;
    LCL_NORM(square_bits)
    LCL_FOR_EACH_ROW(block, x, LCL_RELAX_THREE_TERM)
    LCL_NORM_STORE(LCL_SQUARE, scratch, norms, sweep * norm_stride + first_block + index)
}
