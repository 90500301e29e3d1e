// SPDX-License-Identifier: BSD-3-Clause
// Chains of sweeps that follow each other through the blocks, so that rows are still in cache when the next sweep takes them (level-based blocking of matrix powers: Alappat et al. 2022).
//
// Sweep s reads `even` (s even) or `odd` and writes the other one. In phase t it takes the blocks from t * width - s * lag on, `width` of them, where they exist. With a lag of the blocks
// that rows reach plus 2 * width, all that it reads was finished two phases before, and all that it overwrites had its last reader then. Work-group (i, k): block i of these, sweep
// first_sweep + k. A width of all blocks makes a phase of every sweep.
#ifndef LCL_CHAIN_CL_H
#define LCL_CHAIN_CL_H

#include "rows.cl.h"

#define LCL_PHASE const int phase, const int first_sweep, const int width, const int lag, const int first_block, const int block_count

/// lane, sweep, index (of the block, from first_block on) and block of a work-group in a phase; work-groups without a block end here.
#define LCL_PHASE_BLOCK                                                            \
    const int lane = get_local_id(0);                                              \
    const int sweep = first_sweep + (int)get_group_id(1);                          \
    const int index = phase * width - sweep * lag + (int)get_group_id(0);          \
    if (index < 0 || index >= block_count) return;                                 \
    const lcl_block block = blocks[first_block + index];

/// A series: y = a x + b A x + c d, three numbers a step. The chain begins with step `first_step`; step 0 reads `input` in the place of `even`.
#define LCL_SERIES_FIELDS const int first_step, const __global weight *restrict steps, const __global realn *input, __global realn *even, __global realn *odd

/// a, b, c, x and y of this work-group's sweep, and what is added to them: `third`, or x where c is 0 (y may hold no number yet).
#define LCL_SERIES_STEP(third)                                                                                                                                  \
    const weight a = steps[3 * sweep], b = steps[3 * sweep + 1], c = steps[3 * sweep + 2];                                                                      \
    const __global realn *x = first_step + sweep == 0 ? input : (const __global realn *)(sweep % 2 == 0 ? even : odd);                                          \
    __global realn *y = sweep % 2 == 0 ? odd : even;                                                                                                            \
    const __global realn *d = lcl_is_zero(c) ? x : (third);

#define LCL_SERIES_VALUE(row, ax) lcl_add(lcl_add(lcl_scale(a, x[row]), lcl_scale(b, ax)), lcl_scale(c, d[row]))
#define LCL_SERIES_STORE(row, ax, own) y[row] = LCL_SERIES_VALUE(row, ax)

#endif
