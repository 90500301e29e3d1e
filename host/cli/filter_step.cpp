// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/filter_step.h"

#include "host/cli/channels.h"
#include "host/cli/csv.h"
#include "host/cli/interrupt.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"

namespace lcl::cli {

namespace {

std::vector<std::int32_t> read_pinned(Job& job, lcl_mesh mesh) {
    if (job.options.pin_file.empty()) return {};
    std::vector<std::int32_t> pinned = read_vertex_list(job.options.pin_file, lcl_mesh_vertex_count(mesh));
    job.report.set_parameter("pinned", static_cast<std::int64_t>(pinned.size()));
    return pinned;
}

/// All vertices but the pinned ones.
std::vector<std::int32_t> free_vertices(lcl_mesh mesh, const std::vector<std::int32_t>& pinned) {
    std::vector<char> stays(static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)), 0);
    for (const std::int32_t vertex : pinned) stays[static_cast<std::size_t>(vertex)] = 1;
    std::vector<std::int32_t> free;
    for (std::size_t vertex = 0; vertex < stays.size(); ++vertex) {
        if (!stays[vertex]) free.push_back(static_cast<std::int32_t>(vertex));
    }
    return free;
}

/// For the options of both kinds of operators. No pins: no subset; all pinned: a subset of none, which is not a null one.
template <typename WithSubset>
void set_subset(WithSubset& options, const std::vector<std::int32_t>& free, bool any_pinned) {
    static constexpr std::int32_t none = 0;
    if (!any_pinned) return;
    options.subset = free.empty() ? &none : free.data();
    options.subset_count = free.size();
}

Operator limit_operator(Job& job, DeviceOpening& device, Filter& filter, SchemeChoice& scheme) {
    const std::vector<std::int32_t> free = free_vertices(filter.mesh.get(), filter.pinned);
    set_subset(scheme.options, free, !filter.pinned.empty());
    filter.context = device.finish();
    Operator A = make_operator(job, filter.context.get(), filter.mesh.get(), scheme.options);
    note_scheme_in_use(job, A.get());
    say_scheme(job);
    return A;
}

/// It belongs to no scheme, so the report names none.
Operator feature_operator(Job& job, DeviceOpening& device, Filter& filter) {
    job.report.scheme.clear();
    const std::vector<std::int32_t> free = free_vertices(filter.mesh.get(), filter.pinned);
    lcl_feature_options options = LCL_FEATURE_OPTIONS_INIT;
    set_subset(options, free, !filter.pinned.empty());
    filter.context = device.finish();
    const Phase phase(job, &Seconds::topology, "building the feature-preserving operator", filter.context.get());
    lcl_operator handle = nullptr;
    check_of_input(job, lcl_operator_create_features(filter.context.get(), filter.mesh.get(), &options, &handle));
    job.terminal.say("operator", "feature-preserving");
    return Operator(handle);
}

}  // namespace

Filter open_filter(Job& job, DeviceOpening& device, Mesh mesh) {
    Filter filter;
    filter.mesh = std::move(mesh);
    job.report.set_parameter("precision", std::string(precision_name(job.options.precision)));
    filter.pinned = read_pinned(job, filter.mesh.get());
    filter.channels = choose_channels(job, filter.mesh.get());
    if (job.options.feature_operator) {
        filter.A = feature_operator(job, device, filter);
    } else {
        SchemeChoice scheme = choose_scheme(job, filter.mesh.get());
        filter.A = limit_operator(job, device, filter, scheme);
    }
    filter.values = gather_values(filter.mesh.get(), filter.channels);
    filter.colour_limits = colour_limits(filter.mesh.get(), filter.channels);
    return filter;
}

std::int32_t on_pass(void* user, std::int64_t done, std::int64_t all) {
    const double fraction = all > 0 ? static_cast<double>(done) / static_cast<double>(all) : -1.0;
    static_cast<Progress*>(user)->update(fraction, "pass " + std::to_string(done) + " of " + std::to_string(all));
    return interrupted() ? 0 : 1;
}

}  // namespace lcl::cli
