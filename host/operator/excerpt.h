// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "host/operator/plan.h"

namespace lcl {

/// Consecutive blocks of the smooth part as a plan of their own, in which all other columns are one ghost: where that is zero, its operator is a principal
/// submatrix of A, whose smallest eigenvalue is never below that of the smooth part.
Plan excerpt(const Plan& plan, Index first_block, Index block_count);

/// At least `rows` smooth rows in consecutive blocks round the place where small diagonal elements crowd, which is where small eigenvalues come from; all
/// blocks where there are no more rows. Two passes on the host.
Part weakest_blocks(const Plan& plan, Index rows);

}  // namespace lcl
