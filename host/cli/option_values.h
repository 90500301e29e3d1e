// SPDX-License-Identifier: BSD-3-Clause
// Texts of the command line as values. What cannot be read throws std::invalid_argument with a sentence that says what was given and what was expected.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lcl::cli {

/// Most of what is counted in terms of a series, m and k.
constexpr int most_terms = 100000;

/// Terms first to last.
struct Band {
    int first = 0, last = 0;
};

/// Weights of the terms 0, 1, .. and of what they leave.
struct Equaliser {
    std::vector<double> weights;
    std::optional<double> remainder;
};

/// Names of frames: `prefix`, the number with `digits` digits at least, `suffix`.
struct FramePattern {
    std::string prefix, suffix;
    int digits = 1;
    std::string name(int frame) const;
};

/// The whole text as a number; nothing where it is none.
std::optional<double> to_number(const std::string& text);
/// The whole text as a whole number from least to most; nothing where it is none.
std::optional<std::int64_t> to_count(const std::string& text, std::int64_t least, std::int64_t most);

/// Whether a file's name ends so, in any case; `ending` in lower case.
bool has_ending(const std::string& path, const std::string& ending);

/// "I:J" with least <= I <= J <= most_terms.
Band parse_band(const std::string& text, int least);
/// "w0,..,wm" or "w0,..,wm:r", finite numbers.
Equaliser parse_equaliser(const std::string& text);
/// "2" or "3,2,1": whole numbers from 0 to most_terms.
std::vector<int> parse_counts(const std::string& text);
/// "0.5" or "0.9,0.5": numbers above 0 and up to 1.
std::vector<double> parse_ratios(const std::string& text);
/// "#rrggbb,..": three numbers from 0 to 1 a colour.
std::vector<double> parse_colours(const std::string& text);
/// "KEY=VALUE", the key not empty.
std::pair<std::string, std::string> parse_setting(const std::string& text);
/// A file's name with exactly one %d, or %0Nd (N from 1 to 9), and no other %.
FramePattern parse_frame_pattern(const std::string& text);

}  // namespace lcl::cli
