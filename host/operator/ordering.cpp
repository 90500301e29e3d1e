// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/ordering.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "host/counting_sort.h"
#include "host/mesh/box.h"

namespace lcl {
namespace {

constexpr int axis_bits = 10;   // on a Hilbert curve or with fewer bits sweeps take as long
constexpr int digit_bits = 10;  // three digits a key

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

Array<Keyed> morton_keys(const std::vector<double>& positions, std::size_t count) {
    const Box box = box_of_points(positions, count, [](std::size_t v) { return static_cast<Index>(v); });
    const double extent = std::max({box.extent(0), box.extent(1), box.extent(2)});
    const double scale = extent > 0 && std::isfinite(extent) ? ((1 << axis_bits) - 1) / extent : 0;  // one scale for all axes keeps cells cubic
    const auto cell = [&](double x, int axis) { return scale > 0 ? static_cast<std::uint32_t>((x - box.low[axis]) * scale) : 0u; };
    Array<Keyed> keyed(count);
    parallel_for(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const double* const point = &positions[3 * v];
            keyed[v] = {spread(cell(point[0], 0)) | spread(cell(point[1], 1)) << 1 | spread(cell(point[2], 2)) << 2, static_cast<Index>(v)};
        }
    });
    return keyed;
}

/// One stable pass of a radix sort: put(place, element) for every element, in the order of its digit.
template <class Put>
void sort_by_digit(const Array<Keyed>& keyed, int digit, const Put& put) {
    constexpr std::size_t digits = std::size_t{1} << digit_bits;
    const std::size_t pieces = piece_count(keyed.size());
    Array<Index> places(pieces * digits);
    const auto digit_of = [&](const Keyed& k) { return (k.key >> (digit * digit_bits)) & (digits - 1); };
    for_each_piece(keyed.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index* const counts = places.data() + piece * digits;
        std::fill_n(counts, digits, 0);
        for (std::size_t i = begin; i < end; ++i) ++counts[digit_of(keyed[i])];
    });
    counts_to_places<Index>(places, digits, pieces, nullptr);
    for_each_piece(keyed.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index* const place = places.data() + piece * digits;
        for (std::size_t i = begin; i < end; ++i) put(place[digit_of(keyed[i])]++, keyed[i]);
    });
}

}  // namespace

Array<Index> morton_order(const std::vector<double>& positions, Index vertex_count) {
    Array<Keyed> keyed = morton_keys(positions, vertex_count), sorted(keyed.size());
    sort_by_digit(keyed, 0, [&](Index place, const Keyed& k) { sorted[place] = k; });
    sort_by_digit(sorted, 1, [&](Index place, const Keyed& k) { keyed[place] = k; });
    Array<Index> order(keyed.size());
    sort_by_digit(keyed, 2, [&](Index place, const Keyed& k) { order[place] = k.vertex; });
    return order;
}

}  // namespace lcl
