// SPDX-License-Identifier: BSD-3-Clause
// Nearest points of a cloud.
#pragma once

#include <vector>

#include "host/error.h"

namespace lcl {

/// For each place the number of the nearest one of the chosen points. points: n x 3, finite; chosen: their numbers, at least one; places: any number x 3. All
/// cores.
std::vector<Index> nearest_points(const std::vector<double>& points, const std::vector<Index>& chosen, const std::vector<double>& places);

}  // namespace lcl
