// SPDX-License-Identifier: BSD-3-Clause
// Text by whole lines: where it may be cut, so that its parts can be read at once, and how much of a file has to be in memory for that.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lcl {

/// A text in memory, or in an open file, of which only pieces are brought into memory.
struct Text {
    const char* data = nullptr;  ///< null: in the file
    std::size_t size = 0;
    const std::string& name;  ///< for messages
    int descriptor = -1;
};

/// How a text is shared out: tests make the shares small.
struct Splitting {
    std::size_t smallest_part = std::size_t(1) << 18;  ///< bytes
    std::size_t most_parts = 0;                        ///< that are read at once; 0: one a core
    std::size_t piece = std::size_t(1) << 18;          ///< bytes of a part that lies in a file which are in memory at a time
    std::size_t parts_of(std::size_t size) const;
};

/// The first place at or behind `at` where a line begins; the text's size if there is none. A backslash before a line's end continues the line, as in OBJ:
/// where it does not, there is one place less to cut. FileError if the file cannot be read.
std::size_t next_line(const Text& text, std::size_t at);

/// The lines of a text from one place where a line begins to another, in pieces of whole lines.
class LinePieces {
public:
    LinePieces(const Text& text, std::size_t begin, std::size_t end, std::size_t piece_size) : text_(text), at_(begin), end_(end), capacity_(piece_size) {}

    /// Empty at the end. It holds until the next call. FileError if the file cannot be read.
    std::string_view next();

private:
    std::size_t whole_lines(const char* bytes, std::size_t size) const;

    const Text& text_;
    std::size_t at_, end_, capacity_;
    std::unique_ptr<char[]> buffer_;
};

/// A place where a line begins, and how many lines with something in them come before it.
struct LineCut {
    const char* place;
    std::size_t number;
};

/// Cuts of a text, first to last, its end among them, its beginning not; empty where a CR alone ends lines. Nothing but blanks, or a comment behind them (0:
/// there are none), is no line.
std::vector<LineCut> count_lines(std::string_view text, char comment, const Splitting& splitting);

}  // namespace lcl
