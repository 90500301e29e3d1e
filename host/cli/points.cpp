// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "host/cli/csv.h"
#include "host/cli/failure.h"
#include "host/cli/handles.h"
#include "host/cli/job.h"
#include "host/cli/option_values.h"
#include "host/cli/text_lines.h"

namespace lcl::cli {

namespace {

const std::array<const char*, 6> endings = {".ply", ".xyz", ".csv", ".off", ".obj", ".pts"};

bool ends_so(const std::string& path, const std::string& ending) { return has_ending(path, ending) || has_ending(path, ending + ".gz"); }

double coordinate(const std::string& path, int line, std::string_view text) {
    const std::optional<double> value = parsed<double>(text);
    if (!value) fail_at(path, line, "'" + std::string(text) + "' is not a number");
    if (!std::isfinite(*value)) fail_at(path, line, "the point is not finite: correct it or leave it out");
    return *value;
}

void add_point(const std::string& path, int line, const std::vector<std::string_view>& words, const std::array<std::size_t, 3>& columns,
               std::vector<double>& points) {
    for (const std::size_t column : columns) {
        if (column >= words.size()) fail_at(path, line, "a point needs three numbers, here are " + std::to_string(words.size()));
        points.push_back(coordinate(path, line, words[column]));
    }
}

std::vector<double> read_xyz(const std::string& path, bool has_count) {
    std::vector<double> points;
    std::optional<std::int64_t> count;
    for_each_line(path, [&](std::string_view line, int number) {
        const std::vector<std::string_view> words = words_of(line);
        if (words.front().front() == '#') return;
        if (!has_count || count) return add_point(path, number, words, {0, 1, 2}, points);
        count = words.size() == 1 ? parsed<std::int64_t>(words[0]) : std::nullopt;
        if (!count || *count < 0) fail_at(path, number, "the first line of a .pts file is the number of its points");
    });
    const auto found = static_cast<std::int64_t>(points.size() / 3);
    if (has_count && !count) fail(exit_bad_input, path + ": the file is empty: a .pts file begins with the number of its points");
    if (has_count && found != *count)
        fail(exit_bad_input, path + ": the first line says " + counted(*count, "point", "points") + ", the file has " + std::to_string(found) + ": correct it");
    return points;
}

std::array<std::size_t, 3> columns_of(const std::string& path, int line, const std::vector<std::string_view>& names) {
    std::array<std::size_t, 3> columns{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string name(1, static_cast<char>('x' + axis));
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) fail_at(path, line, "the header has no column " + name + ": a CSV of points needs x, y and z");
        columns[axis] = static_cast<std::size_t>(found - names.begin());
    }
    return columns;
}

std::vector<double> read_csv_points(const std::string& path) {
    std::vector<double> points;
    std::optional<std::array<std::size_t, 3>> columns;
    for_each_line(path, [&](std::string_view line, int number) {
        const std::vector<std::string_view> cells = cells_of(line);
        if (columns) return add_point(path, number, cells, *columns, points);
        columns = columns_of(path, number, cells);
    });
    if (!columns) fail_at(path, 1, "the file is empty: it must begin with a header that has x, y and z");
    return points;
}

std::vector<double> read_mesh_points(const std::string& path) {
    lcl_mesh handle = nullptr;
    check_of_file(path, lcl_mesh_read(path.c_str(), LCL_FORMAT_BY_ENDING, &handle));
    const Mesh mesh(handle);
    std::vector<double> points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh.get())));
    check(lcl_mesh_get_points(mesh.get(), points.data(), 0));
    const auto bad = std::find_if_not(points.begin(), points.end(), [](double value) { return std::isfinite(value); });
    if (bad != points.end())
        fail(exit_bad_input, path + ": point " + std::to_string((bad - points.begin()) / 3) + " is not finite: correct it or leave it out");
    return points;
}

}  // namespace

bool is_points_name(const std::string& path) {
    return std::any_of(endings.begin(), endings.end(), [&path](const char* ending) { return ends_so(path, ending); });
}

std::vector<double> read_points(const std::string& path) {
    if (ends_so(path, ".xyz")) return read_xyz(path, false);
    if (ends_so(path, ".pts")) return read_xyz(path, true);
    return ends_so(path, ".csv") ? read_csv_points(path) : read_mesh_points(path);
}

}  // namespace lcl::cli
