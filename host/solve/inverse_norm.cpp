// SPDX-License-Identifier: BSD-3-Clause
// |A^-1|_inf of the smooth block by Higham and Tisseur's block method for 1-norms (SIAM J. Matrix Anal. Appl. 21, 2000), seven columns at a time: |A^-1|_inf =
// |A^-T|_1, and A^-T = D A^-1 D^-1, so each product is one solve with A.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "host/solve/limit_system.h"
#include "host/solve/recurrences.h"
#include "host/solve/words.h"

namespace lcl {
namespace {

constexpr int columns = 7;  // one field; with three, one matrix in twenty is judged more than 5 % too low
constexpr int rounds = 5;
constexpr int solve_iterations = 1000;
constexpr double solve_tolerance = 1e-4;
constexpr double margin = 1.03;  // the estimate lies below the norm, by less than this as a rule

using Block = std::vector<double>;  // smooth rows x columns

class InverseNormEstimate {
public:
    explicit InverseNormEstimate(LimitSystem& system)
        : A_(*system.A),
          part_(system.plan().smooth),
          scaling_(system.plan().scaling.begin() + part_.first_row, system.plan().scaling.begin() + part_.end_row()),
          m_(A_.make_field(columns, Real::single)),
          x_(A_.make_field(columns, Real::single)) {
        m_.fill_zero();
        visited_.assign(rows(), 0);
    }

    /// Not a number where a solve does not end.
    double run() {
        Block start(rows() * columns);
        std::mt19937 random;  // the same signs in every run
        for (std::size_t i = 0; i < start.size(); ++i) start[i] = (i % columns == 0 || random() % 2 == 0 ? 1.0 : -1.0) / rows();
        double estimate = 0;
        for (int round = 0; round < rounds; ++round) {
            Block y = transposed_solve(std::move(start));
            const double before = estimate;
            for (int c = 0; c < columns; ++c) estimate = std::max(estimate, column_sum(y, c));
            if (round > 0 && estimate <= before * (1 + solve_tolerance)) break;
            for (double& value : y) value = value < 0 ? -1 : 1;
            start = unit_columns(solve(std::move(y)));
        }
        return has_converged_ ? estimate : std::numeric_limits<double>::quiet_NaN();
    }

private:
    std::size_t rows() const { return part_.row_count; }

    /// A^-1 b to solve_tolerance. Values are brought to a size of 1 for float.
    Block solve(Block b) {
        const double size = std::accumulate(b.begin(), b.end(), 0.0, [](double a, double v) { return std::max(a, std::fabs(v)); });
        if (size == 0) return b;
        for (double& value : b) value /= size;
        m_.upload(b.data(), part_.first_row, part_.row_count);
        x_.fill_zero();
        Monitor monitor(solve_iterations, {}, {});
        monitor.allow_growth();
        monitor.begin_stage({solve_tolerance, solve_tolerance});
        iterate_conjugate_gradients(A_, part_, m_, x_, monitor);
        has_converged_ = has_converged_ && monitor.outcome() == Outcome::converged;
        x_.download(b.data(), part_.first_row, part_.row_count);
        for (double& value : b) value *= size;
        return b;
    }

    /// A^-T b = D A^-1 D^-1 b.
    Block transposed_solve(Block b) {
        for (std::size_t i = 0; i < b.size(); ++i) b[i] /= scaling_[i / columns];
        b = solve(std::move(b));
        for (std::size_t i = 0; i < b.size(); ++i) b[i] *= scaling_[i / columns];
        return b;
    }

    static double column_sum(const Block& block, int column) {
        double sum = 0;
        for (std::size_t i = column; i < block.size(); i += columns) sum += std::fabs(block[i]);
        return sum;
    }

    /// Unit vectors at the rows in which z is largest, rows of earlier rounds left out.
    Block unit_columns(const Block& z) {
        std::array<std::size_t, columns> best{};
        std::array<double, columns> size;
        size.fill(-1);
        for (std::size_t row = 0; row < rows(); ++row) {
            if (visited_[row]) continue;
            double largest = 0;
            for (int c = 0; c < columns; ++c) largest = std::max(largest, std::fabs(z[row * columns + c]));
            const auto place = std::min_element(size.begin(), size.end());
            if (largest > *place) *place = largest, best[place - size.begin()] = row;
        }
        Block unit(rows() * columns, 0.0);
        for (int c = 0; c < columns; ++c) unit[best[c] * columns + c] = 1, visited_[best[c]] = 1;
        return unit;
    }

    DeviceOperator& A_;
    const Part part_;
    const std::vector<double> scaling_;
    Field m_, x_;
    std::vector<std::uint8_t> visited_;
    bool has_converged_ = true;
};

/// min (a_ii - sum |a_ij|), Gershgorin's bound; weights of meshes are not negative and sum to 1.
double dominance_of(const LimitSystem& system) {
    const Plan& plan = system.plan();
    if (system.origin == Origin::rows) return plan.lambda_min_bound;
    double dominance = 1;
    for (Index row = plan.smooth.first_row; row < plan.smooth.end_row(); ++row) dominance = std::min(dominance, 2 * plan.diagonal[row] - 1);
    return dominance;
}

}  // namespace

bool has_inverse_norm(const LimitSystem& system) {
    const Plan& plan = system.plan();
    return plan.has_scaling ? !plan.has_darts() : dominance_of(system) > 0;
}

const InverseNorm& inverse_norm_of(LimitSystem& system) {
    if (system.inverse_norm) return *system.inverse_norm;
    if (!has_inverse_norm(system))
        throw Unsupported("a bound of the inverse needs a self-adjoint operator, " + why_not_symmetric(system) +
                          (system.plan().has_scaling ? "" : ", and are not diagonally dominant"));
    const double dominance = dominance_of(system);
    const Spectrum& spectrum = spectrum_of(system);
    if (dominance > 0) system.inverse_norm = InverseNorm{1 / dominance, true};
    else if (spectrum.singular || spectrum.indefinite) system.inverse_norm = InverseNorm{std::numeric_limits<double>::infinity(), spectrum.singular};
    else system.inverse_norm = InverseNorm{InverseNormEstimate(system).run() * margin, false};
    return *system.inverse_norm;
}

}  // namespace lcl
