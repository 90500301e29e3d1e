// SPDX-License-Identifier: BSD-3-Clause
#include "limit_matrix.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace bench {
namespace {

/// What one face round a vertex of valence n adds to its row of S, and the row's sum: edge ends are met from two faces.
struct FaceMask {
    double own, side, opposite, sum;
};

FaceMask face_mask(Scheme scheme, int n) {
    switch (scheme) {
        case Scheme::catmull_clark: return {double(n), 2, 1, n * (n + 5.0)};  // n^2, 4 on edge ends, 1 on diagonals, over n (n + 5)
        case Scheme::doo_sabin: return {9 / 16.0, 3 / 16.0, 1 / 16.0, double(n)};
        case Scheme::loop: break;
    }
    const double t = 3 / 8.0 + std::cos(8 * std::atan(1.0) / n) / 4;
    const double own = 3 / (11 - 8 * (3 / 8.0 + t * t));  // the limit weight of the vertex itself; (1 - own)/n on each edge end
    return {own / (1 - own), 0.5, 0, n / (1 - own)};
}

/// Corners (face * degree + place) round each vertex, behind one another: offsets[v] to offsets[v + 1].
struct Corners {
    std::vector<std::int32_t> offsets, corners;
};

Corners corners_of_vertices(const Shape& shape) {
    Corners of;
    of.offsets.assign(shape.vertex_count() + 1, 0);
    of.corners.resize(shape.faces.size());
    for (const std::int32_t v : shape.faces) ++of.offsets[v + 1];
    std::partial_sum(of.offsets.begin(), of.offsets.end(), of.offsets.begin());
    std::vector<std::int32_t> next(of.offsets.begin(), of.offsets.end() - 1);
    for (std::size_t corner = 0; corner < shape.faces.size(); ++corner) of.corners[next[shape.faces[corner]]++] = static_cast<std::int32_t>(corner);
    return of;
}

}  // namespace

LimitMatrix limit_matrix(const Shape& shape, Scheme scheme) {
    const Corners of = corners_of_vertices(shape);
    LimitMatrix matrix;
    matrix.offsets.push_back(0);
    std::vector<std::pair<std::int32_t, double>> row;
    for (std::int32_t v = 0; v < shape.vertex_count(); ++v) {
        const FaceMask mask = face_mask(scheme, of.offsets[v + 1] - of.offsets[v]);
        row.clear();
        for (std::int32_t i = of.offsets[v]; i < of.offsets[v + 1]; ++i) {
            const std::int32_t face = of.corners[i] / shape.degree, place = of.corners[i] % shape.degree;
            for (int k = 0; k < shape.degree; ++k)
                row.emplace_back(shape.faces[face * shape.degree + (place + k) % shape.degree], k == 0                            ? mask.own
                                                                                                : k == 1 || k == shape.degree - 1 ? mask.side
                                                                                                                                  : mask.opposite);
        }
        std::sort(row.begin(), row.end());
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (i > 0 && row[i].first == row[i - 1].first) {
                matrix.weights.back() += row[i].second;
                continue;
            }
            matrix.columns.push_back(row[i].first);
            matrix.weights.push_back(row[i].second);
        }
        matrix.offsets.push_back(static_cast<std::int32_t>(matrix.columns.size()));
        matrix.scale.push_back(mask.sum);
    }
    return matrix;
}

std::vector<double> limit_points(const LimitMatrix& matrix, const std::vector<double>& points) {
    std::vector<double> out(points.size(), 0.0);
    for (std::int32_t v = 0; v < matrix.size(); ++v)
        for (std::int32_t i = matrix.offsets[v]; i < matrix.offsets[v + 1]; ++i)
            for (int c = 0; c < 3; ++c) out[3 * v + c] += matrix.weights[i] / matrix.scale[v] * points[3 * matrix.columns[i] + c];
    return out;
}

double relative_error(const LimitMatrix& matrix, const Shape& shape, const std::vector<double>& points) {
    const std::vector<double> limit = limit_points(matrix, points);
    double worst = 0;
    for (std::size_t i = 0; i < limit.size(); i += 3) {
        const double error = std::hypot(limit[i] - shape.points[i], limit[i + 1] - shape.points[i + 1], limit[i + 2] - shape.points[i + 2]);
        if (!(error <= worst)) worst = error;  // also if it is not a number
    }
    return worst / diagonal(shape);
}

}  // namespace bench
