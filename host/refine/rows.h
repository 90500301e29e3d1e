// SPDX-License-Identifier: BSD-3-Clause
// Two receivers for the rows of a refinement: the rules are written once and give either refined positions at once or stencils. Internal to host/refine.
// Both offer begin(), add(vertex, weight), add_mean(face, weight), add_harmonic(corner, weight), end().
#pragma once

#include <array>
#include <vector>

#include "host/mesh/topology.h"
#include "host/refine/refine.h"

namespace lcl {

/// cos(2 pi j / m) for j = 0 .. m - 1, exact at quarter turns.
std::vector<double> cosines_of_turn(Index m);

/// Rows applied to the positions on the way. Linear in the mesh, also at faces and vertices of any degree.
class PointRows {
public:
    /// with_means: face means are needed (Catmull-Clark, Doo-Sabin).
    PointRows(const PolygonMesh& mesh, const Topology& topology, std::size_t row_count, bool with_means);

    void begin() { sum_ = {0, 0, 0}; }
    void add(Index vertex, double weight) { add_point(&positions_[3 * static_cast<std::size_t>(vertex)], weight); }
    void add_mean(Index face, double weight) { add_point(&means_[3 * static_cast<std::size_t>(face)], weight); }
    void add_harmonic(Index corner, double weight);
    void end() { result_.insert(result_.end(), sum_.begin(), sum_.end()); }

    std::vector<double> take() { return std::move(result_); }

private:
    void add_point(const double* p, double weight) {
        for (int c = 0; c < 3; ++c) sum_[c] += weight * p[c];
    }
    void prepare_harmonic(Index face);

    const Topology& topology_;
    const std::vector<double>& positions_;
    std::vector<double> means_, result_;
    std::array<double, 3> sum_{};
    Index harmonic_face_ = -1;  ///< the face whose cosines_ and sums over its corners are at hand
    std::vector<double> cosines_;
    std::array<double, 3> cosine_sum_{}, sine_sum_{};
};

/// Rows kept as stencils; a vertex that is met several times in a row becomes one entry.
class StencilRows {
public:
    StencilRows(const Topology& topology, std::size_t row_count);

    void begin() { row_begin_ = stencils_.indices.size(); }
    void add(Index vertex, double weight);
    void add_mean(Index face, double weight);
    void add_harmonic(Index corner, double weight);
    void end() { stencils_.offsets.push_back(stencils_.indices.size()); }

    Stencils take() { return std::move(stencils_); }

private:
    const Topology& topology_;
    Stencils stencils_;
    std::size_t row_begin_ = 0;
    std::vector<std::size_t> entry_of_;  ///< per old vertex: its latest entry, of this row if it is not before row_begin_
    std::vector<double> cosines_;
};

}  // namespace lcl
