// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::MeshFile;

namespace {

/// The bytes of awkward_patch() as a packed OBJ.
std::string packed_patch(const TemporaryFolder& folder) {
    std::vector<std::string> warnings;
    lcl::write_mesh(folder.file("packed.obj.gz"), file_of(awkward_patch()), FileFormat::by_ending, warnings);
    return file_bytes(folder.file("packed.obj.gz"));
}

}  // namespace

TEST_CASE("packed files are known by their first bytes, whatever their name", "[io][gzip]") {
    const TemporaryFolder folder;
    const std::string packed = packed_patch(folder);
    REQUIRE(packed.substr(0, 2) == "\x1f\x8b");
    write_bytes(folder.file("plain.obj"), packed);
    CHECK(same_mesh(lcl::read_mesh(folder.file("plain.obj")).mesh, awkward_patch()));
    CHECK(same_mesh(read_text(packed, FileFormat::obj).mesh, awkward_patch()));
}

TEST_CASE("packed files of several members are one text", "[io][gzip]") {
    const TemporaryFolder folder;
    const std::string twice = packed_patch(folder) + packed_patch(folder);
    const MeshFile file = read_text(twice, FileFormat::obj);
    CHECK(file.mesh.vertex_count == 20);
    CHECK(file.mesh.face_count() == 8);
    CHECK(read_text(twice + "padding", FileFormat::obj).mesh.vertex_count == 20);
}

TEST_CASE("the same mesh is packed to the same bytes", "[io][gzip]") {
    const TemporaryFolder folder;
    CHECK(packed_patch(folder) == packed_patch(folder));
}

TEST_CASE("packed files larger than any buffer come back", "[io][gzip]") {
    const TemporaryFolder folder;
    MeshFile file;
    for (int i = 0; i < 300000; ++i) file.mesh.positions.push_back(std::sin(i));
    file.mesh.vertex_count = 100000;
    CHECK(same_bits(round_trip(file, folder.file("a.obj.gz")).mesh.positions, file.mesh.positions));
    // Nothing but zeros packs 1000 : 1, more than the four bytes of length in the file can be trusted for.
    file.mesh.positions.assign(file.mesh.positions.size(), 0.0);
    const MeshFile back = round_trip(file, folder.file("b.ply.gz"));
    CHECK(same_bits(back.mesh.positions, file.mesh.positions));
    std::string bytes = file_bytes(folder.file("b.ply.gz"));
    CHECK(bytes.size() < 5000);
}

TEST_CASE("packed files that are damaged, cut off or not packed are refused", "[io][gzip]") {
    const TemporaryFolder folder;
    const std::string packed = packed_patch(folder);
    for (std::size_t size = 2; size < packed.size(); ++size)
        CHECK(contains(refusal(packed.substr(0, size), FileFormat::obj, "a.obj.gz"), "a.obj.gz: the gzip data ends too early"));
    std::string damaged = packed;
    damaged[packed.size() / 2] = static_cast<char>(damaged[packed.size() / 2] ^ 0x55);
    CHECK(contains(refusal(damaged, FileFormat::obj, "a.obj.gz"), "a.obj.gz: the gzip data "));
    write_bytes(folder.file("b.obj.gz"), "v 0 0 0\n");
    CHECK(contains(error_of<lcl::BadInput>([&] { lcl::read_mesh(folder.file("b.obj.gz")); }), "is no gzip file"));
}
