// SPDX-License-Identifier: BSD-3-Clause
// Numbers as kernels of a Real take and give them.
#pragma once

#include <cstring>
#include <vector>

#include "host/field/field.h"

namespace lcl {

inline bool is_double(const Context& context, Real real) { return real == Real::full || (real == Real::wide && context.device().has_double); }

/// Numbers as an array of a kernel's weights.
inline std::vector<unsigned char> real_bytes(const Context& context, Real real, const std::vector<double>& values) {
    const auto bytes_of = [](const auto& numbers) {
        const auto* const begin = reinterpret_cast<const unsigned char*>(numbers.data());
        return std::vector<unsigned char>(begin, begin + numbers.size() * sizeof numbers[0]);
    };
    if (is_double(context, real)) return bytes_of(values);
    std::vector<float> narrow;
    narrow.reserve(values.size() * (real == Real::wide ? 2 : 1));
    for (const double value : values) {
        narrow.push_back(static_cast<float>(value));
        if (real == Real::wide) narrow.push_back(static_cast<float>(value - narrow.back()));  // the low half of a pair
    }
    return bytes_of(narrow);
}

/// What a kernel has written.
inline double real_at(const unsigned char* place, bool as_double) {
    float narrow;
    double value;
    if (as_double) std::memcpy(&value, place, sizeof value);
    else std::memcpy(&narrow, place, sizeof narrow), value = narrow;
    return value;
}

}  // namespace lcl
