// SPDX-License-Identifier: BSD-3-Clause
#include "host/field/host_rows.h"

#include <algorithm>

#include "host/field/row_format.h"
#include "host/prefetch.h"

namespace lcl {
namespace {

/// (value - centre) * scale of each of the caller's channels, as it is stored.
struct Scaling {
    const Transform& transform;
    double stored(double value, int channel) const { return (value - transform.centre[channel]) * transform.scale[channel]; }
    double given(double value, int channel) const { return value / transform.scale[channel] + transform.centre[channel]; }
};

}  // namespace

namespace {

constexpr Index rows_ahead = 24;

/// The place of the caller's row that belongs to a row of the plan; starts to load the one that is needed some rows on.
template <class T>
class RowPlaces {
public:
    RowPlaces(const Plan& plan, T* values, std::size_t stride, int channel) : plan_(plan), values_(values + channel), stride_(stride) {}

    T* at(std::size_t row) const { return values_ + plan_.vertex_of_row[row] * stride_; }
    void prefetch_after(std::size_t row) const { prefetch(at(std::min<std::size_t>(row + rows_ahead, plan_.vertex_count - 1))); }

private:
    const Plan& plan_;
    T* values_;
    std::size_t stride_;
};

}  // namespace

void upload_rows(const Plan& plan, const Transform& transform, const HostRows& rows, Field& field) {
    const Scaling scaling{transform};
    field.write(0, plan.vertex_count, [&](std::size_t b, std::size_t first, std::size_t count, void* out) {
        const ChannelBlock& block = field.blocks()[b];
        with_type(rows, [&](const auto* values) {
            const RowPlaces places(plan, values, rows.stride, block.first);
            pack_rows(field.format(), block, count, out, [&](std::size_t i, int c) {
                const std::size_t row = first + i;
                if (c == 0) places.prefetch_after(row);
                const double stored = scaling.stored(places.at(row)[c], block.first + c);
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
            const RowPlaces places(plan, values, rows.stride, block.first);
            unpack_rows(field.format(), block, count, in,
                        [&](std::size_t i, int c, double value) { places.at(first + i)[c] = static_cast<T>(scaling.given(value, block.first + c)); });
        });
    });
}

}  // namespace lcl
