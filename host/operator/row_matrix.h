// SPDX-License-Identifier: BSD-3-Clause
// Rows of A that come from elsewhere than the masks of a scheme: in the caller's numbering, with all their weights.
#pragma once

#include <cstdint>
#include <vector>

#include "host/array.h"
#include "host/error.h"

namespace lcl {

/// Row i holds weights[offsets[i]] .. weights[offsets[i + 1] - 1] at columns[..], each column at most once. The arrays are someone else's.
struct RowMatrix {
    Index count = 0;
    const std::int64_t* offsets = nullptr;  ///< count + 1, from 0 on
    const Index* columns = nullptr;
    const double* weights = nullptr;
    const double* scaling = nullptr;  ///< count: D_ii, all of them at least 0; null: none

    std::int64_t entry_count() const { return offsets[count]; }
    /// One entry, the vertex itself with weight 1.
    bool is_identity(Index row) const { return offsets[row + 1] - offsets[row] == 1 && columns[offsets[row]] == row && weights[offsets[row]] == 1; }
};

/// The transpose, as the rows that have each column.
struct RowReaders {
    std::vector<std::int64_t> offsets;  ///< count + 1
    std::vector<Index> rows;            ///< ascending
    std::vector<double> weights;
};
RowReaders readers_of(const RowMatrix& rows);

/// A breadth-first order of the graph of A and its transpose, component by component, each from an end of it: neighbours come close to each other.
Array<Index> breadth_first_order(const RowMatrix& rows, const RowReaders& readers);

}  // namespace lcl
