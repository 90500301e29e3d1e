// SPDX-License-Identifier: BSD-3-Clause
// Limit masks against numbers worked out by hand.
#include <cmath>
#include <numeric>

#include <catch2/catch.hpp>

#include "host/scheme/masks.h"
#include "tests/solver_support.h"

using namespace lcl;
using solver_test::catmull_clark;
using solver_test::doo_sabin;
using solver_test::loop;

namespace {

constexpr double tolerance = 4e-16;  // two roundings of numbers below 1

void check_mask(const RingWeights& mask, double vertex, double edge, double diagonal) {
    CHECK(mask.vertex == Approx(vertex).margin(tolerance));
    CHECK(mask.edge == Approx(edge).margin(tolerance));
    CHECK(mask.diagonal == Approx(diagonal).margin(tolerance));
}

double sum_of(const std::vector<double>& weights) { return std::accumulate(weights.begin(), weights.end(), 0.0); }

}  // namespace

TEST_CASE("Catmull-Clark masks have the numbers of the books", "[masks][catmull-clark]") {
    check_mask(smooth_ring_weights(catmull_clark(), 4, true), 16.0 / 36, 4.0 / 36, 1.0 / 36);
    check_mask(smooth_ring_weights(catmull_clark(), 3, true), 9.0 / 24, 4.0 / 24, 1.0 / 24);
    check_mask(smooth_ring_weights(catmull_clark(0.5), 3, true), 10.5 / 24, 3.5 / 24, 1.0 / 24);  // 3 (2 + 1/2) + 3, 2 - 1/2 + 2
    check_mask(smooth_ring_weights(catmull_clark(1), 5, true), 30.0 / 50, 3.0 / 50, 1.0 / 50);    // 5 (4 + 1) + 5, 2 - 1 + 2
    check_mask(smooth_ring_weights(catmull_clark(), 3, false), 10.0 / 24, 14.0 / 72, 0);          // 3 * 2 + 3 * 4/3, 2 + 8/3
    check_mask(smooth_ring_weights(catmull_clark(), 6, false), 38.0 / 66, 7.0 / 99, 0);           // 6 * 5 + 6 * 4/3, (2 + 8/3)/66
}

TEST_CASE("Loop masks have the numbers of the books, the lost square put back", "[masks][loop]") {
    CHECK(loop_limit_vertex_weight(6) == Approx(0.5).margin(tolerance));
    CHECK(loop_limit_vertex_weight(3) == Approx(0.4).margin(tolerance));        // cos = -1/2: square 1/16, 3/(11 - 3.5)
    CHECK(loop_limit_vertex_weight(4) == Approx(24.0 / 55).margin(tolerance));  // cos = 0: square 9/64, 3/(11 - 3 - 9/8)
    check_mask(smooth_ring_weights(loop(), 6, false), 0.5, 1.0 / 12, 0);
    CHECK(loop_refined_edge_weight(6) == Approx(1.0 / 16).margin(tolerance));
    CHECK(loop_refined_edge_weight(3) == Approx(3.0 / 16).margin(tolerance));  // (5/8 - 1/16)/3
    CHECK(loop_refined_edge_weight(4) == Approx(31.0 / 256).margin(tolerance));
}

TEST_CASE("Doo-Sabin's two masks agree on quads and nowhere else", "[masks][doo-sabin]") {
    const std::vector<double> quad{9.0 / 16, 3.0 / 16, 1.0 / 16, 3.0 / 16};
    for (int j = 0; j < 4; ++j)
        for (const DooSabinMask mask : {DooSabinMask::catmull, DooSabinMask::classic}) CHECK(doo_sabin_weight(mask, 4, j) == Approx(quad[j]).margin(tolerance));
    CHECK(doo_sabin_weight(DooSabinMask::catmull, 3, 0) == Approx(7.0 / 12).margin(tolerance));
    CHECK(doo_sabin_weight(DooSabinMask::catmull, 3, 1) == Approx(5.0 / 24).margin(tolerance));
    CHECK(doo_sabin_weight(DooSabinMask::classic, 3, 0) == Approx(8.0 / 12).margin(tolerance));
    CHECK(doo_sabin_weight(DooSabinMask::classic, 3, 2) == Approx(1.0 / 6).margin(tolerance));
    CHECK(doo_sabin_weight(DooSabinMask::catmull, 6, 3) == Approx(1.0 / 24).margin(tolerance));
    CHECK(doo_sabin_weight(DooSabinMask::classic, 6, 3) == Approx(1.0 / 24).margin(tolerance));  // (3 - 2)/24
    CHECK(doo_sabin_weight(DooSabinMask::classic, 6, 1) == Approx(4.0 / 24).margin(tolerance));  // (3 + 1)/24
    CHECK(doo_sabin_weight(DooSabinMask::catmull, 6, 1) == Approx(4.0 / 24).margin(tolerance));  // 1/8 + 1/24
    CHECK(doo_sabin_weight(DooSabinMask::classic, 6, 2) == Approx(2.0 / 24).margin(tolerance));
    for (int m = 3; m <= 60; ++m)
        for (const DooSabinMask mask : {DooSabinMask::catmull, DooSabinMask::classic}) {
            double sum = 0;
            for (int j = 0; j < m; ++j) sum += doo_sabin_weight(mask, m, j);
            CHECK(sum == Approx(1).margin(m * tolerance));
        }
    check_mask(smooth_ring_weights(doo_sabin(), 4, true), 36.0 / 64, 6.0 / 64, 1.0 / 64);
    check_mask(smooth_ring_weights(doo_sabin(), 5, false), 7.0 / 12, 1.0 / 12, 0);
    check_mask(smooth_ring_weights(doo_sabin(DooSabinMask::classic), 5, false), 2.0 / 3, 1.0 / 15, 0);
}

TEST_CASE("ring masks sum to one and have no negative weight, at any valence", "[masks]") {
    for (const auto& scheme : solver_test::all_schemes())
        for (int n = 3; n <= 60; ++n)
            for (const bool quads : {false, true}) {
                if (quads && scheme.options.scheme == Scheme::loop) continue;
                INFO(scheme.name << ", valence " << n << (quads ? ", quads" : ", triangles"));
                const RingWeights mask = blend(smooth_ring_weights(scheme.options, n, quads), scheme.options.lambda);
                CHECK(mask.vertex + n * mask.edge + n * mask.diagonal == Approx(1).margin(1e-15));
                CHECK(mask.vertex > 0);
                CHECK(mask.edge >= 0);
                CHECK(mask.diagonal >= 0);
            }
}

TEST_CASE("curve masks are the cubic and the quadratic B-spline's", "[masks][boundary]") {
    check_mask(curve_weights(Scheme::catmull_clark), 2.0 / 3, 1.0 / 6, 0);
    check_mask(curve_weights(Scheme::loop), 2.0 / 3, 1.0 / 6, 0);
    check_mask(curve_weights(Scheme::doo_sabin), 3.0 / 4, 1.0 / 8, 0);
}

TEST_CASE("blending with the identity moves weight to the vertex", "[masks][two-phase]") {
    check_mask(blend({16.0 / 36, 4.0 / 36, 1.0 / 36}, 0.25), 0.25 + 12.0 / 36, 3.0 / 36, 0.75 / 36);
    check_mask(blend({0.5, 1.0 / 12, 0}, 1), 1, 0, 0);
}

TEST_CASE("symmetric scalings and lower bounds have the papers' values", "[masks][spectrum]") {
    CHECK(symmetric_scaling(Scheme::catmull_clark, 4, 0) == 36);
    CHECK(symmetric_scaling(Scheme::catmull_clark, 3, 0.5) == 48);
    CHECK(symmetric_scaling(Scheme::loop, 6, 0) == Approx(12));
    CHECK(symmetric_scaling(Scheme::doo_sabin, 5, 0) == 5);
    CHECK(lambda_min_bound(catmull_clark(), 4, 0) == Approx(1.0 / 9));
    CHECK(lambda_min_bound(catmull_clark(), 3, 0) == 0);
    CHECK(lambda_min_bound(catmull_clark(0.5), 3, 0) == Approx(1.0 / 8));
    CHECK(lambda_min_bound(catmull_clark(), 3, 0.25) == Approx(0.25));
    CHECK(lambda_min_bound(loop(), 3, 0) == Approx(0.1));
    CHECK(lambda_min_bound(loop(), 6, 0) == Approx(0.25));
    CHECK(lambda_min_bound(loop(), 4, 0) == Approx(17.0 / 110));
    CHECK(lambda_min_bound(doo_sabin(), 3, 0) == 0.25);
}

TEST_CASE("a Loop dart of valence 6 has its left eigenvector's weights", "[masks][crease]") {
    // Twice the mesh-independent check: w S = w for the umbrella's matrix S with the first edge's rule replaced by the midpoint.
    const std::vector<double> w = loop_dart_weights(6);
    REQUIRE(w.size() == 7);
    CHECK(sum_of(w) == Approx(1).margin(1e-14));
    CHECK(w[0] * 5 / 8 + 0.5 * w[1] + 3.0 / 8 * (w[2] + w[3] + w[4] + w[5] + w[6]) == Approx(w[0]).margin(1e-14));
    CHECK(w[0] / 16 + 0.5 * w[1] + (w[2] + w[6]) / 8 == Approx(w[1]).margin(1e-14));
    CHECK(w[0] / 16 + 3 * w[2] / 8 + w[3] / 8 == Approx(w[2]).margin(1e-14));  // its sharp neighbour's rule does not use it
    CHECK(w[2] == Approx(w[6]).margin(1e-15));
    CHECK(w[0] > 0.5);  // the smooth mask has 1/2
}

TEST_CASE("a Catmull-Clark dart of valence 4 has the vertex weight of the brute-force row", "[masks][crease]") {
    const std::vector<double> w = catmull_clark_dart_weights(4);
    REQUIRE(w.size() == 9);
    CHECK(sum_of(w) == Approx(1).margin(1e-14));
    CHECK(w[0] == Approx(0.4676617).margin(1e-7));
    CHECK(w[2] == Approx(w[4]).margin(1e-15));
    for (const double weight : w) CHECK(weight > 0);
}
