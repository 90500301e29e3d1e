// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "host/operator/rows_plan.h"

namespace lcl {

constexpr double symmetry_tolerance = 1e-12;  ///< of the largest element of diag(D) A

/// The plan of a caller's rows. Identity rows are fixed; the others are smooth where a scaling is given, else they stand where darts do. With a scaling, D A is
/// symmetric but for rows and columns of identity rows, which go to the right-hand side. plan.lambda_min_bound: Gershgorin's, NaN where that is below 0.
/// BadInput with the row where an array is wrong or D A is not symmetric.
Plan build_user_plan(const RowMatrix& rows, Index block_rows);

}  // namespace lcl
