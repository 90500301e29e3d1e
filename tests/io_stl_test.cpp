// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::Index;
using lcl::MeshFile;

namespace {

MeshFile read_stl_text(const std::string& text) { return read_text(text, FileFormat::stl, "a.stl"); }
std::string stl_refusal(const std::string& text) { return refusal(text, FileFormat::stl, "a.stl"); }

const std::string facet = "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1e0 0\n endloop\nendfacet\n";

std::string binary_stl(const std::vector<float>& coordinates, std::string head = "made by hand", std::uint16_t attribute = 0) {
    head.resize(80);
    const std::uint32_t count = static_cast<std::uint32_t>(coordinates.size() / 9);
    head.append(reinterpret_cast<const char*>(&count), 4);
    for (std::uint32_t f = 0; f < count; ++f) {
        head.append(12, '\0');
        head.append(reinterpret_cast<const char*>(&coordinates[9 * f]), 36);
        head.append(reinterpret_cast<const char*>(&attribute), 2);
    }
    return head;
}

}  // namespace

TEST_CASE("STL keeps triangles of float coordinates to the last bit", "[io][stl]") {
    const TemporaryFolder folder;
    const MeshFile file = file_of(float_triangles());
    for (const char* name : {"a.stl", "a.stl.gz"}) {
        std::vector<std::string> warnings;
        const MeshFile back = round_trip(file, folder.file(name), &warnings);
        CHECK(same_mesh(back.mesh, file.mesh));
        CHECK(warnings.empty());
        CHECK(back.warnings.empty());
    }
    const std::string bytes = file_bytes(folder.file("a.stl"));
    CHECK(bytes.size() == 84 + 2 * 50);
    CHECK(bytes.substr(0, 5) != "solid");
    float normal[3];
    std::memcpy(normal, bytes.data() + 84, sizeof(normal));
    const double length = std::hypot(0.1f, 1.5);  // the normal of (1, 0, 0) x (0.25, 1.5, 0.1) is (0, -0.1, 1.5)
    CHECK(normal[0] == 0);
    CHECK(normal[1] == Approx(-0.1f / length).epsilon(1e-6));
    CHECK(normal[2] == Approx(1.5 / length).epsilon(1e-6));
}

TEST_CASE("STL corners with equal coordinates are one vertex, numbered by first appearance", "[io][stl]") {
    const MeshFile file = read_stl_text(binary_stl({0, 0, 0, 1, 0, 0, 0, 1, 0, /**/ 0, 1, -0.0f, 1, -0.0f, 0, 1, 1, 0}));
    CHECK(same_mesh(file.mesh, mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {{0, 1, 2}, {2, 1, 3}})));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(read_stl_text(binary_stl({nan, 0, 0, 1, 0, 0, nan, 0, 0})).mesh.vertex_count == 2);
}

TEST_CASE("STL welds many vertices", "[io][stl]") {
    std::vector<float> coordinates;
    for (int i = 0; i < 5000; ++i)
        for (int c = 0; c < 3; ++c)
            for (const int value : {i + c, (i + c) * 7 % 11, 0}) coordinates.push_back(static_cast<float>(value) * 0.1f);
    const MeshFile file = read_stl_text(binary_stl(coordinates));
    CHECK(file.mesh.vertex_count == 5002);
    for (Index f = 0; f < 5000; ++f)
        for (Index c = 0; c < 3; ++c) REQUIRE(file.mesh.face_vertices[3 * f + c] == f + c);
}

TEST_CASE("STL ASCII and binary are told apart by size, not by the first word", "[io][stl]") {
    const lcl::PolygonMesh expected = mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}});
    CHECK(same_mesh(read_stl_text(binary_stl({0, 0, 0, 1, 0, 0, 0, 1, 0}, "solid in name only")).mesh, expected));
    CHECK(same_mesh(read_stl_text("solid a\n" + facet + "endsolid a\n").mesh, expected));
    const MeshFile longer = read_stl_text(binary_stl({0, 0, 0, 1, 0, 0, 0, 1, 0}) + "tail");
    CHECK(same_mesh(longer.mesh, expected));
    CHECK(longer.warnings == std::vector<std::string>{"4 bytes behind the last triangle were ignored"});
    CHECK(read_stl_text(binary_stl({})).mesh.vertex_count == 0);
    CHECK(contains(read_stl_text(binary_stl({0, 0, 0, 1, 0, 0, 0, 1, 0}, "x", 7)).warnings.at(0), "attributes (colours) of 1 triangles"));
}

TEST_CASE("STL ASCII is read with several solids, in any case, with any line ends", "[io][stl]") {
    std::string text = "  SOLID a name facet\n" + facet + "endsolid a name\nsolid\n" + facet + "endsolid\n";
    for (char& c : text) c = c >= 'a' && c <= 'z' && c != 'e' ? static_cast<char>(c - 32) : c;
    std::string crlf;
    for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    for (const std::string& variant : {text, crlf}) {
        const MeshFile file = read_stl_text(variant);
        CHECK(same_mesh(file.mesh, mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}, {0, 1, 2}})));
    }
    CHECK(read_stl_text("solid\nfacet normal -1.#IND nan x outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet endsolid").mesh.face_count() ==
          1);
    CHECK(read_stl_text("solid Empty\nendsolid Empty").mesh.face_count() == 0);
}

TEST_CASE("STL that is malformed is refused with the place", "[io][stl]") {
    const std::string whole = binary_stl({0, 0, 0, 1, 0, 0, 0, 1, 0});
    CHECK(contains(stl_refusal(whole.substr(0, 133)), "a.stl: binary STL of 1 triangles takes 134 bytes, the file has 133"));
    CHECK(contains(stl_refusal("hello"), "a.stl: neither ASCII STL (no word 'solid') nor binary STL (5 bytes"));
    CHECK(contains(stl_refusal("solid a\nfacet normal 0 0 1\nvertex 0 0 0\nvertex 0 0\nendfacet"),
                   "a.stl:5: 'endfacet' was found where a coordinate was expected"));
    CHECK(contains(stl_refusal("solid a\nfacet normal 0 0 1\nvertex 0 0 0\nendfacet"), "a.stl:4: a facet has 1 vertices; STL holds triangles only"));
    CHECK(contains(stl_refusal("solid a\nfacet normal 0 0 1\nvertex 0 0 0\n"), "a.stl:4: the file ends within a facet"));
    CHECK(contains(stl_refusal("solid a\nfacet normal 0 0 1\nfacet"), "a.stl:3: a facet begins before"));
    CHECK(contains(stl_refusal("solid a\nfacette"), "a.stl:2: 'facette' is no word of ASCII STL"));
}

TEST_CASE("STL takes triangle meshes alone and says what it loses", "[io][stl]") {
    const TemporaryFolder folder;
    std::vector<std::string> warnings;
    const std::string message = error_of<lcl::InvalidArgument>([&] {
        lcl::write_mesh(folder.file("a.stl"), file_of(mesh_of({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {{0, 1, 2}, {0, 1, 2, 3}})), FileFormat::by_ending,
                        warnings);
    });
    CHECK(message == "STL holds triangles only; face 1 has 4 corners; write OBJ, PLY or OFF");
    CHECK(std::filesystem::is_empty(folder.path()));

    MeshFile file = file_of(mesh_of({9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0}, {{1, 2, 3}}));
    add_byte_colours(file);
    file.properties.push_back({"quality", lcl::VertexProperty::Kind::scalar, "float", {1, 2, 3, 4}});
    file.uvs = {2, {0, 0}, {0, 0, 0}};
    file.normals.assign(12, 0);
    file.lines.push_back({0, "g part"});
    file.tags.corners = {1};
    warnings.clear();
    const MeshFile back = round_trip(file, folder.file("a.stl"), &warnings);
    CHECK(back.mesh.vertex_count == 3);
    CHECK(warnings == std::vector<std::string>{"STL cannot hold the vertex properties 'quality'; they are left out",
                                               "STL cannot hold vertex colours; they are left out",
                                               "STL cannot hold these texture coordinates; they are left out",
                                               "STL cannot hold vertex normals; they are left out", "STL cannot hold groups and materials; they are left out",
                                               "STL cannot hold creases, corners and the boundary rule; write OBJ to keep them",
                                               "STL cannot hold vertices without a face; 1 are left out"});
}
