// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/limit_rows.h"

#include <algorithm>
#include <numeric>

namespace lcl {
namespace {

void add(LimitRow& row, Index column, double weight) {
    row.columns.push_back(column);
    row.weights.push_back(weight);
}

/// Every column once, ascending: a vertex that is met several times gets the sum.
LimitRow merged(const LimitRow& row) {
    std::vector<std::size_t> order(row.columns.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return row.columns[a] < row.columns[b]; });
    LimitRow out;
    for (const std::size_t i : order) {
        if (!out.columns.empty() && out.columns.back() == row.columns[i]) out.weights.back() += row.weights[i];
        else add(out, row.columns[i], row.weights[i]);
    }
    return out;
}

/// Catmull-Clark mask times n (n + 5): n (n - 1 + alpha) on V, 2 - alpha on each edge end, 4/d on every corner of every face (mesh expansion paper).
void add_catmull_clark(const Topology& t, Index v, double alpha, LimitRow& row) {
    const int n = t.vertex_face_count[v];
    const double scale = 1 / (n * (n + 5.0));
    add(row, v, n * (n - 1 + alpha) * scale);
    Index h = t.vertex_half_edge[v];
    for (int i = 0; i < n; ++i, h = t.rotate(h)) {
        const Index face = t.half_edge_face[h];
        add(row, t.destination(h), (2 - alpha) * scale);
        for (Index c = t.face_offsets[face]; c < t.face_offsets[face + 1]; ++c) add(row, t.face_vertices[c], 4.0 / t.degree(face) * scale);
    }
}

/// Centroid of the n new points round V (Doo-Sabin paper).
void add_doo_sabin(const Topology& t, Index v, DooSabinMask mask, LimitRow& row) {
    const int n = t.vertex_face_count[v];
    Index h = t.vertex_half_edge[v];
    for (int i = 0; i < n; ++i, h = t.rotate(h)) {
        const int m = t.degree(t.half_edge_face[h]);
        Index corner = h;
        for (int j = 0; j < m; ++j, corner = t.next(corner)) add(row, t.face_vertices[corner], doo_sabin_weight(mask, m, j) / n);
    }
}

void add_loop(const Topology& t, Index v, LimitRow& row) {
    const int n = t.vertex_face_count[v];
    const double weight = loop_limit_vertex_weight(n);
    add(row, v, weight);
    Index h = t.vertex_half_edge[v];
    for (int i = 0; i < n; ++i, h = t.rotate(h)) add(row, t.destination(h), (1 - weight) / n);
}

}  // namespace

LimitRows::LimitRows(const Topology& topology, const Features& features, const SchemeOptions& options, const std::vector<std::uint8_t>& subset,
                     const std::vector<std::uint8_t>& owned)
    : topology_(topology), features_(features), options_(options), subset_(subset), owned_(owned) {}

RowClass LimitRows::classify(Index v) const {
    if (!owned_.empty() && !owned_[v]) return {RowKind::ghost, RowShape::identity, 0};
    const VertexKind kind = features_.kind[v];
    const bool outside = !subset_.empty() && !subset_[v];
    if (kind == VertexKind::isolated || kind == VertexKind::corner || outside || options_.lambda_at(v) == 1) return {RowKind::fixed, RowShape::identity, 0};
    const bool own_weights = !options_.lambda_per_vertex.empty();
    const bool fold = kind == VertexKind::dart && options_.scheme == Scheme::doo_sabin;  // a crease is a cut, and the curve turns back at its end
    if (kind == VertexKind::curve || fold) return {RowKind::curve, own_weights ? RowShape::weighted : RowShape::ring, 2};
    if (kind == VertexKind::dart) return {RowKind::dart, RowShape::weighted, 0};
    const int n = topology_.vertex_face_count[v];
    bool triangles = true, quads = true;
    Index h = topology_.vertex_half_edge[v];
    for (int i = 0; i < n && (triangles || quads); ++i, h = topology_.rotate(h)) {
        const Index degree = topology_.degree(topology_.half_edge_face[h]);
        triangles = triangles && degree == 3;
        quads = quads && degree == 4;
    }
    if (own_weights || !(triangles || quads)) return {RowKind::smooth, RowShape::weighted, n};
    return {RowKind::smooth, quads ? RowShape::full_ring : RowShape::ring, n};
}

void LimitRows::ring_neighbours(Index v, const RowClass& row, Index* out) const {
    if (row.kind == RowKind::curve) {
        std::copy(features_.curve_neighbours[v].begin(), features_.curve_neighbours[v].end(), out);
        return;
    }
    const Topology& t = topology_;
    Index h = t.vertex_half_edge[v];
    for (int i = 0; i < row.edges; ++i, h = t.rotate(h)) {
        out[i] = t.destination(h);
        if (row.shape == RowShape::full_ring) out[row.edges + i] = t.destination(t.next(h));
    }
}

RingWeights LimitRows::ring_weights(const RowClass& row) const {
    if (row.shape == RowShape::identity) return {};
    const RingWeights plain =
        row.kind == RowKind::curve ? curve_weights(options_.scheme) : smooth_ring_weights(options_, row.edges, row.shape == RowShape::full_ring);
    return blend(plain, options_.lambda);
}

LimitRow LimitRows::row(Index v) {
    const RowClass kind = classify(v);
    LimitRow row;
    if (kind.shape == RowShape::identity) {
        add(row, v, 1.0);
        return row;
    }
    if (kind.kind == RowKind::curve) {
        const RingWeights weights = curve_weights(options_.scheme);
        add(row, v, weights.vertex);
        for (const Index neighbour : features_.curve_neighbours[v]) add(row, neighbour, weights.edge);
    } else if (kind.kind == RowKind::dart) {
        add_dart(v, row);
    } else {
        add_smooth(v, row);
    }
    const double lambda = options_.lambda_at(v);
    for (double& weight : row.weights) weight *= 1 - lambda;
    if (lambda != 0) add(row, v, lambda);
    return merged(row);
}

void LimitRows::add_smooth(Index v, LimitRow& row) const {
    switch (options_.scheme) {
        case Scheme::catmull_clark: add_catmull_clark(topology_, v, options_.alpha, row); break;
        case Scheme::loop: add_loop(topology_, v, row); break;
        case Scheme::doo_sabin: add_doo_sabin(topology_, v, options_.mask, row); break;
    }
}

void LimitRows::add_dart(Index v, LimitRow& row) {
    const Topology& t = topology_;
    const int n = t.vertex_face_count[v];
    std::vector<double>& weights = dart_weights_[n];
    if (weights.empty()) weights = options_.scheme == Scheme::loop ? loop_dart_weights(n) : catmull_clark_dart_weights(n);
    Index first = t.vertex_half_edge[v];
    while (!features_.edge_is_sharp[t.half_edge_edge[first]]) first = t.rotate(first);
    if (options_.scheme == Scheme::catmull_clark) return add_catmull_clark_dart(v, first, weights, row);
    add(row, v, weights[0]);
    Index h = first;
    for (int j = 0; j < n; ++j, h = t.rotate(h)) add(row, t.destination(h), weights[1 + j]);
}

/// The umbrella weights pulled back through the first refinement: V' = ((n - 2 + alpha) V)/n + ((1 - alpha) sum E + sum F)/n^2, E' = (V + E + F_left +
/// F_right)/4 or, on the sharp edge, (V + E)/2; F: face centroids.
void LimitRows::add_catmull_clark_dart(Index v, Index first, const std::vector<double>& weights, LimitRow& row) const {
    const Topology& t = topology_;
    const int n = t.vertex_face_count[v];
    const double alpha = options_.alpha, vertex = weights[0];
    add(row, v, vertex * (n - 2 + alpha) / n);
    Index h = first;
    for (int j = 0; j < n; ++j, h = t.rotate(h)) {
        const double edge = weights[1 + j], edge_part = j == 0 ? 0.5 : 0.25;
        add(row, v, edge * edge_part);
        add(row, t.destination(h), edge * edge_part + vertex * (1 - alpha) / (n * n));
        // Face F_j lies between E_j and E_(j+1): both of their points use its centroid unless their edge is the sharp one.
        double face = weights[1 + n + j] + vertex / (n * n);
        if (j != 0) face += edge / 4;
        if (j + 1 != n) face += weights[1 + j + 1] / 4;
        const Index f = t.half_edge_face[h];
        for (Index c = t.face_offsets[f]; c < t.face_offsets[f + 1]; ++c) add(row, t.face_vertices[c], face / t.degree(f));
    }
}

}  // namespace lcl
