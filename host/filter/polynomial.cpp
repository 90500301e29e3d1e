// SPDX-License-Identifier: BSD-3-Clause
#include "host/filter/polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "host/error.h"

namespace lcl {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double most_weight = 1e30;
constexpr double most_gain = 1e6;  // of a sharpener: what floats of size 1 take without losing the low frequencies

constexpr SeriesStep apply{0, 1, 0};    // A
constexpr SeriesStep remain{1, -1, 0};  // B = E - A

void check_range(const char* name, int value, int least) {
    if (value < least || value > most_terms)
        throw InvalidArgument(std::string(name) + " is " + std::to_string(value) + ", it goes from " + std::to_string(least) + " to " +
                              std::to_string(most_terms));
}

void check_weight(const std::string& name, double weight) {
    if (!std::isfinite(weight)) throw InvalidArgument(name + " is not finite");
    if (!(std::fabs(weight) <= most_weight)) throw InvalidArgument(name + " is beyond 10^30, which floats do not hold: take smaller ones");
}

void check_band(int first, int last, int least) {
    check_range("the first term", first, least);
    check_range("the last term", last, least);
    if (first > last) throw InvalidArgument("the band goes from term " + std::to_string(first) + " to " + std::to_string(last) + ": the first is the smaller");
}

/// 1 .. count in van der Corput's order, in which neighbours lie far apart.
std::vector<int> scattered(int count) {
    int size = 1;
    while (size <= count) size *= 2;
    std::vector<int> order;
    for (int i = 0; i < size; ++i) {
        int reversed = 0;
        for (int bit = 1, value = i; bit < size; bit *= 2, value /= 2) reversed = 2 * reversed + value % 2;
        if (reversed >= 1 && reversed <= count) order.push_back(reversed);
    }
    return order;
}

// D = prod over j = 0 .. m of (1 - w^j B), w = exp(2 pi i / (m + 1)): A for j = 0, 1 + B for j = (m + 1)/2, and 1 - 2 cos(2 pi j / (m + 1)) B + B^2 for each
// conjugate pair. Factors that enlarge high frequencies alternate with those that do not, so that partial products stay below some multiple of m (measured in
// float: off by 2e-7 m of the field's size).
std::vector<SeriesStep> filter_steps(int m) {
    std::vector<SeriesStep> steps{apply};
    if (m % 2 == 1) steps.push_back({2, -1, 0});
    for (const int j : scattered(m / 2)) {
        const double middle = 2 * std::cos(2 * pi * j / (m + 1.0));
        steps.push_back({1 - middle, -1, 0});
        steps.push_back({1, -1, 1});
    }
    return steps;
}

// sum c_i B^i x: y = c_n x, then y = B y + c_i x; the first two in one step.
SeriesSteps horner(std::vector<double> c) {
    while (c.size() > 1 && c.back() == 0) c.pop_back();
    SeriesSteps steps;
    steps.third = SeriesThird::input;
    const std::size_t degree = c.size() - 1;
    if (degree == 0) {
        if (c[0] != 1) steps.first.push_back({c[0], 0, 0});
        return steps;
    }
    steps.first.push_back({c[degree] + c[degree - 1], -c[degree], 0});
    for (std::size_t i = degree - 1; i-- > 0;) steps.first.push_back({1, -1, c[i]});
    return steps;
}

/// c_i = 1 for first <= i <= last, and c_0 as given.
std::vector<double> band_coefficients(double at_zero, int first, int last) {
    std::vector<double> c(static_cast<std::size_t>(last) + 1, 0.0);
    c[0] = at_zero;
    std::fill(c.begin() + first, c.end(), 1.0);
    return c;
}

/// Coefficients of B^i from those of B^i A: A = 1 - B.
std::vector<double> without_a(const std::vector<double>& weights, double remainder) {
    std::vector<double> c(weights.size() + 1);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = (i < weights.size() ? weights[i] : remainder) - (i > 0 ? weights[i - 1] : 0.0);
    return c;
}

/// B^first - B^(last + 1), the terms first .. last of the representation series.
SeriesSteps representation_band(int first, int last) {
    if (last - first > most_factored) {
        std::vector<double> c(static_cast<std::size_t>(last) + 2, 0.0);
        c[first] = 1;
        c.back() = -1;
        return horner(std::move(c));
    }
    SeriesSteps steps;
    steps.first = filter_steps(last - first);
    steps.repeated = {remain};
    steps.repetitions = first;
    return steps;
}

}  // namespace

Polynomial sum_of_terms(Series series, int first, int last) {
    check_band(first, last, 0);
    const double at_zero = first == 0 ? 1 : 0;
    if (series == Series::representation) return {{{representation_band(first, last)}}, at_zero};
    if (first < last) return {{{horner(band_coefficients(at_zero, first, last))}}, at_zero};
    SeriesSteps power;
    power.repeated = {remain};
    power.repetitions = first;
    return {{{power}}, at_zero};
}

Polynomial equaliser(Series series, const std::vector<double>& weights, double remainder) {
    if (weights.empty() || weights.size() > most_terms)
        throw InvalidArgument("an equaliser of " + std::to_string(weights.size()) + " weights was asked for, it has 1 to " + std::to_string(most_terms));
    for (std::size_t i = 0; i < weights.size(); ++i) check_weight("weight " + std::to_string(i) + " of the equaliser", weights[i]);
    check_weight("the weight of the remainder", remainder);
    return {{{horner(series == Series::representation ? without_a(weights, remainder) : weights)}}, weights[0]};
}

Polynomial denoiser(int m, int k, bool plain) {
    check_range("m", m, 0);
    check_range("k", k, 0);
    if (m > most_factored) {
        Polynomial p;
        if (!plain) p.stages.push_back({term_steps(1), 1});
        p.stages.push_back({representation_band(0, m), k});
        return p;
    }
    SeriesSteps steps;
    if (!plain) steps.first = {apply};
    steps.repeated = filter_steps(m);
    steps.repetitions = k;
    return {{{steps}}};
}

Polynomial sharpener(int first, int last, int k) {
    check_band(first, last, 1);
    if (k < 1) throw InvalidArgument("k is " + std::to_string(k) + ", it is at least 1");
    const double gain = std::pow(last - first + 2.0, k);
    if (!(gain <= most_gain))
        throw InvalidArgument("sharpening by the terms " + std::to_string(first) + " to " + std::to_string(last) + ", " + std::to_string(k) +
                              " times, makes noise up to (last - first + 2)^k times larger, more than 10^6: take a narrower band or a smaller k");
    return {{{horner(band_coefficients(1, first, last)), k}}};
}

void check_morph(int m, double rho) {
    check_range("m", m, 0);
    if (!(rho > 0 && rho <= 1)) throw InvalidArgument("rho is " + std::to_string(rho) + ", it lies above 0 and is at most 1");
}

SeriesSteps morph_steps(int m, double rho) {
    SeriesSteps steps;
    steps.first = filter_steps(m);
    steps.first[0].b *= rho;
    return steps;
}

SeriesSteps term_steps(int term_count) {
    check_range("the number of terms", term_count, 1);
    return {SeriesThird::older, {apply}, {remain}, term_count - 1};
}

// Each step lets less of the eigenvalue 1/4, the middle frequencies of a regular mesh, through D^k: 1, .82, .68, .47, .33, .19, .08, .007, 5e-5, .. Large noise
// takes the last ones (bench/quality).
DenoiseSettings denoise_settings(double strength) {
    if (!(strength >= 0 && strength <= 1)) throw InvalidArgument("strength is " + std::to_string(strength) + ", it goes from 0 to 1");
    constexpr std::array<DenoiseSettings, 11> settings{{{2, 0}, {5, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {1, 3}, {1, 6}, {1, 12}, {1, 30}, {1, 100}}};
    return settings[static_cast<std::size_t>(std::lround(strength * 10))];
}

}  // namespace lcl
