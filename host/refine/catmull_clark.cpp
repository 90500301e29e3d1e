// SPDX-License-Identifier: BSD-3-Clause
// Catmull-Clark on polygons: old vertices, edge points, face points; one quad for each corner of each face.
#include "host/refine/catmull_clark_rules.h"

namespace lcl {
namespace {

template <class Rows>
void write_rows(const StepInput& input, Rows& rows) {
    for (Index v = 0; v < input.topology.vertex_count; ++v) {
        rows.begin();
        add_vertex_point(input, v, 1, rows);
        rows.end();
    }
    for (Index e = 0; e < input.topology.edge_count; ++e) {
        rows.begin();
        add_edge_point(input, e, 1, rows);
        rows.end();
    }
    for (Index f = 0; f < input.topology.face_count; ++f) {
        rows.begin();
        rows.add_mean(f, 1);
        rows.end();
    }
}

}  // namespace

void catmull_clark_rows(const StepInput& input, PointRows& rows) { write_rows(input, rows); }
void catmull_clark_rows(const StepInput& input, StencilRows& rows) { write_rows(input, rows); }

void catmull_clark_faces(const StepInput& input, Refinement& refined) {
    const Topology& topology = input.topology;
    const Index edge_points = topology.vertex_count, face_points = edge_points + topology.edge_count;
    refined.mesh.vertex_count = face_points + topology.face_count;
    FaceList faces(refined.mesh, refined.face_parent, topology.half_edge_count(), 4 * static_cast<std::int64_t>(topology.half_edge_count()));
    for (Index f = 0; f < topology.face_count; ++f) {
        Index before = topology.face_offsets[f + 1] - 1;
        for (Index h = topology.face_offsets[f]; h < topology.face_offsets[f + 1]; before = h++)
            faces.add({topology.face_vertices[h], edge_points + topology.half_edge_edge[h], face_points + f, edge_points + topology.half_edge_edge[before]}, f);
    }
}

}  // namespace lcl
