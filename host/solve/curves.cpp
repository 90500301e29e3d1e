// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/curves.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <stdexcept>

namespace lcl {

void solve_curves(const Plan& plan, const std::vector<double>& m, std::vector<double>& p, int channels) {
    const Part& part = plan.curves;
    if (part.row_count == 0) return;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right(part.row_count, channels);
    for (Index row = part.first_row; row < part.end_row(); ++row) {
        const Index i = row - part.first_row;
        for (int c = 0; c < channels; ++c) right(i, c) = m[static_cast<std::size_t>(row) * channels + c];
        const LimitRow entry = plan_row(plan, run_of_row(plan, row), row);
        for (std::size_t k = 0; k < entry.columns.size(); ++k) {
            const Index column = entry.columns[k];
            if (column >= part.end_row())
                throw std::logic_error("a curve depends on a vertex that is not solved for before it");  // darts: callers iterate on the whole then
            if (column >= part.first_row) entries.emplace_back(i, column - part.first_row, entry.weights[k]);
            else
                for (int c = 0; c < channels; ++c) right(i, c) -= entry.weights[k] * p[static_cast<std::size_t>(column) * channels + c];
        }
    }
    Eigen::SparseMatrix<double> system(part.row_count, part.row_count);
    system.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(system);
    const Eigen::MatrixXd solution = factor.solve(right);  // diagonally dominant: never singular
    for (Index i = 0; i < part.row_count; ++i)
        for (int c = 0; c < channels; ++c) p[static_cast<std::size_t>(part.first_row + i) * channels + c] = solution(i, c);
}

}  // namespace lcl
