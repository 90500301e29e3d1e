// SPDX-License-Identifier: BSD-3-Clause
// The two-phase scheme on its refined mesh M^1 (two-phase paper, sections 3.3, 3.4 and 4; fairness: X that minimises |X - X_0|^2 + W |L X|^2 under the umbrellas' constraints, by projected
// conjugate gradients). Every vertex of M^1 belongs to the umbrella of one old vertex. Points stand umbrella after umbrella, the centre first, so that an umbrella lies together in memory.
//
// Steps that write points by umbrella have one work-item an umbrella, which writes the umbrella's points and nobody else's; steps by row have one a row. Sums are kept one a block, in double
// where the device has it, and the host adds them in order: the same bits in every run. Meant for LCL_REAL double: positions have to be met to rounding.
//
// Masks: three weights a point, the centre first, then the members in their order: a of the limit point V_inf = sum a_k X_k, b and c of two tangents. The least-norm step towards a limit
// point Q and a tangent plane with unit normal N is (two-phase paper, equation 15, in a form that also holds where the masks are not orthogonal, at boundaries)
//     eps_k = a_k (R - (R.N) N) / sum a^2 + (a_k y_0 + b_k y_1 + c_k y_2) N,    G y = (R.N, -(b X).N, -(c X).N),    R = Q - V_inf,
// G the Gram matrix of a, b, c. Without a normal N = 0 and eps_k = a_k R / sum a^2, equation 7.
#include "reduce.cl.h"
#include "two_phase.cl.h"

/// A point, or three weights, with a fourth component that is 0 throughout: oclgrind's check for uninitialized values cannot follow vectors of three.
typedef LCL_JOIN(LCL_REAL, 4) point;
inline point lcl_load(const int i, const __global real *x) { return (point)(x[3 * (size_t)i], x[3 * (size_t)i + 1], x[3 * (size_t)i + 2], 0); }
inline void lcl_store(const point a, const int i, __global real *x) {
    x[3 * (size_t)i] = a.x;
    x[3 * (size_t)i + 1] = a.y;
    x[3 * (size_t)i + 2] = a.z;
}

/// offsets: count + 1, first point of each umbrella. mask_of: count, number of the umbrella's mask. mask_offsets: first entry of each mask. masks: entries x 3, weights a, b, c.
/// grams: masks x 7, 1 / sum a^2, then the inverse of G: (0,0) (0,1) (0,2) (1,1) (1,2) (2,2), zeros where there are no tangents. All read.
#define LCL_UMBRELLAS                                                                                                                                                     \
    const __global int *restrict offsets, const __global int *restrict mask_of, const __global int *restrict mask_offsets,           \
        const __global real *restrict masks, const __global real *restrict grams
#define LCL_UMBRELLA_ARGUMENTS offsets, mask_of, mask_offsets, masks, grams

/// The masks applied to an umbrella's points; V_inf relative to the centre, which keeps digits far from the origin.
typedef struct {
    point limit, first, second;
} lcl_mask_sums;

inline void lcl_sum_masks(const int u, LCL_UMBRELLAS, const __global real *x, lcl_mask_sums *found) {
    const __global real *mask = masks + 3 * mask_offsets[mask_of[u]];
    const point centre = lcl_load(offsets[u], x);
    lcl_mask_sums sums;
    sums.limit = sums.first = sums.second = (point)(0);
    for (int k = offsets[u] + 1, entry = 1; k < offsets[u + 1]; ++k, ++entry) {
        const point from_centre = lcl_load(k, x) - centre, weights = lcl_load(entry, mask);
        sums.limit += weights.x * from_centre;
        sums.first += weights.y * from_centre;
        sums.second += weights.z * from_centre;
    }
    *found = sums;
}

/// x += eps on the umbrella; residual: Q - V_inf.
inline void lcl_least_norm_step(const int u, LCL_UMBRELLAS, const lcl_mask_sums *sums, const point residual, const point normal, __global real *x) {
    const __global real *mask = masks + 3 * mask_offsets[mask_of[u]];
    const __global real *gram = grams + 7 * mask_of[u];
    const real along = dot(residual, normal), first = -dot(sums->first, normal), second = -dot(sums->second, normal);
    const point y = {gram[1] * along + gram[2] * first + gram[3] * second, gram[2] * along + gram[4] * first + gram[5] * second,
                     gram[3] * along + gram[5] * first + gram[6] * second, 0};
    const point across = gram[0] * (residual - along * normal);
    for (int k = offsets[u], entry = 0; k < offsets[u + 1]; ++k, ++entry) {
        const point weights = lcl_load(entry, mask);
        lcl_store(lcl_load(k, x) + weights.x * across + dot(weights, y) * normal, k, x);
    }
}

/// count: umbrellas. constrained: count, 1 where Q is to be met. targets: count x 3, Q. normals: count x 3, unit or 0. x: points of M^1 x 3, updated. distances: count, |Q - V_inf| before, 0
/// where not constrained. sides: count, (first x second).N before, 1 without a normal: at most 0 where the surface looked to the other side.
__kernel void lcl_umbrella_repair(const int count, LCL_UMBRELLAS, const __global uchar *restrict constrained, const __global real *restrict targets,
                                  const __global real *restrict normals, __global real *restrict x, __global real *restrict distances, __global real *restrict sides) {
    const int u = get_global_id(0);
    if (u >= count) return;
    distances[u] = 0;
    sides[u] = 1;
    if (!constrained[u]) return;
    lcl_mask_sums sums;
    lcl_sum_masks(u, LCL_UMBRELLA_ARGUMENTS, x, &sums);
    const point residual = (lcl_load(u, targets) - lcl_load(offsets[u], x)) - sums.limit, normal = lcl_load(u, normals);
    distances[u] = length(residual);
    if (dot(normal, normal) > 0) sides[u] = dot(cross(sums.first, sums.second), normal);
    lcl_least_norm_step(u, LCL_UMBRELLA_ARGUMENTS, &sums, residual, normal, x);
}

/// X <- V_inf + S (X - V_inf). handles: count, S. x: points of M^1 x 3, updated.
__kernel void lcl_umbrella_scale(const int count, LCL_UMBRELLAS, const __global real *restrict handles, __global real *restrict x) {
    const int u = get_global_id(0);
    if (u >= count || handles[u] == 1) return;
    lcl_mask_sums sums;
    lcl_sum_masks(u, LCL_UMBRELLA_ARGUMENTS, x, &sums);
    const point limit = lcl_load(offsets[u], x) + sums.limit;
    for (int k = offsets[u]; k < offsets[u + 1]; ++k) lcl_store(limit + handles[u] * (lcl_load(k, x) - limit), k, x);
}

/// Rows of L, the mean of the neighbours that count minus the point. row_offsets: points + 1. neighbours: the edge neighbours of each point, with LCL_COUNTS where its row counts them, and
/// LCL_IS_COUNTED where theirs counts it. lengths: points, how many count; 0: an empty row.
#define LCL_FAIR_ROWS const __global uint *restrict row_offsets, const __global uint *restrict neighbours, const __global int *restrict lengths

/// z = L x, each row divided by its length, as L^T will want it, with the partial sums of |L x|^2. count: points; rows a block: block_rows. x: points x 3, read; z: the same, written.
/// sums: one a block.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_fair_laplacian(const int count, const int block_rows, LCL_FAIR_ROWS, const __global real *restrict x,
                                                                                       __global real *restrict z, __global sum_real *restrict sums) {
    LCL_SCRATCH(sum_real, scratch)
    const int lane = get_local_id(0), block = get_group_id(0);
    sum_real sum = 0;
    for (int i = block * block_rows + lane; i < min(count, (block + 1) * block_rows); i += LCL_GROUP) {
        const point own = lcl_load(i, x);
        const real share = (real)(1) / (real)(max(lengths[i], 1));
        point row = (point)(0);
        for (uint e = row_offsets[i]; e < row_offsets[i + 1]; ++e)
            if (neighbours[e] & LCL_COUNTS) row += lcl_load(neighbours[e] & LCL_PLACE, x) - own;
        row *= share;
        lcl_store(share * row, i, z);
        sum += dot(row, row);
    }
    LCL_GROUP_STORE_SUM(sum, scratch, sums, block);
}

/// (L^T L x)_i, x that of lcl_fair_laplacian: every row that counts i gives its share, i's own takes it away.
inline point lcl_transposed(const int i, LCL_FAIR_ROWS, const __global real *restrict z) {
    point value = -(real)(lengths[i]) * lcl_load(i, z);
    for (uint e = row_offsets[i]; e < row_offsets[i + 1]; ++e)
        if (neighbours[e] & LCL_IS_COUNTED) value += lcl_load(neighbours[e] & LCL_PLACE, z);
    return value;
}

/// q = C (shift p + fair_weight L^T L x) with the partial sums of p.q, C the projection on to directions in which limit points and tangent planes stay. count: umbrellas; umbrellas a block:
/// block_rows. p: points x 3, z: that of lcl_fair_laplacian, read; q: the same, written. sums: one a block.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_fair_apply(const int count, const int block_rows, LCL_UMBRELLAS, LCL_FAIR_ROWS,
                                                                                   const __global uchar *restrict constrained, const __global real *restrict normals, const real shift,
                                                                                   const real fair_weight, const __global real *restrict p, const __global real *restrict z,
                                                                                   __global real *restrict q, __global sum_real *restrict sums) {
    LCL_SCRATCH(sum_real, scratch)
    const int lane = get_local_id(0), block = get_group_id(0);
    sum_real sum = 0;
    for (int u = block * block_rows + lane; u < min(count, (block + 1) * block_rows); u += LCL_GROUP) {
        for (int i = offsets[u]; i < offsets[u + 1]; ++i)
            lcl_store(shift * lcl_load(i, p) + fair_weight * lcl_transposed(i, row_offsets, neighbours, lengths, z), i, q);
        if (constrained[u]) {
            lcl_mask_sums found;
            lcl_sum_masks(u, LCL_UMBRELLA_ARGUMENTS, q, &found);
            lcl_least_norm_step(u, LCL_UMBRELLA_ARGUMENTS, &found, -lcl_load(offsets[u], q) - found.limit, lcl_load(u, normals), q);
        }
        for (int i = offsets[u]; i < offsets[u + 1]; ++i) sum += dot(lcl_load(i, p), lcl_load(i, q));
    }
    LCL_GROUP_STORE_SUM(sum, scratch, sums, block);
}

/// x += alpha p, r -= beta q, with the partial sums of |r|^2, over plain numbers. count: numbers; numbers a block: block_rows. x, r: updated; p, q: read.
__kernel __attribute__((reqd_work_group_size(LCL_GROUP, 1, 1))) void lcl_fair_update(const uint count, const uint block_rows, const real alpha, const real beta,
                                                                                    const __global real *restrict p, const __global real *restrict q, __global real *restrict x,
                                                                                    __global real *restrict r, __global sum_real *restrict sums) {
    LCL_SCRATCH(sum_real, scratch)
    const uint lane = get_local_id(0), block = get_group_id(0);
    sum_real sum = 0;
    for (uint i = block * block_rows + lane; i < min(count, (block + 1) * block_rows); i += LCL_GROUP) {
        x[i] += alpha * p[i];
        const real residual = r[i] - beta * q[i];
        r[i] = residual;
        sum += residual * residual;
    }
    LCL_GROUP_STORE_SUM(sum, scratch, sums, block);
}

/// p = r + beta p. count: numbers. r: read; p: updated.
__kernel void lcl_fair_turn(const uint count, const real beta, const __global real *restrict r, __global real *restrict p) {
    const uint i = get_global_id(0);
    if (i < count) p[i] = r[i] + beta * p[i];
}
