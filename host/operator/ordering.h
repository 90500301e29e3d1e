// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "host/array.h"
#include "host/mesh/topology.h"

namespace lcl {

/// The vertices in breadth-first order over shared faces, isolated ones at the end. Vertices of one face are at most one level apart, so rows of A reach only as
/// far as two levels are wide: neighbours stay close in memory, and sweeps can follow each other through the rows (level-based blocking of matrix powers:
/// Alappat et al. 2022). Levels are counted to both sides, by a core each, from a plane across the longest axis of the mesh, which keeps them narrow; components
/// that the plane does not meet follow one by one. Linear time.
Array<Index> breadth_first_order(const Topology& topology, const std::vector<double>& positions);

}  // namespace lcl
