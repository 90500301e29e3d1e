// SPDX-License-Identifier: BSD-3-Clause
// Limit points, y = A x (mesh expansion paper; masks: Catmull-Clark with alpha, Loop, Doo-Sabin, two-phase blend). One work-group owns one block of rows, one work-item one row of it at
// a time; rows are written once, so writes cannot collide and the result does not depend on scheduling. LCL_REAL double gives double limit points; float sums lose about 1e-7 of the field's size.
#include "rows.cl.h"

/// first_block: block of work-group 0. x: n x LCL_WIDTH, read. y: the same shape, rows of the blocks written; not x.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_limit_points(const int first_block, LCL_STENCILS, const __global realn *restrict x, __global realn *restrict y) {
    const int lane = get_local_id(0);
    const lcl_block block = blocks[first_block + get_group_id(0)];
#define LCL_STORE(row, ax, own) y[row] = ax
    LCL_FOR_EACH_ROW(block, x, LCL_STORE)
}
