// SPDX-License-Identifier: BSD-3-Clause
// What the tests of operators of a caller's own share: rows from matrices and from operators, and operators of them.
#pragma once

#include <Eigen/Dense>

#include "tests/capi_support.h"

namespace rows_test {

/// Arrays of lcl_rows.
struct Rows {
    std::vector<int64_t> offsets{0};
    std::vector<int32_t> columns;
    std::vector<double> weights, scaling;

    int32_t count() const { return static_cast<int32_t>(offsets.size()) - 1; }
    void add(int32_t column, double weight) { columns.push_back(column), weights.push_back(weight); }
    void end_row() { offsets.push_back(static_cast<int64_t>(columns.size())); }
    lcl_rows data() const {
        lcl_rows rows = LCL_ROWS_INIT;
        rows.row_count = count();
        rows.offsets = offsets.data();
        rows.columns = columns.data();
        rows.weights = weights.data();
        rows.scaling = scaling.empty() ? nullptr : scaling.data();
        return rows;
    }
};

/// Everything that is not 0, and the diagonal. d: empty, or D.
inline Rows rows_of(const Eigen::MatrixXd& a, const Eigen::VectorXd& d = {}) {
    Rows rows;
    for (Eigen::Index i = 0; i < a.rows(); ++i, rows.end_row())
        for (Eigen::Index j = 0; j < a.cols(); ++j)
            if (a(i, j) != 0 || i == j) rows.add(static_cast<int32_t>(j), a(i, j));
    rows.scaling.assign(d.data(), d.data() + d.size());
    return rows;
}

/// The rows that an operator gives back.
inline Rows rows_of(lcl_operator A) {
    Rows rows;
    for (int32_t v = 0; v < lcl_operator_vertex_count(A); ++v, rows.end_row()) {
        size_t size = 0;
        capi_test::succeed(lcl_operator_get_row(A, v, nullptr, nullptr, 0, &size));
        rows.columns.resize(rows.columns.size() + size);
        rows.weights.resize(rows.columns.size());
        capi_test::succeed(lcl_operator_get_row(A, v, &rows.columns[rows.columns.size() - size], &rows.weights[rows.columns.size() - size], size, &size));
    }
    return rows;
}

inline Eigen::MatrixXd matrix_of(const Rows& rows) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows.count(), rows.count());
    for (int32_t i = 0; i < rows.count(); ++i)
        for (int64_t e = rows.offsets[i]; e < rows.offsets[i + 1]; ++e) a(i, rows.columns[e]) += rows.weights[e];
    return a;
}

inline lcl_status create(const Rows& rows, capi_test::Operator& A) {
    const lcl_rows data = rows.data();
    lcl_operator made = nullptr;
    const lcl_status status = lcl_operator_create_rows(capi_test::default_context(), &data, &made);
    A.reset(made);
    return status;
}

inline capi_test::Operator make_rows_operator(const Rows& rows) {
    capi_test::Operator A;
    capi_test::succeed(create(rows, A));
    return A;
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline Eigen::MatrixXd matrix_of(const std::vector<double>& values, int channels) {
    return Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(values.size()) / channels, channels);
}

inline std::vector<double> values_of(const Eigen::MatrixXd& matrix) {
    const RowMajor rows = matrix;
    return {rows.data(), rows.data() + rows.size()};
}

/// Numbers in [-1, 1).
inline Eigen::MatrixXd rough_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
    shapes::Random random(seed);
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.symmetric(); });
}

/// Diagonal of the box of the rows of m.
inline double box_diagonal(const Eigen::MatrixXd& m) { return (m.colwise().maxCoeff() - m.colwise().minCoeff()).norm(); }

inline lcl_solve_options solve_options(lcl_solver solver, double tolerance = 1e-6, lcl_precision precision = LCL_PRECISION_MIXED,
                                       int32_t max_iterations = 1000) {
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.solver = solver;
    options.tolerance = tolerance;
    options.precision = precision;
    options.max_iterations = max_iterations;
    return options;
}

/// lcl_interpolate with what it gives.
struct Solved {
    lcl_status status;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    Eigen::MatrixXd P;

    Solved(lcl_operator A, const Eigen::MatrixXd& m, const lcl_solve_options& options = LCL_SOLVE_OPTIONS_INIT) {
        const std::vector<double> values = values_of(m);
        std::vector<double> out(values.size());
        status = lcl_interpolate(A, values.data(), 0, static_cast<int32_t>(m.cols()), &options, out.data(), 0, &report);
        P = matrix_of(out, static_cast<int>(m.cols()));
    }
};

inline Eigen::MatrixXd limit_points(lcl_operator A, const Eigen::MatrixXd& x, lcl_precision precision = LCL_PRECISION_DOUBLE) {
    std::vector<double> values = values_of(x);
    capi_test::succeed(lcl_limit_points(A, values.data(), 0, static_cast<int32_t>(x.cols()), precision, values.data(), 0));
    return matrix_of(values, static_cast<int>(x.cols()));
}

}  // namespace rows_test
