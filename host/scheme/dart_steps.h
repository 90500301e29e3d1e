// SPDX-License-Identifier: BSD-3-Clause
// One refinement of the surroundings of a vertex with one sharp edge, as a matrix. Internal to host/scheme.
#pragma once

#include <Eigen/Core>

namespace lcl {

/// On [V, E_0 .. E_(n-1), F_0 .. F_(n-1)], E_0 the sharp edge, F_j between E_j and E_(j+1): smooth vertex rule, midpoint on the sharp edge.
Eigen::MatrixXd catmull_clark_dart_step(int n);
/// The same on [V, E_0 .. E_(n-1)].
Eigen::MatrixXd loop_dart_step(int n);

}  // namespace lcl
