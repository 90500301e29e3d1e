// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/topology.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>
#include <utility>

#include "host/counting_sort.h"
#include "host/mesh/box.h"
#include "host/mesh/face_walk.h"
#include "host/mesh/soundness.h"
#include "host/prefetch.h"

namespace lcl {
namespace {

constexpr std::size_t index_limit = std::numeric_limits<Index>::max();

void refuse_too_many(std::size_t count, const char* what) {
    if (count <= index_limit) return;
    throw OutOfMemory("the mesh has " + std::to_string(count) + " " + what + ", more than the " + std::to_string(index_limit) +
                      " that 32-bit indices can number: split the mesh");
}

constexpr std::size_t most_count_arrays = 8;  // of a number a vertex each

/// The degree of all faces, 0 where they differ.
Index common_degree(const PolygonMesh& mesh) {
    if (mesh.face_count() == 0) return 0;
    const Index degree = mesh.degree(0);
    std::atomic<bool> differs{false};
    parallel_for(mesh.face_count(), [&](std::size_t begin, std::size_t end) {
        bool all = true;
        for (std::size_t f = begin; f < end; ++f) all &= mesh.face_offsets[f + 1] - mesh.face_offsets[f] == degree;
        if (!all) differs = true;
    });
    return differs ? 0 : degree;
}

void set_faces(const PolygonMesh& mesh, Topology& topology) {
    topology.vertex_count = mesh.vertex_count;
    topology.face_count = mesh.face_count();
    topology.uniform_degree = common_degree(mesh);
    topology.face_offsets.resize(mesh.face_offsets.size());
    topology.face_vertices.resize(mesh.face_vertices.size());
    topology.half_edge_face.resize(mesh.face_vertices.size());
    topology.face_offsets[0] = 0;
    parallel_for(mesh.face_count(), [&](std::size_t begin, std::size_t end) {
        const Index first = mesh.face_offsets[begin], last = mesh.face_offsets[end];
        std::copy(mesh.face_offsets.begin() + begin + 1, mesh.face_offsets.begin() + end + 1, topology.face_offsets.begin() + begin + 1);
        std::copy(mesh.face_vertices.begin() + first, mesh.face_vertices.begin() + last, topology.face_vertices.begin() + first);
        for (std::size_t f = begin; f < end; ++f)
            for (Index h = mesh.face_offsets[f]; h < mesh.face_offsets[f + 1]; ++h) topology.half_edge_face[h] = static_cast<Index>(f);
    });
}

/// The outgoing half-edges of every vertex, ascending, by a counting sort.
void collect_fans(Topology& topology) {
    const std::size_t vertices = topology.vertex_count, corners = topology.face_vertices.size();
    const std::size_t pieces = std::min(piece_count(corners), most_count_arrays);
    Array<Index> places(pieces * vertices);
    for_each_piece(corners, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index* const counts = places.data() + piece * vertices;
        std::fill_n(counts, vertices, 0);
        for (std::size_t h = begin; h < end; ++h) ++counts[topology.face_vertices[h]];
    });
    topology.fan_offsets.resize(vertices + 1);
    counts_to_places(places, vertices, pieces, topology.fan_offsets.data());
    topology.fan_half_edges.resize(corners);
    for_each_piece(corners, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index* const place = places.data() + piece * vertices;
        for (std::size_t h = begin; h < end; ++h) topology.fan_half_edges[place[topology.face_vertices[h]]++] = static_cast<Index>(h);
    });
}

/// Brings the corners of a vertex inside the surface into face order, from the first one on: each is followed by the corner whose half-edge is the twin of the
/// one that comes in before it. False, and the fan as it was, where that does not lead round through all n of them.
template <int n, class Walk>
bool order_closed_fan(const Walk& walk, const Index* vertices, Index* fan, Index* twin) {
    Index incoming[n], origin[n], destination[n], ordered[n];
    for (int i = 0; i < n; ++i) {
        incoming[i] = walk.previous(fan[i]);
        origin[i] = vertices[incoming[i]];
        destination[i] = vertices[walk.next(fan[i])];
    }
    int at = 0;
    unsigned met = 0;
    for (int step = 0; step < n; ++step) {
        int following = n;
        for (int i = 0; i < n; ++i) following = destination[i] == origin[at] ? i : following;
        if (following == n) return false;
        ordered[step] = fan[at];
        twin[incoming[at]] = fan[following];
        met |= 1u << at;
        at = following;
    }
    if (at != 0 || met != (1u << n) - 1) return false;
    std::copy_n(ordered, n, fan);
    return true;
}

template <class Walk>
bool order_small_closed_fan(int size, const Walk& walk, const Index* vertices, Index* fan, Index* twin) {
    switch (size) {
        case 3: return order_closed_fan<3>(walk, vertices, fan, twin);
        case 4: return order_closed_fan<4>(walk, vertices, fan, twin);
        case 5: return order_closed_fan<5>(walk, vertices, fan, twin);
        case 6: return order_closed_fan<6>(walk, vertices, fan, twin);
        case 7: return order_closed_fan<7>(walk, vertices, fan, twin);
        case 8: return order_closed_fan<8>(walk, vertices, fan, twin);
        default: return false;
    }
}

/// The same for any fan, open ones at a boundary among them, in linear time also at a pole.
template <class Walk>
class FanOrder {
public:
    FanOrder(const Walk& walk, Topology& topology) : walk_(walk), topology_(topology) {}

    enum class Kind { closed, open, broken };

    /// broken: an edge with more than two faces, or two that run the same way, or more than one fan.
    Kind order(Index v) {
        fan_ = topology_.fan_half_edges.data() + topology_.fan_offsets[v];
        size_ = topology_.fan_offsets[v + 1] - topology_.fan_offsets[v];
        if (!look_up_destinations()) return Kind::broken;
        link();
        const auto begin = std::find(is_followed_.begin(), is_followed_.end(), 0);
        const Index first = begin == is_followed_.end() ? 0 : static_cast<Index>(begin - is_followed_.begin());
        ordered_.clear();
        Index at = first;
        do {
            ordered_.push_back(fan_[at]);
            at = following_[at];
        } while (at >= 0 && at != first && static_cast<Index>(ordered_.size()) < size_);
        if (static_cast<Index>(ordered_.size()) != size_ || (at >= 0 && at != first)) return Kind::broken;
        std::copy(ordered_.begin(), ordered_.end(), fan_);
        return at < 0 ? Kind::open : Kind::closed;
    }

private:
    /// False where two half-edges lead to one vertex.
    bool look_up_destinations() {
        if (corner_to_.empty()) corner_to_.assign(topology_.vertex_count, 0);
        destination_.resize(size_);
        for (Index i = 0; i < size_; ++i) destination_[i] = topology_.face_vertices[walk_.next(fan_[i])];
        for (Index i = 0; i < size_; ++i) {
            const Index other = corner_to(destination_[i]);
            if (other >= 0 && other != i) return false;
            corner_to_[destination_[i]] = i;
        }
        return true;
    }

    /// The corner whose half-edge leads to a vertex, or -1. What other vertices left in the table does not stand the check.
    Index corner_to(Index vertex) const {
        const Index i = corner_to_[vertex];
        return i < size_ && destination_[i] == vertex ? i : -1;
    }

    /// Sets the twins of the half-edges that come in, and finds out which corner follows each.
    void link() {
        following_.resize(size_);
        is_followed_.assign(size_, 0);
        for (Index i = 0; i < size_; ++i) {
            const Index incoming = walk_.previous(fan_[i]);
            following_[i] = corner_to(topology_.face_vertices[incoming]);
            topology_.twin[incoming] = following_[i] < 0 ? -1 : fan_[following_[i]];
            if (following_[i] >= 0) is_followed_[following_[i]] = 1;
        }
    }

    const Walk& walk_;
    Topology& topology_;
    Index* fan_ = nullptr;
    Index size_ = 0;
    std::vector<Index> corner_to_, destination_, following_, ordered_;
    std::vector<char> is_followed_;
};

constexpr Index fans_ahead = 40;  // corners

/// Starts to load what ordering the fans of `count` corners needs.
void prefetch_fan(const Topology& topology, Index first, Index count) {
    const Index end = std::min(first + count, topology.half_edge_count());
    for (Index i = first; i < end; ++i) {
        const Index h = topology.fan_half_edges[i];
        prefetch(&topology.face_vertices[h]);
        prefetch_for_writing(&topology.twin[h]);
    }
}

/// Orders the fan of each vertex and finds all twins on the way. False where the mesh is no consistently oriented manifold.
template <class Walk>
bool order_fans(const Walk& walk, Topology& topology) {
    using Kind = typename FanOrder<Walk>::Kind;
    const std::size_t pieces = piece_count(topology.vertex_count);
    std::vector<Index> open(pieces, 0);
    std::atomic<bool> is_broken{false};
    for_each_piece(topology.vertex_count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        FanOrder<Walk> any(walk, topology);
        Index open_here = 0;
        for (std::size_t v = begin; v < end; ++v) {
            Index* const fan = topology.fan_half_edges.data() + topology.fan_offsets[v];
            const Index size = topology.fan_offsets[v + 1] - topology.fan_offsets[v];
            prefetch_fan(topology, topology.fan_offsets[v] + fans_ahead, size);
            if (size > 0 && !order_small_closed_fan(size, walk, topology.face_vertices.data(), fan, topology.twin.data())) {
                const Kind kind = any.order(static_cast<Index>(v));
                if (kind == Kind::broken) return void(is_broken = true);
                open_here += kind == Kind::open;
            }
            topology.vertex_half_edge[v] = size > 0 ? *fan : -1;
            topology.vertex_face_count[v] = size;
        }
        open[piece] = open_here;
    });
    topology.boundary_edge_count = std::accumulate(open.begin(), open.end(), Index{0});
    return !is_broken;
}

/// Numbers edges by their first half-edge.
void number_edges(Topology& topology) {
    const std::size_t half_edges = topology.face_vertices.size(), pieces = piece_count(half_edges);
    const auto is_first = [&](std::size_t h) { return topology.twin[h] < 0 || topology.twin[h] > static_cast<Index>(h); };
    std::vector<Index> first_edge(pieces + 1, 0);
    for_each_piece(half_edges, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index count = 0;
        for (std::size_t h = begin; h < end; ++h) count += is_first(h);
        first_edge[piece + 1] = count;
    });
    std::partial_sum(first_edge.begin(), first_edge.end(), first_edge.begin());
    topology.edge_count = first_edge[pieces];
    topology.edge_half_edge.resize(topology.edge_count);
    topology.half_edge_edge.resize(half_edges);
    for_each_piece(half_edges, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Index edge = first_edge[piece];
        for (std::size_t h = begin; h < end; ++h) {
            if (!is_first(h)) continue;
            topology.edge_half_edge[edge] = static_cast<Index>(h);
            topology.half_edge_edge[h] = edge;
            if (topology.twin[h] >= 0) topology.half_edge_edge[topology.twin[h]] = edge;
            ++edge;
        }
    });
}

/// Root of v in a forest of parents that never exceed their children; halves the path on the way.
Index find_root(std::vector<Index>& parent, Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

}  // namespace

bool connect(const PolygonMesh& mesh, Topology& topology) {
    set_faces(mesh, topology);
    collect_fans(topology);
    topology.twin.resize(topology.face_vertices.size());
    topology.vertex_half_edge.resize(topology.vertex_count);
    topology.vertex_face_count.resize(topology.vertex_count);
    const bool is_manifold = with_face_walk(topology, [&](const auto& walk) { return order_fans(walk, topology); });
    if (is_manifold) number_edges(topology);
    return is_manifold;
}

std::optional<Topology> topology_if_sound(const PolygonMesh& mesh) {
    if (mesh.face_count() == 0 || mesh.face_vertices.size() > index_limit) return std::nullopt;
    std::optional<Topology> topology(std::in_place);
    if (!corners_are_sound(mesh) || !positions_are_finite(mesh) || !connect(mesh, *topology)) return std::nullopt;
    return topology;
}

Topology build_topology(const PolygonMesh& mesh) {
    refuse_too_many(mesh.face_vertices.size(), "face corners");
    refuse_too_many(mesh.face_offsets.size() - 1, "faces");
    if (mesh.face_count() == 0) throw BadInput("the mesh has no faces: a surface needs at least one");
    if (std::optional<Topology> topology = topology_if_sound(mesh)) return std::move(*topology);
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
    return box_of_points(mesh.positions, mesh.face_vertices.size(),
                         [&](std::size_t corner) {
                             const Index v = mesh.face_vertices[corner];
                             return v < mesh.vertex_count ? v : -1;
                         })
        .diagonal();
}

double bounding_box_diagonal(const PolygonMesh& mesh, const Topology& topology) {
    return box_of_points(mesh.positions, topology.vertex_count, [&](std::size_t v) { return topology.vertex_half_edge[v] < 0 ? -1 : static_cast<Index>(v); })
        .diagonal();
}

}  // namespace lcl
