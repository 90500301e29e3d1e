// SPDX-License-Identifier: BSD-3-Clause
// Lines, cells and words of small text files, which may be compressed with gzip.
#pragma once

#include <charconv>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace lcl::cli {

/// Calls use(line, line number from 1) for every line that is not blank. Failure with exit code 3 where the file cannot be read.
void for_each_line(const std::string& path, const std::function<void(std::string_view, int)>& use);

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);
/// What stands between commas, trimmed.
std::vector<std::string_view> cells_of(std::string_view line);
/// What stands between blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// The whole text as a number; nothing where it is none.
template <typename Value>
std::optional<Value> parsed(std::string_view text) {
    Value value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace lcl::cli
