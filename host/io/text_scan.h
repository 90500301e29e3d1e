// SPDX-License-Identifier: BSD-3-Clause
// Scanning of text that lies in memory: blanks, words, numbers, line ends, and messages that name the line.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "host/io/format.h"

namespace lcl {

inline bool is_line_break(char c) { return c == '\n' || c == '\r'; }
inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// A piece of a file as it may stand in a message: at most 40 characters, printable ones only.
inline std::string printable(std::string_view text) {
    std::string result(text.substr(0, 40));
    for (char& c : result) c = c >= ' ' && c <= '~' ? c : '?';
    return text.size() > 40 ? result + "..." : result;
}

/// A number that from_chars found too large or too small for a double: infinity or zero, with its sign.
double out_of_range_number(const char* first, const char* last);

/// The position in a text. Lines end with LF, CR LF or CR and are counted only when a message needs the number.
class TextScanner {
public:
    /// `comment`: starts a comment that runs to the end of the line (0: there are none). `joins_lines`: a backslash before a line's end continues the line.
    TextScanner(const InputBytes& input, char comment, bool joins_lines = false)
        : at_(input.data), begin_(input.data), end_(input.data + input.size), name_(input.name), comment_(comment), joins_lines_(joins_lines) {
        skip_byte_order_mark();
    }

    /// Words end at this character too, which is not skipped as blanks are.
    void separate_by(char separator) { separator_ = separator; }

    /// On to another piece of the text. Line numbers count from where it begins; a byte order mark is looked for at the beginning of a text only.
    void move_to_piece(std::string_view piece, bool begins_text) {
        at_ = begin_ = piece.data();
        end_ = at_ + piece.size();
        if (begins_text) skip_byte_order_mark();
    }

    const char* at() const { return at_; }
    const char* end() const { return end_; }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
    bool at_end() const { return at_ == end_; }
    void move_to(const char* place) { at_ = place; }

    /// At the end of the file, of the line, or at a comment.
    bool at_line_end() const { return at_ == end_ || is_line_break(*at_) || (*at_ == comment_ && comment_ != 0); }

    void skip_blanks() {
        while (at_ != end_) {
            if (is_blank(*at_)) ++at_;
            else if (*at_ != '\\' || !skip_joint()) return;
        }
    }

    /// Past a backslash that stands here and the line break after it; false if it does not continue the line.
    bool skip_joint() {
        if (!joins_lines_ || end_ - at_ < 2 || !is_line_break(at_[1])) return false;
        ++at_;
        skip_line_break();
        return true;
    }

    /// Past the end of this line, whatever is left in it.
    void skip_line() {
        while (at_ != end_ && !is_line_break(*at_)) {
            if (*at_ == '\\' && skip_joint()) continue;
            ++at_;
        }
        skip_line_break();
    }

    /// Past blanks, comments and line ends.
    void skip_space() {
        for (skip_blanks(); at_ != end_ && at_line_end(); skip_blanks()) skip_line();
    }

    /// The characters up to the next blank or line end; at least one, unless the line ends here.
    std::string_view word() {
        const char* first = at_;
        if (!at_line_end()) ++at_;
        while (at_ != end_ && !is_delimiter(*at_)) ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }

    /// The number that stands here; `what` says what it is for.
    double number(const char* what) {
        const char* first = at_;
        double value;
        const bool plus = at_ != end_ && *at_ == '+' && end_ - at_ > 1 && at_[1] != '-' && at_[1] != '+';
        const std::from_chars_result result = std::from_chars(at_ + plus, end_, value);
        if (result.ec == std::errc::invalid_argument || (result.ptr != end_ && !is_delimiter(*result.ptr))) fail_number(first, what);
        if (result.ec == std::errc::result_out_of_range) value = out_of_range_number(first, result.ptr);
        at_ = result.ptr;
        return value;
    }

    /// The whole number that stands here and what ends it is left to the caller; false if there is none or it does not fit.
    template <class Integer>
    bool try_integer(Integer& value) {
        const bool plus = at_ != end_ && *at_ == '+';
        const std::from_chars_result result = std::from_chars(at_ + plus, end_, value);
        if (result.ec != std::errc()) return false;
        at_ = result.ptr;
        return true;
    }

    /// The number of one to nine digits that stands here as a word of its own, as most indices are; false, and nothing done, if there is something else.
    bool take_short_number(Index& value) {
        const char* at = at_;
        Index digits = 0;
        for (; at != end_ && *at >= '0' && *at <= '9' && at - at_ < 9; ++at) digits = 10 * digits + (*at - '0');
        if (at == at_ || at == end_ || !is_delimiter(*at)) return false;
        value = digits;
        at_ = at;
        return true;
    }

    /// The whole number that stands here as a word of its own.
    std::int64_t integer(const char* what) {
        if (Index short_value; take_short_number(short_value)) return short_value;
        const char* first = at_;
        std::int64_t value;
        if (!try_integer(value) || (at_ != end_ && !is_delimiter(*at_))) fail_number(first, what);
        return value;
    }

    /// The same, as an index of the mesh.
    Index index(const char* what) {
        const char* first = at_;
        const std::int64_t value = integer(what);
        if (value < std::numeric_limits<Index>::min() || value > std::numeric_limits<Index>::max())
            fail(first, std::to_string(value) + " is too large for " + what + "; the most is 2147483647");
        return static_cast<Index>(value);
    }

    /// "name:12: " before a sentence about `place`.
    std::string place(const char* place) const { return name_ + ":" + std::to_string(line_of(place)) + ": "; }

    [[noreturn]] void fail(const char* where, const std::string& sentence) const { throw BadInput(place(where) + sentence); }

    [[noreturn]] void fail_number(const char* first, const char* what) {
        at_ = first;
        if (at_line_end()) fail(first, std::string(at_ == end_ ? "the file" : "the line") + " ends where " + what + " was expected");
        while (at_ != end_ && !is_delimiter(*at_)) ++at_;
        at_ += at_ == first && at_ != end_;
        fail(first, "'" + printable({first, static_cast<std::size_t>(at_ - first)}) + "' was found where " + what + " was expected");
    }

    bool is_delimiter(char c) const {
        return is_blank(c) || is_line_break(c) || (c == comment_ && c != 0) || (c == separator_ && c != 0) || (c == '\\' && joins_lines_);
    }

private:
    void skip_byte_order_mark() {
        if (remaining() >= 3 && std::string_view(at_, 3) == "\xEF\xBB\xBF") at_ += 3;
    }

    void skip_line_break() {
        if (at_ == end_) return;
        const bool is_pair = *at_ == '\r' && end_ - at_ > 1 && at_[1] == '\n';
        at_ += is_pair ? 2 : 1;
    }

    std::size_t line_of(const char* place) const {
        std::size_t line = 1;
        for (const char* c = begin_; c < place; ++c) line += *c == '\n' || (*c == '\r' && (c + 1 == end_ || c[1] != '\n'));
        return line;
    }

    const char* at_;
    const char* begin_;
    const char* end_;
    const std::string& name_;
    char comment_;
    char separator_ = 0;
    bool joins_lines_;
};

}  // namespace lcl
