// SPDX-License-Identifier: BSD-3-Clause
// How n x c values of a caller lie in device fields: in blocks of at most eight channels, centred and scaled.
#pragma once

#include <type_traits>
#include <vector>

#include "host/operator/plan.h"

namespace lcl {

/// Channels [first, first + count) lie in one buffer of rows of `width` (1, 2, 4 or 8) components.
struct ChannelBlock {
    int first = 0, count = 0, width = 0;
};

constexpr double float_range = 1e37;  // isolated vertices are cut off here

/// Components of a row of so many channels: vectors of the kernels.
constexpr int row_width(int count) { return count > 4 ? 8 : count > 2 ? 4 : count; }

/// Eights, which cost a CPU little more than fours: indices are read once for both. The first block begins with the position, x, y, z (or fewer), whose norm,
/// the residual E_k, is kept apart from that of channels beside it.
std::vector<ChannelBlock> channel_blocks(int channels);
/// Whether a block holds the position and more.
inline bool is_mixed(const ChannelBlock& block) { return block.first == 0 && block.count > 3; }

/// n x c values in a caller's memory: row v begins at value v * stride.
template <class Values>
struct RowsOf {
    Values* values = nullptr;
    std::size_t stride = 0;
    bool is_float = false;  ///< floats, else doubles
};
using HostRows = RowsOf<const void>;
using WritableHostRows = RowsOf<void>;

/// body(values), values: a pointer to what they are.
template <class Values, class Body>
auto with_type(const RowsOf<Values>& rows, const Body& body) {
    constexpr bool is_const = std::is_const_v<Values>;
    using Float = std::conditional_t<is_const, const float, float>;
    using Double = std::conditional_t<is_const, const double, double>;
    return rows.is_float ? body(static_cast<Float*>(rows.values)) : body(static_cast<Double*>(rows.values));
}

/// stored = (value - centre) * scale, one of each a channel. Where rows of A sum to 1, A commutes with it, and models that are far away or huge lose nothing in
/// float; where they do not, the centre is 0.
struct Transform {
    std::vector<double> centre, scale;
};

/// Values as they are: for directions.
inline Transform unscaled(int channels) { return {std::vector<double>(channels, 0.0), std::vector<double>(channels, 1.0)}; }

/// Positions: centre and inverse diagonal of the bounding box; further channels: middle and inverse range. 1 where a range is 0, or, where rows do not sum to
/// 1, the inverse of the largest value. Isolated vertices are left out. BadInput for a value that is not finite, or values so large, so close together or so
/// far from 0 where that is the centre that they cannot be scaled. values: row v of `stride` doubles belongs to vertex v.
Transform fit_transform(const Plan& plan, const double* values, std::size_t stride, int channels);

/// The same in two steps, for values of any kind.
struct ValueRanges {
    bool are_finite = true;         ///< all values, those of isolated vertices among them
    std::vector<double> low, high;  ///< of each channel, isolated vertices left out
};
ValueRanges value_ranges(const Plan& plan, const HostRows& rows, int channels);
Transform transform_of_ranges(const Plan& plan, const ValueRanges& ranges);

/// Values in the plan's order, transformed: vertex_count x channels. Isolated vertices, which may be anywhere, are cut off at 1e37, so that
/// floats hold them.
std::vector<double> to_plan_order(const Plan& plan, const Transform& transform, const double* values, std::size_t stride, int channels);

/// The inverse; writes channels doubles at out + v * stride for every vertex v.
void from_plan_order(const Plan& plan, const Transform& transform, const std::vector<double>& values, int channels, double* out, std::size_t stride);

}  // namespace lcl
