// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/normals.h"

#include <cmath>

#include "host/parallel.h"

namespace lcl {

Vector newell_normal(const Topology& topology, Index face, const std::vector<double>& points) {
    const auto point = [&](Index h) { return &points[3 * static_cast<std::size_t>(topology.face_vertices[h])]; };
    const Index begin = topology.face_offsets[face], end = topology.face_offsets[face + 1];
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

Array<Vector> vertex_normals(const Topology& topology, const std::vector<double>& points) {
    Array<Vector> faces(topology.face_count), normals(topology.vertex_count);
    parallel_for(topology.face_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) faces[f] = newell_normal(topology, static_cast<Index>(f), points);
    });
    parallel_for(topology.vertex_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            Vector sum{0, 0, 0};
            for (Index i = topology.fan_offsets[v]; i < topology.fan_offsets[v + 1]; ++i)
                for (int c = 0; c < 3; ++c) sum[c] += faces[topology.half_edge_face[topology.fan_half_edges[i]]][c];
            normals[v] = sum;
        }
    });
    return normals;
}

}  // namespace lcl
