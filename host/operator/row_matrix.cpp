// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/row_matrix.h"

namespace lcl {
namespace {

class Search {
public:
    Search(const RowMatrix& rows, const RowReaders& readers) : rows_(rows), readers_(readers), is_met_(rows.count, 0) { order_.reserve(rows.count); }

    Array<Index> run() {
        for (Index row = 0; row < rows_.count; ++row) {
            if (is_met_[row]) continue;
            const std::size_t first = order_.size();
            spread_from(row);
            const Index end = order_.back();  // as far away as any
            for (std::size_t i = first; i < order_.size(); ++i) is_met_[order_[i]] = 0;
            order_.resize(first);
            spread_from(end);
        }
        return std::move(order_);
    }

private:
    void meet(Index row) {
        if (is_met_[row]) return;
        is_met_[row] = 1;
        order_.push_back(row);
    }

    void spread_from(Index start) {
        std::size_t next = order_.size();
        for (meet(start); next < order_.size(); ++next) {
            const Index row = order_[next];
            for (std::int64_t e = rows_.offsets[row]; e < rows_.offsets[row + 1]; ++e) meet(rows_.columns[e]);
            for (std::int64_t e = readers_.offsets[row]; e < readers_.offsets[row + 1]; ++e) meet(readers_.rows[e]);
        }
    }

    const RowMatrix& rows_;
    const RowReaders& readers_;
    std::vector<std::uint8_t> is_met_;
    Array<Index> order_;
};

}  // namespace

/// A counting sort by columns.
RowReaders readers_of(const RowMatrix& rows) {
    RowReaders readers;
    readers.offsets.assign(static_cast<std::size_t>(rows.count) + 2, 0);
    for (std::int64_t e = 0; e < rows.entry_count(); ++e) ++readers.offsets[rows.columns[e] + 2];
    for (Index column = 0; column < rows.count; ++column) readers.offsets[column + 2] += readers.offsets[column + 1];
    readers.rows.resize(rows.entry_count());
    readers.weights.resize(rows.entry_count());
    for (Index row = 0; row < rows.count; ++row)
        for (std::int64_t e = rows.offsets[row]; e < rows.offsets[row + 1]; ++e) {
            const std::int64_t place = readers.offsets[rows.columns[e] + 1]++;
            readers.rows[place] = row;
            readers.weights[place] = rows.weights[e];
        }
    readers.offsets.pop_back();
    return readers;
}

Array<Index> breadth_first_order(const RowMatrix& rows, const RowReaders& readers) { return Search(rows, readers).run(); }

}  // namespace lcl
