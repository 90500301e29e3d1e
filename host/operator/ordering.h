// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "host/array.h"
#include "host/mesh/topology.h"

namespace lcl {

/// The vertices in breadth-first order over shared faces, component after component; isolated ones at the end. Vertices of one face are at most one level
/// apart, so rows of A reach only as far as two levels are wide: neighbours stay close in memory, and sweeps can follow each other through the rows
/// (level-based blocking of matrix powers: Alappat et al. 2022). The first component starts at an end of the mesh's longest axis, which keeps levels narrow.
/// Linear time.
Array<Index> breadth_first_order(const Topology& topology, const std::vector<double>& positions);

}  // namespace lcl
