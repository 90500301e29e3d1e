// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::Index;
using lcl::MeshFile;

namespace {

MeshFile read_off_text(const std::string& text) { return read_text(text, FileFormat::off, "a.off"); }
std::string off_refusal(const std::string& text) { return refusal(text, FileFormat::off, "a.off"); }

const lcl::PolygonMesh triangle = mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}});

}  // namespace

TEST_CASE("OFF keeps coordinates to the last bit, and the order of vertices and faces", "[io][off]") {
    const TemporaryFolder folder;
    const MeshFile file = file_of(awkward_patch());
    for (const char* name : {"a.off", "a.OFF.gz"}) {
        const MeshFile back = round_trip(file, folder.file(name));
        CHECK(same_mesh(back.mesh, file.mesh));
        CHECK(back.warnings.empty());
    }
}

TEST_CASE("OFF headers are read in all their forms", "[io][off]") {
    const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
    for (const char* header : {"OFF\n3 1 0\n", "OFF 3 1 0\n", "OFF3 1 0\n", "OFF\n3 1\n", "  OFF # words\n\n# more\n3 1 3 # counts\n", "3 1 3\n",
                               "OFF\r\n3 1 0\r\n", "\tOFF\n3\n1\n"}) {
        INFO(header);
        const MeshFile file = read_off_text(header + body);
        CHECK(same_mesh(file.mesh, triangle));
        CHECK(file.warnings.empty());
    }
}

TEST_CASE("OFF prefixes say what follows the coordinates", "[io][off]") {
    struct Case {
        const char* text;
        std::size_t properties;
    };
    for (const Case& c : {Case{"NOFF 3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n", 0},
                          Case{"CNOFF 3 1 0\n0 0 0 0 0 1 9 8 7\n1 0 0 0 0 1 9 8 7\n0 1 0 0 0 1 9 8 7\n3 0 1 2\n", 3},
                          Case{"STCNOFF\n3 1 0\n0 0 0 0 0 1 9 8 7 6 0.5 0.25\n1 0 0 0 0 1 9 8 7 6 0 0\n0 1 0 0 0 1 9 8 7 6 1 1\n3 0 1 2\n", 4}}) {
        const MeshFile file = read_off_text(c.text);
        CHECK(same_mesh(file.mesh, triangle));
        CHECK(file.properties.size() == c.properties);
        CHECK(file.warnings.empty());
        if (c.properties >= 3) CHECK(file.properties[2].values == std::vector<double>{7, 7, 7});
        if (c.properties == 4) {
            CHECK(file.uvs.values == std::vector<double>{0.5, 0.25, 0, 0, 1, 1});
            CHECK(file.uvs.corner_indices == std::vector<Index>{0, 1, 2});
        }
    }
}

TEST_CASE("OFF vertex colours are bytes or run from 0 to 1, and come back", "[io][off]") {
    const TemporaryFolder folder;
    const MeshFile bytes = read_off_text("COFF\n3 1 0\n0 0 0 255 0 1 255\n1 0 0 7 8 9\n0 1 0 7 8 9 10\n3 0 1 2\n");
    REQUIRE(bytes.properties.size() == 4);
    CHECK(bytes.properties[0].type == "uchar");
    CHECK(bytes.properties[0].values == std::vector<double>{255, 7, 7});
    CHECK(bytes.properties[3].values == std::vector<double>{255, 255, 10});
    const MeshFile fractions = read_off_text("COFF\n3 1 0\n0 0 0 1 0 0.1\n1 0 0 1 1 1\n0 1 0 0 0 0\n3 0 1 2\n");
    REQUIRE(fractions.properties.size() == 3);
    CHECK(fractions.properties[2].type == "double");
    for (const MeshFile* file : {&bytes, &fractions}) {
        const MeshFile back = round_trip(*file, folder.file("a.off"));
        REQUIRE(back.properties.size() == file->properties.size());
        for (std::size_t c = 0; c < back.properties.size(); ++c) {
            CHECK(back.properties[c].type == file->properties[c].type);
            CHECK(same_bits(back.properties[c].values, file->properties[c].values));
        }
    }
}

TEST_CASE("OFF drops face colours and numbers too many, and says so", "[io][off]") {
    const MeshFile file = read_off_text("OFF\n3 2 0\n0 0 0 9 9 9\n1 0 0\n0 1 0\n3 0 1 2 0.1 0.2 0.3\n3 2 1 0 # none\n\n7\n");
    CHECK(same_mesh(file.mesh, mesh_of({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}, {2, 1, 0}})));
    REQUIRE(file.warnings.size() == 3);
    CHECK(file.warnings[0] == "a.off:9: text behind the last face was ignored");
    CHECK(contains(file.warnings[1], "1 vertex lines have more numbers"));
    CHECK(contains(file.warnings[2], "colours of 1 faces"));
}

TEST_CASE("OFF that is malformed is refused with file and line", "[io][off]") {
    CHECK(contains(off_refusal("PLY\n"), "a.off:1: 'PLY' was found where the word OFF was expected"));
    CHECK(contains(off_refusal("OFF BINARY\nxxxx"), "a.off:1: binary OFF is not read"));
    CHECK(contains(off_refusal("4OFF 1 0 0\n1 2 3 4"), "other than three coordinates"));
    CHECK(contains(off_refusal("nOFF 3\n1 0 0\n1 2 3"), "other than three coordinates"));
    CHECK(contains(off_refusal("OFF\n353535235358 6 0\n0 0 0\n"), "a.off:2: the number of vertices is given as 353535235358, more than the file of"));
    CHECK(contains(off_refusal("OFF\n99999999999999999999999 6 0\n0 0 0\n"), "a.off:2: the number of vertices is given as 99999999999999999999999"));
    CHECK(contains(off_refusal("OFF\n1 400 0\n0 0 0\n"), "a.off:2: the number of faces is given as 400"));
    CHECK(contains(off_refusal("OFF\n-1 400 0\n0 0 0\n"), "a.off:2: the number of vertices is -1"));
    CHECK(contains(off_refusal("OFF\n1 1 0\n0 0 zero\n"), "a.off:3: 'zero'"));
    CHECK(contains(off_refusal("OFF\n1 1 0\n0 0 0\n3 0 0\n      "), "a.off:5: the file ends where a vertex of a face was expected"));
    CHECK(contains(off_refusal("OFF\n1 1 0\n0 0 0\n-3 0 0\n"), "a.off:4: face 0 is given -3 corners"));
    CHECK(contains(off_refusal("OFF\n1 1 0\n0 0 0\n1000 0 0\n"), "a.off:4: face 0 is given 1000 corners"));
    CHECK(contains(off_refusal("OFF\n1 1 0\n0 0 0\n3 0 0 0.5\n"), "a.off:4: '0.5'"));
    CHECK(contains(off_refusal("OFF\n1 1 0\n0 0 0\n3 0 0 5000000000\n"), "a.off:4: 5000000000 is too large"));
    CHECK(contains(off_refusal("OFF\n"), "a.off:2: the file ends where the number of vertices"));
    CHECK(contains(off_refusal("# c\n"), "no content"));
    CHECK(contains(off_refusal("COFF\n1 0 0\n0 0 0 1\n"), "a.off:3: the line ends where a component of a colour"));
}

TEST_CASE("OFF leaves what the checks of the mesh report to them", "[io][off]") {
    const MeshFile file = read_off_text("STOFF\n2 3 0\n0 0 0 0 0\n1 0 nan 1 1\n2 0 1\n3 0 0 -7\n0\n");
    CHECK(file.mesh.face_vertices == std::vector<Index>{0, 1, 0, 0, -7});
    CHECK(file.mesh.face_offsets == std::vector<Index>{0, 2, 5, 5});
    CHECK(std::isnan(file.mesh.positions[5]));
    CHECK(file.uvs.corner_indices.empty());
}

TEST_CASE("OFF holds normals, and texture coordinates that belong to vertices", "[io][off]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(triangle);
    add_byte_colours(file);
    file.normals = {0, 0, 1, 0, 0.6, 0.8, 0, 0, 1};
    file.uvs = {2, {0, 0.1, 1, 0, 0.5, 1}, {0, 1, 2}};
    std::vector<std::string> warnings;
    const MeshFile back = round_trip(file, folder.file("a.off"), &warnings);
    CHECK(warnings.empty());
    CHECK(file_bytes(folder.file("a.off")).substr(0, 56) == "STCNOFF\n3 1 0\n0 0 0 0 0 1 0 101 202 255 0 0.1\n1 0 0 0 0.");
    CHECK(back.uvs.values == file.uvs.values);
    CHECK(back.properties.at(1).values == file.properties[1].values);

    file.uvs.corner_indices = {0, 2, 1};
    round_trip(file, folder.file("a.off"), &warnings);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0] == "OFF cannot hold these texture coordinates; they are left out");
}
