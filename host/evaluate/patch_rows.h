// SPDX-License-Identifier: BSD-3-Clause
// The limit surface at a place as a linear function of the patch's control points: the weights of S and of its derivatives.
#pragma once

#include <vector>

#include "host/evaluate/kind_table.h"
#include "host/evaluate/patch_table.h"

namespace lcl {

class PatchRows {
public:
    /// Keeps a reference. Finds the eigenstructures of the table's kinds.
    explicit PatchRows(const PatchTable& table);

    /// K, the control points of a patch: control[patch_begin[patch] + i] of the table, i = 0 .. K - 1.
    int point_count(Index patch) const { return table_.patch_begin[patch + 1] - table_.patch_begin[patch]; }
    /// Weights of the patch's control points for the first `count` of S, S_u, S_v, S_uu, S_uv, S_vv, count 1, 3 or 6. rows: count x K, one after the other;
    /// those of S sum to 1, the others to 0. At an irregular patch's (0, 0), where derivatives do not exist, their rows are NaN. K^2 operations, 200 in regular
    /// patches.
    void write(const PatchPlace& place, int count, double* rows) const;

private:
    void write_irregular(const KindTable& kind, const PatchPlace& place, int count, double* rows) const;

    const PatchTable& table_;
    std::vector<KindTable> kinds_;
};

/// The first `count` of S, S_s, S_t, S_ss, S_st, S_tt on a regular patch: count x regular_point_count weights. In closed form; regular_weights() takes the slow
/// way, to be compared with.
void write_regular_rows(Scheme scheme, double s, double t, int count, double* rows);

}  // namespace lcl
