// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/point_cloud.h"

#include <cmath>

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

}  // namespace

BadRows bad_points(const std::vector<double>& points) {
    return find_rows(points, [](const double* point) { return !is_finite(point); });
}

BadRows bad_normals(const std::vector<double>& normals) {
    return find_rows(normals, [](const double* normal) { return !is_finite(normal) || (normal[0] == 0 && normal[1] == 0 && normal[2] == 0); });
}

std::string not_finite_text(const BadRows& bad) {
    if (bad.count == 1) return " is not finite: correct it or leave it out";
    return " is not finite, nor " + std::string(bad.count == 2 ? "is" : "are") + " " + std::to_string(bad.count - 1) + " more: correct them or leave them out";
}

}  // namespace lcl
