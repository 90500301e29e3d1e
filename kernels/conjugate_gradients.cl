// SPDX-License-Identifier: BSD-3-Clause
// Conjugate gradients in the inner product <u, v>_D = sum D_ii u_i v_i, in which A is self-adjoint; every channel is a system of its own. One work-group owns one block of rows and writes
// one partial sum a channel, in double where the device has it; the host adds the blocks in order, so results are the same bits in every run.
#include "reduce.cl.h"
#include "rows.cl.h"

/// q = A p with the partial sums of <p, q>_D. first_block: block of work-group 0. scaling: D_ii by row. p: n x LCL_WIDTH, read (zero on rows that are not solved for).
/// q: the same shape, rows of the blocks written. sums: one sumn a block.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_cg_apply(const int first_block, LCL_STENCILS, const __global real *restrict scaling,
                                                                                 const __global realn *restrict p, __global realn *restrict q, __global sumn *restrict sums) {
    LCL_SCRATCH(sumn, scratch)
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    sumn sum = (sumn)(0);
#define LCL_CG_APPLY(row, ax, own)                        \
    {                                                     \
        const realn product = ax;                         \
        q[row] = product;                                 \
        sum += LCL_TO_SUM(scaling[row] * p[row] * product); \
    }
    LCL_FOR_EACH_ROW(block, p, LCL_CG_APPLY)
    LCL_GROUP_STORE_SUM(sum, scratch, sums, first_block + get_group_id(0));
}

/// x += alpha p, r -= alpha q, with the partial sums of <r, r>_D and the largest squared row norm of r. alpha: one a channel. x, r: n x LCL_WIDTH, updated; p, q: read.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_cg_update(const int first_block, const __global lcl_block *restrict blocks, const __global real *restrict scaling,
                                                                                  const realn alpha, const __global realn *restrict p, const __global realn *restrict q,
                                                                                  __global realn *restrict x, __global realn *restrict r, __global sumn *restrict sums,
                                                                                  __global real *restrict norms) {
    LCL_SCRATCH(sumn, sum_scratch)
    LCL_SCRATCH(real, norm_scratch)
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    sumn sum = (sumn)(0);
    LCL_NORM(real)
    for (int row = block.first_row + lane; row < block.first_row + block.row_count; row += LCL_GROUP) {
        x[row] += alpha * p[row];
        const realn residual = r[row] - alpha * q[row];
        r[row] = residual;
        sum += LCL_TO_SUM(scaling[row] * residual * residual);
        LCL_NORM_TAKE(LCL_LARGER, residual)
    }
    LCL_GROUP_STORE_SUM(sum, sum_scratch, sums, first_block + get_group_id(0));
    LCL_NORM_STORE(LCL_SAME, norm_scratch, norms, first_block + get_group_id(0))
}

/// p = r + beta p. beta: one a channel. r: n x LCL_WIDTH, read; p: updated.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_cg_direction(const int first_block, const __global lcl_block *restrict blocks, const realn beta,
                                                                                     const __global realn *restrict r, __global realn *restrict p) {
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
    for (int row = block.first_row + lane; row < block.first_row + block.row_count; row += LCL_GROUP) p[row] = r[row] + beta * p[row];
}
