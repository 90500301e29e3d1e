// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/tangent_rows.h"

#include <algorithm>
#include <cmath>

#include "host/scheme/masks.h"

namespace lcl {
namespace {

constexpr double pi = 3.14159265358979323846;

void add(TangentRow& row, Index column, int tangent, double weight) {
    if (weight == 0) return;
    row.entries.push_back({column, {0, 0, 0}});
    row.entries.back().weights[tangent] = weight;
}

/// Every column once, ascending, and all tangents of one size.
void finish(TangentRow& row) {
    std::vector<TangentRow::Entry>& entries = row.entries;
    if (entries.empty()) return;
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.column < b.column; });
    std::size_t last = 0;
    for (std::size_t i = 1; i < entries.size(); ++i) {
        if (entries[i].column != entries[last].column) entries[++last] = entries[i];
        else
            for (int t = 0; t < 3; ++t) entries[last].weights[t] += entries[i].weights[t];
    }
    entries.resize(last + 1);
    for (int t = 0; t < 3; ++t) {
        double size = 0;
        for (const auto& entry : entries) size += std::fabs(entry.weights[t]);
        for (auto& entry : entries) entry.weights[t] *= size > 0 ? tangent_scale / size : 0;
    }
}

}  // namespace

TangentRows::TangentRows(const Topology& topology, const Features& features, const SchemeOptions& options)
    : topology_(topology), features_(features), options_(options) {}

void TangentRows::sectors(Index v, std::vector<TangentSector>& out) const {
    out.clear();
    const Index begin = topology_.fan_offsets[v], end = topology_.fan_offsets[v + 1];
    if (begin == end) return;
    for (Index i = begin; i < end; ++i)
        if (is_sharp(topology_.fan_half_edges[i])) out.push_back({topology_.fan_half_edges[i], i - begin, false});
    if (!topology_.is_boundary(v) && out.size() < 2) {
        const Index first = out.empty() ? topology_.fan_half_edges[begin] : out.front().first;
        out.assign(1, {first, end - begin, true});
        return;
    }
    // `faces` held where each begins; before the first one of an inner vertex lie the last faces of the last one.
    const int before_first = out.front().faces;
    for (std::size_t s = 0; s + 1 < out.size(); ++s) out[s].faces = out[s + 1].faces - out[s].faces;
    out.back().faces = end - begin - out.back().faces + before_first;
}

void TangentRows::row(Index v, const TangentSector& sector, TangentRow& row) {
    row.entries.clear();
    set_edges(sector);
    const bool corner = features_.kind[v] == VertexKind::corner, doo_sabin = options_.scheme == Scheme::doo_sabin;
    const bool ends_rule = corner ? sector.faces == 1 || doo_sabin || (options_.scheme == Scheme::loop && sector.faces == 2) : sector.faces == 1 && !doo_sabin;
    if (sector.closed) add_closed(v, row);
    else if (ends_rule) add_ends(v, row);
    else add_curve(v, row);
    finish(row);
}

void TangentRows::set_edges(const TangentSector& sector) {
    sector_ = sector;
    half_edges_.clear();
    ends_.clear();
    sharp_.clear();
    Index h = sector.first;
    for (int i = 0; i < sector.faces; ++i) {
        half_edges_.push_back(h);
        ends_.push_back(topology_.destination(h));
        sharp_.push_back(is_sharp(h));
        if (i + 1 < sector.faces) h = topology_.rotate(h);
    }
    if (sector.closed) return;
    ends_.push_back(topology_.origin(topology_.previous(h)));
    sharp_.push_back(1);
}

const TangentMasks& TangentRows::closed_masks(int n, bool dart) {
    std::map<int, TangentMasks>& known = dart ? dart_masks_ : smooth_masks_;
    const auto found = known.find(n);
    if (found != known.end()) return found->second;
    const bool loop = options_.scheme == Scheme::loop;
    return known[n] = dart ? loop ? loop_dart_tangents(n) : catmull_clark_dart_tangents(n) : loop ? loop_tangents(n) : catmull_clark_tangents(n);
}

void TangentRows::add_closed(Index v, TangentRow& row) {
    const int n = sector_.faces;
    if (options_.scheme != Scheme::doo_sabin) {
        const TangentMasks& masks = closed_masks(n, features_.kind[v] == VertexKind::dart);
        for (int t = 0; t < 2; ++t) add_mask(v, masks[t], t, row);
        return;
    }
    // Of the n points of the face that the first refinement puts at v; of two of them, their difference and that of the edges.
    for (int j = 0; j < n; ++j) {
        const double angle = 2 * pi * (j + 0.5) / n;
        if (n > 2) add_doo_sabin_point(half_edges_[j], std::cos(angle), 0, row);
        else add(row, ends_[j], 0, j == 0 ? 1 : -1);
        add_doo_sabin_point(half_edges_[j], std::sin(angle), 1, row);
    }
}

void TangentRows::add_ends(Index v, TangentRow& row) {
    for (const int t : {0, 1}) {
        add(row, t == 0 ? ends_.front() : ends_.back(), t, 1);
        add(row, v, t, -1);
    }
    add_spare(v, row);
}

/// Where the surface goes from a straight line through v: what shrinks next slowest after the two edges.
void TangentRows::add_spare(Index v, TangentRow& row) {
    if (options_.scheme == Scheme::catmull_clark) {
        add_mean(half_edges_.front(), 1, 2, row);
        add(row, v, 2, -1);
    } else if (options_.scheme == Scheme::loop && sector_.faces == 2) {
        add(row, ends_[1], 2, 1);
        add(row, v, 2, -1);
    } else if (options_.scheme == Scheme::doo_sabin) {
        // The first refinement's face at v: v, the point on E_0, one in each of the k faces, the point on E_k. The second one puts a point next to v in it.
        const int m = sector_.faces + 3;
        for (int j = 0; j < sector_.faces; ++j) {
            const double weight = doo_sabin_weight(options_.mask, m, j + 2);
            add_doo_sabin_point(half_edges_[j], weight, 2, row);
            add(row, v, 2, -weight);
        }
    }
}

void TangentRows::add_curve(Index v, TangentRow& row) {
    add(row, ends_.front(), 0, 1);
    add(row, ends_.back(), 0, -1);
    switch (options_.scheme) {
        case Scheme::catmull_clark: return add_mask(v, catmull_clark_across(sector_.faces), 1, row);
        case Scheme::loop: return add_mask(v, loop_across(sector_.faces), 1, row);
        case Scheme::doo_sabin: return add_doo_sabin_across(v, row);
    }
}

void TangentRows::add_mask(Index v, const TangentMask& mask, int tangent, TangentRow& row) {
    if (options_.scheme == Scheme::catmull_clark) return add_refined(v, mask, tangent, row);
    add(row, v, tangent, mask.vertex);
    for (std::size_t i = 0; i < ends_.size(); ++i) add(row, ends_[i], tangent, mask.edges[i]);
}

/// A mask on the umbrella after Catmull-Clark's first refinement, pulled back to the mesh: E' = (V + E + F_left + F_right)/4, sharp: (V + E)/2; F: face means.
/// A blend ratio below 1 draws all of the umbrella to V in proportion, which changes no direction; at 1 there is no umbrella left, and this is a choice.
void TangentRows::add_refined(Index v, const TangentMask& mask, int tangent, TangentRow& row) {
    std::vector<double> means = mask.faces;
    const std::size_t faces = means.size();
    for (std::size_t i = 0; i < ends_.size(); ++i) {
        const double part = mask.edges[i] / (sharp_[i] ? 2 : 4);
        add(row, v, tangent, part);
        add(row, ends_[i], tangent, part);
        if (sharp_[i]) continue;
        means[i] += part;
        means[(i + faces - 1) % faces] += part;
    }
    if (mask.vertex != 0) add_refined_vertex(v, mask.vertex, tangent, row);
    for (std::size_t i = 0; i < faces; ++i) add_mean(half_edges_[i], means[i], tangent, row);
}

void TangentRows::add_refined_vertex(Index v, double weight, int tangent, TangentRow& row) {
    if (features_.kind[v] == VertexKind::corner) return add(row, v, tangent, weight);
    if (!sector_.closed) {
        add(row, v, tangent, weight * 3 / 4);
        add(row, ends_.front(), tangent, weight / 8);
        add(row, ends_.back(), tangent, weight / 8);
        return;
    }
    const double n = sector_.faces, alpha = options_.alpha;
    add(row, v, tangent, weight * (n - 2 + alpha) / n);
    for (std::size_t i = 0; i < half_edges_.size(); ++i) {
        add(row, ends_[i], tangent, weight * (1 - alpha) / (n * n));
        add_mean(half_edges_[i], weight / (n * n), tangent, row);
    }
}

void TangentRows::add_mean(Index half_edge, double weight, int tangent, TangentRow& row) const {
    const Index face = topology_.half_edge_face[half_edge];
    for (Index c = topology_.face_offsets[face]; c < topology_.face_offsets[face + 1]; ++c)
        add(row, topology_.face_vertices[c], tangent, weight / topology_.degree(face));
}

/// The new point of a corner.
void TangentRows::add_doo_sabin_point(Index half_edge, double weight, int tangent, TangentRow& row) const {
    const int m = topology_.degree(topology_.half_edge_face[half_edge]);
    Index corner = half_edge;
    for (int j = 0; j < m; ++j, corner = topology_.next(corner))
        add(row, topology_.face_vertices[corner], tangent, weight * doo_sabin_weight(options_.mask, m, j));
}

/// C - V_inf: the first refinement's face at v has the points 3/4 V + 1/4 E_0, one in each face, 3/4 V + 1/4 E_k; V_inf is the middle between the first and the
/// last, C that of the two points that the second refinement puts next to them.
void TangentRows::add_doo_sabin_across(Index v, TangentRow& row) const {
    const int m = sector_.faces + 2;
    for (int j = 0; j < m; ++j) {
        const double weight = (doo_sabin_weight(options_.mask, m, j) + doo_sabin_weight(options_.mask, m, m - 1 - j)) / 2;
        if (j > 0 && j + 1 < m) {
            add_doo_sabin_point(half_edges_[j - 1], weight, 1, row);
            continue;
        }
        add(row, v, 1, (weight - 0.5) * 3 / 4);
        add(row, j == 0 ? ends_.front() : ends_.back(), 1, (weight - 0.5) / 4);
    }
}

}  // namespace lcl
