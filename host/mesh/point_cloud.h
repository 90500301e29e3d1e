// SPDX-License-Identifier: BSD-3-Clause
// A point cloud as plain arrays: what readers of points make and surfaces are made from.
#pragma once

#include <string>
#include <vector>

#include "host/error.h"

namespace lcl {

struct PointCloud {
    std::vector<double> points;         ///< count x 3, model units
    std::vector<double> normals;        ///< count x 3, or empty: none
    std::vector<double> colours;        ///< count x 3 from 0 to 1, or empty: none
    std::vector<std::string> warnings;  ///< what was left out or is doubtful, one sentence each

    std::size_t count() const { return points.size() / 3; }
};

/// Rows that cannot be used: how many, and the first ten.
struct BadRows {
    std::size_t count = 0;
    std::vector<Index> first;
};

/// Points that are not finite.
BadRows bad_points(const std::vector<double>& points);
/// Normals that are not finite, or zero.
BadRows bad_normals(const std::vector<double>& normals);

/// Makes the normals of use to all or to none: one that is not finite or zero becomes that of the nearest point that has one; where more than half are so, all
/// are left out. Either is told by a warning.
void settle_normals(PointCloud& cloud);

/// " is not finite, nor are 3 more: correct them or leave them out", for a sentence that begins with the first.
std::string not_finite_text(const BadRows& bad);

}  // namespace lcl
