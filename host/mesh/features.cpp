// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/features.h"

#include <cmath>
#include <numeric>

#include "host/mesh/normals.h"
#include "host/parallel.h"

namespace lcl {
namespace {

void check_vertex(const Topology& topology, Index v, const char* what) {
    if (v >= 0 && v < topology.vertex_count) return;
    throw BadInput(std::string(what) + " uses vertex " + std::to_string(v) + ", the mesh has " + std::to_string(topology.vertex_count) + ": correct the index",
                   Where{{v}, {}});
}

/// The edge between a and b, -1 if there is none. Walks round the end with fewer faces: over all edges of a surface that is linear, pole or not
/// (the sum of the smaller valences is bounded by the number of edges times the arboricity, Chiba and Nishizeki 1985).
Index find_edge(const Topology& topology, Index a, Index b) {
    if (topology.is_isolated(a) || topology.is_isolated(b)) return -1;
    if (topology.vertex_face_count[a] > topology.vertex_face_count[b]) std::swap(a, b);
    const Index start = topology.vertex_half_edge[a];
    Index h = start;
    do {
        if (topology.destination(h) == b) return topology.half_edge_edge[h];
        const Index before = topology.previous(h);
        if (topology.origin(before) == b) return topology.half_edge_edge[before];
        h = topology.twin[before];
    } while (h >= 0 && h != start);
    return -1;
}

void mark_given_creases(const Topology& topology, const std::vector<std::array<Index, 2>>& creases, Features& features) {
    for (const auto& [a, b] : creases) {
        check_vertex(topology, a, "a crease");
        check_vertex(topology, b, "a crease");
        const Index e = find_edge(topology, a, b);
        if (e < 0)
            throw BadInput("the crease " + std::to_string(a) + "-" + std::to_string(b) + " is no edge of the mesh: name the two ends of an edge",
                           Where{{a, b}, {}});
        features.edge_is_sharp[e] = 1;
    }
}

void mark_creases_by_angle(const PolygonMesh& mesh, const Topology& topology, double degrees, Features& features) {
    Array<Vector> normals(topology.face_count);
    parallel_for(topology.face_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) normals[f] = newell_normal(topology, static_cast<Index>(f), mesh.positions);
    });
    parallel_for(topology.edge_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            const Index h = topology.edge_half_edge[e];
            if (topology.twin[h] < 0) continue;
            const double angle = angle_between(normals[topology.half_edge_face[h]], normals[topology.half_edge_face[topology.twin[h]]]);
            if (angle > degrees * radians_per_degree) features.edge_is_sharp[e] = 1;
        }
    });
}

/// Visits the edges at v in face order, beginning with that of its own half-edge: visit(edge, other end).
template <class Visit>
void for_each_edge_at(const Topology& topology, Index v, Visit&& visit) {
    const Index start = topology.vertex_half_edge[v];
    Index h = start;
    do {
        visit(topology.half_edge_edge[h], topology.destination(h));
        const Index before = topology.previous(h);
        h = topology.twin[before];
        if (h < 0) visit(topology.half_edge_edge[before], topology.origin(before));
    } while (h >= 0 && h != start);
}

VertexKind kind_of(const Topology& topology, Index v, int sharp_edges, bool marked, BoundaryRule rule) {
    if (topology.is_isolated(v)) return VertexKind::isolated;
    if (marked || sharp_edges > 2) return VertexKind::corner;
    if (topology.is_boundary(v)) {
        if (rule == BoundaryRule::fixed) return VertexKind::corner;
        if (rule == BoundaryRule::edge_and_corner && topology.vertex_face_count[v] == 1) return VertexKind::corner;
    }
    constexpr VertexKind by_sharp_edges[] = {VertexKind::smooth, VertexKind::dart, VertexKind::curve};
    return by_sharp_edges[sharp_edges];
}

std::array<Index, 2> sharp_neighbours(const Topology& topology, const Features& features, Index v) {
    std::array<Index, 2> ends{-1, -1};
    for_each_edge_at(topology, v, [&](Index e, Index other) {
        if (!features.edge_is_sharp[e]) return;
        if (ends[0] < 0) ends[0] = other;
        ends[1] = other;
    });
    return ends;
}

/// How many sharp edges end at each vertex, up to 3.
std::vector<std::uint8_t> count_sharp_edges(const Topology& topology, const Features& features) {
    std::vector<std::uint8_t> sharp_edges(topology.vertex_count, 0);
    for (Index e = 0; e < topology.edge_count; ++e) {
        if (!features.edge_is_sharp[e]) continue;
        const Index h = topology.edge_half_edge[e];
        for (const Index v : {topology.origin(h), topology.destination(h)})
            if (sharp_edges[v] < 3) ++sharp_edges[v];
    }
    return sharp_edges;
}

/// Boundary edges are sharp; counts the creases among the others.
void mark_boundary(const Topology& topology, Features& features) {
    const std::size_t pieces = piece_count(topology.edge_count);
    std::vector<Index> creases(pieces, 0);
    for_each_piece(topology.edge_count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        for (Index e = static_cast<Index>(begin); e < static_cast<Index>(end); ++e) {
            if (topology.is_boundary_edge(e)) features.edge_is_sharp[e] = 1;
            else creases[piece] += features.edge_is_sharp[e];
        }
    });
    features.crease_count = std::accumulate(creases.begin(), creases.end(), Index{0});
}

void classify_vertices(const Topology& topology, const std::vector<char>& marked, BoundaryRule rule, Features& features) {
    const std::vector<std::uint8_t> sharp_edges = count_sharp_edges(topology, features);
    const std::size_t pieces = piece_count(topology.vertex_count);
    std::vector<Index> corners(pieces, 0);
    for_each_piece(topology.vertex_count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        for (Index v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
            const VertexKind kind = kind_of(topology, v, sharp_edges[v], marked[v] != 0, rule);
            features.kind[v] = kind;
            corners[piece] += kind == VertexKind::corner;
        }
    });
    features.corner_count = std::accumulate(corners.begin(), corners.end(), Index{0});
    find_curve_neighbours(topology, features);
}

/// Vertices of a surface without boundary, creases and corners.
void classify_as_smooth(const Topology& topology, Features& features) {
    parallel_for(topology.vertex_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) features.kind[v] = topology.is_isolated(static_cast<Index>(v)) ? VertexKind::isolated : VertexKind::smooth;
    });
}

}  // namespace

void find_curve_neighbours(const Topology& topology, Features& features) {
    features.curve_neighbours.resize(topology.vertex_count);
    parallel_for(topology.vertex_count, [&](std::size_t begin, std::size_t end) {
        for (Index v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
            const bool has_neighbours = features.kind[v] == VertexKind::curve || features.kind[v] == VertexKind::dart;
            features.curve_neighbours[v] = has_neighbours ? sharp_neighbours(topology, features, v) : std::array<Index, 2>{-1, -1};
        }
    });
}

Features find_features(const PolygonMesh& mesh, const Topology& topology, const FeatureOptions& options) {
    Features features;
    features.edge_is_sharp.assign(topology.edge_count, 0);
    features.kind.resize(topology.vertex_count);
    if (topology.is_closed() && options.creases.empty() && options.corners.empty() && options.crease_angle_degrees < 0) {
        classify_as_smooth(topology, features);
        return features;
    }
    mark_given_creases(topology, options.creases, features);
    if (options.crease_angle_degrees >= 0) mark_creases_by_angle(mesh, topology, options.crease_angle_degrees, features);
    mark_boundary(topology, features);
    std::vector<char> marked(topology.vertex_count, 0);
    for (const Index v : options.corners) {
        check_vertex(topology, v, "the list of corners");
        marked[v] = 1;
    }
    classify_vertices(topology, marked, options.boundary, features);
    return features;
}

}  // namespace lcl
