// SPDX-License-Identifier: BSD-3-Clause
// A list of colours as a curve.
#pragma once

#include <array>
#include <vector>

namespace lcl {

using Colour = std::array<double, 3>;  ///< red, green, blue, from 0 to 1

/// The uniform cubic B-spline B(t), 0 <= t <= 1, that takes colour j at t = j / (count - 1), with natural ends (B'' = 0). Two colours: a straight line; one:
/// that colour (mesh expansion paper, section 5).
class ColourCurve {
public:
    /// InvalidArgument without a colour.
    explicit ColourCurve(const std::vector<Colour>& colours);

    /// B(t), each component cut off at 0 and 1, beyond which a spline may swing between its colours. t outside [0, 1] counts as the nearer end.
    Colour at(double t) const;

private:
    std::vector<Colour> control_;  ///< control point j + 1 is near colour j; one more at both ends
};

}  // namespace lcl
