// SPDX-License-Identifier: BSD-3-Clause
// One patch for each face of the refined mesh, that is for each corner of the quad mesh that the last refinement starts from: patch h is the child at half-edge
// h, from the vertex V = origin(h). The refined mesh needs no topology of its own: its points are the vertices, edges and faces of the quad mesh. Of a patch's
// four vertices - V, the point of edge h, of the face, of the edge before h - only V can be irregular.
#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>

#include "host/evaluate/catmull_clark_kinds.h"
#include "host/evaluate/patch_table.h"
#include "host/mesh/face_walk.h"
#include "host/parallel.h"

namespace lcl {
namespace {

using Ring = CatmullClarkPlace::Ring;

/// Turns by 0 to 3 quarters of a patch that is `scale` times smaller than the parameters' square.
void add_turns(double scale, std::vector<ParameterTurn>& turns) {
    turns.push_back({scale, 0, 0, scale});
    turns.push_back({0, -scale, scale, 0});
    turns.push_back({-scale, 0, 0, -scale});
    turns.push_back({0, scale, -scale, 0});
}

/// Numbers of the refined points by what they lie on in the quad mesh, and the steps between its half-edges.
class RefinedNumbers : public QuadWalk {
public:
    explicit RefinedNumbers(const Topology& quads) : quads_(quads), edges_(quads.vertex_count), faces_(quads.vertex_count + quads.edge_count) {}

    Index twin(Index h) const { return quads_.twin[h]; }
    Index vertex(Index h) const { return quads_.face_vertices[h]; }  ///< the origin of h
    Index edge(Index h) const { return edges_ + quads_.half_edge_edge[h]; }
    Index face_of(Index h) const { return faces_ + face(h); }
    Index opposite(Index h) const { return h ^ 2; }  ///< the half-edge across the quad
    Index rotate(Index h) const { return quads_.twin[previous(h)]; }

private:
    const Topology& quads_;
    Index edges_, faces_;
};

/// The points (2, 0), (2, 1), (2, 2), (1, 2), (0, 2) of patch h: the far sides of its quad.
std::array<Index, 5> far_points(const RefinedNumbers& at, Index h) {
    const Index right = at.next(h), top = at.opposite(h);
    return {at.vertex(right), at.edge(right), at.vertex(top), at.edge(top), at.vertex(at.previous(h))};
}
/// (2, -1): over the edge of h. (-1, 2): over the edge before h.
Index point_below(const RefinedNumbers& at, Index h) { return at.edge(at.previous(at.twin(h))); }
Index point_beside(const RefinedNumbers& at, Index h) { return at.edge(at.next(at.rotate(h))); }

void write_regular(const RefinedNumbers& at, Index h, Index* out) {
    const Index before = at.previous(h), below = at.twin(h), beside = at.twin(before), across = at.twin(at.previous(beside));
    const std::array<Index, 5> far = far_points(at, h);
    const std::array<Index, 16> points{at.face_of(across),
                                       at.edge(at.next(below)),
                                       at.face_of(below),
                                       point_below(at, h),  // j = -1
                                       at.edge(across),
                                       at.vertex(h),
                                       at.edge(h),
                                       far[0],  // 0
                                       at.face_of(beside),
                                       at.edge(before),
                                       at.face_of(h),
                                       far[1],  // 1
                                       point_beside(at, h),
                                       far[4],
                                       far[3],
                                       far[2]};  // 2
    std::copy(points.begin(), points.end(), out);
}

/// A closed ring of n faces.
void write_closed(const RefinedNumbers& at, Index h, Index n, Index* out) {
    *out = at.vertex(h);
    Index* const edges = out + 1;
    Index* const faces = edges + n;
    Index around = h;
    for (Index j = 0; j < n; ++j) {
        edges[j] = at.edge(around);
        faces[j] = at.face_of(around);
        around = at.rotate(around);
    }
    Index* outer = faces + n;
    *outer++ = point_below(at, h);
    for (const Index point : far_points(at, h)) *outer++ = point;
    *outer = point_beside(at, h);
}

/// The patches at a vertex with sharp features: where each lies.
struct SharpPatch {
    Index half_edge;
    Index sector_begin;  ///< half-edge of the sector's first face; of closed rings the patch's own
    CatmullClarkPlace place;
    bool is_regular() const { return place.ring == Ring::sector && place.faces == (place.is_corner ? 1 : 2); }
};

void write_sector(const RefinedNumbers& at, const SharpPatch& patch, Index* out) {
    const int k = patch.place.faces, place = patch.place.place;
    *out = at.vertex(patch.half_edge);
    Index* const edges = out + 1;
    Index* const faces = edges + k + 1;
    Index around = patch.sector_begin;
    for (int j = 0; j < k; ++j) {
        edges[j] = at.edge(around);
        faces[j] = at.face_of(around);
        edges[j + 1] = at.edge(at.previous(around));
        around = at.rotate(around);
    }
    Index* outer = faces + k;
    if (place > 0) *outer++ = point_below(at, patch.half_edge);
    for (const Index point : far_points(at, patch.half_edge)) *outer++ = point;
    if (place < k - 1) *outer = point_beside(at, patch.half_edge);
}

/// Points across sharp edges, each once: 2 P - P_inner.
class Ghosts {
public:
    Ghosts(const RefinedNumbers& at, Index refined_count, Stencils& rows) : at_(at), refined_count_(refined_count), rows_(rows) {}

    /// Across the sharp edge of h, opposite to its face's point.
    Index of_edge(Index h) { return find(at_.edge(h), at_.face_of(h)); }
    /// Opposite to the point of h's edge at the vertex where h begins, or ends.
    Index of_origin(Index h) { return find(at_.vertex(h), at_.edge(h)); }
    Index of_end(Index h) { return find(at_.vertex(at_.next(h)), at_.edge(h)); }
    /// Of a corner with the face of h alone: reflected both ways.
    Index of_corner(Index h) { return add({{at_.vertex(h), 4}, {at_.edge(h), -2}, {at_.edge(at_.previous(h)), -2}, {at_.face_of(h), 1}}); }

private:
    Index find(Index point, Index inner) {
        const auto [found, is_new] = known_.try_emplace(static_cast<std::uint64_t>(point) << 32 | static_cast<std::uint32_t>(inner), 0);
        if (is_new) found->second = add({{point, 2}, {inner, -1}});
        return found->second;
    }
    Index add(std::initializer_list<std::pair<Index, double>> row) {
        for (const auto& [point, weight] : row) {
            rows_.indices.push_back(point);
            rows_.weights.push_back(weight);
        }
        rows_.offsets.push_back(rows_.indices.size());
        return refined_count_ + static_cast<Index>(rows_.offsets.size()) - 2;
    }

    const RefinedNumbers& at_;
    Index refined_count_;
    Stencils& rows_;
    std::unordered_map<std::uint64_t, Index> known_;
};

/// A curve's two faces or a corner's one.
void write_regular_at_sharp_edge(const RefinedNumbers& at, Ghosts& ghosts, const SharpPatch& patch, Index* out) {
    const Index h = patch.half_edge, before = at.previous(h);
    const bool below_is_sharp = patch.place.place == 0, beside_is_sharp = patch.place.place == patch.place.faces - 1;
    const auto point = [&](int x, int y) -> Index& { return out[4 * (y + 1) + x + 1]; };
    const std::array<Index, 5> far = far_points(at, h);
    point(0, 0) = at.vertex(h), point(1, 0) = at.edge(h), point(1, 1) = at.face_of(h), point(0, 1) = at.edge(before);
    point(2, 0) = far[0], point(2, 1) = far[1], point(2, 2) = far[2], point(1, 2) = far[3], point(0, 2) = far[4];
    if (below_is_sharp) {
        point(0, -1) = ghosts.of_end(before);
        point(1, -1) = ghosts.of_edge(h);
        point(2, -1) = ghosts.of_origin(at.next(h));
    } else {
        const Index below = at.twin(h);
        point(0, -1) = at.edge(at.next(below)), point(1, -1) = at.face_of(below), point(2, -1) = point_below(at, h);
    }
    if (beside_is_sharp) {
        point(-1, 0) = ghosts.of_origin(h);
        point(-1, 1) = ghosts.of_edge(before);
        point(-1, 2) = ghosts.of_end(at.opposite(h));
    } else {
        const Index beside = at.twin(before);
        point(-1, 0) = at.edge(at.previous(beside)), point(-1, 1) = at.face_of(beside), point(-1, 2) = point_beside(at, h);
    }
    if (below_is_sharp && beside_is_sharp) point(-1, -1) = ghosts.of_corner(h);
    else if (below_is_sharp) point(-1, -1) = ghosts.of_edge(at.previous(at.twin(before)));
    else point(-1, -1) = ghosts.of_edge(at.next(at.twin(h)));
}

/// The patches of a quad mesh, from where refinement goes on once.
class PatchBuilder {
public:
    PatchBuilder(const Topology& quads, const Features& features, PatchTable& table) : quads_(quads), features_(features), at_(quads), table_(table) {}

    void build() {
        classify();
        count();
        write();
    }

private:
    void classify() {
        table_.kind.assign(quads_.half_edge_count(), -1);
        for (Index v = 0; v < quads_.vertex_count; ++v) {
            if (features_.kind[v] == VertexKind::isolated) continue;
            if (features_.kind[v] == VertexKind::smooth) classify_smooth(v);
            else classify_sharp(v);
        }
    }

    void classify_smooth(Index v) {
        const Index n = quads_.vertex_face_count[v];
        if (n == 4) return;
        const std::int32_t kind = kind_of({Ring::closed, false, n, 0, -1});
        for (Index i = quads_.fan_offsets[v]; i < quads_.fan_offsets[v + 1]; ++i) table_.kind[quads_.fan_half_edges[i]] = kind;
    }

    /// Closed rings are kept whole where no or one sharp edge ends at a vertex that moves; all else falls into sectors.
    void classify_sharp(Index v) {
        const Index* const fan = quads_.fan_half_edges.data() + quads_.fan_offsets[v];
        const Index n = quads_.vertex_face_count[v];
        const bool is_corner = features_.kind[v] == VertexKind::corner;
        std::vector<Index> starts;  // places in the fan of the sectors' first faces
        for (Index i = 0; i < n; ++i)
            if (features_.edge_is_sharp[quads_.half_edge_edge[fan[i]]]) starts.push_back(i);
        if (starts.empty() || (starts.size() == 1 && features_.kind[v] == VertexKind::dart)) {
            for (Index i = 0; i < n; ++i) {
                const int sharp_edge = starts.empty() ? -1 : (starts[0] - i + n) % n;
                add_sharp({fan[i], fan[i], {Ring::closed, is_corner, n, 0, sharp_edge}});
            }
            return;
        }
        for (std::size_t s = 0; s < starts.size(); ++s) {
            const Index begin = starts[s], end = s + 1 < starts.size() ? starts[s + 1] : starts[0] + n;
            for (Index i = begin; i < end; ++i) add_sharp({fan[i % n], fan[begin], {Ring::sector, is_corner, end - begin, i - begin, -1}});
        }
    }

    void add_sharp(const SharpPatch& patch) {
        if (!patch.is_regular()) table_.kind[patch.half_edge] = kind_of(patch.place);
        sharp_.push_back(patch);
    }

    std::int32_t kind_of(const CatmullClarkPlace& place) {
        const std::tuple key{place.ring, place.is_corner, place.faces, place.place, place.sharp_edge};
        const auto [found, is_new] = kinds_.try_emplace(key, static_cast<std::int32_t>(table_.kinds.size()));
        if (is_new) table_.kinds.push_back(catmull_clark_kind(place));
        return found->second;
    }

    void count() {
        const Index patches = quads_.half_edge_count();
        std::int64_t next = 0;
        table_.patch_begin.resize(patches + 1);
        for (Index p = 0; p < patches; ++p) {
            table_.patch_begin[p] = static_cast<Index>(next);
            next += table_.kind[p] < 0 ? 16 : table_.kinds[table_.kind[p]].point_count;
            check_control_count(next);
        }
        table_.patch_begin[patches] = static_cast<Index>(next);
        table_.control.resize(next);
    }

    void write() {
        parallel_for(quads_.half_edge_count(), [&](std::size_t begin, std::size_t end) {
            for (Index h = static_cast<Index>(begin); h < static_cast<Index>(end); ++h) {
                const Index v = quads_.face_vertices[h];
                if (features_.kind[v] != VertexKind::smooth) continue;
                Index* const out = table_.control.data() + table_.patch_begin[h];
                if (table_.kind[h] < 0) write_regular(at_, h, out);
                else write_closed(at_, h, quads_.vertex_face_count[v], out);
            }
        });
        Ghosts ghosts(at_, table_.refined_count(), table_.ghosts);
        for (const SharpPatch& patch : sharp_) {
            Index* const out = table_.control.data() + table_.patch_begin[patch.half_edge];
            if (patch.place.ring == Ring::closed) write_closed(at_, patch.half_edge, patch.place.faces, out);
            else if (patch.is_regular()) write_regular_at_sharp_edge(at_, ghosts, patch, out);
            else write_sector(at_, patch, out);
        }
    }

    const Topology& quads_;
    const Features& features_;
    RefinedNumbers at_;
    PatchTable& table_;
    std::map<std::tuple<Ring, bool, int, int, int>, std::int32_t> kinds_;
    std::vector<SharpPatch> sharp_;
};

/// Quarter of the unit square: of its corner c, from which s and t run.
struct Quarter {
    Index corner;
    double s, t;
};

/// Without branches, which random places would mispredict.
Quarter quarter_of(double u, double v) {
    const int right = u > 0.5, upper = v > 0.5, odd = right ^ upper;
    const std::array<double, 2> along{2 * std::min(u, 1 - u), 2 * std::min(v, 1 - v)};
    return {odd | upper << 1, along[odd], along[odd ^ 1]};
}

std::string shortest(double x) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

[[noreturn]] void refuse(const PatchTable& table, const Places& places, std::size_t i) {
    check_face(table, places, i);
    const Where where{{}, {places.faces[i]}};
    if (table.degree(places.faces[i]) == 4 && places.corner(i) != 0)
        throw BadInput(place_name(i) + corner_name(places, i) + " does not exist: on a quad the corner is 0 and (u, v) runs over the whole face", where);
    check_corner(table, places, i);
    throw BadInput(place_name(i) + "(u, v) = (" + shortest(places.uv[2 * i]) + ", " + shortest(places.uv[2 * i + 1]) + ") does not lie on face " +
                       std::to_string(places.faces[i]) + ": both run from 0 to 1",
                   where);
}

bool in_unit_square(double u, double v) { return static_cast<int>(u >= 0) & static_cast<int>(u <= 1) & static_cast<int>(v >= 0) & static_cast<int>(v <= 1); }

bool exists(const PatchTable& table, const Places& places, std::size_t i) {
    const Index face = places.faces[i];
    if (face < 0 || face >= table.face_count()) return false;
    const Index degree = table.degree(face), corner = places.corner(i);
    return corner >= 0 && corner < (degree == 4 ? 1 : degree) && in_unit_square(places.uv[2 * i], places.uv[2 * i + 1]);
}

/// All faces are quads: each has four patches. False where a place does not exist.
bool locate_on_quads(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out) {
    const auto faces = static_cast<std::uint32_t>(table.face_count());
    bool good = true;
    for (std::size_t i = begin; i < end; ++i, ++out) {
        const double u = places.uv[2 * i], v = places.uv[2 * i + 1];
        const Index face = places.faces[i];
        const bool is_face = static_cast<std::uint32_t>(face) < faces, is_inside = in_unit_square(u, v);
        good &= is_face & is_inside;
        const Quarter quarter = quarter_of(u, v);
        out->s = quarter.s;
        out->t = quarter.t;
        out->patch = static_cast<Index>(4 * static_cast<std::uint32_t>(face)) + quarter.corner;
        out->turn = quarter.corner;
    }
    if (places.corners)
        for (std::size_t i = begin; i < end; ++i) good &= places.corners[i] == 0;
    return good;
}

bool locate_on_polygons(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out) {
    for (std::size_t i = begin; i < end; ++i, ++out) {
        if (!exists(table, places, i)) return false;
        const double u = places.uv[2 * i], v = places.uv[2 * i + 1];
        const Index face = places.faces[i], corner = places.corner(i), first = table.face_begin[face];
        const bool is_quad = table.degree(face) == 4;
        // Of the quads that the first refinement makes, then of the patches of that one.
        const Quarter quad = is_quad ? quarter_of(u, v) : Quarter{corner, u, v};
        const Quarter quarter = quarter_of(quad.s, quad.t);
        *out = {quarter.s, quarter.t, 4 * (first + quad.corner) + quarter.corner, is_quad ? 4 + ((quad.corner + quarter.corner) & 3) : quarter.corner};
    }
    return true;
}

}  // namespace

void add_catmull_clark_patches(const Topology& topology, const Features& features, const SchemeOptions& options, PatchTable& table) {
    const bool all_quads = topology.uniform_degree == 4;
    table.refiner = std::make_shared<Refiner>(topology, features, options, all_quads ? 1 : 2);
    table.face_begin.assign(topology.face_offsets.begin(), topology.face_offsets.end());
    add_turns(2, table.turns);
    if (!all_quads) add_turns(4, table.turns);
    const RefinerStep& last = table.refiner->steps().back();
    PatchBuilder(last.topology, last.features, table).build();
}

void locate_catmull_clark(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out) {
    const bool good = table.levels() == 1 ? locate_on_quads(table, places, begin, end, out) : locate_on_polygons(table, places, begin, end, out);
    for (std::size_t i = begin; !good && i < end; ++i)
        if (!exists(table, places, i)) refuse(table, places, i);
}

}  // namespace lcl
