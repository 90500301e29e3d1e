// SPDX-License-Identifier: BSD-3-Clause
// Single rows of a field to a small dense array and back, for updates that touch few rows: one launch instead of a transfer a row.
// One work-item owns one entry of the list. `rows` names each row at most once in a stretch, so no two work-items write the same element; values are copied, so they are the same bits.
// A launch works on the stretch [first, first + count) of the lists: several fields share one list of rows and one array of values, which travel together.
#include "types.cl.h"

/// first, count: the stretch. rows: the list, read. x: n x LCL_WIDTH, read. values: list x LCL_WIDTH, the stretch written: values[i] = x[rows[i]].
__kernel void lcl_gather_rows(const int first, const int count, const __global int *restrict rows, const __global realn *restrict x, __global realn *restrict values) {
    const int i = get_global_id(0);
    if (i >= count) return;
    values[first + i] = x[rows[first + i]];
}

/// first, count: the stretch. rows: the list, read. values: list x LCL_WIDTH, read. x: n x LCL_WIDTH, the rows of the stretch written: x[rows[i]] = values[i].
__kernel void lcl_scatter_rows(const int first, const int count, const __global int *restrict rows, const __global realn *restrict values, __global realn *restrict x) {
    const int i = get_global_id(0);
    if (i >= count) return;
    x[rows[first + i]] = values[first + i];
}
