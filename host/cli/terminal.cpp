// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/terminal.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

bool is_terminal(int descriptor) {
    const char* kind = std::getenv("TERM");
    return isatty(descriptor) && (kind == nullptr || std::string(kind) != "dumb");
}

bool wants_colour(const std::string& mode, int descriptor) {
    if (mode != "auto") return mode == "always";
    const char* no_colour = std::getenv("NO_COLOR");  // no-color.org: set and not empty
    return is_terminal(descriptor) && (no_colour == nullptr || *no_colour == '\0');
}

}  // namespace

Terminal::Terminal(const Options& options)
    : quiet_(options.quiet),
      colour_error_(wants_colour(options.color, STDERR_FILENO)),
      colour_result_(wants_colour(options.color, STDOUT_FILENO)),
      progress_(!options.quiet && !options.no_progress && is_terminal(STDERR_FILENO)) {}

void Terminal::say(const std::string& label, const std::string& text) {
    if (quiet_) return;
    std::string padded = label;
    padded.resize(std::max<std::size_t>(padded.size() + 1, 10), ' ');
    progress_.print(paint(padded, Colour::bold, colour_error_) + one_line(text) + "\n");
}

void Terminal::warn(const std::string& text) {
    if (!quiet_) progress_.print(paint("limitcl: warning:", Colour::yellow, colour_error_) + " " + one_line(text) + "\n");
}

void Terminal::error(const std::string& text) {
    progress_.end();
    progress_.print(paint("limitcl: error:", Colour::red, colour_error_) + " " + one_line(text) + "\n");
}

void Terminal::log(const std::string& text) {
    if (!quiet_) progress_.print("limitcl: " + one_line(text) + "\n");
}

void Terminal::result(const std::string& text) const {
    if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) fail(exit_error, "standard output cannot be written");
}

std::string Terminal::paint(const std::string& text, Colour colour, bool on) {
    if (!on || colour == Colour::none) return text;
    const char* code = colour == Colour::green ? "32" : colour == Colour::yellow ? "33" : colour == Colour::red ? "31" : "1";
    return std::string("\033[") + code + "m" + text + "\033[0m";
}

std::string table_text(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t column = 0; column < row.size(); ++column) widths[column] = std::max(widths[column], row[column].size());
    }
    std::string text;
    for (const auto& row : rows) {
        for (std::size_t column = 0; column < row.size(); ++column) {
            const std::size_t blanks = column + 1 < row.size() ? widths[column] - row[column].size() + 2 : 0;
            text += row[column] + std::string(blanks, ' ');
        }
        text += "\n";
    }
    return text;
}

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string length_text(double length, double diagonal) {
    return short_number(length) + (diagonal > 0.0 ? " (" + short_number(length / diagonal) + " of the diagonal)" : "");
}

std::string counted(long long count, const char* one, const char* many) { return std::to_string(count) + " " + (count == 1 ? one : many); }

std::string byte_text(unsigned long long bytes) {
    char text[32];
    const double mebibytes = static_cast<double>(bytes) / 1048576.0;
    if (mebibytes >= 1024.0) std::snprintf(text, sizeof text, "%.1f GiB", mebibytes / 1024.0);
    else std::snprintf(text, sizeof text, "%.0f MiB", mebibytes);
    return text;
}

std::string join(const std::vector<std::string>& parts, const std::string& between) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
    return text;
}

}  // namespace lcl::cli
