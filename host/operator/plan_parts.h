// SPDX-License-Identifier: BSD-3-Clause
// What plans of meshes and plans of other rows have in common: parts, blocks, reach.
#pragma once

#include "host/operator/plan.h"

namespace lcl {

/// Place of a row's kind in the order of a plan: isolated vertices, then RowKind's order.
inline std::uint8_t row_group(RowKind kind, bool is_isolated) {
    return kind == RowKind::fixed && is_isolated ? 0 : static_cast<std::uint8_t>(static_cast<std::uint8_t>(kind) + 1);
}

/// Sorts `order`, all vertices, by their groups, stably, into plan.vertex_of_row, and sets parts and blocks (without their runs). groups: row_group of each
/// vertex. plan.vertex_count is known.
void order_rows(Plan& plan, Array<Index> order, const Array<std::uint8_t>& groups, Index block_rows);

/// Sets plan.reach, how far the rows of each block reach in blocks, from all else.
void measure_reach(Plan& plan, Index block_rows);

}  // namespace lcl
