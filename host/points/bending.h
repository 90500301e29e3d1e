// SPDX-License-Identifier: BSD-3-Clause
// Bending energy of patches as quadratic forms of their control points (after Halstead, Kass & DeRose 1993).
#pragma once

#include <Eigen/Dense>

#include "host/evaluate/patch_kind.h"

namespace lcl {

/// The mean over a regular patch of |S_xx|^2 + 2 |S_xy|^2 + |S_yy|^2 is C^T E C, C the control points. x, y: the patch's own (s, t); Loop: those of the
/// equilateral triangle with sides of length 1, so that no corner of a face is another than the others.
Eigen::MatrixXd regular_bending(Scheme scheme);

/// The same of an irregular patch, K x K. By the natural (s, t) it has no such energy in general: derivatives grow without bound towards the extraordinary
/// point, and the integral of their squares diverges for valences above 4 (Loop: 6). So x, y are the characteristic map, by which the surface has a tangent
/// plane and planes have no energy, turned to the size of a regular patch: on a regular patch it is the rule above. Its integral is a geometric series, summed
/// up in closed form. Kinds without modes, at sharp features, have no such map: the mean over their outer ring, by (s, t), stands for all of it there.
Eigen::MatrixXd irregular_bending(Scheme scheme, const PatchKind& kind);

}  // namespace lcl
