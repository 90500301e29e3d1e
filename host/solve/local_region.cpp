// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/local_region.h"

#include <utility>

namespace lcl {
namespace {

constexpr Index chunk_rows = 256;

}  // namespace

/// Once an operator.
void LocalRegion::prepare() {
    chunk_runs_.clear();
    for (Index r = 0, row = 0; r < static_cast<Index>(plan_.runs.size()); ++r)
        for (; row < plan_.runs[r].first + plan_.runs[r].count; row += chunk_rows) chunk_runs_.push_back(r);
    find_irregular_readers();
    local_of_row_.assign(plan_.vertex_count, -1);
}

/// body(row, column) for every entry that is no mirror image of one in the row of its column.
template <class Body>
void LocalRegion::for_each_irregular_entry(const Body& body) const {
    for (const Run& run : plan_.runs)
        for (Index row = run.first; row < run.first + run.count; ++row)
            for_each_entry(plan_, run, row, [&](Index column, double) {
                if (column != row && !(is_smooth(row) && is_smooth(column))) body(row, column);
            });
}

/// A counting sort by columns.
void LocalRegion::find_irregular_readers() {
    const bool all_is_smooth = plan_.smooth.first_row == plan_.isolated_count;
    const Index columns = plan_.has_darts() ? plan_.vertex_count : all_is_smooth ? 0 : plan_.smooth.first_row;  // darts read smooth columns
    reader_offsets_.assign(static_cast<std::size_t>(columns) + 2, 0);
    if (columns == 0) return;
    for_each_irregular_entry([&](Index, Index column) { ++reader_offsets_[column + 2]; });
    for (Index column = 0; column < columns; ++column) reader_offsets_[column + 2] += reader_offsets_[column + 1];
    readers_.resize(reader_offsets_.back());
    for_each_irregular_entry([&](Index row, Index column) { readers_[reader_offsets_[column + 1]++] = row; });
}

const Run& LocalRegion::run_of(Index row) const {
    Index r = chunk_runs_[row / chunk_rows];
    while (row >= plan_.runs[r].first + plan_.runs[r].count) ++r;
    return plan_.runs[r];
}

void LocalRegion::start(const std::vector<Index>& rows) {
    if (local_of_row_.empty()) prepare();
    for (const Index row : rows_) local_of_row_[row] = -1;
    rows_.clear(), reached_.clear(), places_.clear(), entries_.clear(), irregular_.clear();
    for (const Index row : rows) reach(row);
}

Index LocalRegion::local_of(Index row) {
    Index& local = local_of_row_[row];
    if (local < 0) {
        local = static_cast<Index>(rows_.size());
        rows_.push_back(row);
        places_.emplace_back();
    }
    return local;
}

void LocalRegion::reach(Index row) {
    const Index local = local_of(row);
    if (places_[local].is_reached) return;
    reached_.push_back(local);
    const std::size_t first = entries_.size();
    std::size_t mirrored = first;
    for_each_entry(plan_, run_of(row), row, [&](Index column, double weight) {
        entries_.push_back({weight, local_of(column)});
        if (column == row || (is_smooth(row) && is_smooth(column))) std::swap(entries_.back(), entries_[mirrored++]);
    });
    Place& place = places_[local];
    place.is_reached = true;
    place.scaling = is_smooth(row) ? plan_.scaling[row] : 1;
    place.diagonal = plan_.diagonal[row];
    place.first = static_cast<std::uint32_t>(first);
    place.count = static_cast<Index>(entries_.size() - first);
    place.mirrored_count = static_cast<Index>(mirrored - first);
}

/// All of it, where a column is met several times.
double LocalRegion::weight_of(Index reader, Index column) const {
    double weight = 0;
    for (const Entry& entry : row(reader))
        if (entry.other == column) weight += entry.weight;
    return weight;
}

void LocalRegion::open(Index local) {
    if (places_[local].is_open) return;
    places_[local].is_open = true;
    for (Index e = 0; e < places_[local].mirrored_count; ++e) reach(rows_[entries_[places_[local].first + e].other]);
    const std::size_t column = rows_[local], first = irregular_.size();
    if (column + 2 >= reader_offsets_.size()) return;
    for (std::uint32_t e = reader_offsets_[column]; e < reader_offsets_[column + 1]; ++e) {
        if (e > reader_offsets_[column] && readers_[e] == readers_[e - 1]) continue;  // meets the column twice
        reach(readers_[e]);
        const Index reader = local_of(readers_[e]);
        irregular_.push_back({scaling(reader) * weight_of(reader, local), reader});
    }
    places_[local].irregular_first = static_cast<std::uint32_t>(first);
    places_[local].irregular_count = static_cast<Index>(irregular_.size() - first);
}

void LocalRegion::open_round(Index local) {
    open(local);
    for (Index e = 0; e < places_[local].mirrored_count; ++e) open(entries_[places_[local].first + e].other);
}

void LocalRegion::open_all() {
    const std::size_t end = reached_.size();
    for (std::size_t i = 0; i < end; ++i) open(reached_[i]);
}

}  // namespace lcl
