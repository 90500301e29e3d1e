// SPDX-License-Identifier: BSD-3-Clause
#include "host/filter/colour_curve.h"

#include <algorithm>
#include <cmath>

#include "host/error.h"

namespace lcl {
namespace {

/// d with (d_(j-1) + 4 d_j + d_(j+1)) / 6 = colour_j inside and d = colour at both ends, by elimination (diagonally dominant: no pivots).
std::vector<Colour> solve_control(std::vector<Colour> d) {
    const std::size_t count = d.size();
    std::vector<double> upper(count, 0.0);  // of the eliminated matrix, whose diagonal is 1
    for (std::size_t j = 1; j + 1 < count; ++j) {
        const double pivot = 4 - upper[j - 1];
        upper[j] = 1 / pivot;
        for (std::size_t c = 0; c < 3; ++c) d[j][c] = (6 * d[j][c] - d[j - 1][c]) / pivot;
    }
    for (std::size_t j = count - 1; j-- > 1;)
        for (std::size_t c = 0; c < 3; ++c) d[j][c] -= upper[j] * d[j + 1][c];
    return d;
}

/// The point as far beyond `end` as `inner` is before it: with it as neighbour the spline ends in `end`, without curvature.
Colour beyond(const Colour& end, const Colour& inner) { return {2 * end[0] - inner[0], 2 * end[1] - inner[1], 2 * end[2] - inner[2]}; }

}  // namespace

ColourCurve::ColourCurve(const std::vector<Colour>& colours) {
    if (colours.empty()) throw InvalidArgument("the list of colours is empty: give one at least");
    control_ = solve_control(colours);
    if (colours.size() == 1) return;
    const Colour before = beyond(control_[0], control_[1]), after = beyond(control_.back(), control_[control_.size() - 2]);
    control_.insert(control_.begin(), before);
    control_.push_back(after);
}

Colour ColourCurve::at(double t) const {
    if (control_.size() == 1) return control_[0];
    const std::size_t spans = control_.size() - 3;
    const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(spans);
    const std::size_t j = std::min(static_cast<std::size_t>(place), spans - 1);
    const double u = place - static_cast<double>(j), v = 1 - u;
    const double weights[4] = {v * v * v / 6, (4 + 3 * u * u * (u - 2)) / 6, (4 + 3 * v * v * (v - 2)) / 6, u * u * u / 6};
    Colour colour{};
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 4; ++k) colour[c] += weights[k] * control_[j + k][c];
        colour[c] = std::clamp(colour[c], 0.0, 1.0);
    }
    return colour;
}

}  // namespace lcl
