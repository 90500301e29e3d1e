// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/points_file.h"

#include "host/io/content.h"
#include "host/io/format.h"
#include "host/io/point_columns.h"
#include "host/io/point_text.h"
#include "host/parallel.h"

namespace lcl {
namespace {

std::vector<double> colour_rows(const ColourColumns& columns, std::size_t count) {
    std::vector<double> rows(3 * count);
    const VertexProperty* const components[3] = {columns.red, columns.green, columns.blue};
    parallel_for_each(count, [&](std::size_t i) {
        for (std::size_t c = 0; c < 3; ++c) rows[3 * i + c] = components[c]->values[i];
    });
    return rows;
}

/// 0 where the type does not say it.
double full_intensity_by_type(const VertexProperty& column) {
    const double full = full_intensity(column);
    return full > 1 ? full : 0;
}

void warn_of_rest(const MeshFile& file, const ColourColumns& colours, PointCloud& cloud) {
    const Index faces = file.mesh.face_count();
    if (faces > 0) cloud.warnings.push_back(faces == 1 ? "the face was left out" : "the " + std::to_string(faces) + " faces were left out");
    std::string names;
    std::size_t count = 0;
    for (const VertexProperty& property : file.properties)
        if (!colours.holds(property) || &property == colours.alpha) names += (count++ > 0 ? ", '" : "'") + property.name + "'";
    if (count > 0) cloud.warnings.push_back((count == 1 ? "the property " : "the properties ") + names + (count == 1 ? " was" : " were") + " left out");
}

PointCloud cloud_of(MeshFile file, const std::string& name) {
    PointCloud cloud;
    cloud.points = std::move(file.mesh.positions);
    cloud.normals = std::move(file.given_normals);
    cloud.warnings = std::move(file.warnings);
    if (const BadRows bad = bad_points(cloud.points); bad.count > 0)
        throw BadInput(name + ": point " + std::to_string(bad.first[0]) + not_finite_text(bad), {bad.first, {}});
    const ColourColumns colours = find_colours(file);
    if (colours) take_colours(cloud, colour_rows(colours, cloud.count()), full_intensity_by_type(*colours.red));
    warn_of_rest(file, colours, cloud);
    return cloud;
}

PointCloud read_content(const InputBytes& input, FileFormat format) {
    switch (format) {
        case FileFormat::xyz: return read_xyz(input);
        case FileFormat::csv: return read_csv_points(input);
        case FileFormat::pts: return read_pts(input);
        case FileFormat::obj: return cloud_of(read_obj(input), input.name);
        case FileFormat::off: return cloud_of(read_off(input), input.name);
        default: return cloud_of(read_ply(input), input.name);
    }
}

PointCloud read_bytes(const char* bytes, std::size_t size, FileFormat format, const std::string& name) {
    if (size == 0) throw BadInput(name + " is empty; it holds no points");
    PointCloud cloud = read_content({bytes, size, name, {}, true}, format);
    settle_normals(cloud);
    return cloud;
}

/// The format that is given, or else that of the path's ending.
FileFormat choose_format(const std::string& path, FileFormat format, bool& gzip) {
    const FileFormat by_ending = find_format(path, gzip);
    if (format == FileFormat::by_ending) format = by_ending;
    if (format == FileFormat::by_ending)
        throw InvalidArgument(path == "-" ? "standard input needs a format: ply, xyz, csv, off, obj or pts"
                                          : "the ending of " + path +
                                                " names no format of points; use .ply, .xyz, .csv, .off, .obj or .pts, with .gz behind it if packed");
    if (format == FileFormat::stl || format == FileFormat::om)
        throw InvalidArgument(shown_name(path) + ": points are read from .ply, .xyz, .csv, .off, .obj or .pts, not from .stl or .om; convert it");
    return format;
}

}  // namespace

PointCloud read_points(const std::string& path, FileFormat format) {
    bool ends_in_gz = false;
    const FileFormat chosen = choose_format(path, format, ends_in_gz);
    const InputFile file(path);
    const std::string name = shown_name(path);
    return read_unpacked(file, ends_in_gz, name, [&](const char* bytes, std::size_t size) { return read_bytes(bytes, size, chosen, name); });
}

PointCloud read_points_memory(const char* bytes, std::size_t size, FileFormat format, const std::string& name) {
    bool ends_in_gz = false;
    const FileFormat chosen = choose_format(name, format, ends_in_gz);
    return read_unpacked(bytes, size, name, [&](const char* data, std::size_t length) { return read_bytes(data, length, chosen, name); });
}

}  // namespace lcl
