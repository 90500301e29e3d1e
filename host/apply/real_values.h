// SPDX-License-Identifier: BSD-3-Clause
// Numbers as kernels of a Real take and give them.
#pragma once

#include <cstring>

#include "host/field/field.h"

namespace lcl {

inline bool is_double(const Context& context, Real real) { return real == Real::full || (real == Real::wide && context.device().has_double); }

/// What a kernel has written.
inline double real_at(const unsigned char* place, bool as_double) {
    float narrow;
    double value;
    if (as_double) std::memcpy(&value, place, sizeof value);
    else std::memcpy(&narrow, place, sizeof narrow), value = narrow;
    return value;
}

}  // namespace lcl
