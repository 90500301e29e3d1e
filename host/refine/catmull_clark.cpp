// SPDX-License-Identifier: BSD-3-Clause
// Catmull-Clark on polygons: old vertices, edge points, face points; one quad for each corner of each face.
#include "host/refine/catmull_clark_rules.h"

namespace lcl {

void catmull_clark_rows(const StepInput& input, StencilRows& rows) {
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

void catmull_clark_odd_rows(const StepInput& input, SummedRows& rows) {
    for (Index v = 0; v < input.topology.vertex_count; ++v)
        if (!has_smooth_rule(input.features.kind[v])) rows.add_row_of(v, [&] { add_vertex_point(input, v, 1, rows); });
    for (Index e = 0; e < input.topology.edge_count; ++e)
        if (input.features.edge_is_sharp[e]) rows.add_row_of(input.topology.vertex_count + e, [&] { add_edge_point(input, e, 1, rows); });
}

}  // namespace lcl
