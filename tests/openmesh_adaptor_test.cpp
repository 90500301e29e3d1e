// SPDX-License-Identifier: BSD-3-Clause
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // OpenMesh's vectors are made without a value, and filled later
#endif
#include "include/limitcl/openmesh.hpp"

#include <array>

#include <OpenMesh/Core/System/omstream.hh>
#include <catch2/catch.hpp>

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
};

/// A triangle, a quad and a pentagon round vertex 2, vertex 7 isolated.
const std::vector<std::int32_t> offsets{0, 3, 7, 12};
const std::vector<std::int32_t> corners{0, 1, 2, 1, 3, 4, 2, 2, 4, 5, 6, 0};
const std::vector<double> positions{0.1, 0, 0, 1, 0.2, 0, 1, 1, 0.3, 2, 0, 0, 2, 1, 0, 1, 2, 0, 0, 2, 0, 9, 9, 1.0 / 3};

template <class Action>
std::string refusal(Action action) {
    omerr().disable();
    std::string message = "no error";
    try {
        action();
    } catch (const std::invalid_argument& error) {
        message = error.what();
    }
    omerr().enable();
    return message;
}

std::string refusal_of(const std::vector<std::int32_t>& face_offsets, const std::vector<std::int32_t>& face_vertices) {
    return refusal([&] { limitcl::to_openmesh<DoubleTraits>(face_offsets, face_vertices, positions); });
}

}  // namespace

TEST_CASE("an OpenMesh has the vertices, faces and corners of the arrays, and gives them back", "[openmesh]") {
    const auto mesh = limitcl::to_openmesh<DoubleTraits>(offsets, corners, positions);
    CHECK(mesh.n_vertices() == 8);
    CHECK(mesh.n_faces() == 3);
    CHECK(mesh.n_edges() == 9);
    CHECK(mesh.is_isolated(OpenMesh::VertexHandle(7)));
    const limitcl::OpenMeshArrays arrays = limitcl::from_openmesh(mesh);
    CHECK(arrays.face_offsets == offsets);
    CHECK(arrays.face_vertices == corners);
    CHECK(arrays.positions == positions);
}

TEST_CASE("arrays may be of any kind, and points are cast to the mesh's scalar", "[openmesh]") {
    const std::array<unsigned, 2> face_offsets{0, 3};
    const std::array<std::size_t, 3> face_vertices{2, 0, 1};
    const std::array<float, 9> points{0.1f, 0, 0, 1, 0, 0, 0, 1, 0};
    const auto mesh = limitcl::to_openmesh<OpenMesh::DefaultTraits>(face_offsets, face_vertices, points);
    const limitcl::OpenMeshArrays arrays = limitcl::from_openmesh(mesh);
    CHECK(arrays.face_vertices == std::vector<std::int32_t>{2, 0, 1});
    CHECK(arrays.positions[0] == static_cast<double>(0.1f));
    const auto empty = limitcl::to_openmesh<DoubleTraits>(std::vector<int>{}, std::vector<int>{}, std::vector<double>{});
    CHECK(limitcl::from_openmesh(empty).face_offsets == std::vector<std::int32_t>{0});
}

TEST_CASE("what is deleted but not collected is left out", "[openmesh]") {
    auto mesh = limitcl::to_openmesh<DoubleTraits>(offsets, corners, positions);
    mesh.request_vertex_status(), mesh.request_edge_status(), mesh.request_halfedge_status(), mesh.request_face_status();
    mesh.delete_face(OpenMesh::FaceHandle(1), true);  // vertex 3 goes with it, the others are used by the triangle or the pentagon
    const limitcl::OpenMeshArrays marked = limitcl::from_openmesh(mesh);
    CHECK(marked.face_offsets == std::vector<std::int32_t>{0, 3, 8});
    CHECK(marked.face_vertices == std::vector<std::int32_t>{0, 1, 2, 2, 3, 4, 5, 0});
    std::vector<double> expected = positions;
    expected.erase(expected.begin() + 9, expected.begin() + 12);
    CHECK(marked.positions == expected);

    mesh.garbage_collection();
    const limitcl::OpenMeshArrays collected = limitcl::from_openmesh(mesh);
    CHECK(collected.positions.size() == marked.positions.size());
    CHECK(collected.face_vertices.size() == marked.face_vertices.size());
}

TEST_CASE("faces that OpenMesh cannot hold are refused by number", "[openmesh]") {
    CHECK(refusal_of({0, 3, 6, 9}, {0, 1, 2, 1, 0, 3, 0, 1, 4}) == "face 2 makes the mesh non-manifold or inconsistently oriented; OpenMesh cannot hold it");
    CHECK(refusal_of({0, 3, 6}, {0, 1, 2, 0, 1, 3}) == "face 1 makes the mesh non-manifold or inconsistently oriented; OpenMesh cannot hold it");
    CHECK(refusal_of({0, 3, 6}, {0, 1, 2, 1, 0, 8}) == "face 1 uses vertex 8, there are 8");
    CHECK(refusal_of({0, 3}, {0, 1, -1}) == "face 0 uses vertex -1, there are 8");
    CHECK(refusal_of({0, 3, 7}, {0, 1, 2, 3, 4, 3, 5}) == "face 1 uses vertex 3 twice");
    CHECK(refusal_of({0, 2}, {0, 1}) == "face 0 has fewer than three corners, or corners outside the array");
    CHECK(refusal_of({0, 4}, {0, 1, 2}) == "face 0 has fewer than three corners, or corners outside the array");
    CHECK(refusal_of({3, 0}, {0, 1, 2}) == "face 0 has fewer than three corners, or corners outside the array");
    CHECK(refusal([] { limitcl::to_openmesh<DoubleTraits>(offsets, corners, std::vector<double>{1, 2}); }) == "positions must hold three numbers a vertex");
}
