// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::Index;
using lcl::MeshFile;

namespace {

MeshFile read_obj_text(const std::string& text) { return read_text(text, FileFormat::obj, "cube.obj"); }
std::string obj_refusal(const std::string& text) { return refusal(text, FileFormat::obj, "cube.obj"); }

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("OBJ keeps coordinates to the last bit, and the order of vertices and faces", "[io][obj]") {
    const TemporaryFolder folder;
    const MeshFile file = file_of(awkward_patch());
    for (const char* name : {"a.obj", "a.obj.gz"}) {
        const MeshFile back = round_trip(file, folder.file(name));
        CHECK(same_mesh(back.mesh, file.mesh));
        CHECK(back.warnings.empty());
    }
}

TEST_CASE("OBJ faces are read in all forms of corners", "[io][obj]") {
    const std::vector<Index> expected{0, 1, 2};
    for (const char* face : {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 2/2/1 3/3/1", "f -3 -2 -1", "f -3/-3/-1 -2/-2/-1 -1/-1/-1",
                             "f 1// 2// 3//", "f 1/ 2/ 3/", "f\t1  2\t3  \t", "f +1 2 3 # comment", "f 1 \\\n 2 \\\r\n 3", "f 1 2\\\n 3", "f 1/1/1 2/2/ 3/3"}) {
        INFO(face);
        const MeshFile file = read_obj_text(triangle + "vt 0 0\nvt 1 0\nvt 0.5 1\nvn 0 0 1\n" + face);
        CHECK(file.mesh.face_vertices == expected);
        CHECK(file.mesh.face_offsets == std::vector<Index>{0, 3});
    }
}

TEST_CASE("OBJ lines end in LF, CR LF or CR, and the last may lack its end", "[io][obj]") {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        const MeshFile file = read_obj_text("v 1 2 3" + end + end + "v 4 5 6" + end + "# c" + end + "v 7 8 9" + end + "f 1 2 3");
        CHECK(same_mesh(file.mesh, mesh_of({1, 2, 3, 4, 5, 6, 7, 8, 9}, {{0, 1, 2}})));
        CHECK(contains(obj_refusal("v 1 2 3" + end + end + "v 4 5"), "cube.obj:3: "));
    }
}

TEST_CASE("OBJ numbers are read in all their forms", "[io][obj]") {
    const double infinity = std::numeric_limits<double>::infinity();
    const MeshFile file =
        read_obj_text("\xEF\xBB\xBFv +1. -.5 2.e+1\nv 1E-2 1e400 -1e-400\nv inf -Inf 0." + std::string(400, '0') + "1\nv 1 2 3 1\nv 1 2 3 0.5");
    CHECK(same_bits(file.mesh.positions, {1, -0.5, 20, 0.01, infinity, -0.0, infinity, -infinity, 0, 1, 2, 3, 1, 2, 3}));
    REQUIRE(file.warnings.size() == 1);
    CHECK(contains(file.warnings[0], "w of 1 vertices"));
    CHECK(std::isnan(read_obj_text("v nan NaN -nan").mesh.positions[2]));
}

TEST_CASE("OBJ that is malformed is refused with file and line", "[io][obj]") {
    CHECK(obj_refusal(triangle + "f 0 1 2") == "cube.obj:4: a face has vertex index 0; OBJ counts from 1");
    CHECK(contains(obj_refusal(triangle + "f 1 2 x"), "cube.obj:4: 'x' was found where a face corner"));
    CHECK(contains(obj_refusal(triangle + "f 1 2 3.5"), "cube.obj:4: '3.5'"));
    CHECK(contains(obj_refusal(triangle + "f 1/2/3/4 2 3"), "cube.obj:4: '1/2/3/4'"));
    CHECK(contains(obj_refusal(triangle + "f 1/a 2 3"), "cube.obj:4: '1/a'"));
    CHECK(contains(obj_refusal(triangle + "vt 0 0\nf 1/0 2 3"), "cube.obj:5: a face has texture coordinate index 0"));
    CHECK(contains(obj_refusal(triangle + "f -4 -2 -1"), "cube.obj:4: vertex index -4 counts back further than the 3"));
    CHECK(contains(obj_refusal(triangle + "f 1 2 3000000000"), "cube.obj:4: vertex index 3000000000 is too large"));
    CHECK(contains(obj_refusal("v 1 2\n"), "cube.obj:1: a vertex needs three coordinates, this line has 2"));
    CHECK(contains(obj_refusal("v 1 2 3.1+e2\n"), "cube.obj:1: '3.1+e2' was found where a coordinate was expected"));
    CHECK(contains(obj_refusal("v 1 2 \\\n\nv 1 2 3"), "cube.obj:1: "));
    CHECK(contains(obj_refusal("# nothing\n"), "no vertex line"));
    CHECK(contains(obj_refusal("v 1 2 3 \\x\n"), "cube.obj:1: "));
    CHECK(contains(obj_refusal("v 1 2 3 4 5 6 7 \\x\nv"), "cube.obj:2: "));
    CHECK(contains(obj_refusal(triangle + "vt\n"), "cube.obj:4: a texture coordinate needs"));
}

TEST_CASE("OBJ leaves what the checks of the mesh report to them", "[io][obj]") {
    const MeshFile file = read_obj_text(triangle + "f 1 2\nf 1 1 2\nf 1 2 900\nf\n");
    CHECK(same_mesh(file.mesh, mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1}, {0, 0, 1}, {0, 1, 899}, {}})));
}

TEST_CASE("OBJ takes lines and faces of any length", "[io][obj]") {
    std::string text;
    std::vector<Index> corners;
    for (int i = 0; i < 1000; ++i) text += "v " + std::to_string(i) + " 0 0\n";
    text += "f";
    for (int i = 1; i <= 1000; ++i) text += std::string(200, ' ') + std::to_string(i), corners.push_back(i - 1);
    CHECK(read_obj_text(text).mesh.face_vertices == corners);
}

TEST_CASE("OBJ texture coordinates, groups and materials come back as they were", "[io][obj]") {
    const TemporaryFolder folder;
    const std::string text =
        triangle +
        "v 1 1 0\nvt 0 0.1\nvt 1 0\nvt 0.5 1\nmtllib a  b.mtl\no part # one\ng left \\\nright\ns 1\nusemtl red\nf 1/1 2/2 3/3\ns off\nf 2 4 3/1\nusemtl last\n";
    const MeshFile file = read_obj_text(text);
    REQUIRE(file.lines.size() == 7);
    CHECK(file.lines[0].text == "mtllib a  b.mtl");
    CHECK(file.lines[1].text == "o part # one");
    CHECK(file.lines[2].text == "g left  right");
    CHECK(file.lines[5].text == "s off");
    CHECK(file.lines[5].before_face == 1);
    CHECK(file.lines[6].before_face == 2);
    CHECK(file.uvs.components == 2);
    CHECK(file.uvs.values == std::vector<double>{0, 0.1, 1, 0, 0.5, 1});
    CHECK(file.uvs.corner_indices == std::vector<Index>{0, 1, 2, -1, -1, 0});

    const MeshFile back = round_trip(file, folder.file("a.obj"));
    CHECK(same_mesh(back.mesh, file.mesh));
    CHECK(back.uvs.values == file.uvs.values);
    CHECK(back.uvs.corner_indices == file.uvs.corner_indices);
    REQUIRE(back.lines.size() == file.lines.size());
    for (std::size_t i = 0; i < back.lines.size(); ++i) {
        CHECK(back.lines[i].text == file.lines[i].text);
        CHECK(back.lines[i].before_face == file.lines[i].before_face);
    }
}

TEST_CASE("OBJ texture coordinates of one and three numbers share one width", "[io][obj]") {
    const MeshFile file = read_obj_text(triangle + "vt 0.5\nvt 1 2\nvt 3 4 5\nf 1/1 2/2 3/9\n");
    CHECK(file.uvs.components == 3);
    CHECK(file.uvs.values == std::vector<double>{0.5, 0, 0, 1, 2, 0, 3, 4, 5});
    CHECK(file.uvs.corner_indices == std::vector<Index>{0, 1, -1});
    REQUIRE(file.warnings.size() == 1);
    CHECK(contains(file.warnings[0], "1 face corners name a texture coordinate beyond the 3"));
}

TEST_CASE("OBJ vertex colours are numbers behind the coordinates", "[io][obj]") {
    const TemporaryFolder folder;
    const MeshFile file = read_obj_text("v 0 0 0 0.1 0.2 0.3\nv 1 0 0\nv 0 1 0 1 0.5 nan\nf 1 2 3\n");
    REQUIRE(file.properties.size() == 3);
    CHECK(file.properties[0].name == "red");
    CHECK(file.properties[0].kind == lcl::VertexProperty::Kind::colour);
    CHECK(file.properties[0].values == std::vector<double>{0.1, 1, 1});
    CHECK(file.properties[1].values == std::vector<double>{0.2, 1, 0.5});
    CHECK(contains(file.warnings.at(0), "1 vertices have no colour"));
    const MeshFile back = round_trip(file, folder.file("a.obj"));
    REQUIRE(back.properties.size() == 3);
    for (int c = 0; c < 3; ++c) CHECK(same_bits(back.properties[c].values, file.properties[c].values));

    MeshFile bytes = file_of(awkward_patch());
    add_byte_colours(bytes);
    const MeshFile scaled = round_trip(bytes, folder.file("b.obj"));
    REQUIRE(scaled.properties.size() == 3);
    for (int c = 0; c < 3; ++c)
        for (std::size_t v = 0; v < bytes.properties[c].values.size(); ++v) CHECK(scaled.properties[c].values[v] == bytes.properties[c].values[v] / 255);
    const MeshFile alpha = read_obj_text("v 0 0 0 0.1 0.2 0.3 0.4\n");
    REQUIRE(alpha.properties.size() == 4);
    CHECK(alpha.properties[3].values == std::vector<double>{0.4});
}

TEST_CASE("OBJ statements that are not known are counted", "[io][obj]") {
    const MeshFile file = read_obj_text(triangle + "l 1 2\nl 2 3\np 1\ncurv2 \\\n f 1 2 3\n\x01\xff 7\n");
    CHECK(file.unknown_statements == std::vector<std::pair<std::string, Index>>{{"l", 2}, {"p", 1}, {"curv2", 1}, {"??", 1}});
    CHECK(file.mesh.face_count() == 0);
}

TEST_CASE("OBJ tags of infinitely sharp creases and corners are read and written", "[io][obj][tags]") {
    const TemporaryFolder folder;
    const MeshFile file = read_obj_text(triangle +
                                        "f 1 2 3\nt crease 3/1/0 0 1 2 10\nt crease 3/2/0 2 0 1 0.0 inf\nt corner 2/1/0 0 2 12.5\nt corner 2/2/0 1 0 10 0\n"
                                        "t interpolateboundary 1/0/0 2\nt hole 1/0/0 0\nt creasemethod 0/0/1 chaikin\nt hole 1/0/0 1\n");
    using Edge = std::array<Index, 2>;
    CHECK(file.tags.creases == std::vector<Edge>{{0, 1}, {1, 2}, {0, 1}});
    CHECK(file.tags.corners == std::vector<Index>{0, 2, 1});
    CHECK(file.tags.interpolate_boundary == 2);
    CHECK(file.tags.refused.empty());
    CHECK(file.tags.ignored == std::vector<std::string>{"hole", "creasemethod"});
    CHECK(contains(file.warnings.at(0), "hole, creasemethod"));
    const MeshFile back = round_trip(file, folder.file("a.obj"));
    CHECK(back.tags.creases == file.tags.creases);
    CHECK(back.tags.corners == file.tags.corners);
    CHECK(back.tags.interpolate_boundary == 2);
}

TEST_CASE("OBJ tags of semi-sharp features are read and say that they are refused", "[io][obj][tags]") {
    for (const char* tag : {"t crease 2/1/0 0 1 9.99", "t crease 3/2/0 0 1 2 10 0.5", "t corner 1/1/0 0 3", "t corner 1/1/0 0 -1", "t corner 1/1/0 0 nan"}) {
        INFO(tag);
        const MeshFile file = read_obj_text(triangle + tag + "\n");
        CHECK(contains(file.tags.refused, "cube.obj:4: sharpness "));
        CHECK(contains(file.tags.refused, "use 10 or more"));
    }
}

TEST_CASE("OBJ tags that are malformed are refused with file and line", "[io][obj][tags]") {
    for (const char* tag : {"t crease 2/0/0 0 1", "t crease 1/1/0 0 10", "t crease 3/3/0 0 1 2 10 10 10", "t crease 2/1/0 0 1", "t crease 2-1-0 0 1 10",
                            "t crease", "t corner 1/1/0 a 10", "t corner -1/1/0", "t interpolateboundary 1/0/0 3", "t interpolateboundary 0/0/0",
                            "t crease 2/1/0 0 3000000000 10", "t crease 9223372036854775807/1/0 1 2"}) {
        INFO(tag);
        CHECK(contains(obj_refusal(triangle + tag + "\n"), "cube.obj:4: "));
    }
}

TEST_CASE("OBJ holds one normal a vertex when told to", "[io][obj]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}}));
    file.normals = {0, 0, 1, 0, 0.6, 0.8, 0, 0, 1};
    file.uvs = {2, {0, 0, 1, 0}, {0, 1, -1}};
    std::vector<std::string> warnings;
    lcl::write_mesh(folder.file("a.obj"), file, FileFormat::by_ending, warnings);
    CHECK(warnings.empty());
    CHECK(file_bytes(folder.file("a.obj")) == "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 0.6 0.8\nvn 0 0 1\nf 1/1/1 2/2/2 3//3\n");
}
