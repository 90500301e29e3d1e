// SPDX-License-Identifier: BSD-3-Clause
// Improved Perlin noise: values worked out by hand from the permutation and the gradients, the kernel against the oracle, and the offsets of seeds.
#include <array>
#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "host/apply/noise.h"
#include "tests/oracle/noise.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

using Point = std::array<double, 3>;

/// A value sums eight slopes below 3 by weights each of which is off by some ten roundings; f moves by less than 20 times what its argument does.
constexpr double roundings = 256;
double unit_of(Real real, const Context& context) { return std::ldexp(1, real == Real::single || !context.device().has_double ? -24 : -53); }

std::vector<double> values_at(const std::vector<double>& points, int octave, Real real, const std::shared_ptr<Context>& context = device_context(),
                              const NoiseFrame& frame = {}) {
    return noise_octave(context, frame, points, octave, real);
}

double value_at(const Point& p, Real real = Real::wide) { return values_at({p.begin(), p.end()}, 0, real).at(0); }

/// Rough points in a box of `size` about the origin.
std::vector<double> points_in_box(std::size_t count, double size, std::uint64_t seed) {
    shapes::Random random(seed);
    std::vector<double> points(3 * count);
    for (double& coordinate : points) coordinate = size / 2 * random.symmetric();
    return points;
}

void check_against_oracle(const std::vector<double>& points, int octave, Real real, const std::shared_ptr<Context>& context = device_context()) {
    const std::vector<double> found = values_at(points, octave, real, context);
    REQUIRE(3 * found.size() == points.size());
    double largest = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
        const double* p = &points[3 * v];
        const double expected = oracle::improved_noise(std::ldexp(p[0], octave), std::ldexp(p[1], octave), std::ldexp(p[2], octave));
        const double difference = std::fabs(std::ldexp(found[v], octave) - expected);
        if (!(difference <= largest)) largest = difference;
    }
    INFO("octave " << octave << ", " << found.size() << " points");
    CHECK(largest <= roundings * unit_of(real, *context));
}

}  // namespace

// With p the permutation, corner (x, y, z) hashes to p[p[p[x] + y] + z]. Round the cell at the origin, its last four bits and what they stand for:
//   (0,0,0) p[0] = 151, p[151] = 17, p[17] = 36, 4: (1,0,1)        (0,0,1) p[18] = 103, 7: (-1,0,-1)
//   (1,0,0) p[1] = 160, p[160] = 119, p[119] = 86, 6: (1,0,-1)     (1,0,1) p[120] = 164, 4: (1,0,1)
//   (0,1,0) p[152] = 182, p[182] = 108, 12: (1,1,0)                (0,1,1) p[183] = 110, 14: (-1,1,0)
//   (1,1,0) p[161] = 248, p[248] = 128, 0: (1,1,0)                 (1,1,1) p[249] = 195, 3: (-1,-1,0)
TEST_CASE("noise has the values worked out by hand", "[noise]") {
    const Real real = GENERATE(Real::single, Real::wide);
    const auto check = [&](const Point& p, double expected) {
        INFO(p[0] << ", " << p[1] << ", " << p[2]);
        CHECK_THAT(value_at(p, real), Catch::Matchers::WithinAbs(expected, roundings * unit_of(real, *device_context())));
        CHECK_THAT(improved_noise(p), Catch::Matchers::WithinAbs(expected, roundings * std::ldexp(1, -53)));
        CHECK_THAT(oracle::improved_noise(p[0], p[1], p[2]), Catch::Matchers::WithinAbs(expected, roundings * std::ldexp(1, -53)));
    };
    check({0.5, 0.5, 0.5}, -2.0 / 8);     // the mean of 1, -1, 0, -1, 0, -1, -1, 1
    check({-0.5, -0.5, -0.5}, -7.0 / 8);  // the cell before: -1, 0, -1, -1, -1, -1, -1, -1
    check({0, 0.5, 0}, (0.0 - 0.5) / 2);  // on an edge only its two ends count
    check({0.5, 0, 0}, (0.5 - 0.5) / 2);
    check({0.25, 0, 0}, 0.25 - 0.103515625);         // fade(1/4) = 1/64 (1/4 (6/4 - 15) + 10), times the difference of the slopes -3/4 and 1/4
    check({256.25, -256, 512}, 0.25 - 0.103515625);  // it repeats after 256 cells
    check({3.14, 42, 7}, 0.13691995878400012);       // widely quoted values of the author's own program
    check({1.4142, 1.2589, 2.718}, -0.17245663814988);
}

TEST_CASE("noise is zero at whole numbers", "[noise]") {
    std::vector<double> points;
    for (int x = -3; x < 4; ++x)
        for (int y = 250; y < 260; ++y) points.insert(points.end(), {static_cast<double>(x), static_cast<double>(y), 1e9 * x + y});
    for (const Real real : {Real::single, Real::wide})
        for (const int octave : {0, 7}) {
            const std::vector<double> values = values_at(points, octave, real);
            CHECK(std::all_of(values.begin(), values.end(), [](double value) { return value == 0; }));
        }
}

TEST_CASE("the noise kernel meets the oracle at awkward sizes", "[noise][kernel]") {
    for (const std::size_t count : {1, 63, 64, 65, 1000})
        for (const Real real : {Real::single, Real::wide}) check_against_oracle(points_in_box(count, 40, count), 0, real);
    for (const int octave : {1, 5, 19})
        for (const Real real : {Real::single, Real::wide}) check_against_oracle(points_in_box(2000, 40, 7), octave, real);
    if (device_context()->device().has_double) check_against_oracle(points_in_box(2000, 40, 8), 3, Real::full);
    check_against_oracle(points_in_box(2000, 2e7, 9), 0, Real::single);      // ten million cells away a float has no fraction left
    check_against_oracle(points_in_box(300000, 1000, 10), 0, Real::single);  // more than one launch takes
}

TEST_CASE("devices without double precision get the same noise to rounding", "[noise][kernel]") {
    const std::vector<double> points = points_in_box(1000, 1e6, 1);
    for (const Real real : {Real::single, Real::wide}) check_against_oracle(points, 4, real, context_without_double());
    CHECK(values_at(points, 4, Real::wide, context_without_double()) == values_at(points, 4, Real::single, context_without_double()));
    CHECK_THROWS_AS(values_at(points, 4, Real::full, context_without_double()), Unsupported);
}

TEST_CASE("the noise kernel runs once on a few points", "[noise][kernel][tiny]") {
    for (const Real real : {Real::single, Real::wide}) check_against_oracle(points_in_box(70, 40, 1), 2, real);
}

TEST_CASE("noise is continuous with its first two derivatives", "[noise]") {
    // At the sides of cells, where formulas change, along the axis. Slopes there are up to 3 apart, and fade has derivatives up to 15/8, 5.8 and 60: those of f
    // are below 15/8 * 3 + 1 = 7, 5.8 * 3 + 2 * 15/8 = 22 and 60 * 3 + 3 * 5.8 = 200.
    const double step = 1e-4;
    std::vector<double> points;
    shapes::Random random(3);
    for (int k = 0; k < 300; ++k) {
        Point p{10 * random.symmetric(), 10 * random.symmetric(), 10 * random.symmetric()};
        const int axis = k % 3;
        p[axis] = std::round(p[axis]);
        for (int side = -2; side <= 2; ++side) {
            Point q = p;
            q[axis] += side * step;
            points.insert(points.end(), q.begin(), q.end());
        }
    }
    const std::vector<double> f = values_at(points, 0, Real::wide);
    const double rounding = roundings * unit_of(Real::wide, *device_context());
    for (std::size_t i = 0; i < f.size(); i += 5) {
        CHECK(std::fabs(f[i + 3] - f[i + 2]) <= 7 * step + 2 * rounding);
        CHECK(std::fabs(f[i + 3] - 2 * f[i + 2] + f[i + 1]) <= 22 * step * step + 4 * rounding);
        // A fade of degree 3, as in the noise of 1985, has a second derivative that jumps.
        CHECK(std::fabs((f[i + 4] - 2 * f[i + 3] + f[i + 2]) - (f[i + 2] - 2 * f[i + 1] + f[i])) <= 2 * 200 * step * step * step + 8 * rounding);
    }
}

TEST_CASE("a frame is applied before points are taken apart", "[noise]") {
    const NoiseFrame frame{{1, 2, 3}, {100.25, 7.375, 0.125}, 5};
    const std::vector<double> points = points_in_box(100, 4, 2);
    std::vector<double> framed = points;
    for (std::size_t i = 0; i < points.size(); ++i) framed[i] = 5 * (points[i] - frame.centre[i % 3]) + frame.offset[i % 3];
    CHECK(values_at(points, 3, Real::wide, device_context(), frame) == values_at(framed, 3, Real::wide));
}

TEST_CASE("points that are far beyond all cells have some finite noise", "[noise]") {
    const std::vector<double> values = values_at({1e300, -1e300, 1e308, 1e18, 4e15, -1e9}, 19, Real::single);
    CHECK(std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }));
}

TEST_CASE("offsets of seeds are the same everywhere, differ, and are far from whole numbers in every octave", "[noise]") {
    std::set<Point> all;
    double nearest = 1;
    for (std::uint32_t seed = 0; seed < 2000; ++seed) {
        const Point offset = noise_offset(seed < 1000 ? seed : 0xffffffffu - seed);
        all.insert(offset);
        for (const double value : offset) {
            CHECK((value >= 0 && value < 256));
            for (int octave = 0; octave < most_octaves; ++octave) {
                const double scaled = std::ldexp(value, octave);
                nearest = std::min(nearest, std::fabs(scaled - std::round(scaled)));
            }
        }
    }
    CHECK(all.size() == 2000);
    CHECK(nearest >= 1.0 / 7 - std::ldexp(1, -24));  // digits end after the 44th
    CHECK(nearest <= 1.0 / 7 + 1e-3);                // and do come near that
}
