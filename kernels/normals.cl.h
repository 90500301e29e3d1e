// SPDX-License-Identifier: BSD-3-Clause
// What kernels/normals.cl and the host share.
#ifndef LCL_NORMALS_CL_H
#define LCL_NORMALS_CL_H

/// Sine of the angle, squared, below which two tangents count as parallel.
#define LCL_PARALLEL 1e-8f

#endif
