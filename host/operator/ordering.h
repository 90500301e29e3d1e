// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "host/array.h"
#include "host/mesh/polygon_mesh.h"

namespace lcl {

/// The vertices along a Morton (Z) curve through their positions, 10 bits an axis; equal keys keep the caller's order. Linear time (radix sort).
Array<Index> morton_order(const std::vector<double>& positions, Index vertex_count);

}  // namespace lcl
