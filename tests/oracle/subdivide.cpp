// SPDX-License-Identifier: BSD-3-Clause
#include "tests/oracle/subdivide.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace oracle {

namespace {

const double pi = std::acos(-1.0);

struct Adjacency {
    std::vector<Edge> edges;  // by first appearance walking the faces, as walked
    std::map<Edge, int> edge_number;
    std::map<std::pair<int, int>, int> half_edge_face;  // (from, to) -> face
    std::vector<std::vector<int>> vertex_faces;         // faces at a vertex
    std::vector<std::vector<int>> neighbours;           // other ends of the edges at a vertex
};

Adjacency adjacency_of(const Surface& surface) {
    Adjacency result;
    result.vertex_faces.resize(surface.vertex_count);
    result.neighbours.resize(surface.vertex_count);
    for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f) {
        const auto& face = surface.faces[f];
        for (std::size_t i = 0; i < face.size(); ++i) {
            const int a = face[i], b = face[(i + 1) % face.size()];
            result.vertex_faces[a].push_back(f);
            result.half_edge_face[{a, b}] = f;
            if (!result.edge_number.emplace(edge_of(a, b), static_cast<int>(result.edges.size())).second) continue;
            result.edges.push_back({a, b});
            result.neighbours[a].push_back(b);
            result.neighbours[b].push_back(a);
        }
    }
    return result;
}

int face_of(const Adjacency& adjacency, int from, int to) {
    const auto found = adjacency.half_edge_face.find({from, to});
    return found == adjacency.half_edge_face.end() ? -1 : found->second;
}

// The corner of the face before (-1) or after (1) that of v.
int neighbour_in(const std::vector<int>& face, int v, int direction) {
    const int d = static_cast<int>(face.size()), i = static_cast<int>(std::find(face.begin(), face.end(), v) - face.begin());
    return face[(i + direction + d) % d];
}

bool is_sharp(const Surface& surface, int a, int b) { return surface.sharp.count(edge_of(a, b)) != 0; }

std::vector<int> sharp_neighbours(const Surface& surface, const Adjacency& adjacency, int v) {
    std::vector<int> result;
    for (const int w : adjacency.neighbours[v])
        if (is_sharp(surface, v, w)) result.push_back(w);
    return result;
}

Eigen::RowVectorXd unit_row(const Surface& surface, int v) { return Eigen::RowVectorXd::Unit(surface.vertex_count, v); }

Eigen::RowVectorXd centroid(const Surface& surface, int f) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(surface.vertex_count);
    for (const int v : surface.faces[f]) row[v] += 1.0 / surface.faces[f].size();
    return row;
}

// V' = (n-2)/n V + 1/n^2 sum (alpha V + (1 - alpha) E_j) + 1/n^2 sum f_j (mesh expansion paper); alpha = 0: Q/n + 2R/n + (n-3)/n V.
Eigen::RowVectorXd catmull_clark_vertex(const Surface& surface, const Adjacency& adjacency, int v, double alpha) {
    const double n = static_cast<double>(adjacency.vertex_faces[v].size());
    Eigen::RowVectorXd ends = Eigen::RowVectorXd::Zero(surface.vertex_count), centroids = ends;  // summed first: a row's sum is 1 to a few roundings
    for (const int w : adjacency.neighbours[v]) ends += unit_row(surface, w);
    for (const int f : adjacency.vertex_faces[v]) centroids += centroid(surface, f);
    return (n - 2 + alpha) / n * unit_row(surface, v) + ((1 - alpha) * ends + centroids) / (n * n);
}

Eigen::RowVectorXd loop_vertex(const Surface& surface, const Adjacency& adjacency, int v) {
    const double n = static_cast<double>(adjacency.vertex_faces[v].size());
    const double beta = (0.625 - std::pow(0.375 + std::cos(2 * pi / n) / 4, 2)) / n;
    Eigen::RowVectorXd row = (1 - n * beta) * unit_row(surface, v);
    for (const int w : adjacency.neighbours[v]) row += beta * unit_row(surface, w);
    return row;
}

Eigen::RowVectorXd new_vertex_point(const Surface& surface, const Adjacency& adjacency, int v, const lcl::SchemeOptions& options) {
    if (adjacency.vertex_faces[v].empty() || surface.corners.count(v)) return unit_row(surface, v);
    const auto ends = sharp_neighbours(surface, adjacency, v);
    if (ends.size() == 2) return 0.75 * unit_row(surface, v) + 0.125 * unit_row(surface, ends[0]) + 0.125 * unit_row(surface, ends[1]);
    if (options.scheme == lcl::Scheme::loop) return loop_vertex(surface, adjacency, v);
    return catmull_clark_vertex(surface, adjacency, v, options.alpha);
}

int opposite(const std::vector<int>& triangle, int a, int b) {
    for (const int v : triangle)
        if (v != a && v != b) return v;
    throw std::logic_error("a triangle without a third vertex");
}

Eigen::RowVectorXd new_edge_point(const Surface& surface, const Adjacency& adjacency, Edge edge, const lcl::SchemeOptions& options) {
    const auto [a, b] = edge;
    const int left = face_of(adjacency, a, b), right = face_of(adjacency, b, a);
    const Eigen::RowVectorXd ends = unit_row(surface, a) + unit_row(surface, b);
    if (is_sharp(surface, a, b) || left < 0 || right < 0) return ends / 2;
    if (options.scheme == lcl::Scheme::catmull_clark) return (ends + centroid(surface, left) + centroid(surface, right)) / 4;
    return 0.375 * ends + 0.125 * unit_row(surface, opposite(surface.faces[left], a, b)) + 0.125 * unit_row(surface, opposite(surface.faces[right], a, b));
}

std::set<Edge> halved(const Surface& surface, const Adjacency& adjacency) {
    std::set<Edge> result;
    for (const auto& [a, b] : surface.sharp) {
        const int middle = surface.vertex_count + adjacency.edge_number.at({a, b});
        result.insert(edge_of(a, middle));
        result.insert(edge_of(b, middle));
    }
    return result;
}

void add_children(const Surface& surface, const Adjacency& adjacency, int f, bool is_loop, std::vector<std::vector<int>>& faces) {
    const auto& face = surface.faces[f];
    const std::size_t d = face.size();
    const int centre = surface.vertex_count + static_cast<int>(adjacency.edges.size()) + f;
    std::vector<int> middles(d);
    for (std::size_t i = 0; i < d; ++i) middles[i] = surface.vertex_count + adjacency.edge_number.at(edge_of(face[i], face[(i + 1) % d]));
    for (std::size_t i = 0; i < d; ++i) {
        if (is_loop) faces.push_back({face[i], middles[i], middles[(i + d - 1) % d]});
        else faces.push_back({face[i], middles[i], centre, middles[(i + d - 1) % d]});
    }
    if (is_loop) faces.push_back(middles);
}

Step primal_step(const Surface& surface, const lcl::SchemeOptions& options) {
    const Adjacency adjacency = adjacency_of(surface);
    const bool is_loop = options.scheme == lcl::Scheme::loop;
    const int edge_count = static_cast<int>(adjacency.edges.size()), face_count = static_cast<int>(surface.faces.size());
    Step step;
    step.surface.vertex_count = surface.vertex_count + edge_count + (is_loop ? 0 : face_count);
    step.weights.resize(step.surface.vertex_count, surface.vertex_count);
    for (int v = 0; v < surface.vertex_count; ++v) step.weights.row(v) = new_vertex_point(surface, adjacency, v, options);
    for (int e = 0; e < edge_count; ++e) step.weights.row(surface.vertex_count + e) = new_edge_point(surface, adjacency, adjacency.edges[e], options);
    for (int f = 0; f < face_count; ++f) {
        if (is_loop && surface.faces[f].size() != 3) throw std::invalid_argument("Loop needs triangles");
        if (!is_loop) step.weights.row(surface.vertex_count + edge_count + f) = centroid(surface, f);
        add_children(surface, adjacency, f, is_loop, step.surface.faces);
    }
    step.surface.sharp = halved(surface, adjacency);
    step.surface.corners = surface.corners;
    step.surface.boundary_is_fixed = surface.boundary_is_fixed;
    return step;
}

// Numbers of the points of the two-phase mesh M^1: the old vertices, two an edge (next to its ends), one a face corner.
struct TwoPhaseNumbers {
    const Surface& surface;
    const Adjacency& adjacency;
    std::vector<int> face_offsets;

    TwoPhaseNumbers(const Surface& surface_, const Adjacency& adjacency_) : surface(surface_), adjacency(adjacency_) {
        int next = surface.vertex_count + 2 * static_cast<int>(adjacency.edges.size());
        for (const auto& face : surface.faces) {
            face_offsets.push_back(next);
            next += static_cast<int>(face.size());
        }
        face_offsets.push_back(next);
    }
    int on_edge(int near, int far) const {
        const int e = adjacency.edge_number.at(edge_of(near, far));
        return surface.vertex_count + 2 * e + (adjacency.edges[e].first == near ? 0 : 1);
    }
    int in_face(int f, int v) const {
        const auto& face = surface.faces[f];
        return face_offsets[f] + static_cast<int>(std::find(face.begin(), face.end(), v) - face.begin());
    }
};

std::vector<std::vector<int>> two_phase_faces(const Surface& surface, const Adjacency& adjacency, const TwoPhaseNumbers& number) {
    std::vector<std::vector<int>> faces;
    const int face_count = static_cast<int>(surface.faces.size());
    for (int f = 0; f < face_count; ++f) {
        faces.emplace_back();
        for (const int v : surface.faces[f]) faces.back().push_back(number.in_face(f, v));
    }
    for (const auto& [from, to] : adjacency.edges)
        for (const auto& [a, b] : {Edge{from, to}, Edge{to, from}}) {
            const int f = face_of(adjacency, a, b);
            if (f >= 0) faces.push_back({number.on_edge(a, b), number.on_edge(b, a), number.in_face(f, b), number.in_face(f, a)});
        }
    for (int v = 0; v < surface.vertex_count; ++v)
        for (const int f : adjacency.vertex_faces[v]) {
            const auto& face = surface.faces[f];
            faces.push_back({v, number.on_edge(v, neighbour_in(face, v, 1)), number.in_face(f, v), number.on_edge(v, neighbour_in(face, v, -1))});
        }
    return faces;
}

// Two-phase paper: every new point of Catmull-Clark (alpha too) is blended with the old vertex that it belongs to.
Step two_phase_step(const Surface& surface, const lcl::SchemeOptions& options) {
    const Adjacency adjacency = adjacency_of(surface);
    const TwoPhaseNumbers number(surface, adjacency);
    const Eigen::MatrixXd smooth = primal_step(surface, options).weights;
    const int edge_count = static_cast<int>(adjacency.edges.size());
    Step step;
    step.surface.vertex_count = number.face_offsets.back();
    step.weights.resize(step.surface.vertex_count, surface.vertex_count);
    const auto blend = [&](int row, int v, int smooth_row) {
        const double lambda = options.lambda_at(v);
        step.weights.row(row) = lambda * unit_row(surface, v) + (1 - lambda) * smooth.row(smooth_row);
    };
    for (int v = 0; v < surface.vertex_count; ++v) blend(v, v, v);
    for (int e = 0; e < edge_count; ++e) {
        const auto [a, b] = adjacency.edges[e];
        blend(number.on_edge(a, b), a, surface.vertex_count + e);
        blend(number.on_edge(b, a), b, surface.vertex_count + e);
    }
    for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f)
        for (const int v : surface.faces[f]) blend(number.in_face(f, v), v, surface.vertex_count + edge_count + f);
    step.surface.faces = two_phase_faces(surface, adjacency, number);
    for (const auto& [a, b] : surface.sharp) {
        const int near_a = number.on_edge(a, b), near_b = number.on_edge(b, a);
        for (const Edge& edge : {edge_of(a, near_a), edge_of(near_a, near_b), edge_of(near_b, b)}) step.surface.sharp.insert(edge);
    }
    step.surface.corners = surface.corners;
    step.surface.boundary_is_fixed = surface.boundary_is_fixed;
    return step;
}

double doo_sabin_weight(lcl::DooSabinMask mask, int m, int steps) {
    if (mask == lcl::DooSabinMask::classic) return steps == 0 ? (m + 5.0) / (4 * m) : (3 + 2 * std::cos(2 * pi * steps / m)) / (4 * m);
    double weight = 1.0 / (4 * m);
    if (steps == 0) weight += 0.5;
    if (steps == 1) weight += 0.125;
    if (steps == m - 1) weight += 0.125;  // with two sides the one other corner is both neighbours
    return weight;
}

/// The faces round a vertex between two sharp edges, counter-clockwise; closed when the vertex has no sharp edge.
struct Sector {
    std::vector<int> faces;
    bool is_closed = false;
};

// Goes round v from face f; false if it runs off the rim of a patch.
bool walk_sector(const Surface& surface, const Adjacency& adjacency, int v, int f, Sector& sector) {
    for (int first = f;;) {
        sector.faces.push_back(f);
        const int previous = neighbour_in(surface.faces[f], v, -1);
        if (is_sharp(surface, v, previous)) return true;
        f = face_of(adjacency, v, previous);
        if (f < 0) return false;
        if (f == first) {
            sector.is_closed = true;
            return true;
        }
    }
}

// In the order in which they lie round v, from its boundary or else from its first face.
std::vector<Sector> sectors_of(const Surface& surface, const Adjacency& adjacency, int v) {
    if (adjacency.vertex_faces[v].empty()) return {};
    int f = adjacency.vertex_faces[v][0];
    for (const int w : adjacency.neighbours[v])
        if (face_of(adjacency, v, w) >= 0 && face_of(adjacency, w, v) < 0) f = face_of(adjacency, v, w);
    std::vector<Sector> result;
    bool is_round = false;
    for (const int first = f; f >= 0 && !is_round;) {
        Sector sector;
        if (is_sharp(surface, v, neighbour_in(surface.faces[f], v, 1)) && walk_sector(surface, adjacency, v, f, sector)) result.push_back(sector);
        f = face_of(adjacency, v, neighbour_in(surface.faces[f], v, -1));
        is_round = f == first;
    }
    Sector whole;
    if (sharp_neighbours(surface, adjacency, v).empty() && walk_sector(surface, adjacency, v, adjacency.vertex_faces[v][0], whole)) result.push_back(whole);
    return result;
}

// One Doo-Sabin refinement, made piece by piece. A sharp edge counts as a boundary on both of its sides.
class DooSabinStep {
public:
    DooSabinStep(const Surface& surface, lcl::DooSabinMask mask) : old_(surface), adjacency_(adjacency_of(surface)), mask_(mask) {}

    Step run() {
        for (const auto& face : old_.faces) add_face(face);
        for (const auto& [a, b] : adjacency_.edges)
            if (is_sharp(old_, a, b)) {
                add_boundary_points(a, b);
                add_boundary_points(b, a);
            }
        for (const int v : old_.corners) keep_corner(v);
        for (int v = 0; v < old_.vertex_count; ++v)
            if (adjacency_.vertex_faces[v].empty()) add_point(unit_row(old_, v));
        for (const auto& [a, b] : adjacency_.edges) add_edge_faces(a, b);
        step_.vertex_faces.resize(old_.vertex_count);
        for (int v = 0; v < old_.vertex_count; ++v) add_vertex_faces(v);
        finish();
        return step_;
    }

private:
    int add_point(const Eigen::RowVectorXd& row) {
        rows_.push_back(row);
        return static_cast<int>(rows_.size()) - 1;
    }
    int in_face(int f, int v) const { return corner_points_.at({f, v}); }

    void add_face(const std::vector<int>& face) {
        const int m = static_cast<int>(face.size()), f = static_cast<int>(step_.surface.faces.size());
        std::vector<int> points;
        for (int i = 0; i < m; ++i) {
            Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(old_.vertex_count);
            for (int j = 0; j < m; ++j) row[face[(i + j) % m]] += doo_sabin_weight(mask_, m, j);
            points.push_back(add_point(row));
            corner_points_[{f, face[i]}] = points.back();
        }
        step_.surface.faces.push_back(points);
    }

    // The boundary row once more as a ghost row: a quad (a, b, b, a) has the new points 3/4 a + 1/4 b and 1/4 a + 3/4 b.
    void add_boundary_points(int a, int b) {
        if (face_of(adjacency_, a, b) < 0) return;
        const int near_a = add_point(0.75 * unit_row(old_, a) + 0.25 * unit_row(old_, b));
        const int near_b = add_point(0.25 * unit_row(old_, a) + 0.75 * unit_row(old_, b));
        boundary_points_[{a, b}] = {near_a, near_b};
        if (old_.boundary_is_fixed && face_of(adjacency_, b, a) < 0) step_.surface.corners.insert({near_a, near_b});
    }

    void keep_corner(int v) {
        if (adjacency_.vertex_faces[v].empty()) return;
        for (const Sector& sector : sectors_of(old_, adjacency_, v)) {
            kept_[{v, sector.faces[0]}] = add_point(unit_row(old_, v));
            step_.surface.corners.insert(kept_[{v, sector.faces[0]}]);
        }
    }

    void add_edge_faces(int a, int b) {
        const int f = face_of(adjacency_, a, b), g = face_of(adjacency_, b, a);
        if (!is_sharp(old_, a, b)) {
            if (f >= 0 && g >= 0) step_.surface.faces.push_back({in_face(f, b), in_face(f, a), in_face(g, a), in_face(g, b)});
            return;
        }
        for (const auto& [from, to] : {Edge{a, b}, Edge{b, a}}) {
            const int face = face_of(adjacency_, from, to);
            if (face < 0) continue;
            const auto [near_from, near_to] = boundary_points_.at({from, to});
            step_.edge_faces[{from, to}] = static_cast<int>(step_.surface.faces.size());
            step_.surface.faces.push_back({near_to, in_face(face, to), in_face(face, from), near_from});
            step_.surface.sharp.insert(edge_of(near_from, near_to));
        }
    }

    void add_vertex_faces(int v) {
        for (const Sector& sector : sectors_of(old_, adjacency_, v)) {
            std::vector<int> points;
            for (const int f : sector.faces) points.push_back(in_face(f, v));
            const auto kept = kept_.find({v, sector.faces[0]});
            if (!sector.is_closed) {
                add_open_vertex_face(v, sector, points, kept == kept_.end() ? -1 : kept->second);
            } else if (kept == kept_.end()) {
                step_.vertex_faces[v].push_back(static_cast<int>(step_.surface.faces.size()));
                step_.surface.faces.push_back(points);
            } else {  // a corner inside: the vertex-face becomes a fan round it
                for (std::size_t i = 0; i < points.size(); ++i) step_.surface.faces.push_back({points[i], points[(i + 1) % points.size()], kept->second});
            }
        }
    }

    void add_open_vertex_face(int v, const Sector& sector, const std::vector<int>& inner, int kept) {
        const int next = neighbour_in(old_.faces[sector.faces.front()], v, 1), previous = neighbour_in(old_.faces[sector.faces.back()], v, -1);
        const int first = boundary_points_.at({v, next}).first, last = boundary_points_.at({previous, v}).second;
        std::vector<int> points{first};
        points.insert(points.end(), inner.begin(), inner.end());
        points.push_back(last);
        if (kept >= 0) {
            points.push_back(kept);
            step_.surface.sharp.insert(edge_of(last, kept));
            step_.surface.sharp.insert(edge_of(kept, first));
        } else {
            step_.surface.sharp.insert(edge_of(last, first));
        }
        step_.vertex_faces[v].push_back(static_cast<int>(step_.surface.faces.size()));
        step_.surface.faces.push_back(points);
    }

    void finish() {
        step_.surface.vertex_count = static_cast<int>(rows_.size());
        step_.surface.boundary_is_fixed = old_.boundary_is_fixed;
        step_.weights.resize(rows_.size(), old_.vertex_count);
        for (std::size_t i = 0; i < rows_.size(); ++i) step_.weights.row(i) = rows_[i];
    }

    const Surface& old_;
    const Adjacency adjacency_;
    const lcl::DooSabinMask mask_;
    Step step_;
    std::vector<Eigen::RowVectorXd> rows_;
    std::map<std::pair<int, int>, int> corner_points_;                    // (face, vertex) -> point
    std::map<std::pair<int, int>, std::pair<int, int>> boundary_points_;  // sharp half-edge (a, b) -> points next to a and to b
    std::map<std::pair<int, int>, int> kept_;                             // (corner, first face of its sector) -> point
};

Eigen::Vector3d newell_normal(const std::vector<int>& face, const Eigen::MatrixXd& points) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < face.size(); ++i) {
        const Eigen::Vector3d a = points.row(face[i]) - points.row(face[0]), b = points.row(face[(i + 1) % face.size()]) - points.row(face[0]);
        normal += a.cross(b);
    }
    return normal;
}

void mark_angles(const lcl::PolygonMesh& mesh, const Adjacency& adjacency, double degrees, Surface& surface) {
    const Eigen::MatrixXd points = positions(mesh);
    for (const auto& [a, b] : adjacency.edges) {
        const int f = face_of(adjacency, a, b), g = face_of(adjacency, b, a);
        if (f < 0 || g < 0) continue;
        const Eigen::Vector3d left = newell_normal(surface.faces[f], points), right = newell_normal(surface.faces[g], points);
        if (std::atan2(left.cross(right).norm(), left.dot(right)) * 180 / pi > degrees) surface.sharp.insert(edge_of(a, b));
    }
}

void mark_corners(const Adjacency& adjacency, const lcl::FeatureOptions& features, Surface& surface) {
    surface.corners.insert(features.corners.begin(), features.corners.end());
    for (int v = 0; v < surface.vertex_count; ++v) {
        bool is_on_boundary = false;
        for (const int w : adjacency.neighbours[v]) is_on_boundary |= face_of(adjacency, v, w) < 0 || face_of(adjacency, w, v) < 0;
        const bool has_one_face = adjacency.vertex_faces[v].size() == 1;
        if (sharp_neighbours(surface, adjacency, v).size() > 2) surface.corners.insert(v);
        if (is_on_boundary && features.boundary == lcl::BoundaryRule::fixed) surface.corners.insert(v);
        if (is_on_boundary && has_one_face && features.boundary == lcl::BoundaryRule::edge_and_corner) surface.corners.insert(v);
    }
}

}  // namespace

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

Surface make_surface(const lcl::PolygonMesh& mesh, const lcl::FeatureOptions& features) {
    Surface surface;
    surface.vertex_count = mesh.vertex_count;
    surface.boundary_is_fixed = features.boundary == lcl::BoundaryRule::fixed;
    for (int f = 0; f < mesh.face_count(); ++f)
        surface.faces.emplace_back(mesh.face_vertices.begin() + mesh.face_offsets[f], mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
    const Adjacency adjacency = adjacency_of(surface);
    for (const auto& [a, b] : adjacency.edges)
        if (face_of(adjacency, a, b) < 0 || face_of(adjacency, b, a) < 0) surface.sharp.insert(edge_of(a, b));
    for (const auto& crease : features.creases) {
        if (!adjacency.edge_number.count(edge_of(crease[0], crease[1]))) throw std::invalid_argument("a crease is no edge");
        surface.sharp.insert(edge_of(crease[0], crease[1]));
    }
    if (features.crease_angle_degrees >= 0) mark_angles(mesh, adjacency, features.crease_angle_degrees, surface);
    mark_corners(adjacency, features, surface);
    return surface;
}

Step subdivide(const Surface& surface, const lcl::SchemeOptions& options) {
    if (options.scheme == lcl::Scheme::doo_sabin) return DooSabinStep(surface, options.mask).run();
    return options.is_two_phase() ? two_phase_step(surface, options) : primal_step(surface, options);
}

lcl::SchemeOptions after_first_step(const lcl::SchemeOptions& options) {
    lcl::SchemeOptions result;
    result.scheme = options.scheme;
    result.mask = options.mask;
    return result;
}

Step subdivide(const Surface& surface, const lcl::SchemeOptions& options, int levels) {
    Step result;
    result.surface = surface;
    result.weights = Eigen::MatrixXd::Identity(surface.vertex_count, surface.vertex_count);
    for (int level = 0; level < levels; ++level) {
        Step next = subdivide(result.surface, level == 0 ? options : after_first_step(options));
        next.weights = next.weights * result.weights;
        result = std::move(next);
    }
    return result;
}

Eigen::MatrixXd positions(const lcl::PolygonMesh& mesh) {
    Eigen::MatrixXd points(mesh.vertex_count, 3);
    for (int v = 0; v < mesh.vertex_count; ++v)
        for (int c = 0; c < 3; ++c) points(v, c) = mesh.positions[3 * v + c];
    return points;
}

lcl::PolygonMesh to_mesh(const Surface& surface, const Eigen::MatrixXd& points) {
    lcl::PolygonMesh mesh;
    mesh.vertex_count = surface.vertex_count;
    for (const auto& face : surface.faces) {
        mesh.face_vertices.insert(mesh.face_vertices.end(), face.begin(), face.end());
        mesh.face_offsets.push_back(mesh.corner_count());
    }
    for (int v = 0; v < surface.vertex_count; ++v)
        for (int c = 0; c < 3; ++c) mesh.positions.push_back(points(v, c));
    return mesh;
}

std::vector<std::vector<int>> sorted_faces(const lcl::PolygonMesh& mesh) {
    std::vector<std::vector<int>> faces;
    for (int f = 0; f < mesh.face_count(); ++f) {
        faces.emplace_back(mesh.face_vertices.begin() + mesh.face_offsets[f], mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
        std::rotate(faces.back().begin(), std::min_element(faces.back().begin(), faces.back().end()), faces.back().end());
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

}  // namespace oracle
