// SPDX-License-Identifier: BSD-3-Clause
// The quartic box spline of Loop's scheme on one triangle, which kernels and host share: the weights of its twelve control points (in the order of host/evaluate/patch_kind.h), times 12, as
// polynomials in (s, t). Row q holds the coefficients of the monomial q of 1, s, t, s^2, st, t^2, s^3, s^2 t, s t^2, t^3, s^4, s^3 t, s^2 t^2, s t^3, t^4 in the twelve weights, then four zeros.
// From the basis of Stam, "Evaluation of Loop Subdivision Surfaces" (1998), with u = 1 - s - t.
#ifndef LCL_PATCHES_CL_H
#define LCL_PATCHES_CL_H

#define LCL_BOX_SPLINE                                                                              \
    1, 1, 0, 1, 6, 1, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0,                                                 \
    -2, 2, 0, -4, 0, 4, 0, -2, 2, 0, 0, 0, 0, 0, 0, 0,                                              \
    -4, -2, 0, -2, 0, 2, 0, 2, 4, 0, 0, 0, 0, 0, 0, 0,                                              \
    0, 0, 0, 6, -12, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,                                               \
    6, -6, 0, 6, -12, 6, 0, -6, 6, 0, 0, 0, 0, 0, 0, 0,                                             \
    6, 0, 0, 0, -12, 0, 0, 0, 6, 0, 0, 0, 0, 0, 0, 0,                                               \
    2, -4, 2, -4, 8, -4, 0, 2, -4, 2, 0, 0, 0, 0, 0, 0,                                             \
    0, 0, 0, -6, 12, -6, 0, 6, -12, 6, 0, 0, 0, 0, 0, 0,                                            \
    -6, 6, 0, 0, 12, -12, 0, 0, -6, 6, 0, 0, 0, 0, 0, 0,                                            \
    -4, 2, 0, 2, 8, -4, 0, -4, -4, 2, 2, 0, 0, 0, 0, 0,                                             \
    -1, 2, -1, 1, -1, -1, 1, -1, 2, -1, 0, 0, 0, 0, 0, 0,                                           \
    -2, 4, -2, 2, -2, -2, 2, -2, 4, -2, 0, 0, 0, 0, 0, 0,                                           \
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,                                                 \
    2, -2, 0, -2, -2, 4, 0, 4, -2, -2, -2, 2, 0, 0, 0, 0,                                           \
    1, -1, 0, -1, -1, 2, 0, 2, -1, -1, -1, 1, 0, 0, 0, 0

#endif
