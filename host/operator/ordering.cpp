// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/ordering.h"

#include <array>
#include <cstdint>

#include "host/parallel.h"

namespace lcl {
namespace {

/// Spreads ten bits so that two free bits follow each.
std::uint32_t spread(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000FF;
    x = (x | (x << 8)) & 0x0300F00F;
    x = (x | (x << 4)) & 0x030C30C3;
    return (x | (x << 2)) & 0x09249249;
}

struct Keyed {
    std::uint32_t key;
    Index vertex;
};

std::vector<Keyed> morton_keys(const std::vector<double>& positions, Index count) {
    std::array<double, 3> low{0, 0, 0}, high{0, 0, 0};
    for (int axis = 0; axis < 3 && count > 0; ++axis) low[axis] = high[axis] = positions[axis];
    for (std::size_t i = 0; i < positions.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], positions[i]);
        high[i % 3] = std::max(high[i % 3], positions[i]);
    }
    const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    const double scale = extent > 0 ? 1023 / extent : 0;  // one scale for all axes keeps cells cubic
    std::vector<Keyed> keyed(count);
    parallel_for(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            std::uint32_t key = 0;
            for (int axis = 0; axis < 3; ++axis) key |= spread(static_cast<std::uint32_t>((positions[3 * v + axis] - low[axis]) * scale)) << axis;
            keyed[v] = {key, static_cast<Index>(v)};
        }
    });
    return keyed;
}

}  // namespace

std::vector<Index> morton_order(const std::vector<double>& positions, Index vertex_count) {
    constexpr int digit_bits = 10, digits = 1 << digit_bits;
    std::vector<Keyed> keyed = morton_keys(positions, vertex_count), sorted(keyed.size());
    for (int pass = 0; pass < 3; ++pass) {
        std::array<std::size_t, digits + 1> place{};
        const int shift = pass * digit_bits;
        for (const Keyed& k : keyed) ++place[((k.key >> shift) & (digits - 1)) + 1];
        for (int d = 0; d < digits; ++d) place[d + 1] += place[d];
        for (const Keyed& k : keyed) sorted[place[(k.key >> shift) & (digits - 1)]++] = k;
        keyed.swap(sorted);
    }
    std::vector<Index> order(keyed.size());
    for (std::size_t i = 0; i < keyed.size(); ++i) order[i] = keyed[i].vertex;
    return order;
}

}  // namespace lcl
