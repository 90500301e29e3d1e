// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/csv.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <unistd.h>

#include "host/cli/failure.h"
#include "host/cli/text_lines.h"

namespace lcl::cli {

namespace {

std::int32_t to_vertex(const std::string& path, int line, std::string_view word, std::int32_t vertex_count) {
    const std::optional<std::int64_t> vertex = parsed<std::int64_t>(word);
    if (!vertex) fail_at(path, line, "'" + std::string(word) + "' is not a vertex number");
    if (*vertex < 0 || *vertex >= vertex_count)
        fail_at(path, line, "vertex " + std::to_string(*vertex) + " is not there: the mesh has " + std::to_string(vertex_count) + ", counted from 0");
    return static_cast<std::int32_t>(*vertex);
}

void mark_once(const std::string& path, int line, std::int32_t vertex, std::vector<char>& seen) {
    char& mark = seen[static_cast<std::size_t>(vertex)];
    if (mark) fail_at(path, line, "vertex " + std::to_string(vertex) + " is listed twice: keep one of the lines");
    mark = 1;
}

void check_header(const std::string& path, std::string_view line, int number, const std::string& header) {
    if (cells_of(line) != cells_of(header)) fail_at(path, number, "the header is '" + std::string(trimmed(line)) + "', it must be '" + header + "'");
}

void add_row(Table& table, std::string_view line, int number) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (cells.size() != table.columns)
        fail_at(table.path, number, std::to_string(cells.size()) + " values where the header has " + std::to_string(table.columns));
    for (const std::string_view cell : cells) {
        const std::optional<double> value = parsed<double>(cell);
        if (!value) fail_at(table.path, number, "'" + std::string(cell) + "' is not a number");
        table.values.push_back(*value);
    }
    table.lines.push_back(number);
}

}  // namespace

void fail_at(const std::string& path, int line, const std::string& text) { fail(exit_bad_input, path + ":" + std::to_string(line) + ": " + text); }

Table read_table(const std::string& path, const std::string& header) {
    Table table;
    table.path = path;
    for_each_line(path, [&](std::string_view line, int number) {
        if (table.columns > 0) return add_row(table, line, number);
        check_header(path, line, number, header);
        table.columns = cells_of(header).size();
    });
    if (table.columns == 0) fail_at(path, 1, "the file is empty: it must begin with the header '" + header + "'");
    return table;
}

std::int32_t vertex_of_row(const Table& table, std::size_t row, std::vector<char>& seen) {
    const double value = table.values[row * table.columns];
    const double count = static_cast<double>(seen.size());
    if (!(value >= 0.0 && value < count) || value != static_cast<double>(static_cast<std::int64_t>(value)))
        fail_at(table.path, table.lines[row], "the vertex is not a whole number from 0 to " + std::to_string(static_cast<std::int64_t>(seen.size()) - 1));
    const auto vertex = static_cast<std::int32_t>(value);
    mark_once(table.path, table.lines[row], vertex, seen);
    return vertex;
}

std::vector<std::int32_t> read_vertex_list(const std::string& path, std::int32_t vertex_count) {
    std::vector<std::int32_t> vertices;
    std::vector<char> seen(static_cast<std::size_t>(vertex_count), 0);
    for_each_line(path, [&](std::string_view line, int number) {
        const std::vector<std::string_view> words = words_of(line);
        if (words.size() != 1) fail_at(path, number, "one vertex number a line is expected, here are " + std::to_string(words.size()) + " words");
        vertices.push_back(to_vertex(path, number, words[0], vertex_count));
        mark_once(path, number, vertices.back(), seen);
    });
    if (vertices.empty()) fail_at(path, 1, "the file lists no vertex: one number a line is expected");
    return vertices;
}

PairList read_pair_list(const std::string& path, std::int32_t vertex_count) {
    PairList list;
    for_each_line(path, [&](std::string_view line, int number) {
        const std::vector<std::string_view> words = words_of(line);
        if (words.size() != 2) fail_at(path, number, "two vertex numbers a line are expected, here are " + std::to_string(words.size()) + " words");
        list.pairs.push_back({to_vertex(path, number, words[0], vertex_count), to_vertex(path, number, words[1], vertex_count)});
        list.lines.push_back(number);
    });
    return list;
}

void append_number(std::string& text, double value) {
    if (std::isnan(value)) {
        text += "nan";
        return;
    }
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    text.append(digits, error == std::errc() ? static_cast<std::size_t>(end - digits) : 0);
}

void append_cell(std::string& text, double value) {
    text += ",";
    append_number(text, value);
}

OutputFile::OutputFile(const std::string& path) : path_(path), temporary_(path + "." + std::to_string(getpid()) + ".part") {
    file_ = std::fopen(temporary_.c_str(), "wb");
    if (file_ == nullptr) fail_to_write();
}

OutputFile::~OutputFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove(temporary_.c_str());
}

void OutputFile::fail_to_write() const { fail(exit_error, path_ + ": cannot be written: " + std::strerror(errno)); }

void OutputFile::write(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail_to_write();
}

void OutputFile::finish() {
    if (std::fflush(file_) != 0) fail_to_write();
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail_to_write();
    std::fclose(file_);
    file_ = nullptr;
}

}  // namespace lcl::cli
