// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "host/operator/plan.h"

namespace lcl {

/// Solves the rows of boundary and crease curves directly, in double: each is lambda P + (1 - lambda)(L + 4 P + R)/6 = M (Doo-Sabin (L + 6 P + R)/8) with
/// neighbours on the curve or fixed, so they do not depend on the rest (tridiagonal, cyclic where the curve is closed). m: vertex_count x channels in the
/// plan's order; p: the same, fixed rows read, curve rows written.
void solve_curves(const Plan& plan, const std::vector<double>& m, std::vector<double>& p, int channels);

}  // namespace lcl
