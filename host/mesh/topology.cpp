// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/topology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/mesh/half_edges.h"

namespace lcl {
namespace {

constexpr std::size_t index_limit = std::numeric_limits<Index>::max();

void refuse_too_many(std::size_t count, const char* what) {
    if (count <= index_limit) return;
    throw OutOfMemory("the mesh has " + std::to_string(count) + " " + what + ", more than the " + std::to_string(index_limit) +
                      " that 32-bit indices can number: split the mesh");
}

void set_faces(const PolygonMesh& mesh, Topology& topology) {
    topology.vertex_count = mesh.vertex_count;
    topology.face_count = mesh.face_count();
    topology.face_offsets = mesh.face_offsets;
    topology.face_vertices = mesh.face_vertices;
    topology.half_edge_face.resize(mesh.face_vertices.size());
    for (Index f = 0; f < topology.face_count; ++f)
        for (Index h = mesh.face_offsets[f]; h < mesh.face_offsets[f + 1]; ++h) topology.half_edge_face[h] = f;
}

/// Pairs opposite half-edges. False if an edge has more than two or two that run the same way.
bool match_twins(const HalfEdgeBuckets& buckets, Topology& topology) {
    struct Mark {
        Index lower = -1, half_edge = -1;
    };
    std::vector<Mark> marks(topology.vertex_count);
    topology.twin.assign(topology.face_vertices.size(), -1);
    for (Index v = 0; v < topology.vertex_count; ++v) {
        for (Index i = buckets.offsets[v]; i < buckets.offsets[v + 1]; ++i) {
            const auto [h, higher] = buckets.entries[i];
            Mark& mark = marks[higher];
            if (mark.lower != v) {
                mark = {v, h};
                continue;
            }
            const Index g = mark.half_edge;
            if (topology.twin[g] >= 0 || topology.face_vertices[g] == topology.face_vertices[h]) return false;
            topology.twin[g] = h;
            topology.twin[h] = g;
        }
    }
    return true;
}

void number_edges(Topology& topology) {
    const Index half_edge_count = topology.half_edge_count();
    topology.half_edge_edge.resize(half_edge_count);
    topology.edge_half_edge.reserve(half_edge_count / 2 + half_edge_count / 16 + 3);
    for (Index h = 0; h < half_edge_count; ++h) {
        const Index twin = topology.twin[h];
        if (twin >= 0 && twin < h) {
            topology.half_edge_edge[h] = topology.half_edge_edge[twin];
        } else {
            topology.half_edge_edge[h] = static_cast<Index>(topology.edge_half_edge.size());
            topology.edge_half_edge.push_back(h);
        }
    }
    topology.edge_count = static_cast<Index>(topology.edge_half_edge.size());
}

/// Chooses an outgoing half-edge for each vertex and counts its faces. False if a vertex has two boundary half-edges that leave it.
bool choose_vertex_half_edges(Topology& topology) {
    topology.vertex_half_edge.assign(topology.vertex_count, -1);
    topology.vertex_face_count.assign(topology.vertex_count, 0);
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
        const Index v = topology.face_vertices[h];
        Index& chosen = topology.vertex_half_edge[v];
        ++topology.vertex_face_count[v];
        if (topology.twin[h] < 0) {
            if (chosen >= 0 && topology.twin[chosen] < 0) return false;
            chosen = h;
        } else if (chosen < 0) {
            chosen = h;
        }
    }
    return true;
}

/// A walk round each vertex must meet all of its faces; otherwise they form more than one fan.
bool fans_are_single(const Topology& topology) {
    for (Index v = 0; v < topology.vertex_count; ++v) {
        const Index start = topology.vertex_half_edge[v];
        if (start < 0) continue;
        Index met = 0, h = start;
        do {
            ++met;
            h = topology.rotate(h);
        } while (h >= 0 && h != start);
        if (met != topology.vertex_face_count[v]) return false;
    }
    return true;
}

/// Root of v in a forest of parents that never exceed their children; halves the path on the way.
Index find_root(std::vector<Index>& parent, Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

}  // namespace

HalfEdgeBuckets bucket_half_edges(const PolygonMesh& mesh, const std::vector<char>& skip) {
    const auto for_each = [&](auto&& visit) {
        for (Index f = 0; f < mesh.face_count(); ++f) {
            if (!skip.empty() && skip[f]) continue;
            const Index begin = mesh.face_offsets[f], last = mesh.face_offsets[f + 1] - 1;
            for (Index h = begin; h < last; ++h) visit(h, mesh.face_vertices[h], mesh.face_vertices[h + 1]);
            visit(last, mesh.face_vertices[last], mesh.face_vertices[begin]);
        }
    };
    HalfEdgeBuckets buckets;
    // Counted two places further on, so that filling moves each place on to what it has to be in the end.
    auto& offsets = buckets.offsets;
    offsets.assign(mesh.vertex_count + std::size_t{2}, 0);
    for_each([&](Index, Index a, Index b) { ++offsets[std::min(a, b) + std::size_t{2}]; });
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    buckets.entries.resize(offsets.back());
    for_each([&](Index h, Index a, Index b) { buckets.entries[offsets[std::min(a, b) + 1]++] = {h, std::max(a, b)}; });
    offsets.pop_back();
    return buckets;
}

bool connect(const PolygonMesh& mesh, Topology& topology) {
    set_faces(mesh, topology);
    if (!match_twins(bucket_half_edges(mesh, {}), topology)) return false;
    number_edges(topology);
    return choose_vertex_half_edges(topology) && fans_are_single(topology);
}

Topology build_topology(const PolygonMesh& mesh) {
    refuse_too_many(mesh.face_vertices.size(), "face corners");
    refuse_too_many(mesh.face_offsets.size() - 1, "faces");
    if (mesh.face_count() == 0) throw BadInput("the mesh has no faces: a surface needs at least one");
    Topology topology;
    if (corners_are_sound(mesh) && positions_are_finite(mesh) && connect(mesh, topology)) return topology;
    const Defect defect = find_defects(mesh).front();
    throw BadInput(defect.message, defect.where);
}

std::vector<std::vector<Index>> boundary_loops(const Topology& topology) {
    std::vector<std::vector<Index>> loops;
    std::vector<char> seen(topology.half_edge_count(), 0);
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index first = topology.edge_half_edge[e];
        if (topology.twin[first] >= 0 || seen[first]) continue;
        auto& loop = loops.emplace_back();
        for (Index h = first; !seen[h]; h = topology.vertex_half_edge[topology.destination(h)]) {
            seen[h] = 1;
            loop.push_back(h);
        }
    }
    return loops;
}

std::vector<Index> connected_components(const Topology& topology, Index& count) {
    std::vector<Index> parent(topology.vertex_count);
    for (Index v = 0; v < topology.vertex_count; ++v) parent[v] = v;
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index h = topology.edge_half_edge[e];
        const Index a = find_root(parent, topology.origin(h)), b = find_root(parent, topology.destination(h));
        parent[std::max(a, b)] = std::min(a, b);
    }
    std::vector<Index> component(topology.vertex_count, -1);
    count = 0;
    for (Index v = 0; v < topology.vertex_count; ++v) {
        if (topology.is_isolated(v)) continue;
        const Index root = find_root(parent, v);
        component[v] = root == v ? count++ : component[root];
    }
    return component;
}

double bounding_box_diagonal(const PolygonMesh& mesh) {
    double low[3], high[3];
    std::fill_n(low, 3, std::numeric_limits<double>::infinity());
    std::fill_n(high, 3, -std::numeric_limits<double>::infinity());
    bool is_empty = true;
    for (const Index v : mesh.face_vertices) {
        if (v < 0 || v >= mesh.vertex_count) continue;
        is_empty = false;
        for (int c = 0; c < 3; ++c) {
            const double x = mesh.positions[3 * static_cast<std::size_t>(v) + c];
            low[c] = std::min(low[c], x);
            high[c] = std::max(high[c], x);
        }
    }
    return is_empty ? 0 : std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

}  // namespace lcl
