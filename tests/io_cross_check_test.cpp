// SPDX-License-Identifier: BSD-3-Clause
// What is written here is read by tinyobjloader and OpenMesh, and what OpenMesh writes is read here.
#include <catch2/catch.hpp>

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // OpenMesh's vectors are made without a value, and filled later
#endif
#include <tiny_obj_loader.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::Index;
using lcl::MeshFile;

namespace {

using Mesh = OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// A torus of quads, some split into triangles, with texture coordinates and groups.
MeshFile mixed_torus() {
    constexpr Index around = 12, across = 9;
    MeshFile file;
    file.mesh.vertex_count = around * across;
    const auto vertex = [](Index i, Index j) { return (i % around) * across + j % across; };
    for (Index i = 0; i < around; ++i)
        for (Index j = 0; j < across; ++j) {
            const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
            for (const double value : {(2 + std::cos(v)) * std::cos(u), (2 + std::cos(v)) * std::sin(u), std::sin(v)}) file.mesh.positions.push_back(value);
            file.uvs.values.insert(file.uvs.values.end(), {u / 7, v / 7});
        }
    for (Index i = 0; i < around; ++i)
        for (Index j = 0; j < across; ++j) {
            const Index a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
            std::vector<std::vector<Index>> faces{{a, b, c, d}};
            if ((i + j) % 3 == 0) faces = {{a, b, c}, {a, c, d}};
            for (const std::vector<Index>& face : faces) {
                file.mesh.face_vertices.insert(file.mesh.face_vertices.end(), face.begin(), face.end());
                file.mesh.face_offsets.push_back(static_cast<Index>(file.mesh.face_vertices.size()));
            }
        }
    file.uvs.corner_indices = file.mesh.face_vertices;
    file.lines = {{0, "o torus"}, {0, "g first"}, {7, "usemtl none"}, {40, "g second"}};
    return file;
}

/// tinyobjloader builds a number from its digits in doubles, one rounding each: at most 40 of them.
const double digit_error = 40 * std::numeric_limits<double>::epsilon();
/// OpenMesh rounds to float in its text and PLY formats.
const double float_error = std::numeric_limits<float>::epsilon();

void check_close(const std::vector<double>& a, const std::vector<double>& b, double relative) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) REQUIRE(std::fabs(a[i] - b[i]) <= relative * std::max(1.0, std::fabs(b[i])));
}

}  // namespace

TEST_CASE("tinyobjloader reads the OBJ written here as it was", "[io][cross-check]") {
    const TemporaryFolder folder;
    const MeshFile file = mixed_torus();
    std::vector<std::string> warnings;
    lcl::write_mesh(folder.file("a.obj"), file, FileFormat::by_ending, warnings);
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    REQUIRE(tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, folder.file("a.obj").c_str(), nullptr, false));
    check_close(attributes.vertices, file.mesh.positions, digit_error);
    check_close(attributes.texcoords, file.uvs.values, digit_error);
    std::vector<Index> corners, uvs, offsets{0};
    for (const tinyobj::shape_t& shape : shapes) {
        for (const tinyobj::index_t& index : shape.mesh.indices) corners.push_back(index.vertex_index), uvs.push_back(index.texcoord_index);
        for (const unsigned char degree : shape.mesh.num_face_vertices) offsets.push_back(offsets.back() + degree);
    }
    CHECK(corners == file.mesh.face_vertices);
    CHECK(offsets == file.mesh.face_offsets);
    CHECK(uvs == file.uvs.corner_indices);
}

TEST_CASE("OBJ is read here as tinyobjloader reads it", "[io][cross-check]") {
    const TemporaryFolder folder;
    const std::string text =
        "v 1.25e-3 -7 .5\nv 0.1 0.2 0.30000000000000004\n\tv  5 6 7 \nvt 0.25 0.75\nvn 0 0 1\nf -3/1/1 -2/1/1 -1/1/1\r\nv 9 9 9\nf 4 3 2 1\n";
    write_bytes(folder.file("a.obj"), text);
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    REQUIRE(tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, folder.file("a.obj").c_str(), nullptr, false));
    const MeshFile file = lcl::read_mesh(folder.file("a.obj"));
    check_close(attributes.vertices, file.mesh.positions, digit_error);
    std::vector<Index> corners;
    for (const tinyobj::index_t& index : shapes.at(0).mesh.indices) corners.push_back(index.vertex_index);
    CHECK(corners == file.mesh.face_vertices);
}

TEST_CASE("OpenMesh reads the files written here, as far as it keeps doubles", "[io][cross-check]") {
    const TemporaryFolder folder;
    MeshFile file = mixed_torus();
    file.uvs = {};  // OpenMesh reads no PLY that has a list of them
    for (const char* name : {"a.obj", "a.off", "a.ply", "a.om"}) {
        INFO(name);
        std::vector<std::string> warnings;
        lcl::write_mesh(folder.file(name), file, FileFormat::by_ending, warnings);
        Mesh mesh;
        REQUIRE(OpenMesh::IO::read_mesh(mesh, folder.file(name)));
        std::vector<double> positions;
        for (const auto v : mesh.vertices())
            for (int i = 0; i < 3; ++i) positions.push_back(mesh.point(v)[i]);
        check_close(positions, file.mesh.positions, float_error);
        std::vector<Index> corners, offsets{0};
        for (const auto f : mesh.faces()) {
            for (const auto v : mesh.fv_range(f)) corners.push_back(v.idx());
            offsets.push_back(static_cast<Index>(corners.size()));
        }
        CHECK(corners == file.mesh.face_vertices);
        CHECK(offsets == file.mesh.face_offsets);
    }
}

TEST_CASE("files that OpenMesh writes are read here", "[io][cross-check]") {
    const TemporaryFolder folder;
    const MeshFile file = mixed_torus();
    Mesh mesh;
    for (std::size_t i = 0; i < file.mesh.positions.size(); i += 3)
        mesh.add_vertex({file.mesh.positions[i], file.mesh.positions[i + 1], file.mesh.positions[i + 2]});
    for (Index f = 0; f < file.mesh.face_count(); ++f) {
        std::vector<OpenMesh::VertexHandle> corners;
        for (Index c = file.mesh.face_offsets[f]; c < file.mesh.face_offsets[f + 1]; ++c) corners.emplace_back(file.mesh.face_vertices[c]);
        mesh.add_face(corners);
    }
    omlog().disable();  // it tells of every file
    using OpenMesh::IO::Options;
    struct Case {
        const char* name;
        Options options;
    };
    for (const Case& c : {Case{"a.obj", {}}, Case{"a.off", {}}, Case{"a.ply", {}}, Case{"b.ply", Options::Binary},
                          Case{"c.ply", Options(Options::Binary | Options::MSB)}, Case{"a.om", {}}}) {
        INFO(c.name);
        REQUIRE(OpenMesh::IO::write_mesh(mesh, folder.file(c.name), c.options, 17));
        const MeshFile back = lcl::read_mesh(folder.file(c.name));
        CHECK(back.mesh.face_offsets == file.mesh.face_offsets);
        CHECK(back.mesh.face_vertices == file.mesh.face_vertices);
        check_close(back.mesh.positions, file.mesh.positions, float_error);
    }
    omlog().enable();
}
