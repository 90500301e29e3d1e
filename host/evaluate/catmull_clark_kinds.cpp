// SPDX-License-Identifier: BSD-3-Clause
// A small mesh whose vertices are the control points is refined once by the library's own rules; the rows of the refined points that surround the patch make
// the matrices. Points at the rim of that mesh follow other rules there and are not used.
#include "host/evaluate/catmull_clark_kinds.h"

#include "host/refine/refine.h"

namespace lcl {
namespace {

using Row = Eigen::RowVectorXd;

/// Numbers of the control points. Lattice points beyond a sharp edge are -1.
class ControlPoints {
public:
    explicit ControlPoints(const CatmullClarkPlace& at) : at_(at) {
        const bool has_right = !is_sector() || at.place > 0, has_left = !is_sector() || at.place < at.faces - 1;
        int next = 1 + edge_count() + at.faces;
        if (has_right) right_ = next++;
        outer_ = next;
        next += 5;
        if (has_left) left_ = next++;
        count_ = next;
    }

    bool is_sector() const { return at_.ring == CatmullClarkPlace::Ring::sector; }
    int edge_count() const { return at_.faces + (is_sector() ? 1 : 0); }
    int count() const { return count_; }
    int edge(int j) const { return 1 + (is_sector() ? j : (j + at_.faces) % at_.faces); }
    int face(int j) const { return 1 + edge_count() + (is_sector() ? j : (j + at_.faces) % at_.faces); }
    /// The control point at a place of the patch's lattice, -1 <= x, y <= 2 but for (-1, -1).
    int at(int x, int y) const {
        const int p = at_.place;
        if (x == 2 && y >= 0) return outer_ + y;
        if (y == 2 && x >= 0) return outer_ + 4 - x;
        if (x == 2) return right_;
        if (y == 2) return left_;
        if (y < 0) return right_ < 0 ? -1 : x > 0 ? face(p - 1) : edge(p - 1);
        if (x < 0) return left_ < 0 ? -1 : y > 0 ? face(p + 1) : edge(p + 2);
        return x > 0 ? (y > 0 ? face(p) : edge(p)) : (y > 0 ? edge(p + 1) : 0);
    }
    bool has_right() const { return right_ >= 0; }
    bool has_left() const { return left_ >= 0; }

private:
    CatmullClarkPlace at_;
    int right_ = -1, left_ = -1, outer_ = 0, count_ = 0;
};

void add_quad(PolygonMesh& mesh, std::initializer_list<int> vertices) {
    mesh.face_vertices.insert(mesh.face_vertices.end(), vertices);
    mesh.face_offsets.push_back(mesh.corner_count());
}

/// The faces round V, then those that the outer points span.
PolygonMesh local_mesh(const CatmullClarkPlace& at, const ControlPoints& points) {
    PolygonMesh mesh;
    mesh.vertex_count = points.count();
    mesh.positions.assign(3 * static_cast<std::size_t>(mesh.vertex_count), 0.0);
    for (int j = 0; j < at.faces; ++j) add_quad(mesh, {0, points.edge(j), points.face(j), points.edge(j + 1)});
    const auto add_outer = [&](int x, int y) { add_quad(mesh, {points.at(x, y), points.at(x + 1, y), points.at(x + 1, y + 1), points.at(x, y + 1)}); };
    if (points.has_right()) add_outer(1, -1);
    add_outer(1, 0);
    add_outer(1, 1);
    add_outer(0, 1);
    if (points.has_left()) add_outer(-1, 1);
    return mesh;
}

FeatureOptions local_features(const CatmullClarkPlace& at, const ControlPoints& points) {
    FeatureOptions features;
    features.boundary = BoundaryRule::edge_only;
    if (at.is_corner) features.corners.push_back(0);
    if (at.sharp_edge < 0) return features;
    features.creases.push_back({0, points.edge(at.sharp_edge)});
    // Beside the patch the crease goes on.
    if (at.sharp_edge == 0) features.creases.push_back({points.edge(0), points.at(2, 0)});
    if (at.sharp_edge == 1 % at.faces) features.creases.push_back({points.edge(1), points.at(0, 2)});
    return features;
}

/// The points after one refinement as rows over the control points, on the lattice of half the width: (0, 0) is V.
class RefinedPoints {
public:
    RefinedPoints(const CatmullClarkPlace& at, const ControlPoints& points) : at_(at), points_(points) {
        const PolygonMesh mesh = local_mesh(at, points);
        topology_ = build_topology(mesh);
        SchemeOptions options;
        stencils_ = refine_once(mesh, topology_, find_features(mesh, topology_, local_features(at, points)), options).stencils;
        const auto is_sharp = [&](int edge) { return at.ring == CatmullClarkPlace::Ring::closed ? at.sharp_edge == edge : edge == 0 || edge == at.faces; };
        sharp_below_ = is_sharp(at.place);
        sharp_beside_ = is_sharp(at.ring == CatmullClarkPlace::Ring::closed ? (at.place + 1) % at.faces : at.place + 1);
    }

    Row vertex(int control) const { return row(control); }
    Row edge(int a, int b) const {
        for (Index h = 0; h < topology_.half_edge_count(); ++h)
            if ((topology_.origin(h) == a && topology_.destination(h) == b) || (topology_.origin(h) == b && topology_.destination(h) == a))
                return row(topology_.vertex_count + topology_.half_edge_edge[h]);
        return Row();
    }
    Row face(int number) const { return row(topology_.vertex_count + topology_.edge_count + number); }

    /// -1 <= x, y <= 3 but for (-1, -1). Points across a sharp edge of the patch are reflected at it.
    Row at(int x, int y) const {
        if (y < 0 && sharp_below_) return 2 * at(x, 0) - at(x, 1);
        if (x < 0 && sharp_beside_) return 2 * at(0, y) - at(1, y);
        return plain(x, y);
    }

private:
    Row row(Index point) const {
        Row weights = Row::Zero(points_.count());
        for (std::size_t i = stencils_.offsets[point]; i < stencils_.offsets[point + 1]; ++i) weights[stencils_.indices[i]] += stencils_.weights[i];
        return weights;
    }

    Row plain(int x, int y) const {
        const int p = at_.place;
        if (x == 0 && y == 0) return vertex(0);
        // Round V.
        if (x <= 1 && y <= 1) {
            if (x == 1 && y == 1) return face(p);
            if (y < 0) return x == 0 ? edge(0, points_.edge(p - 1)) : face((p - 1 + at_.faces) % at_.faces);
            if (x < 0) return y == 0 ? edge(0, points_.edge(p + 2)) : face((p + 1) % at_.faces);
            return edge(0, x == 1 ? points_.edge(p) : points_.edge(p + 1));
        }
        // Between the control points of the lattice: vertices, edges and faces of the local mesh.
        const auto floor_half = [](int i) { return i < 0 ? -1 : i / 2; };
        const int x0 = floor_half(x), y0 = floor_half(y), x1 = floor_half(x + 1), y1 = floor_half(y + 1);
        if (x0 == x1 || y0 == y1) return x0 == x1 && y0 == y1 ? vertex(points_.at(x0, y0)) : edge(points_.at(x0, y0), points_.at(x1, y1));
        const int outer = at_.faces + (points_.has_right() ? 1 : 0);
        if (y < 0) return face(at_.faces);
        if (x < 0) return face(outer + 3);
        return face(outer + (x == 3 ? (y == 3 ? 1 : 0) : 2));
    }

    CatmullClarkPlace at_;
    const ControlPoints& points_;
    Topology topology_;
    Stencils stencils_;
    bool sharp_below_ = false, sharp_beside_ = false;
};

Eigen::MatrixXd step_of(const CatmullClarkPlace& at, const ControlPoints& points, const RefinedPoints& refined) {
    Eigen::MatrixXd step(points.count(), points.count());
    int next = 0;
    step.row(next++) = refined.vertex(0);
    for (int j = 0; j < points.edge_count(); ++j) step.row(next++) = refined.edge(0, points.edge(j));
    for (int j = 0; j < at.faces; ++j) step.row(next++) = refined.face(j);
    // Not at(): beyond a dart's edge the control point is the mesh's own, not a reflected one.
    if (points.has_right()) step.row(next++) = refined.edge(points.at(1, 0), points.at(1, -1));
    for (const int y : {0, 1, 2}) step.row(next++) = refined.at(2, y);
    for (const int x : {1, 0}) step.row(next++) = refined.at(x, 2);
    if (points.has_left()) step.row(next++) = refined.edge(points.at(0, 1), points.at(-1, 1));
    return step;
}

}  // namespace

PatchKind catmull_clark_kind(const CatmullClarkPlace& place) {
    const ControlPoints points(place);
    const RefinedPoints refined(place, points);
    PatchKind kind;
    kind.point_count = points.count();
    kind.step = step_of(place, points, refined);
    constexpr std::array<std::array<int, 2>, 3> origins{{{1, 0}, {1, 1}, {0, 1}}};
    for (int cell = 0; cell < 3; ++cell) {
        kind.cells[cell].resize(16, points.count());
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) kind.cells[cell].row(4 * j + i) = refined.at(origins[cell][0] + i - 1, origins[cell][1] + j - 1);
    }
    const int n = place.faces;
    if (place.ring == CatmullClarkPlace::Ring::closed && !place.is_corner && place.sharp_edge < 0) kind.orbits = {{0, 1, 0}, {1, n, 0}, {1 + n, n, 0.5}};
    return kind;
}

}  // namespace lcl
