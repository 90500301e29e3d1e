// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::Index;
using lcl::MeshFile;
using lcl::VertexProperty;

namespace {

MeshFile read_ply_text(const std::string& text) { return read_text(text, FileFormat::ply, "a.ply"); }
std::string ply_refusal(const std::string& text) { return refusal(text, FileFormat::ply, "a.ply"); }

const std::string xyz = "property double x\nproperty double y\nproperty double z\n";
const std::string corners = "property list uchar int vertex_indices\n";

std::string ascii_header(const std::string& elements) { return "ply\nformat ascii 1.0\n" + elements + "end_header\n"; }

/// One column of each scalar type at the ends of its range.
void add_all_types(MeshFile& file) {
    const auto add = [&](const char* type, double low, double high) {
        VertexProperty column{std::string("of ") + type, VertexProperty::Kind::scalar, type,
                              std::vector<double>(static_cast<std::size_t>(file.mesh.vertex_count), low)};
        column.name[2] = '_';
        column.values.back() = high;
        file.properties.push_back(column);
    };
    add("char", -128, 127);
    add("uchar", 0, 255);
    add("short", -32768, 32767);
    add("ushort", 0, 65535);
    add("int", -2147483648.0, 2147483647);
    add("uint", 0, 4294967295.0);
    add("float", 0.1f, -3e38f);  // as ASCII more digits than a float needs: text is read as double
    add("double", 0.1, -1e300);
}

}  // namespace

TEST_CASE("PLY keeps all values to the last bit in every encoding", "[io][ply]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(awkward_patch());
    add_byte_colours(file);
    add_all_types(file);
    for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
        for (const char* name : {"a.ply", "a.ply.gz"}) {
            INFO(encoding << " " << name);
            file.ply_encoding = encoding;
            const MeshFile back = round_trip(file, folder.file(name));
            CHECK(same_mesh(back.mesh, file.mesh));
            CHECK(back.ply_encoding == encoding);
            CHECK(back.ply_position_type == "double");
            CHECK(back.warnings.empty());
            REQUIRE(back.properties.size() == file.properties.size());
            for (std::size_t p = 0; p < back.properties.size(); ++p) {
                CHECK(back.properties[p].name == file.properties[p].name);
                CHECK(back.properties[p].type == file.properties[p].type);
                CHECK(back.properties[p].kind == file.properties[p].kind);
                CHECK(same_bits(back.properties[p].values, file.properties[p].values));
            }
        }
}

TEST_CASE("PLY is written as binary little-endian double unless the input was otherwise", "[io][ply]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(float_triangles());
    std::vector<std::string> warnings;
    lcl::write_mesh(folder.file("a.ply"), file, FileFormat::by_ending, warnings);
    CHECK(contains(file_bytes(folder.file("a.ply")), "format binary_little_endian 1.0\nelement vertex 4\nproperty double x\n"));
    file.ply_encoding = "binary_big_endian";
    file.ply_position_type = "float";
    const MeshFile back = round_trip(file, folder.file("a.ply"));
    CHECK(contains(file_bytes(folder.file("a.ply")), "format binary_big_endian 1.0\nelement vertex 4\nproperty float x\n"));
    CHECK(back.ply_position_type == "float");
    CHECK(same_mesh(back.mesh, file.mesh));
}

TEST_CASE("PLY ASCII is the text that it should be", "[io][ply]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(mesh_of({0, 0.1, -0.0, 1e300, 2, 3, 0, 0, 0}, {{0, 1, 2}}));
    file.ply_encoding = "ascii";
    file.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    std::vector<std::string> warnings;
    lcl::write_mesh(folder.file("a.ply"), file, FileFormat::by_ending, warnings);
    CHECK(file_bytes(folder.file("a.ply")) ==
          ascii_header("element vertex 3\n" + xyz + "property double nx\nproperty double ny\nproperty double nz\nelement face 1\n" + corners) +
              "0 0.1 -0 0 0 1\n1e+300 2 3 0 0 1\n0 0 0 0 0 1\n3 0 1 2\n");
    CHECK(lcl::read_mesh(folder.file("a.ply")).properties.empty());
}

TEST_CASE("PLY elements and properties come in any order, and unknown ones are skipped", "[io][ply]") {
    const MeshFile file = read_ply_text(
        ascii_header("comment by hand\nelement face 2\nproperty uchar flag\nproperty list uint8 int32 vertex_index\nelement edge 1\nproperty int a\n"
                     "property list uchar float more\nobj_info none\nelement vertex 3\nproperty float z\nproperty list uchar int links\n"
                     "property float32 x\nproperty short heat\nproperty float ny\nproperty float y\n") +
        "7 3 0 1 2\n8 3 2 1 0\n5 2 0.5 0.25\n3 2 9 9 1 -40 0 2\n6 0 4 41 0 5\n\n9 1 0 7 42 0 8\n");
    CHECK(same_mesh(file.mesh, mesh_of({1, 2, 3, 4, 5, 6, 7, 8, 9}, {{0, 1, 2}, {2, 1, 0}})));
    REQUIRE(file.properties.size() == 1);
    CHECK(file.properties[0].name == "heat");
    CHECK(file.properties[0].type == "short");
    CHECK(file.properties[0].values == std::vector<double>{-40, 41, 42});
    CHECK(file.ply_position_type == "float");
    CHECK(file.warnings == std::vector<std::string>{"the property 'flag' of the faces was dropped", "the element 'edge' was skipped",
                                                    "the property 'links' of the vertices was dropped"});
}

TEST_CASE("a PLY row with more values than its header announces is refused", "[io][ply]") {
    const std::string text =
        ascii_header("element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n") +
        "0 0 0\n1 0 0\n0 1 0 7\n3 0 1 2\n";
    CHECK_THROWS_WITH(read_ply_text(text), Catch::Contains(":12: the row has more values than the header announces"));
}

TEST_CASE("PLY binary bodies begin right behind the header's last line break", "[io][ply]") {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string text = "ply" + end + "format binary_little_endian 1.0" + end + "element vertex 1" + end + "property char x" + end + "property char y" +
                           end + "property char z" + end + "end_header" + end;
        text += "\n\r\x05";
        const MeshFile file = read_ply_text(text);
        CHECK(file.mesh.positions == std::vector<double>{10, 13, 5});
    }
}

TEST_CASE("PLY texture coordinates of corners come back", "[io][ply]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(awkward_patch());
    file.uvs.values = {0, 0, 0.5, 0.25, 1, 0.1};
    file.uvs.corner_indices.assign(file.mesh.face_vertices.size(), 1);
    file.uvs.corner_indices[0] = 2;
    file.uvs.corner_indices[5] = -1;
    for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        file.ply_encoding = encoding;
        const MeshFile back = round_trip(file, folder.file("a.ply"));
        REQUIRE(back.uvs.corner_indices.size() == file.uvs.corner_indices.size());
        for (std::size_t c = 0; c < back.uvs.corner_indices.size(); ++c) {
            if (c >= 4 && c < 8) {  // the face that has a corner without
                CHECK(back.uvs.corner_indices[c] == -1);
                continue;
            }
            const Index old_index = file.uvs.corner_indices[c], new_index = back.uvs.corner_indices[c];
            for (Index i = 0; i < 2; ++i) CHECK(back.uvs.values[2 * new_index + i] == file.uvs.values[2 * old_index + i]);
        }
        CHECK(back.warnings == std::vector<std::string>{"1 faces have no two texture coordinates a corner"});
        CHECK(contains(file_bytes(folder.file("a.ply")), "property list uchar double texcoord\n"));
    }
    file.uvs.values[5] = 0.125;
    round_trip(file, folder.file("a.ply"));
    CHECK(contains(file_bytes(folder.file("a.ply")), "property list uchar float texcoord\n"));
}

TEST_CASE("PLY faces of more than 255 corners come back", "[io][ply]") {
    const TemporaryFolder folder;
    lcl::PolygonMesh mesh;
    for (Index i = 0; i < 300; ++i) {
        mesh.face_vertices.push_back(i);
        for (const double value : {std::cos(i * 0.02), std::sin(i * 0.02), 0.0}) mesh.positions.push_back(value);
    }
    mesh.vertex_count = 300;
    mesh.face_offsets.push_back(300);
    MeshFile file = file_of(mesh);
    file.uvs.values = {0, 1};
    file.uvs.corner_indices.assign(300, 0);
    for (const char* encoding : {"ascii", "binary_big_endian"}) {
        file.ply_encoding = encoding;
        const MeshFile back = round_trip(file, folder.file("a.ply"));
        CHECK(same_mesh(back.mesh, mesh));
        CHECK(back.uvs.values.size() == 600);
    }
}

TEST_CASE("PLY columns of whole numbers are rounded and bounded when written", "[io][ply]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(float_triangles());
    file.properties.push_back({"red", VertexProperty::Kind::colour, "uchar", {127.5, -3, 1e9, std::numeric_limits<double>::quiet_NaN()}});
    CHECK(round_trip(file, folder.file("a.ply")).properties.at(0).values == std::vector<double>{128, 0, 255, 0});
}

TEST_CASE("PLY that is malformed is refused with the place", "[io][ply]") {
    const std::string vertices = "element vertex 1\n" + xyz;
    CHECK(read_ply_text("PLY\nformat ascii 1.0\n" + vertices + "end_header\n1 2 3\n").mesh.vertex_count == 1);
    CHECK(contains(ply_refusal("plyx\n"), "a.ply:1: a PLY file begins with the line 'ply'"));
    CHECK(contains(ply_refusal("ply\nformat ascii 1.0\n"), "a.ply:3: the file ends before the line 'end_header'"));
    CHECK(contains(ply_refusal("ply\nelement vertex 0\nend_header\n"), "no line 'format'"));
    CHECK(contains(ply_refusal("ply\nformat binary_middle_endian 1.0\n"), "a.ply:2: 'binary_middle_endian' is no encoding"));
    CHECK(contains(ply_refusal(ascii_header("elephant vertex 3\n")), "a.ply:3: 'elephant' is no line of a PLY header"));
    CHECK(contains(ply_refusal(ascii_header("element vertex\n")), "a.ply:3: the line ends where the number of elements"));
    CHECK(contains(ply_refusal(ascii_header("element vertex -1\n")), "a.ply:3: the number of elements is -1"));
    CHECK(contains(ply_refusal(ascii_header("property float x\n")), "a.ply:3: a property stands before the first element"));
    CHECK(contains(ply_refusal(ascii_header("element vertex 1\nproperty bool x\n")), "a.ply:4: 'bool' is no scalar type"));
    CHECK(contains(ply_refusal(ascii_header("element face 0\nproperty list float int vertex_indices\n")),
                   "a.ply:4: the length of a list must be of a whole type"));
    CHECK(contains(ply_refusal(ascii_header("element vertex 1\nproperty float x\n") + "0\n"), "a.ply:3: the vertices have no property 'y'"));
    CHECK(contains(ply_refusal(ascii_header("element face 0\n" + corners)), "no element 'vertex'"));
    CHECK(contains(ply_refusal(ascii_header(vertices + "element face 1\nproperty list uchar int corners\n") + "0 0 0\n0\n"),
                   "a.ply:7: the faces have no list 'vertex_indices'"));
    CHECK(contains(ply_refusal(ascii_header(vertices) + "0 0\n0\n"), "a.ply:8: the line ends where a value was expected"));
    CHECK(contains(ply_refusal(ascii_header(vertices) + "0 0 x 0\n"), "a.ply:8: 'x'"));
    CHECK(contains(ply_refusal(ascii_header(vertices + "element face 1\n" + corners) + "0 0 0\n5 0 0 0\n"), "entries, more than the file can hold"));
    CHECK(contains(ply_refusal(ascii_header(vertices + "element face 1\n" + corners) + "0 0 0\n4 0 0 0\n          "), "a.ply:11: the line ends where"));
    CHECK(contains(ply_refusal(ascii_header(vertices + "element face 1\n" + corners) + "0 0 0\n-4 0 0 0\n"), "has the length -4"));
    CHECK(contains(ply_refusal(ascii_header(vertices + "element face 1\nproperty list uchar uint vertex_indices\n") + "0 0 0\n3 0 0 4294967295\n"),
                   "face 0 uses vertex 4294967295"));
}

TEST_CASE("PLY counts that the file cannot hold are refused before anything is allocated", "[io][ply]") {
    for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
        for (const char* count : {"4000000000", "2147483647", "99999999999999999999", "1000"}) {
            const std::string header = std::string("ply\nformat ") + encoding + " 1.0\n";
            INFO(encoding << " " << count);
            CHECK(contains(ply_refusal(header + "element vertex " + count + "\n" + xyz + "end_header\n0 0 0\n"), "a.ply:3: element 'vertex' is given "));
            CHECK(contains(ply_refusal(header + "element vertex 0\n" + xyz + "element face " + count + "\n" + corners + "end_header\n3 0 0 0\n"),
                           "a.ply:7: element 'face' is given "));
            CHECK(contains(ply_refusal(header + "element vertex " + count + "\nend_header\n"), std::string("a.ply:3: ")));
        }
}

TEST_CASE("PLY binary that is cut off is refused with the byte", "[io][ply]") {
    const TemporaryFolder folder;
    round_trip(file_of(awkward_patch()), folder.file("a.ply"));
    const std::string whole = file_bytes(folder.file("a.ply"));
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const std::string message = refusal(whole.substr(0, size), FileFormat::ply, "a.ply");
        INFO(size);
        CHECK(contains(message, "a.ply"));
    }
    CHECK(contains(refusal(whole.substr(0, whole.size() - 1), FileFormat::ply, "a.ply"), "more than the file can hold (byte "));
}
