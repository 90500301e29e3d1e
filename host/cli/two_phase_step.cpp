// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/two_phase_step.h"

#include <algorithm>
#include <cmath>

#include "host/cli/csv.h"
#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

std::vector<char> subset_marks(lcl_mesh mesh, const SchemeChoice& scheme) {
    std::vector<char> marks(static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)), scheme.subset.empty());
    for (const std::int32_t vertex : scheme.subset) marks[static_cast<std::size_t>(vertex)] = 1;
    return marks;
}

/// 0 0 0 where the file lists none.
std::vector<double> read_normals(const std::string& path, const std::vector<char>& in_subset) {
    const Table table = read_table(path, "vertex,nx,ny,nz");
    std::vector<double> normals(3 * in_subset.size(), 0.0);
    std::vector<char> seen(in_subset.size(), 0);
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const auto vertex = static_cast<std::size_t>(vertex_of_row(table, row, seen));
        const double* const normal = &table.values[4 * row + 1];
        if (!std::isfinite(normal[0]) || !std::isfinite(normal[1]) || !std::isfinite(normal[2]))
            fail_at(path, table.lines[row], "a normal needs finite numbers");
        if (normal[0] == 0.0 && normal[1] == 0.0 && normal[2] == 0.0)
            fail_at(path, table.lines[row], "the normal is zero, which is no direction: correct it, or leave the line out");
        if (!in_subset[vertex])
            fail_at(path, table.lines[row],
                    "vertex " + std::to_string(vertex) + " is not in the subset that is interpolated: leave the line out, or add the vertex");
        std::copy(normal, normal + 3, &normals[3 * vertex]);
    }
    return normals;
}

/// Those of IN, 0 0 0 where it has none or the vertex is not to be interpolated.
std::vector<double> normals_of_input(Job& job, lcl_mesh mesh, const std::vector<char>& in_subset) {
    std::vector<double> normals(3 * in_subset.size());
    check_of_input(job, lcl_mesh_get_normals(mesh, normals.data()));
    std::vector<std::int32_t> corners(static_cast<std::size_t>(lcl_mesh_corner_count(mesh)));
    check(lcl_mesh_get_faces(mesh, nullptr, corners.data()));
    std::vector<char> used(in_subset.size(), 0);
    for (const std::int32_t vertex : corners) used[static_cast<std::size_t>(vertex)] = 1;
    for (std::size_t v = 0; v < in_subset.size(); ++v) {
        double* const normal = &normals[3 * v];
        const bool is_given = std::isfinite(normal[0]) && std::isfinite(normal[1]) && std::isfinite(normal[2]);
        if (is_given && used[v] && in_subset[v] && normal[0] == 0.0 && normal[1] == 0.0 && normal[2] == 0.0) {
            Failure failure =
                make_failure(exit_bad_input, of_input(job, "the normal of vertex " + std::to_string(v) + " is zero, which is no direction: correct it"));
            failure.vertices.push_back(static_cast<std::int32_t>(v));
            throw failure;
        }
        if (!is_given || !in_subset[v]) std::fill(normal, normal + 3, 0.0);
    }
    return normals;
}

/// 1 where the file lists none.
std::vector<double> read_handles(const std::string& path, std::size_t vertex_count) {
    const Table table = read_table(path, "vertex,s");
    std::vector<double> handles(vertex_count, 1.0);
    std::vector<char> seen(vertex_count, 0);
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const double handle = table.values[2 * row + 1];
        if (!(handle > 0.0) || !std::isfinite(handle)) fail_at(path, table.lines[row], "the shape handle " + short_number(handle) + " is not a number above 0");
        handles[static_cast<std::size_t>(vertex_of_row(table, row, seen))] = handle;
    }
    return handles;
}

void note_parameters(Job& job) {
    const Options& options = job.options;
    job.report.set_parameter("refined", true);
    if (!options.normals.empty()) job.report.set_parameter("normals", options.normals);
    if (!options.handles_file.empty()) job.report.set_parameter("handles", options.handles_file);
    else if (options.has("--handles")) job.report.set_parameter("handles", std::vector<double>{options.handles[0], options.handles[1]});
    if (options.fair > 0.0) job.report.set_parameter("fair", options.fair);
}

std::string first_of(const std::int32_t* vertices, std::int32_t count) {
    std::string text = "vertex " + std::to_string(vertices[0]);
    return count > 1 ? text + " and " + std::to_string(count - 1) + " more" : text;
}

}  // namespace

TwoPhaseChoice choose_two_phase(Job& job, lcl_mesh mesh, const SchemeChoice& scheme, const std::vector<std::string>& channels) {
    const Options& options = job.options;
    const std::vector<char> in_subset = subset_marks(mesh, scheme);
    TwoPhaseChoice choice;
    choice.options.skip_normals = options.normals == "mesh";
    if (choice.options.skip_normals) choice.normals = normals_of_input(job, mesh, in_subset);
    else if (!options.normals.empty()) choice.normals = read_normals(options.normals, in_subset);
    if (!options.handles_file.empty()) choice.handles = read_handles(options.handles_file, in_subset.size());
    for (const std::string& name : channels) choice.channels.push_back(name.c_str());
    choice.options.normals = choice.normals.empty() ? nullptr : choice.normals.data();
    choice.options.handles = choice.handles.empty() ? nullptr : choice.handles.data();
    choice.options.convex_handle = options.handles[0];
    choice.options.other_handle = options.handles[1];
    choice.options.fair = options.fair;
    choice.options.channels = choice.channels.data();
    choice.options.channel_count = choice.channels.size();
    note_parameters(job);
    return choice;
}

Failure two_phase_failure(const Job& job, lcl_status status) {
    Failure failure = failure_of(status);
    const bool about_normals = status == LCL_ERROR_BAD_INPUT && !job.options.normals.empty() && job.options.normals != "mesh";
    const bool about_ratios = status == LCL_ERROR_INVALID_ARGUMENT && !job.options.lambda_file.empty();
    if (about_normals) failure.message = job.options.normals + ": " + failure.message;
    if (!about_ratios) return failure;
    failure.message = job.options.lambda_file + " (0 where it lists no ratio): " + failure.message;
    failure.exit_code = exit_bad_input;
    failure.status = "bad-input";
    return failure;
}

void note_two_phase(Job& job, const lcl_two_phase_report& findings) {
    job.report.two_phase = findings;
    if (findings.wrong_side_count > 0) {
        warn(job, "the normal asked for at " + first_of(findings.wrong_side, findings.wrong_side_count) +
                      " is on the other side of the surface, which may fold there: turn it round, or leave it out");
        if (job.report.vertices.empty())
            job.report.vertices.assign(findings.wrong_side, findings.wrong_side + std::min<std::int32_t>(findings.wrong_side_count, 10));
    }
    if (findings.scaled_normals > 0)
        warn(job, counted(findings.scaled_normals, "normal was", "normals were") + " not of unit length and " +
                      (findings.scaled_normals == 1 ? "was" : "were") + " normalised");
    if (findings.skipped_normals > 0)
        warn(job, counted(findings.skipped_normals, "normal was", "normals were") +
                      " left out: corners, creases, boundary vertices with one or more than four faces, and vertices with two faces take none");
    if (job.options.fair > 0.0 && !findings.fair_converged)
        warn(job, "fairness was not finished after " + counted(findings.fair_iterations, "iteration", "iterations") +
                      ": all vertices are met, but a smaller --fair comes further");
}

void say_two_phase(Job& job, lcl_mesh refined) {
    const lcl_two_phase_report& findings = *job.report.two_phase;
    std::string text = counted(lcl_mesh_vertex_count(refined), "vertex", "vertices") + "; limit points repaired by up to " +
                       short_number(findings.largest_repair) + ", now within " + short_number(findings.max_error);
    if (findings.normal_count > 0) text += "; " + counted(findings.normal_count, "normal", "normals");
    job.terminal.say("refined", text);
    if (job.options.fair > 0.0)
        job.terminal.say("fair", "energy " + short_number(findings.energy[0]) + " before, " + short_number(findings.energy[1]) + " after " +
                                     counted(findings.fair_iterations, "iteration", "iterations"));
}

void write_vertex_map(Job& job, lcl_mesh refined) {
    const std::string& path = job.options.map_file;
    std::size_t count = 0;
    check(lcl_two_phase_get_map(refined, nullptr, &count));
    std::vector<std::int32_t> vertices(count);
    check(lcl_two_phase_get_map(refined, vertices.data(), nullptr));
    const Phase phase(job, &Seconds::write, "writing " + path);
    OutputFile file(path);
    file.write("vertex,refined_vertex\n");
    for (std::size_t vertex = 0; vertex < count; ++vertex) file.write(std::to_string(vertex) + "," + std::to_string(vertices[vertex]) + "\n");
    file.finish();
    job.terminal.say("wrote", path + ": the refined vertex of each vertex");
}

}  // namespace lcl::cli
