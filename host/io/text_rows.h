// SPDX-License-Identifier: BSD-3-Clause
// A text as rows of numbers, a line each, read in parts at once.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/io/line_pieces.h"
#include "host/io/text_scan.h"

namespace lcl {

/// Where the numbers of a column go: row i to first[i * stride]; stride 0: nowhere, and the cells may hold any text.
struct NumberColumn {
    double* first = nullptr;
    std::size_t stride = 0;
};

/// Rows of cells from where a scanner stands to the end of the text. Between cells is one of semicolon, comma, blanks: the first of them that the first line
/// has.
class TextRows {
public:
    /// The scanner stands at the first line that is not blank, or at the end. comment: the scanner's.
    TextRows(const TextScanner& scan, char comment);

    /// The cells of that line, without the blanks around them.
    std::vector<std::string_view> first_cells() const;
    /// Begins behind that line.
    void skip_first();

    /// Counts the lines. BadInput if they are more than can be numbered.
    std::size_t count_lines(const Splitting& splitting);
    /// The most rows of so many columns that the text can hold: where it has more lines, one of the first so many is not such a row.
    std::size_t most_rows(std::size_t columns) const;

    /// Reads all rows, after count_lines, to columns that have room for most_rows. BadInput names the first line that is wrong. Returns the number of rows:
    /// that of the lines, or fewer where a range grid may follow, and does.
    std::size_t read(const std::vector<NumberColumn>& columns, bool grid_may_follow) const;

    /// The line of a row.
    const char* place_of(std::size_t row) const;
    /// "name:12: " before a sentence about a place.
    std::string place(const char* place) const { return scan_.place(place); }
    [[noreturn]] void fail(const char* place, const std::string& sentence) const { scan_.fail(place, sentence); }

private:
    struct Stop {
        std::size_t row;
        const char* place;
    };

    bool take_separator(TextScanner& row) const;
    void skip_cell(TextScanner& row) const;
    std::size_t count_cells(const char* place) const;
    bool read_row(TextScanner& row, const std::vector<NumberColumn>& columns, std::size_t index) const;
    std::optional<Stop> read_part(const std::vector<NumberColumn>& columns, std::size_t first, std::size_t last, const char* begin) const;
    std::optional<Stop> read_parts(const std::vector<NumberColumn>& columns) const;
    bool is_range_grid(const Stop& stop) const;
    [[noreturn]] void refuse(const std::vector<NumberColumn>& columns, const Stop& stop) const;

    TextScanner scan_;
    char comment_, separator_;
    std::vector<LineCut> cuts_;
};

}  // namespace lcl
