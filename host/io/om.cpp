// SPDX-License-Identifier: BSD-3-Clause
// OM, by OpenMesh. Its readers and writers are one set of objects for the whole process, with state: one thread at a time.
#include <mutex>
#include <sstream>
#include <stdexcept>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // OpenMesh's vectors are made without a value, and filled later
#endif
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include "host/io/format.h"
#include "host/io/om_chunks.h"
#include "include/limitcl/openmesh.hpp"

namespace lcl {
namespace {

struct OmTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    using Color = OpenMesh::Vec3uc;  // what the file has
};
using OmMesh = OpenMesh::PolyMesh_ArrayKernelT<OmTraits>;

std::mutex& open_mesh_mutex() {
    static std::mutex mutex;
    return mutex;
}

/// Keeps OpenMesh's streams silent and leaves them as they were.
class Silence {
public:
    Silence() {
        for (int i = 0; i < 3; ++i) {
            was_enabled_[i] = streams_[i]->is_enabled();
            streams_[i]->disable();
        }
    }
    ~Silence() {
        for (int i = 0; i < 3; ++i)
            if (was_enabled_[i]) streams_[i]->enable();
            else streams_[i]->disable();
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

private:
    OpenMesh::mostream* streams_[3] = {&omlog(), &omerr(), &omout()};
    bool was_enabled_[3];
};

void take_colours(const OmMesh& mesh, MeshFile& file) {
    constexpr const char* names[] = {"red", "green", "blue"};
    for (std::size_t i = 0; i < 3; ++i) {
        VertexProperty column{names[i], VertexProperty::Kind::colour, "uchar", {}};
        for (const OpenMesh::VertexHandle v : mesh.vertices()) column.values.push_back(mesh.color(v)[i]);
        file.properties.push_back(std::move(column));
    }
}

void give_colours(const ColourColumns& colours, OmMesh& mesh) {
    const VertexProperty* columns[] = {colours.red, colours.green, colours.blue};
    for (const OpenMesh::VertexHandle v : mesh.vertices()) {
        OpenMesh::Vec3uc colour;
        for (std::size_t i = 0; i < 3; ++i) {
            const double value = columns[i]->values[static_cast<std::size_t>(v.idx())] / full_intensity(*columns[i]);
            colour[i] = static_cast<unsigned char>(round_to_range(255 * value, 0, 255));
        }
        mesh.set_color(v, colour);
    }
}

OmMesh build_mesh(const MeshFile& file) try {
    return limitcl::to_openmesh<OmTraits>(file.mesh.face_offsets, file.mesh.face_vertices, file.mesh.positions);
} catch (const std::invalid_argument& error) {
    throw BadInput(std::string("OM cannot hold this mesh: ") + error.what() + "; write OBJ or PLY");
}

/// OpenMesh 9 writes all indices in as many bits as 4 x the number of edges needs; vertices that no edge has may be more.
void check_index_width(const OmMesh& mesh) {
    const std::size_t largest = mesh.n_edges() * 4 <= 256 ? 127 : mesh.n_edges() * 4 <= 65536 ? 32767 : 2147483647;
    if (mesh.n_edges() > 0 && mesh.n_vertices() > largest + 1)
        throw BadInput("OM cannot hold " + std::to_string(mesh.n_vertices()) + " vertices with no more than " + std::to_string(mesh.n_edges()) +
                       " edges (most vertices are isolated); write OBJ or PLY");
}

}  // namespace

MeshFile read_om(const InputBytes& input) {
    const OmContent content = check_om(input);
    std::istringstream stream(content.bytes);
    OmMesh mesh;
    mesh.request_vertex_colors();
    const std::lock_guard<std::mutex> lock(open_mesh_mutex());
    const Silence silence;
    OpenMesh::IO::Options options(OpenMesh::IO::Options::VertexColor | OpenMesh::IO::Options::Status);
    const bool was_read = OpenMesh::IO::read_mesh(mesh, stream, ".om", options);
    if (!was_read) throw BadInput(input.name + ": OpenMesh cannot read this OM file; it may come from a newer version");
    // Only version 1 lists faces that OpenMesh then has to connect, which it does for manifold meshes alone.
    if (mesh.n_vertices() != static_cast<std::size_t>(content.vertex_count) || mesh.n_faces() != static_cast<std::size_t>(content.face_count))
        throw BadInput(input.name + ": OpenMesh cannot connect the faces of this OM file, as they are not manifold");
    limitcl::OpenMeshArrays arrays = limitcl::from_openmesh(mesh);
    MeshFile file;
    file.mesh.vertex_count = static_cast<Index>(arrays.positions.size() / 3);
    file.mesh.face_offsets = std::move(arrays.face_offsets);
    file.mesh.face_vertices = std::move(arrays.face_vertices);
    file.mesh.positions = std::move(arrays.positions);
    if (content.has_colours) take_colours(mesh, file);
    for (const std::string& what : content.dropped) file.warnings.push_back(what + " were dropped");
    return file;
}

void write_om(const MeshFile& file, ByteSink& sink) {
    const ColourColumns colours = find_colours(file);
    std::ostringstream stream;
    {
        const std::lock_guard<std::mutex> lock(open_mesh_mutex());
        const Silence silence;
        OmMesh mesh = build_mesh(file);
        check_index_width(mesh);
        OpenMesh::IO::Options options(OpenMesh::IO::Options::Binary);
        if (colours) {
            mesh.request_vertex_colors();
            give_colours(colours, mesh);
            options += OpenMesh::IO::Options::VertexColor;
        }
        if (!OpenMesh::IO::write_mesh(mesh, stream, ".om", options)) throw WriteError("OpenMesh could not write the OM file");
    }
    const std::string bytes = stream.str();
    sink.write(bytes.data(), bytes.size());
}

}  // namespace lcl
