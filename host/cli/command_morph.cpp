// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <exception>

#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/filter_step.h"
#include "host/cli/interrupt.h"
#include "host/cli/option_names.h"

namespace lcl::cli {

namespace {

/// What is written while the library makes frame after frame.
struct FrameWriter {
    Job& job;
    Filter& filter;
    int written = 0;
    double seconds = 0.0;             ///< of writing
    std::exception_ptr failure = {};  ///< why it stopped; exceptions do not cross the library
};

void write_frame(FrameWriter& writer, std::int32_t frame, double* points) {
    const auto start = std::chrono::steady_clock::now();
    lcl_mesh mesh = writer.filter.mesh.get();
    round_colours(writer.filter.colour_limits, static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)), points);
    scatter_values(mesh, writer.filter.channels, points);
    check(lcl_mesh_write(mesh, writer.job.options.frame_pattern.name(frame).c_str(), LCL_FORMAT_BY_ENDING));
    ++writer.written;
    writer.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::int32_t on_frame(void* user, std::int32_t frame, double* points) {
    FrameWriter& writer = *static_cast<FrameWriter*>(user);
    const int last = writer.job.options.frames;
    try {
        writer.job.terminal.progress().update(static_cast<double>(frame) / last, "frame " + std::to_string(frame) + " of " + std::to_string(last));
        write_frame(writer, frame, points);
    } catch (...) {
        writer.failure = std::current_exception();
        return 0;
    }
    return interrupted() ? 0 : 1;
}

/// Frames that were written before Ctrl-C stay.
void check_morph(const FrameWriter& writer, lcl_status status) {
    if (writer.failure) std::rethrow_exception(writer.failure);
    if (status == LCL_OK) return;
    Failure failure = failure_of(status);
    if (failure.exit_code == exit_interrupted && writer.written > 0)
        failure.message =
            "interrupted: " + counted(writer.written, "frame was", "frames were") + " written, of " + std::to_string(writer.job.options.frames + 1);
    throw failure;
}

lcl_morph_options morph_options(const Options& options) {
    lcl_morph_options morph = LCL_MORPH_OPTIONS_INIT;
    morph.precision = options.precision;
    morph.path = options.path;
    morph.frames = options.frames;
    if (options.path == LCL_MORPH_LINEAR) return morph;
    morph.m = options.morph_m.data();
    morph.m_count = std::min(options.morph_m.size(), static_cast<std::size_t>(options.frames));
    if (options.path == LCL_MORPH_EVEN) return morph;
    morph.rho = options.rho.data();
    morph.rho_count = std::min(options.rho.size(), static_cast<std::size_t>(options.frames));
    return morph;
}

void note_morph(Job& job, const lcl_morph_options& morph) {
    job.report.set_parameter("to", job.options.target);
    job.report.set_parameter("frames", static_cast<std::int64_t>(morph.frames));
    job.report.set_parameter("path", std::string(path_name(morph.path)));
    if (morph.m) job.report.set_parameter("m", std::vector<int>(morph.m, morph.m + morph.m_count));
    if (morph.rho) job.report.set_parameter("rho", std::vector<double>(morph.rho, morph.rho + morph.rho_count));
}

void warn_of_unused(Job& job) {
    const Options& options = job.options;
    for (const auto& [flag, count] : {std::pair("--m", options.morph_m.size()), std::pair("--rho", options.rho.size())}) {
        if (!options.has(flag)) continue;
        if (options.path == LCL_MORPH_LINEAR) warn(job, std::string("straight lines have no filter: ") + flag + " is left out");
        else if (count > static_cast<std::size_t>(options.frames))
            warn(job, std::string(flag) + " has " + std::to_string(count) + " entries, and " + counted(options.frames, "step uses", "steps use") +
                          " the first of them");
    }
}

/// For rho = 1 the mean of the difference never moves.
void warn_of_no_end(Job& job, const lcl_morph_options& morph) {
    if (morph.rho_count > 0 && std::all_of(morph.rho, morph.rho + morph.rho_count, [](double rho) { return rho == 1.0; }))
        warn(job, "with rho 1 the frames tend to a translation of TO, and slowly: take a smaller --rho, or --even");
}

void require_same_faces(const Job& job, lcl_mesh from, lcl_mesh to) { check_of_file(shown_name(job.options.target), lcl_mesh_compare_faces(from, to)); }

void require_channels(const Job& job, lcl_mesh to, const std::vector<std::string>& channels) {
    const std::vector<std::string> there = all_channels(to);
    for (const std::string& channel : channels) {
        if (std::find(there.begin(), there.end(), channel) == there.end())
            fail(exit_bad_input, shown_name(job.options.target) + ": it has no per-vertex data '" + channel + "', which --channels takes from " +
                                     shown_input(job.options) + ": leave it out of --channels");
    }
}

void write_frames(Job& job, Filter& filter, const std::vector<double>& to, const lcl_morph_options& options) {
    FrameWriter writer{job, filter};
    lcl_status status = LCL_OK;
    {
        const Phase phase(job, &Seconds::solve, "morphing", filter.context.get());
        status = lcl_morph(filter.A.get(), filter.values.data(), to.data(), 0, filter.width(), &options, on_frame, &writer);
    }
    job.report.seconds.solve = std::max(job.report.seconds.solve - writer.seconds, 0.0);
    add_seconds(job.report.seconds.write, writer.seconds);
    warn_of_notes(job, filter.mesh.get());
    check_morph(writer, status);
}

}  // namespace

void run_morph(Job& job) {
    DeviceOpening device(job);
    Mesh from = read_sound_input(job);
    const Mesh to = read_target(job);
    require_same_faces(job, from.get(), to.get());
    check_output_format(job, from.get());
    const lcl_morph_options options = morph_options(job.options);
    note_morph(job, options);
    warn_of_unused(job);
    warn_of_no_end(job, options);
    Filter filter = open_filter(job, device, std::move(from));
    require_channels(job, to.get(), filter.channels);
    write_frames(job, filter, gather_values(to.get(), filter.channels), options);
    const FramePattern& names = job.options.frame_pattern;
    job.terminal.say("wrote", names.name(0) + " to " + names.name(options.frames) + ": " + counted(options.frames + 1, "frame", "frames"));
}

}  // namespace lcl::cli
