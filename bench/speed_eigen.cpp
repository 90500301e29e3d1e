// SPDX-License-Identifier: BSD-3-Clause
// speed_eigen: conjugate gradients by Eigen with OpenMP, in double, on S P = D M, preconditioned by the diagonal and started from M, beside limitcl's solve.
#include <Eigen/IterativeLinearSolvers>
#include <thread>

#include "interpolation.h"
#include "measure.h"

namespace bench {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr int iteration_limit = 200;

/// One column after the other (the same recurrence on all three at once, by Eigen's product with a dense matrix, took 1.2 times as long). Both triangles: only
/// then are products taken on all cores.
struct Peer {
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver;
    const Columns start, right;
    Columns P;
    int iterations = 0;

    Peer(const Matrix& S, const Rows& start_, const Rows& right_) : start(start_), right(right_), P(start_.rows(), 3) {
        solver.compute(S);
        solver.setMaxIterations(iteration_limit);
    }
    void solve(double tolerance) {
        solver.setTolerance(tolerance);
        iterations = 0;
        for (int c = 0; c < 3; ++c) {
            P.col(c) = solver.solveWithGuess(right.col(c), start.col(c));
            iterations += static_cast<int>(solver.iterations());
        }
    }
};

void race(const Arguments& arguments) {
    Eigen::setNbThreads(static_cast<int>(std::thread::hardware_concurrency()));
    const Shape shape = quad_sphere(arguments.level);
    const LimitMatrix matrix = limit_matrix(shape, Scheme::catmull_clark);
    const int n = matrix.size();
    const Matrix S = Eigen::Map<const Matrix>(n, n, matrix.offsets[n], matrix.offsets.data(), matrix.columns.data(), matrix.weights.data());
    const Rows M = Eigen::Map<const Rows>(shape.points.data(), n, 3), right = Eigen::Map<const Eigen::VectorXd>(matrix.scale.data(), n).asDiagonal() * M;
    Peer peer(S, M, right);
    const auto error_at = [&](double tolerance) {
        peer.solve(tolerance);
        const Rows P = peer.P;
        return relative_error(matrix, shape, {P.data(), P.data() + P.size()});
    };
    const double tolerance = loosest_tolerance(error_at);
    print_value("eigen.error", error_at(tolerance));
    print_value("eigen.tolerance", tolerance);
    print_value("eigen.iterations", peer.iterations);

    Interpolation problem(open_device(arguments.device), shape, Scheme::catmull_clark);
    run_rounds(arguments.runs, [&](Laps& laps) {
        rest();
        laps.time_warm("eigen.limitcl.single", [&] { problem.solve(LCL_PRECISION_SINGLE); });
        laps.time_warm("eigen.limitcl.mixed", [&] { problem.solve(LCL_PRECISION_MIXED); });
        laps.time_warm("eigen.peer", [&] { peer.solve(tolerance); });
    });
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::race); }
