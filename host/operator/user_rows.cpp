// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/user_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "host/operator/plan_parts.h"

namespace lcl {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double largest_weight = std::numeric_limits<float>::max(), least_diagonal = std::numeric_limits<float>::min();  // kernels work in floats, too
constexpr double least_scaling = 1e-30;                                                                                   // of the largest one

/// A number as short as it can be told.
std::string text(double value) {
    char out[32];
    std::snprintf(out, sizeof out, "%g", value);
    return out;
}

[[noreturn]] void refuse(Index row, const std::string& what) { throw BadInput("row " + std::to_string(row) + " " + what, {{row}, {}}); }

void check_offsets(const RowMatrix& rows) {
    if (rows.offsets[0] != 0) throw BadInput("offsets begin with " + std::to_string(rows.offsets[0]) + ": they begin with 0", {{0}, {}});
    for (Index row = 0; row < rows.count; ++row)
        if (rows.offsets[row + 1] < rows.offsets[row])
            refuse(row,
                   "begins at entry " + std::to_string(rows.offsets[row]) + " and ends at " + std::to_string(rows.offsets[row + 1]) + ": offsets do not fall");
}

/// last_reader: for each column the last row that was seen to have it.
void check_row(const RowMatrix& rows, Index row, std::vector<Index>& last_reader) {
    bool has_diagonal = false;
    for (std::int64_t e = rows.offsets[row]; e < rows.offsets[row + 1]; ++e) {
        const Index column = rows.columns[e];
        const double weight = rows.weights[e];
        if (column < 0 || column >= rows.count) refuse(row, "has column " + std::to_string(column) + ", there are " + std::to_string(rows.count) + " rows");
        if (last_reader[column] == row) refuse(row, "has column " + std::to_string(column) + " twice: add up its weights");
        last_reader[column] = row;
        if (!(std::fabs(weight) <= largest_weight))
            refuse(row, "has the weight " + text(weight) + " at column " + std::to_string(column) + ": weights are finite and fit into a float");
        if (column != row) continue;
        has_diagonal = true;
        if (std::fabs(weight) < least_diagonal) refuse(row, "has the diagonal element " + text(weight) + ": it is not 0");
    }
    if (!has_diagonal) refuse(row, "has no diagonal element: every row holds its own column");
    if (rows.scaling == nullptr) return;
    const double scaling = rows.scaling[row];
    if (!(scaling > 0) || !std::isfinite(scaling)) refuse(row, "has the scaling " + text(scaling) + ": scalings are finite and above 0");
}

void check_arrays(const RowMatrix& rows) {
    check_offsets(rows);
    std::vector<Index> last_reader(rows.count, -1);
    for (Index row = 0; row < rows.count; ++row) check_row(rows, row, last_reader);
}

/// Sums of `count` weights that were rounded once or twice each.
bool sums_to_one(const RowMatrix& rows, Index row) {
    double sum = 0, size = 0;
    for (std::int64_t e = rows.offsets[row]; e < rows.offsets[row + 1]; ++e) sum += rows.weights[e], size += std::fabs(rows.weights[e]);
    return std::fabs(sum - 1) <= epsilon * static_cast<double>(rows.offsets[row + 1] - rows.offsets[row] + 2) * size;
}

Array<std::uint8_t> groups_of(const RowMatrix& rows) {
    const RowKind kind = rows.scaling != nullptr ? RowKind::smooth : RowKind::dart;
    Array<std::uint8_t> groups(rows.count);
    for (Index row = 0; row < rows.count; ++row) groups[row] = row_group(rows.is_identity(row) ? RowKind::fixed : kind, false);
    return groups;
}

/// Tests that D A is symmetric between rows that are not identity rows, and notes entries without a mirror image (which are nearly 0).
class SymmetryTest {
public:
    SymmetryTest(const RowMatrix& rows, const RowReaders& readers, const Array<std::uint8_t>& groups)
        : rows_(rows), readers_(readers), groups_(groups), elements_(rows.count, 0.0), seen_in_(rows.count, -1) {}

    /// Rows and columns that are missing.
    std::vector<std::pair<Index, Index>> run() {
        for (Index row = 0; row < rows_.count; ++row)
            for (std::int64_t e = rows_.offsets[row]; e < rows_.offsets[row + 1]; ++e)
                if (counts(row) && counts(rows_.columns[e])) largest_ = std::max(largest_, std::fabs(element(row, rows_.weights[e])));
        for (Index row = 0; row < rows_.count; ++row)
            if (counts(row)) compare(row);
        return std::move(missing_);
    }

private:
    bool counts(Index row) const { return groups_[row] == row_group(RowKind::smooth, false); }
    double element(Index row, double weight) const { return rows_.scaling[row] * weight; }

    /// Row by row against column by column.
    void compare(Index row) {
        for (std::int64_t e = rows_.offsets[row]; e < rows_.offsets[row + 1]; ++e) {
            seen_in_[rows_.columns[e]] = row;
            elements_[rows_.columns[e]] = element(row, rows_.weights[e]);
        }
        for (std::int64_t e = readers_.offsets[row]; e < readers_.offsets[row + 1]; ++e) {
            const Index other = readers_.rows[e];
            if (!counts(other)) continue;
            const bool is_there = seen_in_[other] == row;
            const double own = is_there ? elements_[other] : 0, mirrored = element(other, readers_.weights[e]);
            if (!(std::fabs(own - mirrored) <= symmetry_tolerance * largest_)) refuse_pair(row, other, own, mirrored);
            if (!is_there) missing_.emplace_back(row, other);
        }
    }

    [[noreturn]] void refuse_pair(Index row, Index other, double own, double mirrored) const {
        throw BadInput("rows " + std::to_string(row) + " and " + std::to_string(other) + " are not symmetric under the scaling D: D A is " + text(own) +
                           " in row " + std::to_string(row) + ", column " + std::to_string(other) + ", and " + text(mirrored) +
                           " the other way round: correct the scaling, or leave it out",
                       {{row, other}, {}});
    }

    const RowMatrix& rows_;
    const RowReaders& readers_;
    const Array<std::uint8_t>& groups_;
    double largest_ = 0;
    std::vector<double> elements_;  // of one row of D A, by column
    std::vector<Index> seen_in_;    // the row that elements_ were last written for
    std::vector<std::pair<Index, Index>> missing_;
};

/// The rows with entries of weight 0 where mirror images are missing: who reads a row is then known from the row itself.
struct MirroredRows {
    MirroredRows(const RowMatrix& rows, std::vector<std::pair<Index, Index>> missing) : matrix(rows) {
        auto next = missing.cbegin();  // ascending by rows, as they were found
        for (Index row = 0; row < rows.count; ++row) {
            columns.insert(columns.end(), rows.columns + rows.offsets[row], rows.columns + rows.offsets[row + 1]);
            for (; next != missing.cend() && next->first == row; ++next) columns.push_back(next->second);
            weights.insert(weights.end(), rows.weights + rows.offsets[row], rows.weights + rows.offsets[row + 1]);
            weights.resize(columns.size(), 0.0);
            offsets.push_back(static_cast<std::int64_t>(columns.size()));
        }
        matrix.offsets = offsets.data(), matrix.columns = columns.data(), matrix.weights = weights.data();
    }

    std::vector<std::int64_t> offsets{0};
    std::vector<Index> columns;
    std::vector<double> weights;
    RowMatrix matrix;
};

/// D is known up to a factor: a power of two brings its largest element to about 1, for floats.
void normalise_scaling(Plan& plan) {
    if (!plan.has_scaling) return;
    const auto [least, largest] = std::minmax_element(plan.scaling.begin(), plan.scaling.end());
    if (*least < least_scaling * *largest)
        refuse(plan.vertex_of_row[least - plan.scaling.begin()], "has the scaling " + text(*least) + ", and row " +
                                                                     std::to_string(plan.vertex_of_row[largest - plan.scaling.begin()]) + " has " +
                                                                     text(*largest) + ": floats do not hold both");
    const int exponent = std::ilogb(*largest);
    for (double& scaling : plan.scaling) scaling = std::scalbn(scaling, -exponent);
}

}  // namespace

Plan build_user_plan(const RowMatrix& rows, Index block_rows) {
    check_arrays(rows);
    const Array<std::uint8_t> groups = groups_of(rows);
    const RowReaders readers = readers_of(rows);
    std::vector<std::pair<Index, Index>> missing;
    if (rows.scaling != nullptr) missing = SymmetryTest(rows, readers, groups).run();
    Array<Index> order = breadth_first_order(rows, readers);
    Plan plan = missing.empty() ? build_rows_plan(rows, groups, std::move(order), block_rows)
                                : build_rows_plan(MirroredRows(rows, missing).matrix, groups, std::move(order), block_rows);
    normalise_scaling(plan);
    for (Index row = 0; row < rows.count && plan.rows_sum_to_one; ++row) plan.rows_sum_to_one = sums_to_one(rows, row);
    const double low = gershgorin_interval(plan).low;
    plan.lambda_min_bound = low >= -symmetry_tolerance ? std::max(0.0, low) : std::numeric_limits<double>::quiet_NaN();
    return plan;
}

}  // namespace lcl
