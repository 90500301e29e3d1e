// SPDX-License-Identifier: BSD-3-Clause
#include "host/field/channels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "host/parallel.h"

namespace lcl {
namespace {

ValueRanges no_range(int channels) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {true, std::vector<double>(channels, infinity), std::vector<double>(channels, -infinity)};
}

void join(ValueRanges& all, const ValueRanges& some) {
    all.are_finite = all.are_finite && some.are_finite;
    for (std::size_t c = 0; c < all.low.size(); ++c) {
        all.low[c] = std::min(all.low[c], some.low[c]);
        all.high[c] = std::max(all.high[c], some.high[c]);
    }
}

/// Ranges of up to `most` channels from `first` on, over the rows [begin, end) that count(v); the rest is only looked at.
template <int most, class T, class Counts>
void add_ranges(const T* values, std::size_t stride, int first, int channels, std::size_t begin, std::size_t end, const Counts& counts, ValueRanges& out) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double low[most], high[most], zero[most];  // x * 0 is 0 for finite x, else nan
    for (int c = 0; c < most; ++c) low[c] = infinity, high[c] = -infinity, zero[c] = 0;
    for (std::size_t v = begin; v < end; ++v) {
        const bool is_counted = counts(v);
        for (int c = 0; c < most && c < channels; ++c) {
            const double value = values[v * stride + first + c];
            zero[c] += value * 0;
            low[c] = is_counted && value < low[c] ? value : low[c];
            high[c] = is_counted && value > high[c] ? value : high[c];
        }
    }
    for (int c = 0; c < most && c < channels; ++c) {
        out.are_finite = out.are_finite && zero[c] == 0;
        out.low[first + c] = low[c];
        out.high[first + c] = high[c];
    }
}

/// Names the first value, in the plan's order, that is not finite, isolated vertices left out.
void refuse_not_finite(const Plan& plan, const double* values, std::size_t stride, int channels) {
    for (Index row = plan.isolated_count; row < plan.vertex_count; ++row) {
        const Index v = plan.vertex_of_row[row];
        for (int c = 0; c < channels; ++c)
            if (!std::isfinite(values[v * stride + c]))
                throw BadInput("channel " + std::to_string(c) + " of vertex " + std::to_string(v) + " is not finite: correct or leave out the value",
                               {{v}, {}});
    }
}

}  // namespace

std::vector<ChannelBlock> channel_blocks(int channels) {
    std::vector<ChannelBlock> blocks;
    for (int first = 0; first < channels;) {
        const int count = std::min(channels - first, 8);
        blocks.push_back({first, count, row_width(count)});
        first += count;
    }
    return blocks;
}

ValueRanges value_ranges(const Plan& plan, const HostRows& rows, int channels) {
    const std::size_t count = plan.vertex_count, pieces = piece_count(count);
    std::vector<ValueRanges> parts(pieces, no_range(channels));
    for_each_piece(count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        with_type(rows, [&](const auto* values) {
            const auto all = [](std::size_t) { return true; };
            const auto used = [&](std::size_t v) { return plan.row_of_vertex[v] >= plan.isolated_count; };
            for (int first = 0; first < channels; first += 4) {
                if (plan.isolated_count == 0 && channels == 3) add_ranges<3>(values, rows.stride, 0, 3, begin, end, all, parts[piece]);
                else add_ranges<4>(values, rows.stride, first, channels - first, begin, end, used, parts[piece]);
            }
        });
    });
    ValueRanges ranges = no_range(channels);
    for (const ValueRanges& part : parts) join(ranges, part);
    return ranges;
}

Transform fit_transform(const Plan& plan, const double* values, std::size_t stride, int channels) {
    const ValueRanges ranges = value_ranges(plan, {values, stride}, channels);
    if (!ranges.are_finite) refuse_not_finite(plan, values, stride, channels);
    return transform_of_ranges(plan, ranges);
}

Transform transform_of_ranges(const Plan& plan, const ValueRanges& ranges) {
    const auto& [finite, low, high] = ranges;
    const int channels = static_cast<int>(low.size());
    Transform transform{std::vector<double>(channels, 0.0), std::vector<double>(channels, 1.0)};
    if (plan.isolated_count == plan.vertex_count) return transform;
    double diagonal = 0, farthest = 0;
    const auto distance = [&, &low = low, &high = high](int c) { return std::max(std::fabs(low[c]), std::fabs(high[c])); };
    for (int c = 0; c < std::min(channels, 3); ++c) {
        diagonal = std::hypot(diagonal, high[c] - low[c]);
        farthest = std::max(farthest, distance(c));
    }
    for (int c = 0; c < channels; ++c) {
        double size = c < 3 ? diagonal : high[c] - low[c];
        if (plan.rows_sum_to_one) transform.centre[c] = low[c] + (high[c] - low[c]) / 2;
        else if (size == 0) size = c < 3 ? farthest : distance(c);
        if (!std::isfinite(size) || (size > 0 && !std::isfinite(1 / size)))
            throw BadInput("the values of channel " + std::to_string(c) + " go from " + std::to_string(low[c]) + " to " + std::to_string(high[c]) +
                           ", a size that double precision cannot scale: use other units");
        if (!plan.rows_sum_to_one && distance(c) > float_range * size)
            throw BadInput("the values of channel " + std::to_string(c) + " go from " + std::to_string(low[c]) + " to " + std::to_string(high[c]) +
                           ", too far from 0 for rows that do not sum to 1: move them closer");
        if (size > 0) transform.scale[c] = 1 / size;
    }
    return transform;
}

std::vector<double> to_plan_order(const Plan& plan, const Transform& transform, const double* values, std::size_t stride, int channels) {
    std::vector<double> out(static_cast<std::size_t>(plan.vertex_count) * channels);
    parallel_for(plan.vertex_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const double* value = values + static_cast<std::size_t>(plan.vertex_of_row[row]) * stride;
            for (int c = 0; c < channels; ++c) {
                const double stored = (value[c] - transform.centre[c]) * transform.scale[c];
                out[row * channels + c] = row < static_cast<std::size_t>(plan.isolated_count) ? std::clamp(stored, -float_range, float_range) : stored;
            }
        }
    });
    return out;
}

void from_plan_order(const Plan& plan, const Transform& transform, const std::vector<double>& values, int channels, double* out, std::size_t stride) {
    parallel_for(plan.vertex_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            double* value = out + static_cast<std::size_t>(plan.vertex_of_row[row]) * stride;
            for (int c = 0; c < channels; ++c) value[c] = values[row * channels + c] / transform.scale[c] + transform.centre[c];
        }
    });
}

}  // namespace lcl
