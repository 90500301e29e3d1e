// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/child_topology.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "host/mesh/face_walk.h"
#include "host/parallel.h"

namespace lcl {
namespace {

void resize(Topology& child, Index degree) {
    const std::size_t corners = static_cast<std::size_t>(child.face_count) * degree;
    child.face_offsets.resize(static_cast<std::size_t>(child.face_count) + 1);
    child.half_edge_face.resize(corners);
    child.twin.resize(corners);
    child.fan_half_edges.resize(corners);
    child.fan_offsets.resize(static_cast<std::size_t>(child.vertex_count) + 1);
    child.vertex_half_edge.resize(child.vertex_count);
    child.vertex_face_count.resize(child.vertex_count);
    child.half_edge_edge.resize(corners);
    child.edge_half_edge.resize(child.edge_count);
    child.fan_offsets[child.vertex_count] = child.face_offsets[child.face_count] = static_cast<Index>(corners);
}

void set_fan(Topology& child, Index v, Index offset, Index size) {
    child.fan_offsets[v] = offset;
    child.vertex_face_count[v] = size;
    child.vertex_half_edge[v] = size > 0 ? child.fan_half_edges[offset] : -1;
}

/// Fans of old vertices, whose half-edges child_of(h) keep their order.
template <class ChildOf>
void set_vertex_fans(const Topology& parent, Topology& child, const ChildOf& child_of) {
    parallel_for_each(parent.half_edge_count(), [&](Index i) { child.fan_half_edges[i] = child_of(parent.fan_half_edges[i]); });
    parallel_for_each(parent.vertex_count, [&](Index v) { set_fan(child, v, parent.fan_offsets[v], parent.vertex_face_count[v]); });
}

/// Fans of edge points: `half` of the half-edges on each side of an edge; on_side(h), an array of them in face order, is that of h's side. A fan inside the
/// surface begins with its smallest half-edge, which is on the side of the edge's own half-edge (a face's half-edges follow each other); on the boundary with
/// the first.
template <int half, class OnSide>
void set_edge_fans(const Topology& parent, Topology& child, const OnSide& on_side) {
    const std::size_t edges = parent.edge_count, pieces = piece_count(edges);
    std::vector<Index> boundary_before(pieces + 1, 0);
    if (!parent.is_closed())
        for_each_piece(edges, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
            Index count = 0;
            for (std::size_t e = begin; e < end; ++e) count += parent.is_boundary_edge(static_cast<Index>(e)) ? 1 : 0;
            boundary_before[piece + 1] = count;
        });
    std::partial_sum(boundary_before.begin(), boundary_before.end(), boundary_before.begin());
    for_each_piece(edges, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index offset = parent.half_edge_count() + 2 * half * static_cast<Index>(begin) - half * boundary_before[piece];
        for (std::size_t e = begin; e < end; ++e) {
            const Index h = parent.edge_half_edge[e], t = parent.twin[h];
            const std::array<Index, half> near = on_side(h);
            Index* const fan = &child.fan_half_edges[offset];
            if (t < 0) {
                std::copy_n(near.begin(), half, fan);
            } else {
                const std::array<Index, half> far = on_side(t);
                const int start = near[0] < near[half - 1] ? 0 : half - 1;
                for (int i = start; i < half; ++i) fan[i - start] = near[i];
                std::copy_n(far.begin(), half, fan + half - start);
                for (int i = 0; i < start; ++i) fan[2 * half - start + i] = near[i];
            }
            const Index size = t < 0 ? half : 2 * half;
            set_fan(child, parent.vertex_count + static_cast<Index>(e), offset, size);
            offset += size;
        }
    });
}

void set_counts(const Topology& parent, Topology& child, Index degree) {
    child.boundary_edge_count = 2 * parent.boundary_edge_count;
    child.edge_count = (degree * child.face_count + child.boundary_edge_count) / 2;
    child.uniform_degree = degree;
    child.face_vertices.resize(static_cast<std::size_t>(degree) * child.face_count);
}

/// Numbers the edges of a child in the order of its half-edges, from the first face of a range of its parent's on: by then each old edge that has
/// appeared has given two, and each corner one inside its face.
class EdgeNumbers {
public:
    EdgeNumbers(const Topology& parent, Topology& child, Index first_face) : child_(child) {
        const Index first = parent.face_offsets[first_face];
        const auto older = std::lower_bound(parent.edge_half_edge.begin(), parent.edge_half_edge.end(), first) - parent.edge_half_edge.begin();
        next_ = first + 2 * static_cast<Index>(older);
    }
    /// h is the first half-edge of an edge.
    void add(Index h) {
        const Index twin = child_.twin[h];
        child_.edge_half_edge[next_] = h;
        child_.half_edge_edge[h] = next_;
        if (twin >= 0) child_.half_edge_edge[twin] = next_;
        ++next_;
    }

private:
    Topology& child_;
    Index next_;
};

/// Of a half-edge with this twin; the two lie in different faces.
bool appears_first(Index h, Index twin) { return twin < 0 || twin > h; }

template <class Walk>
void catmull_clark_faces(const Walk& walk, const Topology& parent, Topology& child) {
    const Index edge_points = parent.vertex_count, face_points = edge_points + parent.edge_count;
    parallel_for_each(parent.half_edge_count(), [&](Index h) {
        Index* const corners = &child.face_vertices[4 * static_cast<std::size_t>(h)];
        corners[0] = parent.face_vertices[h];
        corners[1] = edge_points + parent.half_edge_edge[h];
        corners[2] = face_points + walk.face(h);
        corners[3] = edge_points + parent.half_edge_edge[walk.previous(h)];
    });
}

/// Twins of the children of h, and the edges that appear first among them.
template <class Walk>
void connect_quad(const Walk& walk, const Topology& parent, Topology& child, Index h, EdgeNumbers& edges) {
    const Index before = walk.previous(h), next = walk.next(h), t = parent.twin[h], t_before = parent.twin[before];
    Index* const twin = &child.twin[4 * h];
    twin[0] = t < 0 ? -1 : 4 * walk.next(t) + 3;
    twin[1] = 4 * next + 2;
    twin[2] = 4 * before + 1;
    twin[3] = t_before < 0 ? -1 : 4 * t_before;
    if (appears_first(h, t)) edges.add(4 * h);
    if (next > h) edges.add(4 * h + 1);
    if (before > h) edges.add(4 * h + 2);
    if (appears_first(before, t_before)) edges.add(4 * h + 3);
    std::fill_n(&child.half_edge_face[4 * h], 4, h);
    child.face_offsets[h] = 4 * h;
}

template <class Walk>
void connect_catmull_clark(const Walk& walk, const Topology& parent, Topology& child) {
    parallel_for(parent.face_count, [&](std::size_t begin, std::size_t end) {
        EdgeNumbers edges(parent, child, static_cast<Index>(begin));
        for (Index h = parent.face_offsets[begin]; h < parent.face_offsets[end]; ++h) connect_quad(walk, parent, child, h, edges);
    });
    set_vertex_fans(parent, child, [](Index h) { return 4 * h; });
    set_edge_fans<2>(parent, child, [&](Index h) { return std::array<Index, 2>{4 * walk.next(h) + 3, 4 * h + 1}; });
    const Index face_points = parent.vertex_count + parent.edge_count, offset = child.half_edge_count() - parent.half_edge_count();
    parallel_for_each(parent.half_edge_count(), [&](Index h) { child.fan_half_edges[offset + h] = 4 * h + 2; });
    parallel_for_each(parent.face_count, [&](Index f) { set_fan(child, face_points + f, offset + parent.face_offsets[f], parent.degree(f)); });
}

void loop_faces(const Topology& parent, Topology& child) {
    const Index edge_points = parent.vertex_count;
    parallel_for_each(parent.face_count, [&](Index f) {
        const Index* const vertices = &parent.face_vertices[3 * f];
        const Index* const edges = &parent.half_edge_edge[3 * f];
        Index* const corners = &child.face_vertices[12 * static_cast<std::size_t>(f)];
        for (int k = 0; k < 3; ++k) {
            corners[3 * k] = vertices[k];
            corners[3 * k + 1] = edge_points + edges[k];
            corners[3 * k + 2] = edge_points + edges[(k + 2) % 3];
            corners[9 + k] = edge_points + edges[k];
        }
    });
}

/// Where the corner triangle of half-edge h begins.
Index corner_triangle(Index h) { return 12 * (h / 3) + 3 * (h % 3); }

void connect_triangles(const Topology& parent, Topology& child, Index f, EdgeNumbers& edges) {
    const TriangleWalk walk;
    for (int k = 0; k < 3; ++k) {
        const Index h = 3 * f + k, before = walk.previous(h), first = corner_triangle(h), t = parent.twin[h], t_before = parent.twin[before];
        child.twin[first] = t < 0 ? -1 : corner_triangle(walk.next(t)) + 2;
        child.twin[first + 1] = 12 * f + 9 + (k + 2) % 3;
        child.twin[first + 2] = t_before < 0 ? -1 : corner_triangle(t_before);
        child.twin[12 * f + 9 + k] = corner_triangle(walk.next(h)) + 1;
        if (appears_first(h, t)) edges.add(first);
        edges.add(first + 1);
        if (appears_first(before, t_before)) edges.add(first + 2);
    }
    for (int k = 0; k < 4; ++k) {
        std::fill_n(&child.half_edge_face[12 * f + 3 * k], 3, 4 * f + k);
        child.face_offsets[4 * f + k] = 12 * f + 3 * k;
    }
}

void connect_loop(const Topology& parent, Topology& child) {
    const TriangleWalk walk;
    parallel_for(parent.face_count, [&](std::size_t begin, std::size_t end) {
        EdgeNumbers edges(parent, child, static_cast<Index>(begin));
        for (Index f = static_cast<Index>(begin); f < static_cast<Index>(end); ++f) connect_triangles(parent, child, f, edges);
    });
    set_vertex_fans(parent, child, corner_triangle);
    set_edge_fans<3>(parent, child, [&](Index h) {
        return std::array<Index, 3>{corner_triangle(walk.next(h)) + 2, 12 * (h / 3) + 9 + h % 3, corner_triangle(h) + 1};
    });
}

}  // namespace

Topology catmull_clark_topology(const Topology& parent, TopologyPart part) {
    Topology child;
    child.vertex_count = parent.vertex_count + parent.edge_count + parent.face_count;
    child.face_count = parent.half_edge_count();
    set_counts(parent, child, 4);
    with_face_walk(parent, [&](const auto& walk) {
        catmull_clark_faces(walk, parent, child);
        if (part == TopologyPart::faces) return;
        resize(child, 4);
        connect_catmull_clark(walk, parent, child);
    });
    return child;
}

Topology loop_topology(const Topology& parent, TopologyPart part) {
    Topology child;
    child.vertex_count = parent.vertex_count + parent.edge_count;
    child.face_count = 4 * parent.face_count;
    set_counts(parent, child, 3);
    loop_faces(parent, child);
    if (part == TopologyPart::faces) return child;
    resize(child, 3);
    connect_loop(parent, child);
    return child;
}

Features child_features(const Topology& parent, const Features& features, const Topology& child) {
    Features refined;
    const Index edge_points = parent.vertex_count;
    refined.edge_is_sharp.assign(child.edge_count, 0);
    refined.kind.resize(child.vertex_count);
    refined.crease_count = 2 * features.crease_count;
    refined.corner_count = features.corner_count;
    std::copy(features.kind.begin(), features.kind.end(), refined.kind.begin());
    std::fill(refined.kind.begin() + edge_points, refined.kind.end(), VertexKind::smooth);
    if (parent.is_closed() && features.crease_count == 0 && features.corner_count == 0) return refined;
    for (Index e = 0; e < parent.edge_count; ++e) {
        if (!features.edge_is_sharp[e]) continue;
        refined.kind[edge_points + e] = VertexKind::curve;
        // The two halves of the edge are the edges at its point that lead to old vertices.
        for (Index i = child.fan_offsets[edge_points + e]; i < child.fan_offsets[edge_points + e + 1]; ++i)
            for (const Index h : {child.fan_half_edges[i], child.previous(child.fan_half_edges[i])})
                if (child.origin(h) < edge_points || child.destination(h) < edge_points) refined.edge_is_sharp[child.half_edge_edge[h]] = 1;
    }
    find_curve_neighbours(child, refined);
    return refined;
}

}  // namespace lcl
