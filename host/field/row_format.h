// SPDX-License-Identifier: BSD-3-Clause
// Rows of a field as they lie in device memory, from and to doubles, on all cores.
#pragma once

#include "host/field/field.h"
#include "host/parallel.h"

namespace lcl {

template <int count, class Get>
void pack_count(RowFormat format, std::size_t rows, void* out, const Get& get) {
    constexpr int width = row_width(count);
    parallel_for(rows, [&](std::size_t begin, std::size_t end) {
        const auto for_each = [&](const auto& put) {
            for (std::size_t i = begin; i < end; ++i) {
                for (int c = 0; c < count; ++c) put(i, c, get(i, c));
                for (int c = count; c < width; ++c) put(i, c, 0.0);
            }
        };
        float* const floats = static_cast<float*>(out);
        double* const doubles = static_cast<double*>(out);
        switch (format) {
            case RowFormat::floats: return for_each([&](std::size_t i, int c, double value) { floats[i * width + c] = static_cast<float>(value); });
            case RowFormat::doubles: return for_each([&](std::size_t i, int c, double value) { doubles[i * width + c] = value; });
            case RowFormat::pairs:
                return for_each([&](std::size_t i, int c, double value) {
                    float& high = floats[i * 2 * width + c];
                    high = static_cast<float>(value);
                    floats[(i * 2 + 1) * width + c] = static_cast<float>(value - high);
                });
        }
    });
}

/// Writes `rows` rows of a block: get(i, c) is component c of row i as a double, 0 <= c < block.count, asked for in this order; the components after them
/// become 0.
template <class Get>
void pack_rows(RowFormat format, const ChannelBlock& block, std::size_t rows, void* out, const Get& get) {
    switch (block.count) {
        case 1: return pack_count<1>(format, rows, out, get);
        case 2: return pack_count<2>(format, rows, out, get);
        case 3: return pack_count<3>(format, rows, out, get);
        case 4: return pack_count<4>(format, rows, out, get);
        case 5: return pack_count<5>(format, rows, out, get);
        case 6: return pack_count<6>(format, rows, out, get);
        case 7: return pack_count<7>(format, rows, out, get);
        default: return pack_count<8>(format, rows, out, get);
    }
}

template <int count, class Put>
void unpack_count(RowFormat format, std::size_t rows, const void* in, const Put& put) {
    constexpr int width = row_width(count);
    parallel_for(rows, [&](std::size_t begin, std::size_t end) {
        const auto for_each = [&](const auto& get) {
            for (std::size_t i = begin; i < end; ++i)
                for (int c = 0; c < count; ++c) put(i, c, get(i, c));
        };
        const float* const floats = static_cast<const float*>(in);
        const double* const doubles = static_cast<const double*>(in);
        switch (format) {
            case RowFormat::floats: return for_each([&](std::size_t i, int c) -> double { return floats[i * width + c]; });
            case RowFormat::doubles: return for_each([&](std::size_t i, int c) { return doubles[i * width + c]; });
            case RowFormat::pairs:
                return for_each([&](std::size_t i, int c) { return static_cast<double>(floats[i * 2 * width + c]) + floats[(i * 2 + 1) * width + c]; });
        }
    });
}

/// The way back: put(i, c, value) for the block's own components.
template <class Put>
void unpack_rows(RowFormat format, const ChannelBlock& block, std::size_t rows, const void* in, const Put& put) {
    switch (block.count) {
        case 1: return unpack_count<1>(format, rows, in, put);
        case 2: return unpack_count<2>(format, rows, in, put);
        case 3: return unpack_count<3>(format, rows, in, put);
        case 4: return unpack_count<4>(format, rows, in, put);
        case 5: return unpack_count<5>(format, rows, in, put);
        case 6: return unpack_count<6>(format, rows, in, put);
        case 7: return unpack_count<7>(format, rows, in, put);
        default: return unpack_count<8>(format, rows, in, put);
    }
}

}  // namespace lcl
