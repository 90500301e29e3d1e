// SPDX-License-Identifier: BSD-3-Clause
// Loop on triangles: old vertices, edge points; four triangles for each face.
#include <cmath>
#include <string>

#include "host/refine/steps.h"

namespace lcl {
namespace {

constexpr double two_pi = 6.283185307179586;

/// Weight of each neighbour of a vertex of valence n (Loop PIA paper; source slip there: the square was lost).
double loop_beta(Index n) {
    const double c = 3.0 / 8 + std::cos(two_pi / n) / 4;
    return (5.0 / 8 - c * c) / n;
}

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
    const double beta = loop_beta(n);
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

template <class Rows>
void write_rows(const StepInput& input, Rows& rows) {
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

}  // namespace

void check_triangles(const Topology& topology) {
    for (Index f = 0; f < topology.face_count; ++f) {
        if (topology.degree(f) == 3) continue;
        throw BadInput("face " + std::to_string(f) + " has " + std::to_string(topology.degree(f)) +
                           " corners, Loop refines triangles only: triangulate the mesh or choose another scheme",
                       Where{{}, {f}});
    }
}

void loop_rows(const StepInput& input, PointRows& rows) { write_rows(input, rows); }
void loop_rows(const StepInput& input, StencilRows& rows) { write_rows(input, rows); }

void loop_faces(const StepInput& input, Refinement& refined) {
    const Topology& topology = input.topology;
    refined.mesh.vertex_count = topology.vertex_count + topology.edge_count;
    FaceList faces(refined.mesh, refined.face_parent, 4 * static_cast<std::int64_t>(topology.face_count), 12 * static_cast<std::int64_t>(topology.face_count));
    for (Index f = 0; f < topology.face_count; ++f) {
        const Index* corner = &topology.face_vertices[3 * f];
        const Index* edges = &topology.half_edge_edge[3 * f];
        const Index edge_points[3] = {topology.vertex_count + edges[0], topology.vertex_count + edges[1], topology.vertex_count + edges[2]};
        for (int k = 0; k < 3; ++k) faces.add({corner[k], edge_points[k], edge_points[(k + 2) % 3]}, f);
        faces.add({edge_points[0], edge_points[1], edge_points[2]}, f);
    }
}

}  // namespace lcl
