// SPDX-License-Identifier: BSD-3-Clause
// --channels: per-vertex data of the file that is treated like x, y, z.
#pragma once

#include <string>
#include <vector>

#include "host/cli/job.h"

namespace lcl::cli {

/// Names of the properties that the options choose. Exit code 2 where a name is not in the file.
std::vector<std::string> choose_channels(Job& job, lcl_mesh mesh);
/// All per-vertex data of a mesh.
std::vector<std::string> all_channels(lcl_mesh mesh);

/// vertex_count x (3 + channels): x, y, z, then the properties.
std::vector<double> gather_values(lcl_mesh mesh, const std::vector<std::string>& channels);
/// The way back. `values`: vertex_count x (3 + channels).
void scatter_values(lcl_mesh mesh, const std::vector<std::string>& channels, const double* values);

/// For filters, whose results are colours again: one number a channel, 255 or 65535 for colours in whole numbers, 0 for all other data.
std::vector<double> colour_limits(lcl_mesh mesh, const std::vector<std::string>& channels);
/// Rounds colours in whole numbers and keeps them between 0 and their limits, so that they keep their type.
void round_colours(const std::vector<double>& limits, std::size_t vertex_count, double* values);

}  // namespace lcl::cli
