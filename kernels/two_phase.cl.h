// SPDX-License-Identifier: BSD-3-Clause
// What kernels/two_phase.cl and the host share: marks in the list of edge neighbours, beside a neighbour's place.
#ifndef LCL_TWO_PHASE_CL_H
#define LCL_TWO_PHASE_CL_H

#define LCL_COUNTS 0x80000000u     /* the point's row counts the neighbour */
#define LCL_IS_COUNTED 0x40000000u /* the neighbour's row counts the point */
#define LCL_PLACE 0x3fffffffu

#endif
