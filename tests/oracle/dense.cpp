// SPDX-License-Identifier: BSD-3-Clause
#include "tests/oracle/dense.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>

namespace oracle {

namespace {

History start_history(const SparseMatrix& a, const Eigen::MatrixXd& m) { return {m, {largest_row(m - a * m)}}; }

void record(const SparseMatrix& a, const Eigen::MatrixXd& m, History& history) { history.residuals.push_back(largest_row(m - a * history.points)); }

}  // namespace

Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& m) {
    if (a.rows() > 400) return a.partialPivLu().solve(m);
    Eigen::FullPivLU<Eigen::MatrixXd> lu(a);
    lu.setThreshold(1e-12);
    if (!lu.isInvertible()) throw std::runtime_error("the matrix is singular");
    return lu.solve(m);
}

std::vector<std::complex<double>> spectrum(const Eigen::MatrixXd& a) {
    const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(a, false).eigenvalues();
    std::vector<std::complex<double>> result(values.data(), values.data() + values.size());
    std::sort(result.begin(), result.end(), [](auto x, auto y) { return x.real() < y.real(); });
    return result;
}

double lowest_eigenvalue(const Eigen::MatrixXd& a) { return spectrum(a).front().real(); }

double spectral_radius(const Eigen::MatrixXd& a) {
    double radius = 0;
    for (const auto& value : spectrum(a)) radius = std::max(radius, std::abs(value));
    return radius;
}

Eigen::VectorXd scaled_spectrum(const Eigen::MatrixXd& a, const Eigen::VectorXd& d) {
    const Eigen::MatrixXd s = d.asDiagonal() * a;
    if ((s - s.transpose()).cwiseAbs().maxCoeff() > 1e-12 * s.cwiseAbs().maxCoeff()) throw std::invalid_argument("the scaled matrix is not symmetric");
    const Eigen::VectorXd root = d.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd similar = root.asDiagonal() * s * root.asDiagonal();
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(similar, Eigen::EigenvaluesOnly).eigenvalues();
}

double infinity_norm(const Eigen::MatrixXd& a) { return a.cwiseAbs().rowwise().sum().maxCoeff(); }

Eigen::MatrixXd with_identity_rows(const Eigen::MatrixXd& a, const std::vector<int>& subset) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Identity(a.rows(), a.cols());
    for (const int v : subset) result.row(v) = a.row(v);
    return result;
}

Eigen::MatrixXd pia_iteration(const Eigen::MatrixXd& a, double weight) { return Eigen::MatrixXd::Identity(a.rows(), a.cols()) - weight * a; }

Eigen::MatrixXd gauss_seidel_iteration(const Eigen::MatrixXd& a) {
    const Eigen::MatrixXd upper = a.triangularView<Eigen::StrictlyUpper>();
    return -a.triangularView<Eigen::Lower>().solve(upper);
}

SparseMatrix to_sparse(const Eigen::MatrixXd& a) { return a.sparseView(); }

double largest_row(const Eigen::MatrixXd& residual) { return residual.rows() == 0 ? 0 : residual.rowwise().norm().maxCoeff(); }

History pia(const SparseMatrix& a, const Eigen::MatrixXd& m, int sweeps, double weight) {
    History history = start_history(a, m);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const Eigen::MatrixXd residual = m - a * history.points;
        history.points += weight * residual;
        record(a, m, history);
    }
    return history;
}

History jacobi(const SparseMatrix& a, const Eigen::MatrixXd& m, int sweeps) {
    History history = start_history(a, m);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const Eigen::MatrixXd residual = m - a * history.points;
        for (Eigen::Index i = 0; i < m.rows(); ++i) history.points.row(i) += residual.row(i) / a.coeff(i, i);
        record(a, m, history);
    }
    return history;
}

History gauss_seidel(const SparseMatrix& a, const Eigen::MatrixXd& m, int sweeps) {
    History history = start_history(a, m);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (Eigen::Index i = 0; i < m.rows(); ++i) {
            Eigen::RowVectorXd residual = m.row(i);
            for (SparseMatrix::InnerIterator entry(a, i); entry; ++entry) residual -= entry.value() * history.points.row(entry.col());
            history.points.row(i) += residual / a.coeff(i, i);
        }
        record(a, m, history);
    }
    return history;
}

History chebyshev(const SparseMatrix& a, const Eigen::MatrixXd& m, int sweeps, double lowest, double highest) {
    History history = start_history(a, m);
    const double centre = (highest + lowest) / 2, radius = (highest - lowest) / 2;
    Eigen::MatrixXd step = Eigen::MatrixXd::Zero(m.rows(), m.cols());
    double ratio = 0;  // T_k(x) / T_{k+1}(x) at x = centre / radius
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const double next_ratio = sweep == 0 ? radius / centre : 1 / (2 * centre / radius - ratio);
        const Eigen::MatrixXd residual = m - a * history.points;
        if (sweep == 0 || radius == 0) step = residual / centre;
        else step = next_ratio * ratio * step + 2 * next_ratio / radius * residual;
        history.points += step;
        ratio = next_ratio;
        record(a, m, history);
    }
    return history;
}

History conjugate_gradients(const SparseMatrix& a, const Eigen::VectorXd& d, const Eigen::MatrixXd& m, int sweeps) {
    History history = start_history(a, m);
    const auto dots = [&](const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) { return Eigen::ArrayXd((x.array() * y.array()).matrix().transpose() * d); };
    Eigen::MatrixXd residual = m - a * history.points, direction = residual;
    Eigen::ArrayXd square = dots(residual, residual);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const Eigen::MatrixXd image = a * direction;
        const Eigen::ArrayXd curvature = dots(direction, image);
        const Eigen::ArrayXd length = (square > 0 && curvature != 0).select(square / curvature, 0);
        history.points += direction * length.matrix().asDiagonal();
        residual -= image * length.matrix().asDiagonal();
        const Eigen::ArrayXd next_square = dots(residual, residual);
        const Eigen::ArrayXd keep = (square > 0).select(next_square / square, 0);
        direction = residual + direction * keep.matrix().asDiagonal();
        square = next_square;
        record(a, m, history);
    }
    return history;
}

}  // namespace oracle
