// SPDX-License-Identifier: BSD-3-Clause
// Reductions over one work-group, in a fixed order: the same bits in every run. With LCL_GROUP 1 (CPUs) they are no work at all; the host combines the one value a block.
#ifndef LCL_REDUCE_CL_H
#define LCL_REDUCE_CL_H

#include "types.cl.h"

/// The larger one; a not-a-number stays, so that divergence is seen.
#define LCL_LARGER(worst, value) (((value) > (worst) || (value) != (value)) ? (value) : (worst))

/// Largest of many squares by their bits, which are in the numbers' order, with not-a-numbers above all: one integer maximum.
#define LCL_IS_double 1
#define LCL_IS(type) LCL_JOIN(LCL_IS_, type)
#if LCL_IS(LCL_REAL)
typedef ulong square_bits;
#define LCL_SQUARE_BITS(square) as_ulong(fabs(square))
#define LCL_SQUARE(bits) as_double(bits)
#else
typedef uint square_bits;
#define LCL_SQUARE_BITS(square) as_uint(fabs(square))
#define LCL_SQUARE(bits) as_float(bits)
#endif
#define LCL_LARGER_SQUARE(worst, square) max(worst, LCL_SQUARE_BITS(square))

/// Largest squared row norms of a residual, by COMBINE (one of the two above): of the position, and where a row holds further channels beside it (LCL_MIXED), of these. One number a block, two
/// where they are mixed.
#ifdef LCL_MIXED
#if LCL_WIDTH == 8
#define LCL_POSITION_SQUARE(a) dot((a).lo.xyz, (a).lo.xyz)
#define LCL_OTHERS_SQUARE(a) ((a).s3 * (a).s3 + dot((a).hi, (a).hi))
#else
#define LCL_POSITION_SQUARE(a) dot((a).xyz, (a).xyz)
#define LCL_OTHERS_SQUARE(a) ((a).w * (a).w)
#endif
#define LCL_NORM(type) type worst = 0, worst_others = 0;
#define LCL_NORM_TAKE(COMBINE, residual)                               \
    worst = COMBINE(worst, LCL_POSITION_SQUARE(residual));             \
    worst_others = COMBINE(worst_others, LCL_OTHERS_SQUARE(residual));
#define LCL_NORM_STORE(VALUE, scratch, norms, place)                          \
    LCL_GROUP_STORE_MAX(VALUE(worst), scratch, norms, 2 * (place));           \
    LCL_GROUP_WAIT                                                            \
    LCL_GROUP_STORE_MAX(VALUE(worst_others), scratch, norms, 2 * (place) + 1);
#else
#define LCL_NORM(type) type worst = 0;
#define LCL_NORM_TAKE(COMBINE, residual) worst = COMBINE(worst, LCL_SQUARE_OF(residual));
#define LCL_NORM_STORE(VALUE, scratch, norms, place) LCL_GROUP_STORE_MAX(VALUE(worst), scratch, norms, place);
#endif
#define LCL_SAME(value) (value)

#if LCL_GROUP == 1
#define LCL_SCRATCH(type, name)
#define LCL_GROUP_WAIT
#define LCL_GROUP_STORE_MAX(value, scratch, out, place) out[place] = (value)
#define LCL_GROUP_STORE_SUM(value, scratch, out, place) out[place] = (value)
#else
#define LCL_SCRATCH(type, name) __local type name[LCL_GROUP];
#define LCL_GROUP_WAIT barrier(CLK_LOCAL_MEM_FENCE);
// The first work-item combines: Intel's CPU runtime (2026.2) returned wrong values for a tree with a barrier in its loop, and a block's rows cost far more than this.
#define LCL_GROUP_STORE_(value, scratch, out, place, COMBINE)                                               \
    scratch[lane] = (value);                                                                                \
    barrier(CLK_LOCAL_MEM_FENCE);                                                                           \
    if (lane == 0) {                                                                                        \
        for (int other = 1; other < LCL_GROUP; ++other) scratch[0] = COMBINE(scratch[0], scratch[other]);   \
        out[place] = scratch[0];                                                                            \
    }
#define LCL_SUM_OF(a, b) ((a) + (b))
#define LCL_GROUP_STORE_MAX(value, scratch, out, place) LCL_GROUP_STORE_(value, scratch, out, place, LCL_LARGER)
#define LCL_GROUP_STORE_SUM(value, scratch, out, place) LCL_GROUP_STORE_(value, scratch, out, place, LCL_SUM_OF)
#endif

#endif
