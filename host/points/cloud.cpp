// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

#include "host/mesh/box.h"
#include "host/mesh/nearest_points.h"

namespace lcl {
namespace {

constexpr double flat = 1e-6;  // of the diagonal: what floats leave of a plane

using Point = Eigen::Map<const Eigen::Vector3d>;

Point point(const std::vector<double>& values, std::size_t i) { return Point(&values[3 * i]); }

/// Marks of the points that are not at the place of an earlier one.
std::vector<std::uint8_t> firsts_at_their_place(const std::vector<double>& points) {
    std::vector<Index> order(points.size() / 3);
    std::iota(order.begin(), order.end(), 0);
    const auto at = [&](Index i) { return &points[3 * static_cast<std::size_t>(i)]; };
    const auto compare = [&](Index a, Index b) {
        for (int c = 0; c < 3; ++c)
            if (at(a)[c] != at(b)[c]) return at(a)[c] < at(b)[c] ? -1 : 1;
        return 0;
    };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        const int places = compare(a, b);
        return places != 0 ? places < 0 : a < b;
    });
    std::vector<std::uint8_t> is_first(order.size(), 1);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (compare(order[i - 1], order[i]) == 0) is_first[order[i]] = 0;
    return is_first;
}

void keep_rows(std::vector<double>& values, const std::vector<std::uint8_t>& is_kept) {
    if (values.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < is_kept.size(); ++i)
        if (is_kept[i]) std::copy_n(&values[3 * i], 3, &values[3 * kept++]);
    values.resize(3 * kept);
}

/// How many of the three directions the points spread in.
int dimensions(const std::vector<double>& points) {
    const std::size_t count = points.size() / 3;
    const Box box = box_of_points(points, count, [](std::size_t i) { return static_cast<std::int64_t>(i); });
    const Eigen::Vector3d centre(box.low[0] + box.extent(0) / 2, box.low[1] + box.extent(1) / 2, box.low[2] + box.extent(2) / 2);
    const double size = box.diagonal();
    if (!(size > 0)) return 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < count; ++i) mean += (point(points, i) - centre) / size;
    mean /= static_cast<double>(count);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d way = (point(points, i) - centre) / size - mean;
        spread += way * way.transpose();
    }
    const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
    Eigen::Vector3d largest = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < count; ++i) largest = largest.cwiseMax((axes.transpose() * ((point(points, i) - centre) / size - mean)).cwiseAbs());
    return static_cast<int>((largest.array() > flat).count());
}

void check_spread(const PointCloud& cloud, std::size_t given) {
    const std::string points = cloud.count() == given ? "the " + std::to_string(given) + " points"
                                                      : "the " + std::to_string(cloud.count()) + " different ones of " + std::to_string(given) + " points";
    if (cloud.count() < 4)
        throw BadInput(given == 0 ? "the cloud has no points: a surface takes at least four"
                                  : points + " are too few: a surface takes at least four that differ");
    const int spread = dimensions(cloud.points);
    if (spread == 3) return;
    const char* const place = spread == 2 ? "in a plane" : spread == 1 ? "on a line" : "in one place";
    throw BadInput(points + " all lie " + place + " (within 1e-6 of their box): a surface in space takes points that do not");
}

}  // namespace

DistinctPoints distinct_points(const PointCloud& cloud) {
    DistinctPoints out{cloud, 0};
    const std::vector<std::uint8_t> is_first = firsts_at_their_place(cloud.points);
    for (std::vector<double>* values : {&out.cloud.points, &out.cloud.normals, &out.cloud.colours}) keep_rows(*values, is_first);
    out.duplicate_count = cloud.count() - out.cloud.count();
    for (std::size_t i = 0; i < out.cloud.normals.size(); i += 3) Eigen::Map<Eigen::Vector3d>(&out.cloud.normals[i]).stableNormalize();
    check_spread(out.cloud, cloud.count());
    return out;
}

std::vector<double> values_at_vertices(const PointCloud& cloud, const std::vector<double>& values, const std::vector<double>& positions,
                                       const std::vector<Index>& source) {
    if (values.empty()) return {};
    std::vector<double> unknown;
    for (std::size_t v = 0; v < source.size(); ++v)
        if (source[v] < 0) unknown.insert(unknown.end(), &positions[3 * v], &positions[3 * v] + 3);
    std::vector<Index> nearest;
    if (!unknown.empty()) {
        std::vector<Index> all(cloud.count());
        std::iota(all.begin(), all.end(), 0);
        nearest = nearest_points(cloud.points, all, unknown);
    }
    std::size_t next = 0;
    std::vector<double> out;
    for (const Index known : source) {
        const double* const from = &values[3 * static_cast<std::size_t>(known >= 0 ? known : nearest[next++])];
        out.insert(out.end(), from, from + 3);
    }
    return out;
}

}  // namespace lcl
