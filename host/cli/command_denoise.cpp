// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/filter_step.h"
#include "host/cli/option_names.h"

namespace lcl::cli {

namespace {

lcl_denoise_options denoise_options(Job& job) {
    const Options& options = job.options;
    lcl_denoise_options denoise = LCL_DENOISE_OPTIONS_INIT;
    denoise.precision = options.precision;
    denoise.m = options.m;
    denoise.k = options.k;
    if (options.has("--strength")) check(lcl_denoise_settings(options.strength, &denoise.m, &denoise.k));
    denoise.plain = options.plain;
    denoise.progress = on_pass;
    denoise.progress_user = &job.terminal.progress();
    return denoise;
}

void note_denoise(Job& job, const lcl_denoise_options& denoise) {
    const Options& options = job.options;
    if (options.has("--strength")) job.report.set_parameter("strength", options.strength);
    job.report.set_parameter("m", static_cast<std::int64_t>(denoise.m));
    job.report.set_parameter("k", static_cast<std::int64_t>(denoise.k));
    job.report.set_parameter("plain", options.plain);
    job.report.set_parameter("operator", std::string(name_of(operator_names, options.feature_operator)));
    job.report.set_parameter("keep_volume", options.keep_volume);
}

std::string filter_text(const lcl_denoise_options& denoise) {
    const std::int64_t passes = std::int64_t{denoise.k} * (denoise.m + 1) + (denoise.plain ? 0 : 1);
    return "D^" + std::to_string(denoise.k) + (denoise.plain ? "" : " A") + " with m = " + std::to_string(denoise.m) + ", " + counted(passes, "pass", "passes");
}

bool is_closed(const Job& job) { return job.report.mesh->info.boundary_edges == 0; }

/// A mesh with a boundary encloses nothing: known before anything is computed.
void require_closed(const Job& job) {
    if (!job.options.keep_volume || is_closed(job)) return;
    fail(exit_bad_input, shown_input(job.options) + ": --keep-volume needs a closed mesh, and this one has " +
                             counted(job.report.mesh->info.boundary_edges, "boundary edge", "boundary edges") + ": leave it out, or close the mesh");
}

double volume_of(lcl_mesh mesh) {
    double volume = 0.0;
    check(lcl_mesh_get_volume(mesh, &volume));
    return volume;
}

/// Moves the points, which the mesh holds now, until it encloses as much as with the points `before` (vertex_count x 3).
void restore_volume(Job& job, const Filter& filter, const std::vector<double>& before) {
    const Phase phase(job, &Seconds::solve, "restoring the volume");
    check(lcl_mesh_match_volume(filter.mesh.get(), before.data(), 0, filter.pinned.data(), filter.pinned.size()));
}

std::vector<double> points_of(lcl_mesh mesh) {
    std::vector<double> points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    check(lcl_mesh_get_points(mesh, points.data(), 0));
    return points;
}

void say_volume(Job& job) {
    if (!job.report.volume) return;
    const auto [before, after] = *job.report.volume;
    job.terminal.say("volume", short_number(before) + " before, " + short_number(after) + " after");
}

}  // namespace

void run_denoise(Job& job) {
    DeviceOpening device(job);
    Mesh mesh = read_sound_input(job);
    check_output_format(job, mesh.get());
    require_closed(job);
    const lcl_denoise_options options = denoise_options(job);
    note_denoise(job, options);
    Filter filter = open_filter(job, device, std::move(mesh));
    const std::vector<double> before = job.options.keep_volume ? points_of(filter.mesh.get()) : std::vector<double>();
    const double volume_before = is_closed(job) ? volume_of(filter.mesh.get()) : 0.0;

    double* values = filter.values.data();
    run_passes(job, filter, "filtering", [&] { return lcl_denoise(filter.A.get(), values, 0, filter.width(), &options, values, 0); });
    job.terminal.say("filtered", filter_text(options));
    round_colours(filter.colour_limits, static_cast<std::size_t>(lcl_mesh_vertex_count(filter.mesh.get())), values);
    scatter_values(filter.mesh.get(), filter.channels, values);
    if (job.options.keep_volume) restore_volume(job, filter, before);
    if (is_closed(job)) job.report.volume = {volume_before, volume_of(filter.mesh.get())};
    say_volume(job);
    write_output(job, filter.mesh.get());
}

}  // namespace lcl::cli
