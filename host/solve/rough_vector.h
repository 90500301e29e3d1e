// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lcl {

/// Numbers in [-1, 1) that are the same in every run: a start vector with a part of every eigenvector.
inline std::vector<double> rough_vector(std::size_t size) {
    std::vector<double> values(size);
    std::uint64_t state = 0x9E3779B97F4A7C15u;
    for (double& value : values) {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        value = static_cast<double>(state >> 11) / 4503599627370496.0 - 1;
    }
    return values;
}

}  // namespace lcl
