// SPDX-License-Identifier: BSD-3-Clause
// The point rules of Catmull-Clark as parts of a row: the plain step takes them whole, the two-phase step blends them. Internal to host/refine.
#pragma once

#include "host/refine/steps.h"

namespace lcl {

/// weight * edge point of edge e: the midpoint if it is sharp, else the mean of its ends and of its two faces' centres.
template <class Rows>
void add_edge_point(const StepInput& input, Index e, double weight, Rows& rows) {
    const Topology& topology = input.topology;
    const Index h = topology.edge_half_edge[e];
    const bool sharp = input.features.edge_is_sharp[e] != 0;
    const double end_weight = weight / (sharp ? 2 : 4);
    rows.add(topology.origin(h), end_weight);
    rows.add(topology.destination(h), end_weight);
    if (sharp) return;
    rows.add_mean(topology.half_edge_face[h], weight / 4);
    rows.add_mean(topology.half_edge_face[topology.twin[h]], weight / 4);
}

/// weight * vertex point of an interior vertex with n faces (mesh expansion paper, appendix A):
/// (n - 2)/n V + 1/n^2 sum (alpha V + (1 - alpha) E_j) + 1/n^2 sum f_j, f_j the centres of its faces. With alpha = 0 that is
/// Q/n + 2R/n + (n - 3)S/n (source slip in the Doo-Sabin paper's section 3.2).
template <class Rows>
void add_smooth_vertex_point(const StepInput& input, Index v, double weight, Rows& rows) {
    const Topology& topology = input.topology;
    const double n = topology.vertex_face_count[v], alpha = input.options.alpha;
    rows.add(v, weight * (n - 2 + alpha) / n);
    const Index start = topology.vertex_half_edge[v];
    Index h = start;
    do {
        rows.add(topology.destination(h), weight * (1 - alpha) / (n * n));
        rows.add_mean(topology.half_edge_face[h], weight / (n * n));
        h = topology.rotate(h);
    } while (h != start);
}

/// weight * vertex point of any vertex: smooth rule (darts too), (L + 6V + R)/8 on curves, V itself at corners and isolated vertices.
template <class Rows>
void add_vertex_point(const StepInput& input, Index v, double weight, Rows& rows) {
    switch (input.features.kind[v]) {
        case VertexKind::smooth:
        case VertexKind::dart: add_smooth_vertex_point(input, v, weight, rows); break;
        case VertexKind::curve:
            rows.add(input.features.curve_neighbours[v][0], weight / 8);
            rows.add(v, weight * 6 / 8);
            rows.add(input.features.curve_neighbours[v][1], weight / 8);
            break;
        case VertexKind::corner:
        case VertexKind::isolated: rows.add(v, weight); break;
    }
}

}  // namespace lcl
