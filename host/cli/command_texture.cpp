// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>

#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/failure.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"
#include "host/cli/solve_step.h"

namespace lcl::cli {

namespace {

int levels_of(const Options& options) { return options.has("--levels") ? options.texture_levels : options.octaves - 1; }

lcl_texture_options texture_options(const Options& options, SolveProgress& state) {
    lcl_texture_options texture = LCL_TEXTURE_OPTIONS_INIT;
    texture.octaves = options.octaves;
    texture.levels = levels_of(options);
    texture.frequency = options.frequency;
    texture.seed = options.seed;
    texture.colours = options.colours.empty() ? nullptr : options.colours.data();
    texture.colour_count = options.colours.size() / 3;
    texture.precision = options.precision;
    texture.tolerance = options.tolerance;
    texture.max_iterations = options.max_iterations;
    texture.keep_going = options.keep_going;
    texture.progress = on_solve_progress;
    texture.progress_user = &state;
    return texture;
}

void note_texture(Job& job) {
    const Options& options = job.options;
    job.report.set_parameter("octaves", static_cast<std::int64_t>(options.octaves));
    job.report.set_parameter("frequency", options.frequency);
    job.report.set_parameter("levels", static_cast<std::int64_t>(levels_of(options)));
    if (options.has("--colors")) job.report.set_parameter("colors", options.colours);
    job.report.set_parameter("seed", static_cast<std::int64_t>(options.seed));
    job.report.set_parameter("on_mesh", options.on_mesh);
    job.report.set_parameter("tolerance", options.tolerance);
    job.report.set_parameter("max_iter", static_cast<std::int64_t>(options.max_iterations));
    job.report.set_parameter("precision", std::string(precision_name(options.precision)));
}

/// The textured mesh, and the failure that --keep-going goes past.
struct Textured {
    Mesh mesh;
    std::optional<Failure> failure;
};

Textured make_texture(Job& job, lcl_context context, lcl_mesh mesh, const lcl_scheme_options& scheme) {
    SolveProgress state{&job.terminal.progress(), 0};
    const lcl_texture_options options = texture_options(job.options, state);
    std::vector<double> residuals = residual_space(options.max_iterations);
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    report.residuals = residuals.data();
    report.residual_capacity = residuals.size();
    lcl_mesh handle = nullptr;
    const Phase phase(job, &Seconds::solve, "making the texture", context);
    const lcl_status status = lcl_texture(context, mesh, &scheme, &options, &handle, &report);
    Textured textured{Mesh(handle), std::nullopt};
    if (status != LCL_OK && !is_result(status)) throw failure_of(status);
    note_solve(job, report, std::move(residuals));
    if (status != LCL_OK) textured.failure = failure_of(status);
    if (textured.failure && !(job.options.keep_going && textured.mesh)) throw *textured.failure;
    return textured;
}

/// vertex_count values.
std::vector<double> property_of(lcl_mesh mesh, const std::string& name) {
    const std::vector<std::string> there = all_channels(mesh);
    const auto place = std::find(there.begin(), there.end(), name) - there.begin();
    std::vector<double> values(static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    check(lcl_mesh_get_property(mesh, static_cast<std::int32_t>(place), values.data()));
    return values;
}

/// Colours and noise of the textured mesh's first vertices, which are those of IN.
void take_over(lcl_mesh mesh, lcl_mesh textured) {
    const auto vertex_count = static_cast<std::size_t>(lcl_mesh_vertex_count(mesh));
    std::vector<double> colours(3 * vertex_count);
    std::size_t channel = 0;
    for (const char* name : {"red", "green", "blue"}) {
        const std::vector<double> values = property_of(textured, name);
        for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) colours[3 * vertex + channel] = values[vertex] / 255.0;
        ++channel;
    }
    check(lcl_mesh_set_colours(mesh, colours.data()));
    check(lcl_mesh_set_property(mesh, "noise", property_of(textured, "noise").data()));
}

}  // namespace

void run_texture(Job& job) {
    DeviceOpening device(job);
    const Mesh mesh = read_sound_input(job);
    if (job.options.on_mesh) check_output_format(job, mesh.get());
    note_texture(job);
    if (job.options.channels != "all" && job.options.channels != "none") choose_channels(job, mesh.get());  // names are checked; all are refined in any case
    SchemeChoice scheme = choose_scheme(job, mesh.get());
    Context context = device.finish();
    resolve_alpha(job, context, mesh.get(), scheme.options);
    say_scheme(job);
    const Textured textured = make_texture(job, context.get(), mesh.get(), scheme.options);
    job.terminal.say("textured", counted(job.options.octaves, "octave", "octaves") + " on " + counted(levels_of(job.options), "level", "levels") + ": " +
                                     counted(lcl_mesh_vertex_count(textured.mesh.get()), "vertex", "vertices"));
    warn_of_notes(job, textured.mesh.get());
    if (job.options.on_mesh) take_over(mesh.get(), textured.mesh.get());
    write_output(job, job.options.on_mesh ? mesh.get() : textured.mesh.get());
    if (textured.failure) throw *textured.failure;
}

}  // namespace lcl::cli
