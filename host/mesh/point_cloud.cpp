// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/point_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/parallel.h"

namespace lcl {
namespace {

constexpr std::size_t most_named = 10;

template <class IsBad>
BadRows find_rows(const std::vector<double>& rows, const IsBad& is_bad) {
    const std::size_t count = rows.size() / 3, pieces = piece_count(count);
    std::vector<BadRows> parts(pieces);
    for_each_piece(count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (is_bad(&rows[3 * i]) && parts[piece].count++ < most_named) parts[piece].first.push_back(static_cast<Index>(i));
    });
    BadRows all;
    for (const BadRows& part : parts) {
        all.count += part.count;
        for (const Index row : part.first)
            if (all.first.size() < most_named) all.first.push_back(row);
    }
    return all;
}

bool is_finite(const double* row) { return std::isfinite(row[0]) && std::isfinite(row[1]) && std::isfinite(row[2]); }
bool is_normal(const double* row) { return is_finite(row) && (row[0] != 0 || row[1] != 0 || row[2] != 0); }

std::size_t longest_axis(const std::vector<double>& points) {
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < points.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], points[i]);
        high[i % 3] = std::max(high[i % 3], points[i]);
    }
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
        if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
    return longest;
}

/// Nearest of some points: sorted along the longest axis, and searched outwards from where a point would be.
class NearestAlongAxis {
public:
    NearestAlongAxis(const std::vector<double>& points, std::vector<Index> among) : points_(points), axis_(longest_axis(points)), order_(std::move(among)) {
        std::sort(order_.begin(), order_.end(), [&](Index a, Index b) { return at(a)[axis_] < at(b)[axis_]; });
    }

    Index find(const double* point) const {
        const auto middle = std::lower_bound(order_.begin(), order_.end(), point[axis_], [&](Index i, double value) { return at(i)[axis_] < value; });
        Index nearest = -1;
        double least = std::numeric_limits<double>::infinity();
        const auto look = [&](Index i) {  // false where this one and all behind it are farther away
            const double* const other = at(i);
            if (nearest >= 0 && std::fabs(other[axis_] - point[axis_]) > least) return false;
            const double distance = std::hypot(other[0] - point[0], other[1] - point[1], other[2] - point[2]);
            if (nearest < 0 || distance < least) nearest = i, least = distance;
            return true;
        };
        auto up = middle;
        auto down = middle;
        for (bool upwards = true, downwards = true; upwards || downwards;) {
            upwards = upwards && up != order_.end() && look(*up++);
            downwards = downwards && down != order_.begin() && look(*--down);
        }
        return nearest;
    }

private:
    const double* at(Index i) const { return &points_[3 * static_cast<std::size_t>(i)]; }

    const std::vector<double>& points_;
    std::size_t axis_;
    std::vector<Index> order_;
};

/// Gives each point without a normal that of the nearest one that has one.
void fill_normals(PointCloud& cloud) {
    std::vector<Index> with, without;
    for (std::size_t i = 0; i < cloud.count(); ++i) (is_normal(&cloud.normals[3 * i]) ? with : without).push_back(static_cast<Index>(i));
    const NearestAlongAxis search(cloud.points, std::move(with));
    parallel_for_each(
        without.size(),
        [&](std::size_t i) {
            const std::size_t point = static_cast<std::size_t>(without[i]);
            const std::size_t nearest = static_cast<std::size_t>(search.find(&cloud.points[3 * point]));
            std::copy_n(&cloud.normals[3 * nearest], 3, &cloud.normals[3 * point]);
        },
        16);
}

}  // namespace

BadRows bad_points(const std::vector<double>& points) {
    return find_rows(points, [](const double* point) { return !is_finite(point); });
}

BadRows bad_normals(const std::vector<double>& normals) {
    return find_rows(normals, [](const double* normal) { return !is_normal(normal); });
}

void settle_normals(PointCloud& cloud) {
    const BadRows bad = bad_normals(cloud.normals);
    if (bad.count == 0) return;
    const bool are_dropped = 2 * bad.count > cloud.count();
    const std::string which = bad.count == cloud.count()
                                  ? "all normals are zero or not finite"
                                  : std::to_string(bad.count) + " of the " + std::to_string(cloud.count()) + " normals " + (bad.count == 1 ? "is" : "are") +
                                        " zero or not finite, the first that of point " + std::to_string(bad.first[0]);
    if (are_dropped) cloud.normals.clear();
    else fill_normals(cloud);
    cloud.warnings.push_back(which + (are_dropped ? "; all were left out" : "; instead the normal of the nearest point was taken"));
}

std::string not_finite_text(const BadRows& bad) {
    if (bad.count == 1) return " is not finite: correct it or leave it out";
    return " is not finite, nor " + std::string(bad.count == 2 ? "is" : "are") + " " + std::to_string(bad.count - 1) + " more: correct them or leave them out";
}

}  // namespace lcl
