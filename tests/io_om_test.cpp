// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>

#include <catch2/catch.hpp>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // OpenMesh's vectors are made without a value, and filled later
#endif
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

/// What OpenMesh itself writes of a square and a triangle, with everything that it can put into a file.
std::string full_om_file(bool delete_triangle) {
    Mesh mesh;
    mesh.request_vertex_status(), mesh.request_edge_status(), mesh.request_halfedge_status(), mesh.request_face_status();
    mesh.request_vertex_normals(), mesh.request_vertex_colors(), mesh.request_vertex_texcoords2D(), mesh.request_face_normals(), mesh.request_face_colors();
    std::vector<OpenMesh::VertexHandle> v;
    for (const OpenMesh::Vec3d& point : {OpenMesh::Vec3d(0.1, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.5, 0}}) v.push_back(mesh.add_vertex(point));
    for (const auto vertex : v) mesh.set_color(vertex, {1.0f, 0.2f, 0.0f, 1.0f}), mesh.set_normal(vertex, {0, 0, 1}), mesh.set_texcoord2D(vertex, {0, 0});
    mesh.add_face(v[0], v[1], v[2], v[3]);
    const auto triangle = mesh.add_face(v[1], v[4], v[2]);
    OpenMesh::VPropHandleT<double> quality;
    mesh.add_property(quality, "quality");
    mesh.property(quality).set_persistent(true);
    OpenMesh::VPropHandleT<std::string> label;
    mesh.add_property(label, "label");
    mesh.property(label).set_persistent(true);
    if (delete_triangle) mesh.delete_face(triangle);
    std::stringstream stream;
    using OpenMesh::IO::Options;
    OpenMesh::IO::write_mesh(mesh, stream, ".om",
                             Options(Options::Binary | Options::VertexColor | Options::VertexNormal | Options::VertexTexCoord | Options::FaceNormal |
                                     Options::FaceColor | Options::Status | Options::Custom));
    return stream.str();
}

struct QuietOpenMesh {
    QuietOpenMesh() { omlog().disable(), omerr().disable(), omout().disable(); }
    ~QuietOpenMesh() { omlog().enable(), omerr().enable(), omout().enable(); }
};

}  // namespace

TEST_CASE("OM keeps coordinates to the last bit, and the order of vertices and faces", "[io][om]") {
    const TemporaryFolder folder;
    const MeshFile file = file_of(awkward_patch());
    for (const char* name : {"a.om", "a.om.gz"}) {
        std::vector<std::string> warnings;
        const MeshFile back = round_trip(file, folder.file(name), &warnings);
        CHECK(same_mesh(back.mesh, file.mesh));
        CHECK(warnings.empty());
        CHECK(back.warnings.empty());
    }
}

TEST_CASE("OM holds vertex colours in 8 bits", "[io][om]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(awkward_patch());
    add_byte_colours(file);
    std::vector<std::string> warnings;
    const MeshFile back = round_trip(file, folder.file("a.om"), &warnings);
    CHECK(warnings.empty());
    REQUIRE(back.properties.size() == 3);
    for (int c = 0; c < 3; ++c) {
        CHECK(back.properties[c].name == file.properties[c].name);
        CHECK(back.properties[c].values == file.properties[c].values);
        file.properties[c].type = "double";
        for (double& value : file.properties[c].values) value /= 255;
    }
    const MeshFile rounded = round_trip(file, folder.file("a.om"), &warnings);
    CHECK(warnings == std::vector<std::string>{"OM holds vertex colours in 8 bits; they are rounded"});
    for (int c = 0; c < 3; ++c) CHECK(rounded.properties[c].values == back.properties[c].values);
}

TEST_CASE("OM files with everything that OpenMesh writes are read", "[io][om]") {
    const QuietOpenMesh quiet;
    const MeshFile file = read_text(full_om_file(false), FileFormat::om);
    CHECK(same_mesh(file.mesh, mesh_of({0.1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0.5, 0}, {{0, 1, 2, 3}, {1, 4, 2}})));
    REQUIRE(file.properties.size() == 3);
    CHECK(file.properties[1].values == std::vector<double>(5, 51));
    CHECK(file.warnings ==
          std::vector<std::string>{"texture coordinates were dropped", "colours of faces or edges were dropped", "custom properties were dropped"});
}

TEST_CASE("OM leaves out what is marked deleted", "[io][om]") {
    const QuietOpenMesh quiet;
    const MeshFile file = read_text(full_om_file(true), FileFormat::om);
    CHECK(same_mesh(file.mesh, mesh_of({0.1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {{0, 1, 2, 3}})));
    CHECK(file.properties.at(0).values == std::vector<double>(4, 255));
}

TEST_CASE("OM refuses meshes that OpenMesh cannot hold", "[io][om]") {
    const TemporaryFolder folder;
    std::vector<std::string> warnings;
    const auto refuse = [&](const lcl::PolygonMesh& mesh) {
        return error_of<lcl::BadInput>([&] { lcl::write_mesh(folder.file("a.om"), file_of(mesh), FileFormat::by_ending, warnings); });
    };
    CHECK(contains(refuse(mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}})),
                   "OM cannot hold this mesh: face 2 makes the mesh non-manifold"));
    CHECK(contains(refuse(mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 1}})), "face 0 uses vertex 1 twice"));
    CHECK(contains(refuse(mesh_of(std::vector<double>(900), {{0, 1, 299}})), "OM cannot hold 300 vertices with no more than 3 edges"));
    CHECK(std::filesystem::is_empty(folder.path()));
    CHECK(omerr().is_enabled());
    CHECK(omlog().is_enabled());
}

TEST_CASE("OM that is cut off or changed in any byte is refused or read, never crashed on", "[io][om]") {
    const QuietOpenMesh quiet;
    const std::string whole = full_om_file(false);
    for (std::size_t size = 1; size < whole.size(); ++size) {
        INFO(size);
        try {
            const MeshFile file = read_text(whole.substr(0, size), FileFormat::om, "a.om");
            CHECK(file.mesh.vertex_count == 5);
        } catch (const lcl::BadInput& error) {
            CHECK(contains(error.what(), "a.om: "));
        }
    }
    for (std::size_t place = 0; place < whole.size(); ++place)
        for (const int value : {0, 1, 127, 128, 255}) {
            std::string changed = whole;
            changed[place] = static_cast<char>(value);
            try {
                const MeshFile file = read_text(changed, FileFormat::om, "a.om");
                CHECK(file.mesh.face_offsets.back() == file.mesh.corner_count());
            } catch (const lcl::BadInput& error) {
                CHECK(contains(error.what(), "a.om"));
            }
        }
}
