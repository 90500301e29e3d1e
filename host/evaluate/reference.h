// SPDX-License-Identifier: BSD-3-Clause
// Plain evaluation of patches in double, one place at a time: what kernels are compared with.
#pragma once

#include <array>
#include <vector>

#include "host/evaluate/patch_table.h"

namespace lcl {

/// Value and derivatives by (u, v), in the order S, S_u, S_v, S_uu, S_uv, S_vv.
using SurfaceJet = std::array<std::array<double, 3>, 6>;

/// Powers of the kind's step on control points from which the limit point is subtracted; no eigenstructure. At an irregular patch's (0, 0): the limit point,
/// unit limit tangents along the two sides, NaN for the second derivatives. control: control_count x 3.
SurfaceJet reference_jet(const PatchTable& table, const std::vector<double>& control, const PatchPlace& place);

/// Weights of a regular patch's control points for S, S_s, S_t, S_ss, S_st, S_tt: 6 x regular_point_count, rows one after the other.
std::vector<double> regular_weights(Scheme scheme, double s, double t);

}  // namespace lcl
