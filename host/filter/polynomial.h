// SPDX-License-Identifier: BSD-3-Clause
// The filters of the mesh expansion (mesh expansion paper; math.md sections 4 and 5) as polynomials p of B = E - A. Coefficients only: what applies A is below.
#pragma once

#include <vector>

#include "host/apply/series_steps.h"

namespace lcl {

enum class Series { representation, interpolation };  // order of lcl_series

constexpr int most_terms = 100000;  // of a sum, m and k: beyond, nothing but rounding is left
constexpr int most_factored = 16;   // m up to which D is a product of factors, whose rounding grows like m; beyond, D is summed up as Horner does

/// p(B) x: stages one after the other, each `times` times.
struct Polynomial {
    struct Stage {
        SeriesSteps steps;
        int times = 1;
    };
    std::vector<Stage> stages;
    double at_zero = 1;  ///< p(0): what constants, where rows of A sum to 1, and vertices with A x = x are multiplied by

    std::int64_t pass_count() const {
        std::int64_t passes = 0;
        for (const Stage& stage : stages) passes += stage.steps.count() * stage.times;
        return passes;
    }
};

/// The terms first .. last added up: B^i A (representation), B^i (interpolation). InvalidArgument unless 0 <= first <= last <= most_terms.
Polynomial sum_of_terms(Series series, int first, int last);

/// sum w_i B^i A + r B^count (representation; r the remainder), or sum w_i B^i (interpolation, no remainder). InvalidArgument for no or too many weights, or
/// weights that are not finite or beyond 10^30. Horner form, its leading zeros left out.
Polynomial equaliser(Series series, const std::vector<double>& weights, double remainder);

/// D^k A, or D^k where `plain`, D = 1 - B^(m+1) (eq. 8): k (m + 1) + 1 passes, plain k (m + 1). InvalidArgument for m or k out of 0 .. most_terms.
Polynomial denoiser(int m, int k, bool plain);

/// 1 + B^first + .. + B^last, k times. InvalidArgument unless 1 <= first <= last <= most_terms, 1 <= k, and (last - first + 2)^k <= 10^6, the bound of what it
/// can make of a high frequency.
Polynomial sharpener(int first, int last, int k);

/// rho D, m + 1 passes (eq. 9), in two fields; m <= most_factored.
SeriesSteps morph_steps(int m, double rho);
/// InvalidArgument for m out of 0 .. most_terms or rho out of (0, 1].
void check_morph(int m, double rho);

/// A, then B again and again: the terms of the representation series.
SeriesSteps term_steps(int term_count);

/// m and k of a strength from 0 to 1. InvalidArgument otherwise.
struct DenoiseSettings {
    int m = 2, k = 3;
};
DenoiseSettings denoise_settings(double strength);

}  // namespace lcl
