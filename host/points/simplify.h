// SPDX-License-Identifier: BSD-3-Clause
// Fewer vertices within a tolerance, by edge collapses.
#pragma once

#include <functional>

#include "host/points/fit_mesh.h"

namespace lcl {

struct SimplifyOptions {
    double tolerance = 0;          ///< model units: removed vertices stay so near to the triangles that take their place
    std::size_t max_vertices = 0;  ///< goes on beyond the tolerance down to so many; 0: no matter how many
    /// Called now and then with the number of collapses; false stops (Cancelled).
    std::function<bool(std::size_t)> progress;
};

/// Half-edge collapses in the order of their quadric error (Garland & Heckbert 1997; OpenMesh's decimater), so that the vertices that are left are some of
/// those that were there. No collapse turns a triangle's normal by more than 45 degrees or leaves slivers, and the boundary stays within the tolerance of where
/// it was. 20 to 100 microseconds a vertex.
void simplify(FitMesh& mesh, const SimplifyOptions& options);

}  // namespace lcl
