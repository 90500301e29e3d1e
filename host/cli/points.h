// SPDX-License-Identifier: BSD-3-Clause
// Points of a file, as the library reads them.
#pragma once

#include <string>
#include <vector>

#include "host/cli/job.h"

namespace lcl::cli {

/// Whether a file's ending is one of those that hold points.
bool is_points_name(const std::string& path);

/// Rows of three, all finite. What was left out of the file is warned of. Failures have exit code 3 and name the line, or the point.
std::vector<double> read_points(Job& job, const std::string& path);

}  // namespace lcl::cli
