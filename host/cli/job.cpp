// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/job.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <unistd.h>

#include "host/cli/failure.h"
#include "host/cli/features.h"
#include "host/cli/interrupt.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"

namespace lcl::cli {

namespace {

std::string of_file(const std::string& name, const std::string& message) { return message.find(name) == std::string::npos ? name + ": " + message : message; }

void log_to_terminal(void* user, std::int32_t level, const char* message) {
    Job& job = *static_cast<Job*>(user);
    if (job.held_log.is_held) job.held_log.messages.emplace_back(level, message);
    else if (level <= LCL_LOG_WARNING) warn(job, message);
    else job.terminal.log(message);
}

void release_log(Job& job) {
    job.held_log.is_held = false;
    for (const auto& [level, message] : std::exchange(job.held_log.messages, {})) log_to_terminal(&job, level, message.c_str());
}

Mesh read_mesh(Job& job, const std::string& path) {
    const Phase phase(job, &Seconds::read, "reading " + shown_name(path));
    const bool with_normals = job.options.normals == "mesh";
    lcl_mesh mesh = nullptr;
    if (path != "-") {
        const auto read = with_normals ? lcl_mesh_read_with_normals : lcl_mesh_read;
        check(read(path.c_str(), LCL_FORMAT_BY_ENDING, &mesh));
    } else {
        const std::vector<char> bytes = standard_input();
        const auto read = with_normals ? lcl_mesh_read_memory_with_normals : lcl_mesh_read_memory;
        check(read(bytes.data(), bytes.size(), job.options.format, "standard input", &mesh));
    }
    return Mesh(mesh);
}

void say_mesh(Job& job, lcl_mesh mesh) {
    const lcl_mesh_info& info = job.report.mesh->info;
    std::string text = shown_input(job.options) + ": " + counted(lcl_mesh_vertex_count(mesh), "vertex", "vertices") + ", " +
                       counted(lcl_mesh_face_count(mesh), "face", "faces");
    if (info.edges >= 0) {
        text += ", " + counted(info.edges, "edge", "edges") + "; ";
        text += info.boundary_loops == 0 ? "closed" : counted(info.boundary_loops, "boundary loop", "boundary loops");
        text += ", " + counted(info.components, "component", "components");
        if (info.isolated_vertices > 0) text += ", " + counted(info.isolated_vertices, "isolated vertex", "isolated vertices");
        if (info.creases > 0) text += ", " + counted(info.creases, "crease edge", "crease edges");
    }
    job.terminal.say("read", text);
}

void note_boundary(Job& job, lcl_mesh mesh) {
    lcl_boundary boundary = LCL_BOUNDARY_DEFAULT;
    if (lcl_mesh_get_features(mesh, &boundary, nullptr, nullptr, nullptr, nullptr) != LCL_OK) return;
    if (boundary == LCL_BOUNDARY_DEFAULT) boundary = LCL_BOUNDARY_EDGE_AND_CORNER;
    job.report.set_parameter("boundary", std::string(boundary_name(boundary)));
}

void require_precision(const Job& job, const lcl_device_info& device) {
    if (job.options.precision != LCL_PRECISION_DOUBLE || device.has_double) return;
    fail(exit_device,
         std::string("the device '") + device.name + "' has no double precision: take --precision mixed, or another --device (`limitcl devices` lists them)");
}

}  // namespace

Phase::Phase(Job& job, double Seconds::*seconds, const std::string& what, lcl_context context)
    : job_(job), seconds_(seconds), context_(context), compiled_(lcl_context_compile_seconds(context)), start_(std::chrono::steady_clock::now()) {
    check_interrupt();
    job.terminal.progress().begin(what);
}

Phase::~Phase() {
    job_.terminal.progress().end();
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double compiled = lcl_context_compile_seconds(context_) - compiled_;
    add_seconds(job_.report.seconds.*seconds_, elapsed - compiled);
    add_seconds(job_.report.seconds.compile, compiled);
}

void check_of_file(const std::string& name, lcl_status status) {
    if (status == LCL_OK) return;
    Failure failure = failure_of(status);
    failure.message = of_file(name, failure.message);
    throw failure;
}

void check_of_input(const Job& job, lcl_status status) { check_of_file(shown_input(job.options), status); }

std::string of_input(const Job& job, const std::string& message) { return of_file(shown_input(job.options), message); }

void add_seconds(double& phase, double seconds) { phase += std::max(seconds, 0.0); }

void warn(Job& job, const std::string& text) {
    auto& warnings = job.report.warnings;
    if (std::find(warnings.begin(), warnings.end(), text) != warnings.end()) return;
    warnings.push_back(text);
    job.terminal.warn(text);
}

void warn_of_notes(Job& job, lcl_mesh mesh) {
    for (int index = 0; index < lcl_mesh_note_count(mesh, LCL_NOTE_WARNING); ++index) warn(job, lcl_mesh_note(mesh, LCL_NOTE_WARNING, index));
}

/// Read here, not by the library: a pipe may let wait for ever.
std::vector<char> standard_input() {
    std::vector<char> bytes(1 << 16);
    for (std::size_t size = 0;;) {
        check_interrupt();
        if (size == bytes.size()) bytes.resize(2 * size);
        const ssize_t count = ::read(STDIN_FILENO, bytes.data() + size, bytes.size() - size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(exit_bad_input, std::string("standard input cannot be read: ") + std::strerror(errno));
        size += static_cast<std::size_t>(count);
        if (count > 0) continue;
        bytes.resize(size);
        return bytes;
    }
}

Mesh read_input(Job& job) {
    Mesh mesh = read_mesh(job, job.options.input);
    {
        const Phase phase(job, &Seconds::topology, "checking the mesh");
        add_features(job, mesh.get());
        job.report.mesh = summary_of(mesh.get());
        note_boundary(job, mesh.get());
    }
    job.report.scheme = scheme_name(default_scheme(job.options, mesh.get()));
    if (job.options.command != "info") say_mesh(job, mesh.get());  // there the table says it
    warn_of_notes(job, mesh.get());
    return mesh;
}

Mesh read_sound_input(Job& job) {
    Mesh mesh = read_input(job);
    if (lcl_mesh_face_count(mesh.get()) == 0) fail(exit_bad_input, shown_input(job.options) + ": the mesh has no faces: a surface needs at least one");
    check_of_input(job, lcl_mesh_validate(mesh.get()));
    check_interrupt();
    return mesh;
}

Mesh read_target(Job& job) {
    Mesh mesh = read_mesh(job, job.options.target);
    const std::string name = shown_name(job.options.target);
    job.terminal.say("to", name + ": " + counted(lcl_mesh_vertex_count(mesh.get()), "vertex", "vertices") + ", " +
                               counted(lcl_mesh_face_count(mesh.get()), "face", "faces"));
    warn_of_notes(job, mesh.get());
    const Phase phase(job, &Seconds::topology, "checking " + name);
    check_of_file(name, lcl_mesh_validate(mesh.get()));
    return mesh;
}

MeshSummary summary_of(lcl_mesh mesh) {
    MeshSummary summary;
    check(lcl_mesh_get_info(mesh, &summary.info));
    summary.face_degrees = histogram_of(mesh, LCL_HISTOGRAM_FACE_DEGREES);
    if (summary.info.edges >= 0) summary.valences = histogram_of(mesh, LCL_HISTOGRAM_VALENCES);
    return summary;
}

Histogram histogram_of(lcl_mesh mesh, lcl_histogram which) {
    size_t size = 64;  // more kinds than most meshes have
    std::vector<std::int32_t> keys, counts;
    do {
        keys.resize(size), counts.resize(size);
        check(lcl_mesh_get_histogram(mesh, which, keys.data(), counts.data(), keys.size(), &size));
    } while (size > keys.size());
    Histogram histogram;
    for (size_t index = 0; index < size; ++index) histogram.emplace_back(keys[index], counts[index]);
    return histogram;
}

void check_output_format(const Job& job, lcl_mesh mesh) {
    lcl_format format = job.options.format;
    if (job.options.output != "-") check(lcl_format_of_path(job.options.output.c_str(), &format));
    if (format != LCL_FORMAT_STL) return;
    for (const auto& [degree, count] : histogram_of(mesh, LCL_HISTOGRAM_FACE_DEGREES)) {
        if (degree != 3 && count > 0)
            fail(exit_usage, "STL holds triangles only, and the mesh has " + counted(count, "face", "faces") + " with " + std::to_string(degree) +
                                 " sides: write to .obj, .off, .ply or .om");
    }
}

DeviceOpening::DeviceOpening(Job& job, std::launch policy) : job_(job) {
    const auto open = [&job] {
        lcl_context_options options = LCL_CONTEXT_OPTIONS_INIT;
        options.device = job.options.device.empty() ? nullptr : job.options.device.c_str();
        options.log = log_to_terminal;
        options.log_user = &job;
        options.log_level = job.options.verbosity == 0 ? LCL_LOG_WARNING : job.options.verbosity == 1 ? LCL_LOG_INFO : LCL_LOG_DEBUG;
        lcl_context handle = nullptr;
        check(lcl_context_create(&options, &handle));
        return Context(handle);
    };
    job.held_log.is_held = true;
    try {
        context_ = std::async(policy, open);
    } catch (const std::system_error&) {  // no thread can be had
        context_ = std::async(std::launch::deferred, open);
    }
}

Context DeviceOpening::finish() {
    check_interrupt();
    context_.wait();
    release_log(job_);
    Context context = context_.get();
    lcl_device_info device = LCL_DEVICE_INFO_INIT;
    check(lcl_context_get_device(context.get(), &device));
    job_.report.device = device;
    job_.terminal.say("device", std::string(device.name) + " (" + device.platform + ", " + device.version + ")");
    require_precision(job_, device);
    return context;
}

Context open_device(Job& job) { return DeviceOpening(job, std::launch::deferred).finish(); }

Operator make_operator(Job& job, lcl_context context, lcl_mesh mesh, const lcl_scheme_options& scheme) {
    const Phase phase(job, &Seconds::topology, "building the limit operator", context);
    lcl_operator handle = nullptr;
    check(lcl_operator_create(context, mesh, &scheme, &handle));
    return Operator(handle);
}

void write_output(Job& job, lcl_mesh mesh) {
    const std::string shown = shown_output(job.options);
    {
        const Phase phase(job, &Seconds::write, "writing " + shown);
        check(lcl_mesh_write(mesh, job.options.output.c_str(), job.options.output == "-" ? job.options.format : LCL_FORMAT_BY_ENDING));
    }
    warn_of_notes(job, mesh);
    job.terminal.say("wrote",
                     shown + ": " + counted(lcl_mesh_vertex_count(mesh), "vertex", "vertices") + ", " + counted(lcl_mesh_face_count(mesh), "face", "faces"));
}

std::string shown_name(const std::string& path) { return path == "-" ? "standard input" : path; }

std::string shown_input(const Options& options) { return shown_name(options.input); }

std::string shown_output(const Options& options) { return options.output == "-" ? "standard output" : options.output; }

void say_seconds(Job& job) {
    const Seconds& seconds = job.report.seconds;
    const std::pair<const char*, double> phases[] = {{"read", seconds.read},     {"topology", seconds.topology}, {"compile", seconds.compile},
                                                     {"upload", seconds.upload}, {"solve", seconds.solve},       {"download", seconds.download},
                                                     {"write", seconds.write},   {"total", seconds.total}};
    std::vector<std::string> parts;
    for (const auto& [name, value] : phases) {
        if (value > 0.0) parts.push_back(std::string(name) + " " + short_number(value));
    }
    job.terminal.say("seconds", join(parts, ", "));
}

}  // namespace lcl::cli
