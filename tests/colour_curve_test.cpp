// SPDX-License-Identifier: BSD-3-Clause
// The spline through a list of colours: what it interpolates, how smooth it is, how it ends.
#include <cmath>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "host/error.h"
#include "host/filter/colour_curve.h"
#include "tests/shapes/shapes.h"

using namespace lcl;

namespace {

constexpr double rounding = 1e-14;  // some ten operations on numbers up to 3; systems whose inverse is below 1/2

/// Colours near grey: splines through them stay inside [0, 1], so that nothing is cut off. |d_j| <= 1/2 max |6 c_j| round the mean: 3 times 0.1.
std::vector<Colour> soft_colours(std::size_t count, std::uint64_t seed) {
    shapes::Random random(seed);
    std::vector<Colour> colours(count);
    for (Colour& colour : colours)
        for (double& component : colour) component = 0.5 + 0.1 * random.symmetric();
    return colours;
}

/// Second derivatives at the knots of the natural spline through (j, y_j), by its textbook system: s_(j-1) + 4 s_j + s_(j+1) = 6 (y_(j-1) - 2 y_j + y_(j+1)), s
/// = 0 at the ends.
Eigen::VectorXd second_derivatives(const Eigen::VectorXd& y) {
    const Eigen::Index count = y.size();
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (Eigen::Index j = 1; j + 1 < count; ++j) {
        a.row(j).setZero();
        a(j, j - 1) = a(j, j + 1) = 1, a(j, j) = 4;
        right[j] = 6 * (y[j - 1] - 2 * y[j] + y[j + 1]);
    }
    return a.fullPivLu().solve(right);
}

/// The natural spline by cubic pieces in moments, at place j + u.
double natural_spline(const Eigen::VectorXd& y, const Eigen::VectorXd& s, Eigen::Index j, double u) {
    const double v = 1 - u;
    return v * y[j] + u * y[j + 1] + (v * v * v - v) / 6 * s[j] + (u * u * u - u) / 6 * s[j + 1];
}

}  // namespace

TEST_CASE("a colour curve takes every colour at its place", "[colour]") {
    for (const std::size_t count : {2, 3, 4, 5, 17, 1000}) {
        const std::vector<Colour> colours = soft_colours(count, count);
        const ColourCurve curve(colours);
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t c = 0; c < 3; ++c) {
                INFO("colour " << j << " of " << count << ", component " << c);
                // t itself is rounded: count * 2^-53 of a piece, along which a component moves by up to 1.
                CHECK_THAT(curve.at(static_cast<double>(j) / static_cast<double>(count - 1))[c],
                           Catch::Matchers::WithinAbs(colours[j][c], rounding + static_cast<double>(count) * 2e-16));
            }
    }
}

TEST_CASE("a colour curve is the natural cubic spline", "[colour]") {
    for (const std::size_t count : {2, 3, 4, 6, 20}) {
        const std::vector<Colour> colours = soft_colours(count, 10 + count);
        const ColourCurve curve(colours);
        for (std::size_t c = 0; c < 3; ++c) {
            Eigen::VectorXd y(static_cast<Eigen::Index>(count));
            for (std::size_t j = 0; j < count; ++j) y[static_cast<Eigen::Index>(j)] = colours[j][c];
            const Eigen::VectorXd s = second_derivatives(y);
            for (Eigen::Index j = 0; j + 1 < y.size(); ++j)
                for (const double u : {0.0, 0.125, 0.5, 0.8125}) {
                    const double t = (static_cast<double>(j) + u) / static_cast<double>(count - 1);
                    CHECK_THAT(curve.at(t)[c], Catch::Matchers::WithinAbs(natural_spline(y, s, j, u), 3 * rounding));
                }
        }
    }
}

TEST_CASE("a colour curve has continuous second derivatives, which are 0 at its ends", "[colour]") {
    const std::size_t count = 7;
    const ColourCurve curve(soft_colours(count, 4));
    const double h = 1.0 / 64, unit = 1.0 / static_cast<double>(count - 1);  // a cubic's differences are exact in steps of any size
    const auto second_difference = [&](double place, std::size_t c) {
        return (curve.at((place + h) * unit)[c] - 2 * curve.at(place * unit)[c] + curve.at((place - h) * unit)[c]) / (h * h);
    };
    for (std::size_t c = 0; c < 3; ++c) {
        // Second derivatives of the pieces are linear: differences at distances 2 h and 4 h extend them to the knot.
        const auto right = [&](double knot) { return 2 * second_difference(knot + 2 * h, c) - second_difference(knot + 4 * h, c); };
        const auto left = [&](double knot) { return 2 * second_difference(knot - 2 * h, c) - second_difference(knot - 4 * h, c); };
        const double tolerance = 3 * 4 * rounding / (h * h);
        for (std::size_t knot = 1; knot + 1 < count; ++knot)
            CHECK_THAT(right(static_cast<double>(knot)), Catch::Matchers::WithinAbs(left(static_cast<double>(knot)), 2 * tolerance));
        CHECK_THAT(right(0), Catch::Matchers::WithinAbs(0, tolerance));
        CHECK_THAT(left(static_cast<double>(count - 1)), Catch::Matchers::WithinAbs(0, tolerance));
    }
}

TEST_CASE("one colour is that colour everywhere, two make a straight line", "[colour]") {
    const ColourCurve constant({{0.2, 0.4, 1}});
    for (const double t : {0.0, 0.3, 1.0}) CHECK(constant.at(t) == Colour{0.2, 0.4, 1});
    const ColourCurve line({{0, 1, 0.25}, {1, 0, 0.75}});
    for (const double t : {0.0, 0.1, 0.5, 0.77, 1.0}) {
        const Colour found = line.at(t), expected{t, 1 - t, 0.25 + 0.5 * t};
        for (std::size_t c = 0; c < 3; ++c) CHECK_THAT(found[c], Catch::Matchers::WithinAbs(expected[c], rounding));
    }
}

TEST_CASE("a colour curve ends where t does and never leaves the colours there are", "[colour]") {
    const ColourCurve curve({{0, 0, 0}, {1, 0, 1}, {0, 0, 1}, {1, 0, 1}, {0, 0, 0}});
    CHECK(curve.at(-3) == curve.at(0));
    CHECK(curve.at(1.5) == curve.at(1));
    bool is_cut_off = false;
    for (int i = 0; i <= 1000; ++i) {
        const Colour colour = curve.at(i / 1000.0);
        for (const double component : colour) CHECK((component >= 0 && component <= 1));
        is_cut_off = is_cut_off || (colour[2] == 1 && i % 250 != 0);
    }
    CHECK(is_cut_off);  // the spline through 0 1 1 1 0 swings above 1
}

TEST_CASE("a colour curve without colours is refused", "[colour]") { CHECK_THROWS_AS(ColourCurve({}), InvalidArgument); }
