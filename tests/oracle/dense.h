// SPDX-License-Identifier: BSD-3-Clause
// Dense algebra and plain iterations to compare operators and solvers with: everything in double, in the caller's vertex order, no cleverness.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

namespace oracle {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// X of A X = M by LU with full pivoting (A up to a few hundred rows) or partial pivoting (larger). std::runtime_error if A is singular to 1e-12.
Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& m);

/// All eigenvalues by rising real part.
std::vector<std::complex<double>> spectrum(const Eigen::MatrixXd& a);

/// Real part of the first of `spectrum`; the largest absolute value in it.
double lowest_eigenvalue(const Eigen::MatrixXd& a);
double spectral_radius(const Eigen::MatrixXd& a);

/// The eigenvalues of A by rising size where diag(d) A is symmetric. std::invalid_argument if it is not, to 1e-12 of its largest entry.
Eigen::VectorXd scaled_spectrum(const Eigen::MatrixXd& a, const Eigen::VectorXd& d);

/// Largest row sum of absolute values.
double infinity_norm(const Eigen::MatrixXd& a);

/// The matrix with the rows of the vertices that are not in `subset` made identity rows.
Eigen::MatrixXd with_identity_rows(const Eigen::MatrixXd& a, const std::vector<int>& subset);

/// Matrices that the iterations P <- G P + const apply to the error.
Eigen::MatrixXd pia_iteration(const Eigen::MatrixXd& a, double weight = 1);
Eigen::MatrixXd gauss_seidel_iteration(const Eigen::MatrixXd& a);

SparseMatrix to_sparse(const Eigen::MatrixXd& a);

/// Largest Euclidean norm of a row: E_k of a residual.
double largest_row(const Eigen::MatrixXd& residual);

/// What a plain loop of `sweeps` sweeps from P_0 = M gives.
struct History {
    Eigen::MatrixXd points;         ///< after the last sweep
    std::vector<double> residuals;  ///< E_0 .. E_sweeps, each the largest row of M - A P_k
};

/// P += w (M - A P); w = 1 is PIA.
History pia(const SparseMatrix& a, const Eigen::MatrixXd& m, int sweeps, double weight = 1);

/// P_i += (M - A P)_i / A_ii with the old neighbours.
History jacobi(const SparseMatrix& a, const Eigen::MatrixXd& m, int sweeps);

/// GS-PIA in natural order: P_i += (M - A P)_i / A_ii, vertex after vertex, with the newest neighbours (Loop PIA paper).
History gauss_seidel(const SparseMatrix& a, const Eigen::MatrixXd& m, int sweeps);

/// Chebyshev semi-iteration for a spectrum in [lowest, highest].
History chebyshev(const SparseMatrix& a, const Eigen::MatrixXd& m, int sweeps, double lowest, double highest = 1);

/// Conjugate gradients for diag(d) A symmetric positive definite, in the inner product of d, without preconditioner; every column on its own.
History conjugate_gradients(const SparseMatrix& a, const Eigen::VectorXd& d, const Eigen::MatrixXd& m, int sweeps);

}  // namespace oracle
