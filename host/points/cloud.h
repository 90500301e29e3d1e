// SPDX-License-Identifier: BSD-3-Clause
// What has to hold of a point cloud before a surface is made from it.
#pragma once

#include <vector>

#include "host/mesh/point_cloud.h"

namespace lcl {

/// The points of a cloud that are not at the place of an earlier one, in their order; normals and colours with them.
struct DistinctPoints {
    PointCloud cloud;
    std::size_t duplicate_count = 0;
};

/// Drops duplicates and makes normals unit; points and normals are finite, and no normal is zero. BadInput: fewer than four different points, points that all
/// lie on a line or in a plane (within 1e-6 of the diagonal of their box). Sorts once.
DistinctPoints distinct_points(const PointCloud& cloud);

/// Values of the points (n x 3, or empty) at vertices: those of point source[i], or of the nearest one where that is -1. positions: vertex_count x 3. Empty
/// without values.
std::vector<double> values_at_vertices(const PointCloud& cloud, const std::vector<double>& values, const std::vector<double>& positions,
                                       const std::vector<Index>& source);

}  // namespace lcl
