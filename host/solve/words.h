// SPDX-License-Identifier: BSD-3-Clause
// What messages say of an operator by where it comes from.
#pragma once

#include <string>

#include "host/solve/limit_system.h"

namespace lcl {

/// "the limit operator" or "the operator".
const char* operator_name(const LimitSystem& system);
/// What to do about eigenvalues that are too small.
const char* cure(const LimitSystem& system);
/// Why there is no D that makes D A symmetric, as the end of a sentence: "... need it, " + this.
std::string why_not_symmetric(const LimitSystem& system);

}  // namespace lcl
