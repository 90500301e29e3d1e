// SPDX-License-Identifier: BSD-3-Clause
// What the format files of host/io share: the bytes that come in, the sink that bytes go out to, and one reader and one writer per format.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "host/io/line_pieces.h"
#include "host/io/mesh_file.h"

namespace lcl {

/// The whole content of a file, already unpacked. `name` stands in messages.
struct InputBytes {
    const char* data;
    std::size_t size;
    const std::string& name;
    Splitting splitting = {};
    bool with_normals = false;  ///< MeshFile::given_normals is asked for
};

/// Where writers send their bytes, in order; a sink that cannot take them throws WriteError.
struct ByteSink {
    virtual ~ByteSink() = default;
    virtual void write(const char* bytes, std::size_t size) = 0;
};

MeshFile read_obj(const InputBytes& input);
MeshFile read_off(const InputBytes& input);
MeshFile read_ply(const InputBytes& input);
MeshFile read_stl(const InputBytes& input);
MeshFile read_om(const InputBytes& input);

/// The same from a text that need not be in memory. Nothing where something is wrong: read_obj says what.
std::optional<MeshFile> try_read_obj(const Text& text, const Splitting& splitting);

void write_obj(const MeshFile& file, ByteSink& sink);
void write_off(const MeshFile& file, ByteSink& sink);
void write_ply(const MeshFile& file, ByteSink& sink);
void write_stl(const MeshFile& file, ByteSink& sink);
void write_om(const MeshFile& file, ByteSink& sink);

/// The colour columns of a mesh; all null unless red, green and blue are there. `alpha` may be null alone.
struct ColourColumns {
    const VertexProperty* red = nullptr;
    const VertexProperty* green = nullptr;
    const VertexProperty* blue = nullptr;
    const VertexProperty* alpha = nullptr;

    explicit operator bool() const { return red != nullptr; }
    bool holds(const VertexProperty& property) const { return &property == red || &property == green || &property == blue || &property == alpha; }
};

ColourColumns find_colours(const MeshFile& file);

/// What full intensity is in a column's units: 255 for uchar, 65535 for ushort, 1 for floating point, and so on.
double full_intensity(const VertexProperty& column);

/// True if the mesh has texture coordinates, one entry of the list (or -1) for every corner.
bool has_texture_coordinates(const MeshFile& file);

/// True if texture coordinate v belongs to vertex v at every corner, which is all that OFF can say.
bool has_vertex_texture_coordinates(const MeshFile& file);

/// The values rounded into a whole number of the range low..high; NaN gives 0.
double round_to_range(double value, double low, double high);

}  // namespace lcl
