// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/option_rules.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>

#include "host/cli/failure.h"
#include "host/cli/option_names.h"
#include "host/cli/points.h"

namespace lcl::cli {

namespace {

constexpr const char* point_formats = ".ply .xyz .csv .off .obj .pts, each also with .gz";

/// Shared options that say something of a mesh which comes in.
const std::map<std::string, const char*> not_of_clouds = {{"--lambda", "the two-phase scheme begins with a mesh, and here one comes out: leave it out"},
                                                          {"--creases", "the vertices of OUT are not known beforehand: give --crease-angle DEG"},
                                                          {"--corners", "the vertices of OUT are not known beforehand: give --crease-angle DEG"},
                                                          {"--channels", "a cloud has coordinates alone, and its colours come with them: leave it out"}};

bool reads_cloud(const Options& options) { return options.command == "surface"; }

void choose_scheme(Options& options) {
    if (reads_cloud(options) && !options.has("--scheme")) options.scheme = LCL_SCHEME_DOO_SABIN;
    for (const char* flag : {"--alpha", "--lambda"}) {
        if (!options.has(flag)) continue;
        if (options.has("--mask")) fail(exit_usage, std::string(flag) + " is of catmull-clark and --mask of doo-sabin: give one of them");
        if (options.has("--scheme") && options.scheme != LCL_SCHEME_CATMULL_CLARK)
            fail(exit_usage, std::string(flag) + " is of catmull-clark: leave it out, or give --scheme catmull-clark");
        options.scheme = LCL_SCHEME_CATMULL_CLARK;
    }
    if (!options.has("--mask")) return;
    if (options.has("--scheme") && options.scheme != LCL_SCHEME_DOO_SABIN) fail(exit_usage, "--mask is of doo-sabin: leave it out, or give --scheme doo-sabin");
    options.scheme = LCL_SCHEME_DOO_SABIN;
}

bool is_of_surface(const Options& options) { return options.command == "evaluate" || options.command == "closest"; }
bool writes_table(const Options& options) { return options.command == "spectrum" || is_of_surface(options); }

/// One format for both standard streams: what comes in may be points, what goes out is a mesh.
void check_stream_format(const Options& options, bool points, bool meshes) {
    const std::string formats = !points ? "obj, off, ply, stl or om" : !meshes ? "ply, xyz, csv, off, obj or pts" : "obj, off or ply";
    if (!options.has("--format")) fail(exit_usage, "standard input and output have no ending: give --format " + formats);
    const std::string given = std::string("--format ") + format_name(options.format);
    if (meshes && options.format > LCL_FORMAT_OM) fail(exit_usage, given + " holds points alone, no mesh: give " + formats);
    if (points && (options.format == LCL_FORMAT_STL || options.format == LCL_FORMAT_OM)) fail(exit_usage, given + " holds meshes, no clouds: give " + formats);
}

void check_streams(const Options& options) {
    const bool mesh_to_output = options.output == "-" && !writes_table(options);
    const bool points = reads_cloud(options) && options.input == "-";
    const bool meshes = mesh_to_output || options.target == "-" || (options.input == "-" && !points);
    const bool streams = points || meshes;
    if (streams) check_stream_format(options, points, meshes);
    if (!streams && options.has("--format")) fail(exit_usage, "--format is for standard input and output; a file's ending names its format");
    if (options.output == "-" && options.report == "-") fail(exit_usage, "-o - and --report - cannot both have standard output: give one of them a file");
    if (options.map_file == "-") fail(exit_usage, "--map needs a file's name: standard output is for -o and --report");
}

void check_mesh_ending(const std::string& path) {
    lcl_format format = LCL_FORMAT_BY_ENDING;
    if (path.empty() || path == "-") return;
    if (lcl_format_of_path(path.c_str(), &format) != LCL_OK) fail(exit_usage, lcl_last_error());
    if (format > LCL_FORMAT_OM) fail(exit_usage, "'" + path + "' names a file of points alone: meshes are .obj .off .ply .stl .om, each also with .gz");
}

void check_endings(const Options& options) {
    if (!reads_cloud(options)) check_mesh_ending(options.input);
    check_mesh_ending(options.target);
    if (!writes_table(options)) check_mesh_ending(options.output);
    const bool bad_cloud = reads_cloud(options) && options.input != "-" && !is_points_name(options.input);
    if (bad_cloud) fail(exit_usage, "'" + options.input + "': points are read from " + point_formats);
}

void check_report_name(const Options& options) {
    if (options.report.empty() || options.report == "-") return;
    bool replaces = options.report == options.output || options.report == options.map_file;
    if (options.command == "morph") {
        for (int frame = 0; frame <= options.frames && !replaces; ++frame) replaces = options.report == options.frame_pattern.name(frame);
    }
    if (replaces) fail(exit_usage, "the report would replace another output, '" + options.report + "': give --report another name");
}

void check_interpolate(const Options& options) {
    const char* const flag = two_phase_option(options);
    if (flag == nullptr && !options.map_file.empty())
        fail(exit_usage, "--map names the vertices of the refined mesh of the two-phase scheme: add --refined and --lambda, or leave it out");
    if (flag == nullptr) return;
    if (options.has("--normals") && options.normals.empty()) fail(exit_usage, "--normals is empty: name a CSV, or say mesh");
    const bool has_ratio = options.has("--lambda") && (!options.lambda_file.empty() || (options.lambda > 0.0 && options.lambda < 1.0));
    if (!has_ratio)
        fail(exit_usage, std::string(flag) + " is of the two-phase scheme and needs --lambda L with a blend ratio above 0 and below 1, such as 0.33");
    lcl_format format = options.format;
    if (options.output != "-") lcl_format_of_path(options.output.c_str(), &format);
    if (format == LCL_FORMAT_STL)
        fail(exit_usage,
             std::string("STL holds triangles only, and with ") + flag + " the output is a refined mesh of quads: write to .obj, .off, .ply or .om");
}

void check_refine(const Options& options) {
    if (options.levels == 0 && !options.limit) fail(exit_usage, "--levels 0 changes nothing without --limit: add it, or give a level from 1");
}

void check_expand(const Options& options) {
    const char* const ways[] = {"--term", "--sum", "--band", "--equaliser"};
    const auto count = std::count_if(std::begin(ways), std::end(ways), [&options](const char* way) { return options.has(way); });
    if (count != 1) fail(exit_usage, "expand needs exactly one of --term I, --sum M, --band I:J and --equaliser w0,..,wm[:r]");
    if (options.equaliser.remainder && options.series == LCL_SERIES_INTERPOLATION)
        fail(exit_usage, "--equaliser has a weight of the remainder ':r', which the interpolation series does not have: leave it out");
}

void check_spectrum(const Options& options) {
    const bool known = options.output.empty() || options.output == "-" || has_ending(options.output, ".csv") || has_ending(options.output, ".svg");
    if (!known) fail(exit_usage, "'" + options.output + "': a spectrum is written to .csv or .svg");
}

/// evaluate and closest.
void check_surface(const Options& options) {
    if (options.has("--lambda"))
        fail(exit_usage,
             "--lambda: the surface of a two-phase mesh is that of the refined mesh that interpolate --refined writes: give that as IN, without --lambda");
    if (options.output != "-" && !has_ending(options.output, ".csv")) fail(exit_usage, "'" + options.output + "': the table is written to .csv");
    if (options.places_file == "-" || options.points_file == "-")
        fail(exit_usage, std::string(options.command == "evaluate" ? "--at" : "--points") + " needs a file's name");
    if (options.command == "closest" && !is_points_name(options.points_file))
        fail(exit_usage, "'" + options.points_file + "': points are read from " + point_formats);
}

void check_denoise(const Options& options) {
    if (options.has("--strength") && (options.has("--m") || options.has("--k"))) fail(exit_usage, "--strength stands for --m and --k: give it or them");
    if (!options.feature_operator) return;
    for (const char* flag : {"--scheme", "--alpha", "--lambda", "--mask"}) {
        if (options.has(flag))
            fail(exit_usage, std::string(flag) + " is of the limit operator and has no meaning with --operator features: leave one of them out");
    }
}

void check_morph(Options& options) {
    if (options.output == "-") fail(exit_usage, "a morph is many files: give -o a pattern of names like 'out_%03d.obj'");
    if (options.input == "-" && options.target == "-") fail(exit_usage, "FROM and TO cannot both be standard input: give one of them a file");
    try {
        options.frame_pattern = parse_frame_pattern(options.output);
    } catch (const std::invalid_argument& error) {
        fail(exit_usage, std::string("-o: ") + error.what());
    }
    if (options.has("--even") && options.has("--linear")) fail(exit_usage, "--even and --linear exclude each other: give one of them");
    if (options.has("--even") && options.has("--rho")) fail(exit_usage, "--even chooses the ratio of every step: leave --rho out");
}

void check_texture(const Options& options) {
    if (options.has("--levels") && options.texture_levels < options.octaves - 1)
        fail(exit_usage, "--levels " + std::to_string(options.texture_levels) + " cannot hold " + std::to_string(options.octaves) + " octaves: give " +
                             std::to_string(options.octaves - 1) + " levels or more, or fewer --octaves");
    if (options.on_mesh && options.scheme == LCL_SCHEME_DOO_SABIN)
        fail(exit_usage, "--on-mesh needs a refinement that keeps the vertices of the mesh, and doo-sabin's does not: take catmull-clark or loop");
}

/// surface
void check_fit(const Options& options) {
    for (const auto& [flag, reason] : not_of_clouds) {
        if (options.has(flag.c_str())) fail(exit_usage, flag + ": " + reason);
    }
    if (options.has("--fair") && options.fit != LCL_FIT_LEAST_SQUARES)
        fail(exit_usage, "--fair is the weight of the bending energy in a least-squares fit: add --fit least-squares, or leave it out");
    if (options.has("--engine") && options.engine.empty()) fail(exit_usage, "--engine is empty: name one, or leave it out for the first installed");
    for (auto setting = options.engine_options.begin(); setting != options.engine_options.end(); ++setting) {
        const auto same = [&setting](const auto& earlier) { return earlier.first == setting->first; };
        if (std::any_of(options.engine_options.begin(), setting, same)) fail(exit_usage, "--engine-option gives '" + setting->first + "' twice: leave one out");
    }
}

}  // namespace

const char* reason_against(const std::string& command, const std::string& flag) {
    const auto found = not_of_clouds.find(flag);
    return command == "surface" && found != not_of_clouds.end() ? found->second : nullptr;
}

const char* two_phase_option(const Options& options) {
    for (const char* flag : {"--refined", "--normals", "--handles", "--fair"})
        if (options.has(flag)) return flag;
    return nullptr;
}

void apply_rules(Options& options) {
    choose_scheme(options);
    if (options.quiet && options.verbosity > 0) fail(exit_usage, "--quiet and -v exclude each other: give one of them");
    if (options.command == "morph") check_morph(options);  // the pattern before its ending and names
    check_streams(options);
    check_endings(options);
    check_report_name(options);
    if (!options.map_file.empty() && options.map_file == options.output) fail(exit_usage, "--map would replace the mesh: give it another name");
    if (options.command == "interpolate") check_interpolate(options);
    if (options.command == "refine") check_refine(options);
    if (options.command == "expand") check_expand(options);
    if (options.command == "spectrum") check_spectrum(options);
    if (is_of_surface(options)) check_surface(options);
    if (options.command == "denoise") check_denoise(options);
    if (options.command == "texture") check_texture(options);
    if (reads_cloud(options)) check_fit(options);
}

}  // namespace lcl::cli
