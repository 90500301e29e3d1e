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

}  // namespace lcl
