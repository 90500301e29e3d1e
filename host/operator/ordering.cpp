// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/ordering.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace lcl {
namespace {

/// The vertex with a face that lies lowest along the longest axis of the bounding box; 0 if there is none.
Index end_of_longest_axis(const Topology& topology, const std::vector<double>& positions) {
    std::array<Index, 3> lowest{0, 0, 0}, highest{0, 0, 0};
    for (Index v = 0; v < topology.vertex_count; ++v) {
        if (topology.is_isolated(v)) continue;
        for (int axis = 0; axis < 3; ++axis) {
            const double x = positions[3 * static_cast<std::size_t>(v) + axis];
            const auto at = [&](Index w) { return positions[3 * static_cast<std::size_t>(w) + axis]; };
            if (topology.is_isolated(lowest[axis]) || x < at(lowest[axis])) lowest[axis] = v;
            if (topology.is_isolated(highest[axis]) || x > at(highest[axis])) highest[axis] = v;
        }
    }
    int longest = 0;
    const auto extent = [&](int axis) {
        return positions[3 * static_cast<std::size_t>(highest[axis]) + axis] - positions[3 * static_cast<std::size_t>(lowest[axis]) + axis];
    };
    for (int axis = 1; axis < 3; ++axis)
        if (extent(axis) > extent(longest)) longest = axis;
    return lowest[longest];
}

}  // namespace

Array<Index> breadth_first_order(const Topology& topology, const std::vector<double>& positions) {
    const Index n = topology.vertex_count;
    Array<Index> order(n);
    std::vector<std::uint8_t> vertex_is_met(n, 0), face_is_met(topology.face_count, 0);
    Index met = 0, next = 0;
    const auto meet = [&](Index v) {
        if (vertex_is_met[v]) return;
        vertex_is_met[v] = 1;
        order[met++] = v;
    };
    const auto meet_face = [&](Index face) {
        if (face_is_met[face]) return;
        face_is_met[face] = 1;
        for (Index corner = topology.face_offsets[face]; corner < topology.face_offsets[face + 1]; ++corner) meet(topology.face_vertices[corner]);
    };
    const auto spread_from = [&](Index start) {
        for (meet(start); next < met; ++next)
            for (Index i = topology.fan_offsets[order[next]]; i < topology.fan_offsets[order[next] + 1]; ++i)
                meet_face(topology.half_edge_face[topology.fan_half_edges[i]]);
    };
    if (n == 0) return order;
    const Index start = end_of_longest_axis(topology, positions);
    if (!topology.is_isolated(start)) spread_from(start);
    for (Index v = 0; v < n; ++v)
        if (!vertex_is_met[v] && !topology.is_isolated(v)) spread_from(v);
    for (Index v = 0; v < n; ++v)
        if (topology.is_isolated(v)) order[met++] = v;
    return order;
}

}  // namespace lcl
