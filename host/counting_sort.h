// SPDX-License-Identifier: BSD-3-Clause
// What counting sorts on all cores share.
#pragma once

#include <cstdint>

#include "host/array.h"
#include "host/parallel.h"

namespace lcl {

/// Turns counts into first places. counts: one array of `buckets` numbers after the other, one a piece of the input in its order; each becomes the place of the
/// piece's first element of that bucket, so that filling piece by piece is stable. starts, unless null, receives the buckets' own first places and the total.
template <class Count>
void counts_to_places(Array<Count>& counts, std::size_t buckets, std::size_t pieces, Count* starts) {
    const std::size_t parts = piece_count(buckets);
    std::vector<Count> sums(parts + 1, 0);
    for_each_piece(buckets, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
        Count sum = 0;
        for (std::size_t piece = 0; piece < pieces; ++piece)
            for (std::size_t b = begin; b < end; ++b) sum += counts[piece * buckets + b];
        sums[part + 1] = sum;
    });
    for (std::size_t part = 0; part < parts; ++part) sums[part + 1] += sums[part];
    for_each_piece(buckets, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
        Count place = sums[part];
        for (std::size_t b = begin; b < end; ++b) {
            if (starts != nullptr) starts[b] = place;
            for (std::size_t piece = 0; piece < pieces; ++piece) {
                const Count count = counts[piece * buckets + b];
                counts[piece * buckets + b] = place;
                place += count;
            }
        }
    });
    if (starts != nullptr) starts[buckets] = sums[parts];
}

}  // namespace lcl
