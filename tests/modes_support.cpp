// SPDX-License-Identifier: BSD-3-Clause
#include "tests/modes_support.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

namespace modes_support {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int highest_power = 30;

MatrixXd stacked(const std::array<MatrixXd, 3>& cells) {
    MatrixXd all(3 * cells[0].rows(), cells[0].cols());
    all << cells[0], cells[1], cells[2];
    return all;
}

VectorXd factors(const lcl::Modes& modes, int m) {
    VectorXd values(modes.count());
    for (int j = 0; j < modes.count(); ++j) values[j] = std::pow(modes.values[j], m) * std::pow(double(m), modes.powers[j]);
    return values;
}

void check_rows_sum_to_one(const MatrixXd& matrix) { CHECK((matrix.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-14); }

}  // namespace

void check_kind(const lcl::PatchKind& kind) {
    REQUIRE((kind.step.rows() == kind.point_count && kind.step.cols() == kind.point_count));
    check_rows_sum_to_one(kind.step);
    for (const MatrixXd& cell : kind.cells) {
        REQUIRE(cell.cols() == kind.point_count);
        check_rows_sum_to_one(cell);
    }
    int inner = 0;
    std::vector<int> turned;
    for (const lcl::Orbit& orbit : kind.orbits) {
        REQUIRE(orbit.first == inner);
        inner += orbit.size;
        for (int j = 0; j < orbit.size; ++j) turned.push_back(orbit.first + (j + 1) % orbit.size);
    }
    for (int i = 0; i < inner; ++i)
        for (int j = 0; j < inner; ++j) REQUIRE(std::abs(kind.step(turned[i], turned[j]) - kind.step(i, j)) < 1e-15);
    CHECK(kind.step.topRightCorner(inner, kind.point_count - inner).isZero(0));
}

void check_modes(const lcl::PatchKind& kind, const lcl::Modes& modes) {
    REQUIRE(modes.projection.rows() == modes.count());
    REQUIRE(modes.powers.size() == static_cast<std::size_t>(modes.count()));
    CHECK((modes.values[0] == 1 && modes.powers[0] == 0));
    for (int j = 1; j < modes.count(); ++j) {
        CHECK(modes.powers[j] <= 1);
        CHECK(modes.values[j] <= (j == 1 ? 1 - 1e-3 : modes.values[j - 1]));
    }
    const MatrixXd cells = stacked(modes.cells);
    CHECK((cells.col(0).array() == 1).all());
    // A step's rounding is a few eps and does not grow, since rows are affine with entries of size 1: 30 of them stay far below 1e-12.
    MatrixXd powers = stacked(kind.cells);
    double largest = 0;
    for (int m = 0; m <= highest_power; ++m) {
        largest = std::max(largest, (cells * factors(modes, m).asDiagonal() * modes.projection - powers).cwiseAbs().maxCoeff());
        powers = (powers * kind.step).eval();
    }
    CHECK(largest < 1e-12);
    // Relative to what is left: the same rounding at every step, a factor of a few hundred for the condition of the modes.
    VectorXd points(kind.point_count);
    for (int i = 0; i < kind.point_count; ++i) points[i] = std::sin(i * i + 1.0);
    const Eigen::RowVectorXd limit = modes.projection.row(0);
    const VectorXd coefficients = modes.projection * points;
    points.array() -= double(limit * points);
    largest = 0;
    for (int m = 0; m <= highest_power; ++m) {
        const VectorXd shrunk = cells.rightCols(modes.count() - 1) * (factors(modes, m).cwiseProduct(coefficients)).tail(modes.count() - 1);
        const VectorXd expected = stacked(kind.cells) * points;
        largest = std::max(largest, (shrunk - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff());
        points = (kind.step * points).eval();
        points.array() -= double(limit * points);
    }
    CHECK(largest < 1e-11);
}

void check_values(const lcl::Modes& modes, std::vector<double> expected) {
    std::sort(expected.begin(), expected.end(), std::greater<>());
    std::vector<double> found;
    for (int j = 0; j < modes.count(); ++j)
        if (modes.powers[j] == 0) found.push_back(modes.values[j]);
    REQUIRE(found.size() == expected.size());
    for (std::size_t j = 0; j < found.size(); ++j) {
        CAPTURE(j);
        CHECK(std::abs(found[j] - expected[j]) < 1e-14);
    }
}

}  // namespace modes_support
