// SPDX-License-Identifier: BSD-3-Clause
// Closed meshes by random splits, flips and merges, and duals.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "tests/shapes/shapes.h"

namespace shapes {

namespace {

using HalfEdges = std::map<std::pair<int, int>, int>;  // (from, to) -> face

void add_half_edges(HalfEdges& half_edges, const Face& face, int f) {
    for (std::size_t i = 0; i < face.size(); ++i) half_edges[{face[i], face[(i + 1) % face.size()]}] = f;
}

HalfEdges half_edges_of(const std::vector<Face>& faces) {
    HalfEdges result;
    for (std::size_t f = 0; f < faces.size(); ++f) add_half_edges(result, faces[f], static_cast<int>(f));
    return result;
}

std::vector<int> valences_of(const std::vector<Face>& faces, std::size_t vertex_count) {
    std::vector<int> valences(vertex_count);
    for (const Face& face : faces)
        for (const int v : face) ++valences[v];
    return valences;
}

int third(const Face& triangle, int a, int b) { return triangle[0] + triangle[1] + triangle[2] - a - b; }

Point middle_on_sphere(const Point& a, const Point& b) {
    Point p{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (double& x : p) x /= length;
    return p;
}

double squared_distance(const Point& a, const Point& b) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

// A triangle on the sphere seen counter-clockwise from outside and not too thin.
bool is_sound(const Point& a, const Point& b, const Point& c) {
    const double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    return volume > 0.1 * std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
}

// A triangulated sphere that grows by splits of long edges and is stirred by edge flips, valences 3 to `highest`; it never folds over.
class Dough {
public:
    Dough(std::uint64_t seed, int highest) : random_(seed), highest_(highest), faces_(faces_of(octahedron().mesh)), points_(points_of(octahedron().mesh)) {
        half_edges_ = half_edges_of(faces_);
        valences_ = valences_of(faces_, points_.size());
    }

    void grow_to(int vertex_count) {
        for (int attempt = 0; static_cast<int>(points_.size()) < vertex_count; ++attempt) {
            if (attempt > 1000 * vertex_count) throw std::logic_error("the mesh does not grow: highest valence too low");
            split();
            flip();
        }
    }

    void flip() {
        const int left = random_.below(static_cast<int>(faces_.size()));
        const auto [a, b, c, d, right] = pick(left, random_.below(3));
        if (valences_[a] < 4 || valences_[b] < 4 || valences_[c] >= highest_ || valences_[d] >= highest_ || half_edges_.count({c, d})) return;
        if (!is_sound(points_[a], points_[d], points_[c]) || !is_sound(points_[d], points_[b], points_[c])) return;
        half_edges_.erase({a, b});
        half_edges_.erase({b, a});
        set_face(left, {a, d, c});
        set_face(right, {d, b, c});
        --valences_[a];
        --valences_[b];
        ++valences_[c];
        ++valences_[d];
    }

    Shape shape(std::string name) const { return make(std::move(name), points_, faces_); }

private:
    struct Pick {
        int a, b, c, d, right;  // the picked face is (a, b, c), the one across the edge ab is (b, a, d)
    };

    Pick pick(int left, int side) const {
        const int a = faces_[left][side], b = faces_[left][(side + 1) % 3], right = half_edges_.at({b, a});
        return {a, b, third(faces_[left], a, b), third(faces_[right], a, b), right};
    }

    int longest_side(int f) const {
        int longest = 0;
        double length = 0;
        for (int i = 0; i < 3; ++i) {
            const double now = squared_distance(points_[faces_[f][i]], points_[faces_[f][(i + 1) % 3]]);
            if (now > length) longest = i;
            length = std::max(length, now);
        }
        return longest;
    }

    void set_face(int f, const Face& face) {
        faces_[f] = face;
        add_half_edges(half_edges_, face, f);
    }

    void split() {
        const int left = random_.below(static_cast<int>(faces_.size()));
        const auto [a, b, c, d, right] = pick(left, longest_side(left));
        if (valences_[c] >= highest_ || valences_[d] >= highest_) return;
        const int v = static_cast<int>(points_.size());
        points_.push_back(middle_on_sphere(points_[a], points_[b]));
        half_edges_.erase({a, b});
        half_edges_.erase({b, a});
        set_face(left, {a, v, c});
        set_face(right, {v, a, d});
        for (const Face& face : {Face{v, b, c}, Face{b, v, d}}) {
            faces_.push_back(face);
            add_half_edges(half_edges_, face, static_cast<int>(faces_.size()) - 1);
        }
        valences_.push_back(4);
        ++valences_[c];
        ++valences_[d];
    }

    Random random_;
    int highest_;
    std::vector<Face> faces_;
    std::vector<Point> points_;
    HalfEdges half_edges_;
    std::vector<int> valences_;
};

// The face that is left when the edge from a to b, first in `left` and back in `right`, goes; empty if it would meet a vertex twice.
Face merged(Face left, Face right, int a, int b) {
    for (const int v : left)
        if (v != a && v != b && std::find(right.begin(), right.end(), v) != right.end()) return {};
    std::rotate(left.begin(), std::find(left.begin(), left.end(), b), left.end());      // b .. a
    std::rotate(right.begin(), std::find(right.begin(), right.end(), a), right.end());  // a .. b
    left.insert(left.end(), right.begin() + 1, right.end() - 1);
    return left;
}

}  // namespace

Shape random_triangle_mesh(int vertex_count, std::uint64_t seed, int highest_valence) {
    Dough dough(seed, highest_valence);
    dough.grow_to(vertex_count);
    for (int i = 0; i < 12 * vertex_count; ++i) dough.flip();
    return dough.shape("random_triangle_mesh_" + std::to_string(vertex_count));
}

Shape polygons_mixed(int vertex_count, std::uint64_t seed) {
    const Shape triangles = random_triangle_mesh(vertex_count, seed, 8);
    auto faces = faces_of(triangles.mesh);
    auto half_edges = half_edges_of(faces);
    auto valences = valences_of(faces, triangles.mesh.vertex_count);
    Random random(seed);
    for (int attempt = 0; attempt < 4 * vertex_count; ++attempt) {
        const int left = random.below(static_cast<int>(faces.size()));
        if (faces[left].empty()) continue;
        const int degree = static_cast<int>(faces[left].size()), side = random.below(degree);
        const int a = faces[left][side], b = faces[left][(side + 1) % degree], right = half_edges.at({b, a});
        if (valences[a] < 4 || valences[b] < 4 || degree + static_cast<int>(faces[right].size()) > 12) continue;
        const Face face = merged(faces[left], faces[right], a, b);
        if (face.empty() || random.next() < 0.5) continue;
        half_edges.erase({a, b});
        half_edges.erase({b, a});
        faces[left] = face;
        faces[right].clear();
        add_half_edges(half_edges, face, left);
        --valences[a];
        --valences[b];
    }
    faces.erase(std::remove(faces.begin(), faces.end(), Face{}), faces.end());
    return make("polygons_mixed_" + std::to_string(vertex_count), points_of(triangles.mesh), faces);
}

Shape dual_of(const Shape& closed) {
    const auto old_points = points_of(closed.mesh);
    const auto old_faces = faces_of(closed.mesh);
    const auto half_edges = half_edges_of(old_faces);
    std::vector<Point> points;
    std::vector<Face> faces(old_points.size());
    std::vector<int> start(old_points.size(), -1);
    for (std::size_t f = 0; f < old_faces.size(); ++f) {
        points.push_back({0, 0, 0});
        for (const int v : old_faces[f]) {
            for (int c = 0; c < 3; ++c) points.back()[c] += old_points[v][c] / static_cast<double>(old_faces[f].size());
            if (start[v] < 0) start[v] = static_cast<int>(f);
        }
    }
    for (int v = 0; v < closed.mesh.vertex_count; ++v) {
        int f = start[v];
        do {
            faces[v].push_back(f);
            const Face& face = old_faces[f];
            const std::size_t i = std::find(face.begin(), face.end(), v) - face.begin();
            f = half_edges.at({v, face[(i + face.size() - 1) % face.size()]});
        } while (f != start[v]);
    }
    return make("dual_of_" + closed.name, points, faces);
}

}  // namespace shapes
