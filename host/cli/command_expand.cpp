// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "host/cli/channels.h"
#include "host/cli/commands.h"
#include "host/cli/filter_step.h"
#include "host/cli/option_names.h"

namespace lcl::cli {

namespace {

bool is_equaliser(const Options& options) { return options.has("--equaliser"); }

/// The terms that are summed.
Band chosen_terms(const Options& options) {
    if (is_equaliser(options)) return {0, static_cast<int>(options.equaliser.weights.size()) - 1};
    if (options.has("--term")) return {options.term, options.term};
    return options.has("--sum") ? Band{0, options.sum} : options.band;
}

void note_terms(Job& job) {
    const Options& options = job.options;
    job.report.set_parameter("series", std::string(series_name(options.series)));
    if (options.has("--term")) job.report.set_parameter("term", static_cast<std::int64_t>(options.term));
    if (options.has("--sum")) job.report.set_parameter("sum", static_cast<std::int64_t>(options.sum));
    if (options.has("--band")) job.report.set_parameter("band", std::vector<int>{options.band.first, options.band.last});
    if (!is_equaliser(options)) return;
    job.report.set_parameter("weights", options.equaliser.weights);
    if (options.series == LCL_SERIES_REPRESENTATION) job.report.set_parameter("remainder", options.equaliser.remainder.value_or(1.0));
}

lcl_expand_options expand_options(Job& job) {
    const Options& options = job.options;
    const Band terms = chosen_terms(options);
    lcl_expand_options expand = LCL_EXPAND_OPTIONS_INIT;
    expand.series = options.series;
    expand.precision = options.precision;
    expand.first = terms.first;
    expand.last = terms.last;
    if (is_equaliser(options)) {
        expand.weights = options.equaliser.weights.data();
        expand.weight_count = options.equaliser.weights.size();
        expand.remainder = options.equaliser.remainder.value_or(1.0);
    }
    expand.progress = on_pass;
    expand.progress_user = &job.terminal.progress();
    return expand;
}

/// On a singular operator the terms of the interpolation series do not tend to nothing: its null vectors stay in all of them.
std::optional<Failure> interpolation_failure(Job& job, const Filter& filter) {
    if (job.options.series != LCL_SERIES_INTERPOLATION) return std::nullopt;
    lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
    {
        const Phase phase(job, &Seconds::solve, "looking at the spectrum", filter.context.get());
        check(lcl_operator_diagnose(filter.A.get(), &diagnosis));
    }
    const std::vector<std::int32_t> vertices(diagnosis.vertices, diagnosis.vertices + diagnosis.vertex_count);
    if (diagnosis.singular || diagnosis.indefinite) {
        Failure failure = make_failure(exit_no_result, diagnosis.reason);
        failure.status = diagnosis.singular ? "singular" : "indefinite";
        failure.vertices = vertices;
        return failure;
    }
    if (diagnosis.reason[0] != '\0') {
        warn(job, diagnosis.reason);
        job.report.vertices = vertices;
    }
    return std::nullopt;
}

std::string terms_text(const Options& options) {
    const Band terms = chosen_terms(options);
    const std::string names =
        terms.first == terms.last ? "term " + std::to_string(terms.first) : "terms " + std::to_string(terms.first) + " to " + std::to_string(terms.last);
    std::string text = std::string(series_name(options.series)) + " series, " + names;
    if (!is_equaliser(options)) return text;
    text += " weighted";
    if (options.series == LCL_SERIES_REPRESENTATION) text += ", " + short_number(options.equaliser.remainder.value_or(1.0)) + " of the remainder";
    return text;
}

/// Constants, and so the place of the model, are in term 0 alone.
void say_place(Job& job) {
    const Options& options = job.options;
    const double weight = is_equaliser(options) ? options.equaliser.weights.front() : chosen_terms(options).first == 0 ? 1.0 : 0.0;
    if (weight == 0.0) job.terminal.say("place", "vectors around the origin: without term 0 a result has no place of its own");
    else if (weight != 1.0) job.terminal.say("place", "the model's, times " + short_number(weight) + ": term 0 alone holds it");
}

}  // namespace

void run_expand(Job& job) {
    DeviceOpening device(job);
    Mesh mesh = read_sound_input(job);
    check_output_format(job, mesh.get());
    note_terms(job);
    Filter filter = open_filter(job, device, std::move(mesh));
    const std::optional<Failure> failure = interpolation_failure(job, filter);
    if (failure && !job.options.keep_going) throw *failure;

    const lcl_expand_options options = expand_options(job);
    double* values = filter.values.data();
    run_passes(job, filter, "expanding", [&] { return lcl_expand(filter.A.get(), values, 0, filter.width(), &options, values, 0); });
    job.terminal.say("expanded", terms_text(job.options));
    say_place(job);
    scatter_values(filter.mesh.get(), filter.channels, values);
    write_output(job, filter.mesh.get());
    if (failure) throw *failure;
}

}  // namespace lcl::cli
