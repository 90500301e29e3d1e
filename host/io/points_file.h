// SPDX-License-Identifier: BSD-3-Clause
// Reading points: the vertices of PLY, OFF and OBJ, and text a point a line (XYZ, PTS, CSV), each also gzipped.
#pragma once

#include <string>

#include "host/io/mesh_file.h"
#include "host/mesh/point_cloud.h"

namespace lcl {

/// Reads points, in the order of the file, as lcl_cloud_read describes it (limitcl.h). path "-" reads standard input and needs a format. FileError: cannot be
/// opened; BadInput: malformed or not finite, with file and line or point; InvalidArgument: a format without points (STL, OM). Duplicates are kept.
PointCloud read_points(const std::string& path, FileFormat format = FileFormat::by_ending);

/// The same from memory: `name` stands in messages.
PointCloud read_points_memory(const char* bytes, std::size_t size, FileFormat format, const std::string& name);

}  // namespace lcl
