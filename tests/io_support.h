// SPDX-License-Identifier: BSD-3-Clause
// What the tests of mesh files share: a folder that goes away, awkward meshes, text as a file, the sentence of an error.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include "host/io/mesh_file.h"

namespace io_test {

/// A new folder, removed with all that is in it.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "limitcl-io-XXXXXX").string();
        if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder could be made");
        path_ = pattern;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::string file(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// Standard input or output from or to a file, as long as it lives.
class Redirection {
public:
    Redirection(int descriptor, const std::string& path, const char* mode) : descriptor_(descriptor), saved_(::dup(descriptor)) {
        std::FILE* file = std::fopen(path.c_str(), mode);
        ::dup2(::fileno(file), descriptor);
        std::fclose(file);
    }
    ~Redirection() {
        ::dup2(saved_, descriptor_);
        ::close(saved_);
    }

private:
    int descriptor_, saved_;
};

inline std::string file_bytes(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_bytes(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

inline lcl::MeshFile read_text(const std::string& text, lcl::FileFormat format, const std::string& name = "text") {
    return lcl::read_mesh_memory(text.data(), text.size(), format, name);
}

/// The sentence of the error `E` that `action` throws; "no error" if none.
template <class E, class Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const E& error) {
        return error.what();
    }
    return "no error";
}

/// The sentence with which a text is refused as bad input.
inline std::string refusal(const std::string& text, lcl::FileFormat format, const std::string& name = "text") {
    return error_of<lcl::BadInput>([&] { read_text(text, format, name); });
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Equal to the last bit, also where NaN or -0.
inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

inline bool same_mesh(const lcl::PolygonMesh& a, const lcl::PolygonMesh& b) {
    return a.vertex_count == b.vertex_count && a.face_offsets == b.face_offsets && a.face_vertices == b.face_vertices && same_bits(a.positions, b.positions);
}

inline lcl::PolygonMesh mesh_of(std::vector<double> positions, const std::vector<std::vector<lcl::Index>>& faces) {
    lcl::PolygonMesh mesh;
    mesh.vertex_count = static_cast<lcl::Index>(positions.size() / 3);
    mesh.positions = std::move(positions);
    for (const std::vector<lcl::Index>& face : faces) {
        mesh.face_vertices.insert(mesh.face_vertices.end(), face.begin(), face.end());
        mesh.face_offsets.push_back(static_cast<lcl::Index>(mesh.face_vertices.size()));
    }
    return mesh;
}

/// A manifold patch of a triangle, two quads and a pentagon, the last vertex isolated; its coordinates need all 17 digits, extremes, and a negative zero.
inline lcl::PolygonMesh awkward_patch() {
    std::vector<double> positions;
    for (int i = 0; i < 30; ++i) positions.push_back(std::sin(1.0 + i) / 3.0);
    positions[0] = -0.0;
    positions[4] = std::numeric_limits<double>::max();
    positions[7] = std::numeric_limits<double>::denorm_min();
    positions[10] = 1e22 + 2097152;
    positions[13] = -std::numeric_limits<double>::min();
    positions[16] = 0.1 + 0.2;
    return mesh_of(std::move(positions), {{0, 1, 3, 2}, {2, 3, 5, 4}, {1, 6, 3}, {4, 5, 3, 6, 7}});
}

/// Two triangles whose coordinates are floats, vertices in order of appearance.
inline lcl::PolygonMesh float_triangles() { return mesh_of({0, 0, 0, 1, 0, 0, 0.25, 1.5, 0.1f, 1e-20f, 3e20f, -7}, {{0, 1, 2}, {2, 1, 3}}); }

inline lcl::MeshFile file_of(lcl::PolygonMesh mesh) {
    lcl::MeshFile file;
    file.mesh = std::move(mesh);
    return file;
}

/// Red, green and blue columns of bytes, a different colour a vertex.
inline void add_byte_colours(lcl::MeshFile& file) {
    const char* names[] = {"red", "green", "blue"};
    for (int c = 0; c < 3; ++c) {
        lcl::VertexProperty column{names[c], lcl::VertexProperty::Kind::colour, "uchar", {}};
        for (lcl::Index v = 0; v < file.mesh.vertex_count; ++v) column.values.push_back((v * 37 + c * 101) % 256);
        file.properties.push_back(column);
    }
}

/// Writes and reads again under one name; `warnings` are those of the writer.
inline lcl::MeshFile round_trip(const lcl::MeshFile& file, const std::string& path, std::vector<std::string>* warnings = nullptr) {
    std::vector<std::string> ignored;
    lcl::write_mesh(path, file, lcl::FileFormat::by_ending, warnings ? *warnings : ignored);
    return lcl::read_mesh(path);
}

}  // namespace io_test
