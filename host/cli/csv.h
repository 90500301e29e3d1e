// SPDX-License-Identifier: BSD-3-Clause
// Small text files beside a mesh: lists of vertices, pairs, and CSV tables. Errors are Failures with exit code 3 that name the file and the line.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace lcl::cli {

/// A CSV: `columns` values a row, and the line that each row stands on (from 1).
struct Table {
    std::string path;
    std::size_t columns = 0;
    std::vector<double> values;
    std::vector<int> lines;
    std::size_t rows() const { return lines.size(); }
};

/// Reads a CSV whose header is exactly `header` (names with commas between); cells are numbers, `nan` where there is none.
Table read_table(const std::string& path, const std::string& header);

/// A cell as a vertex below `vertex_count`; `seen` (vertex_count flags) refuses a vertex that is listed twice.
std::int32_t vertex_of_row(const Table& table, std::size_t row, std::vector<char>& seen);

/// One vertex a line, no header, none twice; at least one.
std::vector<std::int32_t> read_vertex_list(const std::string& path, std::int32_t vertex_count);

/// `v0 v1` a line, and the line that each pair stands on.
struct PairList {
    std::vector<std::array<std::int32_t, 2>> pairs;
    std::vector<int> lines;
};
PairList read_pair_list(const std::string& path, std::int32_t vertex_count);

/// "FILE:LINE: text", exit code 3.
[[noreturn]] void fail_at(const std::string& path, int line, const std::string& text);

/// The shortest text that reads back the same number, `nan` where there is none.
void append_number(std::string& text, double value);
/// The same behind a comma.
void append_cell(std::string& text, double value);

/// A text file that appears completely or not at all: a temporary file in the same folder, then rename. Failures have exit code 1.
class OutputFile {
public:
    explicit OutputFile(const std::string& path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    void write(const std::string& text);
    void finish();

private:
    [[noreturn]] void fail_to_write() const;
    std::string path_, temporary_;
    std::FILE* file_ = nullptr;
};

}  // namespace lcl::cli
