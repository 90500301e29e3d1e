// SPDX-License-Identifier: BSD-3-Clause
// The wide half of mixed precision: residual m - A x in double (LCL_REAL double) or in pairs of floats (LCL_PAIR), handed on in float, and the correction x += d. A pair holds 48 bits:
// residuals are right to some 1e-13 of the field's size.
#include "reduce.cl.h"
#include "rows.cl.h"

/// first_block: block of work-group 0. m, x: n x LCL_WIDTH wide rows (LCL_FLOAT_FIELDS: floats), read. r: n x LCL_WIDTH floats, rows of the blocks written. norms: largest squared row norm of each block (reduce.cl.h).
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_residual(const int first_block, LCL_STENCILS, const __global fieldn *restrict m, const __global fieldn *restrict x,
                                                                                 __global floatn *restrict r, __global float *restrict norms) {
    LCL_SCRATCH(float, scratch)
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    LCL_NORM(float)
#define LCL_RESIDUAL(row, ax, own)                                            \
    {                                                                         \
        const floatn residual = lcl_narrow(lcl_add(LCL_ROW(m[row]), lcl_minus(ax)));   \
        LCL_NORM_TAKE(LCL_LARGER, residual)                                   \
        r[row] = residual;                                                    \
    }
    LCL_FOR_EACH_ROW(block, x, LCL_RESIDUAL)
    LCL_NORM_STORE(LCL_SAME, scratch, norms, first_block + get_group_id(0))
}

/// first, count: rows. d: n x LCL_WIDTH floats, read. x: n x LCL_WIDTH rows, x += d in place.
__kernel void lcl_correct(const int first, const int count, const __global floatn *restrict d, __global realn *restrict x) {
    const int i = get_global_id(0);
    if (i >= count) return;
    x[first + i] = lcl_add(x[first + i], lcl_widen(d[first + i]));
}
