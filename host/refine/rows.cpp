// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/rows.h"

#include <array>
#include <cmath>

namespace lcl {
namespace {

constexpr double two_pi = 6.283185307179586;

/// sin(2 pi k / m) out of the cosines: sin(x) = cos(x - pi/2) needs a quarter turn, so it is taken directly, exact at half turns.
double sine_of_turn(Index k, Index m) { return 2 * static_cast<std::int64_t>(k) % m == 0 ? 0 : std::sin(two_pi * k / m); }

}  // namespace

std::vector<double> cosines_of_turn(Index m) {
    std::vector<double> cosines(m);
    for (Index j = 0; j < m; ++j) {
        const std::int64_t quarters = 4 * static_cast<std::int64_t>(j);
        if (quarters % m != 0) cosines[j] = std::cos(two_pi * j / m);
        else cosines[j] = std::array<double, 4>{1, 0, -1, 0}[quarters / m];
    }
    return cosines;
}

void SummedRows::add(Index vertex, double weight) {
    if (weight == 0) return;
    out_.rows.indices.push_back(vertex);
    out_.rows.weights.push_back(weight);
}

/// The first sum of a face, or -1 where `first` has none yet: then the next one is noted.
Index SummedRows::sums_of_face(std::vector<Index>& first, Index face) {
    if (first.empty()) first.assign(topology_.face_count, -1);
    const Index known = first[face];
    if (known < 0) first[face] = out_.sum_count();
    return known;
}

void SummedRows::add_sum_entry(Index corner, double weight) {
    out_.sums.indices.push_back(topology_.face_vertices[corner]);
    out_.sums.weights.push_back(weight);
}

void SummedRows::add_mean(Index face, double weight) {
    if (sums_of_face(mean_of_face_, face) < 0) {
        const double each = 1.0 / topology_.degree(face);
        for (Index h = topology_.face_offsets[face]; h < topology_.face_offsets[face + 1]; ++h) add_sum_entry(h, each);
        end_sum();
    }
    add(topology_.vertex_count + mean_of_face_[face], weight);
}

/// weight/m * sum_j cos(2 pi j / m) * (corner j steps on), by the addition theorem from two sums for the whole face.
void SummedRows::add_harmonic(Index corner, double weight) {
    const Index face = topology_.half_edge_face[corner], first = topology_.face_offsets[face], m = topology_.degree(face), k = corner - first;
    if (static_cast<Index>(cosines_.size()) != m) cosines_ = cosines_of_turn(m);
    if (sums_of_face(harmonic_of_face_, face) < 0) {
        for (Index j = 0; j < m; ++j) add_sum_entry(first + j, cosines_[j]);
        end_sum();
        for (Index j = 0; j < m; ++j) add_sum_entry(first + j, sine_of_turn(j, m));
        end_sum();
    }
    const Index sum = topology_.vertex_count + harmonic_of_face_[face];
    add(sum, weight / m * cosines_[k]);
    add(sum + 1, weight / m * sine_of_turn(k, m));
}

StencilRows::StencilRows(const Topology& topology, std::size_t row_count) : topology_(topology), entry_of_(topology.vertex_count, 0) {
    stencils_.offsets.reserve(row_count + 1);
}

void StencilRows::add(Index vertex, double weight) {
    if (weight == 0) return;
    std::size_t& entry = entry_of_[vertex];
    const bool met = entry >= row_begin_ && entry < stencils_.indices.size() && stencils_.indices[entry] == vertex;
    if (met) {
        stencils_.weights[entry] += weight;
        return;
    }
    entry = stencils_.indices.size();
    stencils_.indices.push_back(vertex);
    stencils_.weights.push_back(weight);
}

void StencilRows::add_mean(Index face, double weight) {
    const double each = weight / topology_.degree(face);
    for (Index h = topology_.face_offsets[face]; h < topology_.face_offsets[face + 1]; ++h) add(topology_.face_vertices[h], each);
}

void StencilRows::add_harmonic(Index corner, double weight) {
    const Index face = topology_.half_edge_face[corner], first = topology_.face_offsets[face], m = topology_.degree(face), k = corner - first;
    if (static_cast<Index>(cosines_.size()) != m) cosines_ = cosines_of_turn(m);
    for (Index j = 0; j < m; ++j) add(topology_.face_vertices[first + (k + j) % m], weight / m * cosines_[j]);
}

}  // namespace lcl
