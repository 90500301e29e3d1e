// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/normals.h"

#include <cmath>

#include "host/parallel.h"

namespace lcl {

Vector newell_normal(const PolygonMesh& mesh, const std::vector<double>& positions, Index f) {
    const auto point = [&](Index h) { return &positions[3 * static_cast<std::size_t>(mesh.face_vertices[h])]; };
    const Index begin = mesh.face_offsets[f], end = mesh.face_offsets[f + 1];
    const double* origin = point(begin);  // differences first: faces far from the origin of space keep their digits
    Vector normal{0, 0, 0};
    for (Index h = begin + 1; h + 1 < end; ++h) {
        const double *p = point(h), *q = point(h + 1);
        for (int c = 0; c < 3; ++c) {
            const int i = (c + 1) % 3, j = (c + 2) % 3;
            normal[c] += (p[i] - origin[i]) * (q[j] - origin[j]) - (p[j] - origin[j]) * (q[i] - origin[i]);
        }
    }
    return normal;
}

double angle_between(const Vector& a, const Vector& b) {
    double dot = 0, cross = 0;
    for (int c = 0; c < 3; ++c) {
        const int i = (c + 1) % 3, j = (c + 2) % 3;
        dot += a[c] * b[c];
        cross = std::hypot(cross, a[i] * b[j] - a[j] * b[i]);
    }
    return std::atan2(cross, dot);
}

std::vector<Vector> vertex_normals(const PolygonMesh& mesh, const Topology& topology, const std::vector<double>& positions) {
    std::vector<Vector> faces(topology.face_count), normals(topology.vertex_count, Vector{0, 0, 0});
    parallel_for(topology.face_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) faces[f] = newell_normal(mesh, positions, static_cast<Index>(f));
    });
    parallel_for(topology.vertex_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            Vector& normal = normals[v];
            for (Index i = topology.fan_offsets[v]; i < topology.fan_offsets[v + 1]; ++i)
                for (int c = 0; c < 3; ++c) normal[c] += faces[topology.half_edge_face[topology.fan_half_edges[i]]][c];
            const double length = std::hypot(normal[0], normal[1], normal[2]);
            for (double& component : normal) component = length > 0 ? component / length : 0;
        }
    });
    return normals;
}

}  // namespace lcl
