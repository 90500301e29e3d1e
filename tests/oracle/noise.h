// SPDX-License-Identifier: BSD-3-Clause
// Improved Perlin noise by the book: sixteen gradient vectors written out, dot products, and one trilinear interpolation. Its table of the permutation is its
// own.
#pragma once

namespace oracle {

/// f(x, y, z) of "Improving Noise" (Perlin 2002); any finite point.
double improved_noise(double x, double y, double z);

}  // namespace oracle
