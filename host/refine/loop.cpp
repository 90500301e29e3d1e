// SPDX-License-Identifier: BSD-3-Clause
// Loop on triangles: old vertices, edge points; four triangles for each face.
#include <string>

#include "host/refine/steps.h"
#include "host/scheme/masks.h"

namespace lcl {
namespace {

template <class Rows>
void add_vertex_point(const StepInput& input, Index v, Rows& rows) {
    const Topology& topology = input.topology;
    const VertexKind kind = input.features.kind[v];
    if (kind == VertexKind::corner || kind == VertexKind::isolated) return rows.add(v, 1);
    if (kind == VertexKind::curve) {
        rows.add(input.features.curve_neighbours[v][0], 1.0 / 8);
        rows.add(v, 6.0 / 8);
        rows.add(input.features.curve_neighbours[v][1], 1.0 / 8);
        return;
    }
    const Index n = topology.vertex_face_count[v], start = topology.vertex_half_edge[v];
    const double beta = loop_refined_edge_weight(n);
    rows.add(v, 1 - n * beta);
    Index h = start;
    do {
        rows.add(topology.destination(h), beta);
        h = topology.rotate(h);
    } while (h != start);
}

template <class Rows>
void add_edge_point(const StepInput& input, Index e, Rows& rows) {
    const Topology& topology = input.topology;
    const Index h = topology.edge_half_edge[e];
    const bool sharp = input.features.edge_is_sharp[e] != 0;
    rows.add(topology.origin(h), sharp ? 1.0 / 2 : 3.0 / 8);
    rows.add(topology.destination(h), sharp ? 1.0 / 2 : 3.0 / 8);
    if (sharp) return;
    rows.add(topology.origin(topology.previous(h)), 1.0 / 8);
    rows.add(topology.origin(topology.previous(topology.twin[h])), 1.0 / 8);
}

}  // namespace

void check_triangles(const Topology& topology) {
    for (Index f = 0; f < topology.face_count; ++f) {
        if (topology.degree(f) == 3) continue;
        throw BadInput("face " + std::to_string(f) + " has " + std::to_string(topology.degree(f)) +
                           " corners, Loop refines triangles only: triangulate the mesh or choose another scheme",
                       Where{{}, {f}});
    }
}

void loop_rows(const StepInput& input, StencilRows& rows) {
    for (Index v = 0; v < input.topology.vertex_count; ++v) {
        rows.begin();
        add_vertex_point(input, v, rows);
        rows.end();
    }
    for (Index e = 0; e < input.topology.edge_count; ++e) {
        rows.begin();
        add_edge_point(input, e, rows);
        rows.end();
    }
}

void loop_odd_rows(const StepInput& input, SummedRows& rows) {
    for (Index v = 0; v < input.topology.vertex_count; ++v)
        if (!has_smooth_rule(input.features.kind[v])) rows.add_row_of(v, [&] { add_vertex_point(input, v, rows); });
    for (Index e = 0; e < input.topology.edge_count; ++e)
        if (input.features.edge_is_sharp[e]) rows.add_row_of(input.topology.vertex_count + e, [&] { add_edge_point(input, e, rows); });
}

}  // namespace lcl
