// SPDX-License-Identifier: BSD-3-Clause
// The steps that commands share: read, check, open a device, make an operator, write. Each fills its part of the report and of the summary.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "host/cli/handles.h"
#include "host/cli/options.h"
#include "host/cli/report.h"
#include "host/cli/terminal.h"

namespace lcl::cli {

/// Messages of the library that came while another thread had the terminal and the report.
struct HeldLog {
    bool is_held = false;
    std::vector<std::pair<std::int32_t, std::string>> messages;  ///< level and text
};

/// One run of the program.
struct Job {
    const Options& options;
    Terminal& terminal;
    Report& report;
    HeldLog held_log = {};
};

/// Times a part of a command and shows it on the progress line; the seconds are added when it ends, also by an exception.
/// What a context spends on building programs meanwhile goes to `compile` instead.
class Phase {
public:
    Phase(Job& job, double Seconds::*seconds, const std::string& what, lcl_context context = nullptr);
    ~Phase();
    Phase(const Phase&) = delete;
    Phase& operator=(const Phase&) = delete;

private:
    Job& job_;
    double Seconds::*seconds_;
    lcl_context context_;
    double compiled_;
    std::chrono::steady_clock::time_point start_;
};

/// Adds to a phase of the report.
void add_seconds(double& phase, double seconds);

/// check() of a call that looks at the mesh of a file: its name stands before the sentence, if it is not in it.
void check_of_file(const std::string& name, lcl_status status);
/// The same of IN.
void check_of_input(const Job& job, lcl_status status);
std::string of_input(const Job& job, const std::string& message);

/// A warning in the report (once) and on standard error.
void warn(Job& job, const std::string& text);
/// The notes of a mesh that are warnings, as warnings.
void warn_of_notes(Job& job, lcl_mesh mesh);

/// All of standard input; Ctrl-C ends the waiting.
std::vector<char> standard_input();
/// IN with the sharp features of the options; the report gets its counts. Not checked further.
Mesh read_input(Job& job);
/// The same, refused (exit code 3) where it has no faces or is not sound.
Mesh read_sound_input(Job& job);
/// TO of a morph, refused where it is not sound. Its sharp features are not looked at.
Mesh read_target(Job& job);
MeshSummary summary_of(lcl_mesh mesh);
Histogram histogram_of(lcl_mesh mesh, lcl_histogram which);

/// Refuses what OUT's format cannot hold before anything is computed.
void check_output_format(const Job& job, lcl_mesh mesh);

/// The device of the options, which a thread opens while the mesh is read: loading the driver takes about as long.
class DeviceOpening {
public:
    explicit DeviceOpening(Job& job, std::launch policy = std::launch::async);
    /// Waits for the driver: libraries that are loaded later cannot bring versions of what it needs.
    void wait() const { context_.wait(); }
    /// Waits for it. Exit code 5 where there is none, or where it has no doubles and they were asked for. May be called once.
    Context finish();

private:
    Job& job_;
    std::future<Context> context_;
};
/// The same at once.
Context open_device(Job& job);
/// Operator of a mesh; its seconds go to topology and compile.
Operator make_operator(Job& job, lcl_context context, lcl_mesh mesh, const lcl_scheme_options& scheme);

/// Writes OUT: complete or not at all.
void write_output(Job& job, lcl_mesh mesh);

/// Name of a file that is read, for people: standard input has no name.
std::string shown_name(const std::string& path);
std::string shown_input(const Options& options);
/// OUT, for people.
std::string shown_output(const Options& options);
/// The line of the seconds by phase.
void say_seconds(Job& job);

}  // namespace lcl::cli
