// SPDX-License-Identifier: BSD-3-Clause
// Operators and solves through the C API: rows, limit points and control points against brute force, every status with its report, cancelling, calls beside the
// caller.
#include <chrono>
#include <limits>
#include <thread>

#include "tests/capi_support.h"
#include "tests/oracle/dense.h"
#include "tests/oracle/limit.h"

using namespace capi_test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

lcl::SchemeOptions oracle_options(const lcl_scheme_options& options) {
    lcl::SchemeOptions out;
    out.scheme = static_cast<lcl::Scheme>(options.scheme - 1);
    out.mask = options.mask == LCL_MASK_CLASSIC ? lcl::DooSabinMask::classic : lcl::DooSabinMask::catmull;
    out.alpha = options.alpha;
    out.lambda = options.lambda;
    return out;
}

Eigen::MatrixXd oracle_rows(const shapes::Shape& shape, const lcl_scheme_options& options) {
    return oracle::limit_rows(shape.mesh, shape.features, oracle_options(options));
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd matrix_of(const std::vector<double>& values, int channels) {
    return Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(values.size()) / channels, channels);
}

std::vector<double> values_of(const Eigen::MatrixXd& matrix) {
    const RowMajor rows = matrix;
    return {rows.data(), rows.data() + rows.size()};
}

lcl_solve_options solve_options(lcl_solver solver, lcl_precision precision = LCL_PRECISION_MIXED) {
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.solver = solver;
    options.precision = precision;
    return options;
}

/// A solve with its own arrays: P, report and residuals.
struct Solved {
    std::vector<double> P, residuals = std::vector<double>(1000, -1.0);
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    lcl_status status;

    Solved(lcl_operator A, const std::vector<double>& M, const lcl_solve_options& options) : P(M.size()) {
        report.residuals = residuals.data();
        report.residual_capacity = residuals.size();
        status = lcl_interpolate(A, M.data(), 0, static_cast<int32_t>(M.size() / lcl_operator_vertex_count(A)), &options, P.data(), 0, &report);
        residuals.resize(std::min(residuals.size(), report.residual_count));
    }
};

struct Progress {
    int calls = 0, stop_at = -1;
    std::vector<int> iterations;
    std::vector<double> residuals;
    double target = 0;
    static int32_t note(void* user, int32_t iteration, double residual, double target) {
        auto& own = *static_cast<Progress*>(user);
        own.calls++;
        own.iterations.push_back(iteration);
        own.residuals.push_back(residual);
        own.target = target;
        return iteration != own.stop_at;
    }
};

std::vector<std::pair<shapes::Shape, lcl_scheme_options>> schemes_on_shapes() {
    lcl_scheme_options classic = scheme(LCL_SCHEME_DOO_SABIN);
    classic.mask = LCL_MASK_CLASSIC;
    return {{shapes::rough(shapes::polygons_mixed(60, 3), 0.05, 1), scheme(LCL_SCHEME_CATMULL_CLARK)},
            {shapes::rough(shapes::grid_with_creases(), 0.1, 2), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5)},
            {shapes::rough(shapes::grid_with_hole(), 0.1, 5), scheme(LCL_SCHEME_CATMULL_CLARK, 0.25, 0.4)},
            {shapes::rough(shapes::grid_triangles_with_creases(), 0.1, 3), scheme(LCL_SCHEME_LOOP)},
            {shapes::rough(shapes::random_triangle_mesh(50, 7), 0.05, 4), scheme(LCL_SCHEME_LOOP)},
            {shapes::rough(shapes::polygons_mixed(40, 5), 0.05, 5), scheme(LCL_SCHEME_DOO_SABIN)},
            {shapes::rough(shapes::grid_with_marked_corner(), 0.1, 6), classic}};
}

bool has_darts(const shapes::Shape& shape) { return contains(shape.name, "with_creases"); }

}  // namespace

TEST_CASE("rows are those of brute-force subdivision", "[capi][operator]") {
    for (const auto& [shape, options] : schemes_on_shapes()) {
        CAPTURE(shape.name, options.scheme);
        const Operator A = make_operator(shape, &options);
        const Eigen::MatrixXd expected = oracle_rows(shape, options);
        for (int32_t v = 0; v < shape.mesh.vertex_count; ++v) {
            std::size_t size = 0;
            succeed(lcl_operator_get_row(A.get(), v, nullptr, nullptr, 0, &size));
            std::vector<int32_t> columns(size);
            std::vector<double> weights(size);
            succeed(lcl_operator_get_row(A.get(), v, columns.data(), weights.data(), size, nullptr));
            CHECK(std::is_sorted(columns.begin(), columns.end(), std::less_equal<int32_t>()));
            Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(expected.cols());
            for (std::size_t i = 0; i < size; ++i) row[columns[i]] = weights[i];
            CHECK((row - expected.row(v)).cwiseAbs().maxCoeff() <= 1e-13);  // the oracle's own rounding, some hundred steps
        }
    }
}

TEST_CASE("a row is cut to the capacity, and one that is not there is refused", "[capi][operator]") {
    const Operator A = make_operator(shapes::octahedron());
    int32_t columns[5] = {-7, -7, -7, -7, -7};
    double weights[5];
    std::size_t size = 0;
    succeed(lcl_operator_get_row(A.get(), 2, columns, weights, 2, &size));
    CHECK(size == 5);
    CHECK((columns[1] >= 0 && columns[2] == -7));
    refuse(lcl_operator_get_row(A.get(), 6, columns, weights, 5, &size), LCL_ERROR_INVALID_ARGUMENT, "row 6 was asked for, the operator has 6");
    refuse(lcl_operator_get_row(A.get(), -1, columns, weights, 5, &size), LCL_ERROR_INVALID_ARGUMENT, "row -1");
}

TEST_CASE("the scheme in use is told", "[capi][operator]") {
    lcl_scheme_options in_use = LCL_SCHEME_OPTIONS_INIT, wanted = LCL_SCHEME_OPTIONS_INIT;
    const auto of = [&](const shapes::Shape& shape) {
        succeed(lcl_operator_get_scheme(make_operator(shape, &wanted).get(), &in_use));
        return in_use.scheme;
    };
    CHECK(of(shapes::octahedron()) == LCL_SCHEME_LOOP);
    CHECK(of(shapes::torus_quads(4, 3)) == LCL_SCHEME_CATMULL_CLARK);
    CHECK(of(shapes::triangular_prism()) == LCL_SCHEME_CATMULL_CLARK);
    wanted.scheme = LCL_SCHEME_DOO_SABIN;
    wanted.mask = LCL_MASK_CLASSIC;
    CHECK(of(shapes::octahedron()) == LCL_SCHEME_DOO_SABIN);
    CHECK(in_use.mask == LCL_MASK_CLASSIC);
    wanted = scheme(LCL_SCHEME_CATMULL_CLARK, 0.25, 0.75);
    CHECK(of(shapes::octahedron()) == LCL_SCHEME_CATMULL_CLARK);
    CHECK((in_use.alpha == 0.25 && in_use.lambda == 0.75 && in_use.subset == nullptr && in_use.lambda_per_vertex == nullptr));
}

TEST_CASE("scheme options that make no sense are refused", "[capi][operator]") {
    const Mesh cube = make_mesh(shapes::cube()), triangles = make_mesh(shapes::octahedron());
    lcl_scheme_options options = LCL_SCHEME_OPTIONS_INIT;
    lcl_operator A = nullptr;
    const auto expect = [&](const Mesh& mesh, const char* part, lcl_status status = LCL_ERROR_INVALID_ARGUMENT) {
        refuse(lcl_operator_create(default_context(), mesh.get(), &options, &A), status, part);
        CHECK(A == nullptr);
    };
    SECTION("alpha of 2") { options.alpha = 2, expect(cube, "alpha is 2"); }
    SECTION("alpha below 0") { options.alpha = -0.5, expect(cube, "alpha is -0.5"); }
    SECTION("alpha that is no number") { options.alpha = not_a_number, expect(cube, "alpha is"); }
    SECTION("lambda of 1.5") { options.lambda = 1.5, expect(cube, "lambda is 1.5"); }
    SECTION("lambda with Loop") { options.lambda = 0.3, expect(triangles, "alpha and lambda belong to Catmull-Clark"); }
    SECTION("alpha with Loop") { options = scheme(LCL_SCHEME_LOOP, 0.5), expect(triangles, "alpha and lambda belong to Catmull-Clark"); }
    SECTION("alpha with Doo-Sabin") { options = scheme(LCL_SCHEME_DOO_SABIN, 0.5), expect(cube, "the scheme is doo-sabin"); }
    SECTION("a scheme that is none") { options.scheme = static_cast<lcl_scheme>(4), expect(cube, "options.scheme is 4"); }
    SECTION("a scheme below 0") { options.scheme = static_cast<lcl_scheme>(-1), expect(cube, "options.scheme is -1"); }
    SECTION("a mask that is none") { options.mask = static_cast<lcl_mask>(2), expect(cube, "options.mask is 2"); }
    SECTION("Loop on quads") {
        options.scheme = LCL_SCHEME_LOOP;
        expect(cube, "face 0 has 4 sides", LCL_ERROR_BAD_INPUT);
        CHECK(last_error_faces().at(0) == 0);
    }
    SECTION("alpha given and automatic") {
        options.alpha = 0.25;
        options.alpha_auto = 1;
        expect(cube, "alpha is given and alpha_auto is set");
    }
    SECTION("a ratio of one vertex") {
        std::vector<double> ratios(8, 0.5);
        ratios[6] = -0.1;
        options.lambda_per_vertex = ratios.data();
        expect(cube, "lambda of vertex 6 is -0.1");
    }
    SECTION("subset and owned vertices that are none") {
        const int32_t list[] = {0, 8};
        options.subset = list;
        options.subset_count = 2;
        expect(cube, "subset names vertex 8, the mesh has 8");
        CHECK(last_error_vertices() == std::vector<int32_t>{8});
        options = LCL_SCHEME_OPTIONS_INIT;
        options.owned = list;
        options.owned_count = 2;
        expect(cube, "owned names vertex 8, the mesh has 8");
    }
}

TEST_CASE("limit points are A times the points, with any layout and number of channels", "[capi][operator]") {
    for (const auto& [shape, options] : schemes_on_shapes()) {
        CAPTURE(shape.name, options.scheme);
        const Operator A = make_operator(shape, &options);
        const Eigen::MatrixXd rows = oracle_rows(shape, options);
        for (int channels = 1; channels <= 9; ++channels) {
            const std::vector<double> values = with_channels(shape.mesh.positions, channels), expected = values_of(rows * matrix_of(values, channels));
            const std::size_t stride = channels + 2, out_stride = channels + 1, count = shape.mesh.vertex_count;
            std::vector<double> wide(count * stride, 5.0), out(count * out_stride, -3.0), found;
            for (std::size_t i = 0; i < values.size(); ++i) wide[i / channels * stride + i % channels] = values[i];
            succeed(lcl_limit_points(A.get(), wide.data(), stride, channels, LCL_PRECISION_DOUBLE, out.data(), out_stride));
            for (std::size_t v = 0; v < count; ++v) {
                found.insert(found.end(), &out[v * out_stride], &out[v * out_stride] + channels);
                CHECK(out[v * out_stride + channels] == -3);
            }
            CHECK(largest_difference(found, expected) <= 1e-13 * 1000);  // values up to 1000
            std::vector<double> in_place = values;
            succeed(lcl_limit_points(A.get(), in_place.data(), 0, channels, LCL_PRECISION_DOUBLE, in_place.data(), 0));
            CHECK(in_place == found);
        }
    }
}

TEST_CASE("limit points in each precision are as exact as it is", "[capi][operator]") {
    const shapes::Shape shape = shapes::transformed(shapes::rough(shapes::torus_quads(7, 5), 0.05, 3), 1, 1e6);  // far away
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Operator A = make_operator(shape, &options);
    const std::vector<double> expected = values_of(oracle_rows(shape, options) * matrix_of(shape.mesh.positions, 3));
    const auto [precision, relative] =
        GENERATE(table<lcl_precision, double>({{LCL_PRECISION_SINGLE, 10 * 6e-8}, {LCL_PRECISION_MIXED, 0.0}, {LCL_PRECISION_DOUBLE, 0.0}}));
    std::vector<double> out(expected.size());
    succeed(lcl_limit_points(A.get(), shape.mesh.positions.data(), 0, 3, precision, out.data(), 0));
    CHECK(largest_difference(out, expected) <= relative * diagonal_of(shape) + 10 * 1e6 * 2.2e-16);  // rounding of coordinates of 1e6 stays in any case
}

TEST_CASE("wrong arguments of limit points and solves are refused", "[capi][operator][solve]") {
    const Operator A = make_operator(shapes::octahedron());
    std::vector<double> M = shapes::octahedron().mesh.positions, P(18, 7.0);
    const auto limit = [&](std::size_t stride, int32_t channels, int precision, std::size_t out_stride) {
        return lcl_limit_points(A.get(), M.data(), stride, channels, static_cast<lcl_precision>(precision), P.data(), out_stride);
    };
    const auto solve = [&](std::size_t stride, int32_t channels, std::size_t P_stride) {
        return lcl_interpolate(A.get(), M.data(), stride, channels, nullptr, P.data(), P_stride, nullptr);
    };
    refuse(limit(0, 0, 0, 0), LCL_ERROR_INVALID_ARGUMENT, "channels is 0");
    refuse(limit(0, -2, 0, 0), LCL_ERROR_INVALID_ARGUMENT, "channels is -2");
    refuse(limit(2, 3, 0, 0), LCL_ERROR_INVALID_ARGUMENT, "stride is 2, less than the 3 channels");
    refuse(limit(0, 3, 0, 2), LCL_ERROR_INVALID_ARGUMENT, "out_stride is 2");
    refuse(limit(0, 3, 3, 0), LCL_ERROR_INVALID_ARGUMENT, "precision is 3");
    refuse(limit(0, 3, -1, 0), LCL_ERROR_INVALID_ARGUMENT, "precision is -1");
    refuse(solve(0, 0, 0), LCL_ERROR_INVALID_ARGUMENT, "channels is 0");
    refuse(solve(2, 3, 0), LCL_ERROR_INVALID_ARGUMENT, "stride is 2");
    refuse(solve(0, 3, 1), LCL_ERROR_INVALID_ARGUMENT, "P_stride is 1");
    M[3 * 4 + 1] = not_a_number;
    refuse(limit(0, 3, 0, 0), LCL_ERROR_BAD_INPUT, "channel 1 of vertex 4 is not finite");
    refuse(solve(0, 3, 0), LCL_ERROR_BAD_INPUT, "channel 1 of vertex 4 is not finite");
    CHECK(last_error_vertices() == std::vector<int32_t>{4});
    CHECK(P == std::vector<double>(18, 7.0));
}

TEST_CASE("options of a solve that make no sense are refused", "[capi][solve]") {
    const Operator A = make_operator(shapes::octahedron());
    const std::vector<double> M = shapes::octahedron().mesh.positions;
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    const auto expect = [&](const char* part) { refuse(Solved(A.get(), M, options).status, LCL_ERROR_INVALID_ARGUMENT, part); };
    SECTION("solver") { options.solver = static_cast<lcl_solver>(8), expect("options.solver is 8"); }
    SECTION("solver below 0") { options.solver = static_cast<lcl_solver>(-1), expect("options.solver is -1"); }
    SECTION("precision") { options.precision = static_cast<lcl_precision>(3), expect("precision is 3"); }
    SECTION("tolerance below 0") { options.tolerance = -1e-6, expect("options.tolerance"); }
    SECTION("tolerance that is no number") { options.tolerance = not_a_number, expect("options.tolerance"); }
    SECTION("negative iterations") { options.max_iterations = -1, expect("negative number of iterations"); }
    SECTION("negative sweeps") { options.exact_sweeps = -1, expect("negative number of iterations"); }
    SECTION("weight of 2") { options.weight = 2, expect("options.weight is 2"); }
    SECTION("weight below 0") { options.weight = -1, expect("options.weight is -1"); }
    SECTION("diagonal below 0") { options.diagonal = -1, expect("options.diagonal"); }
    SECTION("a start that is no number") {
        options.warm_start = 1;
        std::vector<double> P = M;
        P[17] = not_a_number;
        refuse(lcl_interpolate(A.get(), M.data(), 0, 3, &options, P.data(), 0, nullptr), LCL_ERROR_BAD_INPUT, "P of vertex 5 is nan in channel 2");
    }
}

TEST_CASE("every solver that fits gives the control points of a dense solve", "[capi][solve]") {
    for (const auto& [shape, options] : schemes_on_shapes()) {
        const Operator A = make_operator(shape, &options);
        const Eigen::MatrixXd rows = oracle_rows(shape, options), inverse = rows.inverse();
        const Eigen::MatrixXd M = matrix_of(shape.mesh.positions, 3);
        const std::vector<double> expected = values_of(oracle::solve(rows, M));
        const double tolerance = 1e-10, diagonal = diagonal_of(shape);
        for (const lcl_solver solver :
             {LCL_SOLVER_AUTO, LCL_SOLVER_PIA, LCL_SOLVER_WPIA, LCL_SOLVER_GS, LCL_SOLVER_GS_COLOURED, LCL_SOLVER_CHEBYSHEV, LCL_SOLVER_CG})
            for (const lcl_precision precision : {LCL_PRECISION_MIXED, LCL_PRECISION_DOUBLE}) {
                CAPTURE(shape.name, options.scheme, solver, precision);
                if (solver == LCL_SOLVER_CG && has_darts(shape)) continue;
                lcl_solve_options solve = solve_options(solver, precision);
                solve.tolerance = tolerance;
                solve.max_iterations = 3000;
                const Solved solved(A.get(), shape.mesh.positions, solve);
                INFO(solved.report.message);
                CHECK(solved.status == LCL_OK);
                CHECK(solved.report.converged == 1);
                CHECK(solved.report.max_error <= tolerance * diagonal);
                CHECK(solved.report.message[0] == '\0');
                CHECK(solved.report.residual_count == static_cast<std::size_t>(solved.report.iterations) + 1);
                CHECK(std::isnan(solved.report.surface_error_bound));
                if (solver != LCL_SOLVER_AUTO) CHECK(solved.report.solver == solver);
                CHECK(largest_difference(solved.P, expected) <= oracle::infinity_norm(inverse) * tolerance * diagonal);
                const double error = oracle::largest_row(M - rows * matrix_of(solved.P, 3));
                CHECK(std::abs(error - solved.report.max_error) <= 1e-13 * diagonal);  // the same residual, rounded otherwise
            }
    }
}

TEST_CASE("solving undoes limit points for 1 to 9 channels, in place and with strides", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::grid_with_hole(), 0.1, 8);
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Operator A = make_operator(shape, &options);
    const double inverse_norm = oracle::infinity_norm(oracle_rows(shape, options).inverse());
    for (int channels = 1; channels <= 9; ++channels) {
        CAPTURE(channels);
        const std::size_t stride = channels + 1, count = shape.mesh.vertex_count;
        const std::vector<double> control = with_channels(shape.mesh.positions, channels);
        std::vector<double> values(control.size()), wide(count * stride, 4.0);
        succeed(lcl_limit_points(A.get(), control.data(), 0, channels, LCL_PRECISION_DOUBLE, values.data(), 0));
        for (std::size_t i = 0; i < values.size(); ++i) wide[i / channels * stride + i % channels] = values[i];
        lcl_solve_options solve = solve_options(LCL_SOLVER_AUTO);
        solve.tolerance = 1e-9;
        lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
        succeed(lcl_interpolate(A.get(), wide.data(), stride, channels, &solve, wide.data(), stride, &report));
        CHECK(report.channel_error <= 1e-9);
        CHECK((channels > 3 || report.channel_error == 0));
        for (std::size_t v = 0; v < count; ++v) CHECK(wide[v * stride + channels] == 4);
        std::vector<double> size(channels, 0.0);
        for (std::size_t i = 0; i < control.size(); ++i) size[i % channels] = std::max(size[i % channels], std::abs(control[i]));
        for (std::size_t i = 0; i < control.size(); ++i) {
            const double difference =
                std::abs(wide[i / channels * stride + i % channels] - control[i]) / (2 * size[i % channels] + (i % channels < 3 ? diagonal_of(shape) : 0));
            if (difference > inverse_norm * 1e-9) FAIL_CHECK("vertex " << i / channels << " channel " << i % channels << " is off by " << difference);
        }
    }
}

TEST_CASE("corners, isolated vertices and vertices outside the subset keep their values to the bit", "[capi][solve]") {
    const shapes::Shape shape =
        shapes::transformed(shapes::rough(shapes::with_isolated_vertex(shapes::grid_with_marked_corner(), 7), 0.1, 9), 1.0 / 3, 12345.678);
    const std::vector<double>& M = shape.mesh.positions;
    std::vector<int32_t> subset, kept{7};
    for (int32_t v = 0; v < shape.mesh.vertex_count; ++v)
        if (v % 5 != 0) subset.push_back(v);
        else kept.push_back(v);
    for (const int32_t corner : shape.features.corners) kept.push_back(corner);
    lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    options.subset = subset.data();
    options.subset_count = subset.size();
    const Operator A = make_operator(shape, &options);
    const Eigen::MatrixXd rows = oracle::with_identity_rows(oracle_rows(shape, options), subset);
    const lcl_solver solver = GENERATE(LCL_SOLVER_AUTO, LCL_SOLVER_WPIA, LCL_SOLVER_GS, LCL_SOLVER_CG);
    const int warm = GENERATE(0, 1);
    CAPTURE(solver, warm);
    lcl_solve_options solve = solve_options(solver);
    solve.warm_start = warm;
    std::vector<double> P(M.size(), 12345.0);
    succeed(lcl_interpolate(A.get(), M.data(), 0, 3, &solve, P.data(), 0, nullptr));
    for (const int32_t v : kept)
        for (int c = 0; c < 3; ++c) CHECK(P[3 * v + c] == M[3 * v + c]);
    CHECK(oracle::largest_row(matrix_of(M, 3) - rows * matrix_of(P, 3)) <= 1e-6 * diagonal_of(shape) * (1 + 1e-3));
    std::vector<double> limit = P;
    succeed(lcl_limit_points(A.get(), limit.data(), 0, 3, LCL_PRECISION_SINGLE, limit.data(), 0));
    for (const int32_t v : kept)
        for (int c = 0; c < 3; ++c) CHECK(limit[3 * v + c] == M[3 * v + c]);
}

TEST_CASE("a subset may be empty: then everything stays", "[capi][solve]") {
    const shapes::Shape shape = shapes::cube();
    lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const int32_t none = 0;
    options.subset = &none;
    const Operator A = make_operator(shape, &options);
    const Solved solved(A.get(), shape.mesh.positions, LCL_SOLVE_OPTIONS_INIT);
    CHECK(solved.status == LCL_OK);
    CHECK(solved.P == shape.mesh.positions);
}

TEST_CASE("a solve may begin where another one ended", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(8, 6), 0.05, 2);
    const std::vector<double>& M = shape.mesh.positions;
    const Operator A = make_operator(shape);
    lcl_solve_options options = solve_options(LCL_SOLVER_WPIA);
    const Solved cold(A.get(), M, options);
    REQUIRE(cold.status == LCL_OK);
    CHECK(cold.report.iterations > 5);
    options.warm_start = 1;
    std::vector<double> P = cold.P;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    succeed(lcl_interpolate(A.get(), M.data(), 0, 3, &options, P.data(), 0, &report));
    CHECK(report.iterations == 0);
    CHECK(largest_difference(P, cold.P) <= 1e-14);
    for (std::size_t i = 0; i < P.size(); i += 3) P[i] += 10;
    succeed(lcl_interpolate(A.get(), M.data(), 0, 3, &options, P.data(), 0, &report));
    CHECK(report.iterations > cold.report.iterations);
    CHECK(report.max_error <= 1e-6 * diagonal_of(shape));
}

TEST_CASE("the same input gives the same bits", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::polygons_mixed(90, 11), 0.05, 2);
    const Operator A = make_operator(shape), B = make_operator(shape);
    const lcl_solver solver = GENERATE(LCL_SOLVER_AUTO, LCL_SOLVER_GS_COLOURED, LCL_SOLVER_CG);
    const Solved first(A.get(), shape.mesh.positions, solve_options(solver)), second(A.get(), shape.mesh.positions, solve_options(solver)),
        other(B.get(), shape.mesh.positions, solve_options(solver));
    CHECK(first.P == second.P);
    CHECK(first.residuals == second.residuals);
    CHECK(first.P == other.P);
}

TEST_CASE("a singular operator is named with its vertices and the cure, and left alone unless told to go on", "[capi][solve][singular]") {
    const shapes::Shape shape = shapes::cube();
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Operator A = make_operator(shape, &options);
    lcl_solve_options solve = solve_options(LCL_SOLVER_AUTO);
    const Solved stopped(A.get(), shape.mesh.positions, solve);
    CHECK(stopped.status == LCL_ERROR_SINGULAR);
    CHECK_THAT(lcl_last_error(), Catch::Matchers::Contains("alpha 0.5") && Catch::Matchers::Contains("singular"));
    CHECK(last_error_vertices() == std::vector<int32_t>{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(std::string(stopped.report.message) == lcl_last_error());
    CHECK(stopped.report.vertex_count == 8);
    CHECK(stopped.report.converged == 0);
    CHECK(stopped.report.iterations == 0);
    CHECK(largest_difference(stopped.P, shape.mesh.positions) <= 1e-15);
    REQUIRE(stopped.residuals.size() == 1);
    CHECK(stopped.residuals[0] == Approx(std::sqrt(3.0) / 2));  // (9 V + 4 sum E + sum F)/24 = (9 + 4 - 1)/24 V

    solve.keep_going = 1;
    solve.max_iterations = 7;
    solve.solver = LCL_SOLVER_PIA;
    const std::vector<double> rough = shapes::rough(shape, 0.2, 4).mesh.positions;
    const Solved kept_going(A.get(), rough, solve);
    CHECK(kept_going.status == LCL_ERROR_SINGULAR);
    CHECK(kept_going.report.iterations == 7);
    const oracle::History expected = oracle::pia(oracle::to_sparse(oracle_rows(shape, options)), matrix_of(rough, 3), 7);
    CHECK(largest_difference(kept_going.P, values_of(expected.points)) <= 1e-6);

    solve.max_iterations = 0;
    solve.solver = LCL_SOLVER_AUTO;  // conjugate gradients, which meet the null vector and take it for a negative eigenvalue
    const Solved by_auto(A.get(), rough, solve);
    CHECK(by_auto.status == LCL_ERROR_SINGULAR);
    CHECK_THAT(by_auto.report.message, Catch::Matchers::Contains("singular"));
}

TEST_CASE("an indefinite operator is told by its status", "[capi][solve][singular]") {
    const shapes::Shape shape = shapes::cube_split_edges();  // an eigenvalue of -1/14
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Operator A = make_operator(shape, &options);
    const Solved solved(A.get(), shape.mesh.positions, solve_options(LCL_SOLVER_AUTO));
    CHECK(solved.status == LCL_ERROR_INDEFINITE);
    CHECK_THAT(lcl_last_error(), Catch::Matchers::Contains("indefinite") && Catch::Matchers::Contains("alpha"));
    CHECK(solved.report.vertex_count > 0);
    lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
    succeed(lcl_operator_diagnose(A.get(), &diagnosis));
    CHECK(diagnosis.indefinite == 1);
    CHECK(diagnosis.singular == 0);
    CHECK(std::isnan(diagnosis.lambda_min_bound));
    CHECK(diagnosis.lambda_min_estimate < 0);
    CHECK(diagnosis.lambda_min_estimate >= -1.0 / 14 - 1e-4);  // Ritz values lie inside the spectrum, floats aside
    CHECK_THAT(diagnosis.reason, Catch::Matchers::Contains("indefinite"));
}

TEST_CASE("too few iterations give what there is and say so", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(8, 6), 0.05, 2);
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Operator A = make_operator(shape, &options);
    lcl_solve_options solve = solve_options(LCL_SOLVER_PIA);
    solve.max_iterations = 1;
    const Solved solved(A.get(), shape.mesh.positions, solve);
    CHECK(solved.status == LCL_ERROR_NOT_CONVERGED);
    CHECK(solved.report.converged == 0);
    CHECK(solved.report.iterations == 1);
    CHECK_THAT(lcl_last_error(), Catch::Matchers::Contains("after 1 iteration"));
    CHECK(std::string(solved.report.message) == lcl_last_error());
    const oracle::History expected = oracle::pia(oracle::to_sparse(oracle_rows(shape, options)), matrix_of(shape.mesh.positions, 3), 1);
    CHECK(largest_difference(solved.P, values_of(expected.points)) <= 1e-6);
    CHECK(solved.report.max_error == Approx(expected.residuals[1]).epsilon(1e-5));
}

TEST_CASE("a solver that cannot converge says so instead of diverging", "[capi][solve]") {
    const shapes::Shape quads = shapes::rough(shapes::torus_quads(10, 8), 0.05, 2), darts = shapes::grid_with_creases();
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Operator A = make_operator(quads, &options), B = make_operator(darts, &options);
    const Solved jacobi(A.get(), quads.mesh.positions, solve_options(LCL_SOLVER_JACOBI));  // radius 5/4
    CHECK(jacobi.status == LCL_ERROR_NOT_CONVERGED);
    CHECK_THAT(lcl_last_error(), Catch::Matchers::Contains("Jacobi is sure to converge only under diagonal dominance"));
    CHECK(jacobi.report.iterations < 200);
    const Solved cg(B.get(), darts.mesh.positions, solve_options(LCL_SOLVER_CG));
    refuse(cg.status, LCL_ERROR_INVALID_ARGUMENT, "self-adjoint");
}

TEST_CASE("exactly so many sweeps are made and are a success", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::random_triangle_mesh(60, 4), 0.05, 2);
    const lcl_scheme_options options = scheme(LCL_SCHEME_LOOP);
    const Operator A = make_operator(shape, &options);
    const oracle::SparseMatrix rows = oracle::to_sparse(oracle_rows(shape, options));
    const Eigen::MatrixXd M = matrix_of(shape.mesh.positions, 3);
    const int sweeps = GENERATE(1, 10);
    const lcl_precision precision = GENERATE(LCL_PRECISION_DOUBLE, LCL_PRECISION_MIXED, LCL_PRECISION_SINGLE);
    const double eps = precision == LCL_PRECISION_DOUBLE ? 1e-14 : 1e-6;
    CAPTURE(sweeps, precision);
    const auto expect = [&](const lcl_solve_options& solve, const oracle::History& expected) {
        CAPTURE(solve.solver);
        const Solved solved(A.get(), shape.mesh.positions, solve);
        CHECK(solved.status == LCL_OK);
        CHECK(solved.report.converged == (solved.report.max_error <= 1e-6 * diagonal_of(shape)));
        CHECK(solved.report.iterations == sweeps);
        REQUIRE(solved.residuals.size() == expected.residuals.size());
        CHECK(largest_difference(solved.residuals, expected.residuals) <= eps * diagonal_of(shape));
        CHECK(largest_difference(solved.P, values_of(expected.points)) <= 10 * eps * diagonal_of(shape));
    };
    lcl_solve_options solve = solve_options(LCL_SOLVER_PIA, precision);
    solve.exact_sweeps = sweeps;
    expect(solve, oracle::pia(rows, M, sweeps));
    solve.solver = LCL_SOLVER_WPIA;
    solve.weight = 1.5;
    expect(solve, oracle::pia(rows, M, sweeps, 1.5));
    solve.solver = LCL_SOLVER_GS;
    expect(solve, oracle::gauss_seidel(rows, M, sweeps));
    solve.solver = LCL_SOLVER_JACOBI;
    expect(solve, oracle::jacobi(rows, M, sweeps));
}

TEST_CASE("residuals are written as far as there is room", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(8, 6), 0.05, 2);
    const Operator A = make_operator(shape);
    std::vector<double> P(shape.mesh.positions.size()), residuals(5, -1.0);
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    report.residuals = residuals.data();
    report.residual_capacity = 3;
    succeed(lcl_interpolate(A.get(), shape.mesh.positions.data(), 0, 3, nullptr, P.data(), 0, &report));
    CHECK(report.residual_count > 3);
    CHECK(report.residuals == residuals.data());
    CHECK(report.residual_capacity == 3);
    CHECK((residuals[2] >= 0 && residuals[3] == -1));
    CHECK((report.seconds_upload >= 0 && report.seconds_solve > 0 && report.seconds_download >= 0));
}

TEST_CASE("the tolerance refers to the model's size, or to the one that is given", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(8, 6), 0.05, 2);
    const Operator A = make_operator(shape);
    lcl_solve_options options = solve_options(LCL_SOLVER_PIA);
    Progress progress;
    options.progress = Progress::note;
    options.progress_user = &progress;
    options.tolerance = 1e-4;
    const Solved plain(A.get(), shape.mesh.positions, options);
    CHECK(plain.status == LCL_OK);
    CHECK(progress.target == Approx(1e-4 * diagonal_of(shape)));
    CHECK(progress.calls >= plain.report.iterations);
    CHECK(plain.residuals.back() <= 1e-4 * diagonal_of(shape));
    options.diagonal = 100;
    const Solved coarse(A.get(), shape.mesh.positions, options);
    CHECK(progress.target == Approx(1e-2));
    CHECK(coarse.report.iterations < plain.report.iterations);
}

TEST_CASE("a progress callback sees the residuals and can cancel", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(8, 6), 0.05, 2);
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Operator A = make_operator(shape, &options);
    const lcl_solver solver = GENERATE(LCL_SOLVER_PIA, LCL_SOLVER_GS, LCL_SOLVER_CHEBYSHEV, LCL_SOLVER_CG);
    CAPTURE(solver);
    Progress progress;
    progress.stop_at = 3;
    lcl_solve_options solve = solve_options(solver, LCL_PRECISION_DOUBLE);
    solve.progress = Progress::note;
    solve.progress_user = &progress;
    refuse(Solved(A.get(), shape.mesh.positions, solve).status, LCL_ERROR_CANCELLED, "cancelled after 3 iterations");
    REQUIRE(progress.residuals.size() >= 4);
    const double first = oracle::largest_row((Eigen::MatrixXd::Identity(48, 48) - oracle_rows(shape, options)) * matrix_of(shape.mesh.positions, 3));
    CHECK(progress.residuals[0] == Approx(first).epsilon(1e-12));
    progress.stop_at = -1;
    CHECK(Solved(A.get(), shape.mesh.positions, solve).status == LCL_OK);  // a cancelled solve leaves the operator usable
}

TEST_CASE("alpha auto is 0 where that is good enough and 0.5 where it is not", "[capi][operator][singular]") {
    const auto alpha_of = [](const shapes::Shape& shape, lcl_scheme which) {
        lcl_scheme_options options = scheme(which), in_use = LCL_SCHEME_OPTIONS_INIT;
        options.alpha_auto = 1;
        succeed(lcl_operator_get_scheme(make_operator(shape, &options).get(), &in_use));
        return in_use.alpha;
    };
    CHECK(alpha_of(shapes::cube(), LCL_SCHEME_CATMULL_CLARK) == 0.5);
    CHECK(alpha_of(shapes::cube_split_edges(), LCL_SCHEME_CATMULL_CLARK) == 0.5);
    CHECK(alpha_of(shapes::dual_of(shapes::icosphere(1)), LCL_SCHEME_CATMULL_CLARK) == 0.5);  // lambda_min about 0.03
    CHECK(alpha_of(shapes::torus_quads(8, 6), LCL_SCHEME_CATMULL_CLARK) == 0);
    CHECK(alpha_of(shapes::octahedron(), LCL_SCHEME_DEFAULT) == 0);
    lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    options.alpha_auto = 1;
    CHECK(Solved(make_operator(shapes::cube(), &options).get(), shapes::cube().mesh.positions, LCL_SOLVE_OPTIONS_INIT).status == LCL_OK);
}

TEST_CASE("the diagnosis bounds and estimates the smallest eigenvalue", "[capi][operator]") {
    for (const auto& [shape, options] : schemes_on_shapes()) {
        CAPTURE(shape.name, options.scheme);
        const Operator A = make_operator(shape, &options);
        lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
        succeed(lcl_operator_diagnose(A.get(), &diagnosis));
        CHECK(diagnosis.singular == 0);
        CHECK(diagnosis.indefinite == 0);
        CHECK(diagnosis.reason[0] == '\0');
        CHECK(diagnosis.vertex_count == 0);
        CHECK(std::isnan(diagnosis.lambda_min_bound) == has_darts(shape));
        CHECK(std::isnan(diagnosis.lambda_min_estimate) == has_darts(shape));
        if (has_darts(shape)) continue;
        const double lowest = oracle::lowest_eigenvalue(oracle_rows(shape, options));
        CHECK(diagnosis.lambda_min_bound <= lowest + 1e-12);
        CHECK(diagnosis.lambda_min_estimate >= diagnosis.lambda_min_bound);
        CHECK(std::abs(diagnosis.lambda_min_estimate - lowest) <= 0.1);  // 16 Lanczos steps; curves enter by their bound of 1/3
    }
    const lcl_scheme_options plain = scheme(LCL_SCHEME_CATMULL_CLARK);
    lcl_diagnosis cube = LCL_DIAGNOSIS_INIT;
    succeed(lcl_operator_diagnose(make_operator(shapes::cube(), &plain).get(), &cube));
    CHECK(cube.singular == 1);
    CHECK(cube.vertex_count == 8);
    CHECK(std::abs(cube.lambda_min_estimate) <= 1e-4);
    CHECK_THAT(cube.reason, Catch::Matchers::Contains("alpha 0.5"));
}

TEST_CASE("the inverse's norm and the bound of the surface's error hold", "[capi][operator][solve]") {
    for (const auto& [shape, options] : schemes_on_shapes()) {
        CAPTURE(shape.name, options.scheme);
        const Operator A = make_operator(shape, &options);
        double norm = 0;
        int32_t proven = -1;
        if (has_darts(shape)) {
            refuse(lcl_operator_inverse_norm(A.get(), &norm, &proven), LCL_ERROR_UNSUPPORTED, "dart");
            continue;
        }
        succeed(lcl_operator_inverse_norm(A.get(), &norm, &proven));
        succeed(lcl_operator_inverse_norm(A.get(), &norm, nullptr));
        const Eigen::MatrixXd rows = oracle_rows(shape, options);
        if (shape.features.corners.empty() && contains(shape.name, "random")) {  // closed: all is one smooth block
            const double exact = oracle::infinity_norm(rows.inverse());
            CHECK(norm >= (proven ? exact * (1 - 1e-12) : 0.9 * exact));  // an estimate lies below by a few percent as a rule
            if (!proven) CHECK(norm <= exact * 1.04);                     // 1.03 times a lower bound, from solves to 1e-4
        }
        lcl_solve_options solve = solve_options(LCL_SOLVER_AUTO);
        solve.certify = 1;
        solve.tolerance = 1e-5;
        const Solved solved(A.get(), shape.mesh.positions, solve);
        REQUIRE(solved.status == LCL_OK);
        const Eigen::MatrixXd exact_points = oracle::solve(rows, matrix_of(shape.mesh.positions, 3));
        CHECK(solved.report.surface_error_bound >= oracle::largest_row(matrix_of(solved.P, 3) - exact_points) * 0.999);
        CHECK(solved.report.surface_error_bound <= 200 * solved.report.max_error);
    }
}

TEST_CASE("the points of a mesh are replaced by its control points", "[capi][solve]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(8, 6), 0.05, 2);
    const Mesh mesh = make_mesh(shape), other = make_mesh(shapes::cube());
    const Operator A = make_operator(default_context(), mesh.get());
    refuse(lcl_interpolate_mesh(A.get(), other.get(), nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "the operator has 48 vertices, the mesh 8");
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    succeed(lcl_interpolate_mesh(A.get(), mesh.get(), nullptr, &report));
    CHECK(report.converged == 1);
    std::vector<double> P(shape.mesh.positions.size());
    succeed(lcl_mesh_get_points(mesh.get(), P.data(), 0));
    CHECK(P == Solved(A.get(), shape.mesh.positions, LCL_SOLVE_OPTIONS_INIT).P);
}

TEST_CASE("an operator with ghosts has rows for the owned vertices alone and is not solved as a whole", "[capi][operator]") {
    const shapes::Shape shape = shapes::torus_quads(8, 6);
    const std::vector<int32_t> owned{3, 4, 5, 11, 40};
    lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    options.owned = owned.data();
    options.owned_count = owned.size();
    const Operator A = make_operator(shape, &options), whole = make_operator(shape);
    CHECK(lcl_operator_vertex_count(A.get()) == 48);
    CHECK(lcl_operator_row_count(A.get()) == 5);
    CHECK(lcl_operator_row_count(whole.get()) == 48);
    std::size_t size = 0;
    succeed(lcl_operator_get_row(A.get(), 40, nullptr, nullptr, 0, &size));
    CHECK(size == 9);
    refuse(lcl_operator_get_row(A.get(), 6, nullptr, nullptr, 0, &size), LCL_ERROR_INVALID_ARGUMENT, "vertex 6 is a ghost");
    refuse(Solved(A.get(), shape.mesh.positions, LCL_SOLVE_OPTIONS_INIT).status, LCL_ERROR_UNSUPPORTED, "rows for 5 of its 48 vertices");
    std::vector<double> limit(shape.mesh.positions.size()), expected(limit.size());
    succeed(lcl_limit_points(A.get(), shape.mesh.positions.data(), 0, 3, LCL_PRECISION_DOUBLE, limit.data(), 0));
    succeed(lcl_limit_points(whole.get(), shape.mesh.positions.data(), 0, 3, LCL_PRECISION_DOUBLE, expected.data(), 0));
    for (int32_t v = 0; v < 48; ++v) {
        const bool is_owned = std::count(owned.begin(), owned.end(), v) > 0;
        const std::vector<double>& from = is_owned ? expected : shape.mesh.positions;  // ghosts stay
        for (int c = 0; c < 3; ++c) CHECK(limit[3 * v + c] == Approx(from[3 * v + c]).margin(1e-14));
    }
}

TEST_CASE("what does not fit the device is refused with the numbers", "[capi][field][device]") {
    const Operator A = make_operator(shapes::torus_quads(300, 300));
    lcl_device_info device = LCL_DEVICE_INFO_INIT;
    succeed(lcl_context_get_device(default_context(), &device));
    const uint64_t before = lcl_context_allocated_bytes(default_context()), a_channel = 90000 * sizeof(double);
    if (device.memory_bytes / a_channel > 100000) return;  // more buffers than a test should make
    lcl_field field = nullptr;
    refuse(lcl_field_create(A.get(), static_cast<int32_t>(device.memory_bytes / a_channel) + 100, LCL_PRECISION_DOUBLE, &field), LCL_ERROR_MEMORY,
           std::to_string(device.memory_bytes));
    CHECK(field == nullptr);
    CHECK(lcl_context_allocated_bytes(default_context()) == before);
}

TEST_CASE("solves run beside the caller, two contexts at once", "[capi][solve][async][thread]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(20, 16), 0.02, 2);
    const std::vector<double>& M = shape.mesh.positions;
    const Mesh mesh = make_mesh(shape);
    const Context first = open_context("0"), second = open_context(lcl_device_count() > 1 ? "1" : "0");
    Operator A = make_operator(first.get(), mesh.get()), B = make_operator(second.get(), mesh.get());
    std::vector<double> P(M.size()), Q(M.size());
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    lcl_task raw[2] = {nullptr, nullptr};
    {
        const lcl_solve_options options = solve_options(LCL_SOLVER_AUTO);  // copied before the call returns
        succeed(lcl_interpolate_async(A.get(), M.data(), 0, 3, &options, P.data(), 0, &report, &raw[0]));
        succeed(lcl_interpolate_async(B.get(), M.data(), 0, 3, &options, Q.data(), 0, nullptr, &raw[1]));
    }
    A.reset();  // the tasks keep what they need
    B.reset();
    const Task one(raw[0]), two(raw[1]);
    succeed(lcl_task_wait(one.get()));
    CHECK(lcl_task_is_done(one.get()) == 1);
    CHECK(report.converged == 1);
    for (int i = 0; i < 6000 && !lcl_task_is_done(two.get()); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK(lcl_task_is_done(two.get()) == 1);
    succeed(lcl_task_wait(two.get()));
    succeed(lcl_task_wait(two.get()));  // any number of times
    CHECK(P == Q);
    CHECK(P == Solved(make_operator(default_context(), mesh.get()).get(), M, LCL_SOLVE_OPTIONS_INIT).P);
}

TEST_CASE("a task carries status and sentence over to the thread that waits", "[capi][solve][async][thread]") {
    const Operator A = make_operator(shapes::cube()), B = make_operator(shapes::octahedron());
    const std::vector<double> M = shapes::cube().mesh.positions;
    std::vector<double> P(M.size());
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    lcl_task raw = nullptr;
    succeed(lcl_interpolate_async(A.get(), M.data(), 0, 3, nullptr, P.data(), 0, &report, &raw));
    const Task task(raw);
    refuse(lcl_mesh_validate(nullptr), LCL_ERROR_INVALID_ARGUMENT, "mesh is NULL");
    refuse(lcl_task_wait(task.get()), LCL_ERROR_SINGULAR, "alpha 0.5");
    CHECK(last_error_vertices().size() == 8);
    CHECK(report.vertex_count == 8);
    std::string elsewhere;
    std::thread([&] { lcl_task_wait(task.get()), elsewhere = lcl_last_error(); }).join();
    CHECK(elsewhere == lcl_last_error());

    succeed(lcl_interpolate_async(B.get(), nullptr, 0, 3, nullptr, P.data(), 0, nullptr, &raw));
    const Task wrong(raw);
    refuse(lcl_task_wait(wrong.get()), LCL_ERROR_INVALID_ARGUMENT, "M is NULL");
}

TEST_CASE("a task that is released is waited for", "[capi][solve][async][thread]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(20, 16), 0.02, 2);
    const Operator A = make_operator(shape);
    std::vector<double> P(shape.mesh.positions.size());
    lcl_task task = nullptr;
    succeed(lcl_interpolate_async(A.get(), shape.mesh.positions.data(), 0, 3, nullptr, P.data(), 0, nullptr, &task));
    lcl_task_release(task);
    CHECK(P == Solved(A.get(), shape.mesh.positions, LCL_SOLVE_OPTIONS_INIT).P);
}

TEST_CASE("a task can be cancelled by its progress callback", "[capi][solve][async][thread]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(20, 16), 0.02, 2);
    const Operator A = make_operator(shape);
    std::vector<double> P(shape.mesh.positions.size());
    Progress progress;
    progress.stop_at = 2;
    lcl_solve_options options = solve_options(LCL_SOLVER_PIA);
    options.progress = Progress::note;
    options.progress_user = &progress;
    lcl_task raw = nullptr;
    succeed(lcl_interpolate_async(A.get(), shape.mesh.positions.data(), 0, 3, &options, P.data(), 0, nullptr, &raw));
    const Task task(raw);
    refuse(lcl_task_wait(task.get()), LCL_ERROR_CANCELLED, "cancelled after 2 iterations");
    CHECK(std::is_sorted(progress.iterations.begin(), progress.iterations.end()));
    CHECK(progress.iterations.back() == 2);
}
