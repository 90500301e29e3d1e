// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/bar_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "host/cli/terminal.h"

namespace lcl::cli {

namespace {

constexpr double width = 800, height = 450;
constexpr double left = 90, right = width - 20, top = 50, bottom = height - 60;  // of the axes

constexpr const char* style = R"(<style>
text { font: 14px sans-serif; fill: #222222 } .title { font-size: 17px } .back { fill: #ffffff } .bar { fill: #0b5cad }
.axis { stroke: #222222 } .grid { stroke: #dddddd }
@media (prefers-color-scheme: dark) {
text { fill: #dddddd } .back { fill: #1c1c1c } .bar { fill: #6db3f2 } .axis { stroke: #dddddd } .grid { stroke: #444444 }
}
</style>
)";

/// The axis of the values: what is at its ends, and where its ticks are.
struct Axis {
    bool logarithmic = false;
    double low = 0.0, high = 1.0;  ///< values at the ends
    std::vector<double> ticks;
    /// Where a value is, from 0 to 1.
    double place(double value) const {
        const double part = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
        return std::clamp(part, 0.0, 1.0);
    }
};

/// 1, 2 or 5 times a power of ten: about `wanted` of them fit into `range`.
double nice_step(double range, int wanted) {
    const double rough = range / wanted, power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (rough <= factor * power * (1.0 + 1e-9)) return factor * power;
    }
    return 10.0 * power;
}

Axis linear_axis(double largest) {
    Axis axis;
    const double step = nice_step(largest > 0.0 ? largest : 1.0, 5);
    const int count = std::max(1, static_cast<int>(std::ceil((largest > 0.0 ? largest : 1.0) / step * (1.0 - 1e-9))));
    for (int tick = 0; tick <= count; ++tick) axis.ticks.push_back(tick * step);
    axis.high = axis.ticks.back();
    return axis;
}

/// Whole powers of ten, about six of them with a tick, from one below the smallest value on, so that its bar can be seen.
Axis logarithmic_axis(double smallest, double largest) {
    Axis axis;
    axis.logarithmic = true;
    const int first = static_cast<int>(std::ceil(std::log10(smallest))) - 1, last = static_cast<int>(std::ceil(std::log10(largest)));
    const int step = std::max(1, (last - first + 5) / 6);
    for (int power = first; power < last + step; power += step) axis.ticks.push_back(std::pow(10.0, power));
    axis.low = axis.ticks.front();
    axis.high = axis.ticks.back();
    return axis;
}

/// Values that are not above 0 (a flat mesh has such terms) have no place on a logarithmic axis, and no bar.
Axis axis_of(const std::vector<double>& values) {
    double smallest = INFINITY, largest = 0.0;
    for (const double value : values) {
        if (!(value > 0.0) || !std::isfinite(value)) continue;
        smallest = std::min(smallest, value);
        largest = std::max(largest, value);
    }
    return largest > 100.0 * smallest ? logarithmic_axis(std::max(smallest, 1e-300), largest) : linear_axis(largest);
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char character : text) {
        switch (character) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            default: out += static_cast<unsigned char>(character) < 0x20 ? ' ' : character;
        }
    }
    return out;
}

/// A coordinate: tenths of a pixel are enough.
std::string at(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
    return "<line class=\"" + std::string(kind) + "\" x1=\"" + at(x1) + "\" y1=\"" + at(y1) + "\" x2=\"" + at(x2) + "\" y2=\"" + at(y2) + "\"/>\n";
}

std::string label(double x, double y, const std::string& text, const std::string& attributes) {
    return "<text x=\"" + at(x) + "\" y=\"" + at(y) + "\" " + attributes + ">" + escaped(text) + "</text>\n";
}

/// "1e-5"
std::string power_of_ten(double value) { return "1e" + std::to_string(std::lround(std::log10(value))); }

double y_of(const Axis& axis, double value) { return bottom - axis.place(value) * (bottom - top); }

std::string bars(const BarChart& chart, const Axis& axis) {
    const double slot = (right - left) / static_cast<double>(chart.values.size()), gap = std::min(0.1 * slot, 8.0);
    std::string text;
    for (std::size_t index = 0; index < chart.values.size(); ++index) {
        const double value = chart.values[index];
        if (!(value > 0.0)) continue;
        const double x = left + slot * static_cast<double>(index) + gap, y = y_of(axis, value);
        text += "<rect class=\"bar\" x=\"" + at(x) + "\" y=\"" + at(y) + "\" width=\"" + at(std::max(slot - 2.0 * gap, 0.1)) + "\" height=\"" + at(bottom - y) +
                "\"><title>" + std::to_string(index) + ": " + short_number(value) + "</title></rect>\n";
    }
    return text;
}

std::string value_axis(const BarChart& chart, const Axis& axis) {
    std::string text;
    for (const double tick : axis.ticks) {
        const double y = y_of(axis, tick);
        text += line(left, y, right, y, "grid") + line(left - 5, y, left, y, "axis");
        text += label(left - 9, y + 5, axis.logarithmic ? power_of_ten(tick) : short_number(tick), "text-anchor=\"end\"");
    }
    const std::string middle = at((top + bottom) / 2);
    return text + label(22, (top + bottom) / 2, chart.y_label, "text-anchor=\"middle\" transform=\"rotate(-90 22 " + middle + ")\"");
}

/// At most 16 numbers below the bars.
std::string index_axis(const BarChart& chart) {
    const std::size_t count = chart.values.size();
    const auto step = static_cast<std::size_t>(std::max(1.0, nice_step(static_cast<double>(count), 16)));
    const double slot = (right - left) / static_cast<double>(count);
    std::string text;
    for (std::size_t index = 0; index < count; index += step) {
        const double x = left + slot * (static_cast<double>(index) + 0.5);
        text += line(x, bottom, x, bottom + 5, "axis") + label(x, bottom + 20, std::to_string(index), "text-anchor=\"middle\"");
    }
    return text + label((left + right) / 2, height - 15, chart.x_label, "text-anchor=\"middle\"");
}

}  // namespace

std::string to_svg(const BarChart& chart) {
    const Axis axis = axis_of(chart.values);
    const std::string size = "width=\"" + at(width) + "\" height=\"" + at(height) + "\"";
    std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" " + size + " viewBox=\"0 0 " + at(width) + " " + at(height) + "\">\n";
    text += "<title>" + escaped(chart.title) + "</title>\n" + style;
    text += "<rect class=\"back\" " + size + "/>\n";
    text += label((left + right) / 2, 30, chart.title, "class=\"title\" text-anchor=\"middle\"");
    text += value_axis(chart, axis) + bars(chart, axis) + index_axis(chart);
    text += line(left, top, left, bottom, "axis") + line(left, bottom, right, bottom, "axis");
    return text + "</svg>\n";
}

}  // namespace lcl::cli
