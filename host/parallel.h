// SPDX-License-Identifier: BSD-3-Clause
// Loops of the host split over the machine's cores.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace lcl {

constexpr std::size_t smallest_parallel_piece = 16384;  // of a loop of a few nanoseconds an element: starting a thread costs more than less of it

/// Into how many pieces a loop over `count` elements is best cut: one a core, none smaller than `smallest_piece`.
inline std::size_t piece_count(std::size_t count, std::size_t smallest_piece = smallest_parallel_piece) {
    static const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    return std::clamp<std::size_t>(count / std::max<std::size_t>(1, smallest_piece), 1, cores);
}

/// Calls body(piece, begin, end) for that many contiguous pieces of [0, count), each on a thread of its own. The same count and pieces give the same ranges, so
/// that what one loop finds out about a piece another one can use. The first exception is thrown again here.
template <class Body>
void for_each_piece(std::size_t count, std::size_t pieces, const Body& body) {
    const auto begin_of = [&](std::size_t piece) { return count * piece / pieces; };
    if (pieces == 1) return body(std::size_t{0}, std::size_t{0}, count);
    std::vector<std::exception_ptr> failures(pieces);
    std::vector<std::thread> threads;
    threads.reserve(pieces);
    const auto run = [&](std::size_t piece) {
        try {
            body(piece, begin_of(piece), begin_of(piece + 1));
        } catch (...) {
            failures[piece] = std::current_exception();
        }
    };
    std::size_t started = 1;
    try {
        for (; started < pieces; ++started) threads.emplace_back(run, started);
    } catch (...) {  // no more threads to be had: the rest runs here
    }
    run(0);
    for (std::size_t piece = started; piece < pieces; ++piece) run(piece);
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
}

/// Calls body(begin, end) on contiguous pieces of [0, count), one piece a core; small loops stay on the calling thread. The pieces are disjoint, so results do
/// not depend on their number as long as body writes only what belongs to its range. The first exception is thrown again here.
template <class Body>
void parallel_for(std::size_t count, const Body& body, std::size_t smallest_piece = smallest_parallel_piece) {
    for_each_piece(count, piece_count(count, smallest_piece), [&](std::size_t, std::size_t begin, std::size_t end) { body(begin, end); });
}

/// body(i) for every i in [0, count), under the same terms.
template <class Count, class Body>
void parallel_for_each(Count count, const Body& body, std::size_t smallest_piece = smallest_parallel_piece) {
    parallel_for(
        static_cast<std::size_t>(count),
        [&](std::size_t begin, std::size_t end) {
            for (Count i = static_cast<Count>(begin); i < static_cast<Count>(end); ++i) body(i);
        },
        smallest_piece);
}

}  // namespace lcl
