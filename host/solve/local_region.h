// SPDX-License-Identifier: BSD-3-Clause
// The rows of A round a few edited ones, numbered for themselves, as far as they have been looked at.
#pragma once

#include <cstdint>
#include <vector>

#include "host/operator/plan.h"

namespace lcl {

/// A row is reached when its entries are known here, and with them its residual; it is open, and its point may change, when all rows that read it are reached,
/// so that no residual changes unseen. Keeps a number a vertex of the plan (4 bytes) from the first start on, clean between uses, so that no use costs more
/// than its own rows.
class LocalRegion {
public:
    explicit LocalRegion(const Plan& plan) : plan_(plan) {}

    struct Entry {
        double weight;
        Index other;  ///< local number of the column, or of the row that reads
    };
    struct Entries {
        const Entry *first, *last;
        const Entry* begin() const { return first; }
        const Entry* end() const { return last; }
    };

    /// Forgets what there is and reaches these rows, which differ from each other.
    void start(const std::vector<Index>& rows);
    /// Opens a reached row.
    void open(Index local);
    /// Opens a reached row and the smooth rows that read it.
    void open_round(Index local);
    /// Opens all rows that are reached now.
    void open_all();

    /// Plan rows by local number: reached ones and, between them, those that are only read.
    const std::vector<Index>& rows() const { return rows_; }
    /// Local numbers of the reached rows, in the order in which they were.
    const std::vector<Index>& reached() const { return reached_; }
    bool is_open(Index local) const { return places_[local].is_open; }
    /// The factor d_i of a reached row that makes d_i a_ij symmetric on the smooth block; 1 on other rows.
    double scaling(Index local) const { return places_[local].scaling; }
    double diagonal(Index local) const { return places_[local].diagonal; }

    /// a_ij of reached row i.
    Entries row(Index local) const { return slice(entries_, places_[local].first, places_[local].count); }
    /// Those of them whose mirror images d_j a_ji = d_i a_ij are in the rows j: who reads i, without a list of its own.
    Entries mirrored(Index local) const { return slice(entries_, places_[local].first, places_[local].mirrored_count); }
    /// d_j a_ji of the other rows j that read open row i.
    Entries irregular_readers(Index local) const { return slice(irregular_, places_[local].irregular_first, places_[local].irregular_count); }

private:
    struct Place {
        double scaling = 1, diagonal = 1;
        std::uint32_t first = 0, irregular_first = 0;
        Index count = 0, mirrored_count = 0, irregular_count = 0;
        bool is_reached = false, is_open = false;
    };
    static Entries slice(const std::vector<Entry>& entries, std::uint32_t first, Index count) {
        return {entries.data() + first, entries.data() + first + count};
    }

    bool is_smooth(Index row) const { return row >= plan_.smooth.first_row && row < plan_.smooth.end_row(); }
    void prepare();
    void find_irregular_readers();
    template <class Body>
    void for_each_irregular_entry(const Body& body) const;
    const Run& run_of(Index row) const;
    Index local_of(Index row);
    void reach(Index row);
    double weight_of(Index reader, Index column) const;

    const Plan& plan_;
    std::vector<Index> local_of_row_;  // -1 outside the region
    std::vector<Index> chunk_runs_;    // the run of the first row of each chunk of rows
    // Rows that read a column which does not read them with the mirrored weight, by column.
    std::vector<std::uint32_t> reader_offsets_;
    std::vector<Index> readers_;

    std::vector<Index> rows_, reached_;
    std::vector<Place> places_;
    std::vector<Entry> entries_, irregular_;
};

}  // namespace lcl
