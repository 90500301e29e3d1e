// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the two-phase scheme share: umbrellas subdivided by the oracle, and limit normals by deep subdivision.
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include <Eigen/Dense>

#include "tests/oracle/limit.h"
#include "tests/oracle/subdivide.h"

namespace two_phase_test {

/// Faces round vertex 0, [0, E_j, F_j, E_(j + 1)] with E_j = 1 + j and F_j behind all edges: all round, or with an open sector.
inline oracle::Surface umbrella(int faces, bool is_closed, const std::vector<int>& sharp_edges) {
    const int edges = is_closed ? faces : faces + 1;
    oracle::Surface surface;
    surface.vertex_count = 1 + edges + faces;
    for (int j = 0; j < faces; ++j) surface.faces.push_back({0, 1 + j, 1 + edges + j, 1 + (j + 1) % edges});
    for (const int j : sharp_edges) surface.sharp.insert(oracle::edge_of(0, 1 + j));
    return surface;
}

/// Number of the edge point of every edge in the next refinement.
inline std::map<oracle::Edge, int> edge_points(const oracle::Surface& surface) {
    std::map<oracle::Edge, int> points;
    for (const std::vector<int>& face : surface.faces)
        for (std::size_t i = 0; i < face.size(); ++i)
            points.emplace(oracle::edge_of(face[i], face[(i + 1) % face.size()]), surface.vertex_count + static_cast<int>(points.size()));
    return points;
}

/// The umbrella of vertex 0 after one refinement over that before, both in the order V, E, F.
inline Eigen::MatrixXd umbrella_step(const oracle::Surface& surface) {
    const oracle::Step step = oracle::subdivide(surface, {});
    const std::map<oracle::Edge, int> points = edge_points(surface);
    const int faces = static_cast<int>(surface.faces.size()), edges = surface.vertex_count - 1 - faces;
    Eigen::MatrixXd matrix(surface.vertex_count, surface.vertex_count);
    matrix.row(0) = step.weights.row(0);
    for (int j = 0; j < edges; ++j) matrix.row(1 + j) = step.weights.row(points.at(oracle::edge_of(0, 1 + j)));
    for (int j = 0; j < faces; ++j) matrix.row(1 + edges + j) = step.weights.row(surface.vertex_count + static_cast<int>(points.size()) + j);
    return matrix;
}

/// The fan of quads round a vertex: points V, E_0 .., F_0 .. in face order; at a boundary from its first edge on.
struct Fan {
    int faces = 0, edges = 0;
    std::vector<int> vertices;
};

inline Fan fan_of(const std::vector<std::vector<int>>& faces, int v) {
    std::map<int, std::vector<int>> from_edge;  // E_j -> {F_j, E_(j + 1)}
    std::map<int, bool> is_second;
    for (const std::vector<int>& face : faces) {
        const auto at = std::find(face.begin(), face.end(), v);
        if (at == face.end() || face.size() != 4) continue;
        const std::size_t i = static_cast<std::size_t>(at - face.begin());
        from_edge[face[(i + 1) % 4]] = {face[(i + 2) % 4], face[(i + 3) % 4]};
        is_second[face[(i + 3) % 4]] = true;
    }
    Fan fan;
    int edge = from_edge.begin()->first;
    for (const auto& entry : from_edge)
        if (!is_second[entry.first]) edge = entry.first;
    std::vector<int> edges, corners;
    while (from_edge.count(edge) && (edges.empty() || edge != edges.front())) {
        edges.push_back(edge);
        corners.push_back(from_edge[edge][0]);
        edge = from_edge[edge][1];
    }
    if (edge != edges.front()) edges.push_back(edge);
    fan.faces = static_cast<int>(corners.size());
    fan.edges = static_cast<int>(edges.size());
    fan.vertices = {v};
    fan.vertices.insert(fan.vertices.end(), edges.begin(), edges.end());
    fan.vertices.insert(fan.vertices.end(), corners.begin(), corners.end());
    return fan;
}

/// Unit limit normal at a smooth or boundary vertex of a mesh whose faces round it are quads, by refining its umbrella `levels` times with the oracle's
/// weights. limit: its limit point, from which differences are taken, so that a ring shrinks without losing digits. All round: the area vector of the ring, in
/// which bends of first order cancel; at a boundary with 2 or 3 faces: curve tangent x direction inwards.
inline Eigen::Vector3d deep_normal(const oracle::Surface& surface, const Eigen::MatrixXd& points, int v, const Eigen::Vector3d& limit, int levels) {
    const Fan fan = fan_of(surface.faces, v);
    const bool is_closed = fan.faces == fan.edges;
    const Eigen::MatrixXd step = umbrella_step(umbrella(fan.faces, is_closed, is_closed ? std::vector<int>{} : std::vector<int>{0, fan.edges - 1}));
    Eigen::MatrixXd ring(fan.vertices.size(), 3);
    for (std::size_t k = 0; k < fan.vertices.size(); ++k) ring.row(k) = points.row(fan.vertices[k]) - limit.transpose();
    for (int level = 0; level < levels; ++level) ring = step * ring;
    const auto edge = [&](int j) -> Eigen::Vector3d { return ring.row(1 + j); };
    if (!is_closed) {
        const Eigen::Vector3d inwards = edge(1) + edge(fan.edges - 2) - 2 * Eigen::Vector3d(ring.row(0));
        return (edge(0) - edge(fan.edges - 1)).cross(inwards).normalized();
    }
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (int j = 0; j < fan.edges; ++j) area += edge(j).cross(edge((j + 1) % fan.edges));
    return area.normalized();
}

inline double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace two_phase_test
