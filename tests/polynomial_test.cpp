// SPDX-License-Identifier: BSD-3-Clause
// Polynomials of the mesh expansion on a single eigenvalue: what a chain of steps does with it against the formulas that it stands for, and what it makes of
// rounding on the way.
#include <cmath>

#include <catch2/catch.hpp>

#include "host/error.h"
#include "host/filter/polynomial.h"

using namespace lcl;
using Catch::Matchers::Contains;

namespace {

constexpr double unit = 1.1102230246251565e-16;

/// Eigenvalues from 0 to 1, both ends among them, closer together at the ends.
std::vector<double> eigenvalues(int count = 257) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(0.5 - 0.5 * std::cos(3.14159265358979323846 * i / (count - 1)));
    values.back() = 1;
    return values;
}

/// Every step's y for an eigenvector of size 1 of eigenvalue mu: y_0 = 1 first.
std::vector<double> run(const SeriesSteps& steps, double mu, double input = 1) {
    std::vector<double> y{input};
    for (std::int64_t k = 0; k < steps.count(); ++k) {
        const SeriesStep& s = steps[k];
        const double third = steps.third == SeriesThird::input ? input : k > 0 ? y[k - 1] : std::nan("");
        y.push_back(s.a * y[k] + s.b * mu * y[k] + (s.c == 0 ? 0 : s.c * third));
    }
    return y;
}

double value_at(const Polynomial& p, double mu) {
    double value = 1;
    for (const Polynomial::Stage& stage : p.stages)
        for (int time = 0; time < stage.times; ++time) value = run(stage.steps, mu, value).back();
    return value;
}

/// First-order bound of the rounding error of a chain on fields of size 1, in roundings of one step: the sum over the steps of how much each makes of its own
/// terms
/// (|a| + |b| + |c|, A has gain 1 at most) times what the steps after it make of that, each at the eigenvalue where it is worst. Norms of D: of eigenvectors.
double rounding_of(const SeriesSteps& steps) {
    const std::int64_t count = steps.count();
    std::vector<double> size(count, 0.0), gain(count, 0.0);
    for (const double mu : eigenvalues()) {
        const std::vector<double> y = run(steps, mu);
        std::vector<double> later(count + 2, 0.0);  // d y_count / d y_k
        later[count] = 1;
        for (std::int64_t k = count; k-- > 0;) {
            const bool is_older = steps.third == SeriesThird::older;
            later[k] = (steps[k].a + steps[k].b * mu) * later[k + 1] + (is_older && k + 2 <= count ? steps[k + 1].c * later[k + 2] : 0);
            const double third = steps[k].c == 0 ? 0 : is_older ? std::abs(y[k - 1]) : 1;
            size[k] = std::max(size[k], (std::abs(steps[k].a) + std::abs(steps[k].b)) * std::abs(y[k]) + std::abs(steps[k].c) * third);
            gain[k] = std::max(gain[k], std::abs(later[k + 1]));
        }
    }
    double sum = 0;
    for (std::int64_t k = 0; k < count; ++k) sum += size[k] * gain[k];
    return sum;
}

/// The largest difference to `expected(mu)` over the spectrum.
template <class Expected>
double difference(const Polynomial& p, const Expected& expected) {
    double worst = 0;
    for (const double mu : eigenvalues()) {
        const double error = std::abs(value_at(p, mu) - expected(mu));
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

/// The least error that a Horner form or a product of so many factors is held to: it adds up roundings of terms of size up to `size`.
double tolerance(std::int64_t passes, double size = 1) { return 8 * unit * (static_cast<double>(passes) + 4) * size; }

double power(double base, int exponent) { return exponent == 0 ? 1 : std::pow(base, exponent); }

/// sum over i of B^i from first to last, added up.
double band(double mu, int first, int last) {
    double sum = 0;
    for (int i = first; i <= last; ++i) sum += power(1 - mu, i);
    return sum;
}

const std::vector<std::pair<int, int>> bands{{0, 0}, {1, 1}, {7, 7}, {0, 1}, {0, 2}, {2, 3}, {4, 7}, {8, 15}, {0, 16}, {5, 21}, {0, 17}, {3, 40}, {90, 100}};

/// Chains keep their third field apart: a product has none in its first two steps.
void check_sound(const Polynomial& p) {
    for (const Polynomial::Stage& stage : p.stages) {
        for (const SeriesStep& step : stage.steps.repeated) CHECK((std::isfinite(step.a) && std::isfinite(step.b) && std::isfinite(step.c)));
        for (std::int64_t k = 0; stage.steps.third == SeriesThird::older && k < std::min<std::int64_t>(2, stage.steps.count()); ++k)
            CHECK(stage.steps[k].c == 0);
    }
    CHECK(p.at_zero == Approx(value_at(p, 1)).margin(1e-12));
}

template <class Make>
void refused(const Make& make, const std::string& part) {
    CHECK_THROWS_AS(make(), InvalidArgument);
    CHECK_THROWS_WITH(make(), Contains(part));
}

}  // namespace

TEST_CASE("a band of terms is B^first - B^(last + 1), or the sum of its powers", "[polynomial]") {
    for (const auto& [first, last] : bands) {
        CAPTURE(first, last);
        const Polynomial representation = sum_of_terms(Series::representation, first, last), interpolation = sum_of_terms(Series::interpolation, first, last);
        CHECK(difference(representation, [&, f = first, l = last](double mu) { return mu * band(mu, f, l); }) <= tolerance(last + 1, last - first + 1));
        CHECK(difference(interpolation, [&, f = first, l = last](double mu) { return band(mu, f, l); }) <= tolerance(last + 1, last - first + 1));
        CHECK(representation.pass_count() == last + 1);
        CHECK(interpolation.pass_count() == last);
        check_sound(representation);
        check_sound(interpolation);
    }
}

TEST_CASE("an equaliser is the weighted sum of its terms, and takes no pass that it does not need", "[polynomial]") {
    for (const std::vector<double>& weights :
         {std::vector<double>{2.5}, {0.5, -1, 3}, {0, 0, 0, 1}, {1, 2, 0, 0, 0.25, -4, 7, 1}, std::vector<double>(40, 0.75)})
        for (const double remainder : {1.0, 0.0, -2.0}) {
            CAPTURE(weights.size(), weights[0], remainder);
            const int count = static_cast<int>(weights.size());
            double size = std::abs(remainder);
            for (const double weight : weights) size += 2 * std::abs(weight);
            const auto sum = [&](double mu) {
                double value = 0;
                for (int i = 0; i < count; ++i) value += weights[i] * power(1 - mu, i);
                return value;
            };
            const Polynomial representation = equaliser(Series::representation, weights, remainder),
                             interpolation = equaliser(Series::interpolation, weights, remainder);
            CHECK(difference(representation, [&](double mu) { return mu * sum(mu) + remainder * power(1 - mu, count); }) <= tolerance(count, size));
            CHECK(difference(interpolation, sum) <= tolerance(count, size));
            CHECK(representation.pass_count() <= count);
            CHECK(interpolation.pass_count() <= std::max(1, count - 1));
            check_sound(representation);
            check_sound(interpolation);
        }
    CHECK(equaliser(Series::representation, std::vector<double>(100, 1.0), 1).pass_count() == 0);  // gives the input back
    CHECK(equaliser(Series::representation, {0.5, 1, 2, 2, 2}, 2).pass_count() == 2);              // the leading ones cancel
    CHECK(equaliser(Series::interpolation, {1, 1, 0, 0, 0}, 1).pass_count() == 1);
}

TEST_CASE("a denoiser is D^k A, or D^k, in k (m + 1) passes and one", "[polynomial]") {
    for (const int m : {0, 1, 2, 3, 4, 5, 6, 7, 10, 15, 16, 17, 40, 100})
        for (const int k : {0, 1, 2, 3, 4, 10})
            for (const bool plain : {false, true}) {
                CAPTURE(m, k, plain);
                const Polynomial p = denoiser(m, k, plain);
                const auto expected = [&, m = m](double mu) { return power(1 - power(1 - mu, m + 1), k) * (plain ? 1 : mu); };
                CHECK(difference(p, expected) <= tolerance(static_cast<std::int64_t>(k) * (m + 1), m + 1));
                CHECK(p.pass_count() == static_cast<std::int64_t>(k) * (m + 1) + (plain ? 0 : 1));
                CHECK(p.at_zero == 1);
                check_sound(p);
            }
    CHECK(denoiser(100000, 100000, false).pass_count() == 10000100001);
    CHECK(denoiser(0, 100000, true).pass_count() == 100000);
}

TEST_CASE("the equation (8) of the paper for m = 1 is (2A - A^2)^k", "[polynomial]") {
    for (const int k : {1, 2, 3}) CHECK(difference(denoiser(1, k, true), [&](double mu) { return power(2 * mu - mu * mu, k); }) <= tolerance(2 * k));
}

TEST_CASE("a sharpener adds powers of B, k times", "[polynomial]") {
    for (const auto& [first, last, k] : {std::array<int, 3>{1, 3, 1}, {1, 1, 4}, {2, 5, 3}, {7, 40, 2}, {1, 1, 19}, {1, 999, 2}}) {
        CAPTURE(first, last, k);
        const Polynomial p = sharpener(first, last, k);
        const double gain = std::pow(last - first + 2.0, k);
        CHECK(difference(p, [&, f = first, l = last, k = k](double mu) { return power(1 + band(mu, f, l), k); }) <=
              tolerance(static_cast<std::int64_t>(k) * last, gain));
        CHECK(p.pass_count() == static_cast<std::int64_t>(k) * last);
        CHECK(p.at_zero == 1);
        CHECK(value_at(p, 0) == Approx(gain));  // the bound that is refused above 10^6 is reached at eigenvalue 0
        check_sound(p);
    }
}

TEST_CASE("steps of a morph are rho D, and term steps the terms one after the other", "[polynomial]") {
    for (int m = 0; m <= most_factored; ++m)
        for (const double rho : {0.1, 0.5, 1.0}) {
            const SeriesSteps steps = morph_steps(m, rho);
            CHECK(steps.count() == m + 1);
            for (const double mu : eigenvalues()) CHECK(std::abs(run(steps, mu).back() - rho * (1 - power(1 - mu, m + 1))) <= tolerance(m + 1, m + 1));
        }
    const SeriesSteps steps = term_steps(20);
    for (const double mu : eigenvalues())
        for (int i = 0; i < 20; ++i) CHECK(std::abs(run(steps, mu)[i + 1] - mu * power(1 - mu, i)) <= tolerance(i));
}

TEST_CASE("factors of D come in an order in which rounding grows like m", "[polynomial]") {
    for (int m = 0; m <= most_factored; ++m) {
        CAPTURE(m);
        CHECK(rounding_of(morph_steps(m, 1)) <= 20 * (m + 1));
    }
    for (const auto& [first, last] : bands) {  // Horner: each step adds its own rounding, and none grows
        const Polynomial p = sum_of_terms(Series::representation, first, last);
        CHECK(rounding_of(p.stages[0].steps) <= 20 * (last + 2));
    }
    for (const int m : {17, 100}) CHECK(rounding_of(denoiser(m, 1, true).stages[0].steps) <= 5 * (m + 2));
}

TEST_CASE("a strength from 0 to 1 smooths more and more", "[polynomial]") {
    double before = 2;
    for (int i = 0; i <= 10; ++i) {
        const DenoiseSettings settings = denoise_settings(i / 10.0);
        const double gain = value_at(denoiser(settings.m, settings.k, true), 0.25);
        CAPTURE(i, settings.m, settings.k, gain);
        CHECK(gain < before);
        CHECK((settings.m >= 1 && settings.m <= 5));
        before = gain;
    }
    CHECK(denoise_settings(0).k == 0);
    CHECK((denoise_settings(0.5).m == 2 && denoise_settings(0.5).k == 3));
    CHECK((denoise_settings(1).m == 1 && denoise_settings(1).k == 100));
    CHECK((denoise_settings(0.54).m == 2 && denoise_settings(0.54).k == 3));  // the nearest tenth
    for (const double bad : {-0.01, 1.01, std::nan("")}) refused([&] { denoise_settings(bad); }, "it goes from 0 to 1");
}

TEST_CASE("what is out of range is refused with its limits", "[polynomial]") {
    for (const Series series : {Series::representation, Series::interpolation}) {
        refused([&] { sum_of_terms(series, -1, 3); }, "the first term is -1, it goes from 0 to 100000");
        refused([&] { sum_of_terms(series, 0, 100001); }, "the last term is 100001, it goes from 0 to 100000");
        refused([&] { sum_of_terms(series, 3, 2); }, "from term 3 to 2");
        refused([&] { equaliser(series, {}, 1); }, "0 weights");
        refused([&] { equaliser(series, std::vector<double>(100001, 1.0), 1); }, "1 to 100000");
        refused([&] { equaliser(series, {1, std::nan("")}, 1); }, "weight 1 of the equaliser is not finite");
        refused([&] { equaliser(series, {1}, INFINITY); }, "the remainder is not finite");
        CHECK(sum_of_terms(series, 100000, 100000).pass_count() >= 100000);
        CHECK(equaliser(series, std::vector<double>(100000, 2.0), 1).pass_count() >= 99999);
    }
    refused([] { denoiser(-1, 1, false); }, "m is -1, it goes from 0 to 100000");
    refused([] { denoiser(100001, 1, false); }, "m is 100001");
    refused([] { denoiser(1, -1, false); }, "k is -1, it goes from 0 to 100000");
    refused([] { denoiser(1, 100001, true); }, "k is 100001");
    refused([] { sharpener(0, 3, 1); }, "the first term is 0, it goes from 1 to 100000");
    refused([] { sharpener(4, 3, 1); }, "from term 4 to 3");
    refused([] { sharpener(1, 3, 0); }, "k is 0, it is at least 1");
    refused([] { sharpener(1, 1, 20); }, "more than 10^6");
    refused([] { sharpener(1, 1000, 2); }, "take a narrower band or a smaller k");
    refused([] { check_morph(-1, 0.5); }, "m is -1");
    refused([] { check_morph(100001, 0.5); }, "m is 100001");
    for (const double rho : {0.0, -0.5, 1.5, std::nan("")}) refused([&] { check_morph(2, rho); }, "it lies above 0 and is at most 1");
    refused([] { term_steps(0); }, "the number of terms is 0, it goes from 1 to 100000");
}
