// SPDX-License-Identifier: BSD-3-Clause
// Operators from a caller's rows: against dense solutions and spectra, against the limit operators that the rows were read from, and everything that is
// refused.
#include <cmath>
#include <limits>

#include "host/apply/host_operator.h"
#include "host/operator/user_rows.h"
#include "host/solve/ritz.h"
#include "tests/oracle/dense.h"
#include "tests/rows_support.h"
#include "tests/solver_support.h"

using namespace capi_test;
using namespace rows_test;
using solver_test::largest;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

const std::vector<lcl_solver> all_solvers{LCL_SOLVER_AUTO, LCL_SOLVER_PIA,         LCL_SOLVER_WPIA,      LCL_SOLVER_JACOBI,
                                          LCL_SOLVER_GS,   LCL_SOLVER_GS_COLOURED, LCL_SOLVER_CHEBYSHEV, LCL_SOLVER_CG};
const std::vector<lcl_solver> solvers_without_scaling{LCL_SOLVER_AUTO, LCL_SOLVER_PIA, LCL_SOLVER_WPIA, LCL_SOLVER_CHEBYSHEV};

/// (1 - 2 w) x_i + w (x_(i - 1) + x_(i + 1)) round a ring: eigenvalues 1 - 2 w (1 - cos t), t = 2 pi k/n.
Eigen::MatrixXd ring(int n, double w) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) a(i, i) += 1 - 2 * w, a(i, (i + 1) % n) += w, a(i, (i + n - 1) % n) += w;
    return a;
}

/// Five-point smoothing of an m x n grid, the mean of a point and of its mean neighbour: D counts neighbours; symmetric under it.
Eigen::MatrixXd grid(int m, int n, Eigen::VectorXd* d = nullptr) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(m * n, m * n);
    const auto link = [&](int i, int j) { a(i, j) = a(j, i) = 1; };
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < n; ++j) {
            if (i + 1 < m) link(i * n + j, (i + 1) * n + j);
            if (j + 1 < n) link(i * n + j, i * n + j + 1);
        }
    const Eigen::VectorXd degree = a.rowwise().sum();
    if (d != nullptr) *d = degree;
    return 0.6 * Eigen::MatrixXd::Identity(m * n, m * n) + 0.4 * degree.cwiseInverse().asDiagonal() * a;
}

/// D^-1 S with S symmetric positive definite, D between 1 and 3, and eigenvalues from `low` to 1.
Eigen::MatrixXd self_adjoint(int n, double low, std::uint64_t seed, Eigen::VectorXd& d) {
    d = rough_matrix(n, 1, seed) + Eigen::VectorXd::Constant(n, 2);
    const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(rough_matrix(n, n, seed + 1)).householderQ();
    const Eigen::MatrixXd c = q * Eigen::VectorXd::LinSpaced(n, low, 1).asDiagonal() * q.transpose();
    const Eigen::VectorXd root = d.cwiseSqrt();
    return root.cwiseInverse().asDiagonal() * c * root.asDiagonal();
}

/// X diag(values) X^-1, X not far from the identity: not symmetric under any diagonal scaling.
Eigen::MatrixXd with_spectrum(const Eigen::VectorXd& values, std::uint64_t seed) {
    const Eigen::Index n = values.size();
    const Eigen::MatrixXd x = Eigen::MatrixXd::Identity(n, n) + 0.5 / std::sqrt(n) * rough_matrix(n, n, seed);
    return x * values.asDiagonal() * x.inverse();
}

void check_solution(const Eigen::MatrixXd& a, const Eigen::MatrixXd& m, const Solved& solved, double tolerance) {
    const double size = box_diagonal(m), inverse = oracle::infinity_norm(oracle::solve(a, Eigen::MatrixXd::Identity(a.rows(), a.cols())));
    INFO(lcl_status_string(solved.status) << ": " << solved.report.message);
    CHECK(solved.status == LCL_OK);
    CHECK(solved.report.converged == 1);
    CHECK(solved.report.max_error <= tolerance * size);
    CHECK(oracle::largest_row(m - a * solved.P) == Approx(solved.report.max_error).margin(1e-13 * (size + largest(m))));
    CHECK(oracle::largest_row(solved.P - oracle::solve(a, m)) <= inverse * std::sqrt(3) * (solved.report.max_error + 1e-13 * (size + largest(m))));
}

/// Plain arrays as the host library takes them.
lcl::RowMatrix view(const Rows& rows) {
    return {rows.count(), rows.offsets.data(), rows.columns.data(), rows.weights.data(), rows.scaling.empty() ? nullptr : rows.scaling.data()};
}

lcl::Plan plan_of(const Rows& rows, lcl::Index block_rows = 4096) { return lcl::build_user_plan(view(rows), block_rows); }

Rows five_rows() { return rows_of(ring(5, 0.2), Eigen::VectorXd::Ones(5)); }

}  // namespace

TEST_CASE("every solver reaches the dense solution of rows with a scaling", "[rows]") {
    Eigen::VectorXd d, grid_d;
    const Eigen::MatrixXd dense = self_adjoint(60, 0.2, 1, d), smoothing = grid(9, 7, &grid_d);
    for (const auto& [a, scaling] :
         {std::pair(dense, d), std::pair(smoothing, Eigen::VectorXd(1e200 * grid_d)), std::pair(ring(40, 0.2), Eigen::VectorXd(Eigen::VectorXd::Ones(40)))}) {
        const Operator A = make_rows_operator(rows_of(a, scaling));
        const Eigen::MatrixXd m = rough_matrix(a.rows(), 3, 7);
        for (const lcl_solver solver : all_solvers)
            for (const lcl_precision precision : {LCL_PRECISION_MIXED, LCL_PRECISION_DOUBLE}) {
                INFO(a.rows() << " rows, solver " << solver << ", precision " << precision);
                const double dominance = (2 * a.diagonal() - a.cwiseAbs().rowwise().sum()).minCoeff();
                if (solver == LCL_SOLVER_JACOBI && dominance <= 0) continue;  // sure to converge under dominance alone
                const Solved solved(A.get(), m, solve_options(solver, 1e-9, precision));
                if (solver != LCL_SOLVER_AUTO) CHECK(solved.report.solver == solver);
                check_solution(a, m, solved, 1e-9);
            }
    }
}

TEST_CASE("rows without a scaling that have a real spectrum are solved by PIA, W-PIA, Chebyshev and auto", "[rows]") {
    const Eigen::MatrixXd a = with_spectrum(Eigen::VectorXd::LinSpaced(50, 0.1, 1), 3);
    REQUIRE(largest(a - a.transpose()) > 0.05);
    Eigen::MatrixXd triangular = 0.3 * rough_matrix(50, 50, 5).triangularView<Eigen::StrictlyLower>().toDenseMatrix() / 7;
    triangular.diagonal().setLinSpaced(0.3, 1);
    for (const Eigen::MatrixXd& rows : {a, triangular}) {
        const Operator A = make_rows_operator(rows_of(rows));
        const Eigen::MatrixXd m = rough_matrix(50, 5, 4);
        for (const lcl_solver solver : solvers_without_scaling)
            for (const lcl_precision precision : {LCL_PRECISION_MIXED, LCL_PRECISION_DOUBLE}) {
                INFO("solver " << solver << ", precision " << precision);
                const Solved solved(A.get(), m.leftCols(3), solve_options(solver, 1e-9, precision));
                check_solution(rows, m.leftCols(3), solved, 1e-9);
                CHECK(std::isnan(solved.report.lambda_min));
            }
        const Solved five(A.get(), m, solve_options(LCL_SOLVER_AUTO, 1e-9));  // further channels are solved to their own ranges
        CHECK(five.status == LCL_OK);
        CHECK(largest((m - rows * five.P).rightCols(2)) <= 1e-9 * 2 + 1e-13);
    }
}

TEST_CASE("solvers that need a symmetric form are refused on rows without a scaling", "[rows]") {
    const Operator A = make_rows_operator(rows_of(ring(6, 0.2)));
    const std::vector<double> m = values_of(rough_matrix(6, 3, 1));
    std::vector<double> P(18);
    const auto interpolate = [&](lcl_solver solver) {
        const lcl_solve_options options = solve_options(solver);
        return lcl_interpolate(A.get(), m.data(), 0, 3, &options, P.data(), 0, nullptr);
    };
    refuse(
        interpolate(LCL_SOLVER_CG), LCL_ERROR_INVALID_ARGUMENT,
        "conjugate gradients need a self-adjoint operator, and these rows came without a scaling D that makes D A symmetric: use auto, chebyshev, wpia or pia");
    for (const lcl_solver solver : {LCL_SOLVER_GS, LCL_SOLVER_GS_COLOURED})
        refuse(
            interpolate(solver), LCL_ERROR_INVALID_ARGUMENT,
            "Gauss-Seidel needs a self-adjoint operator, and these rows came without a scaling D that makes D A symmetric: use auto, chebyshev, wpia or pia");
}

TEST_CASE("the rows of a limit operator give its limit points and its solves", "[rows][oracle]") {
    struct Case {
        shapes::Shape shape;
        lcl_scheme_options scheme;
        bool is_symmetric;  // but for identity rows
    };
    const int32_t some[] = {0, 2, 3, 5, 8, 13, 21, 34, 40, 41, 42};
    lcl_scheme_options subset = scheme(LCL_SCHEME_CATMULL_CLARK, 0.5);
    subset.subset = some;
    subset.subset_count = std::size(some);
    for (const Case& c :
         {Case{shapes::polygons_mixed(70, 3), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5), true}, Case{shapes::polygons_mixed(70, 3), subset, true},
          Case{shapes::random_triangle_mesh(90, 2), scheme(LCL_SCHEME_LOOP), true}, Case{shapes::torus_quads(7, 5), scheme(LCL_SCHEME_DOO_SABIN), true},
          Case{shapes::grid_with_creases(), scheme(LCL_SCHEME_CATMULL_CLARK, 0.3), false},
          Case{shapes::grid_with_marked_corner(), scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.4), false}}) {
        INFO(c.shape.name);
        const Operator original = make_operator(c.shape, &c.scheme);
        Rows rows = rows_of(original.get());
        const Eigen::MatrixXd a = matrix_of(rows), m = matrix_of(with_channels(c.shape.mesh.positions, 4), 4);
        for (const bool with_scaling : {false, true}) {
            if (with_scaling && !c.is_symmetric) continue;
            const lcl::Topology topology = lcl::build_topology(c.shape.mesh);
            const auto own = static_cast<lcl::Scheme>(c.scheme.scheme - 1);
            for (lcl::Index v = 0; with_scaling && v < rows.count(); ++v)
                rows.scaling.push_back(lcl::symmetric_scaling(own, topology.vertex_face_count[v], c.scheme.lambda));
            const Operator A = make_rows_operator(rows);
            CHECK(rows_of(A.get()).columns == rows.columns);
            CHECK(rows_of(A.get()).weights == rows.weights);
            CHECK(largest(limit_points(A.get(), m) - limit_points(original.get(), m)) < 4e-14 * largest(m));
            lcl_solve_options options = solve_options(LCL_SOLVER_AUTO, 1e-10);
            options.diagonal = diagonal_of(c.shape);
            const Solved theirs(original.get(), m, options), ours(A.get(), m, options);
            CHECK(ours.status == LCL_OK);
            const double inverse = oracle::infinity_norm(oracle::solve(a, Eigen::MatrixXd::Identity(a.rows(), a.rows())));
            CHECK(largest((theirs.P - ours.P).leftCols(3)) <= 2 * inverse * 1.01e-10 * options.diagonal);
            CHECK(largest((theirs.P - ours.P).col(3)) <= 2 * inverse * 1.01e-10 * (m.col(3).maxCoeff() - m.col(3).minCoeff()));
            if (!with_scaling) continue;
            lcl_diagnosis first = LCL_DIAGNOSIS_INIT, second = LCL_DIAGNOSIS_INIT;
            succeed(lcl_operator_diagnose(original.get(), &first));
            succeed(lcl_operator_diagnose(A.get(), &second));
            CHECK(second.lambda_min_estimate == Approx(first.lambda_min_estimate).epsilon(0.05));  // a Lanczos run ends where it gains less
            CHECK(second.singular == 0);
            CHECK(std::string(second.reason) == "");
        }
    }
}

TEST_CASE("identity rows keep their points to the bit, and may break the symmetry", "[rows]") {
    Eigen::VectorXd d;
    Eigen::MatrixXd a = grid(6, 5, &d);
    for (const int fixed : {0, 7, 29}) a.row(fixed).setZero(), a(fixed, fixed) = 1;
    Rows rows;
    for (int i = 0; i < 30; ++i, rows.end_row())
        for (int j = 0; j < 30; ++j)
            if (a(i, j) != 0) rows.add(j, a(i, j));
    for (const bool with_scaling : {true, false}) {
        if (with_scaling) rows.scaling.assign(d.data(), d.data() + 30);
        else rows.scaling.clear();
        const Operator A = make_rows_operator(rows);
        const Eigen::MatrixXd m = rough_matrix(30, 3, 2);
        const Solved solved(A.get(), m, solve_options(with_scaling ? LCL_SOLVER_CG : LCL_SOLVER_CHEBYSHEV, 1e-9));
        check_solution(a, m, solved, 1e-9);
        for (const int fixed : {0, 7, 29}) CHECK(largest(solved.P.row(fixed) - m.row(fixed)) == 0);
    }
    const Operator identity = make_rows_operator(rows_of(Eigen::MatrixXd::Identity(4, 4)));
    const Eigen::MatrixXd m = rough_matrix(4, 3, 3);
    const Solved solved(identity.get(), m);
    CHECK(solved.status == LCL_OK);
    CHECK(largest(solved.P - m) == 0);
    CHECK(solved.report.lambda_min == 1);
}

TEST_CASE("rows that do not sum to 1 are solved and applied right far from the origin", "[rows][scale]") {
    Eigen::VectorXd d;
    const Eigen::MatrixXd smoothing = grid(8, 6, &d), a = 0.5 * smoothing + 0.25 * Eigen::MatrixXd::Identity(48, 48);
    REQUIRE(largest(a.rowwise().sum() - Eigen::VectorXd::Constant(48, 0.75)) < 1e-15);
    const Eigen::MatrixXd m = rough_matrix(48, 4, 5) + Eigen::MatrixXd::Constant(48, 4, 1e6);
    for (const bool with_scaling : {true, false}) {
        const Operator A = make_rows_operator(with_scaling ? rows_of(a, d) : rows_of(a));
        // Values of 1e6 in a box of size 1: double sums lose 1e6 eps a term, pairs of floats 2^-48.
        CHECK(largest(limit_points(A.get(), m) - a * m) < 1e6 * 1e-14);
        CHECK(largest(limit_points(A.get(), m, LCL_PRECISION_MIXED) - a * m) < 1e6 * 1e-13);
        for (const lcl_precision precision : {LCL_PRECISION_MIXED, LCL_PRECISION_DOUBLE}) {
            const Solved solved(A.get(), m, solve_options(LCL_SOLVER_AUTO, 1e-6, precision));
            INFO(with_scaling << ", precision " << precision << ": " << solved.report.message);
            CHECK(solved.status == LCL_OK);
            CHECK(largest(m - a * solved.P) < 1e-6 * box_diagonal(m) + 1e6 * 1e-14);
            CHECK(largest(solved.P - oracle::solve(a, m)) < 4 * (1e-6 * box_diagonal(m) + 1e6 * 1e-14));  // |A^-1| < 1/(0.25 + 0.5 * 0.2)
        }
        const Eigen::MatrixXd same = Eigen::MatrixXd::Constant(48, 3, -3e5);  // a box without a size: the tolerance refers to the values
        const Solved solved(A.get(), same, solve_options(LCL_SOLVER_AUTO, 1e-9));
        CHECK(solved.status == LCL_OK);
        CHECK(largest(solved.P - same / 0.75) < 4e-9 * 3e5 * 1.01);
    }
}

TEST_CASE("fields of rows that do not sum to 1 are kept round 0", "[rows][field]") {
    const Eigen::MatrixXd a = 0.8 * ring(12, 0.2), x = rough_matrix(12, 3, 5) + Eigen::MatrixXd::Constant(12, 3, 50);
    const Operator A = make_rows_operator(rows_of(a, Eigen::VectorXd::Ones(12))), other = make_rows_operator(rows_of(ring(12, 0.2)));
    const FieldHandle in = make_field(A.get(), values_of(x)), out = make_field(A.get()), elsewhere = make_field(other.get(), values_of(x));
    refuse(lcl_field_match(out.get(), elsewhere.get()), LCL_ERROR_INVALID_ARGUMENT, "do not sum to 1, and fields of it are kept round 0");
    succeed(lcl_operator_apply(A.get(), in.get(), out.get()));
    CHECK(largest(matrix_of(download(out.get(), 12), 3) - a * x) < 1e-13);
    const FieldHandle m = make_field(A.get()), y = make_field(A.get());
    succeed(lcl_field_match(m.get(), in.get()));
    const Eigen::MatrixXd right = rough_matrix(12, 3, 6);
    succeed(lcl_field_upload(m.get(), values_of(right).data(), LCL_TYPE_DOUBLE, 0));
    double residual = 0;
    succeed(lcl_operator_step(A.get(), 0.5, 1.5, 0.25, m.get(), in.get(), in.get(), y.get(), 0, -1, &residual));
    CHECK(largest(matrix_of(download(y.get(), 12), 3) - (0.75 * x + 1.5 * (right - a * x))) < 1e-12);
    CHECK(residual == Approx(oracle::largest_row(right - a * x)));
    const FieldHandle far = make_field(A.get());
    std::vector<double> values;
    for (int i = 0; i < 12; ++i) values.insert(values.end(), {1e30, 1e-10 * i, 0});
    refuse(lcl_field_upload(far.get(), values.data(), LCL_TYPE_DOUBLE, 0), LCL_ERROR_BAD_INPUT, "too far from 0 for rows that do not sum to 1");
}

TEST_CASE("solves of rows refer the tolerance to the box of M unless a size is given", "[rows]") {
    Eigen::VectorXd d;
    const Eigen::MatrixXd a = grid(8, 8, &d), m = 1000 * rough_matrix(64, 3, 8);
    const Operator A = make_rows_operator(rows_of(a, d));
    const Solved by_box(A.get(), m, solve_options(LCL_SOLVER_PIA, 1e-4));
    CHECK(by_box.report.residual_count >= 3);
    CHECK(by_box.report.max_error <= 1e-4 * box_diagonal(m));
    CHECK(by_box.report.max_error > 1e-6 * box_diagonal(m));
    lcl_solve_options options = solve_options(LCL_SOLVER_PIA, 1e-4);
    options.diagonal = 0.01 * box_diagonal(m);
    const Solved by_size(A.get(), m, options);
    CHECK(by_size.report.max_error <= 1e-6 * box_diagonal(m));
    CHECK(by_size.report.iterations > by_box.report.iterations);
    const FieldHandle M = make_field(A.get(), values_of(m)), P = make_field(A.get());
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    options = solve_options(LCL_SOLVER_PIA, 1e-4, LCL_PRECISION_DOUBLE);
    succeed(lcl_interpolate_field(A.get(), M.get(), &options, P.get(), &report));
    CHECK(report.max_error <= 1e-4 * box_diagonal(m));
    CHECK(report.max_error > 1e-6 * box_diagonal(m));
}

TEST_CASE("an eigenvalue of 0 is reported where one interpolates", "[rows][singular]") {
    for (const bool with_scaling : {true, false}) {
        const int n = 64;
        const Eigen::MatrixXd a = ring(n, 0.25);  // the eigenvalue of +1, -1, .. is 0
        const Operator A =
            make_rows_operator(with_scaling ? rows_of(a, Eigen::VectorXd::Ones(n)) : rows_of(with_spectrum(Eigen::VectorXd::LinSpaced(24, 0, 1), 9)));
        const Eigen::MatrixXd m = rough_matrix(lcl_operator_vertex_count(A.get()), 3, 2);
        const Solved solved(A.get(), m);
        CHECK(solved.status == LCL_ERROR_SINGULAR);
        CHECK_THAT(solved.report.message, Catch::Contains("the operator is singular to working precision") &&
                                              Catch::EndsWith("use t E + (1 - t) A for a t above 0, which has no eigenvalue below t"));
        CHECK(solved.report.iterations == 0);
        lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
        succeed(lcl_operator_diagnose(A.get(), &diagnosis));
        CHECK(diagnosis.singular == 1);
        CHECK(diagnosis.indefinite == 0);
        lcl_solve_options options = solve_options(LCL_SOLVER_PIA, 1e-6);
        options.keep_going = 1;
        const Eigen::MatrixXd in_range = limit_points(A.get(), m);
        const Solved anyway(A.get(), in_range, options);
        CHECK(anyway.status == LCL_ERROR_SINGULAR);
        CHECK(anyway.report.max_error < 1e-3 * box_diagonal(in_range));
    }
}

TEST_CASE("rows that are nearly singular are called so, and the estimate of the smallest eigenvalue is right", "[rows][spectrum]") {
    Eigen::VectorXd d;
    const Operator A = make_rows_operator(rows_of(self_adjoint(40, 0.02, 3, d), d));
    lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
    succeed(lcl_operator_diagnose(A.get(), &diagnosis));
    CHECK(diagnosis.lambda_min_estimate == Approx(0.02).epsilon(1e-2));
    CHECK(std::isnan(diagnosis.lambda_min_bound));
    CHECK_THAT(diagnosis.reason, Catch::StartsWith("the operator is nearly singular, its smallest eigenvalue is about 0.02"));
    const Operator proven = make_rows_operator(rows_of(grid(9, 9, &d), d));
    succeed(lcl_operator_diagnose(proven.get(), &diagnosis));
    CHECK(diagnosis.lambda_min_bound == Approx(0.2));  // 0.6 - 0.4
    CHECK(diagnosis.lambda_min_estimate >= diagnosis.lambda_min_bound);
    CHECK(diagnosis.lambda_min_estimate == Approx(oracle::scaled_spectrum(grid(9, 9), d)[0]).epsilon(0.02));
    const Operator without = make_rows_operator(rows_of(grid(9, 9)));
    succeed(lcl_operator_diagnose(without.get(), &diagnosis));
    CHECK(diagnosis.lambda_min_bound == Approx(0.2));
    CHECK(std::isnan(diagnosis.lambda_min_estimate));
    CHECK(std::string(diagnosis.reason) == "");
}

TEST_CASE("certified solves of rows bound the distance to the solution", "[rows][certificate]") {
    Eigen::VectorXd d, other;
    const Eigen::MatrixXd dominant = grid(7, 6, &d), rough = self_adjoint(42, 0.2, 5, other), m = rough_matrix(42, 3, 1);
    lcl_solve_options options = solve_options(LCL_SOLVER_AUTO, 1e-4);
    options.certify = 1;
    double norm = 0;
    int32_t proven = 0;
    for (const Rows& rows : {rows_of(dominant, d), rows_of(dominant), rows_of(rough, other)}) {
        const Operator A = make_rows_operator(rows);
        const Eigen::MatrixXd a = matrix_of(rows);
        const Solved solved(A.get(), m, options);
        CHECK(oracle::largest_row(solved.P - oracle::solve(a, m)) <= solved.report.surface_error_bound);
        succeed(lcl_operator_inverse_norm(A.get(), &norm, &proven));
        const double exact = oracle::infinity_norm(oracle::solve(a, Eigen::MatrixXd::Identity(42, 42)));
        CHECK(norm >= 0.95 * exact);
        CHECK(proven == (largest(a - dominant) == 0));
        if (proven) CHECK(norm == Approx(5));  // 1/(0.6 - 0.4)
    }
    const Operator neither = make_rows_operator(rows_of(with_spectrum(Eigen::VectorXd::LinSpaced(42, 0.2, 1), 6)));
    CHECK(std::isnan(Solved(neither.get(), m, options).report.surface_error_bound));
    refuse(lcl_operator_inverse_norm(neither.get(), &norm, &proven), LCL_ERROR_UNSUPPORTED,
           "without a scaling D that makes D A symmetric, and are not diagonally dominant");
}

TEST_CASE("spectra that iterations cannot take are refused with the eigenvalue", "[rows][spectrum]") {
    Operator A;
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(200, 0.3, 1), d;
    const Eigen::MatrixXd good = self_adjoint(200, 0.3, 1, d);
    const auto scaled = [&](double factor, double shift) { return Eigen::MatrixXd(factor * good + shift * Eigen::MatrixXd::Identity(200, 200)); };
    refuse(create(rows_of(scaled(1.2, 0), d), A), LCL_ERROR_UNSUPPORTED, "the rows have an eigenvalue of about 1.2, above 1");
    refuse(create(rows_of(scaled(1.2, -0.5), d), A), LCL_ERROR_UNSUPPORTED,
           "the rows have an eigenvalue of about -0.14, below 0: iterations and filters take eigenvalues from 0 to 1, as t E + (1 - t) A has for a t of 0.12");
    refuse(create(rows_of(scaled(1, -0.8), d), A), LCL_ERROR_UNSUPPORTED, "so that an eigenvalue is below 0");
    CHECK(last_error_vertices().size() == 1);
    refuse(create(rows_of(3 * Eigen::MatrixXd::Identity(4, 4), Eigen::VectorXd::Ones(4)), A), LCL_ERROR_UNSUPPORTED,
           "row 0 has the diagonal element 3, so that an eigenvalue is above 1");
    values[17] = 1.1;
    refuse(create(rows_of(with_spectrum(values, 2)), A), LCL_ERROR_UNSUPPORTED, "the rows have an eigenvalue of about 1.1, above 1");
    values[17] = -0.1;
    refuse(create(rows_of(with_spectrum(values, 2)), A), LCL_ERROR_UNSUPPORTED, "the rows have an eigenvalue of about -0.1, below 0");
    Eigen::MatrixXd turning = Eigen::MatrixXd::Identity(200, 200);
    turning.diagonal() = Eigen::VectorXd::LinSpaced(200, 0.4, 0.9);
    turning.topLeftCorner(2, 2) << 0.5, 0.3, -0.3, 0.5;
    const Eigen::MatrixXd x = Eigen::MatrixXd::Identity(200, 200) + 0.03 * rough_matrix(200, 200, 3);
    refuse(create(rows_of(x * turning * x.inverse()), A), LCL_ERROR_UNSUPPORTED, "the rows have an eigenvalue of about 0.5 + 0.3 i, which is not real");
    CHECK(A == nullptr);
}

TEST_CASE("matrices that are far from normal, or were rounded to floats, are not refused for what they only seem to have", "[rows][spectrum]") {
    const auto is_taken = [](const Rows& rows) {
        Operator A;
        succeed(create(rows, A));
    };
    for (const int n : {5, 12, 29, 30, 31, 60, 300}) {  // one eigenvalue, 1/2, in one Jordan block: its Ritz values fill a disc
        INFO(n);
        Eigen::MatrixXd a = 0.5 * Eigen::MatrixXd::Identity(n, n);
        a.diagonal(-1).setConstant(0.5);
        is_taken(rows_of(a));
        a.diagonal(-1).setConstant(3);
        is_taken(rows_of(a));
    }
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
        Eigen::MatrixXd a = rough_matrix(40, 40, seed).triangularView<Eigen::StrictlyUpper>();
        a.diagonal() = 0.5 * (rough_matrix(40, 1, seed + 10) + Eigen::VectorXd::Constant(40, 1));  // real, whatever stands above
        is_taken(rows_of(a));
        is_taken(rows_of(a.cast<float>().cast<double>()));
        const Eigen::MatrixXd mixed = with_spectrum(Eigen::VectorXd::LinSpaced(80, 0, 1), seed);
        is_taken(rows_of(mixed.cast<float>().cast<double>()));
        Eigen::MatrixXd defective = 0.25 * Eigen::MatrixXd::Identity(12, 12);
        defective(1, 0) = defective(2, 1) = defective(5, 4) = 0.7;
        const Eigen::MatrixXd x = Eigen::MatrixXd::Identity(12, 12) + 0.1 * rough_matrix(12, 12, seed);
        is_taken(rows_of((x * defective * x.inverse()).cast<float>().cast<double>()));
    }
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(41);
    is_taken(rows_of(1.0000001 * ring(41, 0.2), ones));  // what is above 1 could be rounding
}

TEST_CASE("auto falls back to PIA where Chebyshev fails on rows that are far from normal", "[rows]") {
    const int n = 60;
    Eigen::MatrixXd a = 0.5 * Eigen::MatrixXd::Identity(n, n);
    a.diagonal(-1).setConstant(0.5);
    a(0, 0) = 1;
    const Operator A = make_rows_operator(rows_of(a));
    const Eigen::MatrixXd m = rough_matrix(n, 3, 1);
    const Solved solved(A.get(), m, solve_options(LCL_SOLVER_AUTO, 1e-6));
    check_solution(a, m, solved, 1e-6);
    CHECK(solved.report.solver == LCL_SOLVER_PIA);
    const Solved chebyshev(A.get(), m, solve_options(LCL_SOLVER_CHEBYSHEV, 1e-6));
    CHECK(chebyshev.status == LCL_ERROR_NOT_CONVERGED);
    CHECK_THAT(chebyshev.report.message, Catch::EndsWith(": use solver auto"));
}

TEST_CASE("Ritz values of a few rows are the eigenvalues, with a scaling they never lie outside the spectrum", "[rows][spectrum]") {
    Eigen::VectorXd d;
    const Eigen::MatrixXd a = self_adjoint(20, 0.1, 1, d);
    const auto few = lcl::ritz_values(plan_of(rows_of(a, d)));
    REQUIRE(few.size() == 20);
    const Eigen::VectorXd exact = oracle::scaled_spectrum(a, d);
    for (int i = 0; i < 20; ++i) CHECK(few[i].value.real() == Approx(exact[i]).epsilon(1e-9));
    const Eigen::MatrixXd large = self_adjoint(300, 0.1, 2, d);
    const auto some = lcl::ritz_values(plan_of(rows_of(large, d)));
    REQUIRE(some.size() == 30);
    CHECK((some.front().value.real() >= 0.1 - 1e-12 && some.back().value.real() <= 1 + 1e-12));
    CHECK(some.front().value.real() == Approx(0.1).epsilon(0.05));
    const auto general = lcl::ritz_values(plan_of(rows_of(with_spectrum(Eigen::VectorXd::LinSpaced(25, 0.2, 1), 4))));
    REQUIRE(general.size() == 25);
    double lowest = 1;
    for (const auto& ritz : general) {
        lowest = std::min(lowest, ritz.value.real());
        CHECK(ritz.error < 1e-4);
        CHECK(std::fabs(ritz.value.imag()) < 1e-9);
    }
    CHECK(lowest == Approx(0.2).epsilon(1e-9));
    CHECK(lcl::ritz_values(plan_of(rows_of(Eigen::MatrixXd::Identity(3, 3)))).empty());
}

TEST_CASE("wrong arrays are refused with the row", "[rows][capi]") {
    Operator A;
    const auto refuse_rows = [&](const Rows& rows, const std::string& sentence, const std::vector<int32_t>& where) {
        refuse(create(rows, A), LCL_ERROR_BAD_INPUT, sentence);
        CHECK(last_error_vertices() == where);
        CHECK(A == nullptr);
    };
    const auto changed = [](const auto& change) {
        Rows rows = five_rows();  // row 2 holds columns 1, 2, 3 at entries 6, 7, 8
        change(rows);
        return rows;
    };
    refuse_rows(changed([](Rows& r) { r.offsets[0] = 1; }), "offsets begin with 1: they begin with 0", {0});
    refuse_rows(changed([](Rows& r) { r.offsets[3] = 5; }), "row 2 begins at entry 6 and ends at 5: offsets do not fall", {2});
    refuse_rows(changed([](Rows& r) { r.columns[6] = 5; }), "row 2 has column 5, there are 5 rows", {2});
    refuse_rows(changed([](Rows& r) { r.columns[6] = -1; }), "row 2 has column -1, there are 5 rows", {2});
    refuse_rows(changed([](Rows& r) { r.columns[6] = 3; }), "row 2 has column 3 twice: add up its weights", {2});
    refuse_rows(changed([](Rows& r) { r.columns[7] = 0; }), "row 2 has no diagonal element: every row holds its own column", {2});
    refuse_rows(changed([](Rows& r) { r.weights[8] = not_a_number; }), "row 2 has the weight nan at column 3: weights are finite and fit into a float", {2});
    refuse_rows(changed([](Rows& r) { r.weights[8] = -infinity; }), "row 2 has the weight -inf at column 3", {2});
    refuse_rows(changed([](Rows& r) { r.weights[8] = 1e39; }), "row 2 has the weight 1e+39 at column 3", {2});
    refuse_rows(changed([](Rows& r) { r.weights[7] = 0; }), "row 2 has the diagonal element 0: it is not 0", {2});
    refuse_rows(changed([](Rows& r) { r.scaling[4] = 0; }), "row 4 has the scaling 0: scalings are finite and above 0", {4});
    refuse_rows(changed([](Rows& r) { r.scaling[4] = -1; }), "row 4 has the scaling -1", {4});
    refuse_rows(changed([](Rows& r) { r.scaling[4] = infinity; }), "row 4 has the scaling inf", {4});
    refuse_rows(changed([](Rows& r) { r.scaling[4] = not_a_number; }), "row 4 has the scaling nan", {4});
    refuse_rows(changed([](Rows& r) { r.scaling[2] = 2; }),
                "rows 1 and 2 are not symmetric under the scaling D: D A is 0.2 in row 1, column 2, and 0.4 the other way round", {1, 2});
    refuse_rows(changed([](Rows& r) { r.weights[8] = 0.2 + 1e-11; }), "rows 2 and 3 are not symmetric under the scaling D", {2, 3});
    refuse_rows(changed([](Rows& r) { r.columns[8] = 4; }),
                "rows 2 and 3 are not symmetric under the scaling D: D A is 0 in row 2, column 3, and 0.2 the other way round", {2, 3});
    Rows far = rows_of(0.5 * Eigen::MatrixXd::Identity(3, 3), Eigen::Vector3d(1, 1e-40, 0.5));
    refuse_rows(far, "row 1 has the scaling 1e-40, and row 0 has 1: floats do not hold both", {1});
    succeed(create(changed([](Rows& r) { r.weights[8] = 0.2 + 1e-14; }), A));  // within 1e-12 of the largest element
    succeed(create(changed([](Rows& r) { r.weights[8] = 0.2; }), A));
}

TEST_CASE("entries that are nearly 0 may lack their mirror image", "[rows][local]") {
    Rows rows = five_rows();
    rows.columns.insert(rows.columns.begin() + 3, 2);  // row 0, column 2
    rows.weights.insert(rows.weights.begin() + 3, 1e-14);
    for (std::size_t i = 1; i < rows.offsets.size(); ++i) ++rows.offsets[i];
    const Operator A = make_rows_operator(rows);
    size_t size = 0;
    succeed(lcl_operator_get_row(A.get(), 2, nullptr, nullptr, 0, &size));
    CHECK(size == 4);  // who reads a vertex is known from its own row
    const Eigen::MatrixXd m = rough_matrix(5, 3, 3);
    check_solution(matrix_of(rows), m, Solved(A.get(), m, solve_options(LCL_SOLVER_CG, 1e-9)), 1e-9);
}

TEST_CASE("structs and counts of rows are checked", "[rows][capi]") {
    lcl_context context = default_context();
    const Rows rows = five_rows();
    lcl_rows data = rows.data();
    lcl_operator A = nullptr;
    data.row_count = 0;
    refuse(lcl_operator_create_rows(context, &data, &A), LCL_ERROR_INVALID_ARGUMENT, "rows.row_count is 0, it is at least 1");
    data.row_count = -3;
    refuse(lcl_operator_create_rows(context, &data, &A), LCL_ERROR_INVALID_ARGUMENT, "rows.row_count is -3, it is at least 1");
    data = rows.data();
    data.struct_size = 0;
    refuse(lcl_operator_create_rows(context, &data, &A), LCL_ERROR_INVALID_ARGUMENT, "rows.struct_size is not set");
    data = rows.data();
    data.struct_size = offsetof(lcl_rows, scaling);  // an older header, without D
    succeed(lcl_operator_create_rows(context, &data, &A));
    const Operator owner(A);
    const lcl_solve_options options = solve_options(LCL_SOLVER_CG);
    std::vector<double> values(15);
    refuse(lcl_interpolate(A, values.data(), 0, 3, &options, values.data(), 0, nullptr), LCL_ERROR_INVALID_ARGUMENT, "came without a scaling");
}

TEST_CASE("operators of rows tell what they are", "[rows][capi]") {
    const Rows rows = five_rows();
    const Operator A = make_rows_operator(rows);
    CHECK(lcl_operator_vertex_count(A.get()) == 5);
    CHECK(lcl_operator_row_count(A.get()) == 5);
    lcl_scheme_options scheme = LCL_SCHEME_OPTIONS_INIT;
    scheme.scheme = LCL_SCHEME_LOOP;
    succeed(lcl_operator_get_scheme(A.get(), &scheme));
    CHECK(scheme.scheme == LCL_SCHEME_DEFAULT);
    CHECK((scheme.alpha == 0 && scheme.lambda == 0 && scheme.mask == 0));
    int32_t columns[5];
    double weights[5];
    size_t size = 0;
    succeed(lcl_operator_get_row(A.get(), 4, columns, weights, 5, &size));
    REQUIRE(size == 3);
    CHECK((columns[0] == 0 && columns[1] == 3 && columns[2] == 4));
    CHECK((weights[0] == 0.2 && weights[1] == 0.2 && weights[2] == Approx(0.6)));
    refuse(lcl_operator_get_row(A.get(), 5, columns, weights, 5, &size), LCL_ERROR_INVALID_ARGUMENT, "row 5 was asked for, the operator has 5 vertices");
    const Mesh mesh = make_mesh(shapes::octahedron());
    refuse(lcl_interpolate_mesh(A.get(), mesh.get(), nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "the operator has 5 vertices, the mesh 6");
}

TEST_CASE("single sweeps on blocks of rows are those of the dense matrix", "[rows][field]") {
    Eigen::VectorXd d;
    const Eigen::MatrixXd a = grid(40, 30, &d), m = rough_matrix(1200, 3, 1), x = rough_matrix(1200, 3, 2);
    for (const bool with_scaling : {true, false}) {
        const Operator A = make_rows_operator(with_scaling ? rows_of(a, d) : rows_of(a));
        const int32_t blocks = lcl_operator_block_count(A.get());
        REQUIRE(blocks > 1);
        const FieldHandle M = make_field(A.get(), values_of(m)), in = make_field(A.get(), values_of(x), LCL_PRECISION_DOUBLE, M.get()),
                          out = make_field(A.get());
        succeed(lcl_field_match(out.get(), M.get()));
        double worst = 0;
        for (int32_t block = 0; block < blocks; ++block) {
            double residual = 0;
            succeed(lcl_operator_step(A.get(), 1, 1, 0, M.get(), in.get(), nullptr, out.get(), block, 1, &residual));
            worst = std::max(worst, residual);
        }
        CHECK(largest(matrix_of(download(out.get(), 1200), 3) - (x + m - a * x)) < 1e-14);
        CHECK(worst == Approx(oracle::largest_row(m - a * x)));
    }
}

TEST_CASE("an edit of few rows is solved locally with a scaling, and by the full solve without", "[rows][local]") {
    const int m = 70, n = 60, count = m * n;
    Rows rows;  // five points of a grid, by hand: dense matrices would be large
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < n; ++j, rows.end_row()) {
            std::vector<int32_t> neighbours;
            if (i > 0) neighbours.push_back((i - 1) * n + j);
            if (j > 0) neighbours.push_back(i * n + j - 1);
            if (j + 1 < n) neighbours.push_back(i * n + j + 1);
            if (i + 1 < m) neighbours.push_back((i + 1) * n + j);
            rows.add(i * n + j, 0.6);
            for (const int32_t other : neighbours) rows.add(other, 0.4 / static_cast<double>(neighbours.size()));
            rows.scaling.push_back(static_cast<double>(neighbours.size()));
        }
    const Eigen::MatrixXd before = rough_matrix(count, 3, 3);
    const int32_t edited[] = {1234, 4000};
    const double values[] = {0.5, -0.25, 2, 1, 1, 1};
    Eigen::MatrixXd after = before;
    after.row(1234) << 0.5, -0.25, 2;
    after.row(4000) << 1, 1, 1;
    for (const bool with_scaling : {true, false}) {
        if (!with_scaling) rows.scaling.clear();
        const Operator A = make_rows_operator(rows);
        const FieldHandle M = make_field(A.get(), values_of(before)), P = make_field(A.get());
        lcl_solve_options options = solve_options(LCL_SOLVER_AUTO, 1e-7, LCL_PRECISION_DOUBLE);
        succeed(lcl_interpolate_field(A.get(), M.get(), &options, P.get(), nullptr));
        lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
        succeed(lcl_solve_local(A.get(), M.get(), P.get(), edited, 2, values, &options, &report));
        CHECK(report.converged == 1);
        if (with_scaling) CHECK((report.changed_rows > 10 && report.changed_rows < count / 4));
        else CHECK(report.changed_rows == count);
        const Eigen::MatrixXd p = matrix_of(download(P.get(), count), 3);
        CHECK(oracle::largest_row(after - limit_points(A.get(), p)) <= 1e-7 * box_diagonal(before) * 1.001);
        CHECK(oracle::largest_row(after - matrix_of(download(M.get(), count), 3)) < 1e-14);
        options.solver = LCL_SOLVER_GS;
        const lcl_status status = lcl_solve_local(A.get(), M.get(), P.get(), edited, 1, values + 3, &options, &report);
        if (with_scaling) succeed(status);
        else refuse(status, LCL_ERROR_INVALID_ARGUMENT, "Gauss-Seidel needs a self-adjoint operator");
        const double expected = with_scaling ? 1 : 0.5;  // M is as before where the call was refused
        CHECK(matrix_of(download(M.get(), count), 3)(1234, 0) == Approx(expected));
    }
}

TEST_CASE("plans of rows bring neighbours together and keep what was given", "[rows][plan]") {
    const auto shape = shapes::shuffled(shapes::torus_quads(50, 40), 3);  // any graph whose numbering says nothing
    const Operator original = make_operator(shape);
    Rows rows = rows_of(original.get());
    rows.scaling.assign(rows.count(), 36.0);
    const lcl::Plan plan = plan_of(rows, 128);
    CHECK(plan.smooth.row_count == 2000);
    CHECK(plan.has_scaling);
    CHECK(plan.rows_sum_to_one);
    CHECK(plan.reach <= 2);  // levels of the torus hold some 80 rows to both sides; a random order reaches 15 blocks
    std::vector<int> times(2000, 0);
    for (lcl::Index row = 0; row < 2000; ++row) {
        ++times[plan.vertex_of_row[row]];
        CHECK(plan.row_of_vertex[plan.vertex_of_row[row]] == row);
        CHECK(plan.scaling[row] == 1.125);  // 36 / 32: D is known up to a factor
    }
    CHECK(times == std::vector<int>(2000, 1));
    lcl::Index reach = 0;
    for (lcl::Index row = 0; row < 2000; ++row)
        for (const lcl::Index column : plan_row(plan, run_of_row(plan, row), row).columns) reach = std::max(reach, std::abs(row / 128 - column / 128));
    CHECK(plan.reach == reach);
    rows.scaling.clear();
    const lcl::Plan without = plan_of(rows, 128);
    CHECK(without.darts.row_count == 2000);
    CHECK(!without.has_scaling);
    CHECK(without.scaling == std::vector<double>(2000, 0.0));
    CHECK(std::isnan(without.lambda_min_bound));
    CHECK(lcl::gershgorin_interval(without).high == Approx(1));
    CHECK(!plan_of(rows_of(0.9 * ring(5, 0.2))).rows_sum_to_one);
    const Rows two = rows_of((Eigen::MatrixXd(4, 4) << 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 0, 0.7, 0.3, 0, 0, 0.3, 0.7).finished());
    CHECK(plan_of(two).vertex_count == 4);  // two components
}

TEST_CASE("sweeps over rows follow each other like those over meshes", "[rows][kernel]") {
    const auto shape = shapes::torus_quads(120, 100);
    Rows rows = rows_of(make_operator(shape).get());
    rows.scaling.assign(rows.count(), 1.0);
    const auto plan = std::make_shared<const lcl::Plan>(plan_of(rows, 128));
    lcl::DeviceOperator A(solver_test::device_context(), plan, {1, 128, 800000, 8});
    lcl::Field m = A.make_field(3, lcl::Real::single), x = A.make_field(3, lcl::Real::single), y = A.make_field(3, lcl::Real::single);
    REQUIRE(A.phases(8, m, plan->smooth).sweeps > 1);
    REQUIRE(A.phases(8, m, plan->smooth).width < plan->smooth.block_count);
    const std::vector<double> right = values_of(rough_matrix(12000, 3, 1));
    m.upload(right.data(), 0, 12000);
    x.upload(right.data(), 0, 12000);
    y.upload(right.data(), 0, 12000);
    const std::vector<lcl::ResidualNorms> norms = A.chain(std::vector<lcl::Sweep>(8, {1, 1, 0, 0}), m, x, y, plan->smooth);
    std::vector<double> expected = right, found(right.size());
    for (int sweep = 0; sweep < 8; ++sweep) {
        CHECK(norms[sweep].position == Approx(lcl::host_residual(*plan, right, expected, 3).position).epsilon(1e-5));
        const std::vector<double> ax = lcl::host_apply(*plan, expected, 3);
        for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += right[i] - ax[i];
    }
    x.download(found.data(), 0, 12000);
    CHECK(largest_difference(found, expected) < 8 * 2e-6);  // eight sweeps in float
}

TEST_CASE("a few rows are applied on the device", "[rows][tiny]") {
    const Eigen::MatrixXd a = ring(7, 0.2), m = rough_matrix(7, 3, 1), x = rough_matrix(7, 3, 2);
    for (const Rows& rows : {rows_of(a, Eigen::VectorXd::Ones(7)), rows_of(a)}) {
        const Operator A = make_rows_operator(rows);
        CHECK(largest(limit_points(A.get(), x) - a * x) < 1e-15);
        CHECK(largest(limit_points(A.get(), x, LCL_PRECISION_SINGLE) - a * x) < 1e-6);
        const FieldHandle M = make_field(A.get(), values_of(m)), in = make_field(A.get(), values_of(x), LCL_PRECISION_DOUBLE, M.get()),
                          out = make_field(A.get());
        succeed(lcl_operator_step(A.get(), 1, 1, 0, M.get(), in.get(), nullptr, out.get(), 0, -1, nullptr));
        CHECK(largest(matrix_of(download(out.get(), 7), 3) - (x + m - a * x)) < 1e-14);
    }
}
