// SPDX-License-Identifier: BSD-3-Clause
// What columns of numbers beside x, y and z are, by what stands in them.
#pragma once

#include <vector>

#include "host/mesh/point_cloud.h"

namespace lcl {

enum class TripleKind {
    bytes,         ///< whole numbers from 0 to 255, one of them above 1: colours
    unit_vectors,  ///< most rows that are not zero have a length within 0.01 of 1: normals
    fractions,     ///< numbers from 0 to 1, not all zero: colours
    vectors,       ///< all else: normals of any length
    zeros          ///< nothing but 0
};

/// rows: `count` rows of three, `stride` values apart.
TripleKind kind_of_triples(const double* rows, std::size_t stride, std::size_t count);

/// Colours of a cloud, count x 3 or none, of full intensity `full`; 0: 255 where they are bytes, else 1. What then is not from 0 to 1 is left out, with a
/// warning.
void take_colours(PointCloud& cloud, std::vector<double> rows, double full = 0);

/// Makes normals and colours of the `width` columns behind x, y, z, or leaves them out, with a warning. values: count x width. `columns`: of the text, which
/// may have more. may_have_intensity: column 4 of 7 or 10 may be a number of its own, before the triples.
void take_columns(PointCloud& cloud, std::vector<double> values, std::size_t width, std::size_t columns, bool may_have_intensity);

}  // namespace lcl
