// SPDX-License-Identifier: BSD-3-Clause
// Text for people: summaries, warnings and failures on standard error; the tables of devices, selftest and info on standard output.
#pragma once

#include <string>
#include <vector>

#include "host/cli/options.h"
#include "host/cli/progress.h"

namespace lcl::cli {

enum class Colour { none, green, yellow, red, bold };

class Terminal {
public:
    explicit Terminal(const Options& options);

    /// A line of the summary, "label  text"; silent under --quiet.
    void say(const std::string& label, const std::string& text);
    void warn(const std::string& text);
    /// The one line of a failure; never silent.
    void error(const std::string& text);
    /// A message of the library's log (-v).
    void log(const std::string& text);

    /// Standard output. Colours fall away where it is no terminal.
    void result(const std::string& text) const;
    std::string coloured(const std::string& text, Colour colour) const { return paint(text, colour, colour_result_); }
    bool is_quiet() const { return quiet_; }
    Progress& progress() { return progress_; }

private:
    static std::string paint(const std::string& text, Colour colour, bool on);
    bool quiet_, colour_error_, colour_result_;
    Progress progress_;
};

/// Rows of cells as aligned columns, two blanks between, one row a line.
std::string table_text(const std::vector<std::vector<std::string>>& rows);

/// A number with four significant digits at most: 0.0123, 4.568e-09.
std::string short_number(double value);
/// "0.0041 (0.012 of the diagonal)".
std::string length_text(double length, double diagonal);
/// "1 vertex", "2 vertices".
std::string counted(long long count, const char* one, const char* many);
/// 17179869184 -> "16.0 GiB".
std::string byte_text(unsigned long long bytes);
/// The parts with `between` between them.
std::string join(const std::vector<std::string>& parts, const std::string& between);

}  // namespace lcl::cli
