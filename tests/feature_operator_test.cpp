// SPDX-License-Identifier: BSD-3-Clause
// The feature-preserving operator: its rows against the formula written out, its spectrum, and that it smooths a noisy edge along and not across.
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "host/apply/smoothed_points.h"
#include "tests/oracle/dense.h"
#include "tests/oracle/limit.h"
#include "tests/rows_support.h"
#include "tests/solver_support.h"

using namespace capi_test;
using namespace rows_test;
using solver_test::largest;

namespace {

const double pi = std::acos(-1.0);

lcl_feature_options feature_options(double angle = 0, double factor = 0, int32_t smoothing = 0) {
    lcl_feature_options options = LCL_FEATURE_OPTIONS_INIT;
    options.angle_degrees = angle;
    options.diagonal_factor = factor;
    options.smoothing = smoothing;
    return options;
}

lcl_status create(const shapes::Shape& shape, const lcl_feature_options* options, Operator& A) {
    lcl_operator made = nullptr;
    const lcl_status status = lcl_operator_create_features(default_context(), make_mesh(shape).get(), options, &made);
    A.reset(made);
    return status;
}

Operator make_features(const shapes::Shape& shape, const lcl_feature_options& options = LCL_FEATURE_OPTIONS_INIT) {
    Operator A;
    succeed(create(shape, &options, A));
    return A;
}

/// M with (E - (E - A)^3) A of the default scheme's limit rows applied `times` times, the rows from the oracle.
Eigen::MatrixXd smoothed(const shapes::Shape& shape, int times) {
    lcl::SchemeOptions scheme;
    if (shapes::is_triangle_mesh(shape.mesh)) scheme.scheme = lcl::Scheme::loop;
    const Eigen::MatrixXd a = oracle::limit_rows(shape.mesh, shape.features, scheme), e = Eigen::MatrixXd::Identity(a.rows(), a.rows());
    Eigen::MatrixXd points = oracle::positions(shape.mesh);
    for (int time = 0; time < times; ++time) points = (a - (e - a) * (e - a) * (e - a) * a) * points;
    return points;
}

/// Sum of the cross products of the faces' fans round their first corners, vertex by vertex.
Eigen::MatrixXd normals(const shapes::Shape& shape, const Eigen::MatrixXd& points) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(points.rows(), 3);
    for (const shapes::Face& face : shapes::faces_of(shape.mesh)) {
        Eigen::RowVector3d normal(0, 0, 0);
        for (std::size_t k = 1; k + 1 < face.size(); ++k) {
            const Eigen::RowVector3d p = points.row(face[k]) - points.row(face[0]), q = points.row(face[k + 1]) - points.row(face[0]);
            normal += p.cross(q);
        }
        for (const int v : face) out.row(v) += normal;
    }
    return out;
}

/// The operator as the header has it; `holds`: which neighbours a vertex holds to, empty: it stays.
Eigen::MatrixXd expected_rows(const shapes::Shape& shape, const Eigen::MatrixXd& points, double angle, double factor, const std::vector<std::set<int>>& holds) {
    const Eigen::MatrixXd n = normals(shape, points);
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n.rows(), n.rows());
    for (Eigen::Index i = 0; i < n.rows(); ++i) {
        if (holds[i].empty()) continue;
        double sum = 0;
        for (const int j : holds[i]) {
            const double cosine = std::max(-1.0, std::min(1.0, n.row(i).dot(n.row(j)) / (n.row(i).norm() * n.row(j).norm())));
            const double ratio = std::acos(cosine) * 180 / pi / angle;
            sum += a(i, j) = std::exp(-ratio * ratio);
        }
        a.row(i) /= factor * sum;
        a(i, i) = 1 - 1 / factor;
    }
    return a;
}

std::vector<std::set<int>> edges_of(const shapes::Shape& shape) {
    std::vector<std::set<int>> ends(shape.mesh.vertex_count);
    for (const shapes::Face& face : shapes::faces_of(shape.mesh))
        for (std::size_t k = 0; k < face.size(); ++k) {
            ends[face[k]].insert(face[(k + 1) % face.size()]);
            ends[face[(k + 1) % face.size()]].insert(face[k]);
        }
    return ends;
}

/// What each vertex holds to, by the mesh's features.
std::vector<std::set<int>> neighbours(const shapes::Shape& shape) {
    const solver_test::Prepared mesh(shape);
    std::vector<std::set<int>> out = edges_of(shape);
    for (int v = 0; v < shape.mesh.vertex_count; ++v) {
        const lcl::VertexKind kind = mesh.features.kind[v];
        if (kind == lcl::VertexKind::corner || kind == lcl::VertexKind::isolated) out[v].clear();
        if (kind == lcl::VertexKind::curve) out[v] = {mesh.features.curve_neighbours[v][0], mesh.features.curve_neighbours[v][1]};
    }
    return out;
}

}  // namespace

TEST_CASE("feature rows follow the formula on every kind of vertex", "[feature-operator][oracle]") {
    for (shapes::Shape shape : {shapes::rough(shapes::icosphere(2), 0.1, 1), shapes::rough(shapes::polygons_mixed(60, 4), 0.05, 2), shapes::grid_with_creases(),
                                shapes::grid_with_hole(), shapes::torus_triangles_with_dart(), shapes::cube_with_crease(), shapes::grid_with_marked_corner(),
                                shapes::with_isolated_vertex(shapes::grid_triangles_with_creases(), 7)}) {
        shape = shapes::rough(shape, 0.1, 8);
        for (const auto& [angle, factor, smoothing] : {std::tuple(0.0, 0.0, 0), std::tuple(20.0, 4.0, 1), std::tuple(90.0, 2.2, -1)}) {
            INFO(shape.name << ", angle " << angle);
            const Operator A = make_features(shape, feature_options(angle, factor, smoothing));
            const int times = smoothing == 0 ? 3 : std::max(0, smoothing);
            const Eigen::MatrixXd expected =
                expected_rows(shape, smoothed(shape, times), angle == 0 ? 20 : angle, factor == 0 ? 2.5 : factor, neighbours(shape));
            CHECK(largest(rows_test::matrix_of(rows_of(A.get())) - expected) < 1e-9);  // acos(cosine) loses half of the digits near 0, squared here
        }
    }
}

TEST_CASE("points for directions are the smoothed ones in a box of size 1", "[feature-operator]") {
    for (const shapes::Shape& shape : {shapes::rough(shapes::icosphere(2), 0.1, 1), shapes::transformed(shapes::grid_with_creases(), 1e-3, 5)}) {
        const solver_test::Prepared mesh(shape);
        const std::vector<double> points = lcl::smoothed_points(shape.mesh, mesh.topology, mesh.features, 2);
        const Eigen::MatrixXd expected = smoothed(shape, 2), found = rows_test::matrix_of(points, 3), before = oracle::positions(shape.mesh);
        const double size = box_diagonal(before);
        const Eigen::RowVectorXd centre = (before.colwise().maxCoeff() + before.colwise().minCoeff()) / 2;
        CHECK(largest(found - (expected.rowwise() - centre) / size) < 1e-11);
    }
}

TEST_CASE("the spectrum of a feature operator is real and lies between 1 - 2/factor and 1", "[feature-operator][spectrum]") {
    for (const double factor : {2.1, 2.5, 6.0})
        for (const shapes::Shape& shape : {shapes::rough(shapes::icosphere_quads(1), 0.2, 3), shapes::rough(shapes::grid_quads(6, 5), 0.2, 4)}) {
            INFO(shape.name << ", factor " << factor);
            const Operator A = make_features(shape, feature_options(0, factor));
            const auto spectrum = oracle::spectrum(rows_test::matrix_of(rows_of(A.get())));
            for (const auto& value : spectrum) CHECK((std::fabs(value.imag()) < 1e-9 && value.real() > 1 - 2 / factor - 1e-12 && value.real() < 1 + 1e-12));
            lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
            succeed(lcl_operator_diagnose(A.get(), &diagnosis));
            CHECK(diagnosis.lambda_min_bound == Approx(1 - 2 / factor));
            CHECK(diagnosis.lambda_min_estimate >= diagnosis.lambda_min_bound);
            CHECK(diagnosis.lambda_min_estimate <= std::max(spectrum[0].real() * 1.1, 1 - 2 / factor + 1e-12) + 0.02);
            CHECK((diagnosis.singular == 0 && diagnosis.indefinite == 0));
        }
}

TEST_CASE("D of a feature operator counts weights, and makes the block inside the surface symmetric", "[feature-operator][spectrum]") {
    for (shapes::Shape shape : {shapes::rough(shapes::icosphere(1), 0.2, 3), shapes::rough(shapes::grid_with_marked_corner(), 0.2, 4)}) {
        const solver_test::Prepared mesh(shape);
        lcl::FeatureOperatorOptions options;
        options.subset.assign(shape.mesh.vertex_count, 1);
        options.subset[11] = 0;
        const auto system = make_feature_system(solver_test::device_context(), shape.mesh, mesh.topology, mesh.features, options);
        const lcl::Plan& plan = system->plan();
        const Eigen::MatrixXd a = solver_test::matrix_of(plan);
        CHECK(plan.has_scaling);
        CHECK(plan.rows_sum_to_one);
        CHECK(largest(a.rowwise().sum() - Eigen::VectorXd::Ones(a.rows())) < 4e-16 * 8);
        CHECK(plan.row_of_vertex[11] < plan.fixed.end_row());
        for (lcl::Index row = 0; row < plan.row_count; ++row) CHECK(plan.scaling[row] > 0);
        for (lcl::Index i = plan.smooth.first_row; i < plan.smooth.end_row(); ++i)
            for (lcl::Index j = plan.smooth.first_row; j < plan.smooth.end_row(); ++j) {
                const lcl::Index v = plan.vertex_of_row[i], w = plan.vertex_of_row[j];
                CHECK(plan.scaling[i] * a(v, w) == Approx(plan.scaling[j] * a(w, v)).epsilon(1e-13));
                if (v != w && a(v, w) > 0) CHECK((plan.scaling[i] * a(v, w) > 0 && plan.scaling[i] * a(v, w) <= 1));
            }
    }
}

TEST_CASE("a noisy box gets straight edges and flat sides under a feature operator, and keeps them sharp", "[feature-operator][denoise]") {
    shapes::Shape shape = shapes::box_with_crease_angle();
    shape.features = {};                       // the operator is to find the edges by itself
    for (int level = 0; level < 2; ++level) {  // 3 x 3 quads a side, split in four twice, without moving anything
        std::vector<shapes::Point> points = shapes::points_of(shape.mesh);
        std::map<std::vector<int>, int> made;
        const auto middle = [&](std::vector<int> corners) {
            std::sort(corners.begin(), corners.end());
            const auto [place, is_new] = made.emplace(corners, static_cast<int>(points.size()));
            if (!is_new) return place->second;
            shapes::Point sum{0, 0, 0};
            for (const int v : corners)
                for (int c = 0; c < 3; ++c) sum[c] += points[v][c] / static_cast<double>(corners.size());
            points.push_back(sum);
            return place->second;
        };
        std::vector<shapes::Face> faces;
        for (const shapes::Face& face : shapes::faces_of(shape.mesh))
            for (std::size_t k = 0; k < 4; ++k)
                faces.push_back({face[k], middle({face[k], face[(k + 1) % 4]}), middle(face), middle({face[(k + 3) % 4], face[k]})});
        shape = shapes::make("box", points, faces);
    }
    const Eigen::MatrixXd exact = oracle::positions(shape.mesh);
    const Eigen::RowVectorXd low = exact.colwise().minCoeff(), high = exact.colwise().maxCoeff();
    const double size = high[0] - low[0], noise = 0.01 * size;  // an edge is 1/12 long
    const shapes::Shape noisy = shapes::rough(shape, noise, 5);
    // T = D^3 A M with m = 2, by hand: the operator's own rows.
    const auto denoised = [&](lcl_operator A) {
        const Eigen::MatrixXd a = rows_test::matrix_of(rows_of(A)), rest = Eigen::MatrixXd::Identity(a.rows(), a.rows()) - a;
        Eigen::MatrixXd t = a * oracle::positions(noisy.mesh);
        for (int k = 0; k < 3; ++k) t -= rest * rest * rest * t;
        return t;
    };
    const Eigen::MatrixXd kept = denoised(make_features(noisy).get()), plain = denoised(make_operator(noisy).get());
    const auto error = [&](const Eigen::MatrixXd& points, int least_planes, int most_planes) {  // root mean square distance to the planes a vertex lies on
        double sum = 0;
        int count = 0;
        for (Eigen::Index v = 0; v < exact.rows(); ++v) {
            std::vector<double> distances;
            for (int c = 0; c < 3; ++c)
                if (exact(v, c) < low[c] + 1e-9 || exact(v, c) > high[c] - 1e-9) distances.push_back(points(v, c) - exact(v, c));
            if (static_cast<int>(distances.size()) < least_planes || static_cast<int>(distances.size()) > most_planes) continue;
            for (const double d : distances) sum += d * d, ++count;
        }
        return std::sqrt(sum / count);
    };
    const Eigen::MatrixXd given = oracle::positions(noisy.mesh);
    CHECK(error(given, 1, 1) > 0.5 * noise);
    CHECK(error(kept, 1, 1) < 0.6 * error(given, 1, 1));   // sides are flatter: white noise on a flat grid without weights gains 0.56
    CHECK(error(kept, 2, 2) < error(given, 2, 2));         // edges straighter
    CHECK(error(plain, 2, 2) > 1.5 * error(given, 2, 2));  // and where they were, which the limit operator rounds off
}

TEST_CASE("a feature operator is solved with like others", "[feature-operator]") {
    for (shapes::Shape shape :
         {shapes::rough(shapes::icosphere(2), 0.05, 1), shapes::rough(shapes::grid_with_marked_corner(), 0.1, 2), shapes::grid_with_creases()}) {
        INFO(shape.name);
        const Operator A = make_features(shape);
        const Eigen::MatrixXd a = rows_test::matrix_of(rows_of(A.get())), m = oracle::positions(shape.mesh);
        const bool has_darts = shape.name == shapes::grid_with_creases().name;
        std::vector<lcl_solver> solvers{LCL_SOLVER_AUTO, LCL_SOLVER_PIA,         LCL_SOLVER_WPIA,     LCL_SOLVER_JACOBI,
                                        LCL_SOLVER_GS,   LCL_SOLVER_GS_COLOURED, LCL_SOLVER_CHEBYSHEV};
        if (!has_darts) solvers.push_back(LCL_SOLVER_CG);
        for (const lcl_solver solver : solvers) {
            const Solved solved(A.get(), m, solve_options(solver, 1e-9));
            INFO("solver " << solver << ": " << solved.report.message);
            CHECK(solved.status == LCL_OK);
            CHECK(oracle::largest_row(m - a * solved.P) <= 1.01e-9 * diagonal_of(shape));
            CHECK(oracle::largest_row(solved.P - oracle::solve(a, m)) <= 5 * 2e-9 * diagonal_of(shape));  // |A^-1| <= 1/(2 * 0.6 - 1)
        }
        const lcl_solve_options conjugate = solve_options(LCL_SOLVER_CG);
        std::vector<double> P(shape.mesh.positions.size());
        if (has_darts)
            refuse(lcl_interpolate(A.get(), shape.mesh.positions.data(), 0, 3, &conjugate, P.data(), 0, nullptr), LCL_ERROR_INVALID_ARGUMENT, "with darts");
        lcl_solve_options certified = solve_options(LCL_SOLVER_AUTO, 1e-5);
        certified.certify = 1;
        const Solved solved(A.get(), m, certified);
        if (has_darts) CHECK(std::isnan(solved.report.surface_error_bound));
        else CHECK(oracle::largest_row(solved.P - oracle::solve(a, m)) <= solved.report.surface_error_bound);
        double norm = 0;
        int32_t proven = 0;
        if (!has_darts) {
            succeed(lcl_operator_inverse_norm(A.get(), &norm, &proven));
            CHECK((proven == 1 && norm == Approx(5)));
        }
        lcl_scheme_options scheme = LCL_SCHEME_OPTIONS_INIT;
        succeed(lcl_operator_get_scheme(A.get(), &scheme));
        CHECK(scheme.scheme == LCL_SCHEME_DEFAULT);
    }
}

TEST_CASE("edits are followed locally on a feature operator, darts and curves among its rows", "[feature-operator][local]") {
    for (shapes::Shape shape : {shapes::rough(shapes::torus_triangles(30, 20), 0.02, 1), shapes::grid_with_creases()}) {
        INFO(shape.name);
        const Operator A = make_features(shape);
        const std::vector<double>& m = shape.mesh.positions;
        const FieldHandle M = make_field(A.get(), m), P = make_field(A.get());
        lcl_solve_options options = solve_options(LCL_SOLVER_AUTO, 1e-8, LCL_PRECISION_DOUBLE);
        succeed(lcl_interpolate_field(A.get(), M.get(), &options, P.get(), nullptr));
        const int32_t edited[] = {8, 17};
        const std::vector<double> values{m[24] + 0.1, m[25], m[26] + 0.3, m[51], m[52] - 0.2, m[53]};
        lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
        succeed(lcl_solve_local(A.get(), M.get(), P.get(), edited, 2, values.data(), &options, &report));
        std::vector<double> after = m;
        std::copy_n(values.begin(), 3, after.begin() + 24);
        std::copy_n(values.begin() + 3, 3, after.begin() + 51);
        const int32_t count = shape.mesh.vertex_count;
        CHECK((report.converged == 1 && report.changed_rows <= count));
        const Eigen::MatrixXd p = rows_test::matrix_of(download(P.get(), count), 3);
        CHECK(oracle::largest_row(rows_test::matrix_of(after, 3) - limit_points(A.get(), p)) <= 1.01e-8 * diagonal_of(shape));
    }
}

TEST_CASE("vertices outside the subset, and those whose weights underflow, stay", "[feature-operator]") {
    const shapes::Shape shape = shapes::rough(shapes::icosphere(2), 0.1, 1);
    const int32_t movable[] = {3, 4, 5, 50, 60};
    lcl_feature_options options = feature_options();
    options.subset = movable;
    options.subset_count = 5;
    const Operator A = make_features(shape, options), whole = make_features(shape);
    const Eigen::MatrixXd a = rows_test::matrix_of(rows_of(A.get())), all = rows_test::matrix_of(rows_of(whole.get()));
    for (Eigen::Index v = 0; v < a.rows(); ++v) {
        const bool moves = std::find(std::begin(movable), std::end(movable), v) != std::end(movable);
        CHECK(largest(a.row(v) - (moves ? Eigen::MatrixXd(all.row(v)) : Eigen::MatrixXd::Identity(a.rows(), a.rows()).row(v))) == 0);
    }
    // A spike whose normals all differ by more than 27 angles: exp(-27^2) is 0 in double.
    const Operator spiky = make_features(shapes::octahedron(), feature_options(1, 0, -1));
    CHECK(largest(rows_test::matrix_of(rows_of(spiky.get())) - Eigen::MatrixXd::Identity(6, 6)) == 0);
    const Eigen::MatrixXd m = oracle::positions(shapes::octahedron().mesh);
    CHECK(largest(Solved(spiky.get(), m).P - m) == 0);
}

TEST_CASE("feature operators do not depend on the size and place of the mesh, nor on its numbering", "[feature-operator][scale]") {
    const shapes::Shape shape = shapes::rough(shapes::polygons_mixed(80, 2), 0.05, 3);
    const Eigen::MatrixXd a = rows_test::matrix_of(rows_of(make_features(shape).get()));
    for (const auto& [scale, offset, tolerance] : {std::tuple(1e150, 0.0, 1e-13), std::tuple(1e-150, 0.0, 1e-13), std::tuple(1.0, 1e5, 1e-9)}) {
        INFO(scale << ", " << offset);
        const shapes::Shape moved = shapes::transformed(shape, scale, offset);
        CHECK(largest(rows_test::matrix_of(rows_of(make_features(moved).get())) - a) < tolerance);
    }
    shapes::Shape flat = shapes::grid_quads(5, 5);  // no normal turns: plain smoothing, vertex 14 inside
    for (std::size_t v = 0; v < 36; ++v) flat.mesh.positions[3 * v + 2] = 0;
    const auto check_plain = [&] {
        const Eigen::MatrixXd plain = rows_test::matrix_of(rows_of(make_features(flat).get()));
        CHECK(plain(14, 14) == Approx(0.6));
        for (const int other : {8, 13, 15, 20}) CHECK(plain(14, other) == Approx(0.1));
    };
    check_plain();
    std::fill(flat.mesh.positions.begin(), flat.mesh.positions.end(), 1.0);  // nor where there is none
    check_plain();
}

TEST_CASE("options of feature operators are checked", "[feature-operator][capi]") {
    const shapes::Shape shape = shapes::octahedron();
    Operator A;
    const auto refuse_options = [&](const lcl_feature_options& options, const std::string& sentence) {
        refuse(create(shape, &options, A), LCL_ERROR_INVALID_ARGUMENT, sentence);
        CHECK(A == nullptr);
    };
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    refuse_options(feature_options(-1), "options.angle_degrees is -1.000000, it is above 0 and at most 180");
    refuse_options(feature_options(181), "options.angle_degrees is 181.000000");
    refuse_options(feature_options(not_a_number), "options.angle_degrees is nan");
    refuse_options(feature_options(0, 2), "options.diagonal_factor is 2.000000, it is above 2");
    refuse_options(feature_options(0, -3), "options.diagonal_factor is -3.000000");
    refuse_options(feature_options(0, not_a_number), "options.diagonal_factor is nan");
    refuse_options(feature_options(0, std::numeric_limits<double>::infinity()), "options.diagonal_factor is inf");
    refuse_options(feature_options(0, 0, 1001), "options.smoothing is 1001, it is at most 1000");
    const int32_t vertex = 6;
    lcl_feature_options options = feature_options();
    options.subset = &vertex;
    options.subset_count = 1;
    refuse_options(options, "subset names vertex 6, the mesh has 6");
    options.struct_size = 0;
    refuse_options(options, "options.struct_size is not set");
    succeed(create(shape, nullptr, A));
    refuse(create(shapes::edge_with_three_faces(), nullptr, A), LCL_ERROR_BAD_INPUT, "belongs to 3 faces");
}

TEST_CASE("a feature operator of a small mesh runs on the device", "[feature-operator][tiny]") {
    const shapes::Shape shape = shapes::rough(shapes::grid_quads(3, 3), 0.1, 1);
    const Operator A = make_features(shape);
    const Eigen::MatrixXd m = oracle::positions(shape.mesh);
    CHECK(largest(limit_points(A.get(), m, LCL_PRECISION_MIXED) - rows_test::matrix_of(rows_of(A.get())) * m) < 1e-12);
}
