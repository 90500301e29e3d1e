// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <limits>

#include "host/operator/excerpt.h"
#include "host/operator/rows_plan.h"
#include "host/operator/user_rows.h"
#include "host/solve/limit_system.h"
#include "host/solve/recurrences.h"
#include "host/solve/ritz.h"
#include "host/solve/rough_vector.h"
#include "host/solve/words.h"

namespace lcl {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int lanczos_steps = 16;
constexpr int lanczos_steps_unproven = 48;  // valence 2: negative eigenvalues are looked for
constexpr int lanczos_steps_most = 256;
constexpr double rounding = 2e-5;      // of a Ritz value from float sweeps
constexpr double outside = 1e-6;       // of [0, 1], for a diagonal element: weights may have been floats once
constexpr double known_to = 1e-4;      // a Ritz value of rows without a scaling that is taken for an eigenvalue
constexpr Index sample_least = 65536;  // rows; of larger meshes this many or a share are looked at, round the weakest place
constexpr Index sample_share = 16;     // wide enough for waves across the levels of a breadth-first order

/// Coefficients of so many steps on the smooth block; fewer where the Krylov space ends.
LanczosCoefficients lanczos(DeviceOperator& A, int steps) {
    const Part& smooth = A.plan().smooth;
    constexpr int channels = 3;  // three start vectors at the price of one
    Field m = A.make_field(channels, Real::single), x = A.make_field(channels, Real::single);
    m.fill_zero();
    x.fill_zero();
    m.upload(rough_vector(static_cast<std::size_t>(smooth.row_count) * channels).data(), smooth.first_row, smooth.row_count);
    Monitor monitor(steps, {}, {}, true);
    monitor.begin_stage({1e-5, 1e-5});  // beyond, small meshes have nothing left but rounding
    LanczosCoefficients coefficients;
    iterate_conjugate_gradients(A, smooth, m, x, monitor, &coefficients);
    return coefficients;
}

/// Lowest Ritz value of the smooth block, 1 where it is empty; with twice the steps as long as the last quarter of them still lowers it by more than 5 %.
double lanczos_estimate(DeviceOperator& A, int steps) {
    if (A.plan().smooth.row_count == 0) return 1;
    for (;; steps *= 2) {
        const LanczosCoefficients coefficients = lanczos(A, steps);
        const double value = smallest_ritz_value(coefficients, steps);
        const bool has_ended = static_cast<int>(coefficients.alpha.size()) < steps || value < -rounding;
        if (has_ended || steps >= lanczos_steps_most || smallest_ritz_value(coefficients, steps * 3 / 4) - value <= 0.05 * std::fabs(value))
            return std::min(1.0, value);
    }
}

/// The same for the weakest part of a large mesh: an upper estimate still, since parts have no smaller eigenvalues than the whole. Of other rows nothing says
/// which part that is.
double smooth_estimate(const LimitSystem& system, int steps) {
    DeviceOperator& A = *system.A;
    const Plan& plan = A.plan();
    if (system.origin != Origin::scheme) return lanczos_estimate(A, steps);
    const Part sample = weakest_blocks(plan, std::max(sample_least, plan.smooth.row_count / sample_share));
    if (2 * sample.row_count >= plan.smooth.row_count) return lanczos_estimate(A, steps);
    DeviceOperator part(A.shared_context(), std::make_shared<const Plan>(excerpt(plan, sample.first_block, sample.block_count)), A.launch_shape());
    return lanczos_estimate(part, steps);
}

/// Gershgorin's: weights of curves are not negative and sum to 1 (1/3 for (L + 4 V + R)/6, 1/2 for (L + 6 V + R)/8).
double curve_bound(const Plan& plan) {
    double bound = 1;
    for (Index row = plan.curves.first_row; row < plan.curves.end_row(); ++row) bound = std::min(bound, 2 * plan.diagonal[row] - 1);
    return bound;
}

/// lowest: the smallest eigenvalue, as far as it is known.
void judge(const LimitSystem& system, double lowest, Spectrum& spectrum) {
    if (!system.singular.message.empty()) {
        spectrum.singular = true;
        spectrum.message = system.singular.message;
        spectrum.vertices = system.singular.vertices;
        spectrum.estimate = spectrum.smooth = 0;
        return;
    }
    if (lowest >= near_singular) return;
    const std::string value = std::to_string(lowest);
    const std::string where =
        system.weakest.empty() ? "" : " (vertex " + std::to_string(system.weakest[0]) + " has valence " + std::to_string(system.lowest_valence) + ")";
    spectrum.vertices = system.weakest;
    spectrum.indefinite = lowest < -rounding;
    spectrum.singular = !spectrum.indefinite && lowest <= rounding;
    const std::string name = operator_name(system);
    if (spectrum.indefinite)
        spectrum.message =
            name + " is indefinite, it has an eigenvalue of about " + value + " or less" + where + ", and no iteration is sure to converge: " + cure(system);
    else if (spectrum.singular)
        spectrum.message = name + " is singular to working precision, its smallest eigenvalue is about " + value + where + ": " + cure(system);
    else
        spectrum.warning =
            name + " is nearly singular, its smallest eigenvalue is about " + value + where + ", so noise in the vertices is exaggerated: " + cure(system);
}

std::string text(double value) {
    char out[32];
    std::snprintf(out, sizeof out, "%.4g", value);
    return out;
}

/// How far a number lies outside the interval [0, 1].
double distance_from_unit_interval(std::complex<double> value) { return std::hypot(std::max({0.0, -value.real(), value.real() - 1}), value.imag()); }

[[noreturn]] void refuse(std::complex<double> value) {
    const std::string found = "the rows have an eigenvalue of about " + text(value.real()), needed = ": iterations and filters take eigenvalues from 0 to 1";
    if (std::fabs(value.imag()) > std::max(-value.real(), value.real() - 1))
        throw Unsupported(found + " + " + text(std::fabs(value.imag())) + " i, which is not real" + needed);
    if (value.real() > 1) throw Unsupported(found + ", above 1" + needed + ", so divide all weights by it");
    throw Unsupported(found + ", below 0" + needed + ", as t E + (1 - t) A has for a t of " + text(-value.real() / (1 - value.real())) + " or more");
}

/// With a scaling every diagonal element is a quotient <x, A x>_D / <x, x>_D, and lies within the spectrum.
void refuse_diagonal_outside(const Plan& plan) {
    for (Index row = plan.smooth.first_row; row < plan.smooth.end_row(); ++row) {
        const double element = plan.diagonal[row];
        if (distance_from_unit_interval(element) <= outside) continue;
        const Index v = plan.vertex_of_row[row];
        throw Unsupported("row " + std::to_string(v) + " has the diagonal element " + text(element) + ", so that an eigenvalue is " +
                              (element < 0 ? "below 0" : "above 1") + ": iterations and filters take eigenvalues from 0 to 1",
                          {{v}, {}});
    }
}

/// For rows without a scaling, of which Ritz values are all that is known.
Spectrum spectrum_without_scaling(const LimitSystem& system, const std::vector<RitzValue>& values) {
    const double proven = system.plan().lambda_min_bound;
    Spectrum spectrum;
    spectrum.bound = proven;
    spectrum.estimate = values.empty() ? 1 : nan;
    spectrum.smooth = 1;
    double known = 1;
    for (const RitzValue& ritz : values) {
        spectrum.smooth = std::min(spectrum.smooth, ritz.value.real());
        if (ritz.error <= known_to) known = std::min(known, ritz.value.real());
    }
    spectrum.smooth = std::max({0.0, spectrum.smooth, std::isnan(proven) ? 0.0 : proven});
    judge(system, std::max(known, 0.0), spectrum);
    return spectrum;
}

}  // namespace

void check_spectrum(LimitSystem& system) {
    const Plan& plan = system.plan();
    const Interval discs = gershgorin_interval(plan);
    const bool is_proven = plan.has_scaling && discs.low >= -symmetry_tolerance && discs.high <= 1 + symmetry_tolerance;
    if (is_proven) return;
    refuse_diagonal_outside(plan);
    const std::vector<RitzValue> values = ritz_values(plan);
    std::complex<double> worst = 0;
    for (const RitzValue& ritz : values) {
        const double distance = distance_from_unit_interval(ritz.value);
        if (distance > ritz.error && distance > distance_from_unit_interval(worst)) worst = ritz.value;
    }
    if (distance_from_unit_interval(worst) > 0) refuse(worst);
    if (!plan.has_scaling) system.spectrum = spectrum_without_scaling(system, values);
}

const Spectrum& spectrum_of(LimitSystem& system) {
    if (system.spectrum) return *system.spectrum;
    const Plan& plan = system.plan();
    Spectrum spectrum;
    const bool proven = !std::isnan(plan.lambda_min_bound);
    const double curves = curve_bound(plan);
    spectrum.bound = plan.has_darts() || !proven ? nan : std::min(plan.lambda_min_bound, curves);
    if (system.singular.message.empty()) {
        spectrum.smooth = smooth_estimate(system, proven ? lanczos_steps : lanczos_steps_unproven);
        if (proven) spectrum.smooth = std::max(spectrum.smooth, plan.lambda_min_bound);
    }
    spectrum.estimate = plan.has_darts() ? nan : std::min(spectrum.smooth, curves);
    judge(system, spectrum.smooth, spectrum);
    system.spectrum = spectrum;
    return *system.spectrum;
}

bool wants_other_alpha(LimitSystem& system) {
    const Spectrum& spectrum = spectrum_of(system);
    return spectrum.singular || spectrum.indefinite || spectrum.smooth < near_singular;
}

}  // namespace lcl
