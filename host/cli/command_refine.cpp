// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/csv.h"
#include "host/cli/failure.h"
#include "host/cli/limit_step.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"

namespace lcl::cli {

namespace {

Mesh refined_mesh(Job& job, lcl_mesh mesh, const lcl_scheme_options& scheme) {
    lcl_refine_options options = LCL_REFINE_OPTIONS_INIT;
    options.levels = job.options.levels > 0 ? job.options.levels : -1;
    lcl_mesh refined = nullptr;
    const Phase phase(job, &Seconds::topology, "refining");
    check(lcl_mesh_refine(mesh, &scheme, &options, &refined));
    return Mesh(refined);
}

/// alpha and lambda rule the first refinement alone: what it gives is read without them.
lcl_scheme_options scheme_of_refined(const Job& job, const lcl_scheme_options& scheme) {
    lcl_scheme_options options = scheme;
    if (job.options.levels == 0) return options;
    options.alpha = 0.0;
    options.lambda = 0.0;
    options.lambda_per_vertex = nullptr;
    return options;
}

/// An isolated vertex lies on no face: its face and corner are -1, its parameters do not exist.
void append_location(std::string& text, std::size_t vertex, std::int32_t face, std::int32_t corner, const double* uv) {
    text += std::to_string(vertex) + "," + std::to_string(face) + "," + std::to_string(face < 0 ? -1 : corner);
    for (int axis = 0; axis < 2; ++axis) append_cell(text, face < 0 ? NAN : uv[axis]);
    text += "\n";
}

void write_map(Job& job, lcl_mesh refined) {
    const std::string& path = job.options.map_file;
    const auto vertex_count = static_cast<std::size_t>(lcl_mesh_vertex_count(refined));
    std::vector<std::int32_t> faces(vertex_count), corners(vertex_count);
    std::vector<double> uv(2 * vertex_count);
    check(lcl_mesh_get_locations(refined, faces.data(), corners.data(), uv.data()));
    const Phase phase(job, &Seconds::write, "writing " + path);
    OutputFile file(path);
    file.write("vertex,face,corner,u,v\n");
    std::string line;
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
        line.clear();
        append_location(line, vertex, faces[vertex], corners[vertex], &uv[2 * vertex]);
        file.write(line);
    }
    file.finish();
    job.terminal.say("wrote", path + ": where each of the new vertices lies");
}

}  // namespace

void run_refine(Job& job) {
    const Mesh mesh = read_sound_input(job);
    job.report.set_parameter("levels", static_cast<std::int64_t>(job.options.levels));
    job.report.set_parameter("limit", job.options.limit);
    if (job.options.channels != "all" && job.options.channels != "none") choose_channels(job, mesh.get());  // names are checked; all are refined in any case
    SchemeChoice scheme = choose_scheme(job, mesh.get());
    Context context;
    resolve_alpha(job, context, mesh.get(), scheme.options);
    const Mesh refined = refined_mesh(job, mesh.get(), scheme.options);
    say_scheme(job);
    if (job.options.limit) {
        job.report.set_parameter("precision", std::string(precision_name(job.options.precision)));
        if (!context) context = open_device(job);
        const Operator A = make_operator(job, context.get(), refined.get(), scheme_of_refined(job, scheme.options));
        move_to_limit(job, context.get(), A.get(), refined.get(), all_channels(refined.get()));
    }
    warn_of_notes(job, refined.get());
    if (!job.options.map_file.empty()) write_map(job, refined.get());  // first: where it fails, OUT is as it was
    write_output(job, refined.get());
}

}  // namespace lcl::cli
