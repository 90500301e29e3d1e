// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/surface.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>

#include "host/capi/arguments.h"
#include "host/points/holes.h"

using namespace lcl;

namespace {

/// The scheme of the mesh that is to come: no vertex of it is known yet.
SchemeOptions scheme_of(const lcl_scheme_options& given) {
    if (given.lambda != 0 || given.lambda_per_vertex != nullptr)
        throw InvalidArgument("lambda is given: a surface through points has no two-phase form, interpolate its mesh");
    if (given.subset != nullptr || given.owned != nullptr) throw InvalidArgument("subset and owned name vertices, which are not known before: leave them out");
    if (given.alpha_auto != 0 && given.alpha != 0) throw InvalidArgument("alpha is given and alpha_auto is set: choose one");
    lcl_scheme_options options = given;
    if (options.scheme == LCL_SCHEME_DEFAULT) options.scheme = LCL_SCHEME_DOO_SABIN;
    lcl_mesh_s none;
    return scheme_options(none, options);
}

void check_options(const lcl_surface_options& given) {
    const auto refuse = [](const std::string& name, double value, const char* range) {
        char text[32];
        throw InvalidArgument("options." + name + " is " + std::string(text, std::to_chars(text, text + sizeof text, value).ptr) + ", " + range);
    };
    if (given.fit != LCL_FIT_INTERPOLATE && given.fit != LCL_FIT_LEAST_SQUARES) refuse("fit", given.fit, "it is 0 or 1");
    if (!(given.tolerance >= 0) || !std::isfinite(given.tolerance)) refuse("tolerance", given.tolerance, "it is above 0, relative to the diagonal (0: 1e-3)");
    if (given.max_vertices < 0 || (given.max_vertices > 0 && given.max_vertices < 4))
        refuse("max_vertices", given.max_vertices, "it is 4 or more (0: no limit)");
    if (given.max_rounds < 0) refuse("max_rounds", given.max_rounds, "it is 1 or more (0: 30)");
    if (given.fill_holes < 0 || given.fill_holes > most_hole_edges || given.fill_holes == 1 || given.fill_holes == 2)
        refuse("fill_holes", given.fill_holes, "it goes from 3 to 1000 edges (0: none)");
    if (!(given.fair >= 0) || !std::isfinite(given.fair)) refuse("fair", given.fair, "it is 0 or above");
    if (!(given.crease_angle_degrees >= 0 && given.crease_angle_degrees <= 180))
        refuse("crease_angle_degrees", given.crease_angle_degrees, "it goes from 0 to 180 (0: none)");
    if (given.boundary < LCL_BOUNDARY_DEFAULT || given.boundary > LCL_BOUNDARY_FIXED) refuse("boundary", given.boundary, "it goes from 0 to 3");
    if (!(given.solve_tolerance >= 0) || !std::isfinite(given.solve_tolerance)) refuse("solve_tolerance", given.solve_tolerance, "it is above 0 (0: 1e-6)");
    if (given.max_iterations < 0) refuse("max_iterations", given.max_iterations, "it is 1 or more (0: 200)");
    if (given.engine_option_count > 0) required(given.engine_options, "options.engine_options");
}

SolveOptions solve_of(const lcl_surface_options& given, double tolerance) {
    SolveOptions solve;
    solve.precision = inner_precision(given.precision);
    solve.tolerance = std::min(given.solve_tolerance > 0 ? given.solve_tolerance : solve.tolerance, tolerance / 10);
    if (given.max_iterations > 0) solve.max_iterations = given.max_iterations;
    solve.keep_going = given.keep_going != 0;
    return solve;
}

SurfaceOptions inner_options(const lcl_surface_options& given, const lcl_scheme_options& scheme) {
    check_options(given);
    SurfaceOptions options;
    options.scheme = scheme_of(scheme);
    options.alpha_auto = scheme.alpha_auto != 0;
    options.fit = static_cast<FitKind>(given.fit);
    if (given.tolerance > 0) options.tolerance = given.tolerance;
    options.max_vertices = given.max_vertices;
    if (given.max_rounds > 0) options.max_rounds = given.max_rounds;
    options.fill_holes = given.fill_holes;
    options.fair = given.fair;
    if (given.boundary != LCL_BOUNDARY_DEFAULT) options.boundary = static_cast<BoundaryRule>(given.boundary - 1);
    if (given.crease_angle_degrees > 0) options.crease_angle_degrees = given.crease_angle_degrees;
    for (size_t i = 0; i < given.engine_option_count; ++i)
        options.engine_options.emplace_back(required(given.engine_options[i].key, "a key of options.engine_options"),
                                            required(given.engine_options[i].value, "a value of options.engine_options"));
    options.solve = solve_of(given, options.tolerance);
    if (given.progress != nullptr)
        options.progress = [given](SurfacePhase phase, int round, double fraction, double max_distance) {
            return given.progress(given.progress_user, static_cast<lcl_surface_phase>(phase), round, fraction, max_distance) != 0;
        };
    return options;
}

lcl_surface_report report_of(const SurfaceResult& result, double seconds_total) {
    const SurfaceReport& inner = result.report;
    lcl_surface_report out = LCL_SURFACE_REPORT_INIT;
    out.point_count = static_cast<int64_t>(inner.point_count);
    out.duplicate_count = static_cast<int64_t>(inner.duplicate_count);
    out.left_out_count = static_cast<int64_t>(inner.left_out_count);
    out.unused_count = static_cast<int64_t>(inner.unused_count);
    out.approximation_vertices = inner.approximation_vertices;
    out.approximation_faces = inner.approximation_faces;
    out.components = inner.components;
    out.boundary_loops = inner.boundary_loops;
    out.filled_holes = inner.filled_holes;
    out.dropped_faces = inner.dropped_faces;
    out.split_vertices = inner.split_vertices;
    out.simplified_vertices = inner.simplified_vertices;
    out.vertices = result.mesh.vertex_count;
    out.faces = result.mesh.face_count();
    out.creases = inner.creases;
    out.rounds = inner.rounds;
    out.iterations = inner.iterations;
    out.converged = inner.converged;
    out.alpha = inner.alpha;
    out.diagonal = inner.diagonal;
    out.rms = inner.distances.rms;
    out.p95 = inner.distances.p95;
    out.max = inner.distances.max;
    out.outside_count = static_cast<int64_t>(inner.distances.outside);
    out.interpolation_error = inner.interpolation_error;
    out.seconds_approximate = inner.seconds_approximate;
    out.seconds_simplify = inner.seconds_simplify;
    out.seconds_solve = inner.seconds_solve;
    out.seconds_measure = inner.seconds_measure;
    out.seconds_refine = inner.seconds_refine;
    out.seconds_total = seconds_total;
    copy_text(out.message, inner.message);
    return out;
}

std::unique_ptr<lcl_mesh_s> mesh_of(SurfaceResult& result) {
    auto mesh = std::make_unique<lcl_mesh_s>();
    mesh->file.mesh = std::move(result.mesh);
    mesh->boundary = static_cast<lcl_boundary>(static_cast<int>(result.features.boundary) + 1);
    mesh->feature_options = std::move(result.features);
    mesh->notes[LCL_NOTE_WARNING] = std::move(result.warnings);
    return mesh;
}

/// Of the fit, or of the solve that ended it.
lcl_status status_of(const SurfaceResult& result, const lcl_surface_options& given) {
    if (result.solve.status != SolveStatus::converged) return conclude(result.solve, LCL_SOLVE_OPTIONS_INIT, nullptr);
    if (result.report.converged || given.max_vertices > 0) return LCL_OK;
    last_error() = {result.report.message, {}};
    return LCL_ERROR_NOT_CONVERGED;
}

}  // namespace

extern "C" {

lcl_status lcl_surface(lcl_context context, lcl_cloud cloud, const lcl_engine* engine, const lcl_scheme_options* scheme, const lcl_surface_options* options,
                       lcl_mesh* mesh, lcl_surface_report* report) {
    return guarded([&] {
        required(mesh, "mesh");
        required(context, "context");
        required(cloud, "cloud");
        required(engine, "engine");
        options_or(report, LCL_SURFACE_REPORT_INIT, "report");  // refuses one without a size before any work
        const lcl_surface_options given = options_or(options, LCL_SURFACE_OPTIONS_INIT, "options");
        const auto start = std::chrono::steady_clock::now();
        SurfaceResult result =
            surface_from_points(context->context, cloud->cloud, *engine, inner_options(given, options_or(scheme, LCL_SCHEME_OPTIONS_INIT, "scheme")));
        const lcl_surface_report findings = report_of(result, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        if (result.mesh.vertex_count > 0) {
            const std::vector<double> colours = std::move(result.colours);
            auto made = mesh_of(result);
            if (!colours.empty()) set_colours(*made, colours.data());
            *mesh = made.release();
        }
        if (report != nullptr) give(report, findings, "report");
        return status_of(result, given);
    });
}

}  // extern "C"
