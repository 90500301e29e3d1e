// SPDX-License-Identifier: BSD-3-Clause
// The one file that includes CLI11 (slow to compile).
#include "host/cli/options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <set>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

template <typename Value>
using Names = std::vector<std::pair<const char*, Value>>;

const Names<lcl_scheme> scheme_names = {{"catmull-clark", LCL_SCHEME_CATMULL_CLARK}, {"loop", LCL_SCHEME_LOOP}, {"doo-sabin", LCL_SCHEME_DOO_SABIN}};
const Names<lcl_mask> mask_names = {{"catmull", LCL_MASK_CATMULL}, {"classic", LCL_MASK_CLASSIC}};
const Names<lcl_boundary> boundary_names = {
    {"edge-and-corner", LCL_BOUNDARY_EDGE_AND_CORNER}, {"edge-only", LCL_BOUNDARY_EDGE_ONLY}, {"fixed", LCL_BOUNDARY_FIXED}};
const Names<lcl_precision> precision_names = {{"single", LCL_PRECISION_SINGLE}, {"mixed", LCL_PRECISION_MIXED}, {"double", LCL_PRECISION_DOUBLE}};
const Names<lcl_solver> solver_names = {{"auto", LCL_SOLVER_AUTO},           {"pia", LCL_SOLVER_PIA}, {"wpia", LCL_SOLVER_WPIA},
                                        {"jacobi", LCL_SOLVER_JACOBI},       {"gs", LCL_SOLVER_GS},   {"gs-coloured", LCL_SOLVER_GS_COLOURED},
                                        {"chebyshev", LCL_SOLVER_CHEBYSHEV}, {"cg", LCL_SOLVER_CG}};
const Names<lcl_format> format_names = {
    {"obj", LCL_FORMAT_OBJ}, {"off", LCL_FORMAT_OFF}, {"ply", LCL_FORMAT_PLY}, {"stl", LCL_FORMAT_STL}, {"om", LCL_FORMAT_OM}};

const std::array<const char*, 9> later_commands = {"evaluate", "closest", "expand", "spectrum", "denoise", "sharpen", "morph", "texture", "surface"};

constexpr const char* scheme_group = "Scheme and sharp features";
constexpr const char* solve_group = "Values and solving";
constexpr const char* run_group = "Device, report, text";

template <typename Value>
const char* name_of(const Names<Value>& names, Value value) {
    for (const auto& [name, of] : names) {
        if (of == value) return name;
    }
    return "default";
}

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

/// The whole text as a number; nothing where it is none.
std::optional<double> to_number(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
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

CLI::Validator positive_number() {
    const auto test = [](const std::string& text) {
        const std::optional<double> value = to_number(text);
        return value && std::isfinite(*value) && *value > 0.0 ? std::string() : "'" + text + "' is not a number above 0";
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

CLI::Validator count_from(int least) {
    const auto test = [least](const std::string& text) {
        int value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = error == std::errc() && end == text.data() + text.size() && value >= least && value <= 1000000000;
        return good ? std::string() : "'" + text + "' is not a whole number from " + std::to_string(least) + " to 1000000000";
    };
    return CLI::Validator(test, "");
}

/// What is wrong with a way to name a file that is written beside OUT.
void refuse_standard_output(const std::string& flag, const std::string& path) {
    if (path == "-") fail(exit_usage, flag + " needs a file's name: standard output is for -o and --report");
}

class Parser {
public:
    explicit Parser(Options& options)
        : options_(options), app_("Control meshes whose subdivision limit surface passes exactly through given vertices.", "limitcl") {
        app_.fallthrough();  // before the commands are added, which inherit it: options may stand before or after the command's name
        app_.require_subcommand(0, 1);
        app_.set_version_flag("--version", version_text, "Version, build, OpenCL platforms, file formats");
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
    CLI::App* add_command(const char* name, const char* text, bool reads_mesh, bool writes_mesh);
    void add_later(CLI::App& command, const std::string& flag, bool takes_value);
    std::string common_help(bool reads_mesh) const;
    std::string help_page() const;
    [[noreturn]] void refuse_extras(std::vector<std::string> extras) const;
    void refuse_what_is_not_there() const;
    void choose_scheme();
    void check_files() const;
    void check_command() const;
    bool given(const char* flag) const { return app_.get_option(flag)->count() > 0; }

    Options& options_;
    CLI::App app_;
    std::vector<CLI::Option*> later_options_;
};

std::string Parser::version_text() {
    std::string text =
        std::string("limitcl ") + lcl_version_string() + "\n" + lcl_build_string() + "\nfile formats: .obj .off .ply .stl .om, each also with .gz\n";
    std::set<std::string> platforms;
    for (int index = 0; index < lcl_device_count(); ++index) {
        lcl_device_info info = LCL_DEVICE_INFO_INIT;
        if (lcl_device_get_info(index, &info) == LCL_OK) platforms.insert(std::string(info.platform) + " (" + info.version + ")");
    }
    if (platforms.empty()) return text + "OpenCL platforms: none with a device";
    for (const std::string& platform : platforms) text += "OpenCL platform: " + platform + "\n";
    text.pop_back();
    return text;
}

void Parser::add_scheme_options() {
    add_choice(app_, "--scheme", options_.scheme, scheme_names, "Default: loop if all faces are triangles, else catmull-clark")->group(scheme_group);
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
        command->add_option("-o,--output", options_.output, "Mesh to write, may be IN; `-`: standard output (needs --format)")->type_name("OUT")->required();
    command->footer([this, reads_mesh] { return common_help(reads_mesh); });
    return command;
}

void Parser::add_commands() {
    add_command("devices", "List the OpenCL devices", false, false);
    add_command("selftest", "Every kernel against the plain host operator, on the chosen device", false, false);
    add_command("info", "What is in a file, and which schemes fit it", true, false);
    add_interpolate();
    add_limit();
    add_refine();
    for (const char* name : later_commands) {
        CLI::App* command = app_.add_subcommand(name)->group("")->prefix_command();
        command->set_help_flag();
        command->fallthrough(false);
    }
}

void Parser::add_interpolate() {
    CLI::App* command = add_command("interpolate", "Control mesh whose limit surface passes through IN's vertices", true, true);
    add_choice(*command, "--solver", options_.solver, solver_names, "Default auto: the fastest that is sure to converge");
    command->add_option("--subset", options_.subset_file, "Interpolate only these vertices, one a line")->type_name("FILE");
    command->add_option("--sweeps", options_.sweeps, "Exactly so many sweeps, no test")->check(count_from(1))->type_name("N");
    for (const char* flag : {"--normals", "--handles", "--fair", "--map"}) add_later(*command, flag, true);
    add_later(*command, "--refined", false);
}

void Parser::add_limit() {
    CLI::App* command = add_command("limit", "Every vertex moved to its limit point", true, true);
    add_later(*command, "--normals", false);
}

void Parser::add_refine() {
    CLI::App* command = add_command("refine", "Uniform refinement", true, true);
    command->add_option("--levels", options_.levels, "Refinements (default 1; 0 needs --limit)")->check(count_from(0))->type_name("K");
    command->add_flag("--limit", options_.limit, "Move the result on to the limit surface");
    command->add_option("--map", options_.map_file, "CSV of where each new vertex lies: vertex,face,corner,u,v")->type_name("FILE");
}

/// An option that is part of the command's contract but comes with a later version: known, so that asking for it gives a sentence of its own.
void Parser::add_later(CLI::App& command, const std::string& flag, bool takes_value) {
    CLI::Option* option = takes_value ? command.add_option_function<std::string>(flag, [](const std::string&) {}) : command.add_flag(flag);
    option->group("");
    later_options_.push_back(option);
}

std::string Parser::common_help(bool reads_mesh) const {
    const CLI::Formatter formatter;
    std::string text = "Before or after the command's name:";
    for (const char* group : {scheme_group, solve_group, run_group}) {
        if (!reads_mesh && group != run_group) continue;
        text += formatter.make_group(group, false, app_.get_options([group](const CLI::Option* option) { return option->get_group() == group; }));
    }
    return text;
}

void Parser::refuse_what_is_not_there() const {
    for (const char* name : later_commands) {
        if (options_.command == name)
            fail(exit_usage, std::string("this version does not have '") + name + "' yet; `limitcl --help` lists the commands it has");
    }
    for (const CLI::Option* option : later_options_) {
        if (option->count() > 0)
            fail(exit_usage, "this version does not have " + options_.command + " --" + option->get_lnames().front() + " yet; leave the option out");
    }
}

void Parser::choose_scheme() {
    for (const char* flag : {"--alpha", "--lambda"}) {
        if (!given(flag)) continue;
        if (given("--mask")) fail(exit_usage, std::string(flag) + " is of catmull-clark and --mask of doo-sabin: give one of them");
        if (given("--scheme") && options_.scheme != LCL_SCHEME_CATMULL_CLARK)
            fail(exit_usage, std::string(flag) + " is of catmull-clark: leave it out, or give --scheme catmull-clark");
        options_.scheme = LCL_SCHEME_CATMULL_CLARK;
    }
    if (!given("--mask")) return;
    if (given("--scheme") && options_.scheme != LCL_SCHEME_DOO_SABIN) fail(exit_usage, "--mask is of doo-sabin: leave it out, or give --scheme doo-sabin");
    options_.scheme = LCL_SCHEME_DOO_SABIN;
}

void Parser::check_files() const {
    const bool streams = options_.input == "-" || options_.output == "-";
    if (streams && !given("--format")) fail(exit_usage, "standard input and output have no ending: give --format obj, off, ply, stl or om");
    if (!streams && given("--format")) fail(exit_usage, "--format is for standard input and output; a file's ending names its format");
    if (options_.output == "-" && options_.report == "-") fail(exit_usage, "-o - and --report - cannot both have standard output: give one of them a file");
    for (const std::string& path : {options_.input, options_.output}) {
        lcl_format format = LCL_FORMAT_BY_ENDING;
        if (!path.empty() && path != "-" && lcl_format_of_path(path.c_str(), &format) != LCL_OK) fail(exit_usage, lcl_last_error());
    }
    refuse_standard_output("--map", options_.map_file);
    const bool report_is_file = !options_.report.empty() && options_.report != "-";
    if (report_is_file && (options_.report == options_.output || options_.report == options_.map_file))
        fail(exit_usage, "the report would replace another output, '" + options_.report + "': give --report another name");
    if (!options_.map_file.empty() && options_.map_file == options_.output) fail(exit_usage, "--map would replace the mesh: give it another name");
}

void Parser::check_command() const {
    if (options_.quiet && options_.verbosity > 0) fail(exit_usage, "--quiet and -v exclude each other: give one of them");
    if (options_.command == "devices" || options_.command == "selftest") {
        for (const CLI::Option* option : app_.get_options()) {
            const bool of_meshes = option->get_group() == scheme_group || option->get_group() == solve_group;
            if (of_meshes && option->count() > 0) fail(exit_usage, "'" + options_.command + "' reads no mesh and takes no " + option->get_name());
        }
        return;
    }
    check_files();
    if (options_.command == "refine" && options_.levels == 0 && !options_.limit)
        fail(exit_usage, "--levels 0 changes nothing without --limit: add it, or give a level from 1");
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
    refuse_what_is_not_there();
    choose_scheme();
    check_command();
    return std::nullopt;
}

}  // namespace

std::optional<int> parse_options(int argc, char** argv, Options& options) { return Parser(options).parse(argc, argv); }

const char* scheme_name(lcl_scheme scheme) { return name_of(scheme_names, scheme); }

const char* mask_name(lcl_mask mask) { return name_of(mask_names, mask); }

const char* boundary_name(lcl_boundary boundary) { return name_of(boundary_names, boundary); }

const char* precision_name(lcl_precision precision) { return name_of(precision_names, precision); }

const char* solver_name(lcl_solver solver) { return name_of(solver_names, solver); }

}  // namespace lcl::cli
