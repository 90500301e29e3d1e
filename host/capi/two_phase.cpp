// SPDX-License-Identifier: BSD-3-Clause
#include "host/two_phase/two_phase.h"

#include <algorithm>

#include "host/capi/arguments.h"

using namespace lcl;

namespace {

std::vector<double> copied(const double* values, std::size_t count) { return values ? std::vector<double>(values, values + count) : std::vector<double>(); }

TwoPhaseOptions inner_options(const lcl_two_phase_options& given, const lcl_solve_options& solve, std::size_t vertices) {
    TwoPhaseOptions options;
    options.solve = solve_options(solve);
    if (solve.warm_start != 0) throw InvalidArgument("solve.warm_start is set, and a two-phase mesh has no start to begin from: leave it out");
    options.normals = copied(given.normals, 3 * vertices);
    options.skip_normals = given.skip_normals != 0;
    options.handles = copied(given.handles, vertices);
    if (given.convex_handle != 0) options.convex_handle = given.convex_handle;
    if (given.other_handle != 0) options.other_handle = given.other_handle;
    options.fair = given.fair;
    return options;
}

/// All properties, which are refined.
FurtherChannels property_channels(const std::vector<VertexProperty>& properties, std::size_t vertices) {
    FurtherChannels further{static_cast<int>(properties.size()), {}};
    further.values.resize(vertices * properties.size());
    for (std::size_t c = 0; c < properties.size(); ++c)
        for (std::size_t v = 0; v < vertices; ++v) further.values[v * properties.size() + c] = properties[c].values[v];
    return further;
}

/// Those that are also interpolated.
std::vector<std::uint8_t> channel_marks(const std::vector<VertexProperty>& properties, const lcl_two_phase_options& given) {
    std::vector<std::uint8_t> marks(properties.size(), 0);
    if (given.channel_count > 0) required(given.channels, "options.channels");
    for (std::size_t i = 0; i < given.channel_count; ++i) {
        const std::string name = required(given.channels[i], "a name of options.channels");
        const auto found = std::find_if(properties.begin(), properties.end(), [&](const VertexProperty& property) { return property.name == name; });
        if (found == properties.end()) throw InvalidArgument("options.channels names '" + name + "', which is no property of the mesh");
        marks[static_cast<std::size_t>(found - properties.begin())] = 1;
    }
    return marks;
}

std::vector<VertexProperty> refined_properties(const std::vector<VertexProperty>& properties, const FurtherChannels& further) {
    std::vector<VertexProperty> out;
    for (std::size_t c = 0; c < properties.size(); ++c) {
        out.push_back({properties[c].name, properties[c].kind, properties[c].type, std::vector<double>(further.values.size() / properties.size())});
        for (std::size_t i = 0; i < out[c].values.size(); ++i) out[c].values[i] = further.values[i * properties.size() + c];
    }
    round_integers(out);
    return out;
}

void give_findings(lcl_two_phase_report* report, const TwoPhaseReport& inner) {
    if (report == nullptr) return;
    lcl_two_phase_report out = LCL_TWO_PHASE_REPORT_INIT;
    out.normal_count = inner.normal_count;
    out.skipped_normals = inner.skipped_normals;
    out.scaled_normals = inner.scaled_normals;
    out.wrong_side_count = inner.wrong_side_count;
    copy_first(out.wrong_side, inner.wrong_side);
    out.convex_count = inner.convex_count;
    out.fair_iterations = inner.fair_iterations;
    out.fair_converged = inner.fair_converged;
    out.largest_repair = inner.largest_repair;
    out.max_error = inner.max_error;
    std::copy(inner.energy.begin(), inner.energy.end(), out.energy);
    out.seconds = inner.seconds;
    give(report, out, "report");
}

void check_vertex_counts(const LimitSystem& system, const lcl_mesh_s& mesh) {
    const Index expected = system.plan().vertex_count, found = mesh.file.mesh.vertex_count;
    if (expected != found) throw InvalidArgument("the operator has " + std::to_string(expected) + " vertices, the mesh " + std::to_string(found));
    if (system.origin != Origin::scheme)
        throw InvalidArgument("a two-phase mesh needs the limit operator of a mesh with a blend ratio lambda, and this operator has rows of another kind");
}

}  // namespace

extern "C" {

lcl_status lcl_two_phase_mesh(lcl_operator A, lcl_mesh mesh, const lcl_solve_options* solve, const lcl_two_phase_options* options, lcl_mesh* refined,
                              lcl_solve_report* solve_report, lcl_two_phase_report* report) {
    return guarded([&] {
        required(refined, "refined");
        LimitSystem& system = *required(A, "A")->system;
        check_vertex_counts(system, *required(mesh, "mesh"));
        options_or(solve_report, LCL_SOLVE_REPORT_INIT, "solve_report");  // refuses one without a size before any work
        options_or(report, LCL_TWO_PHASE_REPORT_INIT, "report");
        const lcl_solve_options given_solve = options_or(solve, LCL_SOLVE_OPTIONS_INIT, "solve");
        const lcl_two_phase_options given = options_or(options, LCL_TWO_PHASE_OPTIONS_INIT, "options");
        const std::vector<VertexProperty>& properties = mesh->file.properties;
        const auto vertices = static_cast<std::size_t>(mesh->file.mesh.vertex_count);
        TwoPhase made =
            interpolate_two_phase(system, mesh->file.mesh, mesh->topology(), mesh->features(), mesh->named_features(), property_channels(properties, vertices),
                                  channel_marks(properties, given), inner_options(given, given_solve, vertices));
        give_findings(report, made.findings);
        if (!made.is_given) return conclude(made.report, given_solve, solve_report);
        auto out = make_refined_mesh(*mesh, std::move(made.refined), 1);
        out->file.properties = refined_properties(properties, made.further);
        out->two_phase_vertices = mesh->file.mesh.vertex_count;
        *refined = out.release();
        if (!can_be_repaired(made.report)) return conclude(made.report, given_solve, solve_report);
        give_report(solve_report, made.report);
        return LCL_OK;
    });
}

lcl_status lcl_two_phase_get_map(lcl_mesh refined, int32_t* vertices, size_t* count) {
    return guarded([&] {
        const Index old = required(refined, "refined")->two_phase_vertices;
        if (old < 0) throw InvalidArgument("this mesh was not made by lcl_two_phase_mesh");
        if (count != nullptr) *count = static_cast<std::size_t>(old);
        for (Index v = 0; vertices != nullptr && v < old; ++v) vertices[v] = v;  // centres of umbrellas come first, with their old numbers
        return LCL_OK;
    });
}

}  // extern "C"
