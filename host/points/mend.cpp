// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/mend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Dense>

#include "host/mesh/topology.h"
#include "host/points/geometry.h"

namespace lcl {
namespace {

using Triangle = std::array<Index, 3>;

/// A side of a triangle: half-edge 3 t + k runs from corner k of triangle t to the next one.
struct Side {
    std::uint64_t edge;  ///< its two vertices, the smaller one first
    Index half_edge;
};

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) sides.push_back({edge_key(triangles[t][k], triangles[t][(k + 1) % 3]), static_cast<Index>(3 * t) + k});
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge != b.edge ? a.edge < b.edge : a.half_edge < b.half_edge; });
    return sides;
}

void check(const RawTriangles& raw, const std::string& engine) {
    const auto vertices = static_cast<Index>(raw.points.size() / 3);
    for (std::size_t i = 0; i < raw.triangles.size(); ++i)
        if (raw.triangles[i] < 0 || raw.triangles[i] >= vertices)
            throw Error("engine " + engine + " is defective: triangle " + std::to_string(i / 3) + " uses vertex " + std::to_string(raw.triangles[i]) +
                        ", there are " + std::to_string(vertices));
    for (std::size_t i = 0; i < raw.points.size(); ++i)
        if (!std::isfinite(raw.points[i])) throw Error("engine " + engine + " is defective: vertex " + std::to_string(i / 3) + " is not finite");
}

/// Triangles of three different vertices, each set of three once.
std::vector<Triangle> proper_triangles(const std::vector<Index>& corners) {
    std::vector<std::pair<Triangle, std::size_t>> sets;
    for (std::size_t t = 0; t < corners.size() / 3; ++t) {
        Triangle set{corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]};
        std::sort(set.begin(), set.end());
        if (set[0] != set[1] && set[1] != set[2]) sets.emplace_back(set, t);
    }
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.first == b.first; }), sets.end());
    std::sort(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    std::vector<Triangle> triangles;
    for (const auto& [set, t] : sets) triangles.push_back({corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]});
    return triangles;
}

template <class Drop>
void erase_marked(std::vector<Triangle>& triangles, const Drop& is_dropped) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (!is_dropped(t)) triangles[kept++] = triangles[t];
    triangles.resize(kept);
}

/// Drops triangles, the later ones first to go, until no edge has more than two.
void drop_third_triangles(std::vector<Triangle>& triangles) {
    const std::vector<Side> sides = sorted_sides(triangles);
    std::vector<Index> edge_of(3 * triangles.size());
    Index edges = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        edges += i > 0 && sides[i].edge != sides[i - 1].edge;
        edge_of[sides[i].half_edge] = edges;
    }
    std::vector<std::uint8_t> count(static_cast<std::size_t>(edges) + 1, 0);
    erase_marked(triangles, [&](std::size_t t) {
        for (std::size_t k = 0; k < 3; ++k)
            if (count[edge_of[3 * t + k]] == 2) return true;
        for (std::size_t k = 0; k < 3; ++k) ++count[edge_of[3 * t + k]];
        return false;
    });
}

/// The half-edge across each, -1 at a boundary; no edge has more than two.
std::vector<Index> twins_of(const std::vector<Triangle>& triangles) {
    const std::vector<Side> sides = sorted_sides(triangles);
    std::vector<Index> twins(3 * triangles.size(), -1);
    for (std::size_t i = 1; i < sides.size(); ++i)
        if (sides[i].edge == sides[i - 1].edge) {
            twins[sides[i].half_edge] = sides[i - 1].half_edge;
            twins[sides[i - 1].half_edge] = sides[i].half_edge;
        }
    return twins;
}

bool run_alike(const std::vector<Triangle>& triangles, Index h, Index other) { return triangles[h / 3][h % 3] == triangles[other / 3][other % 3]; }

/// Orients the neighbours of every first triangle as it is oriented, and so on. Where a one-sided surface closes on itself, the later triangle goes.
void orient_alike(std::vector<Triangle>& triangles) {
    const std::vector<Index> twins = twins_of(triangles);
    std::vector<std::uint8_t> state(triangles.size(), 0);  // 1: seen, 2: seen and turned
    const auto is_alike = [&](Index h, Index other) {
        return run_alike(triangles, h, other) != (state[h / 3] != state[other / 3]);  // both in their first orientation: alike is wrong
    };
    std::vector<Index> stack;
    for (std::size_t first = 0; first < triangles.size(); ++first) {
        if (state[first] != 0) continue;
        state[first] = 1;
        stack.push_back(static_cast<Index>(first));
        while (!stack.empty()) {
            const Index t = stack.back();
            stack.pop_back();
            for (Index h = 3 * t; h < 3 * t + 3; ++h) {
                const Index other = twins[h];
                if (other < 0 || state[other / 3] != 0) continue;
                state[other / 3] = state[t];
                if (is_alike(h, other)) state[other / 3] = static_cast<std::uint8_t>(3 - state[t]);
                stack.push_back(other / 3);
            }
        }
    }
    std::vector<std::uint8_t> dropped(triangles.size(), 0);
    for (std::size_t h = 0; h < twins.size(); ++h) {
        const Index other = twins[h], here = static_cast<Index>(h);
        if (other > here && !dropped[h / 3] && is_alike(here, other)) dropped[other / 3] = 1;
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (state[t] == 2) std::swap(triangles[t][1], triangles[t][2]);
    erase_marked(triangles, [&](std::size_t t) { return dropped[t] != 0; });
}

/// Numbers the corners of each fan of triangles round a vertex: twins have to run against each other. Returns the fan of every corner, and how many there are.
std::vector<Index> number_fans(const std::vector<Triangle>& triangles, const std::vector<Index>& twins, Index& fan_count) {
    std::vector<Index> fan(3 * triangles.size(), -1);
    const auto next = [](Index h) { return h % 3 == 2 ? h - 2 : h + 1; };
    const auto previous = [](Index h) { return h % 3 == 0 ? h + 2 : h - 1; };
    fan_count = 0;
    for (std::size_t start = 0; start < fan.size(); ++start) {
        if (fan[start] >= 0) continue;
        Index h = static_cast<Index>(start);
        for (; h >= 0 && fan[h] < 0; h = twins[previous(h)]) fan[h] = fan_count;
        for (h = twins[start]; h >= 0 && fan[next(h)] < 0; h = twins[next(h)]) fan[next(h)] = fan_count;
        ++fan_count;
    }
    return fan;
}

MendedMesh numbered_by_fans(const RawTriangles& raw, const std::vector<Triangle>& triangles) {
    MendedMesh out;
    Index fan_count = 0;
    const std::vector<Index> fan = number_fans(triangles, twins_of(triangles), fan_count);
    std::vector<Index> vertex_of_fan(static_cast<std::size_t>(fan_count));
    for (std::size_t c = 0; c < fan.size(); ++c) vertex_of_fan[fan[c]] = triangles[c / 3][c % 3];
    // Vertices keep the engine's order; the fans of one vertex follow each other.
    std::vector<Index> order(vertex_of_fan.size()), number(vertex_of_fan.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return vertex_of_fan[a] < vertex_of_fan[b]; });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Index vertex = vertex_of_fan[order[i]];
        number[order[i]] = static_cast<Index>(i);
        out.split_vertices += !out.source.empty() && out.source.back() == vertex;
        out.source.push_back(vertex);
        out.mesh.positions.insert(out.mesh.positions.end(), &raw.points[3 * static_cast<std::size_t>(vertex)],
                                  &raw.points[3 * static_cast<std::size_t>(vertex)] + 3);
    }
    out.mesh.vertex_count = fan_count;
    for (std::size_t c = 0; c < fan.size(); ++c) {
        out.mesh.face_vertices.push_back(number[fan[c]]);
        if (c % 3 == 2) out.mesh.face_offsets.push_back(static_cast<Index>(c) + 1);
    }
    return out;
}

Eigen::Vector3d point(const std::vector<double>& values, Index v) { return Eigen::Vector3d::Map(&values[3 * static_cast<std::size_t>(v)]); }

}  // namespace

MendedMesh mend(const RawTriangles& raw, const std::string& engine) {
    check(raw, engine);
    std::vector<Triangle> triangles = proper_triangles(raw.triangles);
    drop_third_triangles(triangles);
    orient_alike(triangles);
    MendedMesh out = numbered_by_fans(raw, triangles);
    out.dropped_faces = static_cast<Index>(raw.triangles.size() / 3 - triangles.size());
    return out;
}

void orient(PolygonMesh& mesh, const std::vector<double>& normals) {
    const Topology topology = build_topology(mesh);
    Index count = 0;
    const std::vector<Index> component = connected_components(topology, count);
    std::vector<Eigen::Vector3d> centre(count, Eigen::Vector3d::Zero());
    std::vector<Index> size(count, 0);
    std::vector<std::uint8_t> is_open(count, 0);
    for (Index v = 0; v < mesh.vertex_count; ++v) {
        centre[component[v]] += point(mesh.positions, v);
        ++size[component[v]];
        if (topology.is_boundary(v)) is_open[component[v]] = 1;
    }
    for (Index i = 0; i < count; ++i) centre[i] /= size[i];
    std::vector<double> agreement(count, 0.0);
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const Index* const corners = &mesh.face_vertices[3 * static_cast<std::size_t>(f)];
        const Index part = component[corners[0]];
        const Eigen::Vector3d a = point(mesh.positions, corners[0]), b = point(mesh.positions, corners[1]), c = point(mesh.positions, corners[2]);
        const Eigen::Vector3d area = (b - a).cross(c - a);
        const bool by_normals = is_open[part] && !normals.empty();
        agreement[part] += area.dot(by_normals ? Eigen::Vector3d(point(normals, corners[0]) + point(normals, corners[1]) + point(normals, corners[2]))
                                               : Eigen::Vector3d(a - centre[part]));
    }
    for (Index f = 0; f < mesh.face_count(); ++f) {
        Index* const corners = &mesh.face_vertices[3 * static_cast<std::size_t>(f)];
        if (agreement[component[corners[0]]] < 0) std::swap(corners[1], corners[2]);
    }
}

}  // namespace lcl
