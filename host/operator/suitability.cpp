// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/suitability.h"

#include <algorithm>
#include <atomic>

#include "host/parallel.h"

namespace lcl {
namespace {

/// The destinations of a vertex's half-edges: all of its neighbours where it is no boundary vertex.
template <class Visit>
bool all_of_neighbours(const Topology& t, Index v, const Visit& visit) {
    for (Index i = t.fan_offsets[v]; i < t.fan_offsets[v + 1]; ++i)
        if (!visit(t.destination(t.fan_half_edges[i]))) return false;
    return true;
}

/// Some vertex counts with all of its neighbours: without one there is no component in which all count, and few meshes have one.
template <class Counts>
bool any_counts_with_neighbours(const Topology& t, const Counts& counts) {
    std::atomic<bool> found{false};
    parallel_for(t.vertex_count, [&](std::size_t begin, std::size_t end) {
        for (Index v = static_cast<Index>(begin); v < static_cast<Index>(end) && !found; ++v)
            if (counts(v) && all_of_neighbours(t, v, counts)) found = true;
    });
    return found;
}

/// Two-colours the vertices that count and are connected with `seed` by others that do; `members` receives them. False at an odd cycle or where they are not
/// the whole component. What counts is inside the surface.
template <class Counts>
bool two_colour(const Topology& t, Index seed, const Counts& counts, std::vector<std::int8_t>& colour, std::vector<Index>& members) {
    bool bipartite = true;
    members.assign(1, seed);
    colour[seed] = 1;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const Index v = members[i];
        all_of_neighbours(t, v, [&](Index other) {
            if (colour[other] == 0 && counts(other)) {
                colour[other] = static_cast<std::int8_t>(-colour[v]);
                members.push_back(other);
            }
            bipartite = bipartite && colour[other] == -colour[v];  // one that does not count has no colour
            return true;
        });
    }
    return bipartite;
}

std::string list(const std::vector<Index>& vertices) {
    std::string out;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, vertices.size()); ++i) out += (i ? ", " : "") + std::to_string(vertices[i]);
    return out + (vertices.size() > 3 ? ", ..." : "");
}

}  // namespace

Objection scheme_objection(const Topology& topology, const SchemeOptions& options) {
    Objection objection;
    if (options.scheme != Scheme::loop) return objection;
    for (Index f = 0; topology.uniform_degree != 3 && f < topology.face_count && objection.faces.size() < 10; ++f)
        if (topology.degree(f) != 3) objection.faces.push_back(f);
    if (!objection.faces.empty())
        objection.message = "face " + std::to_string(objection.faces[0]) + " has " + std::to_string(topology.degree(objection.faces[0])) +
                            " sides, and Loop subdivision takes triangles only: use catmull-clark or doo-sabin, or triangulate the mesh";
    return objection;
}

Objection find_singular_component(const Topology& topology, const Features& features, const SchemeOptions& options, const std::vector<std::uint8_t>& subset) {
    Objection objection;
    if (options.scheme != Scheme::catmull_clark || options.alpha != 0) return objection;
    const auto counts = [&](Index v) {
        return features.kind[v] == VertexKind::smooth && topology.vertex_face_count[v] == 3 && options.lambda_at(v) == 0 && (subset.empty() || subset[v]);
    };
    if (!any_counts_with_neighbours(topology, counts)) return objection;
    std::vector<std::int8_t> colour(topology.vertex_count, 0);
    std::vector<Index> members;
    for (Index v = 0; v < topology.vertex_count; ++v) {
        if (colour[v] != 0 || !counts(v) || !two_colour(topology, v, counts, colour, members)) continue;
        std::sort(members.begin(), members.end());
        objection.message =
            "Catmull-Clark interpolation has no unique solution here, and in general none: the closed component of vertices " + list(members) + " (" +
            std::to_string(members.size()) +
            ") has only valence 3 and no odd cycle of edges, which makes its limit operator singular: use alpha 0.5 (alpha auto does so) or a lambda above 0";
        members.resize(std::min<std::size_t>(10, members.size()));
        objection.vertices = members;
        return objection;
    }
    return objection;
}

}  // namespace lcl
