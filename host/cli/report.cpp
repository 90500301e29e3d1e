// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/report.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "host/cli/option_names.h"

namespace lcl::cli {

namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json where_json(const std::vector<std::int32_t>& vertices, const std::vector<std::int32_t>& faces) { return {{"vertices", vertices}, {"faces", faces}}; }

Json histogram_json(const Histogram& histogram) {
    Json json = Json::object();
    for (const auto& [key, count] : histogram) json[std::to_string(key)] = count;
    return json;
}

Json mesh_json(const MeshSummary& mesh) {
    const std::pair<const char*, std::int32_t> counts[] = {{"vertices", mesh.info.vertices},
                                                           {"faces", mesh.info.faces},
                                                           {"edges", mesh.info.edges},
                                                           {"boundary_edges", mesh.info.boundary_edges},
                                                           {"boundary_loops", mesh.info.boundary_loops},
                                                           {"components", mesh.info.components},
                                                           {"isolated_vertices", mesh.info.isolated_vertices}};
    Json json = Json::object();
    for (const auto& [name, count] : counts) {
        if (count >= 0) json[name] = count;
    }
    json["face_degrees"] = histogram_json(mesh.face_degrees);
    if (mesh.info.edges < 0) return json;
    json["valences"] = histogram_json(mesh.valences);
    json["creases"] = mesh.info.creases;
    json["corners"] = mesh.info.corners;
    return json;
}

Json parameters_json(const Report& report) {
    Json json = Json::object();
    for (const auto& [name, value] : report.parameters) json[name] = std::visit([](const auto& alternative) { return Json(alternative); }, value);
    return json;
}

void add_solve(Json& json, const SolveSummary& solve) {
    json["solver"] = solver_name(solve.report.solver);
    json["converged"] = solve.report.converged != 0;
    json["iterations"] = solve.report.iterations;
    Json residuals = Json::array();
    for (const double residual : solve.residuals) residuals.push_back(number_or_null(residual));
    json["residuals"] = residuals;
    json["lambda_min"] = number_or_null(solve.report.lambda_min);
    json["max_error"] = number_or_null(solve.report.max_error);
    json["surface_error_bound"] = number_or_null(solve.report.surface_error_bound);
}

void add_two_phase(Json& json, const lcl_two_phase_report& findings) {
    json["two_phase"] = {{"largest_repair", number_or_null(findings.largest_repair)},
                         {"max_error", number_or_null(findings.max_error)},
                         {"normals", findings.normal_count},
                         {"normals_left_out", findings.skipped_normals},
                         {"normals_on_the_other_side", findings.wrong_side_count},
                         {"seconds", findings.seconds}};
    if (!std::isfinite(findings.energy[0])) return;
    json["energy"] = {number_or_null(findings.energy[0]), number_or_null(findings.energy[1])};
    json["two_phase"]["fair_iterations"] = findings.fair_iterations;
    json["two_phase"]["fair_converged"] = findings.fair_converged != 0;
}

Json fit_seconds_json(const lcl_surface_report& fit) {
    return {{"approximate", fit.seconds_approximate}, {"simplify", fit.seconds_simplify}, {"solve", fit.seconds_solve},
            {"measure", fit.seconds_measure},         {"refine", fit.seconds_refine},     {"total", fit.seconds_total}};
}

void add_fit(Json& json, const FitSummary& summary) {
    const lcl_surface_report& fit = summary.report;
    json["solver"] = solver_name(summary.solver);
    json["converged"] = fit.converged != 0;
    json["iterations"] = fit.iterations;
    json["max_error"] = number_or_null(fit.interpolation_error);
    json["fit"] = {{"points", fit.point_count},
                   {"rms", number_or_null(fit.rms)},
                   {"p95", number_or_null(fit.p95)},
                   {"max", number_or_null(fit.max)},
                   {"vertices", fit.vertices},
                   {"faces", fit.faces},
                   {"tolerance", number_or_null(summary.tolerance)},
                   {"outside", fit.outside_count},
                   {"rounds", fit.rounds},
                   {"duplicates", fit.duplicate_count},
                   {"left_out", fit.left_out_count},
                   {"unused", fit.unused_count},
                   {"approximation",
                    {{"vertices", fit.approximation_vertices},
                     {"faces", fit.approximation_faces},
                     {"components", fit.components},
                     {"boundary_loops", fit.boundary_loops}}},
                   {"filled_holes", fit.filled_holes},
                   {"dropped_faces", fit.dropped_faces},
                   {"split_vertices", fit.split_vertices},
                   {"simplified_vertices", fit.simplified_vertices},
                   {"interpolation_error", number_or_null(fit.interpolation_error)},
                   {"seconds", fit_seconds_json(fit)}};
}

/// The rows of the CSV.
Json spectrum_json(const SpectrumSummary& spectrum) {
    const std::size_t width = spectrum.channels.size();
    Json rows = Json::array();
    for (std::size_t term = 0; term * width < spectrum.energies.size(); ++term) {
        const double* energies = spectrum.energies.data() + term * width;
        Json row = {{"term", term}, {"energy", number_or_null(position_energy(energies))}};
        for (std::size_t channel = 0; channel < width; ++channel) row[spectrum.channels[channel]] = number_or_null(energies[channel]);
        rows.push_back(row);
    }
    return rows;
}

/// "NAME COUNT" as the library notes it.
Json unknown_statements_json(const std::vector<std::string>& notes) {
    Json json = Json::object();
    for (const std::string& note : notes) {
        const std::size_t blank = note.rfind(' ');
        json[note.substr(0, blank)] = blank == std::string::npos ? 1 : std::stoll(note.substr(blank + 1));
    }
    return json;
}

void add_info(Json& json, const InfoSummary& info) {
    Json schemes = Json::object();
    for (const SchemeSummary& scheme : info.schemes)
        schemes[scheme.name] = {{"suitable", scheme.suitable}, {"singular", scheme.singular}, {"reason", scheme.reason}};
    json["schemes"] = schemes;
    json["tags_ignored"] = info.tags_ignored;
    json["unknown_statements"] = unknown_statements_json(info.unknown_statements);
    if (!info.refused_tag.empty()) json["tag_refused"] = info.refused_tag;
    Json defects = Json::array();
    for (const DefectSummary& defect : info.defects)
        defects.push_back({{"kind", defect.kind}, {"where", where_json(defect.vertices, defect.faces)}, {"count", defect.count}, {"message", defect.message}});
    json["defects"] = defects;
}

Json device_json(const lcl_device_info& device) {
    return {{"index", device.index},
            {"platform", device.platform},
            {"name", device.name},
            {"version", device.version},
            {"vendor", device.vendor},
            {"driver", device.driver},
            {"type", device.is_gpu   ? "gpu"
                     : device.is_cpu ? "cpu"
                                     : "other"},
            {"double", device.has_double != 0},
            {"compute_units", device.compute_units},
            {"clock_mhz", device.clock_mhz},
            {"memory_bytes", device.memory_bytes},
            {"max_allocation_bytes", device.max_allocation_bytes}};
}

Json kernel_json(const KernelCheck& check) {
    return {{"kernel", check.kernel},
            {"what", check.what},
            {"difference", number_or_null(check.difference)},
            {"tolerance", check.tolerance},
            {"passed", check.passed}};
}

void add_lists(Json& json, const Report& report) {
    if (report.devices) {
        json["devices"] = Json::array();
        for (const lcl_device_info& device : *report.devices) json["devices"].push_back(device_json(device));
    }
    if (report.kernels) {
        json["kernels"] = Json::array();
        for (const KernelCheck& check : *report.kernels) json["kernels"].push_back(kernel_json(check));
    }
}

Json seconds_json(const Seconds& seconds) {
    return {{"read", seconds.read},   {"topology", seconds.topology}, {"compile", seconds.compile}, {"upload", seconds.upload},
            {"solve", seconds.solve}, {"download", seconds.download}, {"write", seconds.write},     {"total", seconds.total}};
}

}  // namespace

double position_energy(const double* energies) { return energies[0] + energies[1] + energies[2]; }

void Report::set_parameter(const std::string& name, Parameter value) {
    for (auto& [known, old] : parameters) {
        if (known == name) {
            old = std::move(value);
            return;
        }
    }
    parameters.emplace_back(name, std::move(value));
}

std::string to_json(const Report& report) {
    Json json = {{"limitcl", lcl_version_string()}, {"command", report.command},   {"status", report.status},
                 {"message", report.message},       {"warnings", report.warnings}, {"where", where_json(report.vertices, report.faces)}};
    if (report.device) json["device"] = {{"platform", report.device->platform}, {"name", report.device->name}, {"version", report.device->version}};
    if (report.mesh) json["mesh"] = mesh_json(*report.mesh);
    if (report.mesh || report.fit) json["diagonal"] = number_or_null(report.fit ? report.fit->report.diagonal : report.mesh->info.diagonal);
    if (!report.scheme.empty()) json["scheme"] = report.scheme;
    json["parameters"] = parameters_json(report);
    if (report.solve) add_solve(json, *report.solve);
    if (report.two_phase) add_two_phase(json, *report.two_phase);
    if (report.fit) add_fit(json, *report.fit);
    if (report.volume) json["volume"] = *report.volume;
    if (report.spectrum) json["spectrum"] = spectrum_json(*report.spectrum);
    if (report.info) add_info(json, *report.info);
    add_lists(json, report);
    json["seconds"] = seconds_json(report.seconds);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // names of files need not be UTF-8
}

}  // namespace lcl::cli
