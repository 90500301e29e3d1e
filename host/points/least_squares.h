// SPDX-License-Identifier: BSD-3-Clause
// Least-squares fit of a limit surface to points: control points that make squared distances and a bending energy smallest, by turns with the places of the
// closest points (Hoppe et al. 1994; the bending energy after Halstead, Kass & DeRose 1993).
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

/// Minimises  1/n sum_i |S(x_i) - p_i|^2 + W energy  over control points and places x_i in turn: closest points, then control points with those places fixed by
/// conjugate gradients. energy: the mean over the surface of |S_xx|^2 + 2 |S_xy|^2 + |S_yy|^2 by parameters in which edges of the mesh have length 1
/// (host/points/bending.h). Hoppe et al. keep points at their places in the second half, which crawls; here they may slide along the surface, with a weight as
/// in the method of Levenberg and Marquardt (host/points/fit_system.h): some 5 corrections instead of 30 and more. It ends where the root mean square changes
/// by less than a thousandth, or nothing lowers the sum any more; the result is the best that was seen. Vertices that neither points nor the energy see stay.
/// points: n x 3, finite, at least one (InvalidArgument). control: point_count x 3, where to begin; the surface has the result's points afterwards. surface: of
/// any precision; distances are measured in it. Cancelled by `progress`. Time linear in points and mesh a correction; memory some 200 bytes a point and what
/// FitSystem takes.
LeastSquaresFit fit_least_squares(DeviceSurface& surface, const std::vector<double>& points, std::vector<double> control, const LeastSquaresOptions& options);

}  // namespace lcl
