// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/failure.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"

namespace lcl::cli {

namespace {

using Rows = std::vector<std::vector<std::string>>;

std::vector<std::string> notes_of(lcl_mesh mesh, lcl_note kind) {
    std::vector<std::string> notes;
    for (int index = 0; index < lcl_mesh_note_count(mesh, kind); ++index) notes.push_back(lcl_mesh_note(mesh, kind, index));
    return notes;
}

std::vector<DefectSummary> defects_of(lcl_mesh mesh) {
    std::vector<DefectSummary> defects;
    for (int index = 0; index < lcl_mesh_defect_count(mesh); ++index) {
        lcl_defect defect = LCL_DEFECT_INIT;
        check(lcl_mesh_get_defect(mesh, index, &defect));
        defects.push_back({defect.kind,
                           defect.message,
                           defect.count,
                           {defect.vertices, defect.vertices + defect.vertex_count},
                           {defect.faces, defect.faces + defect.face_count}});
    }
    return defects;
}

/// A mesh that no scheme can take (not sound, or with a tag that is refused) is an answer here, not a failure.
SchemeSummary check_scheme(lcl_mesh mesh, const Options& options, lcl_scheme scheme) {
    lcl_scheme_options scheme_options = LCL_SCHEME_OPTIONS_INIT;
    scheme_options.scheme = scheme;
    if (scheme == LCL_SCHEME_DOO_SABIN) scheme_options.mask = options.mask;
    if (scheme == LCL_SCHEME_CATMULL_CLARK) {
        scheme_options.alpha = options.alpha;
        scheme_options.lambda = options.lambda;
    }
    lcl_suitability suitability = LCL_SUITABILITY_INIT;
    const lcl_status status = lcl_mesh_check_scheme(mesh, &scheme_options, &suitability);
    if (status == LCL_ERROR_BAD_INPUT || status == LCL_ERROR_UNSUPPORTED) return {scheme_name(scheme), false, false, lcl_last_error()};
    check(status);
    return {scheme_name(scheme), suitability.suitable != 0, suitability.singular != 0, suitability.reason};
}

InfoSummary info_of(lcl_mesh mesh, const Options& options) {
    InfoSummary info;
    for (const lcl_scheme scheme : {LCL_SCHEME_CATMULL_CLARK, LCL_SCHEME_LOOP, LCL_SCHEME_DOO_SABIN})
        info.schemes.push_back(check_scheme(mesh, options, scheme));
    info.tags_ignored = notes_of(mesh, LCL_NOTE_IGNORED_TAG);
    info.unknown_statements = notes_of(mesh, LCL_NOTE_UNKNOWN_STATEMENT);
    info.refused_tag = join(notes_of(mesh, LCL_NOTE_REFUSED_TAG), "; ");
    info.defects = defects_of(mesh);
    return info;
}

std::string histogram_text(const Histogram& histogram) {
    std::vector<std::string> parts;
    for (const auto& [key, count] : histogram) parts.push_back(std::to_string(key) + ": " + std::to_string(count));
    return parts.empty() ? "none" : join(parts, ", ");
}

std::string text_or_none(const std::string& text) { return text.empty() ? "none" : text; }

void add_topology_rows(Rows& rows, const MeshSummary& mesh, const InfoSummary& report) {
    const lcl_mesh_info& info = mesh.info;
    if (info.edges < 0) {
        rows.push_back({"edges", report.refused_tag.empty() ? "unknown: the mesh is not sound, see the defects" : "unknown: see the tag that is refused"});
        return;
    }
    rows.push_back({"edges", std::to_string(info.edges)});
    rows.push_back({"valences", histogram_text(mesh.valences)});
    rows.push_back({"boundary", counted(info.boundary_loops, "loop", "loops") + ", " + counted(info.boundary_edges, "edge", "edges")});
    rows.push_back({"components", std::to_string(info.components)});
    rows.push_back({"isolated", counted(info.isolated_vertices, "vertex", "vertices")});
    rows.push_back({"creases", counted(info.creases, "edge", "edges") + " off the boundary"});
    rows.push_back({"corners", counted(info.corners, "vertex", "vertices")});
}

void add_scheme_rows(Rows& rows, const InfoSummary& info) {
    for (const SchemeSummary& scheme : info.schemes) {
        const std::string verdict = !scheme.suitable ? "not suitable" : scheme.singular ? "singular" : "suitable";
        rows.push_back({scheme.name, verdict + (scheme.reason.empty() ? "" : ": " + scheme.reason)});
    }
}

std::string info_table(const Job& job, lcl_mesh mesh) {
    const MeshSummary& summary = *job.report.mesh;
    const InfoSummary& info = *job.report.info;
    Rows rows = {{"file", shown_input(job.options)},
                 {"vertices", std::to_string(summary.info.vertices)},
                 {"faces", std::to_string(summary.info.faces)},
                 {"face degrees", histogram_text(summary.face_degrees)}};
    add_topology_rows(rows, summary, info);
    rows.push_back({"diagonal", short_number(summary.info.diagonal)});
    rows.push_back({"data", text_or_none(join(all_channels(mesh), ", "))});
    rows.push_back({"tags ignored", text_or_none(join(info.tags_ignored, ", "))});
    if (!info.refused_tag.empty()) rows.push_back({"tag refused", info.refused_tag});
    if (!info.unknown_statements.empty()) rows.push_back({"skipped", join(info.unknown_statements, ", ") + " (unknown statements)"});
    for (const DefectSummary& defect : info.defects) rows.push_back({"defect", defect.kind + ", " + std::to_string(defect.count) + ": " + defect.message});
    if (info.defects.empty()) rows.push_back({"defects", "none"});
    add_scheme_rows(rows, info);
    return table_text(rows);
}

}  // namespace

void run_info(Job& job) {
    const Mesh mesh = read_input(job);
    if (!job.options.lambda_file.empty()) warn(job, "info looks at one blend ratio for all vertices: --lambda " + job.options.lambda_file + " is left out");
    job.report.info = info_of(mesh.get(), job.options);
    if (job.options.report != "-") job.terminal.result(info_table(job, mesh.get()));
}

}  // namespace lcl::cli
