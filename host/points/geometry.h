// SPDX-License-Identifier: BSD-3-Clause
// What the steps of host/points share on edges and segments.
#pragma once

#include <algorithm>
#include <cstdint>

#include "host/error.h"

namespace lcl {

/// One number for both directions of an edge.
inline std::uint64_t edge_key(Index a, Index b) { return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b)); }

/// Of p from the segment a b. Point: OpenMesh's vectors.
template <class Point>
double squared_distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Point side = b - a;
    const double length = side.sqrnorm(), at = length > 0 ? std::clamp(((p - a) | side) / length, 0.0, 1.0) : 0.0;
    return (p - a - side * at).sqrnorm();
}

}  // namespace lcl
