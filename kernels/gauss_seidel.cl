// SPDX-License-Identifier: BSD-3-Clause
// GS-PIA (Loop PIA paper, eq. 7): P_i += R_i / A_ii with the newest neighbours, in place. A launch takes rows of which none is a neighbour of another (one dependency level, or one
// colour), so no row that is read is written in it, and the iterates are those of the plain loop whatever the scheduling.
#include "types.cl.h"

/// first, count: rows of the schedule; chunk: consecutive ones that a work-item takes. rows: schedule -> row. offsets (schedule + 1), columns, weights: whole rows of A, the vertex among
/// them; inverse_diagonal: 1 / A_ii by schedule. m: n x LCL_WIDTH, read. x: the same shape, updated in place.
__kernel void lcl_relax_rows(const int first, const int count, const int chunk, const __global int *restrict rows, const __global uint *restrict offsets,
                             const __global int *restrict columns, const __global weight *restrict weights, const __global weight *restrict inverse_diagonal,
                             const __global realn *restrict m, __global realn *x) {
    const int begin = (int)get_global_id(0) * chunk;
    if (begin >= count) return;
    const int end = min(begin + chunk, count);
    for (int k = first + begin; k < first + end; ++k) {
        realn ax = lcl_zero();
        for (uint e = offsets[k]; e < offsets[k + 1]; ++e) ax += weights[e] * x[columns[e]];
        x[rows[k]] += inverse_diagonal[k] * (m[rows[k]] - ax);
    }
}
