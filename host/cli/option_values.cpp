// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/option_values.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace lcl::cli {

namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& expected) { throw std::invalid_argument("'" + text + "' is not " + expected); }

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (const char character : text) {
        if (character == separator) parts.emplace_back();
        else parts.back() += character;
    }
    return parts;
}

bool is_digit(char character) { return character >= '0' && character <= '9'; }

/// 0 to 15, or -1.
int hexadecimal(char digit) {
    if (is_digit(digit)) return digit - '0';
    if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
    if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
    return -1;
}

void append_colour(std::vector<double>& colours, const std::string& text) {
    const bool good = text.size() == 7 && text[0] == '#' && std::all_of(text.begin() + 1, text.end(), [](char digit) { return hexadecimal(digit) >= 0; });
    if (!good) refuse(text, "a colour #rrggbb");
    for (std::size_t first = 1; first < text.size(); first += 2) colours.push_back((16 * hexadecimal(text[first]) + hexadecimal(text[first + 1])) / 255.0);
}

/// What stands behind the % of a pattern: "d", or "0Nd". Returns where it ends.
std::size_t read_conversion(const std::string& text, std::size_t percent, FramePattern& pattern) {
    std::size_t place = percent + 1;
    if (place + 1 < text.size() && text[place] == '0' && text[place + 1] >= '1' && text[place + 1] <= '9') {
        pattern.digits = text[place + 1] - '0';
        place += 2;
    }
    const bool is_decimal = place < text.size() && text[place] == 'd';
    return is_decimal ? place + 1 : std::string::npos;
}

}  // namespace

std::string FramePattern::name(int frame) const {
    const std::string number = std::to_string(frame);
    const std::size_t zeros = static_cast<std::size_t>(digits) - std::min(number.size(), static_cast<std::size_t>(digits));
    return prefix + std::string(zeros, '0') + number + suffix;
}

std::optional<double> to_number(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<std::int64_t> to_count(const std::string& text, std::int64_t least, std::int64_t most) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) return std::nullopt;
    return value;
}

bool has_ending(const std::string& path, const std::string& ending) {
    if (path.size() < ending.size()) return false;
    const auto same = [](char wanted, char given) { return std::tolower(static_cast<unsigned char>(given)) == wanted; };
    return std::equal(ending.begin(), ending.end(), path.end() - static_cast<std::ptrdiff_t>(ending.size()), same);
}

Band parse_band(const std::string& text, int least) {
    const std::vector<std::string> ends = split(text, ':');
    const std::optional<std::int64_t> first = to_count(ends.front(), least, most_terms), last = to_count(ends.back(), least, most_terms);
    if (ends.size() != 2 || !first || !last || *first > *last)
        refuse(text, "a band I:J of terms with " + std::to_string(least) + " <= I <= J <= " + std::to_string(most_terms));
    return {static_cast<int>(*first), static_cast<int>(*last)};
}

Equaliser parse_equaliser(const std::string& text) {
    const auto number = [&text](const std::string& part) {
        const std::optional<double> value = to_number(part);
        if (!value || !std::isfinite(*value)) refuse(text, "a list of weights w0,..,wm or w0,..,wm:r, '" + part + "' in it is no number");
        return *value;
    };
    const std::vector<std::string> halves = split(text, ':');
    if (halves.size() > 2) refuse(text, "a list of weights w0,..,wm or w0,..,wm:r");
    Equaliser equaliser;
    for (const std::string& part : split(halves.front(), ',')) equaliser.weights.push_back(number(part));
    if (halves.size() == 2) equaliser.remainder = number(halves.back());
    if (equaliser.weights.size() > static_cast<std::size_t>(most_terms))
        throw std::invalid_argument(std::to_string(equaliser.weights.size()) + " weights are more than " + std::to_string(most_terms));
    return equaliser;
}

std::vector<int> parse_counts(const std::string& text) {
    std::vector<int> counts;
    for (const std::string& part : split(text, ',')) {
        const std::optional<std::int64_t> count = to_count(part, 0, most_terms);
        if (!count) refuse(part, "a whole number from 0 to " + std::to_string(most_terms));
        counts.push_back(static_cast<int>(*count));
    }
    return counts;
}

std::vector<double> parse_ratios(const std::string& text) {
    std::vector<double> ratios;
    for (const std::string& part : split(text, ',')) {
        const std::optional<double> ratio = to_number(part);
        if (!ratio || !(*ratio > 0.0 && *ratio <= 1.0)) refuse(part, "a number above 0 and up to 1");
        ratios.push_back(*ratio);
    }
    return ratios;
}

std::vector<double> parse_colours(const std::string& text) {
    std::vector<double> colours;
    for (const std::string& part : split(text, ',')) append_colour(colours, part);
    return colours;
}

std::pair<std::string, std::string> parse_setting(const std::string& text) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos || sign == 0) refuse(text, "of the form KEY=VALUE");
    return {text.substr(0, sign), text.substr(sign + 1)};
}

FramePattern parse_frame_pattern(const std::string& text) {
    FramePattern pattern;
    const std::size_t percent = text.find('%');
    const std::size_t end = percent == std::string::npos ? percent : read_conversion(text, percent, pattern);
    if (end == std::string::npos || text.find('%', end) != std::string::npos)
        refuse(text, "a pattern of names with exactly one %d (or %03d and the like) for the number of the frame, and no other %");
    pattern.prefix = text.substr(0, percent);
    pattern.suffix = text.substr(end);
    return pattern;
}

}  // namespace lcl::cli
