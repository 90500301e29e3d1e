// SPDX-License-Identifier: BSD-3-Clause
// Improved Perlin noise (Perlin, "Improving Noise", SIGGRAPH 2002) at points q, one octave of it:
//     f(q) = sum over the corners c of q's lattice cell of w(q_x - c_x) w(q_y - c_y) w(q_z - c_z) g_c . (q - c),    w(d) = 1 - fade(|d|),    fade(t) = 6 t^5 - 15 t^4 + 10 t^3,
// g_c one of the twelve vectors from a cube's centre to the middles of its edges (four of them stand twice in a list of sixteen), chosen by hashing c with a permutation of 0 .. 255.
//
// A point comes as its cell, floor(q) modulo 256, and as what that leaves, q - floor(q), both made in double on the host. So every device, with double precision or without, looks at
// the same lattice points, and a float loses only the rounding of a number from 0 to 1 (2^-25, for values about 1e-6), however many cells lie between the point and the origin.
// One work-item owns one point and one value; values are computed on their own: the same bits on every run.
#include "types.cl.h"
#include "noise.cl.h"

__constant uchar lcl_permutation[256] = {LCL_PERMUTATION};

inline uint lcl_hash(uint n) { return lcl_permutation[n & 255]; }

inline real lcl_fade(real t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// g . (x, y, z) with the gradient that the low four bits of `hash` choose: two of the coordinates, each with a sign.
inline real lcl_slope(uint hash, real x, real y, real z) {
    const uint gradient = hash & 15;
    const real first = gradient < 8 ? x : y;
    const real second = gradient < 4 ? y : (gradient & 13) == 12 ? x : z;
    return (gradient & 1 ? -first : first) + (gradient & 2 ? -second : second);
}

/// On an edge of the cell along z: `column` is the hash of its x and y, (x, y, z) the point seen from its lower end.
inline real lcl_along_z(uint column, uchar4 cell, real x, real y, real z) {
    return mix(lcl_slope(lcl_hash(column + cell.z), x, y, z), lcl_slope(lcl_hash(column + cell.z + 1), x, y, z - 1), lcl_fade(z));
}

/// On a side of the cell across x: `side` is the hash of its x.
inline real lcl_along_y(uint side, uchar4 cell, real x, real y, real z) {
    return mix(lcl_along_z(lcl_hash(side + cell.y), cell, x, y, z), lcl_along_z(lcl_hash(side + cell.y + 1), cell, x, y - 1, z), lcl_fade(y));
}

/// count: points. octave: values are divided by 2^octave. cells: count, read: the point's cell along x, y, z, modulo 256; the fourth component is not looked at.
/// fractions: count x 3, read: where in the cell the point lies, from 0 to 1. values: count, written.
__kernel void lcl_noise(const int count, const int octave, const __global uchar4 *restrict cells, const __global real *restrict fractions, __global real *restrict values) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const uchar4 cell = cells[i];
    const real x = fractions[3 * i], y = fractions[3 * i + 1], z = fractions[3 * i + 2];
    const real value = mix(lcl_along_y(lcl_hash(cell.x), cell, x, y, z), lcl_along_y(lcl_hash(cell.x + 1), cell, x - 1, y, z), lcl_fade(x));
    values[i] = ldexp(value, -octave);
}
