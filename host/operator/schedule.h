// SPDX-License-Identifier: BSD-3-Clause
// Orders in which Gauss-Seidel can run in parallel: steps of rows of which none is a neighbour of another.
#pragma once

#include <vector>

#include "host/operator/plan.h"

namespace lcl {

/// Rows of A (plan's numbering) step by step, with their entries in that order.
struct Schedule {
    std::vector<Index> step_offsets{0};  ///< steps + 1
    std::vector<Index> rows;             ///< schedule -> plan row
    std::vector<std::uint32_t> offsets{0};
    std::vector<Index> columns;  ///< plan's numbering, the vertex among them
    std::vector<double> weights;
    std::vector<double> inverse_diagonal;  ///< 1 / A_ii
};

/// Dependency levels of the caller's vertex order: row i comes after every neighbour before it, and before every neighbour after it, so a sweep over the levels
/// gives the iterates of the plain loop (Loop PIA paper, eq. 7). Linear time.
Schedule natural_schedule(const Plan& plan);

/// Greedy colours of the graph of A (face diagonals count), in the plan's order. Linear time.
Schedule coloured_schedule(const Plan& plan);

}  // namespace lcl
