// SPDX-License-Identifier: BSD-3-Clause
// speed_limitcl PART: limitcl's own rows, each beside the device's copy of the field in the same round.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <thread>

#include "interpolation.h"
#include "measure.h"

namespace bench {
namespace {

constexpr lcl_precision single = LCL_PRECISION_SINGLE, mixed = LCL_PRECISION_MIXED;

const char* name_of(lcl_precision precision) { return precision == single ? "single" : "mixed"; }

/// limitcl's rows against limit_matrix's: what every later check of an error stands on.
void check_rows(const Interpolation& problem, const LimitMatrix& matrix) {
    const std::int32_t step = std::max(1, problem.vertex_count / 1000);
    std::vector<std::int32_t> columns(100);
    std::vector<double> weights(100);
    for (std::int32_t v = 0; v < problem.vertex_count; v += step) {
        std::size_t size = 0;
        check(lcl_operator_get_row(problem.A.get(), v, columns.data(), weights.data(), columns.size(), &size));
        const std::int32_t first = matrix.offsets[v], count = matrix.offsets[v + 1] - first;
        bool same = static_cast<std::int32_t>(size) == count;
        for (std::int32_t i = 0; same && i < count; ++i)
            same = columns[i] == matrix.columns[first + i] && std::abs(weights[i] - matrix.weights[first + i] / matrix.scale[v]) < 1e-14;
        if (!same) throw std::runtime_error("row " + std::to_string(v) + " of limitcl's operator is not that of the published mask");
    }
}

/// Solves in single and mixed precision beside the copy; what `others` times takes its turn in the same rounds.
void time_solves(const Arguments& arguments, const std::string& name, const Shape& shape, Scheme scheme,
                 const std::function<void(Interpolation&, Laps&)>& others = nullptr) {
    Interpolation problem(open_device(arguments.device), shape, scheme);
    const LimitMatrix matrix = limit_matrix(shape, scheme);
    check_rows(problem, matrix);
    DeviceCopy copy(problem.context, problem.vertex_count);
    lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
    check(lcl_operator_diagnose(problem.A.get(), &diagnosis));  // part of the set-up
    print_value(name + ".vertices", problem.vertex_count);
    for (const lcl_precision precision : {single, mixed}) {
        print_value(name + ".iterations." + name_of(precision), problem.solve(precision).iterations);
        print_value(name + ".error." + name_of(precision), relative_error(matrix, shape, problem.control_points()));
    }
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.add(name + ".copy", copy.seconds());
        for (const lcl_precision precision : {single, mixed}) laps.time_warm(name + ".solve." + name_of(precision), [&] { problem.solve(precision); });
        if (others) others(problem, laps);
    });
}

/// One application and both fused sweeps: as PIA takes it (two fields and M), and as Chebyshev does (the field before last, which is overwritten).
void time_solve(const Arguments& arguments) {
    FieldHandle y;
    const int repetitions = 20;
    const auto one_pass = [&](Interpolation& problem, Laps& laps) {
        if (!y) {
            y = make_field(problem.A);
            check(lcl_field_match(y.get(), problem.M.get()));
        }
        const lcl_operator A = problem.A.get();
        const lcl_field M = problem.M.get(), P = problem.P.get();
        const auto timed = [&](const char* name, const auto& enqueue) {
            const Clock::time_point start = Clock::now();
            for (int i = 0; i < repetitions; ++i) check(enqueue());
            problem.finish();
            laps.add(name, seconds_since(start) / repetitions);
        };
        timed("q.sweep.pia", [&] { return lcl_operator_step(A, 1, 1, 0, M, P, nullptr, y.get(), 0, -1, nullptr); });
        timed("q.sweep.chebyshev", [&] { return lcl_operator_step(A, 1.3, 1.5, -0.3, M, P, y.get(), y.get(), 0, -1, nullptr); });
        timed("q.apply", [&] { return lcl_operator_apply(A, P, y.get()); });
    };
    time_solves(arguments, "q", quad_sphere(arguments.level), Scheme::catmull_clark, one_pass);
}

void time_other_shapes(const Arguments& arguments) {
    time_solves(arguments, "torus", make_shape("torus", arguments.level), Scheme::catmull_clark);
    time_solves(arguments, "loop", icosphere(arguments.level + 1), Scheme::loop);
    time_solves(arguments, "doo-sabin", quad_sphere(arguments.level), Scheme::doo_sabin);
}

void time_growth(const Arguments& arguments) {
    for (const int level : {arguments.level - 3, arguments.level - 2, arguments.level, arguments.level + 1})
        time_solves(arguments, "growth." + std::to_string(60 * (1 << 2 * level) + 2), quad_sphere(level), Scheme::catmull_clark);
}

/// From index arrays to an operator whose spectrum is known and a field on the device.
void time_setup(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const ContextHandle context = open_device(arguments.device);
    DeviceCopy copy(context, shape.vertex_count());
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.add("setup.copy", copy.seconds());
        MeshHandle mesh;
        OperatorHandle A;
        FieldHandle M;
        lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
        laps.time("setup.all", [&] {
            laps.time("setup.mesh", [&] { mesh = make_mesh(shape); });
            laps.time("setup.operator", [&] { A = make_operator(context, mesh, Scheme::catmull_clark); });
            laps.time("setup.upload", [&] {
                M = make_field(A);
                check(lcl_field_upload(M.get(), shape.points.data(), LCL_TYPE_DOUBLE, 0));
            });
            laps.time("setup.spectrum", [&] { check(lcl_operator_diagnose(A.get(), &diagnosis)); });
        });
    });
}

constexpr int frame_count = 8;

/// The shape's points in frame `frame` of an animation: a slow wave of 1 % of the radius runs over it.
void move_points(const Shape& shape, int frame, double* out, std::size_t stride) {
    for (std::size_t v = 0; v < shape.points.size() / 3; ++v) {
        const double factor = 1 + 0.01 * std::sin(3 * shape.points[3 * v] + 0.2 * frame);
        for (int c = 0; c < 3; ++c) out[v * stride + c] = factor * shape.points[3 * v + c];
    }
}

/// Eight fields as the 24 channels of one, and eight frames one after the other, each from the last one's answer.
void time_fields(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    Interpolation problem(open_device(arguments.device), shape, Scheme::catmull_clark);
    const FieldHandle M = make_field(problem.A, 3 * frame_count), P = make_field(problem.A, 3 * frame_count);
    std::vector<double> values(3 * frame_count * static_cast<std::size_t>(problem.vertex_count));
    for (int frame = 0; frame < frame_count; ++frame) move_points(shape, frame, &values[3 * frame], 3 * frame_count);
    check(lcl_field_upload(M.get(), values.data(), LCL_TYPE_DOUBLE, 0));
    std::vector<FieldHandle> frames;
    for (int frame = 0; frame < frame_count; ++frame) {
        frames.push_back(make_field(problem.A));
        check(lcl_field_match(frames.back().get(), problem.M.get()));
        check(lcl_field_upload(frames.back().get(), &values[3 * frame], LCL_TYPE_DOUBLE, 3 * frame_count));
    }
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.precision = single;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    print_value("fields.count", frame_count);
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.time_warm("fields.one", [&] { check(lcl_interpolate_field(problem.A.get(), frames[0].get(), &options, problem.P.get(), nullptr)); });
        laps.time_warm("fields.together", [&] { check(lcl_interpolate_field(problem.A.get(), M.get(), &options, P.get(), &report)); });
        lcl_solve_options warm = options;
        warm.warm_start = 1;
        check(lcl_interpolate_field(problem.A.get(), frames.back().get(), &options, problem.P.get(), nullptr));  // the frame before the first
        laps.time_warm("fields.frames", [&] {
            for (const FieldHandle& frame : frames) check(lcl_interpolate_field(problem.A.get(), frame.get(), &warm, problem.P.get(), nullptr));
        });
    });
    print_value("fields.iterations.together", report.iterations);
}

/// Ten vertices of one neighbourhood, or spread over the shape.
std::vector<std::int32_t> vertices_to_move(const Shape& shape, bool together) {
    std::vector<std::int32_t> vertices;
    for (std::size_t corner = shape.faces.size() / 2; vertices.size() < 10; ++corner)
        if (std::find(vertices.begin(), vertices.end(), shape.faces[corner]) == vertices.end()) vertices.push_back(shape.faces[corner]);
    if (!together)
        for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = static_cast<std::int32_t>(i * shape.points.size() / 3 / vertices.size());
    return vertices;
}

/// Moves the vertices by 1 % of the radius and back, again and again; then a full solve of the same field shows how far the local answer is from it.
void time_local(const Arguments& arguments, const std::string& name, const Shape& shape, const std::vector<std::int32_t>& vertices) {
    Interpolation problem(open_device(arguments.device), shape, Scheme::catmull_clark);
    problem.solve(single);
    Shape moved = shape;
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.precision = single;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    bool is_moved = false;
    const auto edit = [&] {
        is_moved = !is_moved;
        std::vector<double> values;
        for (const std::int32_t v : vertices)
            for (int c = 0; c < 3; ++c) values.push_back(moved.points[3 * v + c] = (is_moved ? 1.01 : 1.0) * shape.points[3 * v + c]);
        check(lcl_solve_local(problem.A.get(), problem.M.get(), problem.P.get(), vertices.data(), vertices.size(), values.data(), &options, &report));
    };
    run_rounds(arguments.runs, [&](Laps& laps) { laps.time_warm(name, edit); });
    if (!is_moved) edit();
    const std::vector<double> local = problem.control_points();
    problem.solve(single);
    const std::vector<double> full = problem.control_points();
    double difference = 0;
    for (std::size_t i = 0; i < full.size(); ++i) difference = std::max(difference, std::abs(full[i] - local[i]));
    print_value(name + ".error", relative_error(limit_matrix(shape, Scheme::catmull_clark), moved, local));
    print_value(name + ".difference", difference / diagonal(moved));
    print_value(name + ".rows", report.changed_rows);
}

void time_local_solves(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    for (const bool together : {true, false}) time_local(arguments, together ? "local.together" : "local.spread", shape, vertices_to_move(shape, together));
}

/// Filters of the mesh expansion on fields, of three and of eight channels, each beside the device's copy.
void time_filters(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    Interpolation problem(open_device(arguments.device), shape, Scheme::catmull_clark);
    const lcl_operator A = problem.A.get();
    DeviceCopy copy(problem.context, problem.vertex_count);
    const FieldHandle difference = make_field(problem.A), eight = make_field(problem.A, 8), eight_out = make_field(problem.A, 8);
    std::vector<double> values(8 * static_cast<std::size_t>(problem.vertex_count));
    for (std::size_t v = 0; v < values.size() / 8; ++v)
        for (int c = 0; c < 8; ++c) values[8 * v + c] = shape.points[3 * v + c % 3] + c;
    check(lcl_field_upload(eight.get(), values.data(), LCL_TYPE_DOUBLE, 0));
    check(lcl_field_match(problem.P.get(), problem.M.get()));
    check(lcl_field_subtract(problem.P.get(), problem.M.get(), difference.get()));
    const double weights[8] = {1, 0.9, 1.2, 0.7, 1.1, 0.8, 1.3, 0.6};
    lcl_expand_options equaliser = LCL_EXPAND_OPTIONS_INIT;
    equaliser.weights = weights;
    equaliser.weight_count = 8;
    double energies[16 * 3];
    const auto timed = [&](Laps& laps, const char* name, const auto& call) {
        laps.time_warm(name, [&] {
            check(call());
            problem.finish();
        });
    };
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.add("filters.copy", copy.seconds());
        timed(laps, "filters.denoise", [&] { return lcl_denoise_field(A, problem.M.get(), nullptr, problem.P.get()); });
        timed(laps, "filters.denoise.eight", [&] { return lcl_denoise_field(A, eight.get(), nullptr, eight_out.get()); });
        timed(laps, "filters.equaliser", [&] { return lcl_expand_field(A, problem.M.get(), &equaliser, problem.P.get()); });
        timed(laps, "filters.spectrum", [&] { return lcl_spectrum_field(A, problem.M.get(), 16, energies); });
        timed(laps, "filters.sharpen", [&] { return lcl_sharpen_field(A, problem.M.get(), nullptr, problem.P.get()); });
        timed(laps, "filters.morph", [&] { return lcl_morph_field(A, 2, 0.9, problem.M.get(), difference.get(), problem.P.get()); });
    });
}

/// Everything a caller with arrays does, at the start of a process and again.
void time_first_call(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    ContextHandle context;
    const auto call = [&] {
        const MeshHandle mesh = make_mesh(shape);
        check(lcl_interpolate_mesh(make_operator(context, mesh, Scheme::catmull_clark).get(), mesh.get(), nullptr, nullptr));
    };
    const Clock::time_point start = Clock::now();
    context = open_device(arguments.device);
    call();
    const double first = seconds_since(start);
    Laps laps;
    for (int i = 0; i < 3; ++i) laps.time("first.later", call);
    laps.add("first.first", first);
    laps.print();
    print_value("first.compile", lcl_context_compile_seconds(context.get()));
}

/// Bytes a second that all cores copy (read and written counted), for orientation.
double memory_bandwidth() {
    const std::size_t threads = std::max(1u, std::thread::hardware_concurrency()), bytes = std::size_t{64} << 20;
    const int repetitions = 20;
    std::vector<std::vector<char>> from(threads, std::vector<char>(bytes, 1)), to(threads, std::vector<char>(bytes, 0));
    const Clock::time_point start = Clock::now();
    std::vector<std::thread> workers;
    for (std::size_t t = 0; t < threads; ++t)
        workers.emplace_back([&, t] {
            for (int i = 0; i < repetitions; ++i) std::memcpy(to[t].data(), from[t].data(), bytes);
        });
    for (std::thread& worker : workers) worker.join();
    return 2.0 * repetitions * bytes * threads / seconds_since(start);
}

void describe_device(const Arguments& arguments) {
    const ContextHandle context = open_device(arguments.device);
    lcl_device_info info = LCL_DEVICE_INFO_INIT;
    check(lcl_context_get_device(context.get(), &info));
    print_text("device.name", info.name);
    print_text("device.driver", std::string(info.platform) + " " + info.driver + ", " + info.version);
    print_value("device.compute_units", info.compute_units);
    print_value("device.is_gpu", info.is_gpu);
    print_text("limitcl.build", lcl_build_string());
    print_value("host.bandwidth", memory_bandwidth());
}

/// Writes Q to --file, in full digits.
void write_q(const Arguments& arguments) { check(lcl_mesh_write(make_mesh(quad_sphere(arguments.level)).get(), arguments.file.c_str(), LCL_FORMAT_BY_ENDING)); }

void run_part(const Arguments& arguments) {
    const std::vector<std::pair<const char*, void (*)(const Arguments&)>> parts = {
        {"device", describe_device},  {"solve", time_solve},    {"shapes", time_other_shapes},   {"growth", time_growth},
        {"setup", time_setup},        {"fields", time_fields},  {"first-call", time_first_call}, {"write", write_q},
        {"local", time_local_solves}, {"filters", time_filters}};
    for (const auto& [name, part] : parts)
        if (arguments.part == name) return part(arguments);
    throw std::runtime_error("'" + arguments.part + "' is not a part");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::run_part); }
