// SPDX-License-Identifier: BSD-3-Clause
// A small bar chart as SVG.
#pragma once

#include <string>
#include <vector>

namespace lcl::cli {

/// One bar a value, at 0, 1, 2, ..; values are 0 or more. The axis of the values is logarithmic where they differ by more than a factor of a hundred.
struct BarChart {
    std::string title, x_label, y_label;
    std::vector<double> values;
};

/// Readable in light and dark viewers: it has a background of its own, which follows the viewer's preference where the viewer tells.
std::string to_svg(const BarChart& chart);

}  // namespace lcl::cli
