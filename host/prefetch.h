// SPDX-License-Identifier: BSD-3-Clause
// Hints for loops that look up memory at places which they know some elements ahead.
#pragma once

namespace lcl {

/// Starts to load the memory at a place that is read soon. Any address will do.
inline void prefetch([[maybe_unused]] const void* place) {
#if defined(__GNUC__) || defined(__clang__)
    __builtin_prefetch(place);
#endif
}

/// The same for a place that is written soon.
inline void prefetch_for_writing([[maybe_unused]] const void* place) {
#if defined(__GNUC__) || defined(__clang__)
    __builtin_prefetch(place, 1);
#endif
}

}  // namespace lcl
