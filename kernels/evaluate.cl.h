// SPDX-License-Identifier: BSD-3-Clause
// What kernels/evaluate.cl and the host share.
#ifndef LCL_EVALUATE_CL_H
#define LCL_EVALUATE_CL_H

/// What is computed at samples: LCL_WANT is a sum of these.
#define LCL_WANT_POINTS 1
#define LCL_WANT_FIRST 2
#define LCL_WANT_NORMALS 4
#define LCL_WANT_SECOND 8
#define LCL_WANT_CURVATURES 16

/// A kind of irregular patches: M modes; cells of depth m begin at cell_stride m (0 where they are the same at every depth), weights at weight_stride m. Coefficient j of the patch in column p
/// stands at first_coefficient + j stride + p.
typedef struct {
    int mode_count, depths, cell_stride, weight_stride;
    unsigned int first_coefficient, stride;
} lcl_kind;

#endif
