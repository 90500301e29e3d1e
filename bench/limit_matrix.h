// SPDX-License-Identifier: BSD-3-Clause
// The limit operator as a sparse matrix, A = D^-1 S with S symmetric, from the published masks and this file alone: what the peers solve with, and what every
// result is checked against.
#ifndef LIMITCL_BENCH_LIMIT_MATRIX_H
#define LIMITCL_BENCH_LIMIT_MATRIX_H

#include <cmath>

#include "shapes.h"

namespace bench {

enum class Scheme { catmull_clark, loop, doo_sabin };

struct LimitMatrix {
    std::vector<std::int32_t> offsets;  ///< vertex_count + 1
    std::vector<std::int32_t> columns;  ///< ascending in each row
    std::vector<double> weights;        ///< of S
    std::vector<double> scale;          ///< D, vertex_count

    std::int32_t size() const { return static_cast<std::int32_t>(scale.size()); }
};

/// Closed meshes without sharp features. Loop takes triangles, the others quads.
LimitMatrix limit_matrix(const Shape& shape, Scheme scheme);

/// max_i |M - A P|_i in double, M the shape's points, over the diagonal of their bounding box. points: vertex_count x 3.
double relative_error(const LimitMatrix& matrix, const Shape& shape, const std::vector<double>& points);

/// A P: vertex_count x 3.
std::vector<double> limit_points(const LimitMatrix& matrix, const std::vector<double>& points);

constexpr double target_error = 1e-6;  ///< of relative_error

/// The loosest relative tolerance, to 5 %, of a solver whose error_at(tolerance) is within target_error: each peer iterates as little as the same error takes.
template <class ErrorAt>
double loosest_tolerance(const ErrorAt& error_at) {
    double fails = 1, holds = 1e-10;
    while (fails > 1.05 * holds) {
        const double middle = std::sqrt(fails * holds);
        (error_at(middle) <= target_error ? holds : fails) = middle;
    }
    return holds;
}

}  // namespace bench

#endif
