// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/line_pieces.h"

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>
#include <thread>

#include <unistd.h>

#include "host/error.h"
#include "host/parallel.h"

namespace lcl {
namespace {

/// True if a line begins at `place`, of which at least the three bytes before it are known.
bool begins_line(const char* begin, const char* place, const char* end) {
    const char* line_end = place - 1;
    if (*line_end != '\n' && (*line_end != '\r' || (place != end && *place == '\n'))) return false;
    if (*line_end == '\n' && line_end != begin && line_end[-1] == '\r') --line_end;
    return line_end == begin || line_end[-1] != '\\';
}

void read_bytes(const Text& text, std::size_t at, char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t count = ::pread(text.descriptor, bytes, size, static_cast<off_t>(at));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) throw FileError("cannot read " + text.name + ": " + std::generic_category().message(errno));
        if (count == 0) throw FileError("cannot read " + text.name + ": it became shorter while it was read; try again");
        at += static_cast<std::size_t>(count);
        bytes += count;
        size -= static_cast<std::size_t>(count);
    }
}

/// The bytes of a text; those of a file are put into `buffer`, which has room for them.
const char* bytes_of(const Text& text, std::size_t at, std::size_t size, char* buffer) {
    if (text.data) return text.data + at;
    read_bytes(text, at, buffer, size);
    return buffer;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// Lines of LF or CR LF with something in them; nothing if there is a CR that stands alone.
std::optional<std::size_t> count_filled_lines(std::string_view text, char comment) {
    std::size_t count = 0;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        const std::size_t carriage_return = line.find('\r');
        const bool ends_text = line.size() == text.size();
        if (carriage_return != std::string_view::npos && (ends_text || carriage_return + 1 != line.size())) return std::nullopt;
        const auto first = std::find_if_not(line.begin(), line.end(), is_blank);
        count += first != line.end() && *first != '\r' && (comment == 0 || *first != comment);
        text.remove_prefix(line.size() + !ends_text);
    }
    return count;
}

}  // namespace

std::vector<LineCut> count_lines(std::string_view text, char comment, const Splitting& splitting) {
    const std::string no_name;
    const Text memory{text.data(), text.size(), no_name};
    const std::size_t parts = splitting.parts_of(text.size());
    std::vector<std::optional<std::size_t>> counts(parts);
    const auto begin_of = [&](std::size_t part) { return next_line(memory, text.size() / parts * part + text.size() % parts * part / parts); };
    parallel_for(
        parts,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) counts[i] = count_filled_lines(text.substr(begin_of(i), begin_of(i + 1) - begin_of(i)), comment);
        },
        1);
    std::vector<LineCut> cuts;
    std::size_t number = 0;
    for (std::size_t i = 0; i < parts; ++i) {
        if (!counts[i]) return {};
        number += *counts[i];
        cuts.push_back({text.data() + begin_of(i + 1), number});
    }
    return cuts;
}

std::size_t Splitting::parts_of(std::size_t size) const {
    const std::size_t most = most_parts > 0 ? most_parts : std::max(1u, std::thread::hardware_concurrency());
    return std::clamp<std::size_t>(size / smallest_part, 1, most);
}

std::size_t next_line(const Text& text, std::size_t at) {
    if (at == 0) return 0;
    const std::size_t first = at - std::min<std::size_t>(at, 3);
    for (std::size_t window = 4096; at < text.size; window *= 2) {
        const std::size_t size = std::min(window, text.size - first);
        const std::unique_ptr<char[]> buffer(text.data ? nullptr : new char[size]);
        const char* const bytes = bytes_of(text, first, size, buffer.get());
        for (std::size_t place = at - first; place < size; ++place)
            if (begins_line(bytes, bytes + place, bytes + size)) return first + place;
        if (first + size == text.size) break;
    }
    return text.size;
}

std::string_view LinePieces::next() {
    while (at_ != end_) {
        const std::size_t size = text_.data ? end_ - at_ : std::min(capacity_, end_ - at_);
        if (!text_.data && !buffer_) buffer_.reset(new char[capacity_]);
        const char* const bytes = bytes_of(text_, at_, size, buffer_.get());
        const std::size_t length = at_ + size == end_ ? size : whole_lines(bytes, size);
        at_ += length;
        if (length > 0) return {bytes, length};
        buffer_.reset();  // a line longer than the buffer
        capacity_ *= 2;
    }
    return {};
}

/// The length of the lines that end in the bytes. The last byte is no place to look at: what follows it is not known.
std::size_t LinePieces::whole_lines(const char* bytes, std::size_t size) const {
    for (const char* place = bytes + size - 1; place > bytes; --place)
        if (begins_line(bytes, place, bytes + size)) return static_cast<std::size_t>(place - bytes);
    return 0;
}

}  // namespace lcl
