// SPDX-License-Identifier: BSD-3-Clause
// What every engine needs around the library that does its work: options as a table, failures as sentences, and a way to stop in the middle.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <limitcl/limitcl_engine.h>

namespace limitcl_engine {

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// zero_or_whole: 0 turns the option off or leaves the choice to the engine, and is outside the range.
enum class Kind { number, whole, zero_or_whole, list };

struct Option {
    const char* key;
    const char* value;  ///< the default, as people would write it
    Kind kind;
    double least, most;  ///< of its numbers
    const char* text;    ///< what it does
};

/// Ends a run with this status (LCL_ENGINE_*) and sentence.
struct Failure {
    std::int32_t status;
    std::string sentence;
};

struct Cancelled {};

inline std::string number_text(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

/// "a number from 0 to 1"
inline std::string range_text(const Option& option) {
    std::string text = "a number";
    if (option.kind == Kind::whole) text = "a whole number";
    if (option.kind == Kind::zero_or_whole) text = "0 or a whole number";
    if (option.kind == Kind::list) text = "numbers with commas between, each";
    const std::string least = number_text(option.least);
    return text + (option.most == no_limit ? ", " + least + " or more" : " from " + least + " to " + number_text(option.most));
}

inline bool is_in_range(const Option& option, double value) {
    if (option.kind == Kind::zero_or_whole && value == 0.0) return true;
    if ((option.kind == Kind::whole || option.kind == Kind::zero_or_whole) && value != std::floor(value)) return false;
    return value >= option.least && value <= option.most;
}

/// The options by their keys: defaults, then what was given.
class Options {
public:
    /// Throws Failure where a key is not in the table or a value is not in its range.
    template <std::size_t Count>
    Options(const Option (&table)[Count], const lcl_engine_option* given, std::size_t given_count) : table_(table), count_(Count) {
        for (const Option& option : table) values_.push_back(parse(option, option.value));
        for (const lcl_engine_option* pair = given; pair != given + given_count; ++pair) {
            const std::size_t index = find(pair->key);
            values_[index] = parse(table_[index], pair->value);
        }
    }

    const std::vector<double>& list(const char* key) const { return values_[find(key)]; }
    double number(const char* key) const { return list(key).front(); }
    int whole(const char* key) const { return static_cast<int>(number(key)); }

private:
    std::size_t find(const char* key) const {
        std::string all;
        for (std::size_t index = 0; index < count_; ++index) {
            if (std::strcmp(table_[index].key, key) == 0) return index;
            all += (all.empty() ? "" : ", ") + std::string(table_[index].key);
        }
        throw Failure{LCL_ENGINE_OPTION, "the engine has no option '" + std::string(key) + "'; its options are " + all};
    }

    static std::vector<double> parse(const Option& option, const char* text) {
        std::vector<double> values;
        const char* end = text + std::strlen(text);
        bool good = true;
        for (const char* at = text; good; ++at) {
            double value = 0.0;
            const auto [rest, error] = std::from_chars(at, end, value);
            good = error == std::errc() && is_in_range(option, value);
            values.push_back(value);
            at = rest;
            if (at == end) break;
            good = good && *at == ',' && option.kind == Kind::list;
        }
        if (!good) throw Failure{LCL_ENGINE_OPTION, "the engine's option " + std::string(option.key) + "=" + text + ": it takes " + range_text(option)};
        return values;
    }

    const Option* table_;
    std::size_t count_;
    std::vector<std::vector<double>> values_;
};

/// The table as lcl_engine::options has it.
template <std::size_t Count>
std::string options_text(const Option (&table)[Count]) {
    std::string text;
    for (const Option& option : table) {
        text += (text.empty() ? "" : "\n") + std::string(option.key) + "=" + option.value + "  " + option.text + "; " + range_text(option);
    }
    return text;
}

/// Positions with the cloud's middle in the origin and a spacing of about one: the libraries compare with constants of their own, and some count in floats.
struct Frame {
    std::array<double, 3> middle;
    double scale;  ///< a power of two

    explicit Frame(const lcl_engine_points& cloud) {
        std::array<double, 3> low, high;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = high[axis] = cloud.points[axis];
            for (std::int64_t i = 1; i < cloud.count; ++i) {
                low[axis] = std::min(low[axis], cloud.points[3 * i + axis]);
                high[axis] = std::max(high[axis], cloud.points[3 * i + axis]);
            }
            middle[axis] = low[axis] / 2 + high[axis] / 2;
        }
        const double diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
        scale = std::exp2(std::round(std::log2(std::sqrt(cloud.count) / diagonal)));
    }

    double to(double value, int axis) const { return (value - middle[axis]) * scale; }
    double from(double value, int axis) const { return value / scale + middle[axis]; }
};

using Triangle = std::array<std::int32_t, 3>;

/// One run of an engine. What it gives has at least one triangle.
class Call {
public:
    Call(const lcl_engine_points& in, const Options& values, const lcl_engine_sink& out) : points(in), options(values), sink_(out) {}

    const lcl_engine_points& points;
    const Options& options;

    /// Throws Cancelled where the caller wants no more.
    void progress(double fraction) const {
        if (!sink_.progress(sink_.self, fraction)) throw Cancelled();
    }
    void give(const std::vector<double>& vertices, const std::vector<Triangle>& triangles) const {
        give(vertices.data(), static_cast<std::int32_t>(vertices.size() / 3), triangles);
    }
    /// Triangles between the points that came in.
    void give(const std::vector<Triangle>& triangles) const { give(nullptr, points.count, triangles); }
    void leave_out(const std::vector<std::int32_t>& indices) const {
        if (!indices.empty()) sink_.leave_out(sink_.self, static_cast<std::int32_t>(indices.size()), indices.data());
    }

private:
    const lcl_engine_sink& sink_;

    void give(const double* vertices, std::int32_t vertex_count, const std::vector<Triangle>& triangles) const {
        sink_.give(sink_.self, vertex_count, vertices, static_cast<std::int32_t>(triangles.size()), triangles.front().data());
    }
};

/// The text of a library's exception as part of a sentence: its first line, without the colours of terminals.
inline std::string plain_text(const char* text) {
    std::string plain;
    for (; *text && *text != '\n'; ++text) {
        if (*text == '\033') text += std::strcspn(text, "m\n");
        else plain += *text;
        if (!*text) break;
    }
    return plain;
}

/// The outermost function of an engine: `run` does the work on a Call, and what it throws becomes a status with a sentence.
template <std::size_t Count, typename Run>
std::int32_t run_engine(const lcl_engine_points& points, const Option (&table)[Count], const lcl_engine_option* given, std::size_t given_count,
                        const lcl_engine_sink& sink, Run run) {
    const auto fail = [&](std::int32_t status, const std::string& sentence) {
        sink.fail(sink.self, sentence.c_str());
        return status;
    };
    try {
        const Options options(table, given, given_count);
        run(Call(points, options, sink));
        return LCL_ENGINE_OK;
    } catch (const Cancelled&) {
        return LCL_ENGINE_CANCELLED;
    } catch (const Failure& failure) {
        return fail(failure.status, failure.sentence);
    } catch (const std::bad_alloc&) {
        return fail(LCL_ENGINE_MEMORY, std::to_string(points.count) + " points are too many for this engine on this machine's memory: take fewer");
    } catch (const std::exception& error) {
        return fail(LCL_ENGINE_FAILED, "the engine's library failed: " + plain_text(error.what()));
    } catch (...) {
        return fail(LCL_ENGINE_FAILED, "the engine's library failed and did not say why");
    }
}

}  // namespace limitcl_engine
