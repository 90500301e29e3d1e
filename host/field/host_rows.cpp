// SPDX-License-Identifier: BSD-3-Clause
#include "host/field/host_rows.h"

#include <algorithm>

#include "host/field/row_format.h"

namespace lcl {
namespace {

/// (value - centre) * scale of each of the caller's channels, as it is stored.
struct Scaling {
    const Transform& transform;
    double stored(double value, int channel) const { return (value - transform.centre[channel]) * transform.scale[channel]; }
    double given(double value, int channel) const { return value / transform.scale[channel] + transform.centre[channel]; }
};

}  // namespace

void upload_rows(const Plan& plan, const Transform& transform, const HostRows& rows, Field& field) {
    const Scaling scaling{transform};
    field.write(0, plan.vertex_count, [&](std::size_t b, std::size_t first, std::size_t count, void* out) {
        const ChannelBlock& block = field.blocks()[b];
        with_type(rows, [&](const auto* values) {
            pack_rows(field.format(), block, count, out, [&](std::size_t i, int c) {
                const std::size_t row = first + i;
                const double stored = scaling.stored(values[plan.vertex_of_row[row] * rows.stride + block.first + c], block.first + c);
                return row < static_cast<std::size_t>(plan.isolated_count) ? std::clamp(stored, -float_range, float_range) : stored;
            });
        });
    });
}

void download_rows(const Plan& plan, const Transform& transform, const Field& field, const WritableHostRows& rows) {
    const Scaling scaling{transform};
    field.read(0, plan.vertex_count, [&](std::size_t b, std::size_t first, std::size_t count, const void* in) {
        const ChannelBlock& block = field.blocks()[b];
        with_type(rows, [&](auto* values) {
            using T = std::remove_pointer_t<decltype(values)>;
            unpack_rows(field.format(), block, count, in, [&](std::size_t i, int c, double value) {
                values[plan.vertex_of_row[first + i] * rows.stride + block.first + c] = static_cast<T>(scaling.given(value, block.first + c));
            });
        });
    });
}

}  // namespace lcl
