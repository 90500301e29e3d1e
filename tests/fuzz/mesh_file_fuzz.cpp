// SPDX-License-Identifier: BSD-3-Clause
// Any format, chosen by the first byte, packed or not; what is read must be consistent and come back from a PLY file's and an OBJ file's text.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "host/io/format.h"
#include "host/io/mesh_file.h"

namespace {

struct MemorySink : lcl::ByteSink {
    void write(const char* bytes, std::size_t size) override { text.append(bytes, size); }
    std::string text;
};

bool is_consistent(const lcl::MeshFile& file) {
    bool agrees =
        file.mesh.positions.size() == 3 * static_cast<std::size_t>(file.mesh.vertex_count) && file.mesh.face_offsets.back() == file.mesh.corner_count();
    for (const lcl::VertexProperty& property : file.properties) agrees = agrees && property.values.size() == static_cast<std::size_t>(file.mesh.vertex_count);
    for (const lcl::Index index : file.uvs.corner_indices)
        agrees = agrees && (index < 0 || static_cast<std::size_t>(index + 1) * static_cast<std::size_t>(file.uvs.components) <= file.uvs.values.size());
    return agrees;
}

void expect_same_faces(const lcl::MeshFile& file, void (*write)(const lcl::MeshFile&, lcl::ByteSink&), lcl::FileFormat format) {
    MemorySink sink;
    write(file, sink);
    const lcl::MeshFile back = lcl::read_mesh_memory(sink.text.data(), sink.text.size(), format, "fuzz again");
    if (back.mesh.face_vertices != file.mesh.face_vertices || back.mesh.face_offsets != file.mesh.face_offsets) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 1) return 0;
    try {
        const auto format = static_cast<lcl::FileFormat>(1 + data[0] % 5);
        const lcl::MeshFile file = lcl::read_mesh_memory(reinterpret_cast<const char*>(data) + 1, size - 1, format, "fuzz");
        if (!is_consistent(file)) std::abort();
        for (const lcl::Index v : file.mesh.face_vertices)
            if (v < 0 || v >= file.mesh.vertex_count) return 0;
        expect_same_faces(file, lcl::write_ply, lcl::FileFormat::ply);
        if (file.mesh.vertex_count > 0) expect_same_faces(file, lcl::write_obj, lcl::FileFormat::obj);
    } catch (const lcl::BadInput&) {
    }
    return 0;
}
