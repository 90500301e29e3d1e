// SPDX-License-Identifier: BSD-3-Clause
// Points as text, one a line: XYZ, PTS, CSV.
#pragma once

#include "host/io/format.h"
#include "host/mesh/point_cloud.h"

namespace lcl {

/// x y z and further columns, as many in every line, between them blanks or, as in the first line, commas or semicolons. # begins a comment, and so does // in
/// the first line. What the further columns are is told by what stands in them: point_columns.h.
PointCloud read_xyz(const InputBytes& input);

/// The same after a line with the number of points.
PointCloud read_pts(const InputBytes& input);

/// Columns by the names of a header: x, y, z, nx, ny, nz, red, green, blue, in any case and order.
PointCloud read_csv_points(const InputBytes& input);

}  // namespace lcl
