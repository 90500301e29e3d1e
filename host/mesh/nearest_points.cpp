// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/nearest_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nanoflann.hpp>

#include "host/parallel.h"

namespace lcl {
namespace {

struct ChosenPoints {
    const std::vector<double>& points;
    const std::vector<Index>& chosen;
    double scale = 1;  // squares of coordinates must not overflow

    std::size_t kdtree_get_point_count() const { return chosen.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const { return scale * points[3 * static_cast<std::size_t>(chosen[i]) + axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, ChosenPoints>, ChosenPoints, 3, Index>;
};

double scale_of(const std::vector<double>& points, const std::vector<double>& places) {
    double largest = 0;
    for (const std::vector<double>* values : {&points, &places})
        for (const double x : *values) largest = std::max(largest, std::fabs(x));
    return largest > std::numeric_limits<double>::min() ? 1 / largest : 1;
}

}  // namespace

std::vector<Index> nearest_points(const std::vector<double>& points, const std::vector<Index>& chosen, const std::vector<double>& places) {
    const ChosenPoints set{points, chosen, scale_of(points, places)};
    const ChosenPoints::Tree tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    std::vector<Index> nearest(places.size() / 3);
    parallel_for_each(
        nearest.size(),
        [&](std::size_t i) {
            double at[3], square = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = set.scale * places[3 * i + axis];
            Index found = 0;
            tree.knnSearch(at, 1, &found, &square);
            nearest[i] = chosen[static_cast<std::size_t>(found)];
        },
        256);
    return nearest;
}

}  // namespace lcl
