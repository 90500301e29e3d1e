// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/scheme_choice.h"

#include "host/cli/csv.h"
#include "host/cli/failure.h"
#include "host/cli/option_names.h"

namespace lcl::cli {

namespace {

/// One ratio a vertex; 0 where the file lists none.
std::vector<double> read_lambda(const std::string& path, std::int32_t vertex_count) {
    const Table table = read_table(path, "vertex,lambda");
    std::vector<double> lambda(static_cast<std::size_t>(vertex_count), 0.0);
    std::vector<char> seen(lambda.size(), 0);
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const double ratio = table.values[2 * row + 1];
        if (!(ratio >= 0.0 && ratio <= 1.0)) fail_at(path, table.lines[row], "the blend ratio " + short_number(ratio) + " is not between 0 and 1");
        lambda[static_cast<std::size_t>(vertex_of_row(table, row, seen))] = ratio;
    }
    return lambda;
}

void require_suitable(Job& job, lcl_mesh mesh, const lcl_scheme_options& options) {
    const Phase phase(job, &Seconds::topology, "checking the scheme");
    lcl_suitability suitability = LCL_SUITABILITY_INIT;
    check_of_input(job, lcl_mesh_check_scheme(mesh, &options, &suitability));
    if (suitability.suitable) return;
    Failure failure = make_failure(exit_bad_input, of_input(job, suitability.reason));
    failure.vertices.assign(suitability.vertices, suitability.vertices + suitability.vertex_count);
    throw failure;
}

}  // namespace

lcl_scheme default_scheme(const Options& options, lcl_mesh mesh) {
    if (options.scheme != LCL_SCHEME_DEFAULT) return options.scheme;
    for (const auto& [degree, count] : histogram_of(mesh, LCL_HISTOGRAM_FACE_DEGREES)) {
        if (degree != 3 && count > 0) return LCL_SCHEME_CATMULL_CLARK;
    }
    return LCL_SCHEME_LOOP;
}

SchemeChoice choose_scheme(Job& job, lcl_mesh mesh) {
    const Options& options = job.options;
    SchemeChoice choice;
    choice.options.scheme = default_scheme(options, mesh);
    choice.options.mask = options.mask;
    choice.options.alpha = options.alpha;
    choice.options.alpha_auto = options.alpha_auto;
    choice.options.lambda = options.lambda;
    if (!options.lambda_file.empty()) {
        choice.lambda = read_lambda(options.lambda_file, lcl_mesh_vertex_count(mesh));
        choice.options.lambda_per_vertex = choice.lambda.data();
    }
    if (!options.subset_file.empty()) {
        choice.subset = read_vertex_list(options.subset_file, lcl_mesh_vertex_count(mesh));
        choice.options.subset = choice.subset.data();
        choice.options.subset_count = choice.subset.size();
        job.report.set_parameter("subset", static_cast<std::int64_t>(choice.subset.size()));
    }
    note_scheme(job, choice.options);
    require_suitable(job, mesh, choice.options);
    return choice;
}

void resolve_alpha(Job& job, Context& context, lcl_mesh mesh, lcl_scheme_options& scheme) {
    if (!scheme.alpha_auto) return;
    if (!context) context = open_device(job);
    const Operator A = make_operator(job, context.get(), mesh, scheme);
    lcl_scheme_options in_use = LCL_SCHEME_OPTIONS_INIT;
    check(lcl_operator_get_scheme(A.get(), &in_use));
    scheme.alpha = in_use.alpha;
    scheme.alpha_auto = 0;
    note_scheme(job, scheme);
}

void note_scheme(Job& job, const lcl_scheme_options& scheme) {
    job.report.scheme = scheme_name(scheme.scheme);
    if (scheme.scheme == LCL_SCHEME_DOO_SABIN) job.report.set_parameter("mask", std::string(mask_name(scheme.mask)));
    if (scheme.scheme != LCL_SCHEME_CATMULL_CLARK) return;
    if (scheme.alpha_auto) job.report.set_parameter("alpha", std::string("auto"));
    else job.report.set_parameter("alpha", scheme.alpha);
    if (job.options.lambda_file.empty()) job.report.set_parameter("lambda", scheme.lambda);
    else job.report.set_parameter("lambda", job.options.lambda_file);
}

void note_scheme_in_use(Job& job, lcl_operator A) {
    lcl_scheme_options in_use = LCL_SCHEME_OPTIONS_INIT;
    check(lcl_operator_get_scheme(A, &in_use));
    in_use.alpha_auto = 0;
    note_scheme(job, in_use);
}

void say_scheme(Job& job) {
    std::string text = job.report.scheme;
    for (const auto& [name, value] : job.report.parameters) {
        if (name != "alpha" && name != "lambda" && name != "mask" && name != "boundary") continue;
        const auto* number = std::get_if<double>(&value);
        const auto* word = std::get_if<std::string>(&value);
        text += ", " + name + " " + (number ? short_number(*number) : word ? *word : std::string());
    }
    job.terminal.say("scheme", text);
}

}  // namespace lcl::cli
