// SPDX-License-Identifier: BSD-3-Clause
// Local solves: against dense inverses and full solves, over many edits, and that the work stays where the edit is.
#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "host/apply/row_transfer.h"
#include "host/solve/local_region.h"
#include "limitcl/limitcl.hpp"
#include "tests/capi_support.h"
#include "tests/solver_support.h"

using namespace capi_test;

namespace {

constexpr double tolerance = 1e-6;  // the default

/// Rows of the operator, dense, in the caller's order.
Eigen::MatrixXd matrix_of(lcl_operator A) {
    const int32_t n = lcl_operator_vertex_count(A);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    std::vector<int32_t> columns(n);
    std::vector<double> weights(n);
    for (int32_t v = 0; v < n; ++v) {
        size_t size = 0;
        succeed(lcl_operator_get_row(A, v, columns.data(), weights.data(), columns.size(), &size));
        for (size_t k = 0; k < size; ++k) a(v, columns[k]) = weights[k];
    }
    return a;
}

/// A mesh whose points M are kept beside the device, with P solved for.
class Editing {
public:
    explicit Editing(const shapes::Shape& shape, const lcl_scheme_options* scheme = nullptr, lcl_precision precision = LCL_PRECISION_DOUBLE, int channels = 3)
        : channels_(channels),
          rows_(shape.mesh.vertex_count),
          diagonal_(diagonal_of(shape)),
          m_(with_channels(shape.mesh.positions, channels)),
          A_(make_operator(shape, scheme)),
          M_(make_field(A_.get(), m_, precision)),
          P_(make_field(A_.get(), channels, precision)) {
        succeed(lcl_interpolate_field(A_.get(), M_.get(), nullptr, P_.get(), nullptr));
    }

    lcl_operator A() const { return A_.get(); }
    lcl_field M() const { return M_.get(); }
    lcl_field P() const { return P_.get(); }
    int rows() const { return rows_; }
    double diagonal() const { return diagonal_; }

    /// New rows: the old ones moved by up to `amplitude` diagonals (further channels: by so many thousands).
    std::vector<double> moved(const std::vector<int32_t>& vertices, double amplitude, shapes::Random& random) const {
        std::vector<double> values;
        for (const int32_t v : vertices)
            for (int c = 0; c < channels_; ++c) values.push_back(m_[v * channels_ + c] + amplitude * (c < 3 ? diagonal_ : 1000) * random.symmetric());
        return values;
    }

    lcl_solve_report edit(const std::vector<int32_t>& vertices, const std::vector<double>& values, const lcl_solve_options* options = nullptr) {
        lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
        succeed(lcl_solve_local(A_.get(), M_.get(), P_.get(), vertices.data(), vertices.size(), values.data(), options, &report));
        for (size_t i = 0; i < vertices.size(); ++i) std::copy_n(&values[i * channels_], channels_, &m_[vertices[i] * channels_]);
        CHECK(report.converged);
        return report;
    }

    std::vector<double> points() const { return download(P_.get(), rows_); }

    /// M on the device is what was given, to the field's rounding; the residual of all rows, in double.
    double residual() const {
        const std::vector<double> p = points(), m = download(M_.get(), rows_);
        std::vector<double> limit(p.size());
        succeed(lcl_limit_points(A_.get(), p.data(), 0, channels_, LCL_PRECISION_DOUBLE, limit.data(), 0));
        CHECK(largest_difference(m, m_) <= 4 * 6e-8 * 1000);
        double worst = 0;
        for (int v = 0; v < rows_; ++v) {
            double square = 0;
            for (int c = 0; c < std::min(channels_, 3); ++c) square += std::pow(m[v * channels_ + c] - limit[v * channels_ + c], 2);
            worst = std::max(worst, std::sqrt(square));
        }
        return worst;
    }

    /// The distance to the solution of a full solve in double to 1e-13, Euclidean over the position.
    double error() const {
        lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
        options.tolerance = 1e-13;
        options.max_iterations = 3000;
        const std::vector<double> p = points(), m = download(M_.get(), rows_);
        std::vector<double> exact(m.size());
        succeed(lcl_interpolate(A_.get(), m.data(), 0, channels_, &options, exact.data(), 0, nullptr));
        double worst = 0;
        for (int v = 0; v < rows_; ++v) {
            double square = 0;
            for (int c = 0; c < std::min(channels_, 3); ++c) square += std::pow(p[v * channels_ + c] - exact[v * channels_ + c], 2);
            worst = std::max(worst, std::sqrt(square));
        }
        return worst;
    }

private:
    int channels_, rows_;
    double diagonal_;
    std::vector<double> m_;
    Operator A_;
    FieldHandle M_, P_;
};

struct Case {
    std::string name;
    shapes::Shape shape;
    lcl_scheme_options scheme;
};

/// Every kind of row beside every other; lists of vertices live as long as the program.
std::vector<Case> cases() {
    static const std::vector<int32_t> subset{0, 1, 2, 3, 9, 10, 11, 18, 19, 27, 30, 31, 32, 33, 40, 41, 42, 50, 51};
    static const std::vector<double> ratios = [] {
        std::vector<double> values(63);
        for (size_t v = 0; v < values.size(); ++v) values[v] = static_cast<double>(v % 6) * 0.2;  // 1 among them: fixed
        return values;
    }();
    lcl_scheme_options with_subset = scheme(LCL_SCHEME_CATMULL_CLARK), with_ratios = with_subset;
    with_subset.subset = subset.data();
    with_subset.subset_count = subset.size();
    with_ratios.lambda_per_vertex = ratios.data();
    return {{"closed quads", shapes::rough(shapes::icosphere_quads(1), 0.02, 1), scheme(LCL_SCHEME_CATMULL_CLARK)},
            {"alpha", shapes::rough(shapes::icosphere_quads(1), 0.02, 1), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5)},
            {"boundary", shapes::rough(shapes::grid_with_hole(), 0.1, 2), scheme(LCL_SCHEME_CATMULL_CLARK)},
            {"creases, corners, darts and an isolated vertex", shapes::with_isolated_vertex(shapes::rough(shapes::grid_with_creases(), 0.1, 3), 20),
             scheme(LCL_SCHEME_CATMULL_CLARK, 0.3)},
            {"dart", shapes::rough(shapes::torus_with_dart(), 0.05, 4), scheme(LCL_SCHEME_CATMULL_CLARK)},
            {"Loop", shapes::rough(shapes::random_triangle_mesh(80, 2), 0.02, 5), scheme(LCL_SCHEME_LOOP)},
            {"Loop with creases", shapes::rough(shapes::grid_triangles_with_creases(), 0.1, 6), scheme(LCL_SCHEME_LOOP)},
            {"Loop with a dart", shapes::rough(shapes::torus_triangles_with_dart(), 0.05, 7), scheme(LCL_SCHEME_LOOP)},
            {"Doo-Sabin", shapes::rough(shapes::polygons_mixed(90, 3), 0.02, 8), scheme(LCL_SCHEME_DOO_SABIN)},
            {"Doo-Sabin with creases", shapes::rough(shapes::grid_with_creases(), 0.1, 9), scheme(LCL_SCHEME_DOO_SABIN)},
            {"polygons", shapes::rough(shapes::polygons_mixed(90, 5), 0.02, 10), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5)},
            {"two-phase", shapes::rough(shapes::torus_quads(9, 7), 0.05, 11), scheme(LCL_SCHEME_CATMULL_CLARK, 0, 1.0 / 3)},
            {"one ratio a vertex", shapes::rough(shapes::torus_quads(9, 7), 0.05, 12), with_ratios},
            {"subset", shapes::rough(shapes::torus_quads(9, 7), 0.05, 13), with_subset}};
}

/// Different vertices.
std::vector<int32_t> some_vertices(int count, int rows, shapes::Random& random) {
    std::set<int32_t> chosen;
    while (static_cast<int>(chosen.size()) < std::min(count, rows)) chosen.insert(random.below(rows));
    return {chosen.begin(), chosen.end()};
}

}  // namespace

TEST_CASE("a local solve meets the tolerance in every row, and the bound that follows, whatever is moved", "[local][capi]") {
    for (const Case& c : cases())
        for (const lcl_precision precision : {LCL_PRECISION_DOUBLE, LCL_PRECISION_MIXED}) {
            CAPTURE(c.name, precision);
            Editing editing(c.shape, &c.scheme, precision);
            const double inverse_norm = oracle::infinity_norm(matrix_of(editing.A()).inverse()), limit = tolerance * editing.diagonal() * (1 + 1e-9);
            shapes::Random random(21);
            for (int32_t v = 0; v < editing.rows(); v += 1 + editing.rows() / 40) {
                const lcl_solve_report report = editing.edit({v}, editing.moved({v}, 0.1, random));
                CHECK(report.max_error <= limit);
                CHECK(report.residual_count == static_cast<size_t>(report.iterations) + 1);
                CHECK(report.solver == LCL_SOLVER_GS);
            }
            CHECK(editing.residual() <= limit);
            CHECK(editing.error() <= inverse_norm * limit);
            const std::vector<int32_t> several = some_vertices(12, editing.rows(), random);
            editing.edit(several, editing.moved(several, 0.01, random));
            CHECK(editing.residual() <= limit);
            CHECK(editing.error() <= inverse_norm * limit);
        }
}

TEST_CASE("rows that keep their points take the new ones to the bit, however small the move", "[local][capi]") {
    for (const lcl_precision precision : {LCL_PRECISION_DOUBLE, LCL_PRECISION_MIXED}) {
        Editing editing(shapes::with_isolated_vertex(shapes::rough(shapes::grid_with_creases(), 0.1, 3), 20), nullptr, precision);
        shapes::Random random(2);
        const Eigen::MatrixXd a = matrix_of(editing.A());
        int fixed_rows = 0;
        for (const double amplitude : {0.1, 1e-9}) {
            std::vector<int32_t> vertices(editing.rows());
            std::iota(vertices.begin(), vertices.end(), 0);
            const lcl_solve_report report = editing.edit(vertices, editing.moved(vertices, amplitude, random));
            CHECK(report.max_error == Approx(editing.residual()).epsilon(1e-6));  // of the values as the fields hold them
            const std::vector<double> m = download(editing.M(), editing.rows()), p = editing.points();
            for (int v = 0; v < editing.rows(); ++v) {
                if (a(v, v) != 1) continue;
                ++fixed_rows;
                for (int c = 0; c < 3; ++c) CHECK(p[3 * v + c] == m[3 * v + c]);
            }
        }
        CHECK(fixed_rows > 8);
    }
}

TEST_CASE("only the surroundings of an edit change, the rest to the bit", "[local][capi]") {
    const int around = 120, along = 110;
    const lcl_precision precision = GENERATE(LCL_PRECISION_DOUBLE, LCL_PRECISION_MIXED);
    Editing editing(shapes::rough(shapes::torus_quads(around, along), 0.002, 1), nullptr, precision);
    const std::vector<double> before = editing.points();
    const int32_t edited = 50 * around + 60;
    shapes::Random random(3);
    const lcl_solve_report report = editing.edit({edited}, editing.moved({edited}, 0.01, random));
    const std::vector<double> after = editing.points();
    std::set<int> changed;
    for (size_t i = 0; i < after.size(); ++i)
        if (after[i] != before[i]) changed.insert(static_cast<int>(i / 3));
    CHECK(changed.count(edited) == 1);
    CHECK(static_cast<int>(changed.size()) <= report.changed_rows);
    CHECK(report.changed_rows < 15 * 15);
    int farthest = 0;
    for (const int v : changed) farthest = std::max({farthest, std::abs(v % around - edited % around), std::abs(v / around - edited / around)});
    CHECK(farthest <= 7);
    CHECK(editing.residual() <= tolerance * editing.diagonal() * (1 + 1e-9));
}

TEST_CASE("errors of many edits do not add up", "[local][capi]") {
    const lcl_precision precision = GENERATE(LCL_PRECISION_DOUBLE, LCL_PRECISION_MIXED);
    Editing editing(shapes::rough(shapes::icosphere_quads(2), 0.01, 1), nullptr, precision);
    const double inverse_norm = oracle::infinity_norm(matrix_of(editing.A()).inverse()), limit = tolerance * editing.diagonal() * (1 + 1e-9);
    shapes::Random random(5);
    for (int i = 0; i < 400; ++i) {
        const std::vector<int32_t> vertices = some_vertices(1 + random.below(4), i % 2 ? editing.rows() : 20, random);  // again and again the same
        editing.edit(vertices, editing.moved(vertices, 0.003, random));
        if (i % 50 == 49) CHECK(editing.residual() <= limit);
    }
    CHECK(editing.error() <= inverse_norm * limit);
}

TEST_CASE("a sequence of edits gives what one solve of all gives, to the bound", "[local][capi]") {
    const shapes::Shape shape = shapes::rough(shapes::icosphere_quads(2), 0.01, 1);
    Editing one_by_one(shape), together(shape);
    const double inverse_norm = oracle::infinity_norm(matrix_of(together.A()).inverse());
    shapes::Random random(6);
    const std::vector<int32_t> vertices = some_vertices(60, together.rows(), random);
    const std::vector<double> values = together.moved(vertices, 0.02, random);
    together.edit(vertices, values);
    for (size_t i = 0; i < vertices.size(); ++i) one_by_one.edit({vertices[i]}, {values[3 * i], values[3 * i + 1], values[3 * i + 2]});
    CHECK(download(one_by_one.M(), together.rows()) == download(together.M(), together.rows()));
    CHECK(largest_difference(one_by_one.points(), together.points()) <= 2 * inverse_norm * tolerance * together.diagonal());
}

TEST_CASE("the full solve takes over where many vertices are moved", "[local][capi]") {
    Editing editing(shapes::rough(shapes::torus_quads(120, 110), 0.002, 1));
    std::vector<int32_t> vertices(editing.rows());
    std::iota(vertices.begin(), vertices.end(), 0);
    shapes::Random random(7);
    const lcl_solve_report all = editing.edit(vertices, editing.moved(vertices, 0.01, random));
    CHECK(all.changed_rows == editing.rows());
    CHECK(all.solver == LCL_SOLVER_CHEBYSHEV);
    CHECK(editing.residual() <= tolerance * editing.diagonal() * (1 + 1e-9));
    const lcl_solve_report one = editing.edit({5}, editing.moved({5}, 0.01, random));
    CHECK(one.changed_rows < 200);
    CHECK(editing.residual() <= tolerance * editing.diagonal() * (1 + 1e-9));
}

TEST_CASE("the full solve takes over where the operator is nearly singular", "[local][capi]") {
    for (const int levels : {3, 4}) {  // too many sweeps, too many rows
        const shapes::Shape shape = shapes::rough(shapes::dual_of(shapes::icosphere(levels)), 0.001, 1);
        CAPTURE(shape.mesh.vertex_count);
        Editing editing(shape);
        shapes::Random random(1);
        const std::vector<double> value = editing.moved({7}, 0.01, random);
        const lcl_solve_report report = editing.edit({7}, value);
        CHECK(report.changed_rows == editing.rows());
        CHECK(report.solver == LCL_SOLVER_CG);
        CHECK(editing.residual() <= tolerance * editing.diagonal() * (1 + 1e-9));
    }
}

TEST_CASE("a local solve goes on where P was no solution", "[local][capi]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(120, 110), 0.01, 1);
    const Operator A = make_operator(shape);
    const FieldHandle M = make_field(A.get(), shape.mesh.positions), P = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_DOUBLE, M.get());
    const int32_t vertex = 77;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    succeed(lcl_solve_local(A.get(), M.get(), P.get(), &vertex, 1, &shape.mesh.positions[3 * vertex], nullptr, &report));
    CHECK(report.changed_rows == shape.mesh.vertex_count);
    std::vector<double> exact(shape.mesh.positions.size());
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.tolerance = 1e-12;
    succeed(lcl_interpolate(A.get(), shape.mesh.positions.data(), 0, 3, &options, exact.data(), 0, nullptr));
    CHECK(largest_difference(download(P.get(), shape.mesh.vertex_count), exact) <= 15 * tolerance * diagonal_of(shape));
}

TEST_CASE("nothing moves where nothing is to be done", "[local][capi]") {
    Editing editing(shapes::rough(shapes::torus_quads(9, 7), 0.05, 2));
    const std::vector<double> before = editing.points(), m = download(editing.M(), editing.rows());
    CHECK(editing.edit({}, {}).changed_rows == 0);
    const lcl_solve_report report = editing.edit({4}, {m[12], m[13], m[14]});
    CHECK(report.changed_rows == 0);
    CHECK(report.iterations == 0);
    CHECK(editing.points() == before);
}

TEST_CASE("local solves carry 1 to 9 channels", "[local][capi][channels]") {
    const shapes::Shape shape = shapes::rough(shapes::grid_with_creases(), 0.1, 3);
    for (int channels = 1; channels <= 9; ++channels) {
        const lcl_precision precision = channels % 2 ? LCL_PRECISION_DOUBLE : LCL_PRECISION_MIXED;
        CAPTURE(channels);
        Editing editing(shape, nullptr, precision, channels);
        shapes::Random random(channels);
        const std::vector<int32_t> vertices{0, 10, 24, 31};
        const lcl_solve_report report = editing.edit(vertices, editing.moved(vertices, 0.05, random));
        CHECK(report.solver == LCL_SOLVER_GS);
        CHECK(report.channel_error <= tolerance);
        CHECK((report.channel_error > 0) == (channels > 3));
        const std::vector<double> p = editing.points(), m = download(editing.M(), editing.rows());
        const double inverse_norm = oracle::infinity_norm(matrix_of(editing.A()).inverse());
        const Eigen::MatrixXd exact =
            oracle::solve(matrix_of(editing.A()), Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(m.data(), editing.rows(), channels));
        for (int c = 0; c < channels; ++c) {
            double worst = 0, low = m[c], high = m[c];
            for (int v = 0; v < editing.rows(); ++v) {
                worst = std::max(worst, std::abs(p[v * channels + c] - exact(v, c)));
                low = std::min(low, m[v * channels + c]), high = std::max(high, m[v * channels + c]);
            }
            CHECK(worst <= inverse_norm * tolerance * (c < 3 ? editing.diagonal() : high - low) * 1.1);  // ranges are those of the first upload
        }
    }
}

TEST_CASE("options of a local solve are respected", "[local][capi]") {
    Editing editing(shapes::rough(shapes::icosphere_quads(2), 0.01, 1));
    shapes::Random random(8);
    const std::vector<double> moved = editing.moved({3}, 0.02, random);
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.solver = LCL_SOLVER_GS;
    options.tolerance = 1e-3;
    const lcl_solve_report coarse = editing.edit({3}, moved, &options);
    options.tolerance = 1e-5;
    options.diagonal = 0.01 * editing.diagonal();
    const lcl_solve_report fine = editing.edit({3}, moved, &options);
    CHECK(coarse.max_error > 1e-6 * editing.diagonal());
    CHECK(fine.max_error <= 1e-7 * editing.diagonal());
    CHECK(editing.residual() <= 1e-7 * editing.diagonal() * (1 + 1e-9));

    options = LCL_SOLVE_OPTIONS_INIT;
    options.max_iterations = 2;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    const int32_t vertex = 9;
    const std::vector<double> value = editing.moved({vertex}, 0.05, random);
    refuse(lcl_solve_local(editing.A(), editing.M(), editing.P(), &vertex, 1, value.data(), &options, &report), LCL_ERROR_NOT_CONVERGED,
           "the tolerance was not reached after 2 iterations");
    CHECK(report.iterations == 2);
    CHECK(!report.converged);
    CHECK(report.max_error > tolerance * editing.diagonal());
    editing.edit({vertex}, value);  // goes on from there
    CHECK(editing.residual() <= tolerance * editing.diagonal() * (1 + 1e-9));
}

TEST_CASE("floats that cannot hold a tolerance are named", "[local][capi]") {
    Editing editing(shapes::rough(shapes::icosphere_quads(2), 0.01, 1), nullptr, LCL_PRECISION_SINGLE);
    shapes::Random random(9);
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.tolerance = 1e-12;
    const int32_t vertex = 9;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    lcl_solve_local(editing.A(), editing.M(), editing.P(), &vertex, 1, editing.moved({vertex}, 0.05, random).data(), &options, &report);
    CHECK(!report.converged);
    CHECK_THAT(report.message, Catch::Matchers::Contains("the values are kept in float"));
    CHECK(report.max_error < 1e-6 * editing.diagonal());
}

TEST_CASE("a local solve that is cancelled leaves both fields as they were", "[local][capi]") {
    struct Calls {
        int count = 0, stop_at = 0;
        double residual = 0, target = 0;
        static int32_t note(void* user, int32_t iteration, double residual, double target) {
            auto& own = *static_cast<Calls*>(user);
            CHECK(iteration == own.count);
            own.residual = residual, own.target = target;
            return ++own.count <= own.stop_at;
        }
    } calls;
    Editing editing(shapes::rough(shapes::icosphere_quads(2), 0.01, 1));
    const std::vector<double> m = download(editing.M(), editing.rows()), p = editing.points();
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.progress = Calls::note;
    options.progress_user = &calls;
    calls.stop_at = 2;
    const int32_t vertex = 1;
    shapes::Random random(10);
    const std::vector<double> value = editing.moved({vertex}, 0.05, random);
    refuse(lcl_solve_local(editing.A(), editing.M(), editing.P(), &vertex, 1, value.data(), &options, nullptr), LCL_ERROR_CANCELLED, "after 2 iterations");
    CHECK(download(editing.M(), editing.rows()) == m);
    CHECK(editing.points() == p);
    calls = {};
    calls.stop_at = 1000;
    const lcl_solve_report report = editing.edit({vertex}, value, &options);
    CHECK(calls.count == report.iterations + 1);
    CHECK(calls.residual == Approx(report.max_error));
    CHECK(calls.target == Approx(tolerance * editing.diagonal()));
}

TEST_CASE("singular and indefinite operators give the answers of the full solve", "[local][capi]") {
    for (const shapes::Shape& shape : {shapes::cube(), shapes::cube_split_edges()}) {
        CAPTURE(shape.name);
        const Operator A = make_operator(shape);
        const FieldHandle M = make_field(A.get(), shape.mesh.positions), P = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_DOUBLE, M.get());
        lcl_solve_report full = LCL_SOLVE_REPORT_INIT, local = LCL_SOLVE_REPORT_INIT;
        const lcl_status expected = lcl_interpolate_field(A.get(), M.get(), nullptr, P.get(), &full);
        const int32_t vertex = 2;
        const double value[] = {1, 2, 3};
        CHECK(lcl_solve_local(A.get(), M.get(), P.get(), &vertex, 1, value, nullptr, &local) == expected);
        CHECK((expected == LCL_ERROR_SINGULAR || expected == LCL_ERROR_INDEFINITE));
        CHECK(std::string(local.message) == full.message);
        CHECK(download(M.get(), shape.mesh.vertex_count)[8] == Approx(3));
    }
}

TEST_CASE("wrong arguments of a local solve are refused and change nothing", "[local][capi]") {
    const shapes::Shape shape = shapes::torus_quads(9, 7);
    Editing editing(shape), other(shape);
    const std::vector<double> m = download(editing.M(), editing.rows()), p = editing.points();
    std::vector<int32_t> vertices{4, 63};
    std::vector<double> values(6, 0.5);
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    const auto solve = [&](lcl_field M, lcl_field P) { return lcl_solve_local(editing.A(), M, P, vertices.data(), 2, values.data(), &options, nullptr); };
    const auto refused = [&](lcl_field M, lcl_field P, const std::string& part, lcl_status status = LCL_ERROR_INVALID_ARGUMENT) {
        refuse(solve(M, P), status, part);
    };
    refused(editing.M(), editing.P(), "vertex 63 was given, the field has 63");
    CHECK(last_error_vertices() == std::vector<int32_t>{63});
    vertices = {-1, 4};
    refused(editing.M(), editing.P(), "vertex -1 was given");
    vertices = {4, 4};
    refused(editing.M(), editing.P(), "vertex 4 was given twice");
    CHECK(last_error_vertices() == std::vector<int32_t>{4});
    vertices = {4, 5};
    values[4] = std::numeric_limits<double>::quiet_NaN();
    refused(editing.M(), editing.P(), "values of vertex 5 is nan in channel 1", LCL_ERROR_BAD_INPUT);
    values[4] = std::numeric_limits<double>::infinity();
    refused(editing.M(), editing.P(), "values of vertex 5 is inf in channel 1", LCL_ERROR_BAD_INPUT);
    values[4] = 0.5;
    refused(nullptr, editing.P(), "M is NULL");
    refused(editing.M(), nullptr, "P is NULL");
    refused(editing.M(), editing.M(), "the same field");
    refused(other.M(), editing.P(), "fields of another operator");
    refused(editing.M(), other.P(), "fields of another operator");
    const FieldHandle empty = make_field(editing.A()), two = make_field(editing.A(), 2), floats = make_field(editing.A(), m, LCL_PRECISION_SINGLE);
    refused(empty.get(), editing.P(), "holds no values yet");
    refused(editing.M(), two.get(), "differ in channels or precision");
    refused(editing.M(), floats.get(), "differ in channels or precision");
    refused(editing.M(), empty.get(), "kept in another centre and scale");
    const FieldHandle float_points = make_field(editing.A(), m, LCL_PRECISION_SINGLE, floats.get());
    values[4] = 1e300;
    refused(floats.get(), float_points.get(), "vertex 5 in channel 1", LCL_ERROR_BAD_INPUT);
    values[4] = 0.5;
    options.precision = LCL_PRECISION_DOUBLE;
    refused(floats.get(), float_points.get(), "the fields hold floats");
    options = LCL_SOLVE_OPTIONS_INIT;
    options.solver = LCL_SOLVER_CG;
    refused(editing.M(), editing.P(), "options.solver is 7, a local solve takes 0 (auto) or 4 (GS)");
    options = LCL_SOLVE_OPTIONS_INIT;
    options.exact_sweeps = 3;
    refused(editing.M(), editing.P(), "options.exact_sweeps");
    options = LCL_SOLVE_OPTIONS_INIT;
    options.tolerance = -1;
    refused(editing.M(), editing.P(), "options.tolerance");
    options = LCL_SOLVE_OPTIONS_INIT;
    refuse(lcl_solve_local(nullptr, editing.M(), editing.P(), vertices.data(), 2, values.data(), nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "A is NULL");
    refuse(lcl_solve_local(editing.A(), editing.M(), editing.P(), nullptr, 2, values.data(), nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "vertices is NULL");
    refuse(lcl_solve_local(editing.A(), editing.M(), editing.P(), vertices.data(), 2, nullptr, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "values is NULL");
    CHECK(download(editing.M(), editing.rows()) == m);
    CHECK(editing.points() == p);
}

TEST_CASE("operators with ghosts have no local solve", "[local][capi]") {
    const shapes::Shape shape = shapes::torus_quads(9, 7);
    const std::vector<int32_t> owned{0, 1, 2, 3};
    lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    options.owned = owned.data();
    options.owned_count = owned.size();
    const Operator A = make_operator(shape, &options);
    const FieldHandle M = make_field(A.get(), shape.mesh.positions), P = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_DOUBLE, M.get());
    const int32_t vertex = 2;
    const double value[] = {1, 2, 3};
    refuse(lcl_solve_local(A.get(), M.get(), P.get(), &vertex, 1, value, nullptr, nullptr), LCL_ERROR_UNSUPPORTED, "this operator has rows for 4 of its 63");
    CHECK(download(M.get(), shape.mesh.vertex_count) == download(P.get(), shape.mesh.vertex_count));
}

TEST_CASE("the C++ API solves locally", "[local][cpp]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(9, 7), 0.05, 2);
    const MeshArrays arrays(shape.mesh);
    const limitcl::Context context;
    const limitcl::LimitOperator A(context, limitcl::Mesh::from_faces(shape.mesh.positions, arrays.degrees, arrays.vertices));
    limitcl::Field M(A), P(A);
    M.upload(shape.mesh.positions);
    interpolate(A, M, P).require_ok();
    const std::int32_t vertex[] = {7};
    const double point[] = {0.5, 0.25, 1};
    const limitcl::SolveReport report = solve_local(A, M, P, vertex, point);
    report.require_ok();
    CHECK(report.changed_rows > 1);
    CHECK(report.changed_rows <= shape.mesh.vertex_count);
    CHECK(M.read_vertices(vertex)[2] == Approx(1).margin(1e-6));
    CHECK(A.limit_points(P.download())[3 * 7] == Approx(0.5).margin(1e-5));
    CHECK_THROWS_AS(solve_local(A, M, P, vertex, {}), limitcl::Error);
}

TEST_CASE("open rows of a region know every row that reads them", "[local]") {
    for (const shapes::Shape& shape : shapes::all_shapes())
        for (const solver_test::NamedScheme& scheme : solver_test::all_schemes()) {
            if (!solver_test::suits(shape, scheme.options)) continue;
            const solver_test::Prepared mesh(shape);
            INFO(shape.name << ", " << scheme.name);
            const lcl::Plan plan = mesh.plan(scheme.options);
            const Eigen::MatrixXd a = solver_test::matrix_of(plan);
            lcl::LocalRegion region(plan);
            for (const std::vector<lcl::Index>& rows : {std::vector<lcl::Index>{plan.row_count - 1}, {0, plan.row_count / 2}}) {  // twice: clean between uses
                region.start(rows);
                CHECK(region.reached().size() == (rows.front() == rows.back() ? 1 : rows.size()));
                for (int ring = 0; ring < 3; ++ring) region.open_all();
                double difference = 0;
                for (const lcl::Index local : region.reached()) {
                    const lcl::Index v = plan.vertex_of_row[region.rows()[local]];
                    Eigen::VectorXd row = a.row(v), column = a.col(v);
                    for (const auto& entry : region.row(local)) row[plan.vertex_of_row[region.rows()[entry.other]]] -= entry.weight;
                    difference = std::max(difference, row.cwiseAbs().maxCoeff());
                    if (!region.is_open(local)) continue;
                    const auto subtract = [&](lcl::Index reader, double scaled) {
                        column[plan.vertex_of_row[region.rows()[reader]]] -= scaled / region.scaling(reader);
                    };
                    for (const auto& entry : region.mirrored(local)) subtract(entry.other, entry.weight * region.scaling(local));
                    for (const auto& entry : region.irregular_readers(local)) subtract(entry.other, entry.weight);
                    difference = std::max(difference, column.cwiseAbs().maxCoeff());
                }
                CHECK(difference <= 1e-14);
            }
        }
}

TEST_CASE("single rows of fields travel to the bit", "[local][kernel][tiny]") {
    for (const int channels : {1, 2, 3, 7, 11})
        for (const lcl::Real real : {lcl::Real::single, lcl::Real::full}) {
            if (real == lcl::Real::full && !solver_test::device_context()->device().has_double) continue;
            CAPTURE(channels, static_cast<int>(real));
            const lcl::Index rows = 150;
            lcl::Field x(solver_test::device_context(), rows, channels, real), y(solver_test::device_context(), rows, channels, real);
            const Eigen::MatrixXd values = solver_test::rough_values(channels, rows, 1), others = solver_test::rough_values(channels, rows, 2);
            x.upload(values.data(), 0, rows);
            y.upload(others.data(), 0, rows);
            std::vector<double> x_values(values.size()), y_values(values.size()), expected, found, sent;
            x.download(x_values.data(), 0, rows);
            y.download(y_values.data(), 0, rows);
            const std::vector<lcl::Index> of_x{149, 0, 7, 64}, of_y{3, 2, 149};
            for (const lcl::Index row : of_x) expected.insert(expected.end(), &x_values[row * channels], &x_values[row * channels] + channels);
            for (const lcl::Index row : of_y) expected.insert(expected.end(), &y_values[row * channels], &y_values[row * channels] + channels);
            lcl::RowTransfer transfer(solver_test::device_context());
            transfer.read({{&x, &of_x}, {&y, &of_y}}, found);
            CHECK(found == expected);
            transfer.write({{&y, &of_x}}, found);
            for (size_t i = 0; i < of_x.size(); ++i) std::copy_n(&found[i * channels], channels, &y_values[of_x[i] * channels]);
            std::vector<double> now(y_values.size());
            y.download(now.data(), 0, rows);
            CHECK(now == y_values);
            const std::vector<lcl::Index> none;
            transfer.read({{&x, &none}, {&y, &none}}, found);
            CHECK(found.empty());
        }
}

TEST_CASE("the staging memory of single rows grows with their number and width", "[local][kernel]") {
    const lcl::Index rows = 9000;
    std::vector<lcl::Index> some(20), all(rows);
    std::iota(some.begin(), some.end(), 70);
    std::iota(all.rbegin(), all.rend(), 0);
    lcl::RowTransfer transfer(solver_test::device_context());
    for (const int channels : {2, 11, 3}) {
        const lcl::Real real = solver_test::device_context()->device().has_double ? lcl::Real::full : lcl::Real::single;
        lcl::Field x(solver_test::device_context(), rows, channels, real);
        std::vector<double> values(static_cast<size_t>(rows) * channels), found;
        for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i % 65521);
        x.upload(values.data(), 0, rows);
        for (const std::vector<lcl::Index>* list : {&some, &all, &some}) {
            transfer.read({{&x, list}}, found);
            REQUIRE(found.size() == list->size() * channels);
            bool is_same = true;
            for (size_t i = 0; i < found.size(); ++i)
                is_same = is_same && found[i] == values[(*list)[i / channels] * static_cast<size_t>(channels) + i % channels];
            CHECK(is_same);
        }
    }
}
