// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numeric>

#include "host/mesh/soundness.h"
#include "host/parallel.h"

namespace lcl {
namespace {

constexpr std::size_t places_kept = 10;

/// Collects the places of one kind of defect and words the sentence of the first.
class Collector {
public:
    Collector(DefectKind kind, const char* plural) : plural_(plural) { defect_.kind = kind; }

    bool is_first() const { return count_ == 0; }

    template <class Faces>
    void add(std::initializer_list<Index> vertices, const Faces& faces) {
        ++count_;
        keep(vertices, defect_.where.vertices);
        keep(faces, defect_.where.faces);
    }
    void add(std::initializer_list<Index> vertices, std::initializer_list<Index> faces) { add<std::initializer_list<Index>>(vertices, faces); }

    void set_message(const std::string& found, const std::string& cure) { found_ = found, cure_ = cure; }

    void append_to(std::vector<Defect>& defects) {
        if (count_ == 0) return;
        defect_.count = static_cast<Index>(std::min<std::size_t>(count_, std::numeric_limits<Index>::max()));
        defect_.message = found_ + (count_ > 1 ? " (the first of " + std::to_string(count_) + " " + plural_ + ")" : "") + ": " + cure_;
        defects.push_back(std::move(defect_));
    }

private:
    template <class Items>
    static void keep(const Items& from, std::vector<Index>& to) {
        for (const Index i : from)
            if (to.size() < places_kept && std::find(to.begin(), to.end(), i) == to.end()) to.push_back(i);
    }

    Defect defect_{};
    const char* plural_;
    std::size_t count_ = 0;
    std::string found_, cure_;
};

std::string text(Index i) { return std::to_string(i); }

std::string list(const std::vector<Index>& items) {
    std::string out;
    for (std::size_t i = 0; i < items.size() && i < places_kept; ++i) out += (i ? ", " : "") + text(items[i]);
    return out + (items.size() > places_kept ? ", .." : "");
}

std::string edge_name(Index a, Index b) { return text(std::min(a, b)) + "-" + text(std::max(a, b)); }

/// The corners of a face; none where its offsets do not fit the list of corners.
struct FaceCorners {
    const Index* begin;
    const Index* end;
    Index size() const { return static_cast<Index>(end - begin); }
};

bool offsets_fit(const PolygonMesh& mesh, Index f) {
    const Index begin = mesh.face_offsets[f], end = mesh.face_offsets[f + 1];
    return begin >= 0 && begin <= end && static_cast<std::size_t>(end) <= mesh.face_vertices.size();
}

FaceCorners corners_of(const PolygonMesh& mesh, Index f) {
    const Index* all = mesh.face_vertices.data();
    if (!offsets_fit(mesh, f)) return {all, all};
    return {all + mesh.face_offsets[f], all + mesh.face_offsets[f + 1]};
}

bool offsets_span(const PolygonMesh& mesh) {
    return mesh.face_offsets.front() == 0 && static_cast<std::size_t>(mesh.face_offsets.back()) == mesh.face_vertices.size();
}

bool in_range(const PolygonMesh& mesh, Index v) { return v >= 0 && v < mesh.vertex_count; }

/// The first vertex that a face has twice, or -1. `last_face` holds, per vertex, the last face seen there; small faces do without.
Index repeated_vertex(const FaceCorners& corners, Index face, Index vertex_count, std::vector<Index>& last_face) {
    if (corners.size() <= 8) {
        for (const Index* a = corners.begin; a != corners.end; ++a)
            if (std::find(a + 1, corners.end, *a) != corners.end) return *a;
        return -1;
    }
    if (last_face.empty()) last_face.assign(vertex_count, -1);
    for (const Index* a = corners.begin; a != corners.end; ++a) {
        if (*a < 0 || *a >= vertex_count) continue;
        if (last_face[*a] == face) return *a;
        last_face[*a] = face;
    }
    return -1;
}

/// index_range, repeated_vertex and short_face; marks the faces that have one.
std::vector<char> find_corner_defects(const PolygonMesh& mesh, std::vector<Defect>& defects) {
    Collector range(DefectKind::index_range, "such corners"), repeated(DefectKind::repeated_vertex, "such faces"), few(DefectKind::short_face, "such faces");
    std::vector<char> bad(mesh.face_count(), 0);
    std::vector<Index> last_face;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const FaceCorners corners = corners_of(mesh, f);
        for (const Index* v = corners.begin; v != corners.end; ++v) {
            if (in_range(mesh, *v)) continue;
            if (range.is_first())
                range.set_message("face " + text(f) + " uses vertex " + text(*v) + ", the mesh has " + text(mesh.vertex_count),
                                  "correct the index or remove the face");
            range.add({*v}, {f});
            bad[f] = 1;
        }
        if (const Index twice = repeated_vertex(corners, f, mesh.vertex_count, last_face); twice >= 0) {
            if (repeated.is_first())
                repeated.set_message("face " + text(f) + " uses vertex " + text(twice) + " more than once", "remove the corner or the face");
            repeated.add({twice}, {f});
            bad[f] = 1;
        }
        if (corners.size() < 3) {
            const std::string found =
                offsets_fit(mesh, f) ? "has " + text(corners.size()) + " corners, fewer than 3" : "has offsets outside the list of corners";
            if (few.is_first()) few.set_message("face " + text(f) + " " + found, "remove the face");
            few.add({}, {f});
            bad[f] = 1;
        }
    }
    if (range.is_first() && !offsets_span(mesh)) {
        range.set_message("the faces' offsets do not span the list of " + std::to_string(mesh.face_vertices.size()) + " corners",
                          "make them begin at 0 and end there");
        range.add({}, {});
    }
    range.append_to(defects);
    repeated.append_to(defects);
    few.append_to(defects);
    return bad;
}

/// Half-edges in buckets by their lower vertex; inside a bucket in ascending order. A bucket plus one mark per vertex finds all half-edges of an edge in
/// linear time, also at a pole of any valence and without hashing.
struct HalfEdgeBuckets {
    struct Entry {
        Index half_edge;
        Index higher;  ///< the other, higher vertex
    };
    std::vector<Index> offsets;  ///< vertex_count + 1
    std::vector<Entry> entries;
};

/// Buckets of all half-edges of the faces that are not bad; their vertices are in range.
HalfEdgeBuckets bucket_half_edges(const PolygonMesh& mesh, const std::vector<char>& bad) {
    const auto for_each = [&](auto&& visit) {
        for (Index f = 0; f < mesh.face_count(); ++f) {
            if (bad[f]) continue;
            const Index begin = mesh.face_offsets[f], last = mesh.face_offsets[f + 1] - 1;
            for (Index h = begin; h < last; ++h) visit(h, mesh.face_vertices[h], mesh.face_vertices[h + 1]);
            visit(last, mesh.face_vertices[last], mesh.face_vertices[begin]);
        }
    };
    HalfEdgeBuckets buckets;
    // Counted two places further on, so that filling moves each place on to what it has to be in the end.
    auto& offsets = buckets.offsets;
    offsets.assign(mesh.vertex_count + std::size_t{2}, 0);
    for_each([&](Index, Index a, Index b) { ++offsets[std::min(a, b) + std::size_t{2}]; });
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    buckets.entries.resize(offsets.back());
    for_each([&](Index h, Index a, Index b) { buckets.entries[offsets[std::min(a, b) + 1]++] = {h, std::max(a, b)}; });
    offsets.pop_back();
    return buckets;
}

/// All half-edges of the sound faces by edge: those of edge e are half_edges[offsets[e]] .., ascending; edges by first appearance.
struct EdgeGroups {
    std::vector<Index> offsets, half_edges;
    Index count() const { return static_cast<Index>(offsets.size()) - 1; }
};

EdgeGroups group_by_edge(const PolygonMesh& mesh, const std::vector<char>& bad) {
    const HalfEdgeBuckets buckets = bucket_half_edges(mesh, bad);
    std::vector<Index> mark(mesh.vertex_count, -1), first(mesh.face_vertices.size(), -1);
    for (Index v = 0; v < mesh.vertex_count; ++v) {
        for (Index i = buckets.offsets[v]; i < buckets.offsets[v + 1]; ++i) {
            const auto [h, higher] = buckets.entries[i];
            const bool met = mark[higher] >= buckets.offsets[v];
            if (!met) mark[higher] = i;
            first[h] = buckets.entries[mark[higher]].half_edge;  // the lowest, since buckets ascend
        }
    }
    std::vector<Index> edge(first.size(), -1);
    Index count = 0;
    for (std::size_t h = 0; h < first.size(); ++h)
        if (first[h] >= 0) edge[h] = first[h] == static_cast<Index>(h) ? count++ : edge[first[h]];
    EdgeGroups groups;
    groups.offsets.assign(count + std::size_t{2}, 0);
    for (const Index e : edge)
        if (e >= 0) ++groups.offsets[e + std::size_t{2}];
    std::partial_sum(groups.offsets.begin(), groups.offsets.end(), groups.offsets.begin());
    groups.half_edges.resize(groups.offsets.back());
    for (std::size_t h = 0; h < edge.size(); ++h)
        if (edge[h] >= 0) groups.half_edges[groups.offsets[edge[h] + 1]++] = static_cast<Index>(h);
    groups.offsets.pop_back();
    return groups;
}

/// The connectivity of a mesh that may be no manifold: what each half-edge needs to know.
struct LooseHalfEdges {
    const PolygonMesh& mesh;
    std::vector<Index> face;

    explicit LooseHalfEdges(const PolygonMesh& m, const std::vector<char>& bad) : mesh(m), face(m.face_vertices.size(), -1) {
        for (Index f = 0; f < m.face_count(); ++f)
            if (!bad[f]) std::fill(face.begin() + m.face_offsets[f], face.begin() + m.face_offsets[f + 1], f);
    }
    Index origin(Index h) const { return mesh.face_vertices[h]; }
    Index next(Index h) const { return h + 1 < mesh.face_offsets[face[h] + 1] ? h + 1 : mesh.face_offsets[face[h]]; }
    Index destination(Index h) const { return origin(next(h)); }
};

void find_edge_defects(const LooseHalfEdges& half_edges, const EdgeGroups& groups, Collector& crowded, Collector& orientation) {
    for (Index e = 0; e < groups.count(); ++e) {
        const Index* begin = &groups.half_edges[groups.offsets[e]];
        const Index size = groups.offsets[e + 1] - groups.offsets[e];
        const Index a = half_edges.origin(*begin), b = half_edges.destination(*begin);
        if (size > 2) {
            std::vector<Index> faces;
            for (Index i = 0; i < size; ++i) faces.push_back(half_edges.face[begin[i]]);
            if (crowded.is_first())
                crowded.set_message(
                    "edge " + edge_name(a, b) + " belongs to " + text(size) + " faces (" + list(faces) + "), a manifold mesh has at most two at an edge",
                    "remove faces or give them their own copies of the edge's vertices");
            crowded.add({std::min(a, b), std::max(a, b)}, faces);
        } else if (size == 2 && half_edges.origin(begin[1]) == a) {
            const Index f = half_edges.face[begin[0]], g = half_edges.face[begin[1]];
            if (orientation.is_first())
                orientation.set_message(
                    "faces " + text(f) + " and " + text(g) + " run along edge " + edge_name(a, b) + " in the same direction, so their orientations disagree",
                    "reverse the order of the vertices in one of them");
            orientation.add({std::min(a, b), std::max(a, b)}, {f, g});
        }
    }
}

/// Vertices whose corners fall into more than one group when those that share an edge are joined.
void find_vertex_defects(const LooseHalfEdges& half_edges, const EdgeGroups& groups, Collector& vertices) {
    std::vector<Index> parent(half_edges.face.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](Index c) {
        while (parent[c] != c) c = parent[c] = parent[parent[c]];
        return c;
    };
    const auto corner_at = [&](Index h, Index v) { return half_edges.origin(h) == v ? h : half_edges.next(h); };
    for (Index e = 0; e < groups.count(); ++e) {
        const Index first = groups.half_edges[groups.offsets[e]];
        for (const Index v : {half_edges.origin(first), half_edges.destination(first)}) {
            for (Index i = groups.offsets[e] + 1; i < groups.offsets[e + 1]; ++i) {
                const Index a = root(corner_at(first, v)), b = root(corner_at(groups.half_edges[i], v));
                parent[std::max(a, b)] = std::min(a, b);
            }
        }
    }
    std::vector<Index> first_fan(half_edges.mesh.vertex_count, -1), second_fan(half_edges.mesh.vertex_count, -1), fans(half_edges.mesh.vertex_count, 0);
    for (Index c = 0; c < static_cast<Index>(parent.size()); ++c) {
        if (half_edges.face[c] < 0 || parent[c] != c) continue;
        const Index v = half_edges.origin(c);
        if (++fans[v] <= 2) (fans[v] == 1 ? first_fan : second_fan)[v] = half_edges.face[c];
    }
    for (Index v = 0; v < half_edges.mesh.vertex_count; ++v) {
        if (fans[v] < 2) continue;
        if (vertices.is_first())
            vertices.set_message("vertex " + text(v) + " joins " + text(fans[v]) + " fans of faces that share no edge there, with faces " + text(first_fan[v]) +
                                     " and " + text(second_fan[v]) + " in different ones",
                                 "give each fan its own copy of the vertex");
        vertices.add({v}, {first_fan[v], second_fan[v]});
    }
}

void find_connectivity_defects(const PolygonMesh& mesh, const std::vector<char>& bad, bool corners_sound, std::vector<Defect>& defects) {
    if (corners_sound) {
        Topology topology;
        if (connect(mesh, topology)) return;
    }
    const LooseHalfEdges half_edges(mesh, bad);
    const EdgeGroups groups = group_by_edge(mesh, bad);
    Collector crowded(DefectKind::edge_with_three_faces, "such edges"), vertices(DefectKind::non_manifold_vertex, "such vertices");
    Collector orientation(DefectKind::orientation, "such edges");
    find_edge_defects(half_edges, groups, crowded, orientation);
    find_vertex_defects(half_edges, groups, vertices);
    crowded.append_to(defects);
    vertices.append_to(defects);
    orientation.append_to(defects);
}

void find_position_defects(const PolygonMesh& mesh, std::vector<Defect>& defects) {
    if (positions_are_finite(mesh)) return;
    Collector collector(DefectKind::not_finite, "such vertices");
    for (std::size_t v = 0; v < mesh.positions.size() / 3; ++v) {
        for (int c = 0; c < 3; ++c) {
            const double x = mesh.positions[3 * v + c];
            if (std::isfinite(x)) continue;
            const Index vertex = static_cast<Index>(v);
            if (collector.is_first())
                collector.set_message("vertex " + text(vertex) + " has " + "xyz"[c] + " = " +
                                          (std::isnan(x) ? "nan"
                                           : x > 0       ? "inf"
                                                         : "-inf") +
                                          ", which is not finite",
                                      "correct the coordinate");
            collector.add({vertex}, {});
            break;
        }
    }
    collector.append_to(defects);
}

/// Newell's area vector against the largest extent of the face: 1e-14 of its square is what rounding leaves of a face that has no area.
bool has_no_area(const PolygonMesh& mesh, const FaceCorners& corners) {
    const double* origin = &mesh.positions[3 * static_cast<std::size_t>(*corners.begin)];
    double extent = 0, area[3] = {0, 0, 0}, previous[3] = {0, 0, 0};
    for (const Index* v = corners.begin; v != corners.end; ++v)
        for (int c = 0; c < 3; ++c) extent = std::max(extent, std::abs(mesh.positions[3 * static_cast<std::size_t>(*v) + c] - origin[c]));
    if (extent == 0) return true;
    for (const Index* v = corners.begin; v != corners.end; ++v) {
        double p[3];
        for (int c = 0; c < 3; ++c) p[c] = (mesh.positions[3 * static_cast<std::size_t>(*v) + c] - origin[c]) / extent;
        for (int c = 0; c < 3; ++c) area[c] += previous[(c + 1) % 3] * p[(c + 2) % 3] - previous[(c + 2) % 3] * p[(c + 1) % 3];
        std::copy(p, p + 3, previous);
    }
    return std::hypot(area[0], area[1], area[2]) / 2 < 1e-14;
}

/// Much more area than has_no_area lets pass, and sizes whose squares are no trouble: true of nearly every face, and quick to see.
bool surely_has_area(const PolygonMesh& mesh, const FaceCorners& corners) {
    const double* origin = &mesh.positions[3 * static_cast<std::size_t>(*corners.begin)];
    double extent = 0, area[3] = {0, 0, 0}, previous[3] = {0, 0, 0};
    for (const Index* v = corners.begin + 1; v != corners.end; ++v) {
        const double* point = &mesh.positions[3 * static_cast<std::size_t>(*v)];
        const double p[3] = {point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]};
        extent += p[0] * p[0] + p[1] * p[1] + p[2] * p[2];  // more than the largest square
        area[0] += previous[1] * p[2] - previous[2] * p[1];
        area[1] += previous[2] * p[0] - previous[0] * p[2];
        area[2] += previous[0] * p[1] - previous[1] * p[0];
        for (int c = 0; c < 3; ++c) previous[c] = p[c];
    }
    const double square = area[0] * area[0] + area[1] * area[1] + area[2] * area[2];
    return extent > 1e-100 && extent < 1e100 && square > 1e-26 * extent * extent;
}

/// Faces without area, of those whose corners are `usable`.
template <class Usable>
void find_area_defects(const PolygonMesh& mesh, const Usable& usable, std::vector<Defect>& defects) {
    if (mesh.positions.size() < 3 * static_cast<std::size_t>(mesh.vertex_count)) return;
    const std::size_t pieces = piece_count(mesh.face_count());
    std::vector<std::vector<Index>> flat(pieces);
    for_each_piece(mesh.face_count(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        for (Index f = static_cast<Index>(begin); f < static_cast<Index>(end); ++f) {
            if (!usable(f)) continue;
            const FaceCorners corners = corners_of(mesh, f);
            if (!surely_has_area(mesh, corners) && has_no_area(mesh, corners)) flat[piece].push_back(f);
        }
    });
    Collector collector(DefectKind::zero_area, "such faces");
    for (const std::vector<Index>& faces : flat)
        for (const Index f : faces) {
            if (collector.is_first()) collector.set_message("face " + text(f) + " has no area", "it is accepted, but has no normal of its own");
            collector.add({}, {f});
        }
    collector.append_to(defects);
}

/// Sums of x * 0, which is 0 for finite x, else nan; four at once.
bool all_finite(const double* begin, const double* end) {
    double sums[4] = {0, 0, 0, 0};
    for (; end - begin >= 4; begin += 4)
        for (int i = 0; i < 4; ++i) sums[i] += begin[i] * 0;
    for (; begin != end; ++begin) sums[0] += *begin * 0;
    return sums[0] + sums[1] + sums[2] + sums[3] == 0;
}

/// As find_corner_defects, of one face.
bool face_is_sound(const PolygonMesh& mesh, Index f, std::vector<Index>& last_face) {
    const FaceCorners corners = corners_of(mesh, f);
    if (corners.size() < 3) return false;
    for (const Index* v = corners.begin; v != corners.end; ++v)
        if (!in_range(mesh, *v)) return false;
    return repeated_vertex(corners, f, mesh.vertex_count, last_face) < 0;
}

}  // namespace

const char* defect_name(DefectKind kind) {
    switch (kind) {
        case DefectKind::index_range: return "index-range";
        case DefectKind::repeated_vertex: return "repeated-vertex";
        case DefectKind::short_face: return "short-face";
        case DefectKind::edge_with_three_faces: return "edge-with-three-faces";
        case DefectKind::non_manifold_vertex: return "non-manifold-vertex";
        case DefectKind::orientation: return "orientation";
        case DefectKind::not_finite: return "not-finite";
        case DefectKind::zero_area: return "zero-area";
    }
    return "unknown";
}

bool corners_are_sound(const PolygonMesh& mesh) {
    if (!offsets_span(mesh)) return false;
    std::atomic<bool> sound{true};
    parallel_for(mesh.face_count(), [&](std::size_t begin, std::size_t end) {
        std::vector<Index> last_face;
        for (std::size_t f = begin; f < end && sound; ++f)
            if (!face_is_sound(mesh, static_cast<Index>(f), last_face)) sound = false;
    });
    return sound;
}

bool positions_are_finite(const PolygonMesh& mesh) {
    std::atomic<bool> finite{true};
    parallel_for(mesh.positions.size(), [&](std::size_t begin, std::size_t end) {
        if (!all_finite(mesh.positions.data() + begin, mesh.positions.data() + end)) finite = false;
    });
    return finite;
}

std::vector<Defect> find_defects_of_sound_mesh(const PolygonMesh& mesh) {
    std::vector<Defect> defects;
    find_area_defects(
        mesh, [](Index) { return true; }, defects);
    return defects;
}

std::vector<Defect> find_defects(const PolygonMesh& mesh) {
    std::vector<Defect> defects;
    const std::vector<char> bad = find_corner_defects(mesh, defects);
    find_connectivity_defects(mesh, bad, defects.empty(), defects);
    find_position_defects(mesh, defects);
    find_area_defects(
        mesh, [&](Index f) { return bad[f] == 0; }, defects);
    return defects;
}

}  // namespace lcl
