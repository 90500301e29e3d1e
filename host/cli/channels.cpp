// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/channels.h"

#include <algorithm>
#include <cmath>

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

/// 255 or 65535 where all colours of a mesh are whole numbers, else 0. Those from 0 to 1 have fractions, or are no more than 1 where they happen to have none.
double whole_colour_limit(lcl_mesh mesh) {
    std::vector<double> colours(static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    double largest = 0.0;
    for (int index = 0; index < lcl_mesh_property_count(mesh); ++index) {
        if (!lcl_mesh_property_is_colour(mesh, index)) continue;
        check(lcl_mesh_get_property(mesh, index, colours.data()));
        const auto is_whole = [](double colour) { return colour == std::floor(colour) && colour >= 0.0 && colour <= 65535.0; };
        if (!std::all_of(colours.begin(), colours.end(), is_whole)) return 0.0;
        for (const double colour : colours) largest = std::max(largest, colour);
    }
    return largest <= 1.0 ? 0.0 : largest <= 255.0 ? 255.0 : 65535.0;
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

void scatter_values(lcl_mesh mesh, const std::vector<std::string>& channels, const double* values) {
    const auto vertex_count = static_cast<std::size_t>(lcl_mesh_vertex_count(mesh));
    const std::size_t stride = 3 + channels.size();
    std::vector<double> property(channels.empty() ? 0 : vertex_count);
    check(lcl_mesh_set_points(mesh, values, stride));
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) property[vertex] = values[vertex * stride + 3 + channel];
        check(lcl_mesh_set_property(mesh, channels[channel].c_str(), property.data()));
    }
}

std::vector<double> colour_limits(lcl_mesh mesh, const std::vector<std::string>& channels) {
    if (channels.empty()) return {};
    const double limit = whole_colour_limit(mesh);
    std::vector<double> limits;
    for (const std::string& channel : channels) limits.push_back(lcl_mesh_property_is_colour(mesh, property_index(mesh, channel)) ? limit : 0.0);
    return limits;
}

void round_colours(const std::vector<double>& limits, std::size_t vertex_count, double* values) {
    const std::size_t stride = 3 + limits.size();
    for (std::size_t channel = 0; channel < limits.size(); ++channel) {
        if (limits[channel] == 0.0) continue;
        for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
            double& value = values[vertex * stride + 3 + channel];
            value = std::clamp(std::round(value), 0.0, limits[channel]);
        }
    }
}

}  // namespace lcl::cli
