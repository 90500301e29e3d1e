// SPDX-License-Identifier: BSD-3-Clause
// The oracle against numbers worked out by hand, formulas typed here on their own, and known spectra. No library code is involved.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "tests/oracle/dense.h"
#include "tests/oracle/limit.h"
#include "tests/oracle/subdivide.h"
#include "tests/shapes/shapes.h"

namespace {

// Entries are sums of up to about 100 products of numbers below 1, rounded once each, over up to 400 contracting steps.
constexpr double tolerance = 2e-14;

const double pi = std::acos(-1.0);

lcl::SchemeOptions scheme(lcl::Scheme which) {
    lcl::SchemeOptions options;
    options.scheme = which;
    return options;
}

lcl::SchemeOptions catmull_clark(double alpha = 0, double lambda = 0) {
    lcl::SchemeOptions options = scheme(lcl::Scheme::catmull_clark);
    options.alpha = alpha;
    options.lambda = lambda;
    return options;
}

lcl::SchemeOptions doo_sabin(lcl::DooSabinMask mask = lcl::DooSabinMask::catmull) {
    lcl::SchemeOptions options = scheme(lcl::Scheme::doo_sabin);
    options.mask = mask;
    return options;
}

const lcl::SchemeOptions loop = scheme(lcl::Scheme::loop);

bool suits(const shapes::Shape& shape, const lcl::SchemeOptions& options) {
    return options.scheme != lcl::Scheme::loop || shapes::is_triangle_mesh(shape.mesh);
}

std::vector<lcl::SchemeOptions> all_options() {
    return {catmull_clark(), catmull_clark(0.5), catmull_clark(0.25, 0.4), loop, doo_sabin(), doo_sabin(lcl::DooSabinMask::classic)};
}

Eigen::MatrixXd rows_of(const shapes::Shape& shape, const lcl::SchemeOptions& options) { return oracle::limit_rows(shape.mesh, shape.features, options); }

std::map<std::pair<int, int>, int> half_edges_of(const shapes::Shape& shape) {
    std::map<std::pair<int, int>, int> result;
    const auto faces = shapes::faces_of(shape.mesh);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; i < faces[f].size(); ++i) result[{faces[f][i], faces[f][(i + 1) % faces[f].size()]}] = static_cast<int>(f);
    return result;
}

std::vector<int> face_counts(const shapes::Shape& shape) {
    std::vector<int> counts(shape.mesh.vertex_count);
    for (const int v : shape.mesh.face_vertices) ++counts[v];
    return counts;
}

// Mesh expansion paper: n (n - 1 + alpha) on V, 2 - alpha on each edge end, 4 / d on every corner of every face round V, over n (n + 5).
Eigen::MatrixXd catmull_clark_formula(const shapes::Shape& shape, double alpha) {
    const auto n = face_counts(shape);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n.size(), n.size());
    for (const auto& face : shapes::faces_of(shape.mesh))
        for (std::size_t i = 0; i < face.size(); ++i) {
            for (const int w : face) a(face[i], w) += 4.0 / static_cast<double>(face.size());
            a(face[i], face[(i + 1) % face.size()]) += 2 - alpha;  // every edge leaves its origin once
        }
    for (std::size_t v = 0; v < n.size(); ++v) {
        a(v, v) += n[v] * (n[v] - 1 + alpha);
        a.row(v) /= n[v] * (n[v] + 5);
    }
    return a;
}

// Loop PIA paper with the square that it lost (source slip).
Eigen::MatrixXd loop_formula(const shapes::Shape& shape) {
    const auto n = face_counts(shape);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n.size(), n.size());
    for (const auto& [edge, face] : half_edges_of(shape)) {
        const double c = 0.375 + std::cos(2 * pi / n[edge.first]) / 4, alpha = 3 / (11 - 8 * (0.375 + c * c));
        a(edge.first, edge.first) = alpha;
        a(edge.first, edge.second) += (1 - alpha) / n[edge.first];
    }
    return a;
}

// Doo-Sabin: the mean of the points of one step in the n faces round the vertex.
Eigen::MatrixXd doo_sabin_formula(const shapes::Shape& shape, bool classic) {
    const auto n = face_counts(shape);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n.size(), n.size());
    for (const auto& face : shapes::faces_of(shape.mesh)) {
        const int m = static_cast<int>(face.size());
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m; ++j) {
                const int away = std::min((j - i + m) % m, (i - j + m) % m);
                const double ours = (away == 0 ? 0.5 : away == 1 ? 0.125 : 0) + 0.25 / m;
                const double theirs = away == 0 ? (m + 5) / (4.0 * m) : (3 + 2 * std::cos(2 * pi * away / m)) / (4 * m);
                a(face[i], face[j]) += (classic ? theirs : ours) / n[face[i]];
            }
    }
    return a;
}

double largest_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

Eigen::VectorXd scaling(const shapes::Shape& shape, const std::function<double(double)>& of_valence) {
    const auto n = face_counts(shape);
    Eigen::VectorXd d(n.size());
    for (std::size_t v = 0; v < n.size(); ++v) d[v] = of_valence(n[v]);
    return d;
}

// The left vector of eigenvalue 1 whose entries sum to one.
Eigen::VectorXd stationary(const Eigen::MatrixXd& step) {
    Eigen::MatrixXd system = step.transpose() - Eigen::MatrixXd::Identity(step.rows(), step.cols());
    system.row(0).setOnes();
    return system.fullPivLu().solve(Eigen::VectorXd::Unit(step.rows(), 0));
}

double lowest(const shapes::Shape& shape, const lcl::SchemeOptions& options) { return oracle::lowest_eigenvalue(rows_of(shape, options)); }

}  // namespace

TEST_CASE("every shape is closed or bounded as its name says, manifold and consistently oriented", "[oracle][shapes]") {
    for (const auto& shape : shapes::all_shapes()) {
        INFO(shape.name);
        const auto half_edges = half_edges_of(shape);
        CHECK(half_edges.size() == shape.mesh.face_vertices.size());  // no half-edge twice
        CHECK(shape.mesh.positions.size() == 3 * static_cast<std::size_t>(shape.mesh.vertex_count));
        for (const auto& face : shapes::faces_of(shape.mesh)) CHECK(std::set<int>(face.begin(), face.end()).size() == face.size());
    }
    for (const auto& shape : shapes::closed_shapes()) {
        INFO(shape.name);
        const auto half_edges = half_edges_of(shape);
        for (const auto& [edge, face] : half_edges) CHECK(half_edges.count({edge.second, edge.first}) == 1);
        const auto counts = face_counts(shape);
        CHECK(*std::min_element(counts.begin(), counts.end()) >= 3);
        double volume = 0;
        const auto points = oracle::positions(shape.mesh);
        for (const auto& face : shapes::faces_of(shape.mesh))
            for (std::size_t i = 2; i < face.size(); ++i) {
                const Eigen::Vector3d a = points.row(face[0]), b = points.row(face[i - 1]), c = points.row(face[i]);
                volume += a.dot(b.cross(c)) / 6;
            }
        CHECK(volume > 0.1);
    }
    for (const auto& shape : shapes::boundary_shapes()) {
        INFO(shape.name);
        const auto half_edges = half_edges_of(shape);
        CHECK(std::any_of(half_edges.begin(), half_edges.end(), [&](const auto& h) { return half_edges.count({h.first.second, h.first.first}) == 0; }));
    }
}

TEST_CASE("random shapes keep to their valences and face degrees and repeat for a seed", "[oracle][shapes]") {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const auto triangles = shapes::random_triangle_mesh(150, seed);
        const auto counts = face_counts(triangles);
        CHECK(triangles.mesh.vertex_count == 150);
        CHECK(*std::min_element(counts.begin(), counts.end()) == 3);
        CHECK(*std::max_element(counts.begin(), counts.end()) == 10);
        CHECK(shapes::random_triangle_mesh(150, seed).mesh.positions == triangles.mesh.positions);

        const auto polygons = shapes::polygons_mixed(150, seed);
        std::set<int> degrees;
        for (const auto& face : shapes::faces_of(polygons.mesh)) degrees.insert(static_cast<int>(face.size()));
        const auto valences = face_counts(polygons);
        CHECK(*std::min_element(valences.begin(), valences.end()) == 3);
        CHECK(*std::max_element(valences.begin(), valences.end()) <= 8);
        CHECK(*degrees.begin() == 3);
        CHECK(*degrees.rbegin() >= 7);
        CHECK(*degrees.rbegin() <= 10);
        CHECK(polygons.mesh.vertex_count - static_cast<int>(half_edges_of(polygons).size()) / 2 + polygons.mesh.face_count() == 2);
    }
}

TEST_CASE("one Catmull-Clark step of a cube puts its points where they belong", "[oracle][catmull-clark]") {
    const auto cube = shapes::cube();
    const auto step = oracle::subdivide(oracle::make_surface(cube.mesh), catmull_clark());
    const Eigen::MatrixXd points = step.weights * oracle::positions(cube.mesh);
    REQUIRE(points.rows() == 8 + 12 + 6);
    // Q = (1, 1, 1)/3 and R = (2, 2, 2)/3 at the corner (1, 1, 1), n = 3: V' = Q/3 + 2R/3 = (5, 5, 5)/9;
    // an edge point is (3/4, 3/4, 0), a face point (1, 0, 0).
    CHECK(largest_difference(points.row(6), Eigen::RowVector3d::Constant(5.0 / 9)) < tolerance);
    for (int e = 8; e < 20; ++e) CHECK(points.row(e).cwiseAbs().sum() == Approx(1.5).margin(tolerance));
    for (int f = 20; f < 26; ++f) CHECK(points.row(f).norm() == Approx(1).margin(tolerance));
    CHECK(step.surface.faces[0] == std::vector<int>{0, 8, 20, 11});  // first child of face 0 3 2 1: its corner 0, edge 0 3, centre, edge 1 0
}

TEST_CASE("refined surfaces are closed, with the right Euler number", "[oracle]") {
    for (const auto& options : all_options())
        for (const auto& shape : {shapes::octahedron(), shapes::torus_triangles(4, 3), shapes::polygons_mixed(60, 5)}) {
            if (!suits(shape, options)) continue;
            INFO(shape.name << " scheme " << static_cast<int>(options.scheme) << " lambda " << options.lambda);
            const int characteristic = shape.name.rfind("torus", 0) == 0 ? 0 : 2;
            const auto twice = oracle::subdivide(oracle::make_surface(shape.mesh), options, 2);
            shapes::Shape fine;
            fine.mesh = oracle::to_mesh(twice.surface, twice.weights * oracle::positions(shape.mesh));
            const auto half_edges = half_edges_of(fine);
            CHECK(half_edges.size() == fine.mesh.face_vertices.size());
            for (const auto& [edge, face] : half_edges) REQUIRE(half_edges.count({edge.second, edge.first}) == 1);
            CHECK(fine.mesh.vertex_count - static_cast<int>(half_edges.size()) / 2 + fine.mesh.face_count() == characteristic);
        }
}

TEST_CASE("cube limit row for Catmull-Clark is 9, 4, 1 over 24", "[oracle][catmull-clark]") {
    // n = 3, d = 4: (3 * 2 + 3) / 24 on V, (2 + 1 + 1) / 24 on three neighbours, 1/24 on three diagonals, nothing on the far corner.
    const Eigen::MatrixXd a = rows_of(shapes::cube(), catmull_clark());
    const Eigen::RowVectorXd expected = (Eigen::RowVectorXd(8) << 9, 4, 1, 4, 4, 1, 0, 1).finished() / 24;
    CHECK(largest_difference(a.row(0), expected) < tolerance);
}

TEST_CASE("regular rows are the tensor products and box splines of the books", "[oracle]") {
    SECTION("Catmull-Clark: 16, 4, 1 over 36") {
        const Eigen::MatrixXd a = rows_of(shapes::torus_quads(5, 5), catmull_clark());
        CHECK(a(0, 0) == Approx(16.0 / 36).margin(tolerance));
        for (const int w : {1, 4, 5, 20}) CHECK(a(0, w) == Approx(4.0 / 36).margin(tolerance));
        for (const int w : {6, 9, 21, 24}) CHECK(a(0, w) == Approx(1.0 / 36).margin(tolerance));
    }
    SECTION("Loop: 1/2 and 1/12") {
        const Eigen::MatrixXd a = rows_of(shapes::torus_triangles(5, 5), loop);
        CHECK(a(0, 0) == Approx(0.5).margin(tolerance));
        for (const int w : {1, 4, 5, 20, 6, 24}) CHECK(a(0, w) == Approx(1.0 / 12).margin(tolerance));
    }
    SECTION("Doo-Sabin, both masks: 36, 6, 1 over 64 from 9, 3, 1 over 16 in each quad") {
        for (const auto mask : {lcl::DooSabinMask::catmull, lcl::DooSabinMask::classic}) {
            const Eigen::MatrixXd a = rows_of(shapes::torus_quads(5, 5), doo_sabin(mask));
            CHECK(a(0, 0) == Approx(36.0 / 64).margin(tolerance));
            for (const int w : {1, 4, 5, 20}) CHECK(a(0, w) == Approx(6.0 / 64).margin(tolerance));
            for (const int w : {6, 9, 21, 24}) CHECK(a(0, w) == Approx(1.0 / 64).margin(tolerance));
        }
        const auto quad = shapes::single_quad();
        const auto step = oracle::subdivide(oracle::make_surface(quad.mesh), doo_sabin());
        CHECK(largest_difference(step.weights.row(0), (Eigen::RowVectorXd(4) << 9, 3, 1, 3).finished() / 16) < tolerance);
        CHECK(largest_difference(step.weights.row(4), (Eigen::RowVectorXd(4) << 12, 4, 0, 0).finished() / 16) < tolerance);
    }
}

TEST_CASE("closed smooth rows equal the masks of the papers", "[oracle]") {
    for (const auto& shape : shapes::closed_shapes()) {
        INFO(shape.name);
        for (const double alpha : {0.0, 0.3, 1.0})
            CHECK(largest_difference(rows_of(shape, catmull_clark(alpha)), catmull_clark_formula(shape, alpha)) < tolerance);
        if (shapes::is_triangle_mesh(shape.mesh)) CHECK(largest_difference(rows_of(shape, loop), loop_formula(shape)) < tolerance);
        CHECK(largest_difference(rows_of(shape, doo_sabin()), doo_sabin_formula(shape, false)) < tolerance);
        CHECK(largest_difference(rows_of(shape, doo_sabin(lcl::DooSabinMask::classic)), doo_sabin_formula(shape, true)) < tolerance);
    }
}

TEST_CASE("valence 2 follows the same masks", "[oracle]") {
    for (const auto& shape : {shapes::valence_2_pole(), shapes::cube_split_edges()}) {
        INFO(shape.name);
        CHECK(largest_difference(rows_of(shape, catmull_clark()), catmull_clark_formula(shape, 0)) < tolerance);
        CHECK(largest_difference(rows_of(shape, doo_sabin()), doo_sabin_formula(shape, false)) < tolerance);
    }
}

TEST_CASE("high valences settle on the same masks", "[oracle]") {
    const auto quads = shapes::disk_pole_quads(60);
    const Eigen::RowVectorXd row = oracle::limit_row(oracle::make_surface(quads.mesh), catmull_clark(), 0);
    CHECK(largest_difference(row, catmull_clark_formula(quads, 0).row(0)) < tolerance);
    const auto triangles = shapes::disk_pole_triangles(60);
    const Eigen::RowVectorXd loop_row = oracle::limit_row(oracle::make_surface(triangles.mesh), loop, 0);
    CHECK(largest_difference(loop_row, loop_formula(triangles).row(0)) < tolerance);
}

TEST_CASE("two-phase rows blend with the identity", "[oracle][two-phase]") {
    for (const auto& shape : shapes::all_shapes()) {
        INFO(shape.name);
        auto options = catmull_clark(0.25);
        const Eigen::MatrixXd smooth = rows_of(shape, options);
        for (int v = 0; v < shape.mesh.vertex_count; ++v) options.lambda_per_vertex.push_back(v % 3 * 0.4);
        const Eigen::VectorXd lambda = Eigen::Map<Eigen::VectorXd>(options.lambda_per_vertex.data(), shape.mesh.vertex_count);
        Eigen::MatrixXd expected = smooth - lambda.asDiagonal() * smooth;
        expected.diagonal() += lambda;
        CHECK(largest_difference(rows_of(shape, options), expected) < tolerance);
    }
}

TEST_CASE("limit rows sum to one and are not negative", "[oracle]") {
    for (const auto& shape : shapes::all_shapes())
        for (const auto& options : all_options()) {
            if (!suits(shape, options)) continue;
            INFO(shape.name << " scheme " << static_cast<int>(options.scheme));
            const Eigen::MatrixXd a = rows_of(shape, options);
            CHECK((a.rowwise().sum().array() - 1).abs().maxCoeff() < tolerance);
            CHECK(a.minCoeff() > -tolerance);
        }
}

TEST_CASE("boundary rows are those of B-spline curves", "[oracle][boundary]") {
    const auto grid = shapes::grid_triangles(4, 3);  // five vertices a row; 0 has two faces, 4 one
    const Eigen::RowVectorXd cubic = (Eigen::RowVectorXd(4) << 1, 4, 1, 0).finished() / 6, quadratic = (Eigen::RowVectorXd(4) << 1, 6, 1, 0).finished() / 8;
    for (const auto& options : {catmull_clark(), catmull_clark(0.5), loop}) {
        const Eigen::MatrixXd a = rows_of(grid, options);
        CHECK(largest_difference(a.row(2).segment(1, 4), cubic) < tolerance);
        CHECK(a.row(2).segment(1, 3).sum() == Approx(1).margin(tolerance));
        CHECK(a(4, 4) == 1);
        CHECK(a(0, 0) == Approx(4.0 / 6).margin(tolerance));
        CHECK(a(0, 5) == Approx(1.0 / 6).margin(tolerance));
    }
    const Eigen::MatrixXd a = rows_of(grid, doo_sabin());
    CHECK(largest_difference(a.row(2).segment(1, 4), quadratic) < tolerance);
    CHECK(a(4, 4) == 1);
    CHECK(a(0, 1) == Approx(1.0 / 8).margin(tolerance));
}

TEST_CASE("the boundary rule decides which boundary vertices stay", "[oracle][boundary]") {
    for (const auto& options : {catmull_clark(), doo_sabin()}) {
        auto grid = shapes::grid_quads(2, 2);
        const double middle = options.scheme == lcl::Scheme::doo_sabin ? 6.0 / 8 : 4.0 / 6;
        const auto diagonal = [&](lcl::BoundaryRule rule) {
            grid.features.boundary = rule;
            return Eigen::VectorXd(rows_of(grid, options).diagonal());
        };
        const auto both = diagonal(lcl::BoundaryRule::edge_and_corner), curves = diagonal(lcl::BoundaryRule::edge_only);
        const auto fixed = diagonal(lcl::BoundaryRule::fixed);
        CHECK(both[0] == 1);
        CHECK(both[1] == Approx(middle).margin(tolerance));
        CHECK(curves[0] == Approx(middle).margin(tolerance));
        for (const int v : {0, 1, 2, 3, 5, 6, 7, 8}) CHECK(fixed[v] == 1);
        CHECK(fixed[4] == Approx(both[4]).margin(tolerance));
    }
}

TEST_CASE("creases make curves, darts and corners", "[oracle][crease]") {
    const auto grid = shapes::grid_with_creases();  // vertex (i, j) is 7 j + i
    const Eigen::MatrixXd smooth = catmull_clark_formula(grid, 0);
    const Eigen::MatrixXd a = rows_of(grid, catmull_clark());
    for (const int corner : {0, 6, 42, 48, 24, 3, 45, 2, 41}) CHECK(a(corner, corner) == 1);
    for (const auto& [v, left, right] : {std::array<int, 3>{10, 3, 17}, {17, 10, 24}, {23, 22, 24}, {9, 8, 2}}) {
        CHECK(a(v, v) == Approx(4.0 / 6).margin(tolerance));
        CHECK(a(v, left) == Approx(1.0 / 6).margin(tolerance));
        CHECK(a(v, right) == Approx(1.0 / 6).margin(tolerance));
    }
    SECTION("a smooth vertex next to creases keeps its mask") {
        for (const int v : {11, 16, 30, 37}) CHECK(largest_difference(a.row(v), smooth.row(v)) < tolerance);
    }
    SECTION("a Doo-Sabin crease is the boundary curve of both sides, a dart folds it") {
        const Eigen::MatrixXd d = rows_of(grid, doo_sabin());
        CHECK(d(17, 10) == Approx(1.0 / 8).margin(tolerance));
        CHECK(d(17, 17) == Approx(6.0 / 8).margin(tolerance));
        CHECK(d(22, 22) == Approx(6.0 / 8).margin(tolerance));
        CHECK(d(22, 23) == Approx(2.0 / 8).margin(tolerance));
        CHECK(largest_difference(d.row(30), doo_sabin_formula(grid, false).row(30)) < tolerance);
    }
}

TEST_CASE("a dart's row is the stationary vector of its umbrella matrix and differs from the smooth mask", "[oracle][crease]") {
    SECTION("Loop, valence 6") {
        // Umbrella V, E_0 .. E_5 with E_0 at the end of the sharp edge: V' = 5/8 V + 1/16 sum E; E_j' = 3/8 (V + E_j) + 1/8 (E_j-1 + E_j+1);
        // E_0' = (V + E_0)/2.
        Eigen::MatrixXd s = Eigen::MatrixXd::Zero(7, 7);
        s.row(0).setConstant(1.0 / 16);
        s(0, 0) = 5.0 / 8;
        for (int j = 0; j < 6; ++j) {
            s(1 + j, 0) = s(1 + j, 1 + j) = j == 0 ? 0.5 : 0.375;
            if (j > 0) s(1 + j, 1 + (j + 1) % 6) = s(1 + j, 1 + (j + 5) % 6) = 0.125;
        }
        const Eigen::VectorXd left = stationary(s);
        auto torus = shapes::torus_triangles(5, 5);
        torus.features.creases = {{0, 1}};
        const Eigen::MatrixXd a = rows_of(torus, loop);
        const std::vector<int> ring{0, 1, 6, 5, 4, 24, 20};
        for (int i = 0; i < 7; ++i) CHECK(a(0, ring[i]) == Approx(left[i]).margin(tolerance));
        CHECK(largest_difference(a.row(0), loop_formula(torus).row(0)) > 0.005);
    }
    SECTION("Catmull-Clark, valence 4, all quads") {
        // Umbrella V, E_0 .. E_3, F_0 .. F_3; f_j = (V + E_j + E_j+1 + F_j)/4 are the new face points, V' = V/2 + sum (E_j + f_j)/16,
        // E_j' = (V + E_j + f_j + f_j-1)/4.
        Eigen::MatrixXd s = Eigen::MatrixXd::Zero(9, 9);
        for (int j = 0; j < 4; ++j)
            for (const int k : {0, 1 + j, 1 + (j + 1) % 4, 5 + j}) s(5 + j, k) = 0.25;
        s(0, 0) = 0.5;
        for (int j = 0; j < 4; ++j) {
            s.row(0) += s.row(5 + j) / 16;
            s(0, 1 + j) += 1.0 / 16;
            if (j > 0) s.row(1 + j) = (s.row(5 + j) + s.row(4 + j)) / 4;
            s(1 + j, 0) += j == 0 ? 0.5 : 0.25;
            s(1 + j, 1 + j) += j == 0 ? 0.5 : 0.25;
        }
        const Eigen::VectorXd left = stationary(s);
        auto torus = shapes::torus_quads(5, 5);
        torus.features.creases = {{0, 1}};
        const Eigen::MatrixXd a = rows_of(torus, catmull_clark());
        const std::vector<int> ring{0, 1, 5, 4, 20, 6, 9, 24, 21};
        for (int i = 0; i < 9; ++i) CHECK(a(0, ring[i]) == Approx(left[i]).margin(tolerance));
        CHECK(a(0, 0) == Approx(0.4676617).margin(1e-7));  // the smooth mask has 16/36, 0.023 less
    }
}

TEST_CASE("vertex points of ever deeper refinement tend to the limit rows", "[oracle]") {
    using Case = std::pair<shapes::Shape, lcl::SchemeOptions>;
    for (const auto& [shape, options] : {Case{shapes::cube_with_crease(), catmull_clark(0.5)}, Case{shapes::grid_quads(2, 2), catmull_clark()},
                                         Case{shapes::triangular_prism(), catmull_clark(0, 0.3)}, Case{shapes::tetrahedron(), loop}}) {
        INFO(shape.name);
        const Eigen::MatrixXd a = rows_of(shape, options);
        const auto distance = [&, &mesh = shape.mesh, &features = shape.features, &rule = options](int levels) {
            const auto fine = oracle::subdivide(oracle::make_surface(mesh, features), rule, levels);
            return largest_difference(fine.weights.topRows(mesh.vertex_count), a);
        };
        const double third = distance(3), fourth = distance(4);
        CHECK(third < 0.02);
        CHECK(fourth < 0.5 * third);  // the slowest family here, at a dart, shrinks by a little less than 1/2 a level
        CHECK(fourth > 0);
    }
}

TEST_CASE("limit rows of a refined mesh agree with those of the mesh it came from", "[oracle]") {
    for (const auto& shape : {shapes::grid_with_creases(), shapes::torus_with_dart(), shapes::disk_pole_quads(5), shapes::polygons_mixed(30, 4)}) {
        INFO(shape.name);
        const auto surface = oracle::make_surface(shape.mesh, shape.features);
        for (const auto& options : {catmull_clark(), catmull_clark(0.5), catmull_clark(0, 0.3)}) {
            const auto fine = oracle::subdivide(surface, options);
            for (int v = 0; v < shape.mesh.vertex_count; v += 5) {
                const Eigen::RowVectorXd later = oracle::limit_row(fine.surface, oracle::after_first_step(options), v) * fine.weights;
                CHECK(largest_difference(later, oracle::limit_row(surface, options, v)) < tolerance);
            }
        }
    }
}

TEST_CASE("Doo-Sabin refinement keeps the boundary curve and opens creases", "[oracle][doo-sabin]") {
    const auto grid = shapes::grid_quads(3, 3);
    const auto surface = oracle::make_surface(grid.mesh, grid.features);
    const auto step = oracle::subdivide(surface, doo_sabin());
    // 36 face corners, two points for each of 12 boundary edges, four kept corners; 9 old faces, 24 edges and 16 vertices each make a face.
    CHECK(step.surface.vertex_count == 36 + 24 + 4);
    CHECK(step.surface.faces.size() == 9 + 24 + 16);
    CHECK(step.surface.corners.size() == 4);
    // On the curve, the middle of the two points next to vertex 1 is its limit point, before and after another step.
    const Eigen::RowVectorXd limit = oracle::limit_row(surface, doo_sabin(), 1);
    const auto& face = step.surface.faces[step.vertex_faces[1][0]];
    const Eigen::RowVectorXd middle = (step.weights.row(face.front()) + step.weights.row(face.back())) / 2;
    CHECK(largest_difference(middle, limit) < tolerance);

    const auto torus = shapes::torus_with_dart();
    const auto cut = oracle::subdivide(oracle::make_surface(torus.mesh, torus.features), doo_sabin());
    CHECK(cut.surface.vertex_count == 4 * 30 + 3 * 4);        // two points on each side of three crease edges
    CHECK(cut.surface.faces.size() == 30 + 60 + 3 + 30 + 2);  // crease edges make two faces, the two inner crease vertices too
    CHECK(cut.surface.sharp.size() == 6 + 4 + 2);             // per side: three edges and two inner vertices; each dart one
}

TEST_CASE("both sides of a Doo-Sabin crease have the same limit", "[oracle][doo-sabin][crease]") {
    const auto torus = shapes::torus_with_dart();
    const auto surface = oracle::make_surface(torus.mesh, torus.features);
    const auto step = oracle::subdivide(surface, doo_sabin());
    REQUIRE(step.vertex_faces[8].size() == 2);
    for (const int f : step.vertex_faces[8]) {
        const auto& face = step.surface.faces[f];
        const Eigen::RowVectorXd middle = (step.weights.row(face.front()) + step.weights.row(face.back())) / 2;
        CHECK(largest_difference(middle, oracle::limit_row(surface, doo_sabin(), 8)) < tolerance);
    }
}

TEST_CASE("crease angles mark the twelve edges of a box", "[oracle][crease]") {
    const auto box = shapes::box_with_crease_angle();
    const auto surface = oracle::make_surface(box.mesh, box.features);
    CHECK(surface.sharp.size() == 36);
    CHECK(surface.corners.size() == 8);
}

TEST_CASE("isolated vertices stay and shuffling changes nothing but the order", "[oracle]") {
    const auto shape = shapes::with_isolated_vertex(shapes::torus_triangles(4, 3), 5);
    for (const auto& options : all_options()) CHECK(rows_of(shape, options)(5, 5) == 1);
    for (const auto& original : {shapes::grid_with_creases(), shapes::polygons_mixed(50, 9)}) {
        const auto other = shapes::shuffled(original, 3);
        for (const auto& options : {catmull_clark(0.5), doo_sabin()}) {
            const Eigen::VectorXd x = oracle::positions(original.mesh).col(0), y = oracle::positions(other.mesh).col(0);
            Eigen::VectorXd limit = rows_of(original, options) * x, other_limit = rows_of(other, options) * y;
            std::sort(limit.data(), limit.data() + limit.size());
            std::sort(other_limit.data(), other_limit.data() + other_limit.size());
            CHECK(largest_difference(limit, other_limit) < tolerance);
        }
    }
}

TEST_CASE("the cube is singular for Catmull-Clark with alternating signs", "[oracle][spectrum]") {
    const Eigen::MatrixXd a = rows_of(shapes::cube(), catmull_clark());
    const Eigen::VectorXd alternating = (Eigen::VectorXd(8) << 1, -1, 1, -1, -1, 1, -1, 1).finished();
    CHECK((a * alternating).cwiseAbs().maxCoeff() < tolerance);
    CHECK_THROWS_AS(oracle::solve(a, oracle::positions(shapes::cube().mesh)), std::runtime_error);
    for (const auto& shape : {shapes::hexagonal_prism(), shapes::truncated_octahedron(), shapes::hexagonal_torus(3, 4)}) {
        INFO(shape.name);
        CHECK(lowest(shape, catmull_clark()) == Approx(0).margin(1e-12));
        CHECK(lowest(shape, catmull_clark(0.5)) >= 1.0 / 8 - 1e-12);
    }
}

TEST_CASE("lowest eigenvalues of well-known meshes", "[oracle][spectrum]") {
    CHECK(lowest(shapes::tetrahedron(), catmull_clark()) == Approx(2.0 / 9).margin(1e-12));
    // (8.4 + 3.6 mu + 0.8 (mu^2 - 3)) / 24 with mu = -sqrt 5, an eigenvalue of the edge graph.
    CHECK(lowest(shapes::dodecahedron(), catmull_clark()) == Approx((10 - 3.6 * std::sqrt(5.0)) / 24).margin(1e-12));
    CHECK(lowest(shapes::triangular_prism(), catmull_clark()) == Approx(1.0 / 12).margin(1e-12));
    CHECK(lowest(shapes::cube_split_edges(), catmull_clark()) == Approx(-1.0 / 14).margin(1e-12));
    CHECK(lowest(shapes::cube_split_edges(), catmull_clark(0.5)) > -1e-12);
    for (const double alpha : {0.0, 0.5, 1.0}) CHECK(lowest(shapes::torus_quads(6, 4), catmull_clark(alpha)) == Approx((1 + 2 * alpha) / 9).margin(1e-12));
    CHECK(lowest(shapes::torus_triangles(6, 6), loop) == Approx(0.25).margin(1e-12));
    CHECK(lowest(shapes::torus_quads(6, 4), doo_sabin()) == Approx(0.25).margin(1e-12));
}

TEST_CASE("scaled operators are symmetric and keep to the lower bounds", "[oracle][spectrum]") {
    for (const auto& shape : {shapes::random_triangle_mesh(120, 7), shapes::polygons_mixed(120, 8), shapes::icosphere_quads(1)}) {
        INFO(shape.name);
        double bound = std::numeric_limits<double>::infinity();
        for (const double n : face_counts(shape)) bound = std::min(bound, (n - 3) / (n + 5));
        const Eigen::VectorXd d = scaling(shape, [](double n) { return n * (n + 5); });
        const Eigen::VectorXd values = oracle::scaled_spectrum(rows_of(shape, catmull_clark()), d);
        CHECK(values[0] >= bound - 1e-12);
        CHECK(values[values.size() - 1] == Approx(1).margin(1e-12));
        for (const auto mask : {lcl::DooSabinMask::catmull, lcl::DooSabinMask::classic})
            CHECK(oracle::scaled_spectrum(rows_of(shape, doo_sabin(mask)), scaling(shape, [](double n) { return n; }))[0] >= 0.25 - 1e-12);
        if (!shapes::is_triangle_mesh(shape.mesh)) continue;
        const auto alpha = [](double n) { return 3 / (11 - 8 * (0.375 + std::pow(0.375 + std::cos(2 * pi / n) / 4, 2))); };
        double loop_bound = 1;
        for (const double n : face_counts(shape)) loop_bound = std::min(loop_bound, (3 * alpha(n) - 1) / 2);
        CHECK(oracle::scaled_spectrum(rows_of(shape, loop), scaling(shape, [&](double n) { return n / (1 - alpha(n)); }))[0] >= loop_bound - 1e-12);
    }
}

TEST_CASE("with boundaries and creases the spectrum stays real and in (0, 1]", "[oracle][spectrum][boundary]") {
    auto list = shapes::boundary_shapes();
    list.push_back(shapes::cube_with_crease_loop());
    list.push_back(shapes::icosphere_with_crease_loop());
    list.push_back(shapes::box_with_crease_angle());
    for (const auto& shape : list)
        for (const auto& options : {catmull_clark(), loop, doo_sabin(), doo_sabin(lcl::DooSabinMask::classic)}) {
            if (!suits(shape, options)) continue;
            INFO(shape.name << " scheme " << static_cast<int>(options.scheme));
            // Curves have at least 1/3 (Doo-Sabin 1/2); the inside is bounded as closed meshes are: 0 at valence 3 (Catmull-Clark), 0.1 (Loop), 1/4.
            const double bound = options.scheme == lcl::Scheme::doo_sabin ? 0.25 : options.scheme == lcl::Scheme::loop ? 0.1 : 0;
            for (const auto& value : oracle::spectrum(rows_of(shape, options))) {
                CHECK(std::abs(value.imag()) < 1e-6);  // repeated eigenvalues of a matrix that is not symmetric are known to about sqrt(eps)
                CHECK(value.real() > bound - 1e-6);
                CHECK(value.real() < 1 + 1e-6);
            }
        }
}

TEST_CASE("PIA and Gauss-Seidel converge with darts too", "[oracle][spectrum][crease]") {
    for (const auto& shape : {shapes::cube_with_crease(), shapes::cube_with_dart(), shapes::grid_with_creases(), shapes::grid_triangles_with_creases(),
                              shapes::torus_with_dart(), shapes::torus_triangles_with_dart()})
        for (const auto& options : {catmull_clark(0.5), loop, doo_sabin()}) {
            if (!suits(shape, options)) continue;
            INFO(shape.name << " scheme " << static_cast<int>(options.scheme));
            const Eigen::MatrixXd a = rows_of(shape, options);
            CHECK(oracle::spectral_radius(oracle::pia_iteration(a)) < 1 - 1e-6);
            CHECK(oracle::spectral_radius(oracle::gauss_seidel_iteration(a)) < 1 - 1e-6);
        }
}

TEST_CASE("plain iterations end at the dense solution and at their known rates", "[oracle][solve]") {
    const auto shape = shapes::rough(shapes::torus_triangles(6, 6), 0.2, 1);
    const Eigen::MatrixXd a = rows_of(shape, loop), m = oracle::positions(shape.mesh), exact = oracle::solve(a, m);
    const auto sparse = oracle::to_sparse(a);
    CHECK((a * exact - m).cwiseAbs().maxCoeff() < 1e-13);
    const auto pia = oracle::pia(sparse, m, 120), wpia = oracle::pia(sparse, m, 60, 1.6), gauss_seidel = oracle::gauss_seidel(sparse, m, 40);
    const auto chebyshev = oracle::chebyshev(sparse, m, 40, 0.25);
    const auto cg = oracle::conjugate_gradients(sparse, Eigen::VectorXd::Ones(m.rows()), m, 36);
    for (const auto* history : {&pia, &wpia, &gauss_seidel, &chebyshev, &cg}) {
        CHECK(history->residuals.back() < 1e-11);
        CHECK(largest_difference(history->points, exact) < 1e-10);  // at most 4 times the residual, lambda_min = 1/4
    }
    CHECK(pia.residuals.size() == 121);
    CHECK(pia.residuals[0] == Approx(oracle::largest_row(m - a * m)));
    CHECK(pia.residuals[60] / pia.residuals[59] == Approx(0.75).margin(0.02));
    CHECK(wpia.residuals[40] / wpia.residuals[39] == Approx(0.6).margin(0.05));
    CHECK(chebyshev.residuals[20] < 2 * std::pow(1.0 / 3, 20) * 6 * chebyshev.residuals[0]);  // 1 / T_20 in the 2-norm, 6 = sqrt 36 from rows to columns
    CHECK(oracle::spectral_radius(oracle::pia_iteration(a)) == Approx(0.75).margin(1e-12));
    CHECK(oracle::spectral_radius(oracle::pia_iteration(a, 1.6)) == Approx(0.6).margin(1e-12));
    CHECK(oracle::spectral_radius(oracle::gauss_seidel_iteration(a)) < 0.6);
}

TEST_CASE("Jacobi diverges on a regular Catmull-Clark mesh", "[oracle][solve]") {
    const auto shape = shapes::rough(shapes::torus_quads(16, 12), 0.2, 1);
    const Eigen::MatrixXd a = rows_of(shape, catmull_clark());
    // A constant vector has factor 1 - 36/16 = -5/4, but no residual of a regular closed mesh has one;
    // the longest wave has eigenvalue (2 + cos(2 pi / 16)) / 3.
    CHECK(oracle::spectral_radius(oracle::pia_iteration(2.25 * a)) == Approx(1.25).margin(1e-12));
    const auto history = oracle::jacobi(oracle::to_sparse(a), oracle::positions(shape.mesh), 100);
    CHECK(history.residuals[100] / history.residuals[99] == Approx(2.25 * (2 + std::cos(pi / 8)) / 3 - 1).margin(1e-3));
}

TEST_CASE("identity rows leave the vertices outside a subset alone", "[oracle][solve]") {
    const auto shape = shapes::icosahedron();
    const Eigen::MatrixXd a = oracle::with_identity_rows(rows_of(shape, loop), {0, 3});
    CHECK(a.row(1) == Eigen::RowVectorXd::Unit(12, 1));
    const Eigen::MatrixXd m = oracle::positions(shape.mesh), p = oracle::solve(a, m);
    CHECK(largest_difference(p.row(1), m.row(1)) < 1e-14);
    CHECK(largest_difference(a.row(3) * p, m.row(3)) < 1e-14);
    CHECK(oracle::infinity_norm(a) == Approx(1));
}
