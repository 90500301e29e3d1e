// SPDX-License-Identifier: BSD-3-Clause
// The filter D^k A and its relatives (mesh expansion paper, eq. 8): y = a x + b A x + c y', where y' is what y holds before, the field two steps back. D = E - (E - A)^(m + 1) is a product of
// A, of 2 E - A for odd m, and of quadratic factors E - 2 cos(2 pi j / (m + 1)) B + B^2, B = E - A: two steps each, (1 - 2 cos, -1, 0) and (1, -1, 1). So two fields do for any m and k, and
// every step is one application of A.
//
// One work-group owns one block of rows in one sweep and writes these rows of y alone, after it has read them; the phases of a chain (chain.cl.h) keep readers and writers apart. Results do
// not depend on scheduling. The factors are at most 4 and in an order in which their products stay small, so a float filter is off by some 1e-6 of the field's size.
#include "chain.cl.h"

/// steps: a, b, c of each sweep of this chain. input: n x LCL_WIDTH, read by step 0 alone. even, odd: the same shape, written in turns (chain.cl.h).
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_filter(LCL_PHASE, LCL_STENCILS, LCL_SERIES_FIELDS) {
    LCL_PHASE_BLOCK
    LCL_SERIES_STEP(y)
    LCL_FOR_EACH_ROW(block, x, LCL_SERIES_STORE)
}
