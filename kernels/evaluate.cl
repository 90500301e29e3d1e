// SPDX-License-Identifier: BSD-3-Clause
// Exact points and derivatives of limit surfaces at samples (Stam 1998; Doo-Sabin paper, chapter 5). A sample lies at (s, t) in a patch.
//
// Regular patch: S = sum_r w_r(s, t) P_r, w the weights of 16 points (Catmull-Clark, bicubic B-spline), 12 (Loop, quartic box spline) or 9 (Doo-Sabin, biquadratic B-spline).
// Irregular patch: with c_j the projections of its control points on the modes of its kind, c_0 its limit point at (0, 0), cell (m, k) that holds (s, t) has the control points
//     P_r = c_0 + sum over j > 0 of cells_k[j][r] weight_m[j] c_j,    weight_m[j] = value_j^m (m value_j^m in a defective pair),
// and is evaluated like a regular one. c_0 is added last and to the position alone: derivatives keep their relative accuracy down to the point itself. Kinds at sharp features have no modes: there
// c_j are the control points minus c_0, cells_k depends on m too (powers of the local subdivision), and the weights are 1.
//
// Build options beside those of types.cl.h: LCL_POINTS 16 (default), 12 or 9; LCL_WANT, a sum of what is computed (evaluate.cl.h).
// Values go to blocks of `out`, in this order and each only if it is wanted: points, S_u, S_v, normals, S_uu, S_uv, S_vv (3 x capacity each), Gaussian and mean curvature (capacity each); within a
// block sample i stands at its own place, order_i. One work-item owns one sample: writes cannot collide, and values do not depend on what else is in the launch.
#include "types.cl.h"
#include "evaluate.cl.h"
#include "patches.cl.h"

#ifndef LCL_POINTS
#define LCL_POINTS 16
#endif
#ifndef LCL_WANT
#define LCL_WANT 31
#endif
#if LCL_WANT >= LCL_WANT_SECOND
#define LCL_JETS 6
#elif LCL_WANT >= LCL_WANT_FIRST
#define LCL_JETS 3
#else
#define LCL_JETS 1
#endif

typedef LCL_JOIN(LCL_REAL, 2) real2;
typedef LCL_JOIN(LCL_REAL, 4) real4;
typedef LCL_JOIN(LCL_REAL, 16) real16;

typedef struct {
    real4 at[LCL_JETS]; /* S, S_s, S_t, S_ss, S_st, S_tt */
} lcl_jet;

#if LCL_POINTS == 12

__constant real lcl_box_spline[15 * 16] = {LCL_BOX_SPLINE};
#define LCL_BOX(q) vload16(q, lcl_box_spline)

/// Sum of weighted control points.
inline real4 lcl_sum(real16 w, const real4 *p) {
    const real4 first = w.s0 * p[0] + w.s1 * p[1] + w.s2 * p[2] + w.s3 * p[3], second = w.s4 * p[4] + w.s5 * p[5] + w.s6 * p[6] + w.s7 * p[7];
    return (first + second + (w.s8 * p[8] + w.s9 * p[9] + w.sa * p[10] + w.sb * p[11])) / 12;
}

/// The jet of control points p at (s, t). Weights of all points together: polynomials in t whose coefficients a_k, of t^k, are polynomials in s.
inline void lcl_evaluate(real s, real t, const real4 *p, lcl_jet *jet) {
    const real16 a0 = LCL_BOX(0) + s * (LCL_BOX(1) + s * (LCL_BOX(3) + s * (LCL_BOX(6) + s * LCL_BOX(10))));
    const real16 a1 = LCL_BOX(2) + s * (LCL_BOX(4) + s * (LCL_BOX(7) + s * LCL_BOX(11)));
    const real16 a2 = LCL_BOX(5) + s * (LCL_BOX(8) + s * LCL_BOX(12)), a3 = LCL_BOX(9) + s * LCL_BOX(13), a4 = LCL_BOX(14);
    jet->at[0] = lcl_sum(a0 + t * (a1 + t * (a2 + t * (a3 + t * a4))), p);
#if LCL_JETS > 1
    const real16 b0 = LCL_BOX(1) + s * (2 * LCL_BOX(3) + s * (3 * LCL_BOX(6) + 4 * s * LCL_BOX(10)));
    const real16 b1 = LCL_BOX(4) + s * (2 * LCL_BOX(7) + 3 * s * LCL_BOX(11)), b2 = LCL_BOX(8) + 2 * s * LCL_BOX(12), b3 = LCL_BOX(13);
    jet->at[1] = lcl_sum(b0 + t * (b1 + t * (b2 + t * b3)), p);
    jet->at[2] = lcl_sum(a1 + t * (2 * a2 + t * (3 * a3 + 4 * t * a4)), p);
#endif
#if LCL_JETS > 3
    const real16 c0 = 2 * LCL_BOX(3) + s * (6 * LCL_BOX(6) + 12 * s * LCL_BOX(10)), c1 = 2 * LCL_BOX(7) + 6 * s * LCL_BOX(11), c2 = 2 * LCL_BOX(12);
    jet->at[3] = lcl_sum(c0 + t * (c1 + t * c2), p);
    jet->at[4] = lcl_sum(b1 + t * (2 * b2 + 3 * t * b3), p);
    jet->at[5] = lcl_sum(2 * a2 + t * (6 * a3 + 12 * t * a4), p);
#endif
}

#else

/* Uniform B-splines of degree 3 and 2 on [0, 1]: four or three weights (Doo-Sabin paper; source slip there: N1 = (-2 t^2 + 2 t + 1)/2). The fourth of three is 0. */
#if LCL_POINTS == 16
inline real4 lcl_spline(real t) {
    const real r = 1 - t;
    return (real4)(r * r * r, t * t * (3 * t - 6) + 4, r * r * (3 * r - 6) + 4, t * t * t) / 6;
}
inline real4 lcl_spline_1(real t) {
    const real r = 1 - t;
    return (real4)(-r * r, t * (3 * t - 4), r * (4 - 3 * r), t * t) / 2;
}
inline real4 lcl_spline_2(real t) { return (real4)(1 - t, 3 * t - 2, 1 - 3 * t, t); }
#define LCL_POINTS_OF_ROW(p) ((real16)((p)[0], (p)[1], (p)[2], (p)[3]))
#else
inline real4 lcl_spline(real t) { return (real4)((1 - t) * (1 - t), 1 + 2 * t * (1 - t), t * t, 0) / 2; }
inline real4 lcl_spline_1(real t) { return (real4)(t - 1, 1 - 2 * t, t, 0); }
inline real4 lcl_spline_2(real t) { return (real4)(1, -2, 1, 0); }
#define LCL_POINTS_OF_ROW(p) ((real16)((p)[0], (p)[1], (p)[2], (real4)(0)))
#endif

/// Rows of control points added up by weights along t.
inline real16 lcl_along_t(real4 w, const real16 *row) {
#if LCL_POINTS == 16
    return w.x * row[0] + w.y * row[1] + w.z * row[2] + w.w * row[3];
#else
    return w.x * row[0] + w.y * row[1] + w.z * row[2];
#endif
}

/// The points of a row added up by weights along s.
inline real4 lcl_along_s(real4 w, real16 row) {
#if LCL_POINTS == 16
    return w.x * row.s0123 + w.y * row.s4567 + w.z * row.s89ab + w.w * row.scdef;
#else
    return w.x * row.s0123 + w.y * row.s4567 + w.z * row.s89ab;
#endif
}

/// The jet of control points p at (s, t): along t for all points of a row together, then along s.
inline void lcl_evaluate(real s, real t, const real4 *p, lcl_jet *jet) {
#if LCL_POINTS == 16
    const real16 row[4] = {LCL_POINTS_OF_ROW(p), LCL_POINTS_OF_ROW(p + 4), LCL_POINTS_OF_ROW(p + 8), LCL_POINTS_OF_ROW(p + 12)};
#else
    const real16 row[3] = {LCL_POINTS_OF_ROW(p), LCL_POINTS_OF_ROW(p + 3), LCL_POINTS_OF_ROW(p + 6)};
#endif
    const real4 s0 = lcl_spline(s);
    const real16 value = lcl_along_t(lcl_spline(t), row);
    jet->at[0] = lcl_along_s(s0, value);
#if LCL_JETS > 1
    const real4 s1 = lcl_spline_1(s);
    const real16 by_t = lcl_along_t(lcl_spline_1(t), row);
    jet->at[1] = lcl_along_s(s1, value);
    jet->at[2] = lcl_along_s(s0, by_t);
#endif
#if LCL_JETS > 3
    jet->at[3] = lcl_along_s(lcl_spline_2(s), value);
    jet->at[4] = lcl_along_s(s1, by_t);
    jet->at[5] = lcl_along_s(s0, lcl_along_t(lcl_spline_2(t), row));
#endif
}

#endif

/// From derivatives by the patch's own (s, t) to those by (u, v): S_u = turn.x S_s + turn.y S_t, S_v = turn.z S_s + turn.w S_t.
inline void lcl_turn(real4 turn, lcl_jet *jet) {
#if LCL_JETS > 3
    const real4 ss = jet->at[3], st = jet->at[4], tt = jet->at[5];
    jet->at[3] = turn.x * turn.x * ss + 2 * turn.x * turn.y * st + turn.y * turn.y * tt;
    jet->at[4] = turn.x * turn.z * ss + (turn.x * turn.w + turn.y * turn.z) * st + turn.y * turn.w * tt;
    jet->at[5] = turn.z * turn.z * ss + 2 * turn.z * turn.w * st + turn.w * turn.w * tt;
#endif
#if LCL_JETS > 1
    const real4 s = jet->at[1], t = jet->at[2];
    jet->at[1] = turn.x * s + turn.y * t;
    jet->at[2] = turn.z * s + turn.w * t;
#endif
}

inline real lcl_length(real4 a) { return sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }
/// Also of vectors whose squares are too small for the type.
inline real4 lcl_unit(real4 a) {
    a /= fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
    return a / lcl_length(a);
}

/// Unit normal; NaN where the first derivatives are parallel or one of them vanishes, as far as their rounding, and what limit tangents at sharp features leave open (1e-7), lets one tell.
inline real4 lcl_normal(real4 u, real4 v) {
    const real4 unit_u = lcl_unit(u), unit_v = lcl_unit(v);
    const real4 normal = cross(unit_u, unit_v);
    const real length = lcl_length(normal);
    return length > (sizeof(real) == 8 ? (real)1e-6 : (real)1e-5) ? normal / length : (real4)(NAN);
}

/// Gaussian and mean curvature, the latter positive where the surface bends away from the normal.
inline real2 lcl_curvatures(const lcl_jet *jet, real4 n) {
#if LCL_WANT >= LCL_WANT_CURVATURES
    const real4 u = jet->at[1], v = jet->at[2];
    const real e = dot(u, u), f = dot(u, v), g = dot(v, v), area = e * g - f * f;
    const real l = dot(n, jet->at[3]), m = dot(n, jet->at[4]), k = dot(n, jet->at[5]);
    return (real2)((l * k - m * m) / area, -(e * k - 2 * f * m + g * l) / (2 * area));
#else
    return (real2)(0);
#endif
}

inline ulong lcl_put(real4 value, __global real *out, ulong block, int capacity, int order) {
    vstore3(value.xyz, order, out + block);
    return block + 3 * (ulong)capacity;
}

/// Writes what is wanted of a jet by (u, v).
inline void lcl_write(const lcl_jet *jet, int capacity, int order, __global real *out) {
    ulong block = 0;
#if LCL_WANT & LCL_WANT_POINTS
    block = lcl_put(jet->at[0], out, block, capacity, order);
#endif
#if LCL_WANT & LCL_WANT_FIRST
    block = lcl_put(jet->at[1], out, block, capacity, order);
    block = lcl_put(jet->at[2], out, block, capacity, order);
#endif
#if LCL_WANT & (LCL_WANT_NORMALS | LCL_WANT_CURVATURES)
    const real4 normal = lcl_normal(jet->at[1], jet->at[2]);
#endif
#if LCL_WANT & LCL_WANT_NORMALS
    block = lcl_put(normal, out, block, capacity, order);
#endif
#if LCL_WANT & LCL_WANT_SECOND
    block = lcl_put(jet->at[3], out, block, capacity, order);
    block = lcl_put(jet->at[4], out, block, capacity, order);
    block = lcl_put(jet->at[5], out, block, capacity, order);
#endif
#if LCL_WANT & LCL_WANT_CURVATURES
    const real2 curvatures = lcl_curvatures(jet, normal);
    out[block + order] = curvatures.x;
    out[block + capacity + order] = curvatures.y;
#endif
}

#define LCL_ORDER(packed) ((int)((packed) & 0xffffff))
#define LCL_TURN(packed) ((packed) >> 24)

/// Samples in regular patches: begin .. begin + count - 1. parameters: s, t of every sample. places: where the control points of its patch begin in `control`.
/// packed: order_i, 24 bits, and its turn, 8 bits above. turns: read. control: numbers of control points. points: control points, read. out: written.
__kernel void lcl_evaluate_regular(const int begin, const int count, const int capacity, const __global real2 *restrict parameters, const __global uint *restrict places,
                                   const __global uint *restrict packed, const __global real4 *restrict turns, const __global int *restrict control,
                                   const __global real4 *restrict points, __global real *restrict out) {
    if ((int)get_global_id(0) >= count) return;
    const int i = begin + get_global_id(0);
    const __global int *numbers = control + places[i];
    real4 p[LCL_POINTS];
    for (int r = 0; r < LCL_POINTS; ++r) p[r] = points[numbers[r]];
    lcl_jet jet;
    lcl_evaluate(parameters[i].x, parameters[i].y, p, &jet);
    lcl_turn(turns[LCL_TURN(packed[i])], &jet);
    lcl_write(&jet, capacity, LCL_ORDER(packed[i]), out);
}

/// Samples in cells that have become regular patches: places: the number of the first of the cell's control points, which follow one another. The rest as above.
__kernel void lcl_evaluate_cells(const int begin, const int count, const int capacity, const __global real2 *restrict parameters, const __global uint *restrict places,
                                 const __global uint *restrict packed, const __global real4 *restrict turns, const __global real4 *restrict points, __global real *restrict out) {
    if ((int)get_global_id(0) >= count) return;
    const int i = begin + get_global_id(0);
    const __global real4 *first = points + places[i];
    real4 p[LCL_POINTS];
    for (int r = 0; r < LCL_POINTS; ++r) p[r] = first[r];
    lcl_jet jet;
    lcl_evaluate(parameters[i].x, parameters[i].y, p, &jet);
    lcl_turn(turns[LCL_TURN(packed[i])], &jet);
    lcl_write(&jet, capacity, LCL_ORDER(packed[i]), out);
}

/// Control points of cell (m, k), without c_0.
inline void lcl_cell(lcl_kind kind, int m, int k, uint column, const __global real *restrict weights, const __global real *restrict cells, const __global real4 *restrict coefficients,
                     real4 *p) {
    const __global real *w = weights + (size_t)kind.weight_stride * m;
    const __global real *cell = cells + (size_t)kind.cell_stride * m + (size_t)k * kind.mode_count * LCL_POINTS;
    for (int r = 0; r < LCL_POINTS; ++r) p[r] = (real4)(0);
    for (int j = 1; j < kind.mode_count; ++j) {
        const real4 c = w[j] * coefficients[kind.first_coefficient + (size_t)j * kind.stride + column];
        for (int r = 0; r < LCL_POINTS; ++r) p[r] += cell[j * LCL_POINTS + r] * c;
    }
}

#if LCL_POINTS == 12
#define LCL_SIZE(s, t) ((s) + (t))
#else
#define LCL_SIZE(s, t) fmax(s, t)
#endif

/// Which cell holds (s', t'), which becomes the place inside it; -1 for cells whose own parameters run backwards.
inline real lcl_find_cell(real *s, real *t, int *k) {
    if (*s >= 1) {
        *k = 0;
        *s -= 1;
#if LCL_POINTS != 12
        if (*t >= 1) {
            *k = 1;
            *t -= 1;
        }
#endif
        return 1;
    }
    if (*t >= 1) {
        *k = 2;
        *t -= 1;
        return 1;
    }
    *k = 1;
    *s = 1 - *s;
    *t = 1 - *t;
    return -1;
}

/// At the extraordinary point: its limit, limit tangents of length `unit` along the two sides, and no second derivatives. The tangents are those of the dominant modes alone, to which the weights after
/// those of the last depth belong; kinds without modes have those of their deepest cells.
inline void lcl_evaluate_tip(lcl_kind kind, uint column, const __global real *restrict weights, const __global real *restrict cells, const __global real4 *restrict coefficients, real4 turn,
                             real unit, lcl_jet *jet) {
#if LCL_JETS > 1
    const int depth = kind.depths - (kind.weight_stride == 0);
    real4 p[LCL_POINTS];
    lcl_cell(kind, depth, 0, column, weights, cells, coefficients, p);
    lcl_evaluate(0, 0, p, jet);
    const real4 along_s = lcl_unit(jet->at[1]);
    lcl_cell(kind, depth, 2, column, weights, cells, coefficients, p);
    lcl_evaluate(0, 0, p, jet);
    jet->at[2] = lcl_unit(jet->at[2]);
    jet->at[1] = along_s;
    lcl_turn(turn, jet);
    jet->at[1] = unit * lcl_unit(jet->at[1]);
    jet->at[2] = unit * lcl_unit(jet->at[2]);
    for (int q = 3; q < LCL_JETS; ++q) jet->at[q] = (real4)(NAN);
#endif
    jet->at[0] = (real4)(0);
}

/// Samples in irregular patches of kind kinds[which]: begin .. begin + count - 1. unit: the length of a limit tangent at an extraordinary point. places: the column of each sample's patch among those of the kind. weights: (depths + 1) x M where weight_stride is M, else M.
/// cells: (depths x) 3 x M x LCL_POINTS. coefficients: c_j of all patches of all kinds. The rest as above.
__kernel void lcl_evaluate_irregular(const int begin, const int count, const int capacity, const real unit, const __global lcl_kind *restrict kinds, const int which,
                                     const __global real2 *restrict parameters, const __global uint *restrict places, const __global uint *restrict packed, const __global real4 *restrict turns,
                                     const __global real *restrict weights, const __global real *restrict cells, const __global real4 *restrict coefficients, __global real *restrict out) {
    if ((int)get_global_id(0) >= count) return;
    const lcl_kind kind = kinds[which];
    const int i = begin + get_global_id(0);
    const real4 turn = turns[LCL_TURN(packed[i])];
    const uint column = places[i];
    real s = parameters[i].x, t = parameters[i].y, shrink = 1;
    lcl_jet jet;
    if (LCL_SIZE(s, t) > 0) {
        int m = max(0, -ilogb(LCL_SIZE(s, t)) - 1), k;
        const int excess = max(0, m - (kind.depths - 1)); /* beyond the table the surface is a cone as far as one can tell */
        m -= excess;
        shrink = ldexp((real)1, -excess);
        s = ldexp(s, m + 1 + excess);
        t = ldexp(t, m + 1 + excess);
        const real scale = ldexp(lcl_find_cell(&s, &t, &k), m + 1);
        real4 p[LCL_POINTS];
        lcl_cell(kind, m, k, column, weights, cells, coefficients, p);
        lcl_evaluate(s, t, p, &jet);
        lcl_turn(scale * turn, &jet);
    } else {
        lcl_evaluate_tip(kind, column, weights, cells, coefficients, turn, unit, &jet);
    }
    jet.at[0] = coefficients[kind.first_coefficient + column] + shrink * jet.at[0];
    lcl_write(&jet, capacity, LCL_ORDER(packed[i]), out);
}

/// c = projection times control points, for every patch of a kind; a work-item makes four coefficients of a patch, so that control points are fetched once for all four. count: patches;
/// point_count: K. projection: M x K. control: count x K numbers. points: read. coefficients: written.
__kernel void lcl_project(const int count, const int point_count, const __global lcl_kind *restrict kinds, const int which, const __global real *restrict projection, const __global int *restrict control,
                          const __global real4 *restrict points, __global real4 *restrict coefficients) {
    const int p = get_global_id(0), j = 4 * get_global_id(1);
    if (p >= count) return;
    const lcl_kind kind = kinds[which];
    const int last = kind.mode_count - 1;
    const __global real *row0 = projection + j * point_count, *row1 = projection + min(j + 1, last) * point_count;
    const __global real *row2 = projection + min(j + 2, last) * point_count, *row3 = projection + min(j + 3, last) * point_count;
    real4 sum0 = (real4)(0), sum1 = (real4)(0), sum2 = (real4)(0), sum3 = (real4)(0);
    for (int i = 0; i < point_count; ++i) {
        const real4 point = points[control[(size_t)p * point_count + i]];
        sum0 += row0[i] * point;
        sum1 += row1[i] * point;
        sum2 += row2[i] * point;
        sum3 += row3[i] * point;
    }
    __global real4 *const out = coefficients + kind.first_coefficient + (size_t)j * kind.stride + p;
    out[0] = sum0;
    if (j + 1 <= last) out[kind.stride] = sum1;
    if (j + 2 <= last) out[2 * (size_t)kind.stride] = sum2;
    if (j + 3 <= last) out[3 * (size_t)kind.stride] = sum3;
}

/// The control points of a kind's patches as a matrix, K x count: gathered[i count + p], so that a dense product takes its place of the projection.
__kernel void lcl_gather(const int count, const int point_count, const __global int *restrict control, const __global real4 *restrict points, __global real4 *restrict gathered) {
    const int p = get_global_id(0), i = get_global_id(1);
    if (p >= count) return;
    gathered[(size_t)i * count + p] = points[control[(size_t)p * point_count + i]];
}

/// The cells of the first `depths` depths of every patch of a kind as regular patches: control points first_point + (3 (p depths + m) + k) LCL_POINTS + r of `points`, written.
__kernel void lcl_expand_cells(const int count, const int depths, const uint first_point, const __global lcl_kind *restrict kinds, const int which, const __global real *restrict weights, const __global real *restrict cells,
                               const __global real4 *restrict coefficients, __global real4 *restrict points) {
    const int cell = get_global_id(0);
    if (cell >= 3 * count * depths) return;
    const lcl_kind kind = kinds[which];
    const int k = cell % 3, m = cell / 3 % depths, column = cell / 3 / depths;
    real4 p[LCL_POINTS];
    lcl_cell(kind, m, k, column, weights, cells, coefficients, p);
    const real4 limit = coefficients[kind.first_coefficient + column];
    __global real4 *const out = points + first_point + (size_t)cell * LCL_POINTS;
    for (int r = 0; r < LCL_POINTS; ++r) out[r] = limit + p[r];
}
