// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/excerpt.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "host/parallel.h"

namespace lcl {
namespace {

class Excerpt {
public:
    Excerpt(const Plan& plan, Index first_block, Index block_count) : plan_(plan), first_block_(first_block), block_count_(block_count) {
        first_row_ = plan.blocks[first_block].first_row;
        const Block& last = plan.blocks[first_block + block_count - 1];
        out_.row_count = last.first_row + last.row_count - first_row_;
        out_.vertex_count = out_.row_count + 1;
        out_.smooth = {0, out_.row_count, 0, block_count};
    }

    Plan make() {
        for (Index b = first_block_; b < first_block_ + block_count_; ++b) {
            const Block& block = plan_.blocks[b];
            out_.blocks.push_back({static_cast<Index>(out_.runs.size()), block.run_count, block.first_row - first_row_, block.row_count});
            for (Index r = block.first_run; r < block.first_run + block.run_count; ++r) add_run(plan_.runs[r]);
        }
        const auto rows = [&](const std::vector<double>& values) {
            return std::vector<double>(values.begin() + first_row_, values.begin() + first_row_ + out_.row_count);
        };
        out_.scaling = rows(plan_.scaling);
        out_.diagonal = rows(plan_.diagonal);
        out_.lambda_min_bound = plan_.lambda_min_bound;
        out_.reach = plan_.reach;
        return std::move(out_);
    }

private:
    Index column(Index row) const {
        const Index moved = row - first_row_;
        return moved >= 0 && moved < out_.row_count ? moved : out_.row_count;
    }

    void add_run(Run run) {
        const std::uint32_t offset = run.index_offset;
        run.first -= first_row_;
        if (run.shape == RowShape::weighted) {
            run.index_offset = static_cast<std::uint32_t>(out_.weighted_offsets.size()) - 1;
            for (Index i = 0; i < run.count; ++i) add_weighted_row(offset + i);
        } else {
            run.index_offset = static_cast<std::uint32_t>(out_.indices.size());
            const std::size_t count = static_cast<std::size_t>(run.count) * run.stride();
            for (std::size_t i = 0; i < count; ++i) out_.indices.push_back(column(plan_.indices[offset + i]));
            if (count % 2 != 0) out_.indices.push_back(0);  // runs begin at even places
        }
        out_.runs.push_back(run);
    }

    void add_weighted_row(std::uint32_t number) {
        for (std::uint32_t e = plan_.weighted_offsets[number]; e < plan_.weighted_offsets[number + 1]; ++e) {
            out_.weighted_indices.push_back(column(plan_.weighted_indices[e]));
            out_.weighted_weights.push_back(plan_.weighted_weights[e]);
        }
        out_.weighted_offsets.push_back(static_cast<std::uint32_t>(out_.weighted_indices.size()));
    }

    const Plan& plan_;
    const Index first_block_, block_count_;
    Index first_row_ = 0;
    Plan out_;
};

/// The mean of the row's neighbours' and its own value, for every smooth row; other rows count as 1.
std::vector<float> smoothed(const Plan& plan, const std::vector<float>& values) {
    std::vector<float> out(plan.vertex_count, 1.0f);
    const auto sum = [&](const Index* columns, std::size_t count) {
        float total = 0;
        for (std::size_t i = 0; i < count; ++i) total += values[columns[i]];
        return total;
    };
    const auto smooth_run = [&](const Run& run) {
        for (Index i = 0; i < run.count; ++i) {
            const Index row = run.first + i;
            if (run.shape == RowShape::weighted) {
                const std::uint32_t begin = plan.weighted_offsets[run.index_offset + i], count = plan.weighted_offsets[run.index_offset + i + 1] - begin;
                out[row] = sum(plan.weighted_indices.data() + begin, count) / static_cast<float>(count);  // the row's own vertex is among them
            } else {
                const auto stride = static_cast<std::size_t>(run.stride());
                out[row] = (values[row] + sum(plan.indices.data() + run.index_offset + i * stride, stride)) / static_cast<float>(1 + stride);
            }
        }
    };
    parallel_for(
        plan.smooth.block_count,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) {
                const Block& block = plan.blocks[plan.smooth.first_block + b];
                for (Index r = block.first_run; r < block.first_run + block.run_count; ++r) smooth_run(plan.runs[r]);
            }
        },
        4);
    return out;
}

/// The smooth block with the smallest value; where several have it, the one in which the values are smallest on the whole.
Index weakest_block(const Plan& plan, const std::vector<float>& values) {
    constexpr float same = 1e-5f;  // rounding of the means
    Index weakest = plan.smooth.first_block;
    float lowest = 2;
    double lowest_mean = 2;
    for (Index b = plan.smooth.first_block; b < plan.smooth.end_block(); ++b) {
        const auto first = values.begin() + plan.blocks[b].first_row, last = first + plan.blocks[b].row_count;
        const float low = *std::min_element(first, last);
        const double mean = std::accumulate(first, last, 0.0) / plan.blocks[b].row_count;
        if (low > lowest + same || (low > lowest - same && mean >= lowest_mean)) continue;
        weakest = b;
        lowest = low;
        lowest_mean = mean;
    }
    return weakest;
}

}  // namespace

Plan excerpt(const Plan& plan, Index first_block, Index block_count) { return Excerpt(plan, first_block, block_count).make(); }

Part weakest_blocks(const Plan& plan, Index rows) {
    const Part& smooth = plan.smooth;
    if (smooth.row_count <= rows) return smooth;
    std::vector<float> crowd(plan.vertex_count, 1.0f);
    std::copy(plan.diagonal.begin() + smooth.first_row, plan.diagonal.begin() + smooth.end_row(), crowd.begin() + smooth.first_row);
    for (int pass = 0; pass < 2; ++pass) crowd = smoothed(plan, crowd);
    const Index centre = weakest_block(plan, crowd);
    const Index count = std::min(smooth.block_count, rows / std::max(1, plan.blocks[smooth.first_block].row_count) + 1);
    const Index first = std::clamp(centre - count / 2, smooth.first_block, smooth.end_block() - count);
    const Block& last = plan.blocks[first + count - 1];
    return {plan.blocks[first].first_row, last.first_row + last.row_count - plan.blocks[first].first_row, first, count};
}

}  // namespace lcl
