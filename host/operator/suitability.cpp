// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/suitability.h"

#include <algorithm>

namespace lcl {
namespace {

/// Two-colours the component of `seed` along its edges; false at an odd cycle. `members` receives the component, true or not.
bool two_colour(const Topology& t, Index seed, std::vector<std::int8_t>& colour, std::vector<Index>& members) {
    bool bipartite = true;
    members.assign(1, seed);
    colour[seed] = 1;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const Index v = members[i];
        Index h = t.vertex_half_edge[v];
        for (Index k = 0; k < t.vertex_face_count[v]; ++k, h = t.rotate(h))
            for (const Index other : {t.destination(h), t.origin(t.previous(h))}) {
                if (colour[other] == 0) {
                    colour[other] = static_cast<std::int8_t>(-colour[v]);
                    members.push_back(other);
                }
                bipartite = bipartite && colour[other] == -colour[v];
            }
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
    for (Index f = 0; f < topology.face_count && objection.faces.size() < 10; ++f)
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
    std::vector<std::int8_t> colour(topology.vertex_count, 0);
    std::vector<Index> members;
    for (Index v = 0; v < topology.vertex_count; ++v) {
        if (colour[v] != 0 || topology.is_isolated(v)) continue;
        const bool bipartite = two_colour(topology, v, colour, members);
        if (!bipartite || !std::all_of(members.begin(), members.end(), counts)) continue;
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
