// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/filter_step.h"

namespace lcl::cli {

void run_sharpen(Job& job) {
    DeviceOpening device(job);
    Mesh mesh = read_sound_input(job);
    check_output_format(job, mesh.get());
    lcl_sharpen_options options = LCL_SHARPEN_OPTIONS_INIT;
    options.precision = job.options.precision;
    options.first = job.options.band.first;
    options.last = job.options.band.last;
    options.k = job.options.sharpen_steps;
    options.progress = on_pass;
    options.progress_user = &job.terminal.progress();
    job.report.set_parameter("band", std::vector<int>{options.first, options.last});
    job.report.set_parameter("k", static_cast<std::int64_t>(options.k));
    Filter filter = open_filter(job, device, std::move(mesh));

    double* values = filter.values.data();
    run_passes(job, filter, "sharpening", [&] { return lcl_sharpen(filter.A.get(), values, 0, filter.width(), &options, values, 0); });
    job.terminal.say("sharpened", "terms " + std::to_string(options.first) + " to " + std::to_string(options.last) + " added " +
                                      counted(options.k, "time", "times") + ", " + counted(std::int64_t{options.k} * options.last, "pass", "passes"));
    round_colours(filter.colour_limits, static_cast<std::size_t>(lcl_mesh_vertex_count(filter.mesh.get())), values);
    scatter_values(filter.mesh.get(), filter.channels, values);
    write_output(job, filter.mesh.get());
}

}  // namespace lcl::cli
