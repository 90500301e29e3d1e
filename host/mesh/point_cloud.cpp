// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/point_cloud.h"

#include <algorithm>
#include <cmath>

#include "host/mesh/nearest_points.h"
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

/// Gives each point without a normal that of the nearest one that has one.
void fill_normals(PointCloud& cloud) {
    std::vector<Index> with, without;
    std::vector<double> places;
    for (std::size_t i = 0; i < cloud.count(); ++i) {
        if (is_normal(&cloud.normals[3 * i])) {
            with.push_back(static_cast<Index>(i));
        } else {
            without.push_back(static_cast<Index>(i));
            places.insert(places.end(), &cloud.points[3 * i], &cloud.points[3 * i] + 3);
        }
    }
    const std::vector<Index> nearest = nearest_points(cloud.points, with, places);
    for (std::size_t i = 0; i < without.size(); ++i)
        std::copy_n(&cloud.normals[3 * static_cast<std::size_t>(nearest[i])], 3, &cloud.normals[3 * static_cast<std::size_t>(without[i])]);
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
