// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/fit_mesh.h"

#include <string>

namespace lcl {

FitMesh fit_mesh(const PolygonMesh& mesh, const std::vector<Index>& source) {
    FitMesh out;
    out.reserve(static_cast<std::size_t>(mesh.vertex_count), static_cast<std::size_t>(mesh.vertex_count) + mesh.face_count(), mesh.face_count());
    for (Index v = 0; v < mesh.vertex_count; ++v) {
        const double* const point = &mesh.positions[3 * static_cast<std::size_t>(v)];
        const OpenMesh::VertexHandle vertex = out.add_vertex(FitMesh::Point(point[0], point[1], point[2]));
        if (!source.empty()) out.data(vertex).source = source[v];
    }
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const Index* const corners = &mesh.face_vertices[3 * static_cast<std::size_t>(f)];
        const OpenMesh::FaceHandle face = out.add_face(out.vertex_handle(corners[0]), out.vertex_handle(corners[1]), out.vertex_handle(corners[2]));
        if (!face.is_valid()) throw Error("face " + std::to_string(f) + " of a mended mesh cannot be linked");
    }
    return out;
}

PolygonMesh polygon_mesh(const FitMesh& mesh) {
    PolygonMesh out;
    out.vertex_count = static_cast<Index>(mesh.n_vertices());
    out.positions.reserve(3 * mesh.n_vertices());
    out.face_vertices.reserve(3 * mesh.n_faces());
    for (const OpenMesh::VertexHandle vertex : mesh.all_vertices()) {
        const FitMesh::Point& point = mesh.point(vertex);
        out.positions.insert(out.positions.end(), {point[0], point[1], point[2]});
    }
    for (const OpenMesh::FaceHandle face : mesh.all_faces()) {
        for (FitMesh::ConstFaceVertexIter corner = mesh.cfv_iter(face); corner.is_valid(); ++corner) out.face_vertices.push_back(corner->idx());
        out.face_offsets.push_back(out.corner_count());
    }
    return out;
}

}  // namespace lcl
