// SPDX-License-Identifier: BSD-3-Clause
// Checks of kinds of patches and of their modes that hold for every scheme.
#pragma once

#include <vector>

#include "host/evaluate/modes.h"

namespace modes_support {

/// Rows of `step` and of the cells sum to 1; rows of inner points have no entries at outer ones; a turn by one face maps the inner step on itself.
void check_kind(const lcl::PatchKind& kind);

/// - Mode 0 is the constant; values descend; powers are 0 or 1.
/// - cells[k] step^m as matrices, m up to 30, to 1e-12 of the largest element.
/// - What is left of control points when their limit is taken away, relative to its own size, which shrinks: derivatives near the extraordinary point.
void check_modes(const lcl::PatchKind& kind, const lcl::Modes& modes);

/// The values of all modes of power 0, in any order, are `expected`.
void check_values(const lcl::Modes& modes, std::vector<double> expected);

}  // namespace modes_support
