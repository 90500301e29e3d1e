// SPDX-License-Identifier: BSD-3-Clause
// Lines are counted first, so that each row goes to its place and parts of whole lines can be read at once. Where a row cannot be read its part stops; the
// first such row of all is then read again, for the sentence that names its line.
#include "host/io/text_rows.h"

#include <algorithm>
#include <limits>

#include "host/parallel.h"

namespace lcl {
namespace {

constexpr char blanks = ' ';  // cells with blanks between them

char separator_of(const TextScanner& scan, char comment) {
    const auto ends_line = [&](char c) { return is_line_break(c) || (comment != 0 && c == comment); };
    const char* const line_end = std::find_if(scan.at(), scan.end(), ends_line);
    for (const char separator : {';', ','})
        if (std::find(scan.at(), line_end, separator) != line_end) return separator;
    return blanks;
}

}  // namespace

TextRows::TextRows(const TextScanner& scan, char comment) : scan_(scan), comment_(comment), separator_(separator_of(scan, comment)) {
    scan_.separate_by(separator_ == blanks ? '\0' : separator_);
}

std::vector<std::string_view> TextRows::first_cells() const {
    std::vector<std::string_view> cells;
    TextScanner row = scan_;
    do {
        row.skip_blanks();
        const char* const first = row.at();
        skip_cell(row);
        const char* last = row.at();
        while (last != first && is_blank(last[-1])) --last;
        cells.emplace_back(first, static_cast<std::size_t>(last - first));
    } while (take_separator(row));
    return cells;
}

void TextRows::skip_first() {
    scan_.skip_line();
    scan_.skip_space();
}

std::size_t TextRows::count_lines(const Splitting& splitting) {
    cuts_ = lcl::count_lines({scan_.at(), scan_.remaining()}, comment_, splitting);
    if (cuts_.empty()) {  // lines that end with CR
        TextScanner lines = scan_;
        std::size_t count = 0;
        for (lines.skip_space(); !lines.at_end(); lines.skip_space(), ++count) lines.skip_line();
        cuts_ = {{scan_.end(), count}};
    }
    if (cuts_.back().number > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
        scan_.fail(scan_.at(), std::to_string(cuts_.back().number) + " lines follow; 2147483647 is the most that can be numbered");
    return cuts_.back().number;
}

std::size_t TextRows::most_rows(std::size_t columns) const { return std::min(cuts_.back().number, (scan_.remaining() + 1) / columns); }

std::size_t TextRows::read(const std::vector<NumberColumn>& columns, bool grid_may_follow) const {
    const std::optional<Stop> stop = read_parts(columns);
    if (!stop) return cuts_.back().number;
    if (!grid_may_follow || !is_range_grid(*stop)) refuse(columns, *stop);
    return stop->row;
}

const char* TextRows::place_of(std::size_t row) const {
    TextScanner lines = scan_;
    for (lines.skip_space(); row > 0; --row, lines.skip_space()) lines.skip_line();
    return lines.at();
}

/// True where another cell may follow.
bool TextRows::take_separator(TextScanner& row) const {
    row.skip_blanks();
    if (separator_ == blanks) return !row.at_line_end();
    if (row.at_end() || *row.at() != separator_) return false;
    row.move_to(row.at() + 1);
    return true;
}

/// A cell may stand in quotes, with separators in it.
void TextRows::skip_cell(TextScanner& row) const {
    if (!row.at_end() && *row.at() == '"') {
        const char* quote = row.at() + 1;
        while (quote != row.end() && *quote != '"' && !is_line_break(*quote)) ++quote;
        if (quote != row.end() && *quote == '"') row.move_to(quote + 1);
    }
    while (!row.at_line_end() && (separator_ == blanks ? !is_blank(*row.at()) : *row.at() != separator_)) row.move_to(row.at() + 1);
}

std::size_t TextRows::count_cells(const char* place) const {
    TextScanner row = scan_;
    row.move_to(place);
    for (std::size_t count = 1;; ++count) {
        row.skip_blanks();
        skip_cell(row);
        if (!take_separator(row)) return count;
    }
}

/// False if the row does not have the columns of the first.
bool TextRows::read_row(TextScanner& row, const std::vector<NumberColumn>& columns, std::size_t index) const {
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (c > 0 && !take_separator(row)) return false;
        row.skip_blanks();
        if (columns[c].stride > 0) columns[c].first[index * columns[c].stride] = row.number("a number");
        else skip_cell(row);
    }
    take_separator(row);  // one may stand behind the last
    row.skip_blanks();
    return row.at_line_end();
}

/// Where a row of lines `first` to `last` - 1 cannot be read: which.
std::optional<TextRows::Stop> TextRows::read_part(const std::vector<NumberColumn>& columns, std::size_t first, std::size_t last, const char* begin) const {
    TextScanner row = scan_;
    row.move_to(begin);
    const std::size_t most = most_rows(columns.size());
    for (std::size_t i = first; i < last; ++i) {
        row.skip_space();
        const char* const place = row.at();
        try {
            if (i >= most || !read_row(row, columns, i)) return Stop{i, place};
        } catch (const BadInput&) {  // said when it is read again
            return Stop{i, place};
        }
        row.skip_line();
    }
    return std::nullopt;
}

std::optional<TextRows::Stop> TextRows::read_parts(const std::vector<NumberColumn>& columns) const {
    std::vector<std::optional<Stop>> stops(cuts_.size());
    parallel_for(
        cuts_.size(),
        [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                stops[i] =
                    i == 0 ? read_part(columns, 0, cuts_[0].number, scan_.at()) : read_part(columns, cuts_[i - 1].number, cuts_[i].number, cuts_[i - 1].place);
        },
        1);
    const auto first = std::find_if(stops.begin(), stops.end(), [](const std::optional<Stop>& stop) { return stop.has_value(); });
    return first == stops.end() ? std::nullopt : *first;
}

/// The range scans of the Stanford 3D Scanning Repository have, behind the points, a line for each cell of the scanner's grid: "0", or "1 k" for the one that
/// saw point k. Where the header is cut off, that is the only thing behind points that is known not to be one: every line to the end must be of it, and every
/// point in it once, in order.
bool TextRows::is_range_grid(const Stop& stop) const {
    if (stop.row == 0 || separator_ != blanks) return false;
    TextScanner row = scan_;
    row.move_to(stop.place);
    std::size_t seen = 0;
    for (row.skip_space(); !row.at_end(); row.skip_line(), row.skip_space()) {
        std::int64_t count = 0, point = 0;
        if (!row.try_integer(count) || count < 0 || count > 1) return false;
        row.skip_blanks();
        if (count == 1 && (!row.try_integer(point) || point != static_cast<std::int64_t>(seen++))) return false;
        row.skip_blanks();
        if (!row.at_line_end()) return false;
    }
    return seen == stop.row;
}

void TextRows::refuse(const std::vector<NumberColumn>& columns, const Stop& stop) const {
    TextScanner row = scan_;
    row.move_to(stop.place);
    if (stop.row < most_rows(columns.size())) read_row(row, columns, stop.row);  // fails where it is a number that is wrong
    const std::size_t found = count_cells(stop.place);
    if (found != columns.size())
        scan_.fail(stop.place, "mixed columns: this line has " + std::to_string(found) + ", the first one has " + std::to_string(columns.size()) +
                                   "; every line needs the same");
    scan_.fail(stop.place,
               std::string("between some numbers is a '") + separator_ + "', between others none; separate all in one way, and write decimals with a point");
}

}  // namespace lcl
