// SPDX-License-Identifier: BSD-3-Clause
// Types shared by the kernels and, for the structs, by the host, which includes this file as C++.
//
// Build options: LCL_REAL float (default) or double; LCL_WIDTH channels in a row of a field, 1, 2, 4 (default) or 8; LCL_GROUP work-items that sweep one block together, 1 (default, best on
// CPUs) or a power of two (GPUs); LCL_HAS_DOUBLE where the device has double precision; LCL_PAIR: rows are pairs of floats, 48 bits, for devices that have none;
// LCL_MIXED: rows begin with x, y, z, and further channels follow; LCL_FLOAT_FIELDS: fields are floats although LCL_REAL (or LCL_PAIR) is wider.
#ifndef LCL_TYPES_CL_H
#define LCL_TYPES_CL_H

/// Consecutive rows of one shape. Ring rows have their neighbours at indices[index_offset + i * stride], weighted rows are counted from index_offset on.
typedef struct {
    int first, count, shape, edges;
    unsigned int index_offset, unused0, unused1, unused2;
} lcl_run;

/// Rows that one work-group sweeps.
typedef struct {
    int first_run, run_count, first_row, row_count;
} lcl_block;

/// Sweeps that one chain holds at most.
#define LCL_CHAIN 16

#define LCL_SHAPE_IDENTITY 0   /* A x = x */
#define LCL_SHAPE_RING 1       /* vertex and edge ends */
#define LCL_SHAPE_FULL_RING 2  /* vertex, edge ends, face diagonals */
#define LCL_SHAPE_WEIGHTED 3   /* stored weights, the vertex among them */

#ifndef __cplusplus

#ifdef LCL_HAS_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif
#ifndef LCL_REAL
#define LCL_REAL float
#endif
#ifndef LCL_WIDTH
#define LCL_WIDTH 4
#endif
#ifndef LCL_GROUP
#define LCL_GROUP 1
#endif

#define LCL_JOIN_(a, b) a##b
#define LCL_JOIN(a, b) LCL_JOIN_(a, b)
#if LCL_WIDTH == 1
#define LCL_VECTOR(scalar) scalar
#else
#define LCL_VECTOR(scalar) LCL_JOIN(scalar, LCL_WIDTH)
#endif

typedef LCL_VECTOR(float) floatn;
typedef LCL_REAL real; /* norms */

#ifdef LCL_HAS_DOUBLE
typedef LCL_VECTOR(double) sumn; /* sums over many rows */
typedef double sum_real;
#if LCL_WIDTH == 1
#define LCL_TO_SUM(value) ((double)(value))
#else
#define LCL_TO_SUM(value) LCL_JOIN(convert_double, LCL_WIDTH)(value)
#endif
#else
typedef LCL_VECTOR(float) sumn;
typedef float sum_real;
#define LCL_TO_SUM(value) (value)
#endif

#ifdef LCL_PAIR

#pragma OPENCL FP_CONTRACT OFF
/// hi + lo, |lo| <= ulp(hi)/2.
typedef struct { floatn hi, lo; } realn;
typedef struct { float hi, lo; } weight;

inline realn lcl_normal_pair(floatn a, floatn b) {
    realn out;
    out.hi = a + b;
    out.lo = b - (out.hi - a);
    return out;
}
inline realn lcl_add(realn a, realn b) {
    const floatn sum = a.hi + b.hi;
    const floatn part = sum - a.hi;
    const floatn error = (a.hi - (sum - part)) + (b.hi - part);
    return lcl_normal_pair(sum, error + (a.lo + b.lo));
}
inline realn lcl_scale(weight w, realn a) {
    const floatn product = w.hi * a.hi;
    const floatn error = fma((floatn)(w.hi), a.hi, -product);
    return lcl_normal_pair(product, error + (w.hi * a.lo + w.lo * a.hi));
}
inline realn lcl_zero(void) { realn out; out.hi = (floatn)(0); out.lo = (floatn)(0); return out; }
inline realn lcl_minus(realn a) { a.hi = -a.hi; a.lo = -a.lo; return a; }
inline realn lcl_widen(floatn a) { realn out; out.hi = a; out.lo = (floatn)(0); return out; }
inline floatn lcl_narrow(realn a) { return a.hi + a.lo; }
inline real lcl_inverse(weight w) { return 1.0f / w.hi; }
inline int lcl_is_zero(weight w) { return w.hi == 0; }
inline sumn lcl_to_sum(realn a) { return lcl_narrow(a); }
inline sum_real lcl_weight_to_sum(weight w) { return w.hi; }

#else

typedef LCL_VECTOR(LCL_REAL) realn;
typedef LCL_REAL weight;

inline realn lcl_add(realn a, realn b) { return a + b; }
inline realn lcl_scale(weight w, realn a) { return w * a; }
inline realn lcl_zero(void) { return (realn)(0); }
inline realn lcl_minus(realn a) { return -a; }
inline real lcl_inverse(weight w) { return 1 / w; }
inline int lcl_is_zero(weight w) { return w == 0; }
inline sumn lcl_to_sum(realn a) { return LCL_TO_SUM(a); }
inline sum_real lcl_weight_to_sum(weight w) { return w; }
#if LCL_WIDTH == 1
inline realn lcl_widen(floatn a) { return (realn)(a); }
inline floatn lcl_narrow(realn a) { return (floatn)(a); }
#else
inline realn lcl_widen(floatn a) { return LCL_JOIN(LCL_JOIN(convert_, LCL_REAL), LCL_WIDTH)(a); }
inline floatn lcl_narrow(realn a) { return LCL_JOIN(convert_float, LCL_WIDTH)(a); }
#endif

#endif /* LCL_PAIR */

/* Squared Euclidean norm of a row; OpenCL's dot ends at four components. */
#if LCL_WIDTH == 8
#define LCL_SQUARE_OF(a) (dot((a).lo, (a).lo) + dot((a).hi, (a).hi))
#else
#define LCL_SQUARE_OF(a) dot(a, a)
#endif

/* Rows of fields: of the sums' own type, or floats of which wide sums are made. */
#ifdef LCL_FLOAT_FIELDS
typedef floatn fieldn;
#define LCL_ROW(row) lcl_widen(row)
#else
typedef realn fieldn;
#define LCL_ROW(row) (row)
#endif

#endif /* __cplusplus */
#endif
