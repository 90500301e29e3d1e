// SPDX-License-Identifier: BSD-3-Clause
// Limit normals on the host, in plain double: the reference that device results are held against.
#pragma once

#include <vector>

#include "host/operator/tangent_plan.h"

namespace lcl {

struct Normals {
    std::vector<double> vertices;  ///< vertex_count x 3 in the plan's order, unit or 0; 0 at ghosts
    std::vector<double> sides;     ///< side_count x 3
};

/// x: vertex_count x 3 in the plan's order, scaled alike in all three.
Normals host_normals(const Plan& plan, const TangentPlan& tangents, const std::vector<double>& x);

}  // namespace lcl
