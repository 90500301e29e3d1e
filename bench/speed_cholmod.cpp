// SPDX-License-Identifier: BSD-3-Clause
// speed_cholmod: CHOLMOD's supernodal factorisation of S and the solve for three columns, in double, once, beside limitcl's solve.
#include <cholmod.h>

#include <stdexcept>

#include "interpolation.h"
#include "measure.h"

namespace bench {
namespace {

/// The lower triangle of S by columns: its upper triangle by rows.
cholmod_sparse* lower_triangle(const LimitMatrix& matrix, cholmod_common* common) {
    const std::size_t n = matrix.size();
    cholmod_sparse* S = cholmod_allocate_sparse(n, n, (matrix.columns.size() + n) / 2, 1, 1, -1, CHOLMOD_REAL, common);
    if (S == nullptr) throw std::runtime_error("CHOLMOD has no memory for the matrix");
    int *offsets = static_cast<int*>(S->p), *rows = static_cast<int*>(S->i), count = 0;
    double* weights = static_cast<double*>(S->x);
    for (std::size_t v = 0; v < n; ++v) {
        offsets[v] = count;
        for (std::int32_t i = matrix.offsets[v]; i < matrix.offsets[v + 1]; ++i)
            if (matrix.columns[i] >= static_cast<std::int32_t>(v)) {
                rows[count] = matrix.columns[i];
                weights[count++] = matrix.weights[i];
            }
    }
    offsets[n] = count;
    return S;
}

cholmod_dense* scaled_points(const LimitMatrix& matrix, const Shape& shape, cholmod_common* common) {
    const std::size_t n = matrix.size();
    cholmod_dense* right = cholmod_allocate_dense(n, 3, n, CHOLMOD_REAL, common);
    if (right == nullptr) throw std::runtime_error("CHOLMOD has no memory for the points");
    for (std::size_t i = 0; i < 3 * n; ++i) static_cast<double*>(right->x)[i % 3 * n + i / 3] = matrix.scale[i / 3] * shape.points[i];
    return right;
}

std::vector<double> points_of(const cholmod_dense* solution) {
    std::vector<double> points(3 * solution->nrow);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<const double*>(solution->x)[i % 3 * solution->nrow + i / 3];
    return points;
}

/// Once. Analysis (ordering, symbolic factorisation) is timed by itself: it belongs to the set-up, as limitcl's ordering does.
void time_cholmod(const LimitMatrix& matrix, const Shape& shape) {
    cholmod_common common;
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    cholmod_sparse* S = lower_triangle(matrix, &common);
    cholmod_dense* right = scaled_points(matrix, shape, &common);
    cholmod_factor* factor = nullptr;
    cholmod_dense* solution = nullptr;
    Laps laps;
    laps.time("cholmod.analysis", [&] { factor = cholmod_analyze(S, &common); });
    laps.time("cholmod.factor", [&] { cholmod_factorize(S, factor, &common); });
    laps.time("cholmod.solve", [&] { solution = cholmod_solve(CHOLMOD_A, factor, right, &common); });
    if (common.status != CHOLMOD_OK || solution == nullptr) throw std::runtime_error("CHOLMOD failed with status " + std::to_string(common.status));
    laps.print();
    print_value("cholmod.error", relative_error(matrix, shape, points_of(solution)));
    print_value("cholmod.bytes", static_cast<double>(common.memory_usage));
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&right, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_free_sparse(&S, &common);
    cholmod_finish(&common);
}

void race(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    time_cholmod(limit_matrix(shape, Scheme::catmull_clark), shape);
    Interpolation problem(open_device(arguments.device), shape, Scheme::catmull_clark);
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.time_warm("cholmod.limitcl.single", [&] { problem.solve(LCL_PRECISION_SINGLE); });
        laps.time_warm("cholmod.limitcl.mixed", [&] { problem.solve(LCL_PRECISION_MIXED); });
    });
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::race); }
