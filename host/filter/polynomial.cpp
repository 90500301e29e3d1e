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
constexpr double most_gain = 1e6;  // of a sharpener: what floats of size 1 take without losing the low frequencies

constexpr SeriesStep apply{0, 1, 0};    // A
constexpr SeriesStep remain{1, -1, 0};  // B = E - A

void check_range(const char* name, int value, int least) {
    if (value < least || value > most_terms)
        throw InvalidArgument(std::string(name) + " is " + std::to_string(value) + ", it goes from " + std::to_string(least) + " to " +
                              std::to_string(most_terms));
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
// conjugate pair. Factors that enlarge high frequencies alternate with those that do not, so that partial products stay below some multiple of m.
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

// sum c_i B^i x by Horner: y = c_n x, then y = B y + c_i x; the first two in one step.
Polynomial horner(std::vector<double> c) {
    while (c.size() > 1 && c.back() == 0) c.pop_back();
    Polynomial p;
    p.at_zero = c[0];
    p.steps.third = SeriesThird::input;
    const std::size_t degree = c.size() - 1;
    if (degree == 0) {
        if (c[0] != 1) p.steps.first.push_back({c[0], 0, 0});
        return p;
    }
    p.steps.first.push_back({c[degree] + c[degree - 1], -c[degree], 0});
    for (std::size_t i = degree - 1; i-- > 0;) p.steps.first.push_back({1, -1, c[i]});
    return p;
}

/// Coefficients of B^i from those of B^i A: A = 1 - B.
std::vector<double> without_a(const std::vector<double>& weights, double remainder) {
    std::vector<double> c(weights.size() + 1);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = (i < weights.size() ? weights[i] : remainder) - (i > 0 ? weights[i - 1] : 0.0);
    return c;
}

}  // namespace

Polynomial sum_of_terms(Series series, int first, int last) {
    check_band(first, last, 0);
    if (series == Series::interpolation && first < last) {
        std::vector<double> c(static_cast<std::size_t>(last) + 1, 0.0);
        std::fill(c.begin() + first, c.end(), 1.0);
        return horner(std::move(c));
    }
    Polynomial p;
    p.at_zero = first == 0 ? 1 : 0;
    if (series == Series::representation) p.steps.first = filter_steps(last - first);
    p.steps.repeated = {remain};
    p.steps.repetitions = first;
    return p;
}

Polynomial equaliser(Series series, const std::vector<double>& weights, double remainder) {
    if (weights.empty() || weights.size() > most_terms)
        throw InvalidArgument("an equaliser of " + std::to_string(weights.size()) + " weights was asked for, it has 1 to " + std::to_string(most_terms));
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (!std::isfinite(weights[i])) throw InvalidArgument("weight " + std::to_string(i) + " of the equaliser is not finite");
    if (!std::isfinite(remainder)) throw InvalidArgument("the weight of the remainder is not finite");
    return horner(series == Series::representation ? without_a(weights, remainder) : weights);
}

Polynomial denoiser(int m, int k, bool plain) {
    check_range("m", m, 0);
    check_range("k", k, 0);
    Polynomial p;
    if (!plain) p.steps.first = {apply};
    p.steps.repeated = filter_steps(m);
    p.steps.repetitions = k;
    return p;
}

Polynomial sharpener(int first, int last, int k) {
    check_band(first, last, 1);
    if (k < 1) throw InvalidArgument("k is " + std::to_string(k) + ", it is at least 1");
    const double gain = std::pow(last - first + 2.0, k);
    if (!(gain <= most_gain))
        throw InvalidArgument("sharpening by the terms " + std::to_string(first) + " to " + std::to_string(last) + ", " + std::to_string(k) +
                              " times, makes noise up to (last - first + 2)^k times larger, more than 10^6: take a narrower band or a smaller k");
    std::vector<double> c(static_cast<std::size_t>(last) + 1, 0.0);
    c[0] = 1;
    std::fill(c.begin() + first, c.end(), 1.0);
    Polynomial p = horner(std::move(c));
    p.times = k;
    return p;
}

Polynomial morph_step(int m, double rho) {
    check_range("m", m, 0);
    if (!(rho > 0 && rho <= 1)) throw InvalidArgument("rho is " + std::to_string(rho) + ", it lies above 0 and is at most 1");
    Polynomial p;
    p.at_zero = rho;
    p.steps.first = filter_steps(m);
    p.steps.first[0].b *= rho;
    return p;
}

// A step of strength takes off about as much more of the eigenvalue 1/4, the middle frequencies of a regular mesh: gains 1, .82, .68, .47, .33, .19, .11, .08,
// .04, .007, .0003 of D^k.
DenoiseSettings denoise_settings(double strength) {
    if (!(strength >= 0 && strength <= 1)) throw InvalidArgument("strength is " + std::to_string(strength) + ", it goes from 0 to 1");
    constexpr std::array<DenoiseSettings, 11> settings{{{2, 0}, {5, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {2, 4}, {1, 3}, {1, 4}, {1, 6}, {1, 10}}};
    return settings[static_cast<std::size_t>(std::lround(strength * 10))];
}

}  // namespace lcl
