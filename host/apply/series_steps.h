// SPDX-License-Identifier: BSD-3-Clause
// Polynomials of A as chains of single applications: coefficients only, no device.
#pragma once

#include <cstdint>
#include <vector>

namespace lcl {

/// y_k = a y_(k-1) + b A y_(k-1) + c d.
struct SeriesStep {
    double a = 0, b = 0, c = 0;
};

/// What d is.
enum class SeriesThird {
    input,  ///< y_0: Horner form; three fields
    older   ///< y_(k-2): products of quadratic factors; two fields. c is 0 in the first two steps, which have none
};

/// `first`, then `repeated` so many times: long chains are not written out.
struct SeriesSteps {
    SeriesThird third = SeriesThird::older;
    std::vector<SeriesStep> first, repeated;
    std::int64_t repetitions = 0;

    std::int64_t count() const { return static_cast<std::int64_t>(first.size()) + static_cast<std::int64_t>(repeated.size()) * repetitions; }
    const SeriesStep& operator[](std::int64_t k) const {
        const auto head = static_cast<std::int64_t>(first.size());
        return k < head ? first[k] : repeated[(k - head) % static_cast<std::int64_t>(repeated.size())];
    }
};

}  // namespace lcl
