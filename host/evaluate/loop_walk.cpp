// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/loop_walk.h"

#include <algorithm>

#include "host/evaluate/kind_rows.h"

namespace lcl {
namespace {

/// Places in a regular patch's order of the six points round V, A and B, each from the next vertex of the face on.
constexpr int round_vertex[3][6] = {{5, 8, 7, 3, 0, 1}, {8, 4, 1, 2, 6, 9}, {4, 5, 9, 11, 10, 7}};
constexpr int vertex_place[3] = {4, 5, 8};

void add_row(Stencils& rows, std::initializer_list<std::pair<Index, double>> row) {
    for (const auto& [point, weight] : row) {
        rows.indices.push_back(point);
        rows.weights.push_back(weight);
    }
    rows.offsets.push_back(rows.indices.size());
}

}  // namespace

Index RefinedTriangles::origin(Index h) const {
    const Index first = h / 12 * 3, child = h % 12 / 3, i = h % 3;
    if (child < 3 && i == 0) return topology_.face_vertices[first + child];
    const Index edge = child == 3 ? i : i == 1 ? child : (child + 2) % 3;
    return topology_.vertex_count + topology_.half_edge_edge[first + edge];
}

Index RefinedTriangles::twin(Index h) const {
    const Index face = h / 12, child = h % 12 / 3, i = h % 3;
    if (child == 3) return 12 * face + 3 * ((i + 1) % 3) + 1;
    if (i == 1) return 12 * face + 9 + (child + 2) % 3;
    // The first half of a half-edge and the second one of its twin, which ends where that begins; or the other way round.
    const Index across = topology_.twin[3 * face + (i == 0 ? child : (child + 2) % 3)];
    if (across < 0) return -1;
    return i == 0 ? across / 3 * 12 + 3 * ((across + 1) % 3) + 2 : across / 3 * 12 + 3 * (across % 3);
}

bool RefinedTriangles::is_sharp(Index h) const {
    const Index face = h / 12, child = h % 12 / 3, i = h % 3;
    if (child == 3 || i == 1) return false;
    return features_.edge_is_sharp[topology_.half_edge_edge[3 * face + (i == 0 ? child : (child + 2) % 3)]] != 0;
}

VertexKind RefinedTriangles::kind(Index v) const {
    if (v < topology_.vertex_count) return features_.kind[v];
    return features_.edge_is_sharp[v - topology_.vertex_count] ? VertexKind::curve : VertexKind::smooth;
}

std::array<Index, 12> RefinedTriangles::smooth_points(Index h) const {
    return h % 12 < 9 ? smooth_corner_points(h / 12 * 3 + h % 12 / 3) : smooth_middle_points(h / 12);
}

/// Of the child at the corner of half-edge h of the mesh: the points of the six edges at V, and of those across from it.
std::array<Index, 12> RefinedTriangles::smooth_corner_points(Index h) const {
    const Index before = previous(h), below = topology_.twin[h], beside = topology_.twin[before];
    const Index to_left = previous(beside), left = topology_.twin[to_left], to_far = previous(left);
    return {edge_point(previous(topology_.twin[to_far])),  // j = -1
            edge_point(next(below)),
            edge_point(previous(below)),
            edge_point(to_far),  // 0
            topology_.face_vertices[h],
            edge_point(h),
            topology_.face_vertices[next(h)],
            edge_point(to_left),  // 1
            edge_point(before),
            edge_point(next(h)),
            edge_point(next(beside)),  // 2
            topology_.face_vertices[before]};
}

/// Of the middle child: the corners of its face, and the points of the faces across the three edges.
std::array<Index, 12> RefinedTriangles::smooth_middle_points(Index face) const {
    const Index h = 3 * face;
    const Index* const twins = &topology_.twin[h];
    const Index* const vertices = &topology_.face_vertices[h];
    return {edge_point(previous(twins[0])),  // j = -1
            vertices[1],
            edge_point(next(twins[1])),
            edge_point(next(twins[0])),  // 0
            edge_point(h),
            edge_point(h + 1),
            edge_point(previous(twins[1])),
            vertices[0],  // 1
            edge_point(h + 2),
            vertices[2],
            edge_point(previous(twins[2])),  // 2
            edge_point(next(twins[2]))};
}

LoopWalk::LoopWalk(const Topology& topology, const Features& features) : fine_(topology, features) {
    if (fine_.has_sharp_edges()) number_ghosts();
}

void LoopWalk::number_ghosts() {
    first_ghost_.assign(fine_.half_edge_count(), -1);
    for (Index h = 0; h < fine_.half_edge_count(); ++h) {
        if (!fine_.is_sharp(h)) continue;
        const Index a = fine_.origin(h), b = fine_.destination(h), before = fine_.previous(h);
        first_ghost_[h] = fine_.vertex_count() + static_cast<Index>(ghosts_.offsets.size()) - 1;
        add_row(ghosts_, {{a, 1}, {b, 1}, {fine_.origin(before), -1}});
        if (fine_.is_sharp(before)) add_row(ghosts_, {{a, 2}, {b, -1}});
        else if (fine_.is_sharp(fine_.next(h))) add_row(ghosts_, {{b, 2}, {a, -1}});
    }
}

bool LoopWalk::has_sharp_edge(Index h) const {
    Index e = h;
    do {
        if (fine_.is_sharp(fine_.previous(e))) return true;  // at a boundary, where the walk would fall off
        e = fine_.rotate(e);
    } while (e != h);
    return false;
}

/// No sharp feature at the three vertices of a child.
bool LoopWalk::is_smooth(Index h) const {
    if (!fine_.has_sharp_edges()) return true;  // marked corners are irregular
    for (int corner = 0; corner < 3; ++corner, h = fine_.next(h))
        if (fine_.kind(fine_.origin(h)) != VertexKind::smooth) return false;
    return true;
}

LoopWalk::Sector LoopWalk::sector_of(Index h) const {
    Sector sector{h, 0, 1};
    while (!fine_.is_sharp(sector.first)) {
        sector.first = fine_.next(fine_.twin(sector.first));
        ++sector.before;
    }
    Index last = h;
    for (; !fine_.is_sharp(fine_.previous(last)); ++sector.count) last = fine_.rotate(last);
    sector.count += sector.before;
    return sector;
}

LoopPlace LoopWalk::place(Index h) const {
    const Index v = fine_.origin(h), n = fine_.face_count(v);
    const VertexKind kind = fine_.kind(v);
    if (kind == VertexKind::smooth) return n == 6 ? LoopPlace{} : LoopPlace{LoopRound::smooth, n, 0};
    if (kind == VertexKind::corner && !has_sharp_edge(h)) return {LoopRound::corner, n, 0};
    const Sector sector = sector_of(h);
    if (kind == VertexKind::dart) return {LoopRound::dart, n, (n - sector.before) % n};
    const bool is_corner = kind == VertexKind::corner;
    if (sector.count == (is_corner ? 1 : 3)) return {};
    return {is_corner ? LoopRound::corner_sector : LoopRound::curve_sector, sector.count, sector.before};
}

/// The points round the origin of h on the lattice, from the next vertex of h's face on; of six triangles, three of a curve, or the one of a corner.
void LoopWalk::six_round(Index h, Index* six) const {
    if (fine_.kind(fine_.origin(h)) != VertexKind::smooth) return six_round_sector(h, six);
    for (int i = 0; i < 6; ++i) {
        six[i] = fine_.destination(h);
        h = fine_.rotate(h);
    }
}

void LoopWalk::six_round_sector(Index h, Index* six) const {
    const Sector sector = sector_of(h);
    const auto direction = [&](Index i) -> Index& { return six[(6 - sector.before + i) % 6]; };
    Index last = sector.first;
    for (Index i = 0; i < sector.count; ++i) {
        if (i > 0) last = fine_.rotate(last);
        direction(i) = fine_.destination(last);
    }
    const Index end = fine_.previous(last);
    direction(sector.count) = fine_.origin(end);
    direction(sector.count + 1) = first_ghost_[end];
    direction(5) = first_ghost_[sector.first];
    if (sector.count > 1) return;
    direction(3) = first_ghost_[sector.first] + 1;
    direction(4) = first_ghost_[end] + 1;
}

void LoopWalk::regular_points(Index h, Index* out) const {
    for (int corner = 0; corner < 3; ++corner, h = fine_.next(h)) {
        Index six[6];
        six_round(h, six);
        for (int i = 0; i < 6; ++i) out[round_vertex[corner][i]] = six[i];
        out[vertex_place[corner]] = fine_.origin(h);
    }
}

/// V and the ends of its edges; returns where the outer points go.
Index* LoopWalk::ring(Index h, const LoopPlace& place, Index* out) const {
    *out++ = fine_.origin(h);
    Index around = place.is_sector() ? sector_of(h).first : h;
    for (Index i = 0; i < place.count; ++i) {
        if (i > 0) around = fine_.rotate(around);
        *out++ = fine_.destination(around);
    }
    if (place.is_sector()) *out++ = fine_.origin(fine_.previous(around));
    return out;
}

void LoopWalk::points(Index h, const LoopPlace& place, Index* out) const {
    if (place.round == LoopRound::regular) {
        if (!is_smooth(h)) return regular_points(h, out);
        const std::array<Index, 12> smooth = fine_.smooth_points(h);
        std::copy(smooth.begin(), smooth.end(), out);
        return;
    }
    out = ring(h, place, out);
    const auto clockwise = [&](Index e) { return fine_.next(fine_.twin(e)); };
    const Index to_middle = clockwise(fine_.next(h)), to_right = clockwise(to_middle);  // from A to (1, 1) and to (2, 0)
    const Index from_b = fine_.rotate(fine_.rotate(fine_.previous(h)));                 // from B to (1, 1)
    if (!place.is_sector() || place.place > 0) *out++ = fine_.destination(clockwise(to_right));
    *out++ = fine_.destination(to_right);
    *out++ = fine_.destination(to_middle);
    *out++ = fine_.origin(fine_.previous(from_b));
    if (!place.is_sector() || place.place < place.count - 1) *out = fine_.origin(fine_.previous(fine_.rotate(from_b)));
}

namespace {

/// The triangles round V, A and B by the numbers of the kind's control points, with the sharp features that they have.
struct LoopSurroundings {
    explicit LoopSurroundings(const LoopPlace& place) : local(place.point_count()) {
        const Index n = place.count;
        const bool is_sector = place.is_sector(), has_right = !is_sector || place.place > 0, has_left = !is_sector || place.place < n - 1;
        const auto edge = [&](Index i) { return 1 + (is_sector ? i : (i + n) % n); };
        face = is_sector ? place.place : 0;
        for (Index i = 0; i < n; ++i) local.add({0, edge(i), edge(i + 1)});
        const Index a = edge(face), b = edge(face + 1), outer = n + (is_sector ? 2 : 1) + (has_right ? 1 : 0);
        const Index right = outer, middle = outer + 1, top = outer + 2;
        if (has_right) {
            local.add({a, outer - 1, right});
            local.add({a, edge(face - 1), outer - 1});
        }
        local.add({a, right, middle});
        local.add({a, middle, b});
        local.add({b, middle, top});
        if (has_left) {
            local.add({b, top, top + 1});
            local.add({b, top + 1, edge(face + 2)});
        }
        features.boundary = BoundaryRule::edge_only;
        if (place.round == LoopRound::corner || place.round == LoopRound::corner_sector) features.corners = {0};
        if (place.round != LoopRound::dart) return;
        features.creases.push_back({0, edge(place.place)});
        // The crease goes on where it leaves the ring; from other edges' ends on it does not matter.
        if (place.place == 0) features.creases.push_back({a, right});
        if (place.place == 1) features.creases.push_back({b, top});
    }

    LocalMesh local;
    FeatureOptions features;
    Index face;  ///< the patch's
};

}  // namespace

PatchKind loop_kind(const LoopPlace& place) {
    const LoopSurroundings around(place);
    const PolygonMesh& mesh = around.local.mesh();
    const Topology topology = build_topology(mesh);
    SchemeOptions options;
    options.scheme = Scheme::loop;
    const Features features = find_features(mesh, topology, around.features);
    const Stencils refined = refine_once(mesh, topology, features, options).stencils;
    const LoopWalk walk(topology, features);
    PatchKind kind;
    kind.point_count = place.point_count();
    std::vector<Index> child(kind.point_count);
    const Index children = 12 * around.face;  // their first half-edge: V's, A's, B's, the middle one
    walk.points(children, place, child.data());
    kind.step = dense_rows(refined, child, kind.point_count);
    // The cell at A begins at the edge point towards V, the middle one opposite to V, the one at B at the edge point towards V.
    const Index cells[3] = {children + 3 + 2, children + 9 + 1, children + 6 + 1};
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<Index> regular(12);
        walk.regular_points(cells[k], regular.data());
        kind.cells[k] = rows_with_ghosts(refined, walk.ghosts(), regular, kind.point_count);
    }
    if (place.round == LoopRound::smooth) kind.orbits = {{0, 1, 0}, {1, place.count, 0}};
    return kind;
}

}  // namespace lcl
