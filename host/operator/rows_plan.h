// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "host/operator/plan.h"
#include "host/operator/row_matrix.h"

namespace lcl {

/// The plan of rows with their own weights. groups: row_group (plan_parts.h) of each row; fixed ones become identity rows whatever they hold. order: all rows,
/// neighbours close to each other. Rows are taken to sum to 1, and nothing is said of the spectrum. OutOfMemory above 2^32 - 1 entries.
Plan build_rows_plan(const RowMatrix& rows, const Array<std::uint8_t>& groups, Array<Index> order, Index block_rows);

/// The union of the discs of Gershgorin, cut with the real axis: all real parts of the eigenvalues of A lie in it, but for those of fixed rows, which are 1.
/// Columns of fixed rows are left out: A is block triangular. [1, 1] where all rows are fixed.
struct Interval {
    double low = 1, high = 1;
};
Interval gershgorin_interval(const Plan& plan);

}  // namespace lcl
