// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/recurrences.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lcl {
namespace {

constexpr double negligible = 1e-28;  // of the first <r, r>_D
constexpr int longest_chain = 16;     // sweeps between two looks at the residuals

}  // namespace

// y = x + w (m - A x), or + (m - A x) / A_ii
void iterate_stationary(DeviceOperator& A, const Part& part, double weight, bool jacobi, const Field& m, Field& x, Monitor& monitor) {
    const Sweep sweep = jacobi ? Sweep{1, 0, 1, 0} : Sweep{1, weight, 0, 0};
    Field y = A.make_field(x.channels(), x.real());
    y.copy_from(x);  // rows outside the part
    for (;; monitor.advance(), std::swap(x, y)) {
        A.sweep(sweep, m, x, nullptr, y, part);
        if (monitor.stop(A.norms(x, part))) return;
    }
}

void iterate_gauss_seidel(DeviceOperator& A, const Schedule& schedule, const Field& m, Field& x, Monitor& monitor) {
    const Part all = A.plan().all_rows();
    Field residual = A.make_field(x.channels(), x.real());
    for (;; monitor.advance()) {
        A.sweep({0, 1, 0, 0}, m, x, nullptr, residual, all);
        if (monitor.stop(A.norms(x, all))) return;
        A.relax_rows(schedule, m, x);
    }
}

// x_1 = x_0 + r_0 / theta; x_(k+1) = x_k + rho_k rho_(k-1) (x_k - x_(k-1)) + 2 rho_k / delta r_k, rho_k = 1 / (2 theta / delta - rho_(k-1)), rho_0 = delta /
// theta
Sweep ChebyshevSweeps::next() {
    if (rho_ == 0) {
        rho_ = delta_ / theta_;
        return {1, 1 / theta_, 0, 0};
    }
    const double before = rho_;
    rho_ = 1 / (2 * theta_ / delta_ - before);
    return {1 + rho_ * before, 2 * rho_ / delta_, 0, -rho_ * before};
}

// |r_k| / |r_0| <= 1 / T_k(theta / delta)
int ChebyshevSweeps::count_for(double gain) const {
    if (!(gain > 0)) return std::numeric_limits<int>::max();
    return gain >= 1 ? 0 : static_cast<int>(std::min(std::ceil(std::acosh(1 / gain) / std::acosh(theta_ / delta_)), 1e6));
}

// q = (theta - sqrt(theta^2 - delta^2)) / delta
double ChebyshevSweeps::rate() const { return (theta_ - std::sqrt(theta_ * theta_ - delta_ * delta_)) / delta_; }

void iterate_chebyshev(DeviceOperator& A, const Part& part, double low, const ResidualNorms& start, const Field& m, Field& x, Field& y, Monitor& monitor) {
    ChebyshevSweeps sweeps(low);
    y.copy_from(x);
    const auto gain_from = [&](const ResidualNorms& e) {
        const auto share = [](double target, double size) { return size > target ? target / size : 1.0; };
        return std::min(share(monitor.stage_target().position, e.position), share(monitor.stage_target().others, e.others));
    };
    int wanted = std::max(1, sweeps.count_for(gain_from(start)));
    while (wanted > 0 && monitor.remaining() > 0) {
        std::vector<Sweep> chain(std::min({wanted, monitor.remaining(), longest_chain}));
        for (Sweep& sweep : chain) sweep = sweeps.next();
        const std::vector<ResidualNorms> norms = A.chain(chain, m, x, y, part);
        if (monitor.stop_after(norms)) return;
        // The last norm is that of the iterate before the newest, which is one sweep better.
        const double gain = gain_from(norms.back());
        wanted = gain > 0 ? static_cast<int>(std::min(std::ceil(std::log(gain) / std::log(sweeps.rate())), 1e6)) - 1 : longest_chain;
    }
    if (monitor.remaining() > 0) return monitor.set_outcome(Outcome::converged);
    A.sweep({0, 1, 0, 0}, m, x, nullptr, y, part);
    monitor.stop(A.norms(x, part));
}

void iterate_conjugate_gradients(DeviceOperator& A, const Part& part, const Field& m, Field& x, Monitor& monitor, LanczosCoefficients* coefficients) {
    const int channels = x.channels();
    Field r = A.make_field(channels, x.real()), p = A.make_field(channels, x.real()), q = A.make_field(channels, x.real());
    for (Field* field : {&r, &p, &q}) field->fill_zero();  // rows outside the part stay zero
    A.sweep({0, 1, 0, 0}, m, x, nullptr, r, part);
    if (monitor.stop(A.norms(x, part))) return;
    ChannelValues alpha(channels, 0.0), beta(channels, 0.0);
    ChannelValues rr = A.cg_update(alpha, p, q, x, r, part);  // alpha = 0: only <r, r>_D
    const ChannelValues first = rr;
    for (;;) {
        A.cg_direction(beta, r, p, part);
        const ChannelValues pq = A.cg_apply(p, q, part);
        for (int c = 0; c < channels; ++c) {
            const bool is_rounding = !(rr[c] > negligible * first[c]) || pq[c] == 0;  // this channel is solved
            if (!is_rounding && pq[c] < 0 && coefficients == nullptr) return monitor.set_outcome(Outcome::indefinite);
            alpha[c] = is_rounding ? 0.0 : rr[c] / pq[c];
        }
        const ChannelValues rr_next = A.cg_update(alpha, p, q, x, r, part);
        for (int c = 0; c < channels; ++c) beta[c] = rr[c] > 0 ? rr_next[c] / rr[c] : 0.0;
        if (coefficients != nullptr) coefficients->alpha.push_back(alpha), coefficients->beta.push_back(beta);
        rr = rr_next;
        monitor.advance();
        if (monitor.stop(A.norms(x, part))) return;
    }
}

// T_kk = 1/alpha_k + beta_(k-1)/alpha_(k-1), T_k,k+1 = sqrt(beta_k)/alpha_k
double smallest_ritz_value(const LanczosCoefficients& coefficients, int steps) {
    double smallest = std::numeric_limits<double>::infinity();
    const std::size_t channels = coefficients.alpha.empty() ? 0 : coefficients.alpha[0].size();
    for (std::size_t c = 0; c < channels; ++c) {
        std::vector<double> diagonal, off;
        const std::size_t count = std::min<std::size_t>(steps, coefficients.alpha.size());
        for (std::size_t k = 0; k < count && coefficients.alpha[k][c] != 0; ++k) {
            diagonal.push_back(1 / coefficients.alpha[k][c] + (k > 0 ? coefficients.beta[k - 1][c] / coefficients.alpha[k - 1][c] : 0.0));
            off.push_back(std::sqrt(std::max(0.0, coefficients.beta[k][c])) / coefficients.alpha[k][c]);
        }
        if (diagonal.empty()) continue;
        off.pop_back();
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
        solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), diagonal.size()), Eigen::Map<Eigen::VectorXd>(off.data(), off.size()),
                                      Eigen::EigenvaluesOnly);
        smallest = std::min(smallest, solver.eigenvalues()(0));
    }
    return smallest;
}

}  // namespace lcl
