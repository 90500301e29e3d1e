// SPDX-License-Identifier: BSD-3-Clause
// Loops of the host split over the machine's cores.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace lcl {

/// Calls body(begin, end) on contiguous pieces of [0, count), one piece a core; small loops stay on the calling thread. The pieces are disjoint, so results do
/// not depend on their number as long as body writes only what belongs to its range. The first exception is thrown again here.
template <class Body>
void parallel_for(std::size_t count, const Body& body, std::size_t smallest_piece = 16384) {
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t pieces = std::clamp<std::size_t>(count / std::max<std::size_t>(1, smallest_piece), 1, cores);
    if (pieces == 1) return body(std::size_t{0}, count);
    std::vector<std::exception_ptr> failures(pieces);
    std::vector<std::thread> threads;
    threads.reserve(pieces);
    const auto run = [&](std::size_t piece) {
        try {
            body(count * piece / pieces, count * (piece + 1) / pieces);
        } catch (...) {
            failures[piece] = std::current_exception();
        }
    };
    std::size_t started = 1;
    try {
        for (; started < pieces; ++started) threads.emplace_back(run, started);
    } catch (const std::system_error&) {  // no more threads to be had: the rest runs here
    }
    run(0);
    for (std::size_t piece = started; piece < pieces; ++piece) run(piece);
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
}

}  // namespace lcl
