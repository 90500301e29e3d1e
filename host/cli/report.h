// SPDX-License-Identifier: BSD-3-Clause
// What a command found out, and the JSON of it (--report).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <limitcl/limitcl.h>

namespace lcl::cli {

using Histogram = std::vector<std::pair<std::int32_t, std::int32_t>>;
using Parameter = std::variant<double, std::int64_t, bool, std::string, std::vector<std::string>, std::vector<double>, std::vector<int>>;

struct MeshSummary {
    lcl_mesh_info info = LCL_MESH_INFO_INIT;  ///< edges -1: the mesh is not sound, and all that follows from edges is unknown
    Histogram face_degrees, valences;
};

struct SolveSummary {
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    std::vector<double> residuals;
};

struct SchemeSummary {
    std::string name;
    bool suitable = false, singular = false;
    std::string reason;
};

struct DefectSummary {
    std::string kind, message;
    std::int64_t count = 0;
    std::vector<std::int32_t> vertices, faces;
};

struct InfoSummary {
    std::vector<SchemeSummary> schemes;
    std::vector<std::string> tags_ignored, unknown_statements;
    std::string refused_tag;
    std::vector<DefectSummary> defects;
};

struct KernelCheck {
    std::string kernel, what;
    double difference = 0.0, tolerance = 0.0;
    bool passed = false;
};

/// A surface through a cloud.
struct FitSummary {
    lcl_surface_report report = LCL_SURFACE_REPORT_INIT;
    double tolerance = 0.0;               ///< model units
    lcl_solver solver = LCL_SOLVER_AUTO;  ///< that was asked for
};

/// Energies of the terms of the expansion, channel by channel.
struct SpectrumSummary {
    std::vector<std::string> channels;  ///< x, y, z, and the names of further ones
    std::vector<double> energies;       ///< a row a term, a value a channel
};

/// Energy of a term: that of x, y and z.
double position_energy(const double* energies);

/// Seconds by phase; 0: it did not happen, or is part of `solve` (the transfers of `limit`). `surface` has phases of its own beside: see its report.
struct Seconds {
    double read = 0, topology = 0, compile = 0, upload = 0, solve = 0, download = 0, write = 0, total = 0;
};

/// Everything as far as known; what is not known is left out of the JSON.
struct Report {
    std::string command;
    std::string status = "ok", message;
    std::vector<std::string> warnings;
    std::vector<std::int32_t> vertices, faces;  ///< where, the first ten
    std::optional<lcl_device_info> device;
    std::optional<MeshSummary> mesh;
    std::string scheme;
    std::vector<std::pair<std::string, Parameter>> parameters;
    std::optional<SolveSummary> solve;
    std::optional<lcl_two_phase_report> two_phase;
    std::optional<FitSummary> fit;
    std::optional<std::array<double, 2>> volume;  ///< before and after, of closed meshes
    std::optional<SpectrumSummary> spectrum;
    std::optional<InfoSummary> info;
    std::optional<std::vector<lcl_device_info>> devices;
    std::optional<std::vector<KernelCheck>> kernels;
    Seconds seconds;

    /// Sets a parameter, or replaces its value.
    void set_parameter(const std::string& name, Parameter value);
};

/// One JSON object with a line break at its end.
std::string to_json(const Report& report);

}  // namespace lcl::cli
