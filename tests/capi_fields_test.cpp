// SPDX-License-Identifier: BSD-3-Clause
// Fields through the C API: values that stay on the device, single sweeps from which a caller builds solvers, and solves on them.
#include <limits>
#include <numeric>

#include "tests/capi_support.h"
#include "tests/oracle/dense.h"

using namespace capi_test;

namespace {

constexpr double eps = 2.2e-16;
constexpr double float_eps = 6e-8;

/// A boundary, corners, a crease that ends inside (weighted rows), an isolated vertex.
shapes::Shape patchwork() { return shapes::with_isolated_vertex(shapes::rough(shapes::grid_with_creases(), 0.1, 3), 20); }

shapes::Shape torus() { return shapes::rough(shapes::torus_quads(9, 7), 0.05, 2); }

/// One sweep over all blocks.
double step(lcl_operator A, double a, double b, double c, const FieldHandle& M, const FieldHandle& x, const FieldHandle* d, const FieldHandle& y) {
    double residual = -1;
    succeed(lcl_operator_step(A, a, b, c, M.get(), x.get(), d ? d->get() : nullptr, y.get(), 0, -1, &residual));
    return residual;
}

std::vector<double> limit_of(lcl_operator A, const std::vector<double>& values, int channels) {
    std::vector<double> out(values.size());
    succeed(lcl_limit_points(A, values.data(), 0, channels, LCL_PRECISION_DOUBLE, out.data(), 0));
    return out;
}

/// a x + b y
std::vector<double> sum(double a, const std::vector<double>& x, double b, const std::vector<double>& y) {
    std::vector<double> out(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = a * x[i] + b * y[i];
    return out;
}

}  // namespace

TEST_CASE("what is uploaded comes back, for 1 to 9 channels, each type and any stride", "[capi][field]") {
    const shapes::Shape shape = patchwork();
    const Operator A = make_operator(shape);
    const std::size_t rows = shape.mesh.vertex_count;
    for (int channels = 1; channels <= 9; ++channels) {
        const lcl_precision precision = channels % 2 ? LCL_PRECISION_DOUBLE : LCL_PRECISION_SINGLE;
        const double bound = (precision == LCL_PRECISION_DOUBLE ? 8 * eps : 4 * float_eps) * 1000;  // values up to 1000
        CAPTURE(channels, precision);
        const std::vector<double> values = with_channels(shape.mesh.positions, channels);
        const FieldHandle field = make_field(A.get(), channels, precision);
        CHECK(lcl_field_channels(field.get()) == channels);
        const std::size_t stride = channels + 3;
        std::vector<double> wide(rows * stride, 77.0), out(rows * stride, -1.0);
        std::vector<float> narrow(rows * stride, 77.0f), narrow_out(rows * stride, -1.0f);
        for (std::size_t i = 0; i < values.size(); ++i) {
            wide[i / channels * stride + i % channels] = values[i];
            narrow[i / channels * stride + i % channels] = static_cast<float>(values[i]);
        }
        succeed(lcl_field_upload(field.get(), wide.data(), LCL_TYPE_DOUBLE, stride));
        std::fill(wide.begin(), wide.end(), 0.0);  // may be changed at once
        succeed(lcl_field_download(field.get(), out.data(), LCL_TYPE_DOUBLE, stride));
        succeed(lcl_field_upload(field.get(), narrow.data(), LCL_TYPE_FLOAT, stride));
        succeed(lcl_field_download(field.get(), narrow_out.data(), LCL_TYPE_FLOAT, stride));
        for (std::size_t v = 0; v < rows; ++v)
            for (int c = 0; c < static_cast<int>(stride); ++c) {
                const bool is_gap = c >= channels;
                CHECK(std::abs(out[v * stride + c] - (is_gap ? -1 : values[v * channels + c])) <= bound);
                CHECK(std::abs(narrow_out[v * stride + c] - (is_gap ? -1.0 : values[v * channels + c])) <= bound + 1000 * float_eps);
            }
    }
}

TEST_CASE("a model far away loses nothing in float but what its own numbers lack", "[capi][field]") {
    const shapes::Shape shape = shapes::transformed(torus(), 1, 1e6);
    const Operator A = make_operator(shape);
    const FieldHandle field = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_MIXED);
    CHECK(largest_difference(download(field.get(), shape.mesh.vertex_count), shape.mesh.positions) <= float_eps * diagonal_of(shape) + 2e6 * eps);
}

TEST_CASE("wrong arguments of fields are refused", "[capi][field]") {
    const shapes::Shape shape = torus();
    const Operator A = make_operator(shape), B = make_operator(shape);
    const FieldHandle x = make_field(A.get(), shape.mesh.positions), empty = make_field(A.get()), y = make_field(A.get(), 2),
                      other = make_field(B.get(), shape.mesh.positions), floats = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_SINGLE);
    std::vector<double> values(shape.mesh.positions.size());
    lcl_field made = nullptr;
    const auto wrong_type = static_cast<lcl_type>(2);
    refuse(lcl_field_create(A.get(), 0, LCL_PRECISION_SINGLE, &made), LCL_ERROR_INVALID_ARGUMENT, "channels is 0");
    refuse(lcl_field_create(A.get(), -1, LCL_PRECISION_SINGLE, &made), LCL_ERROR_INVALID_ARGUMENT, "channels is -1");
    refuse(lcl_field_create(A.get(), 3, static_cast<lcl_precision>(3), &made), LCL_ERROR_INVALID_ARGUMENT, "precision is 3");
    CHECK(made == nullptr);
    refuse(lcl_field_upload(x.get(), values.data(), wrong_type, 0), LCL_ERROR_INVALID_ARGUMENT, "type is 2");
    refuse(lcl_field_upload(x.get(), values.data(), LCL_TYPE_DOUBLE, 2), LCL_ERROR_INVALID_ARGUMENT, "stride is 2");
    refuse(lcl_field_download(x.get(), values.data(), wrong_type, 0), LCL_ERROR_INVALID_ARGUMENT, "type is 2");
    refuse(lcl_field_download(x.get(), values.data(), LCL_TYPE_FLOAT, 1), LCL_ERROR_INVALID_ARGUMENT, "stride is 1");
    refuse(lcl_field_download(empty.get(), values.data(), LCL_TYPE_DOUBLE, 0), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    refuse(lcl_field_match(x.get(), y.get()), LCL_ERROR_INVALID_ARGUMENT, "differ in channels");
    refuse(lcl_field_match(x.get(), empty.get()), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    std::vector<double> bad = shape.mesh.positions;
    bad[3 * 11 + 2] = std::numeric_limits<double>::infinity();
    refuse(lcl_field_upload(empty.get(), bad.data(), LCL_TYPE_DOUBLE, 0), LCL_ERROR_BAD_INPUT, "values of vertex 11 is inf in channel 2");

    const int32_t list[] = {0, 63}, negative = -1;
    refuse(lcl_field_read_vertices(x.get(), list, 2, values.data()), LCL_ERROR_INVALID_ARGUMENT, "vertex 63 was asked for, the field has 63");
    CHECK(last_error_vertices() == std::vector<int32_t>{63});
    refuse(lcl_field_write_vertices(x.get(), &negative, 1, values.data()), LCL_ERROR_INVALID_ARGUMENT, "vertex -1");
    refuse(lcl_field_read_vertices(empty.get(), list, 1, values.data()), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    refuse(lcl_field_write_vertices(empty.get(), list, 1, values.data()), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    succeed(lcl_field_read_vertices(x.get(), nullptr, 0, nullptr));

    const auto sweep = [&](lcl_field M, lcl_field from, lcl_field d, lcl_field to, double c = 0, int32_t first = 0, int32_t count = -1) {
        return lcl_operator_step(A.get(), 1, 1, c, M, from, d, to, first, count, nullptr);
    };
    refuse(lcl_operator_apply(A.get(), x.get(), x.get()), LCL_ERROR_INVALID_ARGUMENT, "the same field");
    refuse(lcl_operator_apply(A.get(), other.get(), x.get()), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    refuse(lcl_operator_apply(A.get(), x.get(), other.get()), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    refuse(lcl_operator_apply(B.get(), x.get(), other.get()), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    refuse(lcl_operator_apply(A.get(), x.get(), y.get()), LCL_ERROR_INVALID_ARGUMENT, "differ in channels or precision");
    refuse(lcl_operator_apply(A.get(), x.get(), floats.get()), LCL_ERROR_INVALID_ARGUMENT, "differ in channels or precision");
    refuse(lcl_operator_apply(A.get(), empty.get(), x.get()), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    refuse(sweep(x.get(), x.get(), nullptr, x.get()), LCL_ERROR_INVALID_ARGUMENT, "the same field");
    const FieldHandle M = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_DOUBLE, x.get());
    refuse(sweep(M.get(), x.get(), nullptr, M.get()), LCL_ERROR_INVALID_ARGUMENT, "the same field");
    refuse(sweep(other.get(), x.get(), nullptr, empty.get()), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    refuse(sweep(x.get(), x.get(), other.get(), empty.get(), 1), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    refuse(sweep(x.get(), x.get(), nullptr, empty.get(), 1), LCL_ERROR_INVALID_ARGUMENT, "d is NULL");
    refuse(sweep(empty.get(), x.get(), nullptr, M.get()), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    const int32_t blocks = lcl_operator_block_count(A.get());
    refuse(sweep(x.get(), x.get(), nullptr, empty.get(), 0, -1, 1), LCL_ERROR_INVALID_ARGUMENT, "the operator has " + std::to_string(blocks));
    refuse(sweep(x.get(), x.get(), nullptr, empty.get(), 0, 0, blocks + 1), LCL_ERROR_INVALID_ARGUMENT, "the operator has " + std::to_string(blocks));
    refuse(sweep(x.get(), x.get(), nullptr, empty.get(), 0, blocks + 1, -1), LCL_ERROR_INVALID_ARGUMENT, "the operator has " + std::to_string(blocks));
    refuse(sweep(x.get(), x.get(), nullptr, empty.get(), 0, 1, std::numeric_limits<int32_t>::max()), LCL_ERROR_INVALID_ARGUMENT, "the operator has");
}

TEST_CASE("fields in one formula must share centre and scale", "[capi][field]") {
    const shapes::Shape shape = torus(), moved = shapes::transformed(shape, 2, 5);
    const Operator A = make_operator(shape);
    const FieldHandle x = make_field(A.get(), shape.mesh.positions), far_away = make_field(A.get(), moved.mesh.positions), y = make_field(A.get());
    refuse(lcl_operator_step(A.get(), 1, 1, 0, far_away.get(), x.get(), nullptr, y.get(), 0, -1, nullptr), LCL_ERROR_INVALID_ARGUMENT, "lcl_field_match");
    refuse(lcl_operator_step(A.get(), 1, 1, 1, x.get(), x.get(), far_away.get(), y.get(), 0, -1, nullptr), LCL_ERROR_INVALID_ARGUMENT, "lcl_field_match");
    refuse(lcl_field_match(x.get(), far_away.get()), LCL_ERROR_INVALID_ARGUMENT, "before its first upload");
    succeed(lcl_field_match(x.get(), x.get()));
    REQUIRE(lcl_operator_block_count(A.get()) == 1);
    succeed(lcl_operator_step(A.get(), 1, 1, 0, x.get(), x.get(), nullptr, far_away.get(), 0, -1, nullptr));  // all of it is written
    const FieldHandle matched = make_field(A.get(), moved.mesh.positions, LCL_PRECISION_DOUBLE, x.get());
    CHECK(largest_difference(download(matched.get(), shape.mesh.vertex_count), moved.mesh.positions) <= 10 * 10 * eps);
    step(A.get(), 0, 1, 0, matched, x, nullptr, y);
    const std::vector<double> expected = sum(1, moved.mesh.positions, -1, limit_of(A.get(), shape.mesh.positions, 3));
    CHECK(largest_difference(download(y.get(), shape.mesh.vertex_count), expected) <= 100 * eps);
}

TEST_CASE("rows are read and written by vertex, in any order", "[capi][field]") {
    const shapes::Shape shape = patchwork();
    const Operator A = make_operator(shape);
    const int channels = GENERATE(1, 3, 6);
    const std::vector<double> values = with_channels(shape.mesh.positions, channels);
    const FieldHandle field = make_field(A.get(), values);
    const std::vector<int32_t> vertices{49, 3, 4, 5, 0, 31, 5, 48};  // one of them twice
    std::vector<double> found(vertices.size() * channels);
    succeed(lcl_field_read_vertices(field.get(), vertices.data(), vertices.size(), found.data()));
    for (std::size_t i = 0; i < found.size(); ++i) CHECK(std::abs(found[i] - values[vertices[i / channels] * channels + i % channels]) <= 8 * eps * 1000);

    std::vector<double> expected = values, written;
    const std::vector<int32_t> changed{7, 41, 8, 6};
    for (const int32_t v : changed)
        for (int c = 0; c < channels; ++c) written.push_back(expected[v * channels + c] = 0.25 * v - c);
    succeed(lcl_field_write_vertices(field.get(), changed.data(), changed.size(), written.data()));
    CHECK(largest_difference(download(field.get(), shape.mesh.vertex_count), expected) <= 8 * eps * 1000);
}

TEST_CASE("apply gives limit points for 1 to 9 channels", "[capi][field]") {
    const shapes::Shape shape = patchwork();
    const Operator A = make_operator(shape);
    for (int channels = 1; channels <= 9; ++channels) {
        const std::vector<double> values = with_channels(shape.mesh.positions, channels);
        const lcl_precision precision = channels % 2 ? LCL_PRECISION_DOUBLE : LCL_PRECISION_MIXED;
        const FieldHandle x = make_field(A.get(), values, precision), y = make_field(A.get(), channels, precision);
        succeed(lcl_operator_apply(A.get(), x.get(), y.get()));
        succeed(lcl_context_finish(default_context()));
        const std::vector<double> expected = limit_of(A.get(), values, channels);
        CHECK(largest_difference(download(y.get(), shape.mesh.vertex_count), expected) <= (channels % 2 ? 30 * eps : 30 * float_eps) * 1000);
    }
}

TEST_CASE("PIA by single sweeps is PIA", "[capi][field][solve]") {
    const shapes::Shape shape = GENERATE(torus(), patchwork());
    const lcl_precision precision = GENERATE(LCL_PRECISION_DOUBLE, LCL_PRECISION_SINGLE);
    CAPTURE(shape.name, precision);
    const Operator A = make_operator(shape);
    const int sweeps = 12;
    const std::vector<double>& M = shape.mesh.positions;
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.solver = LCL_SOLVER_PIA;
    options.precision = precision;
    options.exact_sweeps = sweeps;
    std::vector<double> P(M.size()), history(sweeps + 1);
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    report.residuals = history.data();
    report.residual_capacity = history.size();
    succeed(lcl_interpolate(A.get(), M.data(), 0, 3, &options, P.data(), 0, &report));

    const FieldHandle m = make_field(A.get(), M, precision);
    FieldHandle x = make_field(A.get(), M, precision), y = make_field(A.get(), 3, precision);
    std::vector<double> residuals;
    for (int i = 0; i <= sweeps; ++i) {
        residuals.push_back(step(A.get(), 1, 1, 0, m, x, nullptr, y));
        if (i < sweeps) std::swap(x, y);
    }
    for (int i = 0; i <= sweeps; ++i)
        CHECK(std::abs(residuals[i] - history[i]) <= 4 * eps * history[i] + (precision == LCL_PRECISION_DOUBLE ? 0 : 4 * float_eps * diagonal_of(shape)));
    // but for the way back to model units the same numbers; in float a solve works on corrections, which are rounded less
    CHECK(largest_difference(download(x.get(), shape.mesh.vertex_count), P) <=
          (precision == LCL_PRECISION_DOUBLE ? 4 * eps : 4 * float_eps) * diagonal_of(shape));  // corners come back to the bit from a solve alone
}

TEST_CASE("a sweep in ranges of blocks is the whole sweep", "[capi][field]") {
    const shapes::Shape shape = shapes::rough(shapes::grid_quads(150, 140), 0.01, 3);  // more rows than a block holds
    const Operator A = make_operator(shape);
    const int32_t blocks = lcl_operator_block_count(A.get());
    REQUIRE(blocks >= 4);
    const FieldHandle M = make_field(A.get(), shape.mesh.positions), whole = make_field(A.get()), parts = make_field(A.get());
    const double residual = step(A.get(), 1, 1.25, 0, M, M, nullptr, whole);
    double largest = 0, of_range = 0;
    for (const int32_t first : {blocks / 2, 0}) {
        succeed(lcl_operator_step(A.get(), 1, 1.25, 0, M.get(), M.get(), nullptr, parts.get(), first, first == 0 ? blocks / 2 : -1, &of_range));
        CHECK(of_range <= residual);
        largest = std::max(largest, of_range);
    }
    CHECK(largest == residual);
    CHECK(download(parts.get(), shape.mesh.vertex_count) == download(whole.get(), shape.mesh.vertex_count));
    succeed(lcl_operator_step(A.get(), 1, 1, 0, M.get(), M.get(), nullptr, parts.get(), blocks, 0, &of_range));  // none
    CHECK(of_range == 0);
}

TEST_CASE("a step is a x + b (M - A x) + c d, also where d is y", "[capi][field]") {
    const shapes::Shape shape = patchwork();
    const Operator A = make_operator(shape);
    const int channels = GENERATE(3, 5);
    const std::vector<double> m = with_channels(shape.mesh.positions, channels);
    std::vector<double> x_values = m, d_values = m;
    for (std::size_t i = 0; i < m.size(); ++i) x_values[i] += 0.3 * std::sin(7.0 * i), d_values[i] -= 0.2 * std::cos(5.0 * i);
    const FieldHandle M = make_field(A.get(), m), x = make_field(A.get(), x_values, LCL_PRECISION_DOUBLE, M.get()),
                      d = make_field(A.get(), d_values, LCL_PRECISION_DOUBLE, M.get()), y = make_field(A.get(), channels);
    const std::vector<double> residual = sum(1, m, -1, limit_of(A.get(), x_values, channels));
    double largest = 0;
    for (std::size_t v = 0; v < residual.size() / channels; ++v)  // the isolated vertex counts for nothing
        if (v != 20) largest = std::max(largest, std::hypot(residual[v * channels], residual[v * channels + 1], residual[v * channels + 2]));
    const auto check = [&](lcl_field field, const std::vector<double>& expected) {
        CHECK(largest_difference(download(field, shape.mesh.vertex_count), expected) <= 100 * eps * 1000);
    };
    SECTION("residual: differences have no centre") {
        CHECK(step(A.get(), 0, 1, 0, M, x, nullptr, y) == Approx(largest).epsilon(1e-12));
        check(y.get(), residual);
    }
    SECTION("W-PIA") {
        step(A.get(), 1, 1.6, 0, M, x, nullptr, y);
        check(y.get(), sum(1, x_values, 1.6, residual));
    }
    SECTION("three terms") {
        step(A.get(), 1.4, 0.7, -0.4, M, x, &d, y);
        check(y.get(), sum(1, sum(1.4, x_values, 0.7, residual), -0.4, d_values));
    }
    SECTION("three terms in place of d") {
        step(A.get(), 1.4, 0.7, -0.4, M, x, &d, d);
        check(d.get(), sum(1, sum(1.4, x_values, 0.7, residual), -0.4, d_values));
    }
    SECTION("a sum that is not affine moves the centre") {
        step(A.get(), 2, 0.5, 1.5, M, x, &d, y);
        check(y.get(), sum(1, sum(2, x_values, 0.5, residual), 1.5, d_values));
    }
    SECTION("the residual may stay unread") {
        succeed(lcl_operator_step(A.get(), 1, 1, 0, M.get(), x.get(), nullptr, y.get(), 0, -1, nullptr));
        check(y.get(), sum(1, x_values, 1, residual));
    }
}

TEST_CASE("solves on fields are those of arrays", "[capi][field][solve]") {
    const shapes::Shape shape = GENERATE(torus(), patchwork());
    const Operator A = make_operator(shape);
    const std::vector<double> values = with_channels(shape.mesh.positions, 5);
    const auto [precision, solver] = GENERATE(table<lcl_precision, lcl_solver>({{LCL_PRECISION_DOUBLE, LCL_SOLVER_AUTO},
                                                                                {LCL_PRECISION_DOUBLE, LCL_SOLVER_GS},
                                                                                {LCL_PRECISION_MIXED, LCL_SOLVER_AUTO},
                                                                                {LCL_PRECISION_MIXED, LCL_SOLVER_WPIA},
                                                                                {LCL_PRECISION_SINGLE, LCL_SOLVER_AUTO}}));
    CAPTURE(shape.name, precision, solver);
    const double tolerance = precision == LCL_PRECISION_SINGLE ? 1e-5 : 1e-6;
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.precision = precision;
    options.solver = solver;
    options.tolerance = tolerance;
    std::vector<double> P(values.size()), history(400), of_field(400);
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT, field_report = LCL_SOLVE_REPORT_INIT;
    report.residuals = history.data();
    field_report.residuals = of_field.data();
    report.residual_capacity = field_report.residual_capacity = history.size();
    succeed(lcl_interpolate(A.get(), values.data(), 0, 5, &options, P.data(), 0, &report));

    const FieldHandle M = make_field(A.get(), values, precision), x = make_field(A.get(), 5, precision);
    succeed(lcl_interpolate_field(A.get(), M.get(), &options, x.get(), &field_report));
    CHECK(field_report.converged == 1);
    CHECK(field_report.solver == report.solver);
    CHECK(field_report.max_error <= tolerance * diagonal_of(shape));
    CHECK(field_report.channel_error <= tolerance);
    CHECK(std::abs(field_report.iterations - report.iterations) <= (precision == LCL_PRECISION_DOUBLE ? 0 : 2));
    CHECK(std::abs(of_field[0] - history[0]) <= 10 * float_eps * diagonal_of(shape));
    const std::vector<double> found = download(x.get(), shape.mesh.vertex_count);
    // Each is off by |A^-1| (below 60 here) times its residual, relative to each channel's size.
    CHECK(largest_difference(found, P) <= (precision == LCL_PRECISION_DOUBLE ? 1e-12 : 2 * 60 * tolerance) * 2000);
    options.warm_start = 1;
    if (precision != LCL_PRECISION_SINGLE) {
        succeed(lcl_interpolate_field(A.get(), M.get(), &options, x.get(), &field_report));
        CHECK(field_report.iterations <= 2);  // storing P as floats costs some of the residual
    }
}

TEST_CASE("solves on fields refuse what does not fit together", "[capi][field][solve]") {
    const shapes::Shape shape = torus();
    const Operator A = make_operator(shape), B = make_operator(shape);
    const FieldHandle M = make_field(A.get(), shape.mesh.positions), P = make_field(A.get()), empty = make_field(A.get()), other = make_field(B.get()),
                      narrow = make_field(A.get(), 2), floats = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_MIXED),
                      float_P = make_field(A.get(), 3, LCL_PRECISION_MIXED);
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    const auto solve = [&](const FieldHandle& m, const FieldHandle& p) { return lcl_interpolate_field(A.get(), m.get(), &options, p.get(), nullptr); };
    refuse(solve(M, other), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    refuse(solve(other, P), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    refuse(solve(M, M), LCL_ERROR_INVALID_ARGUMENT, "the same field");
    refuse(solve(empty, P), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    refuse(solve(M, narrow), LCL_ERROR_INVALID_ARGUMENT, "differ in channels or precision");
    refuse(solve(M, float_P), LCL_ERROR_INVALID_ARGUMENT, "differ in channels or precision");
    options.precision = LCL_PRECISION_DOUBLE;
    refuse(solve(floats, float_P), LCL_ERROR_INVALID_ARGUMENT, "the fields hold floats");
    options.precision = LCL_PRECISION_MIXED;
    options.warm_start = 1;
    refuse(solve(M, P), LCL_ERROR_INVALID_ARGUMENT, "lcl_field_match");
    lcl_solve_report no_size{};
    options.warm_start = 0;
    refuse(lcl_interpolate_field(A.get(), M.get(), &options, P.get(), &no_size), LCL_ERROR_INVALID_ARGUMENT, "struct_size is not set");

    const int32_t owned[] = {1, 2};
    lcl_scheme_options part = scheme(LCL_SCHEME_CATMULL_CLARK);
    part.owned = owned;
    part.owned_count = 2;
    const Operator G = make_operator(shape, &part);
    const FieldHandle of_part = make_field(G.get(), shape.mesh.positions), result = make_field(G.get());
    refuse(lcl_interpolate_field(G.get(), of_part.get(), nullptr, result.get(), nullptr), LCL_ERROR_UNSUPPORTED, "lcl_operator_step");
}

TEST_CASE("ghost rows are not touched by sweeps", "[capi][field]") {
    const shapes::Shape shape = torus();
    std::vector<int32_t> owned(30);
    std::iota(owned.begin(), owned.end(), 10);
    lcl_scheme_options part = scheme(LCL_SCHEME_CATMULL_CLARK);
    part.owned = owned.data();
    part.owned_count = owned.size();
    const Operator A = make_operator(shape, &part);
    const FieldHandle x = make_field(A.get(), shape.mesh.positions),
                      y = make_field(A.get(), std::vector<double>(shape.mesh.positions.size(), 0.5), LCL_PRECISION_DOUBLE, x.get());
    const std::vector<double> limit = limit_of(make_operator(shape).get(), shape.mesh.positions, 3);
    const FieldHandle elsewhere =
        make_field(A.get(), shapes::transformed(shape, 2, 1).mesh.positions);  // ghosts in another centre and scale would change their meaning
    refuse(lcl_operator_apply(A.get(), x.get(), elsewhere.get()), LCL_ERROR_INVALID_ARGUMENT, "only some rows of y are written");
    refuse(lcl_operator_step(A.get(), 1, 1, 0, x.get(), x.get(), nullptr, elsewhere.get(), 0, -1, nullptr), LCL_ERROR_INVALID_ARGUMENT,
           "only some rows of y are written");
    SECTION("apply") { succeed(lcl_operator_apply(A.get(), x.get(), y.get())); }
    SECTION("step") { step(A.get(), 1, -1, 0, x, x, nullptr, y); }  // x - (x - A x)
    const std::vector<double> found = download(y.get(), shape.mesh.vertex_count);
    for (int v = 0; v < shape.mesh.vertex_count; ++v)
        for (int c = 0; c < 3; ++c) CHECK(found[3 * v + c] == Approx(v >= 10 && v < 40 ? limit[3 * v + c] : 0.5).margin(1e-14));
}
