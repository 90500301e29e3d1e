// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/plan_parts.h"

#include <algorithm>
#include <array>

#include "host/counting_sort.h"

namespace lcl {
namespace {

constexpr std::size_t group_count = 6;

void cut_into_blocks(Plan& plan, Part& part, Index block_rows) {
    part.first_block = static_cast<Index>(plan.blocks.size());
    for (Index row = part.first_row; row < part.end_row(); row += block_rows) plan.blocks.push_back({0, 0, row, std::min(block_rows, part.end_row() - row)});
    part.block_count = static_cast<Index>(plan.blocks.size()) - part.first_block;
}

void set_parts(Plan& plan, const std::array<Index, group_count + 1>& starts, Index block_rows) {
    plan.isolated_count = starts[1];
    plan.fixed = {0, starts[2], 0, 0};
    plan.curves = {starts[2], starts[3] - starts[2], 0, 0};
    plan.darts = {starts[3], starts[4] - starts[3], 0, 0};
    plan.smooth = {starts[4], starts[5] - starts[4], 0, 0};
    plan.row_count = starts[5];
    for (Part* part : {&plan.fixed, &plan.curves, &plan.darts, &plan.smooth}) cut_into_blocks(plan, *part, block_rows);
}

/// Of one smooth block; rows of a part's blocks are equally many but for the last.
Index reach_of(const Plan& plan, const Block& block, Index block_rows) {
    Index lowest = block.first_row, highest = block.first_row;
    const auto take = [&](const Index* columns, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            if (columns[i] < plan.smooth.first_row || columns[i] >= plan.smooth.end_row()) continue;
            lowest = std::min(lowest, columns[i]);
            highest = std::max(highest, columns[i]);
        }
    };
    for (Index r = block.first_run; r < block.first_run + block.run_count; ++r) {
        const Run& run = plan.runs[r];
        if (run.shape != RowShape::weighted) {
            take(plan.indices.data() + run.index_offset, static_cast<std::size_t>(run.count) * run.stride());
            continue;
        }
        const std::uint32_t begin = plan.weighted_offsets[run.index_offset];
        take(plan.weighted_indices.data() + begin, plan.weighted_offsets[run.index_offset + run.count] - begin);
    }
    const auto block_of = [&](Index row) { return (row - plan.smooth.first_row) / block_rows; };
    return std::max(block_of(highest) - block_of(block.first_row), block_of(block.first_row) - block_of(lowest));
}

}  // namespace

/// A counting sort.
void order_rows(Plan& plan, Array<Index> order, const Array<std::uint8_t>& groups, Index block_rows) {
    const std::size_t n = order.size(), pieces = piece_count(n);
    Array<Index> places(pieces * group_count);
    std::array<Index, group_count + 1> starts;
    for_each_piece(n, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        std::array<Index, group_count> counts{};
        for (std::size_t v = begin; v < end; ++v) ++counts[groups[order[v]]];
        std::copy(counts.begin(), counts.end(), places.begin() + piece * group_count);
    });
    counts_to_places(places, group_count, pieces, starts.data());
    set_parts(plan, starts, block_rows);
    if (plan.smooth.row_count == plan.vertex_count) return plan.vertex_of_row.swap(order);
    plan.vertex_of_row.resize(n);
    for_each_piece(n, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index* const place = places.data() + piece * group_count;
        for (std::size_t i = begin; i < end; ++i) plan.vertex_of_row[place[groups[order[i]]]++] = order[i];
    });
}

void measure_reach(Plan& plan, Index block_rows) {
    const Part& smooth = plan.smooth;
    std::vector<Index> reaches(smooth.block_count, 0);
    parallel_for(
        smooth.block_count,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) reaches[b] = reach_of(plan, plan.blocks[smooth.first_block + b], block_rows);
        },
        4);
    for (const Index reach : reaches) plan.reach = std::max(plan.reach, reach);
}

}  // namespace lcl
