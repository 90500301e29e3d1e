// SPDX-License-Identifier: BSD-3-Clause
#include "tests/shapes/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace shapes {

namespace {

const double pi = std::acos(-1.0);

Point sum(const Point& a, const Point& b, double scale = 1) { return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]}; }

Point unit(const Point& p) {
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return {p[0] / length, p[1] / length, p[2] / length};
}

Point centroid(const std::vector<Point>& points, const Face& face) {
    Point result{0, 0, 0};
    for (const int v : face) result = sum(result, points[v], 1.0 / static_cast<double>(face.size()));
    return result;
}

Shape prism(std::string name, int sides) {
    std::vector<Point> points;
    std::vector<Face> faces(2);
    for (const double z : {-1.0, 1.0})
        for (int i = 0; i < sides; ++i) points.push_back({std::cos(2 * pi * i / sides), std::sin(2 * pi * i / sides), z});
    for (int i = 0; i < sides; ++i) {
        faces[0].insert(faces[0].begin(), i);
        faces[1].push_back(sides + i);
        faces.push_back({i, (i + 1) % sides, sides + (i + 1) % sides, sides + i});
    }
    return make(std::move(name), points, faces);
}

// Numbers for the middles of edges, in order of first use.
class EdgeMiddles {
public:
    explicit EdgeMiddles(std::vector<Point>& points) : points_(points) {}
    int of(int a, int b) {
        const auto [found, is_new] = number_.emplace(std::minmax(a, b), static_cast<int>(points_.size()));
        if (is_new) points_.push_back(sum(sum({0, 0, 0}, points_[a], 0.5), points_[b], 0.5));
        return found->second;
    }

private:
    std::vector<Point>& points_;
    std::map<std::pair<int, int>, int> number_;
};

// Every triangle of a ball cut into four, the new vertices moved on to the unit sphere.
Shape finer_ball(const Shape& ball) {
    auto points = points_of(ball.mesh);
    std::vector<Face> faces;
    EdgeMiddles middle(points);
    for (const Face& f : faces_of(ball.mesh)) {
        const int a = middle.of(f[0], f[1]), b = middle.of(f[1], f[2]), c = middle.of(f[2], f[0]);
        faces.insert(faces.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
    }
    for (Point& p : points) p = unit(p);
    return make(ball.name, points, faces);
}

std::vector<Point> torus_points(int m, int n) {
    std::vector<Point> points;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i) {
            const double u = 2 * pi * i / m, v = 2 * pi * j / n, ring = 1 + 0.4 * std::cos(v);
            points.push_back({ring * std::cos(u), ring * std::sin(u), 0.4 * std::sin(v)});
        }
    return points;
}

// m x n quads over columns x rows of vertices; indices wrap where there are as many columns (rows) as faces.
std::vector<Face> sheet_faces(int m, int n, int columns, int rows, bool triangles) {
    std::vector<Face> faces;
    const auto at = [&](int i, int j) { return (j % rows) * columns + i % columns; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i) {
            const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (triangles) faces.insert(faces.end(), {{a, b, c}, {a, c, d}});
            else faces.push_back({a, b, c, d});
        }
    return faces;
}

Shape grid(const std::string& name, int m, int n, bool triangles) {
    std::vector<Point> points;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= m; ++i) {
            const double x = 2.0 * i / m - 1, y = 2.0 * j / n - 1;
            points.push_back({x, y, 0.3 * std::sin(2 * x) * std::cos(3 * y)});
        }
    return make(name + "_" + std::to_string(m) + "x" + std::to_string(n), points, sheet_faces(m, n, m + 1, n + 1, triangles));
}

Shape torus(const std::string& name, int m, int n, bool triangles) {
    return make(name + "_" + std::to_string(m) + "x" + std::to_string(n), torus_points(m, n), sheet_faces(m, n, m, n, triangles));
}

Shape renamed(Shape shape, std::string name) {
    shape.name = std::move(name);
    return shape;
}

Shape with_features(Shape shape, std::string name, std::vector<std::array<lcl::Index, 2>> creases, std::vector<lcl::Index> corners = {}) {
    shape.name = std::move(name);
    shape.features.creases = std::move(creases);
    shape.features.corners = std::move(corners);
    return shape;
}

Shape single_polygon(std::string name, int sides) {
    std::vector<Point> points;
    std::vector<Face> faces(1);
    for (int i = 0; i < sides; ++i) {
        points.push_back({std::cos(2 * pi * i / sides), std::sin(2 * pi * i / sides), 0.1 * i});
        faces[0].push_back(i);
    }
    return make(std::move(name), points, faces);
}

template <typename List>
void append(List& list, List more) {
    for (auto& item : more) list.push_back(std::move(item));
}

}  // namespace

double Random::next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
}

int Random::below(int count) { return std::min(count - 1, static_cast<int>(next() * count)); }

Shape make(std::string name, const std::vector<Point>& points, const std::vector<Face>& faces) {
    Shape shape;
    shape.name = std::move(name);
    shape.mesh.vertex_count = static_cast<lcl::Index>(points.size());
    for (const Point& p : points) shape.mesh.positions.insert(shape.mesh.positions.end(), p.begin(), p.end());
    for (const Face& face : faces) {
        shape.mesh.face_vertices.insert(shape.mesh.face_vertices.end(), face.begin(), face.end());
        shape.mesh.face_offsets.push_back(shape.mesh.corner_count());
    }
    return shape;
}

std::vector<Face> faces_of(const lcl::PolygonMesh& mesh) {
    std::vector<Face> faces;
    for (lcl::Index f = 0; f < mesh.face_count(); ++f)
        faces.emplace_back(mesh.face_vertices.begin() + mesh.face_offsets[f], mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
    return faces;
}

std::vector<Point> points_of(const lcl::PolygonMesh& mesh) {
    std::vector<Point> points;
    for (lcl::Index v = 0; v < mesh.vertex_count; ++v) points.push_back({mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]});
    return points;
}

bool is_triangle_mesh(const lcl::PolygonMesh& mesh) {
    for (lcl::Index f = 0; f < mesh.face_count(); ++f)
        if (mesh.degree(f) != 3) return false;
    return true;
}

Shape tetrahedron() { return make("tetrahedron", {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}); }

Shape cube() {
    return make("cube", {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
                {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

Shape cube_split_edges() {
    const Shape whole = cube();
    auto points = points_of(whole.mesh);
    EdgeMiddles middle(points);
    std::vector<Face> faces;
    for (const Face& f : faces_of(whole.mesh)) {
        faces.emplace_back();
        for (int i = 0; i < 4; ++i) append(faces.back(), Face{f[i], middle.of(f[i], f[(i + 1) % 4])});
    }
    return make("cube_split_edges", points, faces);
}

Shape octahedron() {
    return make("octahedron", {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}});
}

Shape icosahedron() {
    std::vector<Point> points{{0, 0, 1}};
    std::vector<Face> faces;
    for (int i = 0; i < 10; ++i) {
        const double z = (i < 5 ? 1 : -1) / std::sqrt(5.0), r = 2 / std::sqrt(5.0), angle = 2 * pi * (i < 5 ? i : i + 0.5) / 5;
        points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
    points.push_back({0, 0, -1});
    for (int i = 0; i < 5; ++i) {
        const int a = 1 + i, b = 1 + (i + 1) % 5, c = 6 + i, d = 6 + (i + 1) % 5;
        faces.insert(faces.end(), {{0, a, b}, {a, c, b}, {b, c, d}, {11, d, c}});
    }
    return make("icosahedron", points, faces);
}

Shape dodecahedron() { return renamed(dual_of(icosahedron()), "dodecahedron"); }
Shape triangular_prism() { return prism("triangular_prism", 3); }
Shape hexagonal_prism() { return prism("hexagonal_prism", 6); }

Shape truncated_octahedron() {
    const Shape whole = cube();
    auto points = points_of(whole.mesh);
    std::vector<Face> faces;
    for (const Face& f : faces_of(whole.mesh)) {
        points.push_back(sum({0, 0, 0}, centroid(points, f), 1.5));
        for (int i = 0; i < 4; ++i) faces.push_back({f[i], f[(i + 1) % 4], static_cast<int>(points.size()) - 1});
    }
    return renamed(dual_of(make("tetrakis_hexahedron", points, faces)), "truncated_octahedron");
}

Shape icosphere(int levels) {
    Shape result = icosahedron();
    for (int level = 0; level < levels; ++level) result = finer_ball(result);
    return renamed(result, "icosphere_" + std::to_string(levels));
}

Shape icosphere_quads(int levels) {
    const Shape ball = icosphere(levels);
    auto points = points_of(ball.mesh);
    std::vector<Face> faces;
    EdgeMiddles middle(points);
    for (const Face& f : faces_of(ball.mesh)) {
        const int a = middle.of(f[0], f[1]), b = middle.of(f[1], f[2]), c = middle.of(f[2], f[0]), centre = static_cast<int>(points.size());
        points.push_back(centroid(points, f));
        faces.insert(faces.end(), {{f[0], a, centre, c}, {f[1], b, centre, a}, {f[2], c, centre, b}});
    }
    for (Point& p : points) p = unit(p);
    return make("icosphere_quads_" + std::to_string(levels), points, faces);
}

Shape valence_2_pole() {
    return make("valence_2_pole", {{0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, -1}},
                {{0, 1, 3, 2}, {0, 2, 4, 1}, {1, 4, 5}, {4, 2, 5}, {2, 3, 5}, {3, 1, 5}});
}

Shape neighbour_also_diagonal() {
    return make("neighbour_also_diagonal",
                {{0, 0, 1}, {0, 0, -1}, {-1, 0, 0.2}, {1, 0, 0.2}, {-0.6, -0.5, -0.4}, {0.6, -0.5, -0.4}, {-0.7, 0.3, -0.6}, {0.7, 0.3, -0.6}},
                {{0, 1, 2}, {0, 3, 1}, {0, 2, 4, 1, 5, 3}, {2, 1, 6}, {1, 4, 6}, {4, 2, 6}, {1, 3, 7}, {3, 5, 7}, {5, 1, 7}});
}

Shape torus_quads(int m, int n) { return torus("torus_quads", m, n, false); }
Shape torus_triangles(int m, int n) { return torus("torus_triangles", m, n, true); }
Shape hexagonal_torus(int m, int n) { return renamed(dual_of(torus_triangles(m, n)), "hexagonal_torus_" + std::to_string(m) + "x" + std::to_string(n)); }
Shape grid_quads(int m, int n) { return grid("grid_quads", m, n, false); }
Shape grid_triangles(int m, int n) { return grid("grid_triangles", m, n, true); }

Shape grid_with_hole() {
    const Shape whole = grid_quads(5, 5);
    auto faces = faces_of(whole.mesh);
    faces.erase(faces.begin() + 12);
    return make("grid_with_hole", points_of(whole.mesh), faces);
}

Shape cylinder_open(int m, int n) {
    std::vector<Point> points;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i < m; ++i) points.push_back({std::cos(2 * pi * i / m), std::sin(2 * pi * i / m), 2.0 * j / n - 1});
    return make("cylinder_open_" + std::to_string(m) + "x" + std::to_string(n), points, sheet_faces(m, n, m, n + 1, false));
}

Shape disk_pole_triangles(int n) {
    std::vector<Point> points{{0, 0, 0.5}};
    std::vector<Face> faces;
    for (int i = 0; i < n; ++i) {
        points.push_back({std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0});
        faces.push_back({0, 1 + i, 1 + (i + 1) % n});
    }
    return make("disk_pole_triangles_" + std::to_string(n), points, faces);
}

Shape disk_pole_quads(int n) {
    std::vector<Point> points{{0, 0, 0.5}};
    std::vector<Face> faces;
    for (int i = 0; i < 2 * n; ++i) {
        points.push_back({std::cos(pi * i / n), std::sin(pi * i / n), 0.1 * (i % 2)});
        if (i % 2 == 0) faces.push_back({0, 1 + i, 2 + i, 1 + (i + 2) % (2 * n)});
    }
    return make("disk_pole_quads_" + std::to_string(n), points, faces);
}

Shape single_triangle() { return single_polygon("single_triangle", 3); }
Shape single_quad() { return single_polygon("single_quad", 4); }
Shape single_hexagon() { return single_polygon("single_hexagon", 6); }

Shape cube_with_crease() { return with_features(cube(), "cube_with_crease", {{4, 5}, {5, 6}, {6, 7}}); }
Shape cube_with_crease_loop() { return with_features(cube(), "cube_with_crease_loop", {{4, 5}, {5, 6}, {7, 6}, {7, 4}}); }
Shape cube_with_dart() { return with_features(cube(), "cube_with_dart", {{6, 2}}); }

// Vertex (i, j) of a 6 x 6 grid is 7 j + i.
Shape grid_with_creases() {
    return with_features(grid_quads(6, 6), "grid_with_creases",
                         {{3, 10},
                          {10, 17},
                          {17, 24},
                          {24, 31},
                          {31, 38},
                          {38, 45},  // the column i = 3 from boundary to boundary
                          {22, 23},
                          {23, 24},
                          {24, 25},
                          {25, 26},  // across it at (3, 3), a dart at both ends
                          {8, 9},
                          {9, 2},      // from the dart (1, 1) round one face to the boundary
                          {40, 41}});  // a dart at (5, 5) that ends on the boundary
}

Shape grid_with_marked_corner() { return with_features(grid_quads(4, 5), "grid_with_marked_corner", {}, {12, 10}); }

Shape grid_triangles_with_creases() {
    return with_features(grid_triangles(5, 5), "grid_triangles_with_creases", {{2, 8}, {8, 14}, {14, 21}, {14, 15}, {25, 26}, {26, 32}}, {19});
}

Shape torus_with_dart() { return with_features(torus_quads(6, 5), "torus_with_dart", {{7, 8}, {8, 14}, {14, 20}}); }
Shape torus_triangles_with_dart() { return with_features(torus_triangles(6, 5), "torus_triangles_with_dart", {{7, 8}, {8, 15}, {15, 21}}); }

Shape icosphere_with_crease_loop() {
    Shape ball = finer_ball(finer_ball(octahedron()));
    const auto points = points_of(ball.mesh);
    std::vector<std::array<lcl::Index, 2>> creases;
    for (const Face& f : faces_of(ball.mesh))
        for (int i = 0; i < 3; ++i) {
            const int a = f[i], b = f[(i + 1) % 3];
            if (a < b && std::abs(points[a][2]) < 1e-9 && std::abs(points[b][2]) < 1e-9) creases.push_back({a, b});
        }
    return with_features(ball, "icosphere_with_crease_loop", creases);
}

Shape box_with_crease_angle() {
    std::vector<Point> points;
    std::vector<Face> faces;
    std::map<std::array<int, 3>, int> number;
    const auto at = [&](std::array<int, 3> key) {
        const auto [found, is_new] = number.emplace(key, static_cast<int>(points.size()));
        if (is_new) points.push_back({key[0] / 1.5 - 1, key[1] / 1.5 - 1, key[2] / 1.5 - 1});
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, 3})
            for (int i = 0; i < 9; ++i) {
                const auto corner = [&](int u, int v) {
                    std::array<int, 3> key{};
                    key[axis] = side;
                    key[(axis + 1) % 3] = i % 3 + u;
                    key[(axis + 2) % 3] = i / 3 + v;
                    return at(key);
                };
                Face face{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                if (side == 0) std::reverse(face.begin(), face.end());
                faces.push_back(face);
            }
    Shape box = make("box_with_crease_angle", points, faces);
    box.features.crease_angle_degrees = 60;
    return box;
}

Shape rough(Shape shape, double amplitude, std::uint64_t seed) {
    Random random(seed);
    for (double& x : shape.mesh.positions) x += amplitude * random.symmetric();
    shape.name += "_rough";
    return shape;
}

Shape shuffled(const Shape& shape, std::uint64_t seed) {
    Random random(seed);
    const int count = shape.mesh.vertex_count;
    std::vector<int> number(count);
    for (int i = 0; i < count; ++i) {  // Fisher-Yates from the front
        const int j = random.below(i + 1);
        number[i] = number[j];
        number[j] = i;
    }
    std::vector<Point> points(count);
    const auto old_points = points_of(shape.mesh);
    for (int v = 0; v < count; ++v) points[number[v]] = old_points[v];
    auto faces = faces_of(shape.mesh);
    for (Face& face : faces) {
        for (int& v : face) v = number[v];
        std::rotate(face.begin(), face.begin() + random.below(static_cast<int>(face.size())), face.end());
    }
    for (int i = static_cast<int>(faces.size()) - 1; i > 0; --i) std::swap(faces[i], faces[random.below(i + 1)]);
    Shape result = make(shape.name + "_shuffled", points, faces);
    result.features = shape.features;
    for (auto& crease : result.features.creases) crease = {number[crease[0]], number[crease[1]]};
    for (auto& corner : result.features.corners) corner = number[corner];
    return result;
}

Shape transformed(Shape shape, double scale, double offset) {
    for (double& x : shape.mesh.positions) x = scale * x + offset;
    shape.name += "_transformed";
    return shape;
}

Shape combined(const Shape& a, const Shape& b) {
    auto points = points_of(a.mesh);
    auto faces = faces_of(a.mesh);
    const int shift = static_cast<int>(points.size());
    for (const Point& p : points_of(b.mesh)) points.push_back({p[0] + 2, p[1], p[2]});
    for (Face face : faces_of(b.mesh)) {
        for (int& v : face) v += shift;
        faces.push_back(face);
    }
    Shape result = make(a.name + "_and_" + b.name, points, faces);
    result.features = a.features;
    for (const auto& crease : b.features.creases) result.features.creases.push_back({crease[0] + shift, crease[1] + shift});
    for (const auto corner : b.features.corners) result.features.corners.push_back(corner + shift);
    return result;
}

Shape with_isolated_vertex(const Shape& shape, int number) {
    auto points = points_of(shape.mesh);
    auto faces = faces_of(shape.mesh);
    points.insert(points.begin() + number, Point{0.3, -0.4, 0.9});
    for (Face& face : faces)
        for (int& v : face) v += v >= number;
    Shape result = make(shape.name + "_with_isolated_vertex", points, faces);
    result.features = shape.features;
    for (auto& crease : result.features.creases)
        for (auto& v : crease) v += v >= number;
    for (auto& v : result.features.corners) v += v >= number;
    return result;
}

Shape two_components() { return renamed(combined(octahedron(), tetrahedron()), "two_components"); }

std::vector<Shape> closed_shapes() {
    std::vector<Shape> list{tetrahedron(), cube(), octahedron(), icosahedron(), dodecahedron(), triangular_prism(), hexagonal_prism(), truncated_octahedron()};
    append(list, {icosphere(1), icosphere_quads(1), torus_quads(3, 3), torus_quads(6, 4), torus_triangles(3, 3), torus_triangles(6, 6), hexagonal_torus(3, 4)});
    append(list, {neighbour_also_diagonal(), random_triangle_mesh(80, 1), polygons_mixed(90, 2), dual_of(random_triangle_mesh(40, 3))});
    return list;
}

std::vector<Shape> boundary_shapes() {
    std::vector<Shape> list{single_triangle(), single_quad(), single_hexagon(), grid_quads(1, 2), grid_quads(4, 3), grid_triangles(4, 3), grid_with_hole()};
    append(list, {cylinder_open(5, 3), cylinder_open(3, 1), disk_pole_triangles(3), disk_pole_triangles(9), disk_pole_quads(3), disk_pole_quads(7)});
    return list;
}

std::vector<Shape> feature_shapes() {
    std::vector<Shape> list{cube_with_crease(), cube_with_crease_loop(), cube_with_dart(), grid_with_creases(), grid_with_marked_corner()};
    append(list, {grid_triangles_with_creases(), torus_with_dart(), torus_triangles_with_dart(), icosphere_with_crease_loop(), box_with_crease_angle()});
    return list;
}

std::vector<Shape> all_shapes() {
    auto list = closed_shapes();
    append(list, boundary_shapes());
    append(list, feature_shapes());
    append(list, {cube_split_edges(), valence_2_pole(), two_components(), with_isolated_vertex(torus_triangles(4, 3), 5)});
    return list;
}

std::vector<Shape> triangles_only(std::vector<Shape> shapes) {
    shapes.erase(std::remove_if(shapes.begin(), shapes.end(), [](const Shape& s) { return !is_triangle_mesh(s.mesh); }), shapes.end());
    return shapes;
}

}  // namespace shapes
