// SPDX-License-Identifier: BSD-3-Clause
// Fewer vertices within a tolerance, by edge collapses.
#pragma once

#include <functional>

#include "host/points/fit_mesh.h"

namespace lcl {

struct SimplifyOptions {
    double tolerance = 0;          ///< model units: removed vertices stay so near to the triangles that take their place
    bool is_graded = false;        ///< leaves no edge of more than four times its neighbours' length, which takes more vertices where points are uneven
    std::size_t max_vertices = 0;  ///< goes on beyond the tolerance down to so many; 0: no matter how many
    /// Called now and then with the number of collapses; false stops (Cancelled).
    std::function<bool(std::size_t)> progress;
};

/// Half-edge collapses in the order of their quadric error (Garland & Heckbert 1997; OpenMesh's decimater), so that the vertices that are left are some of
/// those that were there. Within the tolerance no collapse turns a triangle's normal by more than 45 degrees or leaves slivers, and the boundary stays where it
/// was; beyond it these give way one after the other. Parts of the surface, their handles and boundary loops stay, so more than max_vertices may be left. 20 to
/// 100 microseconds a vertex.
void simplify(FitMesh& mesh, const SimplifyOptions& options);

}  // namespace lcl
