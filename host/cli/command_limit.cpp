// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/failure.h"
#include "host/cli/limit_step.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"

namespace lcl::cli {

namespace {

/// Of the limit surface of the mesh as it is before its points move.
std::vector<double> limit_normals(Job& job, lcl_context context, lcl_operator A, lcl_mesh mesh) {
    std::vector<double> normals(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    const Phase phase(job, &Seconds::solve, "taking limit normals", context);
    check(lcl_limit_normals(A, mesh, nullptr, 0, job.options.precision, nullptr, 0, normals.data(), 0));
    return normals;
}

}  // namespace

void run_limit(Job& job) {
    DeviceOpening device(job);
    const Mesh mesh = read_sound_input(job);
    check_output_format(job, mesh.get());
    job.report.set_parameter("precision", std::string(precision_name(job.options.precision)));
    job.report.set_parameter("normals", job.options.limit_normals);
    const SchemeChoice scheme = choose_scheme(job, mesh.get());
    const std::vector<std::string> channels = choose_channels(job, mesh.get());
    const Context context = device.finish();
    const Operator A = make_operator(job, context.get(), mesh.get(), scheme.options);
    note_scheme_in_use(job, A.get());
    say_scheme(job);
    std::vector<double> normals;
    if (job.options.limit_normals) normals = limit_normals(job, context.get(), A.get(), mesh.get());
    move_to_limit(job, context.get(), A.get(), mesh.get(), channels);
    if (job.options.limit_normals) check(lcl_mesh_set_normals(mesh.get(), normals.data()));
    write_output(job, mesh.get());
}

}  // namespace lcl::cli
