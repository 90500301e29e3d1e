// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/limit_rows.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace lcl {
namespace {

void add(LimitRow& row, Index column, double weight) {
    row.columns.push_back(column);
    row.weights.push_back(weight);
}

/// Every column once, ascending: a vertex that is met several times gets the sum, in the order of its parts.
void merge(LimitRow& row) {
    const std::size_t size = row.columns.size();
    std::vector<std::pair<Index, double>> sorted;
    for (std::size_t i = 1; size <= 64 && i < size; ++i) {  // an insertion sort, which needs no memory
        const Index column = row.columns[i];
        const double weight = row.weights[i];
        std::size_t place = i;
        for (; place > 0 && row.columns[place - 1] > column; --place) row.columns[place] = row.columns[place - 1], row.weights[place] = row.weights[place - 1];
        row.columns[place] = column, row.weights[place] = weight;
    }
    if (size > 64) {
        for (std::size_t i = 0; i < size; ++i) sorted.emplace_back(row.columns[i], row.weights[i]);
        std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (std::size_t i = 0; i < size; ++i) std::tie(row.columns[i], row.weights[i]) = sorted[i];
    }
    std::size_t last = 0;
    for (std::size_t i = 1; i < size; ++i) {
        if (row.columns[i] == row.columns[last]) row.weights[last] += row.weights[i];
        else ++last, row.columns[last] = row.columns[i], row.weights[last] = row.weights[i];
    }
    row.columns.resize(last + 1);
    row.weights.resize(last + 1);
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
    const Index degree = own_weights ? 0 : common_degree(v);
    return {RowKind::smooth, degree == 4 ? RowShape::full_ring : degree == 3 ? RowShape::ring : RowShape::weighted, n};
}

Index LimitRows::common_degree(Index v) const {
    if (topology_.uniform_degree > 0) return topology_.uniform_degree;
    const auto degree_at = [&](Index i) { return topology_.degree(topology_.half_edge_face[topology_.fan_half_edges[i]]); };
    const Index first = topology_.fan_offsets[v], degree = degree_at(first);
    for (Index i = first + 1; i < topology_.fan_offsets[v + 1]; ++i)
        if (degree_at(i) != degree) return 0;
    return degree;
}

RingWeights LimitRows::ring_weights(const RowClass& row) const {
    if (row.shape == RowShape::identity) return {};
    const RingWeights plain =
        row.kind == RowKind::curve ? curve_weights(options_.scheme) : smooth_ring_weights(options_, row.edges, row.shape == RowShape::full_ring);
    return blend(plain, options_.lambda);
}

LimitRow LimitRows::row(Index v) {
    LimitRow out;
    row(v, out);
    return out;
}

void LimitRows::row(Index v, LimitRow& row) {
    const RowClass kind = classify(v);
    row.columns.clear();
    row.weights.clear();
    if (kind.shape == RowShape::identity) return add(row, v, 1.0);
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
    merge(row);
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
