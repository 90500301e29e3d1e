// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>

#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/failure.h"
#include "host/cli/interrupt.h"
#include "host/cli/option_names.h"
#include "host/cli/option_rules.h"
#include "host/cli/scheme_choice.h"
#include "host/cli/solve_step.h"
#include "host/cli/two_phase_step.h"

namespace lcl::cli {

namespace {

void note_solve_parameters(Job& job) {
    const Options& options = job.options;
    job.report.set_parameter("solver", std::string(solver_name(options.solver)));
    job.report.set_parameter("tolerance", options.tolerance);
    job.report.set_parameter("max_iter", static_cast<std::int64_t>(options.max_iterations));
    job.report.set_parameter("precision", std::string(precision_name(options.precision)));
    if (options.sweeps > 0) job.report.set_parameter("sweeps", static_cast<std::int64_t>(options.sweeps));
}

lcl_solve_options solve_options(const Options& options, SolveProgress& state) {
    lcl_solve_options solve = LCL_SOLVE_OPTIONS_INIT;
    solve.solver = options.solver;
    solve.precision = options.precision;
    solve.tolerance = options.tolerance;
    solve.max_iterations = options.max_iterations;
    solve.exact_sweeps = options.sweeps;
    solve.keep_going = options.keep_going || options.sweeps > 0;  // exactly so many sweeps, whatever they give
    solve.certify = !options.report.empty();                      // the bound may cost some ten short solves: for those who read it
    solve.progress = on_solve_progress;
    solve.progress_user = &state;
    return solve;
}

/// The library builds kernels at their first use, somewhere in a call of `elapsed` seconds: `compiled` of them, taken off its parts in proportion. `further`:
/// of what follows the solve.
void note_seconds(Seconds& seconds, const lcl_solve_report& report, double further, double elapsed, double compiled) {
    const double all = elapsed - report.seconds_download;
    const double rest = all > compiled ? 1.0 - compiled / all : 0.0;
    add_seconds(seconds.compile, compiled);
    add_seconds(seconds.upload, report.seconds_upload * rest);
    add_seconds(seconds.solve, (report.seconds_solve + further) * rest);
    add_seconds(seconds.download, report.seconds_download);
}

/// Replaces the points of the mesh, and the channels, by control points.
lcl_status interpolate(lcl_operator A, lcl_mesh mesh, const std::vector<std::string>& channels, const lcl_solve_options& options, lcl_solve_report& report) {
    if (channels.empty()) return lcl_interpolate_mesh(A, mesh, &options, &report);
    std::vector<double> values = gather_values(mesh, channels);
    const lcl_status status = lcl_interpolate(A, values.data(), 0, static_cast<std::int32_t>(3 + channels.size()), &options, values.data(), 0, &report);
    if (status == LCL_OK || is_result(status)) scatter_values(mesh, channels, values.data());
    return status;
}

/// A call of the library that solves.
using SolveCall = std::function<lcl_status(const lcl_solve_options&, lcl_solve_report&)>;

/// Runs it, with what the report says of it; the status is LCL_OK or one of the three results.
lcl_status solve(Job& job, lcl_context context, const SolveCall& call) {
    SolveProgress state{&job.terminal.progress(), job.options.sweeps};
    const lcl_solve_options options = solve_options(job.options, state);
    std::vector<double> residuals = residual_space(std::max(options.max_iterations, options.exact_sweeps));
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    report.residuals = residuals.data();
    report.residual_capacity = residuals.size();
    const double compiled = lcl_context_compile_seconds(context);
    check_interrupt();
    job.terminal.progress().begin("solving");
    const auto start = std::chrono::steady_clock::now();
    const lcl_status status = call(options, report);
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    job.terminal.progress().end();
    if (status != LCL_OK && !is_result(status)) throw two_phase_option(job.options) != nullptr ? two_phase_failure(job, status) : failure_of(status);
    note_solve(job, report, std::move(residuals));
    note_seconds(job.report.seconds, report, job.report.two_phase ? job.report.two_phase->seconds : 0.0, elapsed,
                 lcl_context_compile_seconds(context) - compiled);
    return status;
}

/// A solve that came through on an operator near a singular one: the control points are right, but small errors in M grow in them.
void warn_of_spectrum(Job& job, lcl_operator A) {
    lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
    check(lcl_operator_diagnose(A, &diagnosis));
    if (diagnosis.reason[0] == '\0') return;
    warn(job, diagnosis.reason);
    if (job.report.vertices.empty()) job.report.vertices.assign(diagnosis.vertices, diagnosis.vertices + diagnosis.vertex_count);
}

void say_solve(Job& job, std::size_t further_channels) {
    const lcl_solve_report& report = job.report.solve->report;
    const std::vector<double>& residuals = job.report.solve->residuals;
    const double diagonal = job.report.mesh->info.diagonal;
    job.terminal.say("solved", std::string(solver_name(report.solver)) + ", " + counted(report.iterations, "iteration", "iterations") + ", " +
                                   precision_name(job.options.precision) + " precision: " + (report.converged ? "converged" : "not converged"));
    if (!residuals.empty())
        job.terminal.say("residual", length_text(residuals.front(), diagonal) + " before, " + length_text(report.max_error, diagonal) + " after");
    if (further_channels > 0) job.terminal.say("channels", "largest residual " + short_number(report.channel_error) + " of their ranges");
    if (std::isfinite(report.surface_error_bound))
        job.terminal.say("surface", "within about " + length_text(report.surface_error_bound, diagonal) + " of the exact one");
}

/// Exporters that split vertices at every seam make such meshes.
void warn_if_all_fixed(Job& job) {
    const lcl_mesh_info& info = job.report.mesh->info;
    if (info.corners + info.isolated_vertices < info.vertices) return;
    warn(
        job,
        "every vertex is a corner or isolated, so the mesh is its own control mesh: if its faces should hang together, weld vertices at equal positions first");
}

lcl_status solve_two_phase(Job& job, lcl_context context, lcl_operator A, lcl_mesh mesh, const TwoPhaseChoice& choice, Mesh& refined) {
    return solve(job, context, [&](const lcl_solve_options& options, lcl_solve_report& report) {
        lcl_two_phase_report findings = LCL_TWO_PHASE_REPORT_INIT;
        lcl_mesh handle = nullptr;
        const lcl_status status = lcl_two_phase_mesh(A, mesh, &options, &choice.options, &handle, &report, &findings);
        refined.reset(handle);
        if (refined) note_two_phase(job, findings);
        return status;
    });
}

void finish_refined(Job& job, lcl_mesh refined) {
    const lcl_solve_report& report = job.report.solve->report;
    if (!report.converged && job.options.sweeps == 0 && report.message[0] != '\0')
        warn(job, std::string(report.message) + " (all vertices are met all the same)");
    say_two_phase(job, refined);
    if (!job.options.map_file.empty()) write_vertex_map(job, refined);  // first: where it fails, OUT is as it was
    write_output(job, refined);
}

}  // namespace

void run_interpolate(Job& job) {
    DeviceOpening device(job);
    const Mesh mesh = read_sound_input(job);
    if (two_phase_option(job.options) == nullptr) check_output_format(job, mesh.get());
    note_solve_parameters(job);
    const SchemeChoice scheme = choose_scheme(job, mesh.get());
    const std::vector<std::string> channels = choose_channels(job, mesh.get());
    const bool makes_refined = two_phase_option(job.options) != nullptr;
    TwoPhaseChoice two_phase;
    if (makes_refined) two_phase = choose_two_phase(job, mesh.get(), scheme, channels);
    const Context context = device.finish();
    const Operator A = make_operator(job, context.get(), mesh.get(), scheme.options);
    note_scheme_in_use(job, A.get());
    say_scheme(job);

    warn_if_all_fixed(job);
    Mesh refined;
    const lcl_status status = makes_refined ? solve_two_phase(job, context.get(), A.get(), mesh.get(), two_phase, refined)
                                            : solve(job, context.get(), [&](const lcl_solve_options& options, lcl_solve_report& report) {
                                                  return interpolate(A.get(), mesh.get(), channels, options, report);
                                              });
    std::optional<Failure> failure;
    if (status != LCL_OK) failure = failure_of_result(status, job.report.solve->report);
    const bool was_solved = (status != LCL_ERROR_SINGULAR && status != LCL_ERROR_INDEFINITE) || job.options.keep_going || job.options.sweeps > 0;
    if (was_solved) say_solve(job, channels.size());
    if (status == LCL_OK || status == LCL_ERROR_NOT_CONVERGED) warn_of_spectrum(job, A.get());
    if (failure && job.options.sweeps > 0) {
        warn(job, failure->message);
        failure.reset();
    }
    if (failure && !job.options.keep_going) throw *failure;
    if (refined) finish_refined(job, refined.get());
    else write_output(job, mesh.get());
    if (failure) throw *failure;
}

}  // namespace lcl::cli
