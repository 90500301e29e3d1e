// SPDX-License-Identifier: BSD-3-Clause
// --boundary, --creases, --corners, --crease-angle.
#pragma once

#include "host/cli/job.h"

namespace lcl::cli {

/// Adds the sharp features of the options to a mesh that was just read. Indices and edges that the mesh does not have are exit code 3 with file and line.
void add_features(Job& job, lcl_mesh mesh);

}  // namespace lcl::cli
