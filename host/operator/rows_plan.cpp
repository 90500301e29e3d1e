// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/rows_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "host/operator/plan_parts.h"
#include "host/parallel.h"

namespace lcl {
namespace {

class RowsPlanBuilder {
public:
    RowsPlanBuilder(const RowMatrix& rows, Index block_rows) : rows_(rows), block_rows_(block_rows) {}

    Plan build(const Array<std::uint8_t>& groups, Array<Index> order) {
        plan_.vertex_count = rows_.count;
        order_rows(plan_, std::move(order), groups, block_rows_);
        plan_.row_of_vertex.resize(rows_.count);
        for (Index row = 0; row < rows_.count; ++row) plan_.row_of_vertex[plan_.vertex_of_row[row]] = row;
        make_runs();
        place_entries();
        fill();
        measure_reach(plan_, block_rows_);
        return std::move(plan_);
    }

private:
    /// One run a block.
    void make_runs() {
        for (Block& block : plan_.blocks) {
            Run run;
            run.first = block.first_row;
            run.count = block.row_count;
            if (run.first >= plan_.fixed.end_row()) {
                run.shape = RowShape::weighted;
                run.index_offset = static_cast<std::uint32_t>(run.first - plan_.fixed.end_row());
            }
            block.first_run = static_cast<Index>(plan_.runs.size());
            block.run_count = 1;
            plan_.runs.push_back(run);
        }
    }

    void place_entries() {
        std::uint64_t entries = 0;
        for (Index row = plan_.fixed.end_row(); row < plan_.row_count; ++row) {
            const Index i = plan_.vertex_of_row[row];
            entries += static_cast<std::uint64_t>(rows_.offsets[i + 1] - rows_.offsets[i]);
            if (entries > std::numeric_limits<std::uint32_t>::max())
                throw OutOfMemory("the rows have " + std::to_string(rows_.entry_count()) + " entries, 4294967295 are the most: split the matrix into parts");
            plan_.weighted_offsets.push_back(static_cast<std::uint32_t>(entries));
        }
        plan_.weighted_indices.resize(entries);
        plan_.weighted_weights.resize(entries);
    }

    void fill() {
        plan_.diagonal.assign(plan_.row_count, 1.0);
        plan_.scaling.assign(plan_.row_count, 0.0);
        plan_.has_scaling = rows_.scaling != nullptr;
        parallel_for(plan_.row_count, [&](std::size_t begin, std::size_t end) {
            for (Index row = static_cast<Index>(begin); row < static_cast<Index>(end); ++row) {
                if (plan_.has_scaling) plan_.scaling[row] = rows_.scaling[plan_.vertex_of_row[row]];
                if (row >= plan_.fixed.end_row()) fill_row(row);
            }
        });
    }

    void fill_row(Index row) {
        const Index i = plan_.vertex_of_row[row];
        std::uint32_t place = plan_.weighted_offsets[row - plan_.fixed.end_row()];
        for (std::int64_t e = rows_.offsets[i]; e < rows_.offsets[i + 1]; ++e, ++place) {
            plan_.weighted_indices[place] = plan_.row_of_vertex[rows_.columns[e]];
            plan_.weighted_weights[place] = rows_.weights[e];
            if (rows_.columns[e] == i) plan_.diagonal[row] = rows_.weights[e];
        }
    }

    const RowMatrix& rows_;
    const Index block_rows_;
    Plan plan_;
};

}  // namespace

Plan build_rows_plan(const RowMatrix& rows, const Array<std::uint8_t>& groups, Array<Index> order, Index block_rows) {
    return RowsPlanBuilder(rows, block_rows).build(groups, std::move(order));
}

Interval gershgorin_interval(const Plan& plan) {
    Interval all;
    for (const Run& run : plan.runs)
        for (Index row = std::max(run.first, plan.fixed.end_row()); row < run.first + run.count; ++row) {
            double radius = 0;
            for_each_entry(plan, run, row, [&](Index column, double weight) {
                if (column != row && column >= plan.fixed.end_row()) radius += std::fabs(weight);
            });
            all.low = std::min(all.low, plan.diagonal[row] - radius);
            all.high = std::max(all.high, plan.diagonal[row] + radius);
        }
    return all;
}

}  // namespace lcl
