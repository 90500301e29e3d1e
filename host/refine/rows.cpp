// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/rows.h"

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

PointRows::PointRows(const PolygonMesh& mesh, const Topology& topology, std::size_t row_count, bool with_means)
    : topology_(topology), positions_(mesh.positions) {
    result_.reserve(3 * row_count);
    if (!with_means) return;
    means_.resize(3 * static_cast<std::size_t>(topology.face_count));
    for (Index f = 0; f < topology.face_count; ++f) {
        begin();
        for (Index h = topology.face_offsets[f]; h < topology.face_offsets[f + 1]; ++h) add(topology.face_vertices[h], 1);
        for (int c = 0; c < 3; ++c) means_[3 * static_cast<std::size_t>(f) + c] = sum_[c] / topology.degree(f);
    }
}

void PointRows::prepare_harmonic(Index face) {
    const Index m = topology_.degree(face), first = topology_.face_offsets[face];
    harmonic_face_ = face;
    if (static_cast<Index>(cosines_.size()) != m) cosines_ = cosines_of_turn(m);
    cosine_sum_ = sine_sum_ = {0, 0, 0};
    for (Index k = 0; k < m; ++k) {
        const double* p = &positions_[3 * static_cast<std::size_t>(topology_.face_vertices[first + k])];
        const double sine = sine_of_turn(k, m);
        for (int c = 0; c < 3; ++c) {
            cosine_sum_[c] += cosines_[k] * p[c];
            sine_sum_[c] += sine * p[c];
        }
    }
}

/// weight/m * sum_j cos(2 pi j / m) * (corner j steps on), by the addition theorem from two sums for the whole face.
void PointRows::add_harmonic(Index corner, double weight) {
    const Index face = topology_.half_edge_face[corner];
    if (face != harmonic_face_) prepare_harmonic(face);
    const Index m = topology_.degree(face), k = corner - topology_.face_offsets[face];
    add_point(cosine_sum_.data(), weight / m * cosines_[k]);
    add_point(sine_sum_.data(), weight / m * sine_of_turn(k, m));
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
