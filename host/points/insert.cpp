// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/insert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "host/points/geometry.h"

namespace lcl {
namespace {

using Point = FitMesh::Point;
using Vertex = OpenMesh::VertexHandle;
using HalfEdge = OpenMesh::HalfedgeHandle;
using Edge = OpenMesh::EdgeHandle;
using Face = OpenMesh::FaceHandle;

constexpr double least_flip_cosine = 0.5;  // of the turn of a normal by a flip: 60 degrees
constexpr int most_flips = 64;             // after one point: more than a valence, and an end where flips on a curved surface run in circles
constexpr double angle_rounding = 1e-9;    // four points on a circle stay as they are
constexpr double edge_weight = 0.15;       // a point whose barycentric weight is smaller goes on the edge opposite to that corner

/// Twice the area, along the normal.
Point area_vector(const Point& a, const Point& b, const Point& c) { return (b - a) % (c - a); }

bool turns_little(const Point& before, const Point& after, double least_cosine) {
    const double lengths = before.norm() * after.norm();
    return lengths > 0 && (before | after) >= least_cosine * lengths;
}

double squared_distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const Point normal = area_vector(a, b, c);
    const double whole = normal.sqrnorm();
    const bool is_inside = whole > 0 && (area_vector(a, b, p) | normal) >= 0 && (area_vector(b, c, p) | normal) >= 0 && (area_vector(c, a, p) | normal) >= 0;
    if (is_inside) return std::pow((p - a) | normal, 2) / whole;
    return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c), squared_distance_to_segment(p, c, a)});
}

/// The half-edge at place k of `sides` runs from corner k to corner k + 1.
std::array<HalfEdge, 3> sides_of(const FitMesh& mesh, Face face) {
    const HalfEdge first = mesh.halfedge_handle(face), second = mesh.next_halfedge_handle(first);
    return {first, second, mesh.next_halfedge_handle(second)};
}

const Point& origin(const FitMesh& mesh, HalfEdge h) { return mesh.point(mesh.from_vertex_handle(h)); }
const Point& opposite(const FitMesh& mesh, HalfEdge h) { return mesh.point(mesh.to_vertex_handle(mesh.next_halfedge_handle(h))); }

class Inserter {
public:
    Inserter(FitMesh& mesh, const std::vector<double>& points, const InsertOptions& options)
        : mesh_(mesh),
          points_(points),
          changed_(mesh.n_faces(), 0),
          least_dihedral_(std::cos(options.feature_degrees * M_PI / 180)),
          least_cosine_(std::cos(options.most_turn_degrees * M_PI / 180) - angle_rounding) {}

    bool insert(const FarPoint& far) {
        const Point p(points_[3 * static_cast<std::size_t>(far.point)], points_[3 * static_cast<std::size_t>(far.point) + 1],
                      points_[3 * static_cast<std::size_t>(far.point) + 2]);
        const Face face = nearest_face(mesh_.face_handle(far.face), p);
        if (is_changed(face)) return false;
        const std::array<HalfEdge, 3> sides = sides_of(mesh_, face);
        Vertex vertex;
        for (const int side : sides_beside(sides, p))
            if (!vertex.is_valid()) vertex = split_edge(sides[side], p);
        if (!vertex.is_valid()) vertex = split_face(face, sides, p);
        if (!vertex.is_valid()) return false;
        mesh_.data(vertex).source = far.point;
        make_delaunay(vertex);
        mark_changed(vertex);
        return true;
    }

private:
    /// The face that the point is nearest to, by steps to better ones round it: the surface may come nearest in another one.
    Face nearest_face(Face face, const Point& p) const {
        double least = squared_distance(face, p);
        for (Face from; from != face;) {
            from = face;
            for (const Vertex corner : mesh_.fv_range(from))
                for (const Face next : mesh_.vf_range(corner)) {
                    const double distance = squared_distance(next, p);
                    if (distance < least) least = distance, face = next;
                }
        }
        return face;
    }

    double squared_distance(Face face, const Point& p) const {
        const std::array<HalfEdge, 3> sides = sides_of(mesh_, face);
        return squared_distance_to_triangle(p, origin(mesh_, sides[0]), origin(mesh_, sides[1]), origin(mesh_, sides[2]));
    }

    /// The sides that the point is next to or lies beyond, the farthest beyond first; none where it lies well inside.
    std::vector<int> sides_beside(const std::array<HalfEdge, 3>& sides, const Point& p) const {
        const Point normal = area_vector(origin(mesh_, sides[0]), origin(mesh_, sides[1]), origin(mesh_, sides[2]));
        const double whole = normal.sqrnorm();
        std::vector<std::pair<double, int>> beside;
        for (int k = 0; k < 3; ++k) {
            const double weight = (area_vector(origin(mesh_, sides[k]), mesh_.point(mesh_.to_vertex_handle(sides[k])), p) | normal) / whole;
            if (weight < edge_weight) beside.emplace_back(weight, k);  // the barycentric weight of the corner opposite to this side
        }
        std::sort(beside.begin(), beside.end());
        std::vector<int> order;
        for (const auto& [weight, side] : beside) order.push_back(side);
        return order;
    }

    Vertex split_face(Face face, const std::array<HalfEdge, 3>& sides, const Point& p) {
        const Point before = area_vector(origin(mesh_, sides[0]), origin(mesh_, sides[1]), origin(mesh_, sides[2]));
        for (const HalfEdge side : sides)
            if (!turns_little(before, area_vector(origin(mesh_, side), mesh_.point(mesh_.to_vertex_handle(side)), p), least_cosine_)) return Vertex();
        const Vertex vertex = mesh_.add_vertex(p);
        mesh_.split(face, vertex);
        return vertex;
    }

    /// Both halves of both faces at an edge.
    bool may_split(HalfEdge h, const Point& p) const {
        if (mesh_.is_boundary(h)) return true;
        const Point &a = origin(mesh_, h), &b = mesh_.point(mesh_.to_vertex_handle(h)), &c = opposite(mesh_, h);
        const Point before = area_vector(a, b, c);
        return turns_little(before, area_vector(a, p, c), least_cosine_) && turns_little(before, area_vector(p, b, c), least_cosine_);
    }

    Vertex split_edge(HalfEdge h, const Point& p) {
        const HalfEdge other = mesh_.opposite_halfedge_handle(h);
        if (!mesh_.is_boundary(other) && is_changed(mesh_.face_handle(other))) return Vertex();
        if (!may_split(h, p) || !may_split(other, p)) return Vertex();
        const Vertex vertex = mesh_.add_vertex(p);
        mesh_.split(mesh_.edge_handle(h), vertex);
        return vertex;
    }

    bool is_changed(Face face) const { return static_cast<std::size_t>(face.idx()) >= changed_.size() || changed_[face.idx()] != 0; }

    void mark_changed(Vertex vertex) {
        changed_.resize(mesh_.n_faces(), 1);
        for (const Face face : mesh_.vf_range(vertex)) changed_[face.idx()] = 1;
    }

    /// Lawson's flips, beginning with the edges opposite to the new vertex; all flipped edges end at it.
    void make_delaunay(Vertex vertex) {
        std::vector<Edge> stack;
        for (const Face face : mesh_.vf_range(vertex))
            for (const HalfEdge h : sides_of(mesh_, face))
                if (mesh_.from_vertex_handle(h) != vertex && mesh_.to_vertex_handle(h) != vertex) stack.push_back(mesh_.edge_handle(h));
        for (int flips = 0; !stack.empty() && flips < most_flips;) {
            const Edge edge = stack.back();
            stack.pop_back();
            if (!should_flip(edge)) continue;
            const HalfEdge h = mesh_.halfedge_handle(edge, 0), other = mesh_.halfedge_handle(edge, 1);
            const HalfEdge far = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)) == vertex ? other : h;
            const Edge first = mesh_.edge_handle(mesh_.next_halfedge_handle(far)), second = mesh_.edge_handle(mesh_.prev_halfedge_handle(far));
            mesh_.flip(edge);
            ++flips;
            stack.push_back(first);
            stack.push_back(second);
        }
    }

    bool should_flip(Edge edge) const {
        if (mesh_.is_boundary(edge) || !mesh_.is_flip_ok(edge)) return false;
        const HalfEdge h = mesh_.halfedge_handle(edge, 0), other = mesh_.halfedge_handle(edge, 1);
        if (is_changed_before(h) || is_changed_before(other)) return false;
        const Point &a = origin(mesh_, h), &b = origin(mesh_, other), &c = opposite(mesh_, h), &d = opposite(mesh_, other);
        const double at_c = angle(a - c, b - c), at_d = angle(a - d, b - d);
        if (!(at_c + at_d > M_PI + angle_rounding)) return false;
        const Point first = area_vector(a, b, c), second = area_vector(b, a, d);
        if ((first | second) < least_dihedral_ * first.norm() * second.norm()) return false;
        const Point both = first + second;
        return turns_little(both, area_vector(a, d, c), least_flip_cosine) && turns_little(both, area_vector(d, b, c), least_flip_cosine);
    }

    static double angle(const Point& u, const Point& v) { return std::atan2((u % v).norm(), u | v); }

    /// Faces that changed for another point of this round stay as they are now.
    bool is_changed_before(HalfEdge h) const {
        const auto face = static_cast<std::size_t>(mesh_.face_handle(h).idx());
        return face < changed_.size() && changed_[face] != 0;
    }

    FitMesh& mesh_;
    const std::vector<double>& points_;
    std::vector<std::uint8_t> changed_;  // of the faces that there were at first
    double least_dihedral_, least_cosine_;
};

}  // namespace

std::size_t insert_points(FitMesh& mesh, std::vector<FarPoint> far, const std::vector<double>& points, const InsertOptions& options) {
    std::sort(far.begin(), far.end(),
              [](const FarPoint& a, const FarPoint& b) { return a.distance != b.distance ? a.distance > b.distance : a.point < b.point; });
    Inserter inserter(mesh, points, options);
    std::size_t count = 0;
    for (const FarPoint& point : far) {
        if (options.max_vertices > 0 && mesh.n_vertices() >= options.max_vertices) break;
        count += inserter.insert(point);
    }
    return count;
}

}  // namespace lcl
