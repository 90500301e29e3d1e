// SPDX-License-Identifier: BSD-3-Clause
// The one file that includes CLI11 (slow to compile).
#include "host/cli/options.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "host/cli/engine_library.h"
#include "host/cli/failure.h"
#include "host/cli/option_names.h"
#include "host/cli/option_rules.h"
#include "host/cli/option_values.h"
#include "host/cli/terminal.h"

namespace lcl::cli {

namespace {

constexpr const char* scheme_group = "Scheme and sharp features";
constexpr const char* solve_group = "Values and solving";
constexpr const char* run_group = "Device, report, text";

/// An option whose value is one of a list of names.
template <typename Value>
CLI::Option* add_choice(CLI::App& app, const std::string& flag, Value& value, const Names<Value>& names, const std::string& text) {
    std::string list;
    for (const auto& entry : names) list += (list.empty() ? "" : "|") + std::string(entry.first);
    const auto set = [&value, &names, list, flag](const std::string& given) {
        for (const auto& [name, of] : names) {
            if (given != name) continue;
            value = of;
            return;
        }
        throw CLI::ValidationError(flag, "'" + given + "' is none of " + list);
    };
    return app.add_option_function<std::string>(flag, set, text)->type_name(list);
}

/// An option whose text `parse` makes a value of; std::invalid_argument says why not.
template <typename Value, typename Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& flag, Value& value, Parse parse, const std::string& text) {
    const auto set = [&value, parse, flag](const std::string& given) {
        try {
            value = parse(given);
        } catch (const std::invalid_argument& error) {
            throw CLI::ValidationError(flag, error.what());
        }
    };
    return app.add_option_function<std::string>(flag, set, text);
}

bool is_fraction(double value) { return value >= 0.0 && value <= 1.0; }

void set_alpha(Options& options, const std::string& text) {
    options.alpha_auto = text == "auto";
    if (options.alpha_auto) return;
    const std::optional<double> alpha = to_number(text);
    if (!alpha || !is_fraction(*alpha)) throw CLI::ValidationError("--alpha", "'" + text + "' is neither a number from 0 to 1 nor auto");
    options.alpha = *alpha;
}

void set_lambda(Options& options, const std::string& text) {
    const std::optional<double> lambda = to_number(text);
    if (lambda && !is_fraction(*lambda)) throw CLI::ValidationError("--lambda", "'" + text + "' is not between 0 and 1");
    if (lambda) options.lambda = *lambda;
    else options.lambda_file = text;
}

/// Two numbers, or else a file's name.
void set_handles(Options& options, const std::string& text) {
    const std::size_t comma = text.find(',');
    const std::string parts[2] = {text.substr(0, comma), comma == std::string::npos ? "" : text.substr(comma + 1)};
    const bool is_file = !text.empty() && !to_number(parts[0]) && !to_number(parts[1]);
    if (is_file) {
        options.handles_file = text;
        return;
    }
    for (std::size_t i = 0; i < 2; ++i) {
        options.handles[i] = to_number(parts[i]).value_or(0.0);
        if (!(options.handles[i] > 0.0) || !std::isfinite(options.handles[i]))
            throw CLI::ValidationError("--handles", "'" + text + "' is neither two numbers above 0, S1,S2, nor a file");
    }
}

void add_setting(Options& options, const std::string& text) {
    try {
        options.engine_options.push_back(parse_setting(text));
    } catch (const std::invalid_argument& error) {
        throw CLI::ValidationError("--engine-option", error.what());
    }
}

CLI::Validator positive_number() {
    const auto test = [](const std::string& text) {
        const std::optional<double> value = to_number(text);
        return value && std::isfinite(*value) && *value > 0.0 ? std::string() : "'" + text + "' is not a number above 0";
    };
    return CLI::Validator(test, "");
}

CLI::Validator weight() {
    const auto test = [](const std::string& text) {
        const std::optional<double> value = to_number(text);
        return value && std::isfinite(*value) && *value >= 0.0 ? std::string() : "'" + text + "' is not a number from 0 on";
    };
    return CLI::Validator(test, "");
}

CLI::Validator angle() {
    const auto test = [](const std::string& text) {
        const std::optional<double> value = to_number(text);
        return value && *value > 0.0 && *value <= 180.0 ? std::string() : "'" + text + "' is not an angle above 0 and up to 180 degrees";
    };
    return CLI::Validator(test, "");
}

CLI::Validator fraction() {
    const auto test = [](const std::string& text) {
        const std::optional<double> value = to_number(text);
        return value && is_fraction(*value) ? std::string() : "'" + text + "' is not a number from 0 to 1";
    };
    return CLI::Validator(test, "");
}

CLI::Validator count_within(int least, int most) {
    const auto test = [least, most](const std::string& text) {
        const bool good = to_count(text, least, most).has_value();
        return good ? std::string() : "'" + text + "' is not a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    };
    return CLI::Validator(test, "");
}

CLI::Validator count_from(int least) { return count_within(least, 1000000000); }

bool reads_nothing(const std::string& command) { return command == "devices" || command == "selftest"; }

class Parser {
public:
    explicit Parser(Options& options)
        : options_(options), app_("Control meshes whose subdivision limit surface passes exactly through given vertices.", "limitcl") {
        app_.fallthrough();  // before the commands are added, which inherit it: options may stand before or after the command's name
        app_.require_subcommand(0, 1);
        app_.set_version_flag("--version", version_text, "Version, build, OpenCL platforms, file formats, engines of point clouds");
        app_.get_formatter()->label("SUBCOMMAND", "COMMAND");  // before the commands are added, which share the formatter
        app_.get_formatter()->label("REQUIRED", "");
        app_.footer("Every option of a command: limitcl COMMAND --help");
        add_scheme_options();
        add_solve_options();
        add_run_options();
        add_commands();
    }

    std::optional<int> parse(int argc, char** argv);

private:
    static std::string version_text();
    void add_scheme_options();
    void add_solve_options();
    void add_run_options();
    void add_commands();
    void add_interpolate();
    void add_limit();
    void add_refine();
    void add_expand();
    void add_spectrum();
    void add_denoise();
    void add_sharpen();
    void add_morph();
    void add_texture();
    void add_evaluate();
    void add_closest();
    void add_surface();
    CLI::App* add_command(const char* name, const char* text, bool reads_mesh, bool writes_mesh);
    std::string common_help(const std::string& command) const;
    std::string help_page() const;
    [[noreturn]] void refuse_extras(std::vector<std::string> extras) const;
    void note_what_is_given();

    Options& options_;
    CLI::App app_;
};

/// What `surface` can make its approximation with.
std::string engine_text() {
    std::vector<std::string> lines, warnings;
    for (const Engine& engine : installed_engines(warnings))
        lines.push_back("engine: " + engine.name + " (" + engine.description + ", " + engine.licence + ")");
    if (lines.empty()) lines.push_back("engines: none");
    for (const std::string& warning : warnings) lines.push_back("warning: " + warning);
    return join(lines, "\n");
}

/// The same with their options, a line each.
std::string engine_help() {
    std::vector<std::string> warnings;
    std::string text = "Engines installed:";
    const std::vector<Engine> engines = installed_engines(warnings);
    for (const Engine& engine : engines) {
        text += "\n  " + engine.name + ": " + engine.description + ", " + engine.licence;
        std::istringstream options(engine.options);
        for (std::string line; std::getline(options, line);) text += "\n    " + line;
    }
    if (engines.empty()) text += " none";
    for (const std::string& warning : warnings) text += "\n  warning: " + warning;
    return text + "\n";
}

std::string Parser::version_text() {
    std::string text = std::string("limitcl ") + lcl_version_string() + "\n" + lcl_build_string() +
                       "\nfile formats: .obj .off .ply .stl .om of meshes, .ply .xyz .csv .off .obj .pts of points, each also with .gz\n";
    std::set<std::string> platforms;
    for (int index = 0; index < lcl_device_count(); ++index) {
        lcl_device_info info = LCL_DEVICE_INFO_INIT;
        if (lcl_device_get_info(index, &info) == LCL_OK) platforms.insert(std::string(info.platform) + " (" + info.version + ")");
    }
    if (platforms.empty()) text += "OpenCL platforms: none with a device\n";
    for (const std::string& platform : platforms) text += "OpenCL platform: " + platform + "\n";
    return text + engine_text();
}

void Parser::add_scheme_options() {
    add_choice(app_, "--scheme", options_.scheme, scheme_names, "Default: loop if all faces are triangles, else catmull-clark; surface: doo-sabin")
        ->group(scheme_group);
    app_.add_option_function<std::string>(
            "--alpha", [this](const std::string& text) { set_alpha(options_, text); },
            "Catmull-Clark parameter, 0 to 1 (default 0); auto: 0, or 0.5 where 0 is singular or nearly so")
        ->type_name("A|auto")
        ->group(scheme_group);
    add_choice(app_, "--mask", options_.mask, mask_names, "Doo-Sabin mask (default catmull)")->group(scheme_group);
    app_.add_option_function<std::string>(
            "--lambda", [this](const std::string& text) { set_lambda(options_, text); },
            "Two-phase blend ratio, 0 to 1 (default 0), or a CSV with header vertex,lambda")
        ->type_name("L|FILE")
        ->group(scheme_group);
    add_choice(app_, "--boundary", options_.boundary, boundary_names,
               "Default edge-and-corner: boundary curves, and vertices with one face are corners; fixed: every boundary vertex is a corner")
        ->group(scheme_group);
    app_.add_option("--creases", options_.creases_file, "Sharp edges, `v0 v1` a line")->type_name("FILE")->group(scheme_group);
    app_.add_option("--corners", options_.corners_file, "Vertices that stay, one a line")->type_name("FILE")->group(scheme_group);
    app_.add_option("--crease-angle", options_.crease_angle, "Edges whose face normals differ by more are sharp")
        ->check(angle())
        ->type_name("DEG")
        ->group(scheme_group);
}

void Parser::add_solve_options() {
    add_choice(app_, "--precision", options_.precision, precision_names, "Default mixed: float sweeps, residuals and corrections in more")->group(solve_group);
    app_.add_option("--tol", options_.tolerance, "Largest residual, relative to the bounding box's diagonal (default 1e-6)")
        ->check(positive_number())
        ->type_name("T")
        ->group(solve_group);
    app_.add_option("--max-iter", options_.max_iterations, "Iterations at most (default 200)")->check(count_from(1))->type_name("N")->group(solve_group);
    app_.add_flag("--keep-going", options_.keep_going,
                  "Write what there is although the result is singular, indefinite or not converged (exit code 4 all the same)")
        ->group(solve_group);
    app_.add_option("--channels", options_.channels, "Per-vertex data treated like x, y, z: none (default), colours, all, or names")
        ->type_name("none|colours|all|NAME,..")
        ->group(solve_group);
    add_choice(app_, "--format", options_.format, format_names, "Format of standard input or output")->group(solve_group);
}

void Parser::add_run_options() {
    app_.add_option("--device", options_.device, "Index, part of a name, cpu or gpu (default: LIMITCL_DEVICE, else the fastest GPU, else the CPU)")
        ->type_name("SPEC")
        ->group(run_group);
    app_.add_option("--report", options_.report, "JSON report; `-`: standard output")->type_name("FILE")->group(run_group);
    app_.add_flag("--quiet", options_.quiet, "Standard error stays empty but for the one line of a failure")->group(run_group);
    app_.add_flag("-v,--verbose", options_.verbosity, "Say more; twice: still more")->group(run_group);
    app_.add_flag("--no-progress", options_.no_progress, "No progress line on a terminal")->group(run_group);
    app_.add_option("--color", options_.color, "Default auto: on a terminal, unless NO_COLOR is set")
        ->check(CLI::IsMember({"auto", "always", "never"}).description(""))
        ->type_name("auto|always|never")
        ->group(run_group);
}

CLI::App* Parser::add_command(const char* name, const char* text, bool reads_mesh, bool writes_mesh) {
    CLI::App* command = app_.add_subcommand(name, text)->group("Commands");
    if (reads_mesh)
        command->add_option("IN", options_.input, "Mesh: .obj .off .ply .stl .om, also .gz; `-`: standard input (needs --format)")->type_name("")->required();
    if (writes_mesh)
        command->add_option("-o,--output", options_.output, "Mesh to write, may be the input; `-`: standard output (needs --format)")
            ->type_name("OUT")
            ->required();
    command->footer([this, command] { return common_help(command->get_name()); });
    return command;
}

void Parser::add_commands() {
    add_command("devices", "List the OpenCL devices", false, false);
    add_command("selftest", "Every kernel against the plain host operator, on the chosen device", false, false);
    add_command("info", "What is in a file, and which schemes fit it", true, false);
    add_interpolate();
    add_limit();
    add_refine();
    add_expand();
    add_spectrum();
    add_denoise();
    add_sharpen();
    add_morph();
    add_texture();
    add_evaluate();
    add_closest();
    add_surface();
}

void Parser::add_interpolate() {
    CLI::App* command = add_command("interpolate", "Control mesh whose limit surface passes through IN's vertices", true, true);
    add_choice(*command, "--solver", options_.solver, solver_names, "Default auto: the fastest that is sure to converge");
    command->add_option("--subset", options_.subset_file, "Interpolate only these vertices, one a line")->type_name("FILE");
    command->add_option("--sweeps", options_.sweeps, "Exactly so many sweeps, no test")->check(count_from(1))->type_name("N");
    command->add_flag("--refined", options_.refined,
                      "Two-phase scheme: the refined control mesh M^1, which meets all vertices exactly (with --lambda, as the next four)");
    command->add_option("--normals", options_.normals, "Normals to have: a CSV with header vertex,nx,ny,nz, or those of IN")->type_name("FILE|mesh");
    command
        ->add_option_function<std::string>(
            "--handles", [this](const std::string& text) { set_handles(options_, text); },
            "Shape handles of convex and of other vertices, or a CSV with header vertex,s: above 1 flatter, below 1 sharper")
        ->type_name("S1,S2|FILE");
    command->add_option("--fair", options_.fair, "Weight of fairness: bumps are taken out as far as the vertices allow")
        ->check(positive_number())
        ->type_name("W");
    command->add_option("--map", options_.map_file, "CSV of the refined vertex of each vertex: vertex,refined_vertex")->type_name("FILE");
}

void Parser::add_limit() {
    CLI::App* command = add_command("limit", "Every vertex moved to its limit point", true, true);
    command->add_flag("--normals", options_.limit_normals,
                      "Unit limit normals too (OBJ, PLY, OFF): at creases the mean of the sides, 0 0 0 at isolated vertices");
}

void Parser::add_refine() {
    CLI::App* command = add_command("refine", "Uniform refinement", true, true);
    command->add_option("--levels", options_.levels, "Refinements (default 1; 0 needs --limit)")->check(count_from(0))->type_name("K");
    command->add_flag("--limit", options_.limit, "Move the result on to the limit surface");
    command->add_option("--map", options_.map_file, "CSV of where each new vertex lies: vertex,face,corner,u,v")->type_name("FILE");
}

void Parser::add_expand() {
    CLI::App* command = add_command("expand", "Mesh expansion: a term, a band, a partial sum, or an equaliser", true, true);
    add_choice(*command, "--series", options_.series, series_names, "Default representation: terms that sum to IN; interpolation: to its control mesh");
    command->add_option("--term", options_.term, "Term I alone")->check(count_within(0, most_terms))->type_name("I");
    command->add_option("--sum", options_.sum, "Terms 0 to M")->check(count_within(0, most_terms))->type_name("M");
    const auto band = [](const std::string& text) { return parse_band(text, 0); };
    add_parsed(*command, "--band", options_.band, band, "Terms I to J")->type_name("I:J");
    add_parsed(*command, "--equaliser", options_.equaliser, parse_equaliser,
               "Weights of the terms 0 to m, and of what they leave (default 1; representation series only)")
        ->type_name("w0,..,wm[:r]");
}

void Parser::add_spectrum() {
    CLI::App* command = add_command("spectrum", "Energy of every term of the expansion", true, false);
    command->add_option("-o,--output", options_.output, "Table .csv or chart .svg (default: the CSV on standard output)")->type_name("OUT");
    command->add_option("--terms", options_.terms, "Terms 0 to N - 1 (default 16)")->check(count_within(1, most_terms))->type_name("N");
}

void Parser::add_denoise() {
    CLI::App* command = add_command("denoise", "Noise filtered away: D^k A with D = E - (E - A)^(m + 1)", true, true);
    command->add_option("--m", options_.m, "Terms 0 to m pass (default 2); the fewer, the smoother")->check(count_within(0, most_terms))->type_name("M");
    command->add_option("--k", options_.k, "How many times D filters (default 3)")->check(count_within(0, most_terms))->type_name("K");
    command->add_flag("--plain", options_.plain, "D^k instead of D^k A");
    command
        ->add_option("--strength", options_.strength,
                     "0 (hardly) to 1 (most), by tenths, instead of m and k; 0.5: their defaults; 0.8 to 1 for noise of 0.1 to 0.7 edge lengths")
        ->check(fraction())
        ->type_name("S");
    command->add_flag("--keep-volume", options_.keep_volume, "Closed meshes: moved along the normals until they enclose as much as before");
    command->add_option("--pin", options_.pin_file, "Vertices that stay where they are, one a line")->type_name("FILE");
    add_choice(*command, "--operator", options_.feature_operator, operator_names, "Default limit: A of the scheme; features: one that keeps sharp edges");
}

void Parser::add_sharpen() {
    CLI::App* command = add_command("sharpen", "Detail raised: terms of higher frequency added", true, true);
    const auto band = [](const std::string& text) { return parse_band(text, 1); };
    add_parsed(*command, "--band", options_.band, band, "Terms m to n of the interpolation series are added (default 1:3)")->type_name("m:n");
    command->add_option("--k", options_.sharpen_steps, "Times (default 1)")->check(count_within(1, most_terms))->type_name("K");
}

void Parser::add_morph() {
    CLI::App* command = app_.add_subcommand("morph", "Frames from one mesh to another of the same faces")->group("Commands");
    command->add_option("FROM", options_.input, "Mesh where it starts; `-`: standard input (needs --format)")->type_name("")->required();
    command->add_option("TO", options_.target, "Mesh where it ends, with FROM's faces")->type_name("")->required();
    command->add_option("-o,--output", options_.output, "Names of the frames, with one %d or %03d for the number")->type_name("'OUT_%03d.obj'")->required();
    command->add_option("--frames", options_.frames, "Steps (default 10): N + 1 files, FROM is frame 0")->check(count_within(1, 1000000))->type_name("N");
    add_parsed(*command, "--m", options_.morph_m, parse_counts, "m of the filter D of each step, the last repeated (default 2)")->type_name("M,..");
    add_parsed(*command, "--rho", options_.rho, parse_ratios,
               "Ratio of each step, the last repeated (default 0.5): the smaller, the faster; the last frame only comes near TO")
        ->type_name("R,..");
    command->add_flag_callback(
        "--even", [this] { options_.path = LCL_MORPH_EVEN; }, "Even steps that end on TO itself, instead of --rho");
    command->add_flag_callback(
        "--linear", [this] { options_.path = LCL_MORPH_LINEAR; }, "Straight lines, for comparison");
    command->footer([this] { return common_help("morph"); });
}

void Parser::add_texture() {
    CLI::App* command = add_command("texture", "Procedural texture as colours of the vertices of a refined mesh", true, true);
    command->add_option("--octaves", options_.octaves, "Octaves of noise (default 4)")->check(count_within(1, 20))->type_name("N");
    command->add_option("--frequency", options_.frequency, "Noise cells across the bounding box's diagonal in the first octave (default 8)")
        ->check(positive_number())
        ->type_name("F");
    command->add_option("--levels", options_.texture_levels, "Refinements of IN, from octaves - 1 (the default) on")->check(count_from(0))->type_name("K");
    add_parsed(*command, "--colors", options_.colours, parse_colours, "Colours that the curve of colours passes through (default: marble)")
        ->type_name("'#rrggbb,..'");
    const auto seed = [](const std::string& text) {
        const std::optional<std::int64_t> value = to_count(text, 0, std::numeric_limits<std::uint32_t>::max());
        if (!value) throw std::invalid_argument("'" + text + "' is not a whole number from 0 to 4294967295");
        return static_cast<std::uint32_t>(*value);
    };
    add_parsed(*command, "--seed", options_.seed, seed, "Another texture for every number (default 0)")->type_name("S");
    command->add_flag("--on-mesh", options_.on_mesh, "OUT is IN itself with the colours at its vertices");
}

void Parser::add_evaluate() {
    CLI::App* command = add_command("evaluate", "Exact points, derivatives and normals anywhere on the limit surface", true, false);
    command->add_option("--at", options_.places_file, "CSV of places with header face,corner,u,v")->type_name("FILE.csv")->required();
    command->add_option("-o,--output", options_.output, "Table to write; `-`: standard output")->type_name("OUT.csv")->required();
    command
        ->add_option("--derivatives", options_.derivatives,
                     "0: points alone; 1 (default): first derivatives and normals too; 2: second ones and curvatures too")
        ->check(count_within(0, 2))
        ->type_name("0|1|2");
}

void Parser::add_closest() {
    CLI::App* command = add_command("closest", "Closest points on the limit surface", true, false);
    command->add_option("--points", options_.points_file, "Points: .ply .xyz .csv .off .obj .pts, also .gz")->type_name("FILE")->required();
    command->add_option("-o,--output", options_.output, "Table to write; `-`: standard output")->type_name("OUT.csv")->required();
}

void Parser::add_surface() {
    CLI::App* command = add_command("surface", "Control mesh of a surface through a cloud of points", false, true);
    command->add_option("POINTS", options_.input, "Points: .ply .xyz .csv .off .obj .pts, also .gz; `-`: standard input (needs --format)")
        ->type_name("")
        ->required();
    command->add_option("--tolerance", options_.fit_tolerance, "Largest distance of a point, relative to the bounding box's diagonal (default 1e-3)")
        ->check(positive_number())
        ->type_name("T");
    command->add_option("--vertices", options_.most_vertices, "At most so many (default: as many as the tolerance takes)")
        ->check(count_from(4))
        ->type_name("N");
    add_choice(*command, "--fit", options_.fit, fit_names,
               "Default interpolate: through points of the cloud; least-squares: as near as such a mesh can come to all of them, for noise");
    command->add_option("--fair", options_.fit_fair, "Weight of the bending energy in a least-squares fit (default 1e-3)")->check(weight())->type_name("W");
    command->add_option("--fill-holes", options_.fill_holes, "Close boundary loops of at most so many edges")->check(count_within(3, 1000))->type_name("EDGES");
    command->add_option("--engine", options_.engine, "What makes the first mesh of the points (default: the first installed, see below)")->type_name("NAME");
    const auto add_settings = [this](const std::vector<std::string>& settings) {
        for (const std::string& setting : settings) add_setting(options_, setting);
    };
    command->add_option_function<std::vector<std::string>>("--engine-option", add_settings, "An option of the engine; may be given for each of them")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    command->footer([this] { return engine_help() + "\n" + common_help("surface"); });
}

std::string Parser::common_help(const std::string& command) const {
    const CLI::Formatter formatter;
    std::string text = "Before or after the command's name:";
    for (const char* group : {scheme_group, solve_group, run_group}) {
        if (group != run_group && reads_nothing(command)) continue;
        const auto is_taken = [&](const CLI::Option* option) { return option->get_group() == group && !reason_against(command, option->get_name()); };
        text += formatter.make_group(group, false, app_.get_options(is_taken));
    }
    return text;
}

/// Also refuses options of meshes with a command that reads none.
void Parser::note_what_is_given() {
    for (CLI::App* app : {&app_, app_.get_subcommands().front()}) {
        for (const CLI::Option* option : app->get_options()) {
            if (option->count() == 0) continue;
            options_.given.insert(option->get_name());
            const bool of_meshes = option->get_group() == scheme_group || option->get_group() == solve_group;
            if (of_meshes && reads_nothing(options_.command)) fail(exit_usage, "'" + options_.command + "' reads no mesh and takes no " + option->get_name());
        }
    }
}

/// The page that lists what the command line should have held.
std::string Parser::help_page() const {
    const std::vector<CLI::App*> commands = app_.get_subcommands();
    return "`limitcl " + (commands.empty() ? "" : commands.front()->get_name() + " ") + "--help`";
}

/// Words that are no option and no file: without a command the first of them was meant as one.
void Parser::refuse_extras(std::vector<std::string> extras) const {
    const auto is_option = [](const std::string& word) { return word.size() > 1 && word[0] == '-'; };
    const auto first_word = std::find_if_not(extras.begin(), extras.end(), is_option);
    if (app_.get_subcommands().empty() && first_word != extras.end())
        fail(exit_usage, "there is no command '" + *first_word + "'; `limitcl --help` lists them");
    const auto first_option = std::find_if(extras.begin(), extras.end(), is_option);
    const std::string& culprit = first_option != extras.end() ? *first_option : extras.front();
    fail(exit_usage, "'" + culprit + "' is not expected here; see " + help_page());
}

std::optional<int> Parser::parse(int argc, char** argv) {
    try {
        app_.parse(argc, argv);
    } catch (const CLI::Success& request) {
        return app_.exit(request, std::cout, std::cerr);
    } catch (const CLI::ExtrasError&) {
        refuse_extras(app_.remaining(true));
    } catch (const CLI::ParseError& error) {
        fail(exit_usage, std::string(error.what()) + "; see " + help_page());
    }
    const std::vector<CLI::App*> commands = app_.get_subcommands();
    if (commands.empty()) fail(exit_usage, "no command; `limitcl --help` lists them");
    options_.command = commands.front()->get_name();
    note_what_is_given();
    apply_rules(options_);
    return std::nullopt;
}

}  // namespace

std::optional<int> parse_options(int argc, char** argv, Options& options) { return Parser(options).parse(argc, argv); }

}  // namespace lcl::cli
