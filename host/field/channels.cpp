// SPDX-License-Identifier: BSD-3-Clause
#include "host/field/channels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "host/parallel.h"

namespace lcl {
namespace {

constexpr double float_range = 1e37;

}  // namespace

std::vector<ChannelBlock> channel_blocks(int channels) {
    const auto width_of = [](int count) { return count > 4 ? 8 : count > 2 ? 4 : count; };
    std::vector<ChannelBlock> blocks;
    for (int first = 0; first < channels;) {
        const int count = std::min(channels - first, first == 0 ? 3 : 8);
        blocks.push_back({first, count, width_of(count)});
        first += count;
    }
    return blocks;
}

Transform fit_transform(const Plan& plan, const double* values, std::size_t stride, int channels) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> low(channels, infinity), high(channels, -infinity);
    for (Index row = plan.isolated_count; row < plan.vertex_count; ++row) {
        const double* value = values + static_cast<std::size_t>(plan.vertex_of_row[row]) * stride;
        for (int c = 0; c < channels; ++c) {
            if (!std::isfinite(value[c])) {
                const Index v = plan.vertex_of_row[row];
                throw BadInput("channel " + std::to_string(c) + " of vertex " + std::to_string(v) + " is not finite: correct or leave out the value",
                               {{v}, {}});
            }
            low[c] = std::min(low[c], value[c]);
            high[c] = std::max(high[c], value[c]);
        }
    }
    Transform transform{std::vector<double>(channels, 0.0), std::vector<double>(channels, 1.0)};
    if (plan.isolated_count == plan.vertex_count) return transform;
    double diagonal = 0;
    for (int c = 0; c < std::min(channels, 3); ++c) diagonal = std::hypot(diagonal, high[c] - low[c]);
    for (int c = 0; c < channels; ++c) {
        const double size = c < 3 ? diagonal : high[c] - low[c];
        transform.centre[c] = low[c] + (high[c] - low[c]) / 2;
        if (!std::isfinite(size) || (size > 0 && !std::isfinite(1 / size)))
            throw BadInput("the values of channel " + std::to_string(c) + " go from " + std::to_string(low[c]) + " to " + std::to_string(high[c]) +
                           ", a size that double precision cannot scale: use other units");
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
