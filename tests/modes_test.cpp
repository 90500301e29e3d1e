// SPDX-License-Identifier: BSD-3-Clause
// Kinds of Catmull-Clark patches and the eigenstructure of kinds.
#include <cmath>

#include <catch2/catch.hpp>

#include "host/evaluate/catmull_clark_kinds.h"
#include "tests/modes_support.h"

using namespace lcl;
using namespace modes_support;
using Ring = CatmullClarkPlace::Ring;

namespace {

constexpr double two_pi = 6.283185307179586;

PatchKind smooth_kind(int n) { return catmull_clark_kind({Ring::closed, false, n, 0, -1}); }

/// Stam 1998, appendix A; S12's are those of a regular patch's outer points.
std::vector<double> catmull_clark_values(int n) {
    std::vector<double> values{1};
    for (const double sign : {-1.0, 1.0}) {
        values.push_back((3.0 * n - 7 + sign * std::sqrt(5.0 * n * n - 30 * n + 49)) / (8 * n));
        for (int w = 1; w < n; ++w) {
            const double c = std::cos(two_pi * w / n);
            values.push_back((5 + c + sign * std::sqrt(std::max(0.0, (c + 1) * (c + 9)))) / 16);
        }
    }
    values.insert(values.end(), {1.0 / 8, 1.0 / 8, 1.0 / 16, 1.0 / 16, 1.0 / 32, 1.0 / 32, 1.0 / 64});
    return values;
}

/// A turned ring of three, S with 1/2 in the middle and 1/4 at both sides: the values 1, 1/4, 1/4. Cells are one point each: the outer ones.
PatchKind made_up_kind(const Eigen::MatrixXd& outer) {
    PatchKind kind;
    kind.point_count = 3 + static_cast<int>(outer.rows());
    kind.step = Eigen::MatrixXd::Zero(kind.point_count, kind.point_count);
    kind.step.topLeftCorner(3, 3) << 0.5, 0.25, 0.25, 0.25, 0.5, 0.25, 0.25, 0.25, 0.5;
    kind.step.bottomRows(outer.rows()) = outer;
    for (auto& cell : kind.cells) cell = Eigen::MatrixXd::Identity(kind.point_count, kind.point_count).bottomRows(outer.rows());
    kind.orbits = {{0, 3, 0}};
    return kind;
}

}  // namespace

TEST_CASE("Catmull-Clark modes of valences 3 to 50 do what the powers of the step do", "[evaluate][modes]") {
    for (const int n : {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 16, 24, 25, 36, 50}) {
        CAPTURE(n);
        const PatchKind kind = smooth_kind(n);
        REQUIRE(kind.point_count == 2 * n + 8);
        check_kind(kind);
        const auto modes = find_modes(kind);
        REQUIRE(modes);
        check_modes(kind, *modes);
        check_values(*modes, catmull_clark_values(n));
        // The limit mask: n^2, 4 and 1 over n (n + 5).
        const double sum = n * (n + 5.0);
        for (int i = 0; i < kind.point_count; ++i) {
            const double weight = i == 0 ? n / (n + 5.0) : i <= n ? 4 / sum : i <= 2 * n ? 1 / sum : 0;
            CHECK(std::abs(modes->projection(0, i) - weight) < 1e-14);
        }
    }
}

TEST_CASE("every valence up to 50 has modes", "[evaluate][modes]") {
    for (int n = 3; n <= 50; ++n) {
        CAPTURE(n);
        const auto modes = find_modes(smooth_kind(n));
        REQUIRE(modes);
        CHECK(modes->count() == 2 * n + 8);
    }
}

TEST_CASE("sharp kinds have affine steps and no modes", "[evaluate][modes]") {
    std::vector<CatmullClarkPlace> places{{Ring::closed, true, 3, 0, -1}, {Ring::closed, true, 4, 0, -1}};
    for (const int n : {2, 3, 4, 5})
        for (int d = 0; d < n; ++d) places.push_back({Ring::closed, false, n, 0, d});
    for (const int k : {1, 2, 3, 5})
        for (int j = 0; j < k; ++j)
            for (const bool is_corner : {false, true}) places.push_back({Ring::sector, is_corner, k, j, -1});
    for (const CatmullClarkPlace& place : places) {
        CAPTURE(place.faces, place.place, place.sharp_edge, place.is_corner);
        const PatchKind kind = catmull_clark_kind(place);
        check_kind(kind);
        CHECK(kind.orbits.empty());
        CHECK_FALSE(find_modes(kind));
        CHECK_FALSE(modes_of(kind));
        CHECK(kind.step.minCoeff() >= 0);
        if (place.is_corner) CHECK(kind.step.row(0) == Eigen::RowVectorXd::Unit(kind.point_count, 0));
    }
}

TEST_CASE("equal values that share no eigenvectors make chains of length two", "[evaluate][modes]") {
    Eigen::MatrixXd outer(2, 5);
    outer << 0.75, 0, 0, 0.25, 0,  //
        0, 0.5, 0.25, 0, 0.25;
    const PatchKind kind = made_up_kind(outer);
    check_kind(kind);
    const auto modes = find_modes(kind);
    REQUIRE(modes);
    CHECK(modes->count() == 7);
    CHECK(std::count(modes->powers.begin(), modes->powers.end(), 1) == 2);
    check_modes(kind, *modes);
    check_values(*modes, {1, 0.25, 0.25, 0.25, 0.25});
    // By hand: the outer point x' = x/4 + 3/4 e, e' = e/4 about the limit, so after m steps x = (x + 3 m e) / 4^m.
    Eigen::VectorXd points(5);
    points << 2, -1, -1, 7, 0;
    for (const int m : {0, 1, 2, 5}) {
        double x = 0;
        for (int j = 0; j < modes->count(); ++j)
            x += modes->cells[0](0, j) * std::pow(modes->values[j], m) * (modes->powers[j] != 0 ? m : 1) * (modes->projection.row(j) * points)(0);
        CHECK(std::abs(x - (7 + 3 * m * 2) / std::pow(4, m)) < 1e-13);
    }
}

TEST_CASE("equal values that the outer points do not feel make no chain", "[evaluate][modes]") {
    Eigen::MatrixXd outer(1, 4);
    outer << 0.25, 0.25, 0.25, 0.25;
    const auto modes = find_modes(made_up_kind(outer));
    REQUIRE(modes);
    CHECK(modes->count() == 4);
    check_modes(made_up_kind(outer), *modes);
}

TEST_CASE("kinds whose structure is not known have no modes", "[evaluate][modes]") {
    Eigen::MatrixXd outer(2, 5);
    outer << 0.75, 0, 0, 0.25, 0,  // a chain within the outer points
        0, 0.25, 0, 0.5, 0.25;
    CHECK_FALSE(find_modes(made_up_kind(outer)));
    PatchKind bent = smooth_kind(5);
    bent.step(1, 0) += 0.125;  // no longer alike from every face
    bent.step(1, 1) -= 0.125;
    CHECK_FALSE(find_modes(bent));
}

TEST_CASE("modes are found once for equal kinds", "[evaluate][modes]") {
    const auto modes = modes_of(smooth_kind(7));
    REQUIRE(modes);
    CHECK(modes_of(smooth_kind(7)) == modes);
    CHECK(modes_of(smooth_kind(6)) != modes);
    CHECK(modes->values == find_modes(smooth_kind(7))->values);
}
