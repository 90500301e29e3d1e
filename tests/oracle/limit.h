// SPDX-License-Identifier: BSD-3-Clause
// Limit points by subdividing again and again round one vertex, until nothing moves.
#pragma once

#include <Eigen/Dense>

#include "tests/oracle/subdivide.h"

namespace oracle {

/// Row of one vertex: its limit point as weights of all vertices (surface.vertex_count). Exact to about 1e-15 a weight.
Eigen::RowVectorXd limit_row(const Surface& surface, const lcl::SchemeOptions& options, int vertex);

/// The limit operator A, vertex_count x vertex_count, row by row. Corners and isolated vertices have identity rows.
Eigen::MatrixXd limit_rows(const lcl::PolygonMesh& mesh, const lcl::FeatureOptions& features, const lcl::SchemeOptions& options);

}  // namespace oracle
