// SPDX-License-Identifier: BSD-3-Clause
#include <thread>

#include <sys/stat.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::MeshFile;

namespace {

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    return names;
}

unsigned mode_of(const std::string& path) {
    struct stat status;
    return ::stat(path.c_str(), &status) == 0 ? status.st_mode & 0777 : 0;
}

void write_patch(const std::string& path) {
    std::vector<std::string> warnings;
    lcl::write_mesh(path, file_of(awkward_patch()), FileFormat::by_ending, warnings);
}

}  // namespace

TEST_CASE("endings name the format in any case", "[io][file]") {
    bool gzip = true;
    CHECK(lcl::format_of_path("a.obj", gzip) == FileFormat::obj);
    CHECK_FALSE(gzip);
    CHECK(lcl::format_of_path("x/A.PLY.Gz", gzip) == FileFormat::ply);
    CHECK(gzip);
    CHECK(lcl::format_of_path("a.b.Off", gzip) == FileFormat::off);
    CHECK(lcl::format_of_path(".stl", gzip) == FileFormat::stl);
    CHECK(lcl::format_of_path("a.om", gzip) == FileFormat::om);
    for (const char* path : {"a", "a.gz", "obj", "a.objx", "a.obj.zip", "", "-"})
        CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::format_of_path(path, gzip); }), "names no mesh format"));
}

TEST_CASE("a format that is given wins over the ending", "[io][file]") {
    const TemporaryFolder folder;
    std::vector<std::string> warnings;
    lcl::write_mesh(folder.file("a.txt"), file_of(awkward_patch()), FileFormat::off, warnings);
    CHECK(file_bytes(folder.file("a.txt")).substr(0, 4) == "OFF\n");
    CHECK(same_mesh(lcl::read_mesh(folder.file("a.txt"), FileFormat::off).mesh, awkward_patch()));
}

TEST_CASE("files that are missing, folders or empty are refused in words", "[io][file]") {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& name) { return error_of<lcl::FileError>([&] { lcl::read_mesh(folder.file(name)); }); };
    CHECK(error("none.obj") == "cannot read " + folder.file("none.obj") + ": No such file or directory");
    std::filesystem::create_directory(folder.file("folder.obj"));
    CHECK(error("folder.obj") == folder.file("folder.obj") + " is a directory; name a file in it");
    for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl", "a.om", "a.obj.gz"}) {
        write_bytes(folder.file(name), "");
        CHECK(error_of<lcl::BadInput>([&] { lcl::read_mesh(folder.file(name)); }) == folder.file(name) + " is empty; it holds no mesh");
    }
    CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::read_mesh(folder.file("a.abc")); }), "names no mesh format"));
}

TEST_CASE("files that may not be read or replaced are refused in words", "[io][file]") {
    if (::geteuid() == 0) return;  // root may do all of this
    const TemporaryFolder folder;
    write_patch(folder.file("a.obj"));
    ::chmod(folder.file("a.obj").c_str(), 0400);
    CHECK(contains(error_of<lcl::WriteError>([&] { write_patch(folder.file("a.obj")); }), "Permission denied"));
    ::chmod(folder.file("a.obj").c_str(), 0);
    CHECK(contains(error_of<lcl::FileError>([&] { lcl::read_mesh(folder.file("a.obj")); }), "Permission denied"));
}

TEST_CASE("a file that is written replaces the old one and leaves nothing else", "[io][file]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.obj");
    write_bytes(path, "old");
    ::chmod(path.c_str(), 0640);
    write_patch(path);
    CHECK(same_mesh(lcl::read_mesh(path).mesh, awkward_patch()));
    CHECK(mode_of(path) == 0640);
    CHECK(names_in(folder.path()) == std::vector<std::string>{"a.obj"});
    const mode_t old_mask = ::umask(027);
    write_patch(folder.file("b.obj"));
    ::umask(old_mask);
    CHECK(mode_of(folder.file("b.obj")) == 0640);
}

TEST_CASE("a write that fails leaves the old file and nothing else", "[io][file]") {
    const TemporaryFolder folder;
    write_bytes(folder.file("a.stl"), "old");
    std::vector<std::string> warnings;
    CHECK(error_of<lcl::InvalidArgument>([&] { lcl::write_mesh(folder.file("a.stl"), file_of(awkward_patch()), FileFormat::by_ending, warnings); }) !=
          "no error");
    CHECK(file_bytes(folder.file("a.stl")) == "old");
    CHECK(names_in(folder.path()) == std::vector<std::string>{"a.stl"});
    CHECK(contains(error_of<lcl::WriteError>([&] { write_patch(folder.file("no/such/a.obj")); }), "no file can be made in"));
    std::filesystem::create_directory(folder.file("b.obj"));
    CHECK(contains(error_of<lcl::WriteError>([&] { write_patch(folder.file("b.obj")); }), "it is a directory"));
}

TEST_CASE("a full device is reported", "[io][file]") {
    if (!std::filesystem::exists("/dev/full")) return;
    const TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/full", folder.file("a.obj"));
    CHECK(error_of<lcl::WriteError>([&] { write_patch(folder.file("a.obj")); }) == "cannot write " + folder.file("a.obj") + ": No space left on device");
}

TEST_CASE("symbolic links stay and what they point at is replaced", "[io][file]") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("there"));
    write_bytes(folder.file("there/a.obj"), "old");
    std::filesystem::create_symlink("there/a.obj", folder.file("link.obj"));
    write_patch(folder.file("link.obj"));
    CHECK(std::filesystem::is_symlink(folder.file("link.obj")));
    CHECK(same_mesh(lcl::read_mesh(folder.file("there/a.obj")).mesh, awkward_patch()));
}

TEST_CASE("the output may be the input", "[io][file]") {
    const TemporaryFolder folder;
    write_patch(folder.file("a.ply"));
    MeshFile file = lcl::read_mesh(folder.file("a.ply"));
    file.mesh.positions[0] = 42;
    CHECK(same_mesh(round_trip(file, folder.file("a.ply")).mesh, file.mesh));
}

TEST_CASE("standard streams need a format and carry a whole mesh", "[io][file]") {
    const TemporaryFolder folder;
    std::vector<std::string> warnings;
    CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::read_mesh("-"); }), "need a format"));
    CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::write_mesh("-", file_of(awkward_patch()), FileFormat::by_ending, warnings); }), "need a format"));
    {
        const Redirection output(STDOUT_FILENO, folder.file("out"), "wb");
        lcl::write_mesh("-", file_of(awkward_patch()), FileFormat::ply, warnings);
    }
    MeshFile back;
    {
        const Redirection input(STDIN_FILENO, folder.file("out"), "rb");
        back = lcl::read_mesh("-", FileFormat::ply);
    }
    CHECK(same_mesh(back.mesh, awkward_patch()));
    write_bytes(folder.file("bad"), "OFF\nx");
    const Redirection input(STDIN_FILENO, folder.file("bad"), "rb");
    CHECK(contains(error_of<lcl::BadInput>([&] { lcl::read_mesh("-", FileFormat::off); }), "standard input:2: 'x'"));
}

TEST_CASE("pipes are read to their end", "[io][file]") {
    const TemporaryFolder folder;
    const std::string pipe = folder.file("a.obj");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    std::string text;
    for (int i = 0; i < 20000; ++i) text += "v " + std::to_string(i) + " 0 0\n";
    std::thread writer([&] { write_bytes(pipe, text); });
    const MeshFile file = lcl::read_mesh(pipe);
    writer.join();
    CHECK(file.mesh.vertex_count == 20000);
    CHECK(file.mesh.positions[3 * 19999] == 19999);
}

TEST_CASE("meshes whose arrays contradict each other are not written", "[io][file]") {
    const TemporaryFolder folder;
    std::vector<std::string> warnings;
    const auto refuse = [&](const MeshFile& file) {
        return error_of<lcl::InvalidArgument>([&] { lcl::write_mesh(folder.file("a.ply"), file, FileFormat::by_ending, warnings); });
    };
    MeshFile file = file_of(awkward_patch());
    file.mesh.face_vertices[3] = 99;
    CHECK(contains(refuse(file), "face 0 uses vertex 99, the mesh has 10"));
    file = file_of(awkward_patch());
    file.mesh.positions.pop_back();
    CHECK(contains(refuse(file), "do not have the lengths"));
    file = file_of(awkward_patch());
    file.properties.push_back({"q", lcl::VertexProperty::Kind::scalar, "float", {1}});
    CHECK(contains(refuse(file), "do not have the lengths"));
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("one sentence tells each thing that a format cannot hold", "[io][file]") {
    const TemporaryFolder folder;
    MeshFile file = file_of(float_triangles());
    add_byte_colours(file);
    file.properties.push_back({"q", lcl::VertexProperty::Kind::scalar, "float", {1, 2, 3, 4}});
    file.uvs = {3, {0, 0, 0}, {0, 0, 0, 0, 0, 0}};
    file.normals.assign(12, 1);
    file.lines.push_back({0, "g part"});
    file.tags.creases.push_back({0, 1});
    const auto losses = [&](const char* name) {
        std::vector<std::string> warnings;
        round_trip(file, folder.file(name), &warnings);
        return warnings;
    };
    CHECK(losses("a.obj") == std::vector<std::string>{"OBJ cannot hold the vertex properties 'q'; they are left out"});
    CHECK(losses("a.ply") == std::vector<std::string>{"PLY cannot hold the third texture coordinate; it is left out",
                                                      "PLY cannot hold groups and materials; they are left out",
                                                      "PLY cannot hold creases, corners and the boundary rule; write OBJ to keep them"});
    CHECK(losses("a.off").size() == 4);
    CHECK(losses("a.om").size() == 5);
    CHECK(losses("a.stl").size() == 6);
}

TEST_CASE("four threads read and write at once", "[io][threads]") {
    const TemporaryFolder folder;
    const char* names[] = {"a.obj", "a.off", "a.ply", "a.om", "a.obj.gz", "a.om.gz"};
    std::vector<std::thread> threads;
    std::vector<int> good(4, 0);
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int round = 0; round < 25; ++round)
                for (const char* name : names)
                    good[t] += same_mesh(round_trip(file_of(awkward_patch()), folder.file(std::to_string(t) + name)).mesh, awkward_patch());
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(good == std::vector<int>(4, 150));
}

TEST_CASE("four threads write one file, and it is whole whenever it is read", "[io][threads]") {
    const TemporaryFolder folder;
    write_patch(folder.file("a.obj"));
    std::vector<std::thread> threads;
    std::vector<int> good(4, 0);
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int round = 0; round < 50; ++round) good[t] += same_mesh(round_trip(file_of(awkward_patch()), folder.file("a.obj")).mesh, awkward_patch());
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(good == std::vector<int>(4, 50));
    CHECK(names_in(folder.path()) == std::vector<std::string>{"a.obj"});
}
