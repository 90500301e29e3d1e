// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/operator/excerpt.h"
#include "host/solve/limit_system.h"
#include "host/solve/recurrences.h"

namespace lcl {
namespace {

constexpr int lanczos_steps = 16;
constexpr int lanczos_steps_unproven = 48;  // valence 2: negative eigenvalues are looked for
constexpr int lanczos_steps_most = 256;
constexpr double rounding = 2e-5;      // of a Ritz value from float sweeps
constexpr Index sample_least = 65536;  // rows; of larger meshes this many or a share are looked at, round the weakest place
constexpr Index sample_share = 16;     // wide enough for waves across the levels of a breadth-first order

/// Numbers in [-1, 1) that are the same in every run: a start vector with a part of every eigenvector.
std::vector<double> rough_vector(std::size_t size) {
    std::vector<double> values(size);
    std::uint64_t state = 0x9E3779B97F4A7C15u;
    for (double& value : values) {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        value = static_cast<double>(state >> 11) / 4503599627370496.0 - 1;
    }
    return values;
}

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

/// The same for the weakest part of a large mesh: an upper estimate still, since parts have no smaller eigenvalues than the whole.
double sampled_estimate(DeviceOperator& A, int steps) {
    const Plan& plan = A.plan();
    const Part sample = weakest_blocks(plan, std::max(sample_least, plan.smooth.row_count / sample_share));
    if (2 * sample.row_count >= plan.smooth.row_count) return lanczos_estimate(A, steps);
    DeviceOperator part(A.shared_context(), std::make_shared<const Plan>(excerpt(plan, sample.first_block, sample.block_count)), A.launch_shape());
    return lanczos_estimate(part, steps);
}

/// Curve rows (L + 4 V + R)/6 have spectrum in [1/3, 1], Doo-Sabin's (L + 6 V + R)/8 in [1/2, 1].
double curve_bound(const LimitSystem& system) {
    if (system.plan().curves.row_count == 0) return 1;
    const double plain = system.scheme.scheme == Scheme::doo_sabin ? 0.5 : 1.0 / 3;
    return system.scheme.lambda_per_vertex.empty() ? system.scheme.lambda + (1 - system.scheme.lambda) * plain : plain;
}

const char* cure(Scheme scheme) {
    return scheme == Scheme::catmull_clark ? "use a larger alpha (0.5; alpha auto does so) or a lambda above 0"
                                           : "use another scheme, or remove vertices of valence 2";
}

void judge(const LimitSystem& system, Spectrum& spectrum) {
    if (!system.singular.message.empty()) {
        spectrum.singular = true;
        spectrum.message = system.singular.message;
        spectrum.vertices = system.singular.vertices;
        spectrum.estimate = spectrum.smooth = 0;
        return;
    }
    if (spectrum.smooth >= near_singular) return;
    const std::string value = std::to_string(spectrum.smooth);
    const std::string where =
        system.weakest.empty() ? "" : " (vertex " + std::to_string(system.weakest[0]) + " has valence " + std::to_string(system.lowest_valence) + ")";
    spectrum.vertices = system.weakest;
    spectrum.indefinite = spectrum.smooth < -rounding;
    spectrum.singular = !spectrum.indefinite && spectrum.smooth <= rounding;
    if (spectrum.indefinite)
        spectrum.message = "the limit operator is indefinite, it has an eigenvalue of about " + value + " or less" + where +
                           ", and no iteration is sure to converge: " + cure(system.scheme.scheme);
    else if (spectrum.singular)
        spectrum.message =
            "the limit operator is singular to working precision, its smallest eigenvalue is about " + value + where + ": " + cure(system.scheme.scheme);
    else
        spectrum.warning = "the limit operator is nearly singular, its smallest eigenvalue is about " + value + where +
                           ", so noise in the vertices is exaggerated: " + cure(system.scheme.scheme);
}

}  // namespace

const Spectrum& spectrum_of(LimitSystem& system) {
    if (system.spectrum) return *system.spectrum;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const Plan& plan = system.plan();
    Spectrum spectrum;
    const bool proven = !std::isnan(plan.lambda_min_bound);
    const double curves = curve_bound(system);
    spectrum.bound = plan.has_darts() || !proven ? nan : std::min(plan.lambda_min_bound, curves);
    if (system.singular.message.empty()) {
        spectrum.smooth = sampled_estimate(*system.A, proven ? lanczos_steps : lanczos_steps_unproven);
        if (proven) spectrum.smooth = std::max(spectrum.smooth, plan.lambda_min_bound);
    }
    spectrum.estimate = plan.has_darts() ? nan : std::min(spectrum.smooth, curves);
    judge(system, spectrum);
    system.spectrum = spectrum;
    return *system.spectrum;
}

}  // namespace lcl
