// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/feature_rows.h"

#include <cmath>
#include <limits>

#include "host/mesh/normals.h"
#include "host/operator/ordering.h"
#include "host/operator/plan_parts.h"
#include "host/operator/rows_plan.h"
#include "host/parallel.h"

namespace lcl {
namespace {

class FeatureRows {
public:
    FeatureRows(const Topology& topology, const Features& features, const std::vector<double>& points, const FeatureOperatorOptions& options)
        : topology_(topology), features_(features), options_(options), normals_(vertex_normals(topology, points)) {
        const std::size_t n = topology.vertex_count;
        scaling_.resize(n);
        groups_.resize(n);
        offsets_.assign(n + 1, 0);
        for (std::size_t v = 0; v < n; ++v) offsets_[v + 1] = offsets_[v] + 1 + neighbour_count(static_cast<Index>(v));
        columns_.resize(offsets_.back());
        weights_.resize(offsets_.back());
        parallel_for(n, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) fill(static_cast<Index>(v));
        });
    }

    RowMatrix matrix() const { return {topology_.vertex_count, offsets_.data(), columns_.data(), weights_.data(), scaling_.data()}; }
    const Array<std::uint8_t>& groups() const { return groups_; }

private:
    bool is_curve(Index v) const { return features_.kind[v] == VertexKind::curve; }
    Index neighbour_count(Index v) const { return is_curve(v) ? 2 : topology_.valence(v); }

    /// Writes as many as neighbour_count says.
    void get_neighbours(Index v, Index* out) const {
        if (is_curve(v)) {
            out[0] = features_.curve_neighbours[v][0], out[1] = features_.curve_neighbours[v][1];
            return;
        }
        for (Index i = topology_.fan_offsets[v]; i < topology_.fan_offsets[v + 1]; ++i) *out++ = topology_.destination(topology_.fan_half_edges[i]);
        if (topology_.is_boundary(v)) *out = topology_.origin(topology_.previous(topology_.fan_half_edges[topology_.fan_offsets[v + 1] - 1]));
    }

    void fill(Index v) {
        const std::int64_t first = offsets_[v], end = offsets_[v + 1];
        columns_[first] = v;
        get_neighbours(v, &columns_[first + 1]);
        double sum = 0;
        for (std::int64_t e = first + 1; e < end; ++e) sum += weights_[e] = weight(v, columns_[e]);
        const double factor = options_.diagonal_factor;
        weights_[first] = 1 - 1 / factor;
        for (std::int64_t e = first + 1; e < end; ++e) weights_[e] /= factor * sum;
        scaling_[v] = factor * sum;
        groups_[v] = row_group(kind_of(v, sum), topology_.is_isolated(v));
    }

    /// exp(-(phi / angle)^2)
    double weight(Index v, Index other) const {
        const double ratio = angle_between(normals_[v], normals_[other]) / (options_.angle_degrees * radians_per_degree);
        return std::exp(-ratio * ratio);
    }

    RowKind kind_of(Index v, double sum) const {
        const bool stays = (!options_.subset.empty() && !options_.subset[v]) || sum < std::numeric_limits<double>::min();
        switch (features_.kind[v]) {
            case VertexKind::smooth: return stays ? RowKind::fixed : RowKind::smooth;
            case VertexKind::dart: return stays ? RowKind::fixed : RowKind::dart;
            case VertexKind::curve: return stays ? RowKind::fixed : RowKind::curve;
            default: return RowKind::fixed;
        }
    }

    const Topology& topology_;
    const Features& features_;
    const FeatureOperatorOptions& options_;
    const Array<Vector> normals_;
    std::vector<std::int64_t> offsets_;
    std::vector<Index> columns_;
    std::vector<double> weights_;
    Array<double> scaling_;
    Array<std::uint8_t> groups_;
};

}  // namespace

Plan build_feature_plan(const PolygonMesh& mesh, const Topology& topology, const Features& features, const std::vector<double>& points,
                        const FeatureOperatorOptions& options, Index block_rows) {
    const FeatureRows rows(topology, features, points, options);
    Plan plan = build_rows_plan(rows.matrix(), rows.groups(), breadth_first_order(topology, mesh.positions), block_rows);
    plan.lambda_min_bound = 1 - 2 / options.diagonal_factor;
    return plan;
}

}  // namespace lcl
