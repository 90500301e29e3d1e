// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/program.h"

#include <chrono>
#include <map>
#include <new>

#include "host/cli/commands.h"
#include "host/cli/csv.h"
#include "host/cli/failure.h"
#include "host/cli/interrupt.h"

namespace lcl::cli {

namespace {

using Command = void (*)(Job&);

const std::map<std::string, Command> commands = {
    {"devices", run_devices}, {"selftest", run_selftest}, {"info", run_info},         {"interpolate", run_interpolate}, {"limit", run_limit},
    {"refine", run_refine},   {"expand", run_expand},     {"spectrum", run_spectrum}, {"denoise", run_denoise},         {"sharpen", run_sharpen},
    {"morph", run_morph},     {"texture", run_texture},   {"evaluate", run_evaluate}, {"closest", run_closest},         {"surface", run_surface}};

int end_with(Job& job, const Failure& failure) {
    job.report.status = failure.status;
    job.report.message = failure.message;
    if (!failure.vertices.empty()) job.report.vertices = failure.vertices;
    if (!failure.faces.empty()) job.report.faces = failure.faces;
    job.terminal.error(failure.message);
    return failure.exit_code;
}

int run_command(Job& job) {
    try {
        commands.at(job.options.command)(job);
        return exit_ok;
    } catch (const Failure& failure) {
        return end_with(job, failure);
    } catch (const std::bad_alloc&) {
        return end_with(job, make_failure(exit_device, "the mesh is too large for this machine's memory: take a smaller one, or fewer --levels"));
    } catch (const std::exception& error) {
        return end_with(job, make_failure(exit_error, std::string("internal error: ") + error.what()));
    }
}

void write_report(Job& job) {
    const std::string& path = job.options.report;
    if (path.empty()) return;
    if (path == "-") return job.terminal.result(to_json(job.report));
    OutputFile file(path);
    file.write(to_json(job.report));
    file.finish();
}

/// A command that failed keeps its own exit code, even if its report cannot be written either.
int finish_report(Job& job, int exit_code) {
    try {
        write_report(job);
        return exit_code;
    } catch (const Failure& failure) {
        job.terminal.error("the report: " + failure.message);
        return exit_code == exit_ok ? failure.exit_code : exit_code;
    }
}

int run(const Options& options) {
    const auto start = std::chrono::steady_clock::now();
    Terminal terminal(options);
    Report report;
    report.command = options.command;
    Job job{options, terminal, report};
    const int exit_code = run_command(job);
    report.seconds.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (exit_code == exit_ok && !options.output.empty()) say_seconds(job);
    return finish_report(job, exit_code);
}

}  // namespace

int run_program(int argc, char** argv) {
    watch_signals();
    Options options;
    try {
        if (const std::optional<int> exit_code = parse_options(argc, argv, options)) return *exit_code;
    } catch (const Failure& failure) {
        Terminal(options).error(failure.message);
        return failure.exit_code;
    }
    return run(options);
}

}  // namespace lcl::cli
