// SPDX-License-Identifier: BSD-3-Clause
// Limit normals by refining again and again round one vertex: what the normals of the faces there tend to.
#pragma once

#include <vector>

#include <Eigen/Dense>

#include "tests/oracle/subdivide.h"

namespace oracle {

struct FaceNormal {
    int face = 0;  ///< of the surface; at the vertex
    Eigen::Vector3d normal;
    double error = 0;  ///< estimate, from how the normals change from level to level; large where there is no limit
};

/// Unit normals at a vertex, as seen from each of its faces, by `levels` refinements: those of the refined faces there. levels 0: as many as it takes until
/// rounding sets in; the level with the least estimated error counts.
std::vector<FaceNormal> limit_normals(const Surface& surface, const lcl::SchemeOptions& options, const Eigen::MatrixXd& points, int vertex, int levels = 0);

}  // namespace oracle
