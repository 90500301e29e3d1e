// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/ritz.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/apply/host_operator.h"
#include "host/parallel.h"
#include "host/solve/rough_vector.h"

namespace lcl {
namespace {

constexpr int most_steps = 30, least_steps = 8;
constexpr std::size_t most_bytes = std::size_t{1} << 29;  // of the vectors
constexpr std::size_t chunk = 16384;                      // rows of which sums are made, whatever the number of cores: results are the same on all
constexpr double rounding = 1e-6;                         // of weights that were floats once: 6e-8, and some of them in a row
constexpr double exhausted = 1e-13;                       // of the size of A v: what is left of it is rounding

using Vector = std::vector<double>;

/// v_1 .. v_k, orthonormal in <., .>_w, and H = V^T W A V.
class Krylov {
public:
    explicit Krylov(const Plan& plan) : plan_(plan), steps_(steps_for(plan)), weights_(plan.has_scaling ? plan.scaling : Vector(plan.row_count, 1.0)) {
        std::fill_n(weights_.begin(), plan.fixed.end_row(), 0.0);
        hessenberg_ = Eigen::MatrixXd::Zero(steps_ + 1, steps_);
        Vector start = rough_vector(plan.vertex_count);
        std::fill_n(start.begin(), plan.fixed.end_row(), 0.0);  // and so are all that follow
        scale(start, 1 / std::sqrt(dots({&start}, start)[0]));
        basis_.push_back(std::move(start));
        while (size_ < steps_ && step()) {
        }
    }

    /// k x k, and |h_(k + 1, k)|.
    Eigen::MatrixXd hessenberg() const { return hessenberg_.topLeftCorner(size_, size_); }
    double remainder() const { return size_ == 0 ? 0 : hessenberg_(size_, size_ - 1); }

private:
    static int steps_for(const Plan& plan) {
        const std::size_t rows = plan.row_count - plan.fixed.row_count, fit = most_bytes / (sizeof(double) * std::max<std::size_t>(1, plan.vertex_count));
        const std::size_t most = plan.has_scaling ? most_steps : std::clamp<std::size_t>(fit, least_steps, most_steps);
        return static_cast<int>(std::min(rows, most));
    }

    /// False where the space is exhausted.
    bool step() {
        Vector next = host_apply(plan_, basis_[size_], 1);
        const double before = std::sqrt(dots({&next}, next)[0]);
        const std::size_t first = plan_.has_scaling && size_ > 0 ? size_ - 1 : 0;  // A is self-adjoint: it is orthogonal to all but the last two
        std::vector<const Vector*> others;
        for (std::size_t i = first; i < basis_.size(); ++i) others.push_back(&basis_[i]);
        double left = before, size;
        do {  // once more where much has gone, which leaves rounding behind (Daniel et al. 1976)
            const Vector parts = dots(others, next);
            for (std::size_t i = 0; i < parts.size(); ++i) hessenberg_(first + i, size_) += parts[i];
            subtract(others, parts, next);
            size = std::exchange(left, std::sqrt(dots({&next}, next)[0]));
        } while (left < 0.5 * size && left > exhausted * before);
        const bool goes_on = left > exhausted * before;
        if (goes_on) {
            hessenberg_(size_ + 1, size_) = left;
            scale(next, 1 / left);
            if (plan_.has_scaling && size_ > 0) Vector().swap(basis_[size_ - 1]);  // no longer needed
            basis_.push_back(std::move(next));
        }
        ++size_;
        return goes_on;
    }

    using Segment = Eigen::Map<const Eigen::ArrayXd>;
    static Segment segment(const Vector& a, std::size_t begin, std::size_t end) { return {a.data() + begin, static_cast<Eigen::Index>(end - begin)}; }

    template <class Body>
    void for_each_chunk(const Body& body) const {
        const std::size_t rows = plan_.row_count;
        parallel_for((rows + chunk - 1) / chunk,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t k = begin; k < end; ++k) body(k, k * chunk, std::min(rows, (k + 1) * chunk));
                     },
                     1);
    }

    /// <a_i, b>_w.
    Vector dots(const std::vector<const Vector*>& a, const Vector& b) const {
        const std::size_t chunks = (static_cast<std::size_t>(plan_.row_count) + chunk - 1) / chunk;
        Vector parts(chunks * a.size()), sums(a.size(), 0.0);
        for_each_chunk([&](std::size_t k, std::size_t begin, std::size_t end) {
            const Eigen::ArrayXd weighted = segment(weights_, begin, end) * segment(b, begin, end);
            for (std::size_t i = 0; i < a.size(); ++i) parts[k * a.size() + i] = (segment(*a[i], begin, end) * weighted).sum();
        });
        for (std::size_t k = 0; k < chunks; ++k)
            for (std::size_t i = 0; i < a.size(); ++i) sums[i] += parts[k * a.size() + i];
        return sums;
    }

    void subtract(const std::vector<const Vector*>& a, const Vector& factors, Vector& b) const {
        for_each_chunk([&](std::size_t, std::size_t begin, std::size_t end) {
            Eigen::Map<Eigen::ArrayXd> out(b.data() + begin, static_cast<Eigen::Index>(end - begin));
            for (std::size_t i = 0; i < a.size(); ++i) out -= factors[i] * segment(*a[i], begin, end);
        });
    }

    void scale(Vector& a, double factor) const {
        for_each_chunk([&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) a[row] *= factor;
        });
    }

    const Plan& plan_;
    const int steps_;
    Vector weights_;
    int size_ = 0;
    std::vector<Vector> basis_;
    Eigen::MatrixXd hessenberg_;
};

std::vector<RitzValue> symmetric_values(const Eigen::MatrixXd& h) {
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>((h + h.transpose()) / 2, Eigen::EigenvaluesOnly).eigenvalues();
    std::vector<RitzValue> out;
    for (const double value : values) out.push_back({value, rounding});
    return out;
}

std::vector<RitzValue> general_values(const Eigen::MatrixXd& h, double remainder) {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(h);
    const Eigen::MatrixXcd right = solver.eigenvectors(), left = right.partialPivLu().inverse();  // rows of `left` times columns of `right` are 1
    const double size = std::max(1.0, h.cwiseAbs().maxCoeff());
    std::vector<RitzValue> out;
    for (Eigen::Index i = 0; i < h.rows(); ++i) {
        const double length = right.col(i).norm(), kappa = left.row(i).norm() * length, residual = remainder * std::abs(right(h.rows() - 1, i)) / length;
        out.push_back({solver.eigenvalues()(i), kappa * (10 * residual + rounding * size)});
    }
    return out;
}

}  // namespace

std::vector<RitzValue> ritz_values(const Plan& plan) {
    if (plan.fixed.row_count == plan.row_count) return {};
    const Krylov krylov(plan);
    return plan.has_scaling ? symmetric_values(krylov.hessenberg()) : general_values(krylov.hessenberg(), krylov.remainder());
}

}  // namespace lcl
