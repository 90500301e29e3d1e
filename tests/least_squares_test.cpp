// SPDX-License-Identifier: BSD-3-Clause
// Least-squares fits: the bending energy of patches, the normal equations against rows that are formed one by one, and fits of known surfaces.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>
#include <unsupported/Eigen/KroneckerProduct>

#include "host/error.h"
#include "host/evaluate/catmull_clark_kinds.h"
#include "host/evaluate/closest.h"
#include "host/evaluate/doo_sabin_walk.h"
#include "host/evaluate/loop_walk.h"
#include "host/evaluate/modes.h"
#include "host/evaluate/reference.h"
#include "host/points/bending.h"
#include "host/points/fit_system.h"
#include "host/points/least_squares.h"
#include "tests/solver_support.h"

using namespace lcl;
using Catch::Matchers::WithinAbs;
using Eigen::MatrixXd;

namespace {

PatchTable table_of(const shapes::Shape& shape, const SchemeOptions& options) {
    const Topology topology = build_topology(shape.mesh);
    return build_patch_table(topology, find_features(shape.mesh, topology, shape.features), options);
}

// ---------------------------------------------------------------- bending

/// Where the control points of a regular patch lie in the plane, when the surface is the plane with (x, y) its own coordinates.
MatrixXd plane_points(Scheme scheme) {
    if (scheme == Scheme::loop) {
        MatrixXd points(12, 2);
        int r = 0;
        for (const auto& [j, first, last] : {std::array{-1, 0, 2}, {0, -1, 2}, {1, -1, 1}, {2, -1, 0}})
            for (int i = first; i <= last; ++i) points.row(r++) << i + 0.5 * j, std::sqrt(3.0) / 2 * j;
        return points;
    }
    const int size = scheme == Scheme::catmull_clark ? 4 : 3;
    MatrixXd points(size * size, 2);
    for (int r = 0; r < size * size; ++r) points.row(r) << r % size - 1, r / size - 1;
    return points;
}

/// Kinds of closed smooth rings with n faces.
PatchKind closed_kind(const SchemeOptions& options, int n) {
    switch (options.scheme) {
        case Scheme::catmull_clark: return catmull_clark_kind({CatmullClarkPlace::Ring::closed, false, n, 0, -1});
        case Scheme::loop: return loop_kind({LoopRound::smooth, n, 0});
        default: return doo_sabin_kind(n, options.mask);
    }
}

MatrixXd regular_jet_rows(Scheme scheme, double s, double t) {
    const std::vector<double> weights = regular_weights(scheme, s, t);
    return Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>>(weights.data(), 6, regular_point_count(scheme));
}

/// Gradients by (x, y) of functions on a regular patch, 2 x functions, where x and y are functions on it too; all by their control points.
MatrixXd gradients(Scheme scheme, const MatrixXd& plane, const MatrixXd& functions, double s, double t) {
    const MatrixXd rows = regular_jet_rows(scheme, s, t).middleRows(1, 2);
    return (rows * plane).inverse() * (rows * functions);
}

/// The integral over (x, y) of a regular patch of H : H of every function by sums over midpoints; H by differences of gradients.
Eigen::VectorXd bending_by_sums(Scheme scheme, const MatrixXd& plane, const MatrixXd& functions) {
    constexpr int grid = 24;
    constexpr double h = 1e-4;
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(functions.cols());
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            double s = (i + 0.5) / grid, t = (j + 0.5) / grid, weight = 1.0 / (grid * grid);
            if (scheme == Scheme::loop) weight *= 1 - s, t *= 1 - s;
            const Eigen::Matrix2d by = (regular_jet_rows(scheme, s, t).middleRows(1, 2) * plane).inverse();
            const auto at = [&](double a, double b) { return gradients(scheme, plane, functions, a, b); };
            const MatrixXd by_s = (at(s + h, t) - at(s - h, t)) / (2 * h), by_t = (at(s, t + h) - at(s, t - h)) / (2 * h);
            const MatrixXd by_x = by(0, 0) * by_s + by(0, 1) * by_t, by_y = by(1, 0) * by_s + by(1, 1) * by_t;
            sums += weight / std::abs(by.determinant()) * (by_x.colwise().squaredNorm() + by_y.colwise().squaredNorm()).transpose();
        }
    return sums;
}

}  // namespace

TEST_CASE("the bending energy of regular patches is exact for quadratic functions", "[least_squares][bending]") {
    const Scheme scheme = GENERATE(Scheme::catmull_clark, Scheme::loop, Scheme::doo_sabin);
    const MatrixXd energy = regular_bending(scheme), plane = plane_points(scheme);
    const auto of = [&](const Eigen::VectorXd& control) { return control.dot(energy * control); };
    const Eigen::ArrayXd x = plane.col(0), y = plane.col(1);
    // Uniform splines give x^2 of control points x^2, up to a constant. H : H of x^2 is 4, of xy 2, of a x^2 + b y^2 + c xy it is 4 (a^2 + b^2) + 2 c^2. The
    // tolerance: 256 products of numbers up to 10.
    CHECK_THAT(of(x * x), WithinAbs(4, 1e-12));
    CHECK_THAT(of(y * y), WithinAbs(4, 1e-12));
    CHECK_THAT(of(x * y), WithinAbs(2, 1e-12));
    CHECK_THAT(of(2 * x * x - y * y + 3 * x * y + x - 5 * y + 7), WithinAbs(38, 2e-11));
    CHECK_THAT((energy * (x + 2 * y - 3).matrix()).norm(), WithinAbs(0, 1e-12));
}

TEST_CASE("irregular patches with regular surroundings have the energy of regular ones", "[least_squares][bending]") {
    const SchemeOptions options = GENERATE(solver_test::catmull_clark(), solver_test::loop(), solver_test::doo_sabin());
    const PatchKind kind = closed_kind(options, options.scheme == Scheme::loop ? 6 : 4);
    const MatrixXd energy = irregular_bending(options.scheme, kind), regular = regular_bending(options.scheme);
    // Three quarters of the patch are its outer ring, whose cells have second derivatives 4 times those by their own parameters; the fourth is the same again.
    MatrixXd right = 4 * kind.step.transpose() * energy * kind.step;
    for (const MatrixXd& cell : kind.cells) right += 4 * cell.transpose() * regular * cell;
    CHECK_THAT((energy - right).cwiseAbs().maxCoeff(), WithinAbs(0, 1e-10 * energy.cwiseAbs().maxCoeff()));
}

TEST_CASE("the bending energy of irregular patches is that by the characteristic map", "[least_squares][bending]") {
    struct Case {
        SchemeOptions options;
        int faces;
    };
    const auto [options, faces] = GENERATE(values<Case>({{solver_test::catmull_clark(), 3},
                                                         {solver_test::catmull_clark(), 7},
                                                         {solver_test::loop(), 3},
                                                         {solver_test::loop(), 8},
                                                         {solver_test::doo_sabin(), 5},
                                                         {solver_test::doo_sabin(DooSabinMask::classic), 6}}));
    const Scheme scheme = options.scheme;
    const PatchKind kind = closed_kind(options, faces);
    const std::shared_ptr<const Modes> modes = modes_of(kind);
    const MatrixXd energy = irregular_bending(scheme, kind);
    const double value = modes->values[1], patch_area = scheme == Scheme::loop ? std::sqrt(3.0) / 4 : 1;
    // The map's control points, and such that the surface they give has the area of a regular patch.
    const MatrixXd identity = MatrixXd::Identity(kind.point_count, kind.point_count);
    double area = 0;
    Eigen::VectorXd ring = Eigen::VectorXd::Zero(kind.point_count);
    for (int k = 0; k < 3; ++k) {
        const MatrixXd plane = modes->cells[k].middleCols(1, 2);
        for (double s = 1 / 32.0; s < 1; s += 1 / 16.0)
            for (double t = 1 / 32.0; t < 1; t += 1 / 16.0) {
                const double shrink = scheme == Scheme::loop ? 1 - s : 1;
                area += shrink / 256 * std::abs((regular_jet_rows(scheme, s, shrink * t).middleRows(1, 2) * plane).determinant()) / (1 - value * value);
            }
        ring += bending_by_sums(scheme, plane, kind.cells[k]);
    }
    // Without the outer ring it is the same, of the control points one step on, by a map that is smaller by `value`.
    const MatrixXd rest = energy - kind.step.transpose() * energy * kind.step / (value * value);
    const Eigen::VectorXd told = rest.diagonal() * patch_area * patch_area / area;
    // Midpoint sums are off by some (1/24)^2 of what changes over a cell.
    for (Eigen::Index i = 0; i < told.size(); ++i) CHECK_THAT(told[i], WithinAbs(ring[i], 0.01 * ring.maxCoeff()));
    // Planes have none.
    CHECK_THAT((energy * Eigen::VectorXd::Ones(kind.point_count)).norm(), WithinAbs(0, 1e-9 * energy.norm()));
}

// ---------------------------------------------------------------- the normal equations

namespace {

/// Places all over a mesh.
struct RandomPlaces {
    std::vector<Index> faces, corners;
    std::vector<double> uv;

    RandomPlaces(const PolygonMesh& mesh, Scheme scheme, int count, Index face_limit = -1) {
        shapes::Random random(5);
        for (int i = 0; i < count; ++i) {
            const Index face = random.below(face_limit < 0 ? mesh.face_count() : face_limit), degree = mesh.degree(face);
            const bool has_corners = scheme == Scheme::doo_sabin || (scheme == Scheme::catmull_clark && degree != 4);
            double u = random.next(), v = random.next();
            if (scheme == Scheme::loop && u + v > 1) u = 1 - u, v = 1 - v;
            faces.push_back(face);
            corners.push_back(has_corners ? random.below(degree) : 0);
            uv.push_back(u);
            uv.push_back(v);
        }
    }
    Places all() const { return {faces.size(), faces.data(), corners.data(), uv.data()}; }
};

/// The matrix of S at places over the mesh's points: every unit control point evaluated.
MatrixXd rows_at(const PatchTable& table, const Places& places) {
    std::vector<PatchPlace> found(places.count);
    locate(table, places, 0, places.count, found.data());
    MatrixXd rows(places.count, table.point_count);
    for (Index v = 0; v < table.point_count; ++v) {
        std::vector<double> unit(3 * static_cast<std::size_t>(table.point_count), 0.0);
        unit[3 * static_cast<std::size_t>(v)] = 1;
        const std::vector<double> control = control_points(table, unit, 3);
        for (std::size_t i = 0; i < places.count; ++i) rows(static_cast<Eigen::Index>(i), v) = reference_jet(table, control, found[i])[0][0];
    }
    return rows;
}

/// The energy's matrix, patch by patch.
MatrixXd energy_matrix(const PatchTable& table) {
    const Index n = table.point_count;
    std::vector<double> identity(static_cast<std::size_t>(n) * n, 0.0);
    for (Index v = 0; v < n; ++v) identity[static_cast<std::size_t>(v) * n + v] = 1;
    const std::vector<double> control = control_points(table, identity, n);
    MatrixXd sum = MatrixXd::Zero(n, n);
    for (Index patch = 0; patch < table.patch_count(); ++patch) {
        const Index begin = table.patch_begin[patch], K = table.patch_begin[patch + 1] - begin;
        MatrixXd points(K, n);
        for (Index i = 0; i < K; ++i) points.row(i) = Eigen::Map<const Eigen::RowVectorXd>(&control[static_cast<std::size_t>(table.control[begin + i]) * n], n);
        const MatrixXd energy = table.kind[patch] < 0 ? regular_bending(table.scheme) : irregular_bending(table.scheme, table.kinds[table.kind[patch]]);
        sum += std::pow(16.0, table.levels()) / table.patch_count() * points.transpose() * energy * points;
    }
    return sum;
}

using PackedPoints = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

MatrixXd dense_blocks(const FitSystem& system) {
    const Stencils& pattern = system.pattern();
    const auto n = static_cast<Eigen::Index>(pattern.offsets.size()) - 1;
    MatrixXd matrix = MatrixXd::Zero(3 * n, 3 * n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (std::size_t k = pattern.offsets[i]; k < pattern.offsets[i + 1]; ++k) {
            const double* const v = &system.normal()[FitSystem::block * k];
            matrix.block<3, 3>(3 * i, 3 * pattern.indices[k]) << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
        }
    return matrix;
}

struct Case {
    shapes::Shape shape;
    SchemeOptions options;
};

std::vector<Case> system_cases() {
    return {{shapes::cube(), solver_test::catmull_clark(0.5)},
            {shapes::polygons_mixed(30, 1), solver_test::catmull_clark()},
            {shapes::grid_with_creases(), solver_test::catmull_clark()},
            {shapes::with_isolated_vertex(shapes::icosahedron(), 3), solver_test::loop()},
            {shapes::grid_triangles_with_creases(), solver_test::loop()},
            {shapes::dodecahedron(), solver_test::doo_sabin()},
            {shapes::grid_with_hole(), solver_test::doo_sabin(DooSabinMask::classic)}};
}

double energy_of(const shapes::Shape& shape, const SchemeOptions& options) {
    const PatchTable table = table_of(shape, options);
    return FitSystem(table, 1).energy(shape.mesh.positions);
}

}  // namespace

TEST_CASE("the normal equations are those of rows that are formed one by one", "[least_squares]") {
    const auto [shape, options] = GENERATE(from_range(system_cases()));
    CAPTURE(shape.name);
    constexpr int count = 100;
    constexpr double fair = 0.3, along = 0.2;
    const PatchTable table = table_of(shape, options);
    const Index n = table.point_count;
    const RandomPlaces places(shape.mesh, options.scheme, count);
    const MatrixXd points = solver_test::rough_values(count, 3, 9), rows = rows_at(table, places.all()), energy = energy_matrix(table);
    const PackedPoints packed = points.rowwise() + Eigen::RowVector3d(100, 0, -50);
    PackedPoints normals = solver_test::rough_values(count, 3, 10).rowwise().normalized();
    MatrixXd normal = MatrixXd::Zero(3 * n, 3 * n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * n);
    for (int i = 0; i < count; ++i) {
        Eigen::Matrix3d metric = along * Eigen::Matrix3d::Identity() + (1 - along) * normals.row(i).transpose() * normals.row(i);
        if (i % 5 == 0) {
            metric.setIdentity();
            normals.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
        }
        const MatrixXd row = Eigen::kroneckerProduct(rows.row(i), Eigen::Matrix3d::Identity());
        normal += row.transpose() * metric * row / count;
        right += row.transpose() * metric * points.row(i).transpose() / count;
    }
    normal += fair * MatrixXd(Eigen::kroneckerProduct(energy, Eigen::Matrix3d::Identity()));
    FitSystem system(table, fair);
    system.set_samples({places.all(), packed.data(), normals.data(), along, {100, 0, -50}});
    // Sums of some hundreds of products in another order; the origin is taken away from numbers up to 100.
    CHECK((dense_blocks(system) - normal).cwiseAbs().maxCoeff() < 1e-13 * normal.cwiseAbs().maxCoeff());
    CHECK((Eigen::Map<const Eigen::VectorXd>(system.right().data(), 3 * n) - right).cwiseAbs().maxCoeff() < 1e-13);

    std::vector<double> control(shape.mesh.positions.size(), 0.0);
    CHECK(system.solve(control, 1e-14, 2000) < 2000);
    const Eigen::Map<const Eigen::VectorXd> solution(control.data(), 3 * n);
    CHECK((normal * solution - right).cwiseAbs().maxCoeff() < 1e-12);
    const Eigen::Map<const PackedPoints> solved(control.data(), n, 3);
    CHECK_THAT(system.energy(control), WithinAbs((solved.transpose() * energy * solved).trace(), 1e-11));
}

TEST_CASE("the bending energy is the same however often the table refines the mesh", "[least_squares]") {
    // Beside faces that are no quads all quads are refined once more. On regular quads nothing else changes: the energy of both is their mean by areas.
    const SchemeOptions options = solver_test::catmull_clark();
    const shapes::Shape quads = shapes::rough(shapes::torus_quads(5, 4), 0.1, 1), other = shapes::rough(shapes::octahedron(), 0.1, 2);
    const shapes::Shape both = shapes::combined(quads, other);
    REQUIRE(table_of(quads, options).levels() == 1);
    REQUIRE(table_of(both, options).levels() == 2);
    const double area = 20, other_area = 24 / 4.0;  // in faces; the corner of a triangle's face is a quarter of one
    CHECK_THAT(energy_of(both, options), WithinAbs((area * energy_of(quads, options) + other_area * energy_of(other, options)) / (area + other_area), 1e-12));
    // The same surface by a mesh with edges half as long: second derivatives are a quarter.
    for (const SchemeOptions& scheme : {options, solver_test::loop(), solver_test::doo_sabin()}) {
        const bool is_loop = scheme.scheme == Scheme::loop;
        shapes::Shape coarse = shapes::rough(is_loop ? shapes::torus_triangles(5, 4) : shapes::torus_quads(5, 4), 0.1, 3);
        shapes::Shape fine{"refined", refine(coarse.mesh, {}, scheme, 1).mesh, {}};
        CHECK_THAT(energy_of(fine, scheme), WithinAbs(energy_of(coarse, scheme) / 16, 1e-12));
    }
}

// ---------------------------------------------------------------- fits

namespace {

class Scene {
public:
    Scene(const shapes::Shape& shape, const SchemeOptions& options, Real real = Real::full)
        : shape_(shape), scheme_(options.scheme), surface_(solver_test::device_context(), table_of(shape, options), real) {}

    DeviceSurface& surface() { return surface_; }
    /// Points of the limit surface of `control` at random places.
    std::vector<double> points_of(const std::vector<double>& control, int count) {
        surface_.set_points(control.data(), 3);
        const RandomPlaces places(shape_.mesh, scheme_, count);
        std::vector<double> points(3 * static_cast<std::size_t>(count));
        SurfaceValues values;
        values.points = points.data();
        surface_.evaluate(surface_.make_samples(places.all(), 0, places.all().count), values);
        return points;
    }
    LeastSquaresFit fit(const std::vector<double>& points, const LeastSquaresOptions& options) { return fit_from(shape_.mesh.positions, points, options); }
    LeastSquaresFit fit_from(const std::vector<double>& control, const std::vector<double>& points, const LeastSquaresOptions& options) {
        return fit_least_squares(surface_, points, control, options);
    }

private:
    shapes::Shape shape_;
    Scheme scheme_;
    DeviceSurface surface_;
};

std::vector<double> sphere_points(int count, double noise) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::vector<double> points;
    for (int i = 0; i < count; ++i) {
        const Eigen::Vector3d direction = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized(),
                              at = (1 + noise * normal(random)) * direction;
        points.insert(points.end(), at.data(), at.data() + 3);
    }
    return points;
}

double root_mean_square(const std::vector<double>& distances) {
    return std::sqrt(Eigen::Map<const Eigen::VectorXd>(distances.data(), static_cast<Eigen::Index>(distances.size())).squaredNorm() /
                     static_cast<double>(distances.size()));
}

/// Of |S| - 1.
double sphere_error(const std::vector<double>& points) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < points.size(); i += 3) errors.push_back(Eigen::Map<const Eigen::Vector3d>(&points[i]).norm() - 1);
    return root_mean_square(errors);
}

LeastSquaresOptions weight(double fair, int max_corrections = 30) { return {fair, max_corrections, {}}; }

std::vector<Case> sphere_cases() {
    return {{shapes::icosphere_quads(0), solver_test::catmull_clark()},
            {shapes::icosphere(1), solver_test::loop()},
            {shapes::icosphere_quads(0), solver_test::doo_sabin()}};
}

}  // namespace

TEST_CASE("noise on a sphere is smoothed away by few control points", "[least_squares]") {
    const auto [shape, options] = GENERATE(from_range(sphere_cases()));
    const Real real = GENERATE(Real::full, Real::single);
    if (real == Real::full && !solver_test::device_context()->device().has_double) return;
    constexpr double noise = 0.05;
    constexpr int count = 3000;
    Scene scene(shape, options, real);
    const LeastSquaresFit fit = scene.fit(sphere_points(count, noise), weight(1e-3));
    CAPTURE(fit.corrections, fit.iterations);
    // What is left is the noise, less the part of it that as many control points as there are take up: 62 or 42 of 3000.
    CHECK_THAT(root_mean_square(fit.distances), WithinAbs(noise, 0.03 * noise));
    CHECK(sphere_error(scene.points_of(fit.control, 2000)) < noise / 5);
    CHECK(fit.corrections >= 1);
    CHECK(fit.iterations >= fit.corrections);
}

TEST_CASE("the control points of a surface come back from points on it", "[least_squares]") {
    const auto [shape, options] = GENERATE(from_range(sphere_cases()));
    if (!solver_test::device_context()->device().has_double) return;
    Scene scene(shape, options);
    const std::vector<double> truth = shapes::rough(shape, 0.05, 4).mesh.positions;
    const LeastSquaresFit fit = scene.fit_from(shapes::rough(shape, 0.05, 8).mesh.positions, scene.points_of(truth, 3000), weight(0, 100));
    double largest = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) largest = std::max(largest, std::abs(fit.control[i] - truth[i]));
    CAPTURE(fit.corrections, fit.iterations, root_mean_square(fit.distances));
    CHECK(largest < 1e-6);
}

TEST_CASE("fits with boundaries and creases come near to their points", "[least_squares]") {
    const auto [shape, options] = GENERATE(values<Case>({{shapes::cube_with_crease_loop(), solver_test::catmull_clark()},
                                                         {shapes::grid_quads(3, 4), solver_test::catmull_clark()},
                                                         {shapes::grid_triangles(4, 3), solver_test::loop()},
                                                         {shapes::grid_quads(4, 3), solver_test::doo_sabin()}}));
    CAPTURE(shape.name, static_cast<int>(options.scheme));
    Scene scene(shape, options);
    const std::vector<double> points = scene.points_of(shapes::rough(shape, 0.05, 4).mesh.positions, 2000),
                              start = shapes::rough(shape, 0.05, 8).mesh.positions;
    const double before = root_mean_square(scene.fit_from(start, points, weight(0, 0)).distances);
    const double after = root_mean_square(scene.fit_from(start, points, weight(0)).distances);
    // Points beyond a boundary, or seen from a crease, do not slide: there it goes as slowly as with fixed pairs of points, and does not end at zero soon.
    CHECK(before > 0.005);
    CHECK(after < before / 10);
}

TEST_CASE("a larger weight of the bending energy makes flatter surfaces", "[least_squares]") {
    const auto [shape, options] = GENERATE(from_range(sphere_cases()));
    Scene scene(shape, options);
    const FitSystem system(scene.surface().table(), 1);
    const std::vector<double> points = sphere_points(1000, 0.05);
    double energy = std::numeric_limits<double>::infinity(), rms = 0;
    for (const double fair : {1e-4, 1e-2, 1.0}) {
        const LeastSquaresFit fit = scene.fit(points, weight(fair));
        CHECK(system.energy(fit.control) < 0.98 * energy);
        CHECK(root_mean_square(fit.distances) > rms);
        energy = system.energy(fit.control);
        rms = root_mean_square(fit.distances);
    }
}

TEST_CASE("vertices that no point sees stay where they are", "[least_squares]") {
    // Points on the first face of a strip of ten, and a vertex without faces. Catmull-Clark: a face depends on its neighbours' vertices.
    const shapes::Shape shape = shapes::with_isolated_vertex(shapes::rough(shapes::grid_quads(10, 1), 0.05, 1), 7);
    Scene scene(shape, solver_test::catmull_clark());
    const std::vector<double>& start = shape.mesh.positions;
    std::vector<double> points;
    for (int i = 0; i < 3; ++i) points.insert(points.end(), {start[3 * shape.mesh.face_vertices[i]], start[3 * shape.mesh.face_vertices[i] + 1], 0.3});
    const LeastSquaresFit fit = scene.fit(points, weight(0, 3));
    std::vector<Index> moved;
    for (Index v = 0; v < shape.mesh.vertex_count; ++v)
        if (!std::equal(&start[3 * v], &start[3 * v] + 3, &fit.control[3 * v])) moved.push_back(v);
    CHECK(!moved.empty());
    CHECK(moved.size() <= 8);
    CHECK(std::find(moved.begin(), moved.end(), 7) == moved.end());
    const LeastSquaresFit fair = scene.fit(points, weight(0.1, 3));
    CHECK(std::equal(&start[3 * 7], &start[3 * 7] + 3, &fair.control[3 * 7]));
}

TEST_CASE("progress is told before every correction and cancels the fit", "[least_squares]") {
    Scene scene(shapes::icosphere(1), solver_test::loop());
    const std::vector<double> points = sphere_points(500, 0.05);
    std::vector<double> largest;
    LeastSquaresOptions options = weight(1e-3);
    options.progress = [&](int corrections, double distance) {
        CHECK(corrections == static_cast<int>(largest.size()));
        largest.push_back(distance);
        return corrections < 2;
    };
    CHECK_THROWS_AS(scene.fit(points, options), Cancelled);
    CHECK(largest.size() == 3);
    const LeastSquaresFit none = scene.fit(points, weight(1e-3, 0));
    CHECK(none.corrections == 0);
    CHECK(none.control == shapes::icosphere(1).mesh.positions);
    CHECK(largest.front() == *std::max_element(none.distances.begin(), none.distances.end()));
    CHECK_THROWS_AS(scene.fit({}, weight(0)), InvalidArgument);
}

TEST_CASE("searches that begin at places find what searches from seeds find", "[least_squares][closest]") {
    const auto [shape, options] = GENERATE(values<Case>({{shapes::icosphere_quads(1), solver_test::catmull_clark()},
                                                         {shapes::dodecahedron(), solver_test::catmull_clark()},
                                                         {shapes::icosphere(1), solver_test::loop()},
                                                         {shapes::icosphere_quads(1), solver_test::doo_sabin()}}));
    if (!solver_test::device_context()->device().has_double) return;
    Scene scene(shape, options);
    DeviceSurface& surface = scene.surface();
    const std::vector<double> points = sphere_points(500, 0.05), moved = shapes::rough(shape, 0.01, 3).mesh.positions;
    std::vector<Index> faces(500), corners(500);
    std::vector<double> uv(1000), distances(500), right(500);
    const Places places{500, faces.data(), corners.data(), uv.data()};
    ClosestPoints out;
    out.faces = faces.data(), out.corners = corners.data(), out.uv = uv.data(), out.distances = distances.data();
    surface.set_points(shape.mesh.positions.data(), 3);
    ClosestSearch search(surface);
    search.find(points.data(), 3, 500, out);
    surface.set_points(moved.data(), 3);
    search.find(points.data(), 3, 500, out, &places);
    ClosestPoints only_distances;
    only_distances.distances = right.data();
    ClosestSearch(surface).find(points.data(), 3, 500, only_distances);
    // On so round a surface, so near to it, there is one local minimum: both ways end within 1e-12 of it, where distances are flat.
    for (int i = 0; i < 500; ++i) CHECK_THAT(distances[i], WithinAbs(right[i], 1e-13));
}
