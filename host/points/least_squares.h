// SPDX-License-Identifier: BSD-3-Clause
// Least-squares fit of a limit surface to points: control points that make squared distances and a bending energy smallest, by turns with the places of the
// closest points (Hoppe et al. 1994; the bending energy of Halstead, Kass & DeRose 1993).
#pragma once

#include <functional>
#include <vector>

#include "host/evaluate/device_surface.h"

namespace lcl {

struct LeastSquaresOptions {
    double fair = 1e-3;        ///< W
    int max_corrections = 30;  ///< of the parameters
    /// Called before each correction with their number so far and the largest distance then, model units; false stops (Cancelled).
    std::function<bool(int, double)> progress;
};

struct LeastSquaresFit {
    std::vector<double> control;    ///< point_count x 3, model units
    std::vector<double> distances;  ///< of every point to that surface, model units, not signed
    int corrections = 0;
    int iterations = 0;  ///< of conjugate gradients, all corrections together
    double seconds_solve = 0, seconds_measure = 0;
};

/// Minimises  1/n sum_i |S(x_i) - p_i|^2 + W/m sum over the m charts of the integral of |S_uu|^2 + 2 |S_uv|^2 + |S_vv|^2  over control points and places x_i in
/// turn: closest points, then conjugate gradients, until the root mean square changes by less than a thousandth. points: n x 3, finite. `control`: where to
/// begin, which also holds for the surface afterwards (its points are the result's). Time linear in points and mesh a turn; memory of the rows linear in the
/// mesh.
LeastSquaresFit fit_least_squares(DeviceSurface& surface, const std::vector<double>& points, std::vector<double> control, const LeastSquaresOptions& options);

}  // namespace lcl
