// SPDX-License-Identifier: BSD-3-Clause
// Which format, which bytes: the readers and writers themselves are one file a format.
//
// Why OBJ, OFF, PLY and STL have readers of ours: what is computed here is judged by vertex and face number and to the last bits of a double, so a file
// must come in as it is. OpenMesh duplicates the vertices of non-manifold input, drops faces that it cannot add, rounds coordinates to float in all text
// formats and cannot read in two threads at once; tinyobjloader keeps face sizes in one byte and so loses faces of more than 255 sides. Neither says on
// which line a file is wrong. OM, which is OpenMesh's own format and keeps doubles, goes through OpenMesh.
#include "host/io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include <unistd.h>

#include "host/io/atomic_file.h"
#include "host/io/content.h"
#include "host/io/format.h"

namespace lcl {
namespace {

/// What a format can hold beside positions and faces.
struct FormatRow {
    FileFormat format;
    const char* name;
    const char* ending;
    MeshFile (*read)(const InputBytes&);
    void (*write)(const MeshFile&, ByteSink&);
    std::optional<MeshFile> (*try_read)(const Text&, const Splitting&);  ///< null where the whole file has to be in memory
    bool holds_colours, holds_properties, holds_corner_uvs, holds_vertex_uvs, holds_normals, holds_lines, holds_tags;
};

constexpr FormatRow format_rows[] = {
    {FileFormat::obj, "OBJ", ".obj", read_obj, write_obj, try_read_obj, true, false, true, true, true, true, true},
    {FileFormat::off, "OFF", ".off", read_off, write_off, nullptr, true, false, false, true, true, false, false},
    {FileFormat::ply, "PLY", ".ply", read_ply, write_ply, nullptr, true, true, true, true, true, false, false},
    {FileFormat::stl, "STL", ".stl", read_stl, write_stl, nullptr, false, false, false, false, false, false, false},
    {FileFormat::om, "OM", ".om", read_om, write_om, nullptr, true, false, false, false, false, false, false},
};

/// Formats of points alone: host/io/points_file.cpp reads them.
struct PointFormatRow {
    FileFormat format;
    const char* name;
    const char* ending;
};

constexpr PointFormatRow point_format_rows[] = {{FileFormat::xyz, "XYZ", ".xyz"}, {FileFormat::csv, "CSV", ".csv"}, {FileFormat::pts, "PTS", ".pts"}};

const FormatRow& row_of(FileFormat format, const std::string& path) {
    for (const FormatRow& row : format_rows)
        if (row.format == format) return row;
    for (const PointFormatRow& row : point_format_rows)
        if (row.format == format)
            throw InvalidArgument(
                shown_name(path) + ": " + row.name +
                " holds points, not a mesh: `limitcl surface` (lcl_surface) makes a mesh from them; meshes are .obj, .off, .ply, .stl or .om");
    throw InvalidArgument("standard input and output need a format: obj, off, ply, stl or om");
}

bool take_ending(std::string& path, std::string_view ending) {
    if (path.size() < ending.size()) return false;
    const bool matches = std::equal(ending.begin(), ending.end(), path.end() - static_cast<std::ptrdiff_t>(ending.size()),
                                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
    if (matches) path.resize(path.size() - ending.size());
    return matches;
}

/// The row of `format`, or where that is by_ending of the path's ending; `gzip` by the ending alone.
const FormatRow& choose_format(const std::string& path, FileFormat format, bool& gzip) {
    std::string stem = path;
    gzip = take_ending(stem, ".gz");
    const bool is_given = format != FileFormat::by_ending || path == "-";
    return row_of(is_given ? format : format_of_path(path, gzip), path);
}

std::string joined_property_names(const MeshFile& file, const ColourColumns& colours) {
    std::string names;
    for (const VertexProperty& property : file.properties)
        if (!colours.holds(property)) names += (names.empty() ? "'" : ", '") + property.name + "'";
    return names;
}

void warn_of_properties(const MeshFile& file, const FormatRow& row, std::vector<std::string>& warnings) {
    if (row.holds_properties) return;
    const ColourColumns colours = find_colours(file);
    const std::string names = joined_property_names(file, colours);
    if (!names.empty()) warnings.push_back(std::string(row.name) + " cannot hold the vertex properties " + names + "; they are left out");
    if (!colours) return;
    if (!row.holds_colours) warnings.push_back(std::string(row.name) + " cannot hold vertex colours; they are left out");
    if (row.format != FileFormat::om) return;
    if (colours.alpha) warnings.push_back("OM cannot hold the alpha of vertex colours; it is left out");
    if (colours.red->type != "uchar" && colours.red->type != "uint8") warnings.push_back("OM holds vertex colours in 8 bits; they are rounded");
}

void warn_of_texture_coordinates(const MeshFile& file, const FormatRow& row, std::vector<std::string>& warnings) {
    if (!has_texture_coordinates(file) || (row.holds_vertex_uvs && has_vertex_texture_coordinates(file) && file.uvs.components == 2)) return;
    if (!row.holds_corner_uvs) warnings.push_back(std::string(row.name) + " cannot hold these texture coordinates; they are left out");
    else if (row.format == FileFormat::ply && file.uvs.components > 2) warnings.push_back("PLY cannot hold the third texture coordinate; it is left out");
}

void warn_of_isolated_vertices(const MeshFile& file, std::vector<std::string>& warnings) {
    std::vector<bool> is_used(static_cast<std::size_t>(file.mesh.vertex_count), false);
    for (const Index v : file.mesh.face_vertices) is_used[static_cast<std::size_t>(v)] = true;
    const auto count = std::count(is_used.begin(), is_used.end(), false);
    if (count > 0) warnings.push_back("STL cannot hold vertices without a face; " + std::to_string(count) + " are left out");
}

/// One sentence for each thing in `file` that the format cannot hold.
void warn_of_losses(const MeshFile& file, const FormatRow& row, std::vector<std::string>& warnings) {
    warn_of_properties(file, row, warnings);
    warn_of_texture_coordinates(file, row, warnings);
    if (!file.normals.empty() && !row.holds_normals) warnings.push_back(std::string(row.name) + " cannot hold vertex normals; they are left out");
    if (!file.lines.empty() && !row.holds_lines) warnings.push_back(std::string(row.name) + " cannot hold groups and materials; they are left out");
    const bool has_rule = file.tags.interpolate_boundary == 0 || file.tags.interpolate_boundary == 2;  // 1 is what no tag means
    if ((has_rule || !file.tags.creases.empty() || !file.tags.corners.empty()) && !row.holds_tags)
        warnings.push_back(std::string(row.name) + " cannot hold creases, corners and the boundary rule; write OBJ to keep them");
    if (row.format == FileFormat::stl) warn_of_isolated_vertices(file, warnings);
}

/// Writers index by what the mesh says; one that contradicts itself is the caller's mistake.
void check_consistency(const MeshFile& file) {
    const PolygonMesh& mesh = file.mesh;
    const std::size_t vertex_count = static_cast<std::size_t>(mesh.vertex_count);
    bool agrees = mesh.vertex_count >= 0 && mesh.positions.size() == 3 * vertex_count && !mesh.face_offsets.empty() && mesh.face_offsets.front() == 0 &&
                  static_cast<std::size_t>(mesh.face_offsets.back()) == mesh.face_vertices.size() &&
                  std::is_sorted(mesh.face_offsets.begin(), mesh.face_offsets.end());
    agrees = agrees && (file.normals.empty() || file.normals.size() == 3 * vertex_count);
    for (const VertexProperty& property : file.properties) agrees = agrees && property.values.size() == vertex_count;
    if (!agrees) throw InvalidArgument("the arrays of the mesh do not have the lengths that its counts demand");
    for (Index f = 0; f < mesh.face_count(); ++f)
        for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c)
            if (mesh.face_vertices[c] < 0 || mesh.face_vertices[c] >= mesh.vertex_count)
                throw InvalidArgument("face " + std::to_string(f) + " uses vertex " + std::to_string(mesh.face_vertices[c]) + ", the mesh has " +
                                          std::to_string(mesh.vertex_count) + " vertices; a mesh with a false index cannot be written",
                                      {{mesh.face_vertices[c]}, {f}});
}

void write_to_sink(const MeshFile& file, const FormatRow& row, bool gzip, ByteSink& sink) {
    if (!gzip) return row.write(file, sink);
    GzipSink packed(sink);
    row.write(file, packed);
    packed.finish();
}

MeshFile read_content(const char* bytes, std::size_t size, const FormatRow& row, const std::string& name, bool with_normals) {
    if (size == 0) throw BadInput(name + " is empty; it holds no mesh");
    return row.read({bytes, size, name, {}, with_normals});
}

/// A plain text is read piece by piece: most of what reading a large file costs is new memory for it. Nothing where that is not for this file.
std::optional<MeshFile> try_read_pieces(const InputFile& file, const FormatRow& row, const std::string& name) {
    char head[2];
    const bool is_file = row.try_read && file.size() > sizeof(head) && ::pread(file.descriptor(), head, sizeof(head), 0) == sizeof(head);
    if (!is_file || is_gzip(head, sizeof(head))) return std::nullopt;
    return within_memory([&] { return row.try_read({nullptr, file.size(), name, file.descriptor()}, {}); }, file.size(), name);
}

}  // namespace

FileFormat find_format(const std::string& path, bool& gzip) {
    std::string stem = path;
    gzip = take_ending(stem, ".gz");
    for (const FormatRow& row : format_rows)
        if (take_ending(stem, row.ending)) return row.format;
    for (const PointFormatRow& row : point_format_rows)
        if (take_ending(stem, row.ending)) return row.format;
    return FileFormat::by_ending;
}

FileFormat format_of_path(const std::string& path, bool& gzip) {
    const FileFormat format = find_format(path, gzip);
    if (format != FileFormat::by_ending) return format;
    throw InvalidArgument("the ending of " + path +
                          " names no mesh format; use .obj, .off, .ply, .stl or .om (points also: .xyz, .csv, .pts), with .gz behind it if packed");
}

MeshFile read_mesh(const std::string& path, FileFormat format, bool with_normals) {
    bool ends_in_gz = false;
    const FormatRow& row = choose_format(path, format, ends_in_gz);
    const InputFile file(path);
    const std::string name = shown_name(path);
    if (!ends_in_gz && !with_normals)
        if (std::optional<MeshFile> mesh = try_read_pieces(file, row, name)) return *std::move(mesh);
    return read_unpacked(file, ends_in_gz, name, [&](const char* bytes, std::size_t size) { return read_content(bytes, size, row, name, with_normals); });
}

MeshFile read_mesh_memory(const char* bytes, std::size_t size, FileFormat format, const std::string& name, bool with_normals) {
    bool ends_in_gz = false;
    const FormatRow& row = choose_format(name, format, ends_in_gz);
    return read_unpacked(bytes, size, name, [&](const char* data, std::size_t length) { return read_content(data, length, row, name, with_normals); });
}

void write_mesh(const std::string& path, const MeshFile& file, FileFormat format, std::vector<std::string>& warnings) {
    bool gzip = false;
    const FormatRow& row = choose_format(path, format, gzip);
    check_consistency(file);
    warn_of_losses(file, row, warnings);
    if (path == "-") {
        StandardOutput output;
        return row.write(file, output);
    }
    AtomicFile output(path);
    write_to_sink(file, row, gzip, output);
    output.commit();
}

ColourColumns find_colours(const MeshFile& file) {
    ColourColumns columns;
    for (const VertexProperty& property : file.properties) {
        if (property.kind != VertexProperty::Kind::colour) continue;
        if (property.name == "red") columns.red = &property;
        if (property.name == "green") columns.green = &property;
        if (property.name == "blue") columns.blue = &property;
        if (property.name == "alpha") columns.alpha = &property;
    }
    return columns.red && columns.green && columns.blue ? columns : ColourColumns{};
}

double full_intensity(const VertexProperty& column) {
    if (column.type == "uchar" || column.type == "uint8") return 255;
    if (column.type == "ushort" || column.type == "uint16") return 65535;
    return column.type == "char" || column.type == "int8" ? 127 : 1;
}

bool has_texture_coordinates(const MeshFile& file) {
    return !file.uvs.corner_indices.empty() && file.uvs.corner_indices.size() == file.mesh.face_vertices.size();
}

bool has_vertex_texture_coordinates(const MeshFile& file) {
    return has_texture_coordinates(file) && file.uvs.corner_indices == file.mesh.face_vertices &&
           file.uvs.values.size() == static_cast<std::size_t>(file.mesh.vertex_count) * static_cast<std::size_t>(file.uvs.components);
}

double round_to_range(double value, double low, double high) { return std::isnan(value) ? 0 : std::clamp(std::round(value), low, high); }

}  // namespace lcl
