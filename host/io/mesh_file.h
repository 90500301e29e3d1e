// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing mesh files: OBJ, OFF, PLY, STL, OM, each also gzipped. Only arrays come out.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "host/mesh/features.h"
#include "host/mesh/polygon_mesh.h"

namespace lcl {

enum class FileFormat { by_ending, obj, off, ply, stl, om, xyz, csv, pts };  ///< the last three: points alone, for host/io/points_file.h

/// One scalar per vertex that a file carries beside x, y, z: a colour component or a PLY property. Colours of OBJ are of type "double", from 0 to 1; those of
/// OFF are that or "uchar"; those of OM "uchar". A writer converts to what its format has.
struct VertexProperty {
    enum class Kind { colour, scalar };
    std::string name;  ///< "red", "green", "blue", "alpha", or the property's own name
    Kind kind = Kind::scalar;
    std::string type;            ///< scalar type in the file ("uchar", "float", "double", ...), so that it is written as it was read
    std::vector<double> values;  ///< vertex_count, in the file's own units (0..255 for uchar colours)
};

/// Texture coordinates: a list, and one entry of it (or -1) for each corner, as OBJ has them.
struct TextureCoordinates {
    int components = 2;
    std::vector<double> values;         ///< count x components
    std::vector<Index> corner_indices;  ///< corner_count of the mesh, or empty
};

/// A line of an OBJ file that is kept in its place: o, g, s, usemtl before a face; mtllib before the first.
struct PassThroughLine {
    Index before_face;
    std::string text;
};

/// Sharpness tags of OpenSubdiv's OBJ dialect.
struct MeshTags {
    std::vector<std::array<Index, 2>> creases;  ///< infinitely sharp edges
    std::vector<Index> corners;                 ///< infinitely sharp vertices
    int interpolate_boundary = -1;              ///< k of `t interpolateboundary`, -1 if the file has none
    std::string refused;                        ///< not empty: a semi-sharp tag was met; the sentence that refuses it
    std::vector<std::string> ignored;           ///< names of other tags, once each
};

/// A mesh as a file holds it.
struct MeshFile {
    PolygonMesh mesh;
    std::vector<VertexProperty> properties;
    TextureCoordinates uvs;
    std::vector<PassThroughLine> lines;
    MeshTags tags;
    std::vector<std::pair<std::string, Index>> unknown_statements;  ///< OBJ statements that were skipped, with their number
    std::vector<double> normals;                                    ///< only for writing (limit normals): vertex_count x 3, or empty
    std::vector<double> given_normals;  ///< only from reading, where asked for: vertex_count x 3, NaN where a vertex has none; empty where none has one
    std::vector<std::string> warnings;  ///< what could not be kept, one sentence each
    std::string ply_encoding;           ///< "ascii", "binary_little_endian", "binary_big_endian"; empty: the default
    std::string ply_position_type;      ///< "float", "double"; empty: double
};

/// The format that an ending names (any case, .gz stripped); InvalidArgument if it names none. `gzip` says whether .gz was there.
FileFormat format_of_path(const std::string& path, bool& gzip);
/// The same, by_ending where it names none.
FileFormat find_format(const std::string& path, bool& gzip);

/// Reads a mesh. path "-" reads standard input and needs a format. FileError: cannot be opened; BadInput: malformed, with file and line or byte;
/// InvalidArgument: a format of points alone.
/// Indices are checked for range by find_defects, not here, save where the format makes that impossible; counts in headers that the file cannot hold are
/// BadInput. with_normals: normals of the vertices (OBJ, PLY, OFF) are kept instead of dropped; takes longer.
MeshFile read_mesh(const std::string& path, FileFormat format = FileFormat::by_ending, bool with_normals = false);

/// The same from memory (fuzzers, tests, standard input): `name` stands in messages.
MeshFile read_mesh_memory(const char* bytes, std::size_t size, FileFormat format, const std::string& name, bool with_normals = false);

/// Writes complete or not at all: a temporary file in the same folder, then rename. path "-" writes standard output and needs a format. WriteError if that
/// fails. `warnings` receives what the format cannot hold, one sentence each. A mesh with other than triangles to STL: InvalidArgument.
void write_mesh(const std::string& path, const MeshFile& file, FileFormat format, std::vector<std::string>& warnings);

}  // namespace lcl
