// SPDX-License-Identifier: BSD-3-Clause
// Mesh files.
#ifndef LIMITCL_IO_HPP
#define LIMITCL_IO_HPP

#include "mesh.hpp"

namespace limitcl {

enum class Format {
    by_ending = LCL_FORMAT_BY_ENDING,
    obj = LCL_FORMAT_OBJ,
    off = LCL_FORMAT_OFF,
    ply = LCL_FORMAT_PLY,
    stl = LCL_FORMAT_STL,
    om = LCL_FORMAT_OM,
    xyz = LCL_FORMAT_XYZ,  ///< this and what follows: points alone
    csv = LCL_FORMAT_CSV,
    pts = LCL_FORMAT_PTS
};

/// Reads .obj .off .ply .stl .om, each also with .gz. path "-" is standard input and needs a format.
/// Errors: LCL_ERROR_FILE (cannot be opened or read), LCL_ERROR_BAD_INPUT (its content is wrong; the sentence has the line).
inline Mesh read_mesh(const std::string& path, Format format = Format::by_ending) {
    lcl_mesh mesh = nullptr;
    check(lcl_mesh_read(path.c_str(), static_cast<lcl_format>(format), &mesh));
    return Mesh(MeshHandle(mesh));
}

/// The same from a file's bytes in memory; `name` stands in messages.
inline Mesh read_mesh(const void* bytes, std::size_t size, Format format, const std::string& name = "memory") {
    lcl_mesh mesh = nullptr;
    check(lcl_mesh_read_memory(bytes, size, static_cast<lcl_format>(format), name.c_str(), &mesh));
    return Mesh(MeshHandle(mesh));
}

/// The same with the normals of vertices that the file holds (OBJ vn, PLY nx ny nz, OFF with N), for Mesh::file_normals.
inline Mesh read_mesh_with_normals(const std::string& path, Format format = Format::by_ending) {
    lcl_mesh mesh = nullptr;
    check(lcl_mesh_read_with_normals(path.c_str(), static_cast<lcl_format>(format), &mesh));
    return Mesh(MeshHandle(mesh));
}

/// Writes completely or not at all. What the format cannot hold is told by mesh.warnings(). path "-" is standard output and needs a format.
/// Errors: LCL_ERROR_WRITE, LCL_ERROR_UNSUPPORTED (STL holds triangles only), LCL_ERROR_INVALID_ARGUMENT (unknown ending).
inline void write_mesh(const Mesh& mesh, const std::string& path, Format format = Format::by_ending) {
    check(lcl_mesh_write(mesh.get(), path.c_str(), static_cast<lcl_format>(format)));
}

/// The format that a path's ending names. Error LCL_ERROR_INVALID_ARGUMENT for an unknown one.
inline Format format_of_path(const std::string& path) {
    lcl_format format = LCL_FORMAT_BY_ENDING;
    check(lcl_format_of_path(path.c_str(), &format));
    return static_cast<Format>(format);
}

}  // namespace limitcl

#endif
