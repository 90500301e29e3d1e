// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "host/cli/commands.h"
#include "host/cli/engine_library.h"
#include "host/cli/failure.h"
#include "host/cli/interrupt.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"
#include "host/cli/solve_step.h"

namespace lcl::cli {

namespace {

Cloud read_cloud(Job& job) {
    const Phase phase(job, &Seconds::read, "reading " + shown_input(job.options));
    lcl_cloud cloud = nullptr;
    if (job.options.input != "-") {
        check(lcl_cloud_read(job.options.input.c_str(), LCL_FORMAT_BY_ENDING, &cloud));
    } else {
        const std::vector<char> bytes = standard_input();
        check(lcl_cloud_read_memory(bytes.data(), bytes.size(), job.options.format, "standard input", &cloud));
    }
    return Cloud(cloud);
}

void say_cloud(Job& job, lcl_cloud cloud) {
    std::vector<std::string> beside;
    if (lcl_cloud_has_normals(cloud)) beside.emplace_back("normals");
    if (lcl_cloud_has_colours(cloud)) beside.emplace_back("colours");
    const auto count = static_cast<long long>(lcl_cloud_count(cloud));
    job.terminal.say("read", shown_input(job.options) + ": " + counted(count, "point", "points") + (beside.empty() ? "" : " with ") + join(beside, " and "));
    for (int index = 0; index < lcl_cloud_note_count(cloud); ++index) warn(job, of_input(job, lcl_cloud_note(cloud, index)));
}

/// Exit code 2 where there is no such engine, or where it has no such option.
Engine engine_of_options(Job& job) {
    std::vector<std::string> warnings;
    Engine engine = choose_engine(job.options.engine, warnings);
    for (const std::string& warning : warnings) warn(job, warning);
    for (const auto& setting : job.options.engine_options) require_option(engine, setting.first);
    return engine;
}

void note_parameters(Job& job, const Engine& engine) {
    const Options& options = job.options;
    job.report.set_parameter("engine", engine.name);
    if (!options.engine_options.empty()) {
        std::vector<std::string> settings;
        for (const auto& [key, value] : options.engine_options) settings.push_back(key + "=" + value);
        job.report.set_parameter("engine_options", settings);
    }
    job.report.set_parameter("fit", std::string(fit_name(options.fit)));
    if (options.fit == LCL_FIT_LEAST_SQUARES) job.report.set_parameter("fair", options.fit_fair);
    job.report.set_parameter("tolerance", options.fit_tolerance);
    if (options.most_vertices > 0) job.report.set_parameter("vertices", static_cast<std::int64_t>(options.most_vertices));
    if (options.fill_holes > 0) job.report.set_parameter("fill_holes", static_cast<std::int64_t>(options.fill_holes));
    if (options.crease_angle > 0.0) job.report.set_parameter("crease_angle", options.crease_angle);
    job.report.set_parameter("boundary",
                             std::string(boundary_name(options.boundary == LCL_BOUNDARY_DEFAULT ? LCL_BOUNDARY_EDGE_AND_CORNER : options.boundary)));
    job.report.set_parameter("tol", options.tolerance);
    job.report.set_parameter("max_iter", static_cast<std::int64_t>(options.max_iterations));
    job.report.set_parameter("precision", std::string(precision_name(options.precision)));
}

lcl_scheme_options scheme_of_options(Job& job) {
    lcl_scheme_options scheme = LCL_SCHEME_OPTIONS_INIT;
    scheme.scheme = job.options.scheme;
    scheme.mask = job.options.mask;
    scheme.alpha = job.options.alpha;
    scheme.alpha_auto = job.options.alpha_auto;
    note_scheme(job, scheme);
    return scheme;
}

/// What the progress line needs between two calls.
struct FitProgress {
    Progress& progress;
    const Engine& engine;
};

std::string phase_text(lcl_surface_phase phase, const Engine& engine) {
    switch (phase) {
        case LCL_SURFACE_APPROXIMATE: return "approximating (" + engine.name + ")";
        case LCL_SURFACE_SIMPLIFY: return "simplifying";
        case LCL_SURFACE_SOLVE: return "solving";
        case LCL_SURFACE_MEASURE: return "measuring";
        default: return "refining";
    }
}

std::int32_t on_fit_progress(void* user, lcl_surface_phase phase, std::int32_t round, double fraction, double max_distance) {
    const FitProgress& state = *static_cast<FitProgress*>(user);
    std::string text = phase_text(phase, state.engine);
    if (phase >= LCL_SURFACE_SOLVE) text += ", round " + std::to_string(round + 1);
    if (max_distance >= 0.0) text += ", largest distance " + short_number(max_distance);
    state.progress.update(fraction, text);
    return interrupted() ? 0 : 1;
}

/// `settings`: room for the engine's options, which the struct points to.
lcl_surface_options fit_options(const Options& options, std::vector<lcl_engine_option>& settings, FitProgress& state) {
    for (const auto& [key, value] : options.engine_options) settings.push_back({key.c_str(), value.c_str()});
    lcl_surface_options fit = LCL_SURFACE_OPTIONS_INIT;
    fit.fit = options.fit;
    fit.tolerance = options.fit_tolerance;
    fit.max_vertices = options.most_vertices;
    fit.fill_holes = options.fill_holes;
    fit.fair = options.fit_fair;
    fit.boundary = options.boundary;
    fit.crease_angle_degrees = options.crease_angle;
    fit.engine_options = settings.data();
    fit.engine_option_count = settings.size();
    fit.precision = options.precision;
    fit.solve_tolerance = options.tolerance;
    fit.max_iterations = options.max_iterations;
    fit.keep_going = options.keep_going;
    fit.progress = on_fit_progress;
    fit.progress_user = &state;
    return fit;
}

/// The library builds kernels at their first use, while it solves and measures: `compiled` seconds, taken off both in proportion. What else the fit takes is
/// among its own seconds.
void note_seconds(Seconds& seconds, const lcl_surface_report& fit, double compiled) {
    const double all = fit.seconds_solve + fit.seconds_measure;
    add_seconds(seconds.compile, compiled);
    add_seconds(seconds.solve, all > compiled ? fit.seconds_solve * (1.0 - compiled / all) : 0.0);
}

/// Without a failure there is a mesh, with one there may be.
struct Fitted {
    std::optional<Failure> failure;  ///< singular, indefinite, not converged
    Mesh mesh;
};

Fitted fit_surface(Job& job, lcl_context context, lcl_cloud cloud, const Engine& engine, const lcl_scheme_options& scheme) {
    Progress& progress = job.terminal.progress();
    FitProgress state{progress, engine};
    std::vector<lcl_engine_option> settings;
    const lcl_surface_options options = fit_options(job.options, settings, state);
    FitSummary summary;
    lcl_mesh mesh = nullptr;
    Fitted fitted;
    const double compiled = lcl_context_compile_seconds(context);
    check_interrupt();
    progress.begin("fitting");
    const lcl_status status = lcl_surface(context, cloud, engine.engine, &scheme, &options, &mesh, &summary.report);
    progress.end();
    fitted.mesh.reset(mesh);
    if (status == LCL_ERROR_BAD_INPUT) check_of_input(job, status);
    if (status != LCL_OK) fitted.failure = failure_of(status);
    if (fitted.failure && !is_result(status)) throw *fitted.failure;
    note_seconds(job.report.seconds, summary.report, lcl_context_compile_seconds(context) - compiled);
    summary.solver = job.options.solver;
    summary.tolerance = job.options.fit_tolerance * summary.report.diagonal;
    job.report.fit = summary;
    return fitted;
}

void say_fit(Job& job, const Engine& engine) {
    const lcl_surface_report& fit = job.report.fit->report;
    const auto part = [](long long count, const char* one, const char* many) { return count > 0 ? "; " + counted(count, one, many) : std::string(); };
    job.terminal.say("points", counted(fit.point_count, "point measured", "points measured") +
                                   part(fit.duplicate_count, "duplicate dropped", "duplicates dropped") +
                                   part(fit.left_out_count, "outlier left out", "outliers left out") +
                                   part(fit.unused_count, "of them no vertex of the first mesh", "of them no vertices of the first mesh"));
    job.terminal.say("engine", engine.name + ": " + counted(fit.approximation_vertices, "vertex", "vertices") + ", " +
                                   counted(fit.approximation_faces, "face", "faces") + ", " + counted(fit.components, "component", "components") + ", " +
                                   (fit.boundary_loops == 0 ? "closed" : counted(fit.boundary_loops, "boundary loop", "boundary loops")) +
                                   part(fit.filled_holes, "hole filled", "holes filled") + part(fit.dropped_faces, "face dropped", "faces dropped") +
                                   part(fit.split_vertices, "vertex split", "vertices split"));
    job.terminal.say("fitted", counted(fit.vertices, "vertex", "vertices") + " in " + counted(fit.rounds, "round", "rounds") + " and " +
                                   counted(fit.iterations, "iteration", "iterations") + ": " + (fit.converged ? "converged" : "not converged"));
    job.terminal.say("distances", length_text(fit.rms, fit.diagonal) + " rms, " + length_text(fit.p95, fit.diagonal) + " for 95 %, " +
                                      length_text(fit.max, fit.diagonal) + " at most" +
                                      part(fit.outside_count, "point outside the tolerance", "points outside the tolerance"));
    if (job.options.crease_angle > 0.0) job.terminal.say("creases", counted(fit.creases, "edge", "edges"));
    job.terminal.say("phases", "approximate " + short_number(fit.seconds_approximate) + ", simplify " + short_number(fit.seconds_simplify) + ", solve " +
                                   short_number(fit.seconds_solve) + ", measure " + short_number(fit.seconds_measure) + ", refine " +
                                   short_number(fit.seconds_refine) + " seconds");
}

/// The one that --alpha auto chose: whoever reads OUT has to say it.
void note_alpha(Job& job, lcl_scheme_options scheme, double alpha) {
    scheme.alpha_auto = 0;
    scheme.alpha = alpha;
    note_scheme(job, scheme);
}

}  // namespace

void run_surface(Job& job) {
    DeviceOpening device(job);
    device.wait();
    const Engine engine = engine_of_options(job);  // wrong usage is told before any work
    note_parameters(job, engine);
    const Cloud cloud = read_cloud(job);
    say_cloud(job, cloud.get());
    const lcl_scheme_options scheme = scheme_of_options(job);
    const Context context = device.finish();
    say_scheme(job);

    const Fitted fitted = fit_surface(job, context.get(), cloud.get(), engine, scheme);
    const lcl_surface_report& report = job.report.fit->report;
    if (fitted.mesh) {
        note_alpha(job, scheme, report.alpha);
        job.report.mesh = summary_of(fitted.mesh.get());
        warn_of_notes(job, fitted.mesh.get());
        say_fit(job, engine);
    }
    if (!fitted.failure && !report.converged) warn(job, report.message);
    if (fitted.failure && !(job.options.keep_going && fitted.mesh)) throw *fitted.failure;
    check_output_format(job, fitted.mesh.get());
    write_output(job, fitted.mesh.get());
    if (fitted.failure) throw *fitted.failure;
}

}  // namespace lcl::cli
