// SPDX-License-Identifier: BSD-3-Clause
// A on the host, in plain double: the reference that device results are held against, and the final residual of every solve.
#pragma once

#include <vector>

#include "host/operator/plan.h"

namespace lcl {

/// y = A x for n x channels values in the plan's order; rows without a row of A (ghosts) are copied. x and y differ. Uses all cores.
std::vector<double> host_apply(const Plan& plan, const std::vector<double>& x, int channels);

/// Row norms of a residual.
struct ResidualNorms {
    double position = 0;  ///< largest Euclidean norm over the first three channels
    double others = 0;    ///< largest absolute value over further channels
};

/// max over rows of m - A x. m, x: n x channels in the plan's order.
ResidualNorms host_residual(const Plan& plan, const std::vector<double>& m, const std::vector<double>& x, int channels);

}  // namespace lcl
