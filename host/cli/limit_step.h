// SPDX-License-Identifier: BSD-3-Clause
// Points to limit points, for `limit` and `refine --limit`.
#pragma once

#include <string>
#include <vector>

#include "host/cli/job.h"

namespace lcl::cli {

/// Replaces points and the named channels of a mesh by A of them.
void move_to_limit(Job& job, lcl_context context, lcl_operator A, lcl_mesh mesh, const std::vector<std::string>& channels);

}  // namespace lcl::cli
