// SPDX-License-Identifier: BSD-3-Clause
// Morphing (mesh expansion paper, eq. 9): Q' = M + rho D (Q - M). The difference Q - M is what is kept; its filter is that of filter.cl with rho in the first step, and the last step writes
// the frame M + difference as well, so that no pass only adds.
//
// One work-group owns one block of rows in one sweep and writes these rows of y (and of the frame) alone; see filter.cl. One work-item owns row i in the kernels without neighbours. Results
// do not depend on scheduling. Differences shrink, and so does what float loses of them.
#include "chain.cl.h"

/// As lcl_filter; the step `last_step` also writes frame = target + y. target: M, n x LCL_WIDTH, read. frame: the same shape, rows of the blocks written.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_morph(LCL_PHASE, LCL_STENCILS, LCL_SERIES_FIELDS, const int last_step, const __global realn *restrict target,
                                                                              __global realn *restrict frame) {
    LCL_PHASE_BLOCK
    LCL_SERIES_STEP(y)
#define LCL_FRAME(row, ax, own)                            \
    {                                                      \
        const realn value = LCL_SERIES_VALUE(row, ax);     \
        y[row] = value;                                    \
        frame[row] = lcl_add(target[row], value);          \
    }
    if (first_step + sweep == last_step) {
        LCL_FOR_EACH_ROW(block, x, LCL_FRAME)
    } else {
        LCL_FOR_EACH_ROW(block, x, LCL_SERIES_STORE)
    }
}

/// For a rho that is known only after the filter: difference *= rho, frame = target + difference. count: rows. rho: one number. All n x LCL_WIDTH.
__kernel void lcl_morph_blend(const int count, const __global weight *restrict rho, const __global realn *restrict target, __global realn *restrict difference,
                              __global realn *restrict frame) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const realn value = lcl_scale(rho[0], difference[i]);
    difference[i] = value;
    frame[i] = lcl_add(target[i], value);
}

/// difference = a - b. count: rows. All n x LCL_WIDTH.
__kernel void lcl_morph_difference(const int count, const __global realn *restrict a, const __global realn *restrict b, __global realn *restrict difference) {
    const int i = get_global_id(0);
    if (i >= count) return;
    difference[i] = lcl_add(a[i], lcl_minus(b[i]));
}
