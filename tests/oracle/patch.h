// SPDX-License-Identifier: BSD-3-Clause
// Pieces of a surface that are refined on their own, again and again, round one vertex. Internal to tests/oracle.
#pragma once

#include <vector>

#include "tests/oracle/subdivide.h"

namespace oracle {

/// Some faces of a surface on their own; vertex i of the patch is vertex origin[i] of the surface.
struct Patch {
    Surface surface;
    std::vector<int> origin;
};

Patch patch_of(const Surface& surface, const std::vector<std::vector<int>>& faces, int first_vertex);

/// All faces that contain v, in their order: everything that the new faces round v depend on. v is vertex 0 of the patch.
Patch umbrella_of(const Surface& surface, int v);

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& weights, const std::vector<int>& rows);

/// Whether two patches are refined by the same matrix.
bool is_same(const Surface& a, const Surface& b);

/// The options of a patch, with the blend ratios of its own vertices.
lcl::SchemeOptions options_for(const lcl::SchemeOptions& options, const std::vector<int>& origin);

/// Follows the face that a vertex becomes; on a curve the new face on the edge from its last to its first point, which is the vertex's piece of the curve.
Patch next_doo_sabin_patch(const Step& step, const Patch& patch, bool follows_curve);

}  // namespace oracle
