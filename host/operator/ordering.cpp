// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/ordering.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "host/counting_sort.h"
#include "host/mesh/box.h"

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

std::uint32_t hilbert(std::uint32_t morton, int bits);

Array<Keyed> morton_keys(const std::vector<double>& positions, std::size_t count, int axis_bits) {
    const Box box = box_of_points(positions, count, [](std::size_t v) { return static_cast<Index>(v); });
    const double extent = std::max({box.extent(0), box.extent(1), box.extent(2)});
    const double scale = extent > 0 && std::isfinite(extent) ? ((1 << axis_bits) - 1) / extent : 0;  // one scale for all axes keeps cells cubic
    static const bool use_hilbert = std::getenv("HILBERT") != nullptr;
    Array<Keyed> keyed(count);
    parallel_for(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            std::uint32_t key = 0;
            for (int axis = 0; axis < 3; ++axis) key |= spread(static_cast<std::uint32_t>((positions[3 * v + axis] - box.low[axis]) * scale)) << axis;
            if (use_hilbert) key = hilbert(key, axis_bits);
            keyed[v] = {key, static_cast<Index>(v)};
        }
    });
    return keyed;
}

std::uint32_t compact(std::uint32_t x) {
    x &= 0x09249249;
    x = (x | (x >> 2)) & 0x030C30C3;
    x = (x | (x >> 4)) & 0x0300F00F;
    x = (x | (x >> 8)) & 0x030000FF;
    return (x | (x >> 16)) & 0x3FF;
}

std::uint32_t hilbert(std::uint32_t morton, int bits) {
    std::uint32_t X[3] = {compact(morton), compact(morton >> 1), compact(morton >> 2)};
    std::uint32_t M = 1u << (bits - 1), P, Q, t;
    for (Q = M; Q > 1; Q >>= 1) {
        P = Q - 1;
        for (int i = 0; i < 3; i++)
            if (X[i] & Q) X[0] ^= P;
            else { t = (X[0] ^ X[i]) & P; X[0] ^= t; X[i] ^= t; }
    }
    for (int i = 1; i < 3; i++) X[i] ^= X[i - 1];
    t = 0;
    for (Q = M; Q > 1; Q >>= 1)
        if (X[2] & Q) t ^= Q - 1;
    for (int i = 0; i < 3; i++) X[i] ^= t;
    return spread(X[0]) << 2 | spread(X[1]) << 1 | spread(X[2]);
}

/// One stable pass of a radix sort: put(place, element) for every element, in the order of its digit.
template <class Put>
void sort_by_digit(const Array<Keyed>& keyed, int shift, int digit_bits, const Put& put) {
    const std::size_t digits = std::size_t{1} << digit_bits, pieces = piece_count(keyed.size());
    Array<Index> places(pieces * digits);
    const auto digit = [&](const Keyed& k) { return (k.key >> shift) & (digits - 1); };
    for_each_piece(keyed.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index* const counts = places.data() + piece * digits;
        std::fill_n(counts, digits, 0);
        for (std::size_t i = begin; i < end; ++i) ++counts[digit(keyed[i])];
    });
    counts_to_places<Index>(places, digits, pieces, nullptr);
    for_each_piece(keyed.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index* const place = places.data() + piece * digits;
        for (std::size_t i = begin; i < end; ++i) put(place[digit(keyed[i])]++, keyed[i]);
    });
}

}  // namespace

Array<Index> morton_order(const std::vector<double>& positions, Index vertex_count) {
    const int axis_bits = std::getenv("AXIS") ? atoi(std::getenv("AXIS")) : 10, passes = std::getenv("PASSES") ? atoi(std::getenv("PASSES")) : 3, digit_bits = (3 * axis_bits + passes - 1) / passes;
    Array<Keyed> keyed = morton_keys(positions, vertex_count, axis_bits), sorted(keyed.size());
    for (int pass = 0; pass + 1 < passes; ++pass) {
        sort_by_digit(keyed, pass * digit_bits, digit_bits, [&](Index place, const Keyed& k) { sorted[place] = k; });
        keyed.swap(sorted);
    }
    Array<Index> order(keyed.size());
    sort_by_digit(keyed, (passes - 1) * digit_bits, digit_bits, [&](Index place, const Keyed& k) { order[place] = k.vertex; });
    return order;
}

}  // namespace lcl
