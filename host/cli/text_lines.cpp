// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/text_lines.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include <zlib.h>

#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

struct CloseFile {
    void operator()(gzFile file) const { gzclose(file); }
};
using TextFile = std::unique_ptr<gzFile_s, CloseFile>;

/// Appends what comes next; false at the end. zlib gives files that are not compressed as they are.
bool read_more(const std::string& path, gzFile file, std::string& text) {
    constexpr unsigned piece = 1 << 16;
    const std::size_t before = text.size();
    text.resize(before + piece);
    const int count = gzread(file, &text[before], piece);
    int error = Z_OK;
    gzerror(file, &error);
    if (count < 0 || (error != Z_OK && error != Z_STREAM_END)) fail(exit_bad_input, path + ": cannot be read: the file is damaged or ends too early");
    text.resize(before + static_cast<std::size_t>(count));
    return count > 0;
}

}  // namespace

void for_each_line(const std::string& path, const std::function<void(std::string_view, int)>& use) {
    const TextFile file(gzopen(path.c_str(), "rb"));
    if (!file || std::filesystem::is_directory(path)) fail(exit_bad_input, path + ": cannot be opened: check the name");
    int number = 0;
    const auto take = [&](std::string_view line) {
        ++number;
        if (!trimmed(line).empty()) use(line, number);
    };
    std::string text;
    while (read_more(path, file.get(), text)) {
        std::size_t begin = 0;
        for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) take(std::string_view(text).substr(begin, end - begin));
        text.erase(0, begin);
    }
    if (!text.empty()) take(text);
}

std::string_view trimmed(std::string_view text) {
    const char* blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
        const std::size_t length = std::min(line.find_first_of(" \t"), line.size());
        words.push_back(line.substr(0, length));
        line.remove_prefix(length);
    }
    return words;
}

}  // namespace lcl::cli
