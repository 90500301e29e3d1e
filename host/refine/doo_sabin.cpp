// SPDX-License-Identifier: BSD-3-Clause
// Doo-Sabin: one vertex for each corner of each face; faces of type F (old faces), E (old edges), V (old vertices).
//
// A boundary is closed by a ghost row equal to the boundary row: each boundary edge ab yields 3/4 a + 1/4 b and 1/4 a + 3/4 b, the face of the edge closes with
// these two, the face of a vertex with its own two, and a corner keeps itself as one more point of its face. The mesh is cut along creases: each side gets the
// points of a boundary of its own, at the same places, so the sides share the curve and nothing gapes. A dart is the tip of its slit: a boundary vertex with
// the crease's other end as both neighbours. A corner without any sharp edge has no gap in its face for its point: its face is a fan of triangles round it.
#include <string>

#include "host/refine/steps.h"

namespace lcl {
namespace {

bool is_sharp(const StepInput& input, Index h) { return input.features.edge_is_sharp[input.topology.half_edge_edge[h]] != 0; }

/// Adds the sectors of v in face order from its own half-edge on; they begin at its sharp outgoing half-edges.
void add_sectors(const Topology& topology, const Features& features, Index v, std::vector<DooSabinLayout::Sector>& sectors) {
    const std::size_t before = sectors.size();
    const Index start = topology.vertex_half_edge[v];
    Index h = start;
    do {
        if (features.edge_is_sharp[topology.half_edge_edge[h]]) sectors.push_back({v, h, -1, false});
        h = topology.rotate(h);
    } while (h >= 0 && h != start);
    if (sectors.size() > before) return;
    if (topology.vertex_face_count[v] == 2)
        throw BadInput("vertex " + std::to_string(v) +
                           " has only two faces all round it, where Doo-Sabin makes a face of two sides: remove the vertex, "
                           "make one of its edges a crease, or choose another scheme",
                       Where{{v}, {topology.half_edge_face[start], topology.half_edge_face[topology.twin[start]]}});
    sectors.push_back({v, start, -1, true});
}

/// Visits the outgoing half-edges of a sector in face order; returns the last.
template <class Visit>
Index for_each_in_sector(const StepInput& input, const DooSabinLayout::Sector& sector, Visit&& visit) {
    const Topology& topology = input.topology;
    Index h = sector.first;
    while (true) {
        visit(h);
        const Index before = topology.previous(h);
        if (!sector.closed && is_sharp(input, before)) return h;
        const Index following = topology.twin[before];
        if (following == sector.first) return h;
        h = following;
    }
}

/// Faces of the refined mesh together with the quadrants of their corners.
class QuadrantFaces {
public:
    QuadrantFaces(FaceList& faces, std::vector<std::uint8_t>* quadrants) : faces_(faces), quadrants_(quadrants) {}
    void push(Index vertex, std::uint8_t quadrant) {
        faces_.push(vertex);
        if (quadrants_) quadrants_->push_back(quadrant);
    }
    void close(Index parent) { faces_.close(parent); }

private:
    FaceList& faces_;
    std::vector<std::uint8_t>* quadrants_;
};

void add_edge_faces(const StepInput& input, const DooSabinLayout& layout, Index e, QuadrantFaces& faces) {
    const Topology& topology = input.topology;
    const Index first = topology.edge_half_edge[e], twin = topology.twin[first];
    if (!input.features.edge_is_sharp[e]) {
        faces.push(first, 1);
        faces.push(topology.next(twin), 3);
        faces.push(twin, 1);
        faces.push(topology.next(first), 3);
        return faces.close(-1);
    }
    for (const Index h : {first, twin}) {
        if (h < 0) continue;
        const Index point = layout.point(topology, h);
        faces.push(h, 1);
        faces.push(point, 0);
        faces.push(point + 1, 0);
        faces.push(topology.next(h), 3);
        faces.close(-1);
    }
}

void add_vertex_face(const StepInput& input, const DooSabinLayout& layout, const DooSabinLayout::Sector& sector, QuadrantFaces& faces) {
    const Topology& topology = input.topology;
    const Index last = for_each_in_sector(input, sector, [&](Index h) { faces.push(h, 2); });
    if (!sector.closed) {
        faces.push(layout.point(topology, topology.previous(last)) + 1, 1);
        if (sector.kept >= 0) faces.push(sector.kept, 0);
        faces.push(layout.point(topology, sector.first), 3);
    }
    faces.close(-1);
}

void add_fan(const StepInput& input, const DooSabinLayout::Sector& sector, QuadrantFaces& faces) {
    for_each_in_sector(input, sector, [&](Index h) {
        faces.push(sector.kept, 0);
        faces.push(h, 2);
        faces.push(input.topology.rotate(h), 2);
        faces.close(-1);
    });
}

template <class Rows>
void write_corner_row(const StepInput& input, Index h, Rows& rows) {
    const Topology& topology = input.topology;
    const Index face = topology.half_edge_face[h];
    rows.begin();
    if (input.options.mask == DooSabinMask::classic) {
        // (m + 5)/(4m) on the corner itself, (3 + 2 cos(2 pi j/m))/(4m) on the one j steps on
        rows.add(topology.origin(h), 1.0 / 4);
        rows.add_mean(face, 3.0 / 4);
        rows.add_harmonic(h, 1.0 / 2);
    } else {
        rows.add(topology.origin(h), 1.0 / 2);
        rows.add(topology.destination(h), 1.0 / 8);
        rows.add(topology.origin(topology.previous(h)), 1.0 / 8);
        rows.add_mean(face, 1.0 / 4);
    }
    rows.end();
}

template <class Rows>
void write_curve_rows(const Topology& topology, Index h, Rows& rows) {
    for (const double near : {3.0 / 4, 1.0 / 4}) {
        rows.begin();
        rows.add(topology.origin(h), near);
        rows.add(topology.destination(h), 1 - near);
        rows.end();
    }
}

template <class Rows>
void write_rows(const StepInput& input, const DooSabinLayout& layout, Rows& rows) {
    const Topology& topology = input.topology;
    const auto write_same = [&](Index v) {
        rows.begin();
        rows.add(v, 1);
        rows.end();
    };
    for (Index h = 0; h < topology.half_edge_count(); ++h) write_corner_row(input, h, rows);
    for (Index e = 0; e < topology.edge_count; ++e) {
        if (!input.features.edge_is_sharp[e]) continue;
        const Index first = topology.edge_half_edge[e];
        for (const Index h : {first, topology.twin[first]})
            if (h >= 0) write_curve_rows(topology, h, rows);
    }
    for (const auto& sector : layout.sectors)
        if (sector.kept >= 0) write_same(sector.vertex);
    for (const Index v : layout.isolated) write_same(v);
}

}  // namespace

DooSabinLayout lay_out_doo_sabin(const Topology& topology, const Features& features) {
    DooSabinLayout layout;
    std::int64_t next = topology.half_edge_count();  // refine() refuses what does not fit 32 bits, from counts of its own
    layout.first_point.assign(topology.edge_count, -1);
    for (Index e = 0; e < topology.edge_count; ++e) {
        if (!features.edge_is_sharp[e]) continue;
        layout.first_point[e] = static_cast<Index>(next);
        next += topology.is_boundary_edge(e) ? 2 : 4;
    }
    layout.kept_begin = static_cast<Index>(next);
    layout.sectors.reserve(topology.vertex_count);
    for (Index v = 0; v < topology.vertex_count; ++v) {
        if (topology.is_isolated(v)) {
            layout.isolated.push_back(v);
            continue;
        }
        const std::size_t before = layout.sectors.size();
        add_sectors(topology, features, v, layout.sectors);
        if (features.kind[v] != VertexKind::corner) continue;
        for (std::size_t i = before; i < layout.sectors.size(); ++i) layout.sectors[i].kept = static_cast<Index>(next++);
    }
    layout.isolated_begin = static_cast<Index>(next);
    layout.vertex_count = static_cast<Index>(next + static_cast<std::int64_t>(layout.isolated.size()));
    return layout;
}

void doo_sabin_rows(const StepInput& input, const DooSabinLayout& layout, SummedRows& rows) { write_rows(input, layout, rows); }
void doo_sabin_rows(const StepInput& input, const DooSabinLayout& layout, StencilRows& rows) { write_rows(input, layout, rows); }

void doo_sabin_faces(const StepInput& input, const DooSabinLayout& layout, Refinement& refined, std::vector<std::uint8_t>* quadrants) {
    const Topology& topology = input.topology;
    refined.mesh.vertex_count = layout.vertex_count;
    FaceList list(refined.mesh, refined.face_parent, topology.face_count + topology.edge_count + static_cast<std::int64_t>(layout.sectors.size()),
                  4 * static_cast<std::int64_t>(topology.half_edge_count()) + layout.vertex_count);
    QuadrantFaces faces(list, quadrants);
    for (Index f = 0; f < topology.face_count; ++f) {
        for (Index h = topology.face_offsets[f]; h < topology.face_offsets[f + 1]; ++h) faces.push(h, 0);
        faces.close(f);
    }
    for (Index e = 0; e < topology.edge_count; ++e) add_edge_faces(input, layout, e, faces);
    for (const auto& sector : layout.sectors) {
        const bool smooth_corner = sector.closed && sector.kept >= 0;
        smooth_corner ? add_fan(input, sector, faces) : add_vertex_face(input, layout, sector, faces);
    }
}

}  // namespace lcl
