// SPDX-License-Identifier: BSD-3-Clause
// Weighted sums of terms of the mesh expansion (mesh expansion paper, eq. 6) in Horner form: y = a x + b A x + c M, with M the field that the series begins with. sum c_i (E - A)^i M takes
// steps (1, -1, c_i) from the highest coefficient down: one application of A a term, none stored.
//
// One work-group owns one block of rows in one sweep and writes these rows of y alone; the phases of a chain (chain.cl.h) keep readers and writers apart. Results do not depend on
// scheduling. Eigenvalues of E - A lie in [0, 1), so rounding does not grow: a float series is off by about 1e-7 of the field's size a step at most.
#include "chain.cl.h"
#include "reduce.cl.h"

/// steps: a, b, c of each sweep of this chain. input: M, n x LCL_WIDTH, read. even, odd: the same shape, written in turns (chain.cl.h).
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_series(LCL_PHASE, LCL_STENCILS, LCL_SERIES_FIELDS) {
    LCL_PHASE_BLOCK
    LCL_SERIES_STEP(input)
    LCL_FOR_EACH_ROW(block, x, LCL_SERIES_STORE)
}

/// The same in two fields (as lcl_filter), with sums over the rows of each block: of D y and of D y^2, for means, energies and norms. scaling: D_ii by row, 0 where a row does not count.
/// sums: two sumn a block and sweep, at (sweep * sum_stride + the block's number) * 2.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_series_sums(LCL_PHASE, LCL_STENCILS, LCL_SERIES_FIELDS, const int sum_stride, const __global weight *restrict scaling,
                                                                                    __global sumn *restrict sums) {
    LCL_SCRATCH(sumn, first_scratch)
    LCL_SCRATCH(sumn, second_scratch)
    LCL_PHASE_BLOCK
    LCL_SERIES_STEP(y)
    sumn first = (sumn)(0), second = (sumn)(0);
#define LCL_TERM(row, ax, own)                                                          \
    {                                                                                   \
        const realn value = LCL_SERIES_VALUE(row, ax);                                  \
        y[row] = value;                                                                 \
        if (!lcl_is_zero(scaling[row])) { /* isolated rows may hold what has no square */ \
            const sumn wide = lcl_to_sum(value);                                        \
            const sumn weighted = lcl_weight_to_sum(scaling[row]) * wide;               \
            first += weighted;                                                          \
            second += weighted * wide;                                                  \
        }                                                                               \
    }
    LCL_FOR_EACH_ROW(block, x, LCL_TERM)
    const int place = 2 * (sweep * sum_stride + first_block + index);
    LCL_GROUP_STORE_SUM(first, first_scratch, sums, place);
    LCL_GROUP_STORE_SUM(second, second_scratch, sums, place + 1);
}
