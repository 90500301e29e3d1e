// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/point_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string_view>
#include <system_error>

#include "host/io/point_columns.h"
#include "host/io/text_rows.h"

namespace lcl {
namespace {

constexpr std::size_t most_columns = 10;  // that are looked at: x y z intensity r g b nx ny nz

void require_finite(const PointCloud& cloud, const TextRows& rows) {
    const BadRows bad = bad_points(cloud.points);
    if (bad.count > 0) throw BadInput(rows.place(rows.place_of(static_cast<std::size_t>(bad.first[0]))) + "the point" + not_finite_text(bad), {bad.first, {}});
}

bool begins_with_number(std::string_view text) {
    double value;
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    return std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc::invalid_argument;
}

/// How many columns the first line has.
std::size_t column_count(const TextRows& rows) {
    std::vector<std::string_view> cells = rows.first_cells();
    if (cells.size() > 1 && cells.back().empty()) cells.pop_back();  // a separator behind the last
    if (!begins_with_number(cells.front()))
        rows.fail(cells.front().data(),
                  "'" + printable(cells.front()) + "' was found where a coordinate was expected; put # before a header, or read the file as .csv");
    if (cells.size() < 3)
        rows.fail(cells.front().data(), "a point needs three numbers, this line has " + std::to_string(cells.size()) +
                                            (cells.size() == 1 ? "; a file that begins with the number of its points is a .pts file" : ""));
    return cells.size();
}

PointCloud read_rows(const TextRows& rows, FileFormat format) {
    const std::size_t columns = column_count(rows), most = rows.most_rows(columns), width = std::min(columns, most_columns) - 3;
    PointCloud cloud;
    cloud.points.resize(3 * most);
    std::vector<double> further(width * most);
    std::vector<NumberColumn> targets(columns);
    for (std::size_t c = 0; c < 3 + width; ++c) targets[c] = c < 3 ? NumberColumn{&cloud.points[c], 3} : NumberColumn{&further[c - 3], width};
    const bool is_pts = format == FileFormat::pts;
    const std::size_t count = rows.read(targets, !is_pts);
    if (count < most)
        cloud.warnings.push_back(rows.place(rows.place_of(count)) + "the lines from here on are a scanner's range grid, not points; they were left out");
    cloud.points.resize(3 * count);
    further.resize(width * count);
    require_finite(cloud, rows);
    if (width > 0) take_columns(cloud, std::move(further), width, columns, is_pts);
    return cloud;
}

/// The number in the first line of a .pts file.
std::size_t read_count(TextScanner& scan) {
    scan.skip_space();
    const char* const first = scan.at();
    std::int64_t count = -1;
    const bool is_whole = scan.try_integer(count) && (scan.at_end() || scan.is_delimiter(*scan.at()));
    scan.skip_blanks();
    if (!is_whole || count < 0 || !scan.at_line_end()) scan.fail(first, "the first line of a .pts file is the number of its points, and nothing else");
    scan.skip_line();
    return static_cast<std::size_t>(count);
}

// CSV.

std::string plain_name(std::string_view cell) {
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    std::string name(cell);
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return name;
}

/// Names of three columns, and their places.
struct Triple {
    std::array<const char*, 3> names;
    std::array<std::size_t, 3> columns = {};
    std::array<bool, 3> is_there = {};

    void look_for(const std::vector<std::string>& header) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto found = std::find(header.begin(), header.end(), names[i]);
            is_there[i] = found != header.end();
            columns[i] = static_cast<std::size_t>(found - header.begin());
        }
    }
    bool is_whole() const { return is_there[0] && is_there[1] && is_there[2]; }

    /// Room for `count` rows, if the triple is whole.
    std::vector<double> make_room(std::size_t count, std::vector<NumberColumn>& targets) const {
        if (!is_whole()) return {};
        std::vector<double> rows(3 * count);
        for (std::size_t i = 0; i < 3; ++i) targets[columns[i]] = {count > 0 ? rows.data() + i : nullptr, 3};
        return rows;
    }
};

void require_coordinates(const Triple& coordinates, const TextRows& rows, const char* header) {
    for (std::size_t i = 0; i < 3; ++i)
        if (!coordinates.is_there[i]) rows.fail(header, std::string("the header has no column ") + coordinates.names[i] + ": a CSV of points needs x, y and z");
}

void warn_of_unread(const std::vector<std::string>& header, const std::vector<NumberColumn>& targets, PointCloud& cloud) {
    std::string names;
    std::size_t count = 0;
    for (std::size_t c = 0; c < header.size(); ++c) {
        if (targets[c].stride > 0 || header[c].empty()) continue;
        names += (count++ > 0 ? ", '" : "'") + printable(header[c]) + "'";
    }
    if (count > 0) cloud.warnings.push_back((count == 1 ? "the column " : "the columns ") + names + (count == 1 ? " was" : " were") + " left out");
}

}  // namespace

PointCloud read_xyz(const InputBytes& input) {
    TextScanner scan(input, '#');
    scan.skip_space();
    if (scan.remaining() > 1 && scan.at()[0] == '/' && scan.at()[1] == '/') scan.skip_line();
    scan.skip_space();
    TextRows rows(scan, '#');
    return rows.count_lines(input.splitting) > 0 ? read_rows(rows, FileFormat::xyz) : PointCloud();
}

PointCloud read_pts(const InputBytes& input) {
    TextScanner scan(input, '#');
    scan.skip_space();
    const char* const first = scan.at();
    const std::size_t given = read_count(scan);
    scan.skip_space();
    TextRows rows(scan, '#');
    const std::size_t found = rows.count_lines(input.splitting);
    if (found != given)
        scan.fail(first, "the first line says " + std::to_string(given) + (given == 1 ? " point, " : " points, ") + std::to_string(found) +
                             (found == 1 ? " line follows" : " lines follow") + ": correct the number, or the lines");
    return found > 0 ? read_rows(rows, FileFormat::pts) : PointCloud();
}

PointCloud read_csv_points(const InputBytes& input) {
    TextScanner scan(input, 0);
    scan.skip_space();
    TextRows rows(scan, 0);
    std::vector<std::string> header;
    for (const std::string_view cell : rows.first_cells()) header.push_back(plain_name(cell));
    Triple coordinates{{"x", "y", "z"}}, normals{{"nx", "ny", "nz"}}, colours{{"red", "green", "blue"}};
    for (Triple* triple : {&coordinates, &normals, &colours}) triple->look_for(header);
    require_coordinates(coordinates, rows, scan.at());

    rows.skip_first();
    rows.count_lines(input.splitting);
    const std::size_t most = rows.most_rows(header.size());
    std::vector<NumberColumn> targets(header.size());
    PointCloud cloud;
    cloud.points = coordinates.make_room(most, targets);
    cloud.normals = normals.make_room(most, targets);
    std::vector<double> colour_rows = colours.make_room(most, targets);
    rows.read(targets, false);
    require_finite(cloud, rows);
    warn_of_unread(header, targets, cloud);
    take_colours(cloud, std::move(colour_rows));
    return cloud;
}

}  // namespace lcl
