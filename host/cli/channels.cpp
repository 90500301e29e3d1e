// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/channels.h"

#include <algorithm>

#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

std::vector<std::string> split_names(const std::string& list) {
    std::vector<std::string> names;
    std::size_t first = 0;
    for (;;) {
        const std::size_t comma = std::min(list.find(',', first), list.size());
        names.push_back(list.substr(first, comma - first));
        if (comma == list.size()) return names;
        first = comma + 1;
    }
}

std::vector<std::string> colour_channels(lcl_mesh mesh) {
    std::vector<std::string> names;
    for (int index = 0; index < lcl_mesh_property_count(mesh); ++index) {
        if (lcl_mesh_property_is_colour(mesh, index)) names.push_back(lcl_mesh_property_name(mesh, index));
    }
    return names;
}

std::vector<std::string> named_channels(const Job& job, lcl_mesh mesh) {
    const std::vector<std::string> there = all_channels(mesh);
    std::vector<std::string> names;
    for (const std::string& name : split_names(job.options.channels)) {
        if (std::find(there.begin(), there.end(), name) == there.end())
            fail(exit_usage,
                 "--channels: " + shown_input(job.options) + " has no per-vertex data '" + name + "'; it has " + (there.empty() ? "none" : join(there, ", ")));
        if (std::find(names.begin(), names.end(), name) != names.end()) fail(exit_usage, "--channels names '" + name + "' twice");
        names.push_back(name);
    }
    return names;
}

int property_index(lcl_mesh mesh, const std::string& name) {
    int index = 0;
    while (lcl_mesh_property_name(mesh, index) != name) ++index;
    return index;
}

}  // namespace

std::vector<std::string> all_channels(lcl_mesh mesh) {
    std::vector<std::string> names;
    for (int index = 0; index < lcl_mesh_property_count(mesh); ++index) names.push_back(lcl_mesh_property_name(mesh, index));
    return names;
}

std::vector<std::string> choose_channels(Job& job, lcl_mesh mesh) {
    const std::string& choice = job.options.channels;
    if (choice == "none") return {};
    std::vector<std::string> names = choice == "all" ? all_channels(mesh) : choice == "colours" ? colour_channels(mesh) : named_channels(job, mesh);
    if (names.empty()) warn(job, "--channels " + choice + ": " + shown_input(job.options) + " has none");
    job.report.set_parameter("channels", names);
    return names;
}

std::vector<double> gather_values(lcl_mesh mesh, const std::vector<std::string>& channels) {
    const auto vertex_count = static_cast<std::size_t>(lcl_mesh_vertex_count(mesh));
    const std::size_t stride = 3 + channels.size();
    std::vector<double> values(vertex_count * stride), property(channels.empty() ? 0 : vertex_count);
    check(lcl_mesh_get_points(mesh, values.data(), stride));
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        check(lcl_mesh_get_property(mesh, property_index(mesh, channels[channel]), property.data()));
        for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) values[vertex * stride + 3 + channel] = property[vertex];
    }
    return values;
}

void scatter_values(lcl_mesh mesh, const std::vector<std::string>& channels, const std::vector<double>& values) {
    const auto vertex_count = static_cast<std::size_t>(lcl_mesh_vertex_count(mesh));
    const std::size_t stride = 3 + channels.size();
    std::vector<double> property(channels.empty() ? 0 : vertex_count);
    check(lcl_mesh_set_points(mesh, values.data(), stride));
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) property[vertex] = values[vertex * stride + 3 + channel];
        check(lcl_mesh_set_property(mesh, channels[channel].c_str(), property.data()));
    }
}

}  // namespace lcl::cli
