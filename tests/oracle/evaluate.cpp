// SPDX-License-Identifier: BSD-3-Clause
#include "tests/oracle/evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace oracle {

namespace {

using Real = long double;
using Matrix2 = Eigen::Matrix<Real, 2, 2>;

const Real pi = std::acos(Real(-1));

// So many refinements take an extraordinary point that is followed exactly to its limit: 0.6^100 is the slowest.
constexpr int depth_of_points = 100;
// And so far from it along a side the tangent is that at the point: 0.92^400 is the slowest up to valence 12.
constexpr int depth_of_tangents = 400;

/// The faces round a place, points relative to `origin`. An edge with one face that is not sharp is the rim; nothing that is asked for depends on it.
struct Patch {
    std::vector<std::vector<int>> faces;
    std::vector<Vector> points;
    std::set<Edge> sharp;
    std::set<int> corners;
    Vector origin = Vector::Zero();
    std::map<std::pair<int, int>, int> face_of;  // half-edge (from, to) -> face

    bool is_sharp(int a, int b) const { return sharp.count(edge_of(a, b)) != 0; }
    int face_at(int from, int to) const {
        const auto found = face_of.find({from, to});
        return found == face_of.end() ? -1 : found->second;
    }
};

int after(const std::vector<int>& face, int v, int steps) {
    const int d = static_cast<int>(face.size()), i = static_cast<int>(std::find(face.begin(), face.end(), v) - face.begin());
    if (i == d) throw std::logic_error("a vertex that is not of the face");
    return face[(i + steps + d) % d];
}

bool share_a_vertex(const std::vector<int>& a, const std::vector<int>& b) {
    return std::any_of(a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

// Some faces of a whole that has faces, points, sharp and corners, in the order given, with points relative to one of them.
template <class Whole>
Patch cut(const Whole& whole, const std::vector<Vector>& points, const std::vector<int>& kept, int centre) {
    Patch patch;
    patch.origin = points[centre];
    std::map<int, int> number;
    for (const int f : kept) {
        patch.faces.emplace_back();
        for (const int v : whole.faces[f]) {
            const auto [found, is_new] = number.emplace(v, static_cast<int>(patch.points.size()));
            if (is_new) {
                patch.points.emplace_back(points[v] - points[centre]);
                if (whole.corners.count(v)) patch.corners.insert(found->second);
            }
            patch.faces.back().push_back(found->second);
        }
    }
    for (std::size_t f = 0; f < patch.faces.size(); ++f) {
        const auto& face = patch.faces[f];
        for (std::size_t i = 0; i < face.size(); ++i) patch.face_of[{face[i], face[(i + 1) % face.size()]}] = static_cast<int>(f);
    }
    for (const Edge& edge : whole.sharp)
        if (number.count(edge.first) && number.count(edge.second)) patch.sharp.insert(edge_of(number[edge.first], number[edge.second]));
    return patch;
}

Patch cut(const Patch& whole, const std::vector<int>& kept, int centre) {
    Patch patch = cut(whole, whole.points, kept, centre);
    patch.origin += whole.origin;
    return patch;
}

Vector mean_of(const Patch& patch, const std::vector<int>& face) {
    Vector sum = Vector::Zero();
    for (const int v : face) sum += patch.points[v];
    return sum / static_cast<Real>(face.size());
}

/// The faces round a vertex that can be reached from one of them without crossing a sharp edge, counter-clockwise; an open sector from edge to edge.
struct Sector {
    std::vector<int> faces;
    bool is_closed = false;
    std::size_t size() const { return faces.size(); }
};

Sector sector_of(const Patch& patch, int v, int face) {
    Sector sector;
    int first = face;
    for (int next; !patch.is_sharp(v, next = after(patch.faces[first], v, 1));) {
        first = patch.face_at(next, v);
        if (first < 0) throw std::logic_error("the faces of a patch end round a vertex");
        sector.is_closed = first == face;
        if (sector.is_closed) break;
    }
    sector.faces = {first};
    for (int previous, f = first; !patch.is_sharp(v, previous = after(patch.faces[f], v, -1));) {
        f = patch.face_at(v, previous);
        if (f == first) break;
        sector.faces.push_back(f);
    }
    return sector;
}

std::vector<int> sharp_ends(const Patch& patch, int v) {
    std::vector<int> ends;
    for (const Edge& edge : patch.sharp)
        if (edge.first == v || edge.second == v) ends.push_back(edge.first == v ? edge.second : edge.first);
    return ends;
}

/// A value with its derivatives by two parameters: s, t, ss, st, tt.
struct Jet {
    std::array<Real, 6> of{};
    static Jet constant(Real value) { return {{value, 0, 0, 0, 0, 0}}; }
};
Jet operator+(const Jet& a, const Jet& b) {
    Jet sum;
    for (int i = 0; i < 6; ++i) sum.of[i] = a.of[i] + b.of[i];
    return sum;
}
Jet operator*(const Jet& a, const Jet& b) {
    const auto& [f, fs, ft, fss, fst, ftt] = a.of;
    const auto& [g, gs, gt, gss, gst, gtt] = b.of;
    return {{f * g, fs * g + f * gs, ft * g + f * gt, fss * g + 2 * fs * gs + f * gss, fst * g + fs * gt + ft * gs + f * gst, ftt * g + 2 * ft * gt + f * gtt}};
}
Jet operator*(Real factor, const Jet& a) { return Jet::constant(factor) * a; }
Jet operator-(const Jet& a, const Jet& b) { return a + Real(-1) * b; }

// Uniform B-splines by the recursion of de Boor: N_k(x) = (x N_(k-1)(x) + (k + 1 - x) N_(k-1)(x - 1)) / k, N_0 = 1 on [0, 1). The pieces of degree k on the
// interval x = t + j, for j = 0 .. k.
std::vector<Jet> spline_pieces(int degree, const Jet& t) {
    std::vector<Jet> pieces{Jet::constant(1)};
    for (int k = 1; k <= degree; ++k) {
        std::vector<Jet> next;
        for (int j = 0; j <= k; ++j) {
            const Jet x = t + Jet::constant(j), rest = Jet::constant(k + 1) - x;
            const Jet left = j < k ? x * pieces[j] : Jet(), right = j > 0 ? rest * pieces[j - 1] : Jet();
            next.push_back(Real(1) / k * (left + right));
        }
        pieces = next;
    }
    return pieces;
}

/// Control points of a tensor-product patch, row by row, and the weights of a place on it: point (i, j) of degree + 1 a side has N(t + degree - i).
std::vector<Jet> tensor_weights(int degree, Real s, Real t) {
    const auto along_s = spline_pieces(degree, {{s, 1, 0, 0, 0, 0}}), along_t = spline_pieces(degree, {{t, 0, 1, 0, 0, 0}});
    std::vector<Jet> weights;
    for (int j = 0; j <= degree; ++j)
        for (int i = 0; i <= degree; ++i) weights.push_back(along_s[degree - i] * along_t[degree - j]);
    return weights;
}

// Sums of c w^i u^j v^k.
struct Term {
    int factor, w, u, v;
};
Jet polynomial(const std::vector<Term>& terms, const Jet& w, const Jet& u, const Jet& v) {
    const auto power = [](const Jet& x, int n) {
        Jet product = Jet::constant(1);
        for (int i = 0; i < n; ++i) product = product * x;
        return product;
    };
    Jet sum;
    for (const Term& term : terms) sum = sum + term.factor * (power(w, term.w) * power(u, term.u) * power(v, term.v));
    return Real(1) / 12 * sum;
}

// The quartic box spline on one triangle (Stam 1998, "Evaluation of Loop subdivision surfaces", appendix A) has three kinds of weights. `w` is the weight of
// the triangle's vertex next to the point: of the vertex itself; of a point across the edge between the vertices of u and w; of a point next to w, nearer to u.
Jet vertex_weight(const Jet& w, const Jet& u, const Jet& v) {
    return polynomial({{6, 4, 0, 0},
                       {24, 3, 0, 1},
                       {24, 2, 0, 2},
                       {8, 1, 0, 3},
                       {1, 0, 0, 4},
                       {24, 3, 1, 0},
                       {60, 2, 1, 1},
                       {36, 1, 1, 2},
                       {6, 0, 1, 3},
                       {24, 2, 2, 0},
                       {36, 1, 2, 1},
                       {12, 0, 2, 2},
                       {8, 1, 3, 0},
                       {6, 0, 3, 1},
                       {1, 0, 4, 0}},
                      w, u, v);
}
Jet across_weight(const Jet& w, const Jet& u, const Jet& v) {
    return polynomial({{1, 4, 0, 0}, {2, 3, 0, 1}, {6, 3, 1, 0}, {6, 2, 1, 1}, {12, 2, 2, 0}, {6, 1, 2, 1}, {6, 1, 3, 0}, {2, 0, 3, 1}, {1, 0, 4, 0}}, w, u, v);
}
Jet far_weight(const Jet& w, const Jet& u) { return polynomial({{1, 4, 0, 0}, {2, 3, 1, 0}}, w, u, Jet()); }

using Cell = std::pair<int, int>;  // on the lattice of a patch
Cell operator+(Cell a, Cell b) { return {a.first + b.first, a.second + b.second}; }
Cell operator-(Cell a, Cell b) { return {a.first - b.first, a.second - b.second}; }

/// Weights of the twelve points round the triangle (0, 0), (1, 0), (0, 1), whose barycentric weights are (1 - s - t, s, t).
std::map<Cell, Jet> box_weights(Real w_value, Real s, Real t) {
    const Jet w{{w_value, -1, -1, 0, 0, 0}}, u{{s, 1, 0, 0, 0, 0}}, v{{t, 0, 1, 0, 0, 0}};
    return {{{0, 0}, vertex_weight(w, u, v)}, {{1, 0}, vertex_weight(u, v, w)},  {{0, 1}, vertex_weight(v, w, u)}, {{1, -1}, across_weight(w, u, v)},
            {{1, 1}, across_weight(u, v, w)}, {{-1, 1}, across_weight(v, w, u)}, {{0, -1}, far_weight(w, u)},      {{-1, 0}, far_weight(w, v)},
            {{2, 0}, far_weight(u, v)},       {{2, -1}, far_weight(u, w)},       {{-1, 2}, far_weight(v, w)},      {{0, 2}, far_weight(v, u)}};
}

/// What a patch that is a spline gives, by its own parameters.
struct Values {
    std::array<Vector, 6> of;
    Values() { of.fill(Vector::Zero()); }
    void add(const Jet& weight, const Vector& point) {
        for (int i = 0; i < 6; ++i) of[i] += weight.of[i] * point;
    }
};

/// Parameters of the patch that holds the place, (s, t) = scale (u, v) + something. w is 1 - s - t, kept on its own to stay exact.
struct Position {
    Real s = 0, t = 0, w = 0;
    Matrix2 scale = Matrix2::Identity();

    void turn(Real s_, Real t_, Real w_, Real ss, Real st, Real ts, Real tt) {
        s = s_, t = t_, w = w_;
        const Matrix2 step = (Matrix2() << ss, st, ts, tt).finished();
        scale = step * scale;
    }
};

// Derivatives by (u, v): S_u = sum of S_i di/du.
SurfacePoint in_parameters(const Values& values, const Vector& origin, const Matrix2& scale) {
    const auto& [point, s, t, ss, st, tt] = values.of;
    const Real su = scale(0, 0), sv = scale(0, 1), tu = scale(1, 0), tv = scale(1, 1);
    SurfacePoint result;
    result.point = origin + point;
    result.du = su * s + tu * t;
    result.dv = sv * s + tv * t;
    result.duu = su * su * ss + 2 * su * tu * st + tu * tu * tt;
    result.duv = su * sv * ss + (su * tv + tu * sv) * st + tu * tv * tt;
    result.dvv = sv * sv * ss + 2 * sv * tv * st + tv * tv * tt;
    return result;
}

SurfacePoint extraordinary(const Vector& point) {
    SurfacePoint result;
    result.point = point;
    result.is_extraordinary = true;
    for (Vector* derivative : {&result.du, &result.dv, &result.duu, &result.duv, &result.dvv}) derivative->setConstant(std::numeric_limits<Real>::quiet_NaN());
    return result;
}

// ---- Catmull-Clark and Loop: face 0 of the patch is followed.

/// The next refinement of all that lies round face 0.
class FaceStep {
public:
    FaceStep(const Patch& old, bool is_loop, Real alpha) : old_(old), is_loop_(is_loop), alpha_(alpha) { next_.origin = old.origin; }

    /// Child `child` of face 0, one a corner (Loop: 3 in the middle), and all faces that share a vertex with it.
    Patch child(int child) {
        const auto& tracked = old_.faces[0];
        for (std::size_t i = 0; i < tracked.size(); ++i) add_vertex(tracked[i]);
        int followed = children_.at({0, is_loop_ && child == 3 ? -1 : tracked[child]});
        std::vector<int> kept{followed};
        for (int f = 0; f < static_cast<int>(next_.faces.size()); ++f)
            if (f != followed && share_a_vertex(next_.faces[f], next_.faces[followed])) kept.push_back(f);
        return cut(next_, kept, next_.faces[followed][0]);
    }

private:
    int add_point(const Vector& point) {
        next_.points.push_back(point);
        return static_cast<int>(next_.points.size()) - 1;
    }

    void add_vertex(int v) {
        const int point = add_point(vertex_point(v));
        if (old_.corners.count(v)) next_.corners.insert(point);
        for (int f = 0; f < static_cast<int>(old_.faces.size()); ++f) {
            const auto& face = old_.faces[f];
            if (std::find(face.begin(), face.end(), v) == face.end()) continue;
            const int next = edge_number(v, after(face, v, 1)), previous = edge_number(after(face, v, -1), v);
            if (is_loop_) add_face(f, v, {point, next, previous});
            else add_face(f, v, {point, next, face_number(f), previous});
            for (const auto& [end, middle] : {std::pair{after(face, v, 1), next}, std::pair{after(face, v, -1), previous}})
                if (old_.is_sharp(v, end)) next_.sharp.insert(edge_of(point, middle));
            if (is_loop_ && is_beside(face)) add_middle(f);
        }
    }

    void add_face(int f, int v, const std::vector<int>& points) {
        children_[{f, v}] = static_cast<int>(next_.faces.size());
        next_.faces.push_back(points);
    }

    // Face 0 and its neighbours: all their edges have an end on face 0.
    bool is_beside(const std::vector<int>& face) const {
        const auto& tracked = old_.faces[0];
        return std::count_if(face.begin(), face.end(), [&](int v) { return std::find(tracked.begin(), tracked.end(), v) != tracked.end(); }) >= 2;
    }

    void add_middle(int f) {
        const auto& face = old_.faces[f];
        if (children_.count({f, -1})) return;
        add_face(f, -1, {edge_number(face[0], face[1]), edge_number(face[1], face[2]), edge_number(face[2], face[0])});
    }

    int edge_number(int a, int b) {
        const Edge edge = edge_of(a, b);
        if (!edges_.count(edge)) edges_[edge] = add_point(edge_point(a, b));
        return edges_[edge];
    }
    int face_number(int f) {
        if (!centres_.count(f)) centres_[f] = add_point(mean_of(old_, old_.faces[f]));
        return centres_[f];
    }

    Vector edge_point(int a, int b) const {
        const Vector ends = old_.points[a] + old_.points[b];
        if (old_.is_sharp(a, b)) return ends / 2;
        const auto &left = old_.faces.at(old_.face_at(a, b)), &right = old_.faces.at(old_.face_at(b, a));
        if (is_loop_) return Real(0.375) * ends + Real(0.125) * (old_.points[after(left, b, 1)] + old_.points[after(right, a, 1)]);
        return (ends + mean_of(old_, left) + mean_of(old_, right)) / 4;
    }

    Vector vertex_point(int v) const {
        const Vector& here = old_.points[v];
        const auto ends = sharp_ends(old_, v);
        if (old_.corners.count(v)) return here;
        if (ends.size() == 2) return (old_.points[ends[0]] + 6 * here + old_.points[ends[1]]) / 8;
        Real n = 0;
        Vector edges = Vector::Zero(), centres = edges;
        for (const auto& face : old_.faces) {
            if (std::find(face.begin(), face.end(), v) == face.end()) continue;
            n += 1;
            edges += old_.points[after(face, v, 1)];  // every edge at an inner vertex leaves it once
            centres += mean_of(old_, face);
        }
        if (is_loop_) {
            const Real part = Real(0.375) + std::cos(2 * pi / n) / 4, beta = (Real(0.625) - part * part) / n;
            return (1 - n * beta) * here + beta * edges;
        }
        return ((n - 2 + alpha_) * here + ((1 - alpha_) * edges + centres) / n) / n;
    }

    const Patch& old_;
    const bool is_loop_;
    const Real alpha_;
    Patch next_;
    std::map<Edge, int> edges_;
    std::map<int, int> centres_;
    std::map<std::pair<int, int>, int> children_;  // (face, vertex, -1: middle) -> new face
};

/// A quad is regular where at each vertex its sector is the one of a bicubic spline: four quads round it, two along a curve, one in a corner.
bool is_regular_quad_corner(const Patch& patch, int v) {
    const Sector sector = sector_of(patch, v, 0);
    for (const int f : sector.faces)
        if (patch.faces[f].size() != 4) return false;
    const std::size_t sharp = sharp_ends(patch, v).size();
    if (patch.corners.count(v)) return !sector.is_closed && sector.size() == 1;
    return (sharp == 0 && sector.size() == 4) || (sharp == 2 && sector.size() == 2);
}

/// Sixteen control points by their places round the quad (0, 0), (1, 0), (1, 1), (0, 1); those beyond sharp sides are ghosts, 2 P - P_inner.
std::optional<std::map<Cell, Vector>> bicubic_net(const Patch& patch) {
    static const std::array<Cell, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, along{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const auto& face = patch.faces[0];
    if (face.size() != 4) return std::nullopt;
    for (const int v : face)
        if (!is_regular_quad_corner(patch, v)) return std::nullopt;
    std::map<Cell, Vector> net;
    for (int k = 0; k < 4; ++k) net[square[k]] = patch.points[face[k]];
    for (int k = 0; k < 4; ++k) {
        const int a = face[k], b = face[(k + 1) % 4];
        if (patch.is_sharp(a, b)) continue;
        const Cell out = Cell{0, 0} - along[(k + 1) % 4];
        const auto& beside = patch.faces[patch.face_at(b, a)];
        const int outer = after(beside, a, 1);
        net[square[k] + out] = patch.points[outer];
        net[square[(k + 1) % 4] + out] = patch.points[after(beside, a, 2)];
        if (patch.is_sharp(a, outer)) continue;
        net[square[k] + out - along[k]] = patch.points[after(patch.faces[patch.face_at(outer, a)], a, 2)];
    }
    for (const int k : {0, 2, 1, 3}) {  // rows first, so that columns find them complete
        if (!patch.is_sharp(face[k], face[(k + 1) % 4])) continue;
        const Cell out = Cell{0, 0} - along[(k + 1) % 4];
        for (int i = -1; i <= 2; ++i) {
            const Cell at{square[k].first + i * along[k].first, square[k].second + i * along[k].second};
            if (net.count(at)) net[at + out] = 2 * net[at] - net.at(at - out);
        }
    }
    if (net.size() != 16) throw std::logic_error("a bicubic patch without all its points");
    return net;
}

/// The points round face 0 of a Loop patch: at each vertex six triangles, or three along a curve, and beyond that two ghosts, a + b - c.
std::optional<std::map<Cell, Vector>> box_net(const Patch& patch) {
    static const std::array<Cell, 6> round{{{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}}};
    static const std::array<Cell, 3> triangle{{{0, 0}, {1, 0}, {0, 1}}};
    std::map<Cell, Vector> net;
    for (std::size_t k = 0; k < 3; ++k) {
        const int v = patch.faces[0][k];
        const Sector sector = sector_of(patch, v, 0);
        const std::size_t sharp = sharp_ends(patch, v).size();
        if (patch.corners.count(v) || !((sharp == 0 && sector.size() == 6) || (sharp == 2 && sector.size() == 3))) return std::nullopt;
        const auto own = static_cast<std::size_t>(std::find(sector.faces.begin(), sector.faces.end(), 0) - sector.faces.begin());
        const std::size_t first = 2 * k + 6 - own;  // direction of the sector's first edge: face 0 lies between the directions 2 k and 2 k + 1
        const auto at = [&](std::size_t i) { return triangle[k] + round[(first + i) % 6]; };
        for (std::size_t i = 0; i < sector.size(); ++i) {
            net[at(i)] = patch.points[after(patch.faces[sector.faces[i]], v, 1)];
            net[at(i + 1)] = patch.points[after(patch.faces[sector.faces[i]], v, -1)];
        }
        if (sharp == 0) continue;
        net[at(4)] = patch.points[v] + net[at(3)] - net[at(2)];
        net[at(5)] = patch.points[v] + net[at(0)] - net[at(1)];
    }
    if (net.size() != 12) throw std::logic_error("a box spline without all its points");
    return net;
}

Values bicubic_values(const std::map<Cell, Vector>& net, const Position& position) {
    const auto weights = tensor_weights(3, position.s, position.t);
    Values values;
    for (const auto& [cell, point] : net) values.add(weights[4 * (cell.second + 1) + cell.first + 1], point);
    return values;
}

Values box_values(const std::map<Cell, Vector>& net, const Position& position) {
    const auto weights = box_weights(position.w, position.s, position.t);
    Values values;
    for (const auto& [cell, point] : net) values.add(weights.at(cell), point);
    return values;
}

// The child of a quad that holds the position; from then on the position is that in the child.
int descend_quad(Position& at) {
    const Real s = at.s, t = at.t;
    const bool right = s > Real(0.5), up = t > Real(0.5);
    if (!right && !up) at.turn(2 * s, 2 * t, 0, 2, 0, 0, 2);
    else if (right && !up) at.turn(2 * t, 2 * (1 - s), 0, 0, 2, -2, 0);
    else if (right) at.turn(2 * (1 - s), 2 * (1 - t), 0, -2, 0, 0, -2);
    else at.turn(2 * (1 - t), 2 * s, 0, 0, -2, 2, 0);
    return !right && !up ? 0 : right && !up ? 1 : right ? 2 : 3;
}

int descend_triangle(Position& at) {
    const Real s = at.s, t = at.t, w = at.w;
    if (2 * w >= 1) at.turn(2 * s, 2 * t, w - s - t, 2, 0, 0, 2);
    else if (2 * s >= 1) at.turn(2 * t, 2 * w, s - t - w, 0, 2, -2, -2);
    else if (2 * t >= 1) at.turn(2 * w, 2 * s, t - s - w, -2, -2, 2, 0);
    else at.turn(1 - 2 * w, 1 - 2 * s, 1 - 2 * t, 2, 2, -2, 0);
    return 2 * w >= 1 ? 0 : 2 * s >= 1 ? 1 : 2 * t >= 1 ? 2 : 3;
}

// The corner of face 0 that the position is exactly at, or -1.
int corner_at(const Patch& patch, const Position& at, bool is_loop) {
    if ((at.s != 0 && at.s != 1) || (at.t != 0 && at.t != 1)) return -1;
    const int corner = is_loop ? (at.s == 1 ? 1 : at.t == 1 ? 2 : 0) : at.t == 0 ? (at.s == 0 ? 0 : 1) : at.s == 1 ? 2 : 3;
    return patch.faces[0][corner];
}

// ---- Doo-Sabin: the patch of a vertex is followed. Its corners (0, 0), (1, 0), (1, 1), (0, 1), the quadrants 0 to 3, are the centres of faces round the
// vertex; where a quadrant has none, a sharp edge lies between.

using Quadrants = std::array<int, 4>;  // faces, -1: none

Quadrants quadrants_of(const Patch& patch, int w, int known, int face) {
    Quadrants quadrants{-1, -1, -1, -1};
    const Sector sector = sector_of(patch, w, face);
    if (sector.size() > 4) throw std::invalid_argument("a Doo-Sabin patch beside a corner inside");
    const int own = static_cast<int>(std::find(sector.faces.begin(), sector.faces.end(), face) - sector.faces.begin());
    for (int i = 0; i < static_cast<int>(sector.size()); ++i) quadrants[(known + i - own + 8) % 4] = sector.faces[i];
    return quadrants;
}

struct DooSabinPatch {
    Patch patch;
    int vertex = 0;
    Quadrants quadrants{};
};

Real doo_sabin_weight(lcl::DooSabinMask mask, int m, int steps) {
    if (mask == lcl::DooSabinMask::classic) return steps == 0 ? (m + Real(5)) / (4 * m) : (3 + 2 * std::cos(2 * pi * steps / m)) / (4 * m);
    return Real(1) / (4 * m) + (steps == 0 ? Real(0.5) : 0) + (steps == 1 ? Real(0.125) : 0) + (steps == m - 1 ? Real(0.125) : 0);
}

/// The next refinement of one sector of faces round a vertex.
class VertexStep {
public:
    VertexStep(const Patch& old, int w, int face, lcl::DooSabinMask mask) : old_(old), w_(w), mask_(mask), sector_(sector_of(old, w, face)) {
        next_.origin = old.origin;
        for (const int f : sector_.faces) add_face(f);
        for (std::size_t i = 0; i + (sector_.is_closed ? 0 : 1) < sector_.size(); ++i) {
            const int here = sector_.faces[i], there = sector_.faces[(i + 1) % sector_.size()], x = after(old.faces[here], w, -1);
            add({in_face(here, w), in_face(here, x), in_face(there, x), in_face(there, w)});
        }
        if (!sector_.is_closed) add_curve();
        else if (old.corners.count(w)) throw std::invalid_argument("a Doo-Sabin patch beside a corner inside");
        else vertex_face_ = add(points_of_w());
    }

    /// The patch of the new vertex that w makes in an old face.
    DooSabinPatch inside(int face, int quadrant) const { return around(in_face(face, w_), quadrant, new_faces_.at(face)); }
    /// Those of the boundary points next to w on the sector's first and last edge, whose face of the edge lies in `quadrant`.
    DooSabinPatch on_first_edge(int quadrant) const { return around(first_point_, quadrant, first_face_); }
    DooSabinPatch on_last_edge(int quadrant) const { return around(last_point_, quadrant, last_face_); }
    /// That of the corner that w stays.
    DooSabinPatch kept(int quadrant) const { return around(kept_, quadrant, vertex_face_); }

private:
    int add_point(const Vector& point) {
        next_.points.push_back(point);
        return static_cast<int>(next_.points.size()) - 1;
    }
    int add(const std::vector<int>& face) {
        for (std::size_t i = 0; i < face.size(); ++i) next_.face_of[{face[i], face[(i + 1) % face.size()]}] = static_cast<int>(next_.faces.size());
        next_.faces.push_back(face);
        return static_cast<int>(next_.faces.size()) - 1;
    }
    int in_face(int f, int v) const { return corner_points_.at({f, v}); }

    void add_face(int f) {
        const auto& face = old_.faces[f];
        const int m = static_cast<int>(face.size());
        std::vector<int> points;
        for (int i = 0; i < m; ++i) {
            Vector point = Vector::Zero();
            for (int j = 0; j < m; ++j) point += doo_sabin_weight(mask_, m, j) * old_.points[face[(i + j) % m]];
            points.push_back(add_point(point));
            corner_points_[{f, face[i]}] = points.back();
        }
        new_faces_[f] = add(points);
    }

    std::vector<int> points_of_w() const {
        std::vector<int> points;
        for (const int f : sector_.faces) points.push_back(in_face(f, w_));
        return points;
    }

    int near(int a, int b) { return add_point((3 * old_.points[a] + old_.points[b]) / 4); }

    // A ghost row equal to the boundary row: a sharp edge ab gets the points 3/4 a + 1/4 b and 1/4 a + 3/4 b.
    void add_curve() {
        const int first = sector_.faces.front(), last = sector_.faces.back(), next = after(old_.faces[first], w_, 1),
                  previous = after(old_.faces[last], w_, -1);
        first_point_ = near(w_, next);
        last_point_ = near(w_, previous);
        const int beyond_first = near(next, w_), beyond_last = near(previous, w_);
        first_face_ = add({beyond_first, in_face(first, next), in_face(first, w_), first_point_});
        last_face_ = add({last_point_, in_face(last, w_), in_face(last, previous), beyond_last});
        next_.sharp = {edge_of(first_point_, beyond_first), edge_of(last_point_, beyond_last)};
        std::vector<int> points = points_of_w();
        points.insert(points.begin(), first_point_);
        points.push_back(last_point_);
        if (old_.corners.count(w_)) {
            kept_ = add_point(old_.points[w_]);
            points.push_back(kept_);
            next_.corners.insert(kept_);
            next_.sharp.insert({edge_of(first_point_, kept_), edge_of(last_point_, kept_)});
        } else {
            next_.sharp.insert(edge_of(first_point_, last_point_));
        }
        vertex_face_ = add(points);
    }

    DooSabinPatch around(int vertex, int quadrant, int face) const {
        if (vertex < 0) throw std::invalid_argument("no Doo-Sabin patch is there");
        std::vector<int> kept{face};
        for (int f = 0; f < static_cast<int>(next_.faces.size()); ++f) {
            const auto& points = next_.faces[f];
            if (f != face && std::find(points.begin(), points.end(), vertex) != points.end()) kept.push_back(f);
        }
        DooSabinPatch result;
        result.patch = cut(next_, kept, vertex);
        const auto& points = next_.faces[face];
        result.vertex = result.patch.faces[0][std::find(points.begin(), points.end(), vertex) - points.begin()];
        result.quadrants = quadrants_of(result.patch, result.vertex, quadrant, 0);
        return result;
    }

    const Patch& old_;
    const int w_;
    const lcl::DooSabinMask mask_;
    const Sector sector_;
    Patch next_;
    std::map<std::pair<int, int>, int> corner_points_;  // (old face, old vertex) -> point
    std::map<int, int> new_faces_;                      // old face -> new face
    int vertex_face_ = -1, first_point_ = -1, last_point_ = -1, first_face_ = -1, last_face_ = -1, kept_ = -1;
};

DooSabinPatch child_in_quadrant(const DooSabinPatch& from, int quadrant, lcl::DooSabinMask mask) {
    const auto face = [&](int turn) { return from.quadrants[(quadrant + turn) % 4]; };
    int some = -1;
    for (int turn = 0; turn < 4; ++turn) some = some < 0 ? face(turn) : some;
    const VertexStep step(from.patch, from.vertex, some, mask);
    if (face(0) >= 0) return step.inside(face(0), quadrant);
    if (face(1) >= 0) return step.on_first_edge((quadrant + 1) % 4);
    if (face(3) >= 0) return step.on_last_edge((quadrant + 3) % 4);
    return step.kept((quadrant + 2) % 4);
}

/// Nine control points, the vertex at (0, 0), the points beyond sharp edges those on them once more.
std::optional<std::map<Cell, Vector>> biquadratic_net(const DooSabinPatch& from) {
    static const std::array<Cell, 4> sides{{{-1, 0}, {0, -1}, {1, 0}, {0, 1}}};  // the point that follows the vertex in the face of quadrant q
    const Patch& patch = from.patch;
    const auto& faces = from.quadrants;
    const std::ptrdiff_t count = 4 - std::count(faces.begin(), faces.end(), -1);
    const bool is_corner = patch.corners.count(from.vertex) != 0;
    if (is_corner != (count == 1) || count == 3) throw std::invalid_argument("a Doo-Sabin patch beside a corner that stays on a curve");
    std::map<Cell, Vector> net{{{0, 0}, patch.points[from.vertex]}};
    for (int q = 0; q < 4; ++q) {
        if (faces[q] < 0) continue;
        const auto& face = patch.faces[faces[q]];
        if (face.size() != 4) return std::nullopt;
        const Cell next = sides[q], previous = sides[(q + 1) % 4];
        net[next] = patch.points[after(face, from.vertex, 1)];
        net[next + previous] = patch.points[after(face, from.vertex, 2)];
        net[previous] = patch.points[after(face, from.vertex, 3)];
    }
    const std::map<Cell, Vector> known = net;
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) net[{i, j}] = known.at({i != 0 && !known.count({i, 0}) ? 0 : i, j != 0 && !known.count({0, j}) ? 0 : j});
    return net;
}

Values biquadratic_values(const std::map<Cell, Vector>& net, const Position& position) {
    const auto weights = tensor_weights(2, position.s, position.t);
    Values values;
    for (const auto& [cell, point] : net) values.add(weights[3 * (cell.second + 1) + cell.first + 1], point);
    return values;
}

// The quadrant that holds the position; from then on the position is that in the child.
int descend_quadrant(Position& at) {
    const bool right = at.s > Real(0.5), up = at.t > Real(0.5);
    at.turn(2 * at.s - (right ? 1 : 0), 2 * at.t - (up ? 1 : 0), 0, 2, 0, 0, 2);
    return up ? (right ? 2 : 3) : (right ? 1 : 0);
}

// The face of a quadrant whose centre the position is exactly at, or -1.
int face_at_corner(const DooSabinPatch& from, const Position& at) {
    if ((at.s != 0 && at.s != 1) || (at.t != 0 && at.t != 1)) return -1;
    return from.quadrants[at.t == 0 ? (at.s == 0 ? 0 : 1) : at.s == 1 ? 2 : 3];
}

}  // namespace

LimitSurface::LimitSurface(const Surface& surface, const Eigen::MatrixXd& points, const lcl::SchemeOptions& options)
    : surface_(surface), options_(options), vertex_faces_(surface.vertex_count) {
    if (options.is_two_phase()) throw std::invalid_argument("a two-phase surface is that of its refined mesh");
    for (int v = 0; v < surface.vertex_count; ++v) points_.emplace_back(points.row(v).transpose().cast<Real>());
    for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f)
        for (const int v : surface.faces[f]) vertex_faces_[v].push_back(f);
}

SurfacePoint LimitSurface::evaluate(const Place& place) const { return options_.scheme == lcl::Scheme::doo_sabin ? on_doo_sabin_patch(place) : on_face(place); }

SurfacePoint LimitSurface::at(const Place& place) const {
    SurfacePoint result = evaluate(place);
    if (!result.is_extraordinary || place.u != 0 || place.v != 0) return result;
    const Real near = std::ldexp(Real(1), -depth_of_tangents);
    result.du = evaluate({place.face, place.corner, near, 0}).du.normalized();
    result.dv = evaluate({place.face, place.corner, 0, near}).dv.normalized();
    return result;
}

SurfacePoint LimitSurface::on_face(const Place& place) const {
    const bool is_loop = options_.scheme == lcl::Scheme::loop;
    std::vector<int> kept{place.face};
    for (const int v : surface_.faces.at(place.face)) kept.insert(kept.end(), vertex_faces_[v].begin(), vertex_faces_[v].end());
    std::sort(kept.begin() + 1, kept.end());
    kept.erase(std::unique(kept.begin() + 1, kept.end()), kept.end());
    kept.erase(std::find(kept.begin() + 1, kept.end(), place.face));
    Patch patch = cut(surface_, points_, kept, surface_.faces[place.face][0]);
    Position position;
    position.s = place.u, position.t = place.v, position.w = (1 - place.u) - place.v;
    for (int level = 0, rest = 0;; ++level) {
        const bool is_polygon = !is_loop && patch.faces[0].size() != 4;
        const bool may_be_regular = level > 0 || options_.alpha == 0;  // alpha rules the first refinement
        if (const auto net = !may_be_regular || is_polygon ? std::nullopt : is_loop ? box_net(patch) : bicubic_net(patch)) {
            SurfacePoint result = in_parameters(is_loop ? box_values(*net, position) : bicubic_values(*net, position), patch.origin, position.scale);
            result.levels = level;
            return result;
        }
        const int corner = is_polygon ? -1 : corner_at(patch, position, is_loop);
        rest = corner < 0 ? 0 : rest + 1;
        if (rest > depth_of_points) return extraordinary(patch.origin + patch.points[corner]);
        const int child = is_polygon ? place.corner : is_loop ? descend_triangle(position) : descend_quad(position);
        patch = FaceStep(patch, is_loop, level == 0 ? static_cast<Real>(options_.alpha) : 0).child(child);
    }
}

SurfacePoint LimitSurface::on_doo_sabin_patch(const Place& place) const {
    if (surface_.boundary_is_fixed) throw std::invalid_argument("Doo-Sabin with a fixed boundary");
    const int w = surface_.faces.at(place.face).at(place.corner);
    std::vector<int> kept = vertex_faces_[w];
    std::iter_swap(kept.begin(), std::find(kept.begin(), kept.end(), place.face));
    const Patch umbrella = cut(surface_, points_, kept, w);
    const int centre = umbrella.faces[0][place.corner];
    const VertexStep first(umbrella, centre, 0, options_.mask);
    DooSabinPatch patch = place.u < 0 && place.v < 0 ? first.kept(2)
                          : place.v < 0              ? first.on_first_edge(2)
                          : place.u < 0              ? first.on_last_edge(2)
                                                     : first.inside(0, 2);
    Position position;
    position.s = place.u < 0 ? place.u + 1 : place.u, position.t = place.v < 0 ? place.v + 1 : place.v;
    for (int level = 1, rest = 0;; ++level) {
        if (const auto net = biquadratic_net(patch)) {
            SurfacePoint result = in_parameters(biquadratic_values(*net, position), patch.patch.origin, position.scale);
            result.levels = level;
            return result;
        }
        const int face = face_at_corner(patch, position);
        rest = face < 0 ? 0 : rest + 1;
        if (rest > depth_of_points) return extraordinary(patch.patch.origin + mean_of(patch.patch, patch.patch.faces[face]));
        patch = child_in_quadrant(patch, descend_quadrant(position), options_.mask);
    }
}

}  // namespace oracle
