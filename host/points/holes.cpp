// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/holes.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_set>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "host/mesh/topology.h"
#include "host/points/geometry.h"

namespace lcl {
namespace {

constexpr double no_way = std::numeric_limits<double>::infinity();

class EdgeSet {
public:
    explicit EdgeSet(const Topology& topology) {
        for (Index h = 0; h < topology.half_edge_count(); ++h) edges_.insert(edge_key(topology.origin(h), topology.destination(h)));
    }
    bool holds(Index a, Index b) const { return edges_.count(edge_key(a, b)) != 0; }
    void add(Index a, Index b) { edges_.insert(edge_key(a, b)); }

private:
    std::unordered_set<std::uint64_t> edges_;
};

/// Least area of the polygon loop[i] .. loop[j], for all i < j, and the third corner of the triangle on its side from j to i.
class Triangulation {
public:
    Triangulation(const PolygonMesh& mesh, const Topology& topology, const std::vector<Index>& loop, const EdgeSet& edges)
        : mesh_(mesh), topology_(topology), loop_(loop), size_(loop.size()), area_(size_ * size_, 0.0), third_(size_ * size_, 0) {
        for (std::size_t span = 2; span < size_; ++span)
            for (std::size_t i = 0; i + span < size_; ++i) find(i, i + span, edges);
    }

    bool is_possible() const { return area_[size_ - 1] < no_way; }

    /// body(a, b, c) for every triangle, corners of the loop in its order.
    template <class Body>
    void for_each(const Body& body) const {
        std::vector<std::pair<std::size_t, std::size_t>> stack = {{0, size_ - 1}};
        while (!stack.empty()) {
            const auto [i, j] = stack.back();
            stack.pop_back();
            if (j < i + 2) continue;
            const std::size_t k = third_[i * size_ + j];
            body(loop_[i], loop_[k], loop_[j]);
            stack.emplace_back(i, k);
            stack.emplace_back(k, j);
        }
    }

private:
    void find(std::size_t i, std::size_t j, const EdgeSet& edges) {
        double& least = area_[i * size_ + j];
        least = no_way;
        const bool is_side = i == 0 && j == size_ - 1;  // of the loop itself; any other edge has to be new
        if (!is_side && edges.holds(loop_[i], loop_[j])) return;
        for (std::size_t k = i + 1; k < j; ++k) {
            if (closes_with_two_faces(i, k, j)) continue;
            const double area = area_[i * size_ + k] + area_[k * size_ + j] + triangle(i, k, j);
            if (area < least) least = area, third_[i * size_ + j] = static_cast<std::uint16_t>(k);
        }
    }

    /// Whether the triangle lies on both sides of the loop at a vertex that has just one face, which would then have two all round it: no scheme takes that.
    bool closes_with_two_faces(std::size_t i, std::size_t k, std::size_t j) const {
        const auto has_one_face = [&](std::size_t corner) { return topology_.vertex_face_count[loop_[corner]] == 1; };
        if (k == i + 1 && j == k + 1 && has_one_face(k)) return true;
        if (i != 0 || j != size_ - 1) return false;
        return (k == 1 && has_one_face(i)) || (k + 1 == j && has_one_face(j));
    }

    double triangle(std::size_t i, std::size_t k, std::size_t j) const {
        const auto at = [&](std::size_t corner) { return Eigen::Vector3d::Map(&mesh_.positions[3 * static_cast<std::size_t>(loop_[corner])]); };
        return (at(k) - at(i)).cross(at(j) - at(i)).norm();
    }

    const PolygonMesh& mesh_;
    const Topology& topology_;
    const std::vector<Index>& loop_;
    std::size_t size_;
    std::vector<double> area_;
    std::vector<std::uint16_t> third_;
};

}  // namespace

Index fill_holes(PolygonMesh& mesh, int most_edges) {
    const Topology topology = build_topology(mesh);
    EdgeSet edges(topology);
    Index filled = 0, component_count = 0;
    const std::vector<Index> component = connected_components(topology, component_count);
    std::vector<Index> size(component_count, 0);
    for (const Index part : component)
        if (part >= 0) ++size[part];
    for (const std::vector<Index>& half_edges : boundary_loops(topology)) {
        if (half_edges.size() > static_cast<std::size_t>(most_edges)) continue;
        if (size[component[topology.origin(half_edges.front())]] == static_cast<Index>(half_edges.size())) continue;  // a sheet that would be closed on itself
        std::vector<Index> loop;  // against the half-edges of the boundary: the way that the new triangles go round
        for (auto h = half_edges.rbegin(); h != half_edges.rend(); ++h) loop.push_back(topology.origin(*h));
        const Triangulation triangulation(mesh, topology, loop, edges);
        if (!triangulation.is_possible()) continue;
        ++filled;
        triangulation.for_each([&](Index a, Index b, Index c) {
            mesh.face_vertices.insert(mesh.face_vertices.end(), {a, b, c});
            mesh.face_offsets.push_back(mesh.corner_count());
            edges.add(a, c);
        });
    }
    return filled;
}

}  // namespace lcl
