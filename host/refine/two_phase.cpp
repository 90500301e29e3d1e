// SPDX-License-Identifier: BSD-3-Clause
// First step of the two-phase scheme (two-phase paper, section 2): every point of a Catmull-Clark step is drawn towards each of the old vertices that it
// belongs to, by that vertex's blend ratio lambda. Boundaries and creases take the curve rules of Catmull-Clark into the same blend, which makes the limit
// of each vertex lambda V + (1 - lambda) (A V) there too.
#include "host/refine/catmull_clark_rules.h"

namespace lcl {
namespace {

template <class Rows, class AddPoint>
void write_blend(const StepInput& input, Index v, Rows& rows, AddPoint&& add_point) {
    const double lambda = input.options.lambda_at(v);
    rows.begin();
    rows.add(v, lambda);
    add_point(1 - lambda);
    rows.end();
}

template <class Rows>
void write_rows(const StepInput& input, Rows& rows) {
    const Topology& topology = input.topology;
    for (Index v = 0; v < topology.vertex_count; ++v) write_blend(input, v, rows, [&](double weight) { add_vertex_point(input, v, weight, rows); });
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index h = topology.edge_half_edge[e];
        for (const Index v : {topology.origin(h), topology.destination(h)})
            write_blend(input, v, rows, [&](double weight) { add_edge_point(input, e, weight, rows); });
    }
    for (Index h = 0; h < topology.half_edge_count(); ++h)
        write_blend(input, topology.origin(h), rows, [&](double weight) { rows.add_mean(topology.half_edge_face[h], weight); });
}

/// Refined numbers: vertices keep theirs, then two points an edge, then one for each corner.
struct Numbers {
    const Topology& topology;
    /// The point of h's edge next to h's origin.
    Index edge_point(Index h) const { return topology.vertex_count + 2 * topology.half_edge_edge[h] + (is_first(h) ? 0 : 1); }
    /// The point of h's edge next to h's destination.
    Index far_edge_point(Index h) const { return topology.vertex_count + 2 * topology.half_edge_edge[h] + (is_first(h) ? 1 : 0); }
    bool is_first(Index h) const { return topology.edge_half_edge[topology.half_edge_edge[h]] == h; }
    Index face_point(Index h) const { return topology.vertex_count + 2 * topology.edge_count + h; }
};

}  // namespace

void two_phase_rows(const StepInput& input, SummedRows& rows) { write_rows(input, rows); }
void two_phase_rows(const StepInput& input, StencilRows& rows) { write_rows(input, rows); }

void two_phase_faces(const StepInput& input, Refinement& refined) {
    const Topology& topology = input.topology;
    const Numbers number{topology};
    const std::int64_t corners = topology.half_edge_count();
    refined.mesh.vertex_count = topology.vertex_count + 2 * topology.edge_count + topology.half_edge_count();
    FaceList faces(refined.mesh, refined.face_parent, topology.face_count + 2 * corners, 9 * corners);
    for (Index f = 0; f < topology.face_count; ++f) {
        for (Index h = topology.face_offsets[f]; h < topology.face_offsets[f + 1]; ++h) faces.push(number.face_point(h));
        faces.close(f);
    }
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index first = topology.edge_half_edge[e];
        for (const Index h : {first, topology.twin[first]})
            if (h >= 0)
                faces.add({number.edge_point(h), number.far_edge_point(h), number.face_point(topology.next(h)), number.face_point(h)},
                          topology.half_edge_face[h]);
    }
    for (Index v = 0; v < topology.vertex_count; ++v) {
        const Index start = topology.vertex_half_edge[v];
        for (Index h = start; h >= 0;) {
            faces.add({v, number.edge_point(h), number.face_point(h), number.far_edge_point(topology.previous(h))}, topology.half_edge_face[h]);
            h = topology.rotate(h);
            if (h == start) break;
        }
    }
}

}  // namespace lcl
