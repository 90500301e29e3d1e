// SPDX-License-Identifier: BSD-3-Clause
// Caller's points to rows of the device and back:
//     row_i = (x_{order[i]} - centre) * scale,    x_{order[i]} = row_i * inverse_scale + centre,    channel by channel.
// The difference comes before anything is rounded to LCL_REAL, so that models far from the origin lose nothing but what their own numbers lack.
// One work-item owns row i and, on the way back, the caller's row order[i]: `order` names each of the caller's rows at most once, so no two work-items write
// the same element.
// Every element is computed on its own: the same bits on every run.
//
// LCL_REAL    element of the device's rows: float (default) or double
// LCL_SOURCE  element of the caller's array: float (default) or double
// LCL_WIDTH   components of a row: 1, 2, 4 (default) or 8
// Arithmetic is double if either element is (the device must have cl_khr_fp64 then), else float.
#ifndef LCL_REAL
#define LCL_REAL float
#endif
#ifndef LCL_SOURCE
#define LCL_SOURCE float
#endif
#ifndef LCL_WIDTH
#define LCL_WIDTH 4
#endif

// The preprocessor cannot compare types, but it can join their names: LCL_IS_double is 1, LCL_IS_float is no macro and counts as 0.
#define LCL_IS_double 1
#define LCL_JOIN_NAMES(a, b) a##b
#define LCL_IS(type) LCL_JOIN_NAMES(LCL_IS_, type)
#if LCL_IS(LCL_REAL) || LCL_IS(LCL_SOURCE)
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double lcl_wide;
#else
typedef float lcl_wide;
#endif

// count     rows
// stride    elements from one of the caller's rows to the next
// offset    elements before the caller's first row
// first     the caller's first channel taken
// channels  how many are taken, 1..LCL_WIDTH; the components after them become 0
// order     count, read: the caller's row of each of ours
// frame     3 x LCL_WIDTH, read: centre, scale, inverse scale of each component; powers of two as scales keep the round trip exact
// source    the caller's array, read: row r at offset + r * stride
// rows      count x LCL_WIDTH, written
__kernel void lcl_import_points(const uint count, const ulong stride, const ulong offset, const uint first, const uint channels,
                                __global const int* restrict order, __constant lcl_wide* frame,
                                __global const LCL_SOURCE* restrict source, __global LCL_REAL* restrict rows) {
    const size_t i = get_global_id(0);
    if (i >= count) return;
    __global const LCL_SOURCE* from = source + offset + (ulong)order[i] * stride + first;
    for (uint k = 0; k < LCL_WIDTH; ++k) {
        rows[i * LCL_WIDTH + k] = k < channels ? (LCL_REAL)(((lcl_wide)from[k] - frame[k]) * frame[LCL_WIDTH + k]) : (LCL_REAL)0;
    }
}

// The arguments of lcl_import_points, with the last two changed: rows are read; target is written, at the taken channels of the rows in `order` and nowhere
// else.
__kernel void lcl_export_points(const uint count, const ulong stride, const ulong offset, const uint first, const uint channels,
                                __global const int* restrict order, __constant lcl_wide* frame,
                                __global const LCL_REAL* restrict rows, __global LCL_SOURCE* restrict target) {
    const size_t i = get_global_id(0);
    if (i >= count) return;
    __global LCL_SOURCE* to = target + offset + (ulong)order[i] * stride + first;
    for (uint k = 0; k < channels; ++k) to[k] = (LCL_SOURCE)((lcl_wide)rows[i * LCL_WIDTH + k] * frame[2 * LCL_WIDTH + k] + frame[k]);
}
