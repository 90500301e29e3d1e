// SPDX-License-Identifier: BSD-3-Clause
/// Between plain arrays and OpenMesh::PolyMesh_ArrayKernelT<Traits>. Header only, independent of the rest of limitcl; needs OpenMesh 9 and C++17.
///
///     auto mesh = limitcl::to_openmesh<OpenMesh::DefaultTraitsDouble>(face_offsets, face_vertices, positions);
///     limitcl::OpenMeshArrays arrays = limitcl::from_openmesh(mesh);
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/Traits.hh>

namespace limitcl {

/// Faces as offsets + indices: face f has the corners face_offsets[f] .. face_offsets[f + 1] - 1.
struct OpenMeshArrays {
    std::vector<std::int32_t> face_offsets{0};  ///< face count + 1
    std::vector<std::int32_t> face_vertices;    ///< zero-based vertex of every corner
    std::vector<double> positions;              ///< vertex count x 3, model units
};

namespace openmesh_detail {

/// Throws unless corners first .. last - 1 are at least three different vertices below vertex_count. `last_face_of` holds, for each vertex, the last face
/// (+ 1) that was seen to use it.
template <class Indices>
void check_face(std::size_t face, const Indices& face_vertices, std::size_t first, std::size_t last, std::vector<std::size_t>& last_face_of) {
    const std::string name = "face " + std::to_string(face);
    if (last < first || last - first < 3 || last > face_vertices.size())
        throw std::invalid_argument(name + " has fewer than three corners, or corners outside the array");
    for (std::size_t c = first; c < last; ++c) {
        const auto vertex = static_cast<std::int64_t>(face_vertices[c]);
        if (vertex < 0 || static_cast<std::size_t>(vertex) >= last_face_of.size())
            throw std::invalid_argument(name + " uses vertex " + std::to_string(vertex) + ", there are " + std::to_string(last_face_of.size()));
        std::size_t& last_face = last_face_of[static_cast<std::size_t>(vertex)];
        if (last_face == face + 1) throw std::invalid_argument(name + " uses vertex " + std::to_string(vertex) + " twice");
        last_face = face + 1;
    }
}

}  // namespace openmesh_detail

/// Builds an OpenMesh with the same numbers of vertices and faces. The arrays are anything with size() and [], laid out as in OpenMeshArrays; positions
/// are cast to the scalar type of Traits::Point. Throws std::invalid_argument that names the first face that is malformed or that OpenMesh refuses
/// (three faces at an edge, a vertex whose faces do not form one fan, or opposite orientations); OpenMesh then also writes a line to its stream omerr(),
/// which can be switched off.
template <class Traits, class Offsets, class Indices, class Positions>
OpenMesh::PolyMesh_ArrayKernelT<Traits> to_openmesh(const Offsets& face_offsets, const Indices& face_vertices, const Positions& positions) {
    using Mesh = OpenMesh::PolyMesh_ArrayKernelT<Traits>;
    using Scalar = typename Mesh::Scalar;
    if (positions.size() % 3 != 0) throw std::invalid_argument("positions must hold three numbers a vertex");
    const std::size_t vertex_count = positions.size() / 3, face_count = face_offsets.size() > 0 ? face_offsets.size() - 1 : 0;
    Mesh mesh;
    mesh.reserve(vertex_count, face_vertices.size(), face_count);
    for (std::size_t i = 0; i < positions.size(); i += 3)
        mesh.add_vertex({static_cast<Scalar>(positions[i]), static_cast<Scalar>(positions[i + 1]), static_cast<Scalar>(positions[i + 2])});
    std::vector<std::size_t> last_face_of(vertex_count, 0);
    std::vector<OpenMesh::VertexHandle> corners;
    for (std::size_t f = 0; f < face_count; ++f) {
        const auto first = static_cast<std::size_t>(face_offsets[f]), last = static_cast<std::size_t>(face_offsets[f + 1]);
        openmesh_detail::check_face(f, face_vertices, first, last, last_face_of);
        corners.clear();
        for (std::size_t c = first; c < last; ++c) corners.emplace_back(static_cast<int>(face_vertices[c]));
        if (!mesh.add_face(corners).is_valid())
            throw std::invalid_argument("face " + std::to_string(f) + " makes the mesh non-manifold or inconsistently oriented; OpenMesh cannot hold it");
    }
    return mesh;
}

/// The arrays of an OpenMesh. Vertices and faces that are marked deleted but not yet collected are left out, and the rest is numbered without gaps in
/// their order; where nothing is deleted the numbers are the handles'. A face begins with the vertex it was made with. Throws std::length_error above
/// 2^31 - 1 corners.
template <class Traits>
OpenMeshArrays from_openmesh(const OpenMesh::PolyMesh_ArrayKernelT<Traits>& mesh) {
    OpenMeshArrays arrays;
    arrays.positions.reserve(3 * mesh.n_vertices());
    arrays.face_offsets.reserve(mesh.n_faces() + 1);
    std::vector<std::int32_t> number(mesh.n_vertices(), -1);
    std::int32_t count = 0;
    for (const OpenMesh::VertexHandle vertex : mesh.vertices()) {  // skips the deleted ones, if the mesh has a status
        number[static_cast<std::size_t>(vertex.idx())] = count++;
        for (std::size_t i = 0; i < 3; ++i) arrays.positions.push_back(static_cast<double>(mesh.point(vertex)[i]));
    }
    for (const OpenMesh::FaceHandle face : mesh.faces()) {
        for (const OpenMesh::VertexHandle vertex : mesh.fv_range(face)) arrays.face_vertices.push_back(number[static_cast<std::size_t>(vertex.idx())]);
        if (arrays.face_vertices.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
            throw std::length_error("more than 2^31 - 1 face corners");
        arrays.face_offsets.push_back(static_cast<std::int32_t>(arrays.face_vertices.size()));
    }
    return arrays;
}

}  // namespace limitcl
