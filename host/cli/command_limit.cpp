// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/failure.h"
#include "host/cli/limit_step.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"

namespace lcl::cli {

void run_limit(Job& job) {
    DeviceOpening device(job);
    const Mesh mesh = read_sound_input(job);
    check_output_format(job, mesh.get());
    job.report.set_parameter("precision", std::string(precision_name(job.options.precision)));
    const SchemeChoice scheme = choose_scheme(job, mesh.get());
    const std::vector<std::string> channels = choose_channels(job, mesh.get());
    const Context context = device.finish();
    const Operator A = make_operator(job, context.get(), mesh.get(), scheme.options);
    note_scheme_in_use(job, A.get());
    say_scheme(job);
    move_to_limit(job, context.get(), A.get(), mesh.get(), channels);
    write_output(job, mesh.get());
}

}  // namespace lcl::cli
