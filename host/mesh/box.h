// SPDX-License-Identifier: BSD-3-Clause
// Bounding boxes of many points, on all cores.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/parallel.h"

namespace lcl {

struct Box {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    double low[3] = {infinity, infinity, infinity}, high[3] = {-infinity, -infinity, -infinity};

    bool is_empty() const { return low[0] > high[0]; }
    double extent(int axis) const { return is_empty() ? 0 : high[axis] - low[axis]; }
    double diagonal() const { return std::hypot(extent(0), extent(1), extent(2)); }
};

/// The box of the points vertex_at(0) .. vertex_at(count - 1), negative ones left out. positions: x, y, z of every vertex.
template <class VertexAt>
Box box_of_points(const std::vector<double>& positions, std::size_t count, const VertexAt& vertex_at) {
    const std::size_t pieces = piece_count(count);
    std::vector<Box> boxes(pieces);
    for_each_piece(count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Box box;
        double x0 = box.low[0], y0 = x0, z0 = x0, x1 = box.high[0], y1 = x1, z1 = x1;  // kept in registers, which members would not be
        for (std::size_t i = begin; i < end; ++i) {
            const auto v = vertex_at(i);
            if (v < 0) continue;
            const double* const point = &positions[3 * static_cast<std::size_t>(v)];
            x0 = std::min(x0, point[0]), y0 = std::min(y0, point[1]), z0 = std::min(z0, point[2]);
            x1 = std::max(x1, point[0]), y1 = std::max(y1, point[1]), z1 = std::max(z1, point[2]);
        }
        boxes[piece] = {{x0, y0, z0}, {x1, y1, z1}};
    });
    Box all;
    for (const Box& box : boxes)
        for (int axis = 0; axis < 3; ++axis) {
            all.low[axis] = std::min(all.low[axis], box.low[axis]);
            all.high[axis] = std::max(all.high[axis], box.high[axis]);
        }
    return all;
}

}  // namespace lcl
