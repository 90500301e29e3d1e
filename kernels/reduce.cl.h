// SPDX-License-Identifier: BSD-3-Clause
// Reductions over one work-group, in a fixed order: the same bits in every run. With LCL_GROUP 1 (CPUs) they are no work at all; the host combines the one value a block.
#ifndef LCL_REDUCE_CL_H
#define LCL_REDUCE_CL_H

#include "types.cl.h"

/// The larger one; a not-a-number stays, so that divergence is seen.
#define LCL_LARGER(worst, value) (((value) > (worst) || (value) != (value)) ? (value) : (worst))

#if LCL_GROUP == 1
#define LCL_SCRATCH(type, name)
#define LCL_GROUP_STORE_MAX(value, scratch, out, place) out[place] = (value)
#define LCL_GROUP_STORE_SUM(value, scratch, out, place) out[place] = (value)
#else
#define LCL_SCRATCH(type, name) __local type name[LCL_GROUP];
#define LCL_GROUP_STORE_(value, scratch, out, place, COMBINE)                                      \
    scratch[lane] = (value);                                                                       \
    for (int half_size = LCL_GROUP / 2; half_size > 0; half_size /= 2) {                           \
        barrier(CLK_LOCAL_MEM_FENCE);                                                              \
        if (lane < half_size) scratch[lane] = COMBINE(scratch[lane], scratch[lane + half_size]);   \
    }                                                                                              \
    if (lane == 0) out[place] = scratch[0];                                                        \
    barrier(CLK_LOCAL_MEM_FENCE)
#define LCL_SUM_OF(a, b) ((a) + (b))
#define LCL_GROUP_STORE_MAX(value, scratch, out, place) LCL_GROUP_STORE_(value, scratch, out, place, LCL_LARGER)
#define LCL_GROUP_STORE_SUM(value, scratch, out, place) LCL_GROUP_STORE_(value, scratch, out, place, LCL_SUM_OF)
#endif

#endif
