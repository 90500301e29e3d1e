// SPDX-License-Identifier: BSD-3-Clause
#include "host/two_phase/umbrellas.h"

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "host/mesh/normals.h"
#include "host/parallel.h"

namespace lcl {
namespace {

constexpr double flat_angle = 1e-12;  // radians: what rounding makes of 180 degrees

/// The walk round a vertex that its mask is written for.
struct Fan {
    UmbrellaKind kind = UmbrellaKind::fixed;
    Index faces = 0;
    Index start = 0;   ///< place in the topology's fan of the half-edge to E_0
    Index second = 0;  ///< of a crease
};

bool is_sharp(const Topology& topology, const Features& features, Index h) { return features.edge_is_sharp[topology.half_edge_edge[h]] != 0; }

/// Turns the walk so that it begins at a sharp edge.
void start_at_sharp_edge(const Topology& topology, const Features& features, Index v, Fan& fan) {
    const Index first = topology.fan_offsets[v];
    while (!is_sharp(topology, features, topology.fan_half_edges[first + fan.start])) ++fan.start;
    for (Index j = 1; j < fan.faces; ++j)
        if (is_sharp(topology, features, topology.fan_half_edges[first + (fan.start + j) % fan.faces])) fan.second = j;
}

Fan fan_of(const Topology& topology, const Features& features, Index v) {
    Fan fan;
    if (topology.is_isolated(v)) return fan;
    fan.faces = topology.vertex_face_count[v];
    switch (features.kind[v]) {
        case VertexKind::smooth: fan.kind = UmbrellaKind::smooth; break;
        case VertexKind::curve: fan.kind = topology.is_boundary(v) ? UmbrellaKind::boundary : UmbrellaKind::crease; break;
        case VertexKind::dart: fan.kind = UmbrellaKind::dart; break;
        case VertexKind::corner:
        case VertexKind::isolated: break;
    }
    if (fan.kind == UmbrellaKind::crease || fan.kind == UmbrellaKind::dart) start_at_sharp_edge(topology, features, v, fan);
    return fan;
}

/// Masks by what they depend on, each made once. A `fixed` one is as long as its umbrella, so its faces and boundary tell it apart too.
class MaskTable {
public:
    explicit MaskTable(std::vector<UmbrellaMask>& masks) : masks_(masks) {}

    Index find(const Fan& fan, Index size) {
        const auto [place, is_new] = known_.try_emplace({fan.kind, fan.kind == UmbrellaKind::fixed ? size : fan.faces, fan.second}, 0);
        if (!is_new) return place->second;
        place->second = static_cast<Index>(masks_.size());
        masks_.push_back(umbrella_mask(fan.kind, fan.kind == UmbrellaKind::fixed ? 0 : fan.faces, fan.second));
        masks_.back().weights.resize(size);  // of `fixed`: the vertex alone has a weight
        return place->second;
    }

private:
    std::vector<UmbrellaMask>& masks_;
    std::map<std::tuple<UmbrellaKind, Index, Index>, Index> known_;
};

/// Numbers of M^1: see refine.h.
struct Numbers {
    const Topology& topology;
    Index near_point(Index h) const { return topology.vertex_count + 2 * topology.half_edge_edge[h] + (is_first(h) ? 0 : 1); }
    Index far_point(Index h) const { return topology.vertex_count + 2 * topology.half_edge_edge[h] + (is_first(h) ? 1 : 0); }
    Index face_point(Index h) const { return topology.vertex_count + 2 * topology.edge_count + h; }
    bool is_first(Index h) const { return topology.edge_half_edge[topology.half_edge_edge[h]] == h; }
};

void write_umbrella(const Topology& topology, Index v, const Fan& fan, Index* out) {
    *out++ = v;
    if (fan.faces == 0) return;
    const Numbers number{topology};
    const Index* const half_edges = &topology.fan_half_edges[topology.fan_offsets[v]];
    for (Index j = 0; j < fan.faces; ++j) *out++ = number.near_point(half_edges[(fan.start + j) % fan.faces]);
    if (topology.is_boundary(v)) *out++ = number.far_point(topology.previous(half_edges[fan.faces - 1]));
    for (Index j = 0; j < fan.faces; ++j) *out++ = number.face_point(half_edges[(fan.start + j) % fan.faces]);
}

/// Whether v's row of the umbrella Laplacian counts the other end of h's edge.
bool row_counts(const Topology& topology, const Features& features, Index v, Index h) {
    switch (features.kind[v]) {
        case VertexKind::smooth:
        case VertexKind::dart: return true;
        case VertexKind::curve: return is_sharp(topology, features, h);
        case VertexKind::corner:
        case VertexKind::isolated: break;
    }
    return false;
}

/// Gives the number of neighbours that count.
Index write_fair_row(const Topology& topology, const Features& features, const Array<std::uint32_t>& place_of, Index v, std::uint32_t* out) {
    Index length = 0;
    const auto add = [&](Index h, Index other) {
        const bool counts = row_counts(topology, features, v, h), is_counted = row_counts(topology, features, other, h);
        length += counts;
        *out++ = place_of[other] | (counts ? FairRows::counts : 0u) | (is_counted ? FairRows::is_counted : 0u);
    };
    for (Index i = topology.fan_offsets[v]; i < topology.fan_offsets[v + 1]; ++i) {
        const Index h = topology.fan_half_edges[i];
        add(h, topology.destination(h));
        if (i + 1 == topology.fan_offsets[v + 1] && topology.is_boundary(v)) add(topology.previous(h), topology.origin(topology.previous(h)));
    }
    return length;
}

}  // namespace

Umbrellas build_umbrellas(const Topology& topology, const Features& features) {
    Umbrellas umbrellas;
    umbrellas.count = topology.vertex_count;
    umbrellas.vertex_count = topology.vertex_count + 2 * topology.edge_count + topology.half_edge_count();
    umbrellas.offsets.resize(static_cast<std::size_t>(umbrellas.count) + 1);
    umbrellas.mask_of.resize(umbrellas.count);
    umbrellas.order.resize(umbrellas.vertex_count);
    MaskTable table(umbrellas.masks);
    umbrellas.offsets[0] = 0;
    std::vector<Index> of_smooth;  // most vertices: found without a search
    for (Index v = 0; v < umbrellas.count; ++v) {
        const Index faces = topology.vertex_face_count[v], size = topology.is_isolated(v) ? 1 : 1 + faces + topology.valence(v);
        umbrellas.offsets[v + 1] = umbrellas.offsets[v] + size;
        const bool is_smooth = features.kind[v] == VertexKind::smooth;
        if (is_smooth && static_cast<std::size_t>(faces) >= of_smooth.size()) of_smooth.resize(static_cast<std::size_t>(faces) + 1, -1);
        if (is_smooth && of_smooth[faces] >= 0) {
            umbrellas.mask_of[v] = of_smooth[faces];
            continue;
        }
        umbrellas.mask_of[v] = table.find(fan_of(topology, features, v), size);
        if (is_smooth) of_smooth[faces] = umbrellas.mask_of[v];
    }
    parallel_for(umbrellas.count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            write_umbrella(topology, static_cast<Index>(v), fan_of(topology, features, static_cast<Index>(v)), &umbrellas.order[umbrellas.offsets[v]]);
    });
    return umbrellas;
}

std::string tangent_objection(const Topology& topology, const Features& features, Index v) {
    if (topology.is_isolated(v)) return "it has no face";
    const Index faces = topology.vertex_face_count[v];
    const std::string count = std::to_string(faces);
    switch (features.kind[v]) {
        case VertexKind::smooth: return faces >= 3 ? "" : "it has valence " + count + ", and the masks of the tangents need three faces round it";
        case VertexKind::dart: return "a crease ends there";
        case VertexKind::curve: break;
        case VertexKind::corner:
        case VertexKind::isolated: return "it is a corner, which has no tangent plane of its own";
    }
    if (!topology.is_boundary(v)) return "it lies on a crease, where each side has a tangent plane of its own";
    if (faces >= 2 && faces <= 4) return "";
    return "it lies on the boundary with " + count + (faces == 1 ? " face" : " faces") + ", and the surface has a tangent plane there with 2 to 4 only";
}

std::vector<std::uint8_t> convex_vertices(const Topology& topology, const std::vector<double>& points) {
    Array<Vector> normals(topology.face_count);
    parallel_for(topology.face_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) normals[f] = newell_normal(topology, static_cast<Index>(f), points);
    });
    const auto length = [](const Vector& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); };
    std::vector<std::uint8_t> convex(topology.vertex_count, 1);
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index h = topology.edge_half_edge[e], twin = topology.twin[h];
        if (twin < 0) continue;
        const Index a = topology.origin(h), b = topology.destination(h);
        const Vector &m = normals[topology.half_edge_face[h]], &n = normals[topology.half_edge_face[twin]];
        double turn = 0;
        Vector along{};
        for (std::size_t c = 0; c < 3; ++c) along[c] = points[3 * static_cast<std::size_t>(b) + c] - points[3 * static_cast<std::size_t>(a) + c];
        for (std::size_t c = 0; c < 3; ++c) turn += (m[(c + 1) % 3] * n[(c + 2) % 3] - m[(c + 2) % 3] * n[(c + 1) % 3]) * along[c];
        if (turn > flat_angle * length(m) * length(n) * length(along)) continue;
        convex[a] = convex[b] = 0;
    }
    for (Index v = 0; v < topology.vertex_count; ++v)
        if (topology.is_isolated(v)) convex[v] = 0;
    return convex;
}

FairRows build_fair_rows(const Umbrellas& umbrellas, const Topology& topology, const Features& features) {
    const auto vertices = static_cast<std::size_t>(topology.vertex_count);
    if (vertices > FairRows::place)
        throw OutOfMemory("the refined mesh has " + std::to_string(vertices) + " vertices, and fairness can number 1073741823: take a smaller mesh");
    FairRows rows;
    Array<std::uint32_t> place_of(vertices);
    rows.offsets.resize(vertices + 1);
    std::size_t entries = 0;
    for (std::size_t i = 0; i < vertices; ++i) {
        const Index v = umbrellas.order[i];
        place_of[v] = static_cast<std::uint32_t>(i);
        entries += topology.is_isolated(v) ? 0 : topology.valence(v);
        if (entries > std::numeric_limits<std::uint32_t>::max())
            throw OutOfMemory("the refined mesh has more than 4294967295 neighbours, which fairness cannot number: take a smaller mesh");
        rows.offsets[i + 1] = static_cast<std::uint32_t>(entries);
    }
    rows.neighbours.resize(entries);
    rows.lengths.resize(vertices);
    parallel_for(vertices, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            rows.lengths[i] = write_fair_row(topology, features, place_of, umbrellas.order[i], rows.neighbours.data() + rows.offsets[i]);
    });
    return rows;
}

}  // namespace lcl
