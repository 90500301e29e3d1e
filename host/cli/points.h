// SPDX-License-Identifier: BSD-3-Clause
// Points of a file: .xyz .csv .pts as text, .ply .off .obj by the library's mesh readers; each also with .gz.
#pragma once

#include <string>
#include <vector>

namespace lcl::cli {

/// Whether a file's ending is one of those that hold points.
bool is_points_name(const std::string& path);

/// Rows of three, all finite. .xyz: three numbers a line, what follows is ignored; .pts: the same after a line with their count; .csv: the columns x, y and z.
/// Failures have exit code 3 and name the line, or the vertex.
std::vector<double> read_points(const std::string& path);

}  // namespace lcl::cli
