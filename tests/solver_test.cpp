// SPDX-License-Identifier: BSD-3-Clause
// Every solver against dense solutions and plain loops.
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include <catch2/catch.hpp>

#include "host/solve/curves.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

const std::vector<Solver> all_solvers{
    Solver::automatic,          Solver::pia, Solver::wpia, Solver::jacobi, Solver::gauss_seidel, Solver::gauss_seidel_coloured, Solver::chebyshev,
    Solver::conjugate_gradients};

Eigen::MatrixXd positions(const Prepared& mesh) { return oracle::positions(mesh.shape.mesh); }

/// The dense operator, its solution for M, and |A^-1|_inf.
struct Dense {
    Dense(const Plan& plan, const Eigen::MatrixXd& m)
        : a(matrix_of(plan)),
          solution(oracle::solve(a, m)),
          inverse_norm(oracle::infinity_norm(oracle::solve(a, Eigen::MatrixXd::Identity(a.rows(), a.cols())))) {}
    Eigen::MatrixXd a, solution;
    double inverse_norm;
};

double error_of(const Solved& solved, const Dense& dense) { return oracle::largest_row(solved.points - dense.solution); }
double residual_of(const Solved& solved, const Dense& dense, const Eigen::MatrixXd& m) { return oracle::largest_row(m - dense.a * solved.points); }

/// What a converged solve has to keep: the tolerance, the residual it names, and the dense solution within |A^-1|_inf times it.
void check_converged(const Solved& solved, const Dense& dense, const Eigen::MatrixXd& m, double tolerance, double diagonal) {
    CHECK(solved.report.status == SolveStatus::converged);
    CHECK(solved.report.message == "");
    CHECK(solved.report.max_error <= tolerance * diagonal);
    CHECK(residual_of(solved, dense, m) <= solved.report.max_error + 1e-13 * diagonal);
    CHECK(residual_of(solved, dense, m) >= solved.report.max_error - 1e-13 * diagonal);
    CHECK(error_of(solved, dense) <= dense.inverse_norm * (solved.report.max_error + 1e-13 * diagonal));
    CHECK(solved.report.residuals.size() == static_cast<std::size_t>(solved.report.iterations) + 1);
}

void check_histories(const SolveReport& report, const oracle::History& plain, double tolerance) {
    REQUIRE(report.residuals.size() == plain.residuals.size());
    for (std::size_t k = 0; k < plain.residuals.size(); ++k)
        CHECK(report.residuals[k] == Approx(plain.residuals[k]).epsilon(tolerance).margin(tolerance * plain.residuals[0]));
}

SolveOptions exact(Solver solver, int sweeps, Precision precision = Precision::full) {
    SolveOptions options = solve_options(solver, 1e-6, precision);
    options.exact_sweeps = sweeps;
    return options;
}

std::vector<Precision> precisions() {
    return device_context()->device().has_double ? std::vector<Precision>{Precision::mixed, Precision::full} : std::vector<Precision>{Precision::mixed};
}
bool has_double() { return device_context()->device().has_double; }

}  // namespace

TEST_CASE("every solver reaches the dense solution with every scheme", "[solver]") {
    const std::vector<shapes::Shape> list{shapes::rough(shapes::random_triangle_mesh(150, 4), 0.1, 1), shapes::rough(shapes::icosphere_quads(1), 0.1, 2)};
    for (const auto& shape : list) {
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        for (const auto& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            const auto system = mesh.system(device_context(), scheme.options);
            const Dense dense(system->plan(), m);
            for (const Solver solver : all_solvers)
                for (const Precision precision : precisions()) {
                    if (solver == Solver::jacobi && dense.a.diagonal().minCoeff() <= 0.5) continue;  // sure to converge under dominance alone
                    INFO(shape.name << ", " << scheme.name << ", solver " << static_cast<int>(solver) << ", precision " << static_cast<int>(precision));
                    check_converged(solve(*system, m, solve_options(solver, 1e-8, precision)), dense, m, 1e-8, system->diagonal);
                }
        }
    }
}

TEST_CASE("automatic converges on every shape with every scheme that is not singular", "[solver]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        for (const auto& scheme : {catmull_clark(0.5), catmull_clark(0, 1.0 / 3), loop(), doo_sabin(), doo_sabin(DooSabinMask::classic)}) {
            if (!suits(shape, scheme) || shape.name == "cube_split_edges" || shape.name == "valence_2_pole") continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme) << ", alpha " << scheme.alpha << ", lambda " << scheme.lambda);
            const auto system = mesh.system(device_context(), scheme);
            const Dense dense(system->plan(), m);
            for (const Precision precision : precisions()) {
                const Solved solved = solve(*system, m, solve_options(Solver::automatic, 1e-8, precision, 200));
                check_converged(solved, dense, m, 1e-8, system->diagonal);
            }
        }
    }
}

TEST_CASE("automatic converges with boundaries, creases and darts at alpha 0 too", "[solver][crease][boundary]") {
    auto list = shapes::feature_shapes();
    for (const auto& shape :
         {shapes::grid_quads(4, 3), shapes::grid_with_hole(), shapes::cylinder_open(5, 3), shapes::disk_pole_quads(7), shapes::disk_pole_triangles(9)})
        list.push_back(shape);
    for (const auto& shape : list) {
        if (shape.name == "cube_with_dart") continue;  // singular: see below
        INFO(shape.name);
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        const auto system = mesh.system(device_context(), catmull_clark());
        const Dense dense(system->plan(), m);
        for (const Precision precision : precisions())
            check_converged(solve(*system, m, solve_options(Solver::automatic, 1e-9, precision)), dense, m, 1e-9, system->diagonal);
        for (const Solver solver : {Solver::pia, Solver::wpia, Solver::gauss_seidel, Solver::gauss_seidel_coloured, Solver::chebyshev})
            check_converged(solve(*system, m, solve_options(solver, 1e-6, Precision::mixed, 3000)), dense, m, 1e-6, system->diagonal);
        if (!system->plan().has_darts()) check_converged(solve(*system, m, solve_options(Solver::conjugate_gradients, 1e-9)), dense, m, 1e-9, system->diagonal);
    }
}

TEST_CASE("a cube with one crease edge, singular at alpha 0, is not called solved, and alpha 0.5 cures it", "[solver][crease][singular]") {
    const Prepared mesh(shapes::cube_with_dart());
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), catmull_clark()), cured = mesh.system(device_context(), catmull_clark(0.5));
    CHECK(std::abs(oracle::lowest_eigenvalue(matrix_of(system->plan()))) < 1e-12);
    const Solved solved = solve(*system, m, solve_options(Solver::automatic));
    CHECK(solved.report.status != SolveStatus::converged);
    CHECK(solved.report.message.find("larger alpha") != std::string::npos);
    CHECK(solved.report.max_error == Approx(oracle::largest_row(m - matrix_of(system->plan()) * solved.points)));
    check_converged(solve(*cured, m, solve_options(Solver::automatic)), Dense(cured->plan(), m), m, 1e-6, cured->diagonal);
}

TEST_CASE("a tolerance below rounding ends at the precision's floor, with darts and corners too", "[solver][crease][precision]") {
    for (const auto& shape : {shapes::grid_with_creases(), shapes::grid_triangles_with_creases(), shapes::grid_quads(5, 4), shapes::torus_with_dart()}) {
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        const auto system = mesh.system(device_context(), catmull_clark(0.5));
        for (const Precision precision : {Precision::single, Precision::mixed, has_double() ? Precision::full : Precision::mixed}) {
            INFO(shape.name << ", precision " << static_cast<int>(precision));
            const Solved solved = solve(*system, m, solve_options(Solver::automatic, 1e-30, precision));
            CHECK(solved.report.status == SolveStatus::not_converged);
            CHECK(solved.report.max_error <= (precision == Precision::single ? 1e-6 : 1e-13) * system->diagonal);
            CHECK(oracle::largest_row(m - matrix_of(system->plan()) * solved.points) <=
                  solved.report.max_error + 1e-14);  // fixed rows come back better than they were
        }
    }
}

TEST_CASE("conjugate gradients are refused where the operator is not self-adjoint", "[solver][crease][refused]") {
    const Prepared mesh(shapes::torus_with_dart());
    const auto system = mesh.system(device_context(), catmull_clark());
    CHECK_THROWS_AS(solve(*system, positions(mesh), solve_options(Solver::conjugate_gradients)), InvalidArgument);
    CHECK_THROWS_WITH(solve(*system, positions(mesh), solve_options(Solver::conjugate_gradients)), Catch::Contains("vertex 7") || Catch::Contains("vertex 20"));
}

TEST_CASE("iterates of PIA, W-PIA, Jacobi and Gauss-Seidel are those of the plain loops", "[solver][history]") {
    const std::vector<std::pair<shapes::Shape, SchemeOptions>> cases{{shapes::rough(shapes::random_triangle_mesh(200, 5), 0.1, 1), loop()},
                                                                     {shapes::rough(shapes::polygons_mixed(120, 5), 0.1, 1), catmull_clark(0.5)},
                                                                     {shapes::rough(shapes::grid_with_creases(), 0.1, 1), catmull_clark(0.3, 0.25)},
                                                                     {shapes::rough(shapes::torus_quads(9, 7), 0.1, 1), doo_sabin()}};
    for (const auto& [shape, scheme] : cases) {
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        const auto system = mesh.system(device_context(), scheme);
        const oracle::SparseMatrix a = matrix_of(system->plan());
        for (const Precision precision : precisions()) {
            INFO(shape.name << ", precision " << static_cast<int>(precision));
            const double tolerance = precision == Precision::full ? 1e-12 : 1e-6;
            const auto points_agree = [&](const Solved& solved, const oracle::History& plain) {
                return oracle::largest_row(solved.points - plain.points) <= tolerance * system->diagonal;
            };
            for (const int sweeps : {1, 2, 3, 4, 5, 12}) {
                INFO(sweeps << " sweeps");
                SolveOptions weighted = exact(Solver::wpia, sweeps, precision);
                weighted.weight = 1.4;
                const oracle::History pia = oracle::pia(a, m, sweeps), wpia = oracle::pia(a, m, sweeps, 1.4), jacobi = oracle::jacobi(a, m, sweeps),
                                      gs = oracle::gauss_seidel(a, m, sweeps);
                const Solved device_pia = solve(*system, m, exact(Solver::pia, sweeps, precision)), device_wpia = solve(*system, m, weighted);
                const Solved device_jacobi = solve(*system, m, exact(Solver::jacobi, sweeps, precision)),
                             device_gs = solve(*system, m, exact(Solver::gauss_seidel, sweeps, precision));
                check_histories(device_pia.report, pia, tolerance);
                check_histories(device_wpia.report, wpia, tolerance);
                check_histories(device_jacobi.report, jacobi, tolerance);
                check_histories(device_gs.report, gs, tolerance);
                CHECK(points_agree(device_pia, pia));
                CHECK(points_agree(device_wpia, wpia));
                CHECK(points_agree(device_jacobi, jacobi));
                CHECK(points_agree(device_gs, gs));
            }
        }
    }
}

TEST_CASE("Chebyshev and conjugate gradients follow the plain recurrences on closed meshes", "[solver][history]") {
    if (!has_double()) return;
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(200, 5), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), loop());
    const oracle::SparseMatrix a = matrix_of(system->plan());
    Eigen::VectorXd d(mesh.vertex_count());
    for (Index row = 0; row < system->plan().row_count; ++row) d[system->plan().vertex_of_row[row]] = system->plan().scaling[row];
    const auto cg = oracle::conjugate_gradients(a, d, m, 12);
    const Solved device_cg = solve(*system, m, exact(Solver::conjugate_gradients, 12));
    check_histories(device_cg.report, cg, 1e-10);  // sums over the vertices are added in another order, and CG remembers
    CHECK(largest(device_cg.points - cg.points) < 1e-10);
    const Spectrum& spectrum = spectrum_of(*system);
    const auto chebyshev = oracle::chebyshev(a, m, 12, std::max(spectrum.bound, 0.95 * spectrum.smooth));
    const Solved device_chebyshev = solve(*system, m, exact(Solver::chebyshev, 12));
    check_histories(device_chebyshev.report, chebyshev, 1e-12);
    CHECK(largest(device_chebyshev.points - chebyshev.points) < 1e-12);
}

TEST_CASE("coloured Gauss-Seidel has other iterates than natural, and the same end", "[solver][gauss-seidel]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(150, 9), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), loop());
    const Solved natural = solve(*system, m, exact(Solver::gauss_seidel, 2, Precision::mixed)),
                 coloured = solve(*system, m, exact(Solver::gauss_seidel_coloured, 2, Precision::mixed));
    CHECK(largest(natural.points - coloured.points) > 1e-4);
    const Solved a = solve(*system, m, solve_options(Solver::gauss_seidel, 1e-10)), b = solve(*system, m, solve_options(Solver::gauss_seidel_coloured, 1e-10));
    CHECK(a.report.status == SolveStatus::converged);
    CHECK(b.report.status == SolveStatus::converged);
    CHECK(largest(a.points - b.points) < 1e-8);
    CHECK(std::abs(a.report.iterations - b.report.iterations) <= 5);
}

TEST_CASE("exact sweeps are made whatever the residual does", "[solver][exact-sweeps]") {
    const Prepared mesh(shapes::octahedron());
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), loop());
    for (const Precision precision : precisions())
        for (const Solver solver : {Solver::pia, Solver::wpia, Solver::gauss_seidel, Solver::jacobi}) {
            INFO("precision " << static_cast<int>(precision) << ", solver " << static_cast<int>(solver));
            const Solved solved = solve(*system, m, exact(solver, 150, precision));  // far beyond rounding
            CHECK(solved.report.iterations == 150);
            CHECK(solved.report.residuals.size() == 151);
        }
    const Prepared torus(shapes::rough(shapes::torus_quads(16, 12), 0.2, 1));
    const auto diverging = torus.system(device_context(), catmull_clark());
    const Eigen::MatrixXd rough = positions(torus);
    const oracle::History plain = oracle::jacobi(matrix_of(diverging->plan()), rough, 60);
    for (const Precision precision : precisions()) {
        const Solved solved = solve(*diverging, rough, exact(Solver::jacobi, 60, precision));
        CHECK(solved.report.iterations == 60);
        REQUIRE(solved.report.residuals.size() == 61);
        CHECK(solved.report.residuals[60] == Approx(plain.residuals[60]).epsilon(1e-3));
    }
}

TEST_CASE("Jacobi says that it diverges on a regular Catmull-Clark mesh, and converges with lambda 0.4", "[solver][jacobi]") {
    const Prepared mesh(shapes::rough(shapes::torus_quads(20, 16), 0.2, 1));
    const Eigen::MatrixXd m = positions(mesh);
    for (const Precision precision : {Precision::mixed, Precision::single}) {
        const auto system = mesh.system(device_context(), catmull_clark());
        const Solved diverged = solve(*system, m, solve_options(Solver::jacobi, 1e-6, precision));
        CHECK(diverged.report.status == SolveStatus::not_converged);
        CHECK(diverged.report.message.find("the residual grows") == 0);
        CHECK(diverged.report.message.find("lambda of 1/3 or more") != std::string::npos);
        CHECK(diverged.report.iterations < 100);
        const auto dominant = mesh.system(device_context(), catmull_clark(0, 0.4));
        if (precision == Precision::mixed)
            check_converged(solve(*dominant, m, solve_options(Solver::jacobi)), Dense(dominant->plan(), m), m, 1e-6, dominant->diagonal);
    }
}

TEST_CASE("Jacobi stalls on a regular Loop mesh and says so", "[solver][jacobi]") {
    const Prepared mesh(shapes::rough(shapes::torus_triangles(12, 12), 0.2, 1));  // its radius is 1: the longest wave never dies
    const auto system = mesh.system(device_context(), loop());
    const Solved solved = solve(*system, positions(mesh), solve_options(Solver::jacobi, 1e-9));
    CHECK(solved.report.status == SolveStatus::not_converged);
    CHECK(!solved.report.message.empty());
}

TEST_CASE("too few iterations end with the residual that was reached, and a sentence", "[solver]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(150, 9), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), loop());
    const Dense dense(system->plan(), m);
    for (const Solver solver : all_solvers) {
        if (solver == Solver::jacobi) continue;
        INFO("solver " << static_cast<int>(solver));
        const Solved solved = solve(*system, m, solve_options(solver, 1e-9, Precision::mixed, 4));
        CHECK(solved.report.status == SolveStatus::not_converged);
        CHECK(solved.report.iterations == 4);
        CHECK_THAT(solved.report.message, Catch::StartsWith("the tolerance was not reached after 4 iterations: "));
        CHECK((solved.report.message.find("use solver auto") == std::string::npos) == (solver == Solver::automatic));
        CHECK(solved.report.max_error == Approx(residual_of(solved, dense, m)).epsilon(1e-9));
        CHECK(solved.report.residuals.back() == Approx(solved.report.max_error).epsilon(1e-6));
        CHECK(std::isnan(solved.report.surface_error_bound));
    }
}

TEST_CASE("a tolerance of 1e-12 is reached in mixed precision", "[solver][precision]") {
    for (const auto& shape : {shapes::rough(shapes::random_triangle_mesh(300, 2), 0.1, 1), shapes::rough(shapes::grid_triangles(9, 8), 0.1, 3)}) {
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        for (const auto& scheme : {loop(), catmull_clark(0.5), doo_sabin()})
            for (const Solver solver : {Solver::automatic, Solver::wpia, Solver::gauss_seidel, Solver::conjugate_gradients}) {
                INFO(shape.name << ", " << scheme_name(scheme.scheme) << ", solver " << static_cast<int>(solver));
                const auto system = mesh.system(device_context(), scheme);
                check_converged(solve(*system, m, solve_options(solver, 1e-12)), Dense(system->plan(), m), m, 1e-12, system->diagonal);
            }
    }
}

TEST_CASE("a tolerance of 1e-12 is reached with pairs of floats", "[solver][precision][pair]") {
    for (const auto& shape : {shapes::rough(shapes::random_triangle_mesh(300, 2), 0.1, 1), shapes::rough(shapes::grid_triangles_with_creases(), 0.05, 3)}) {
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        INFO(shape.name);
        const auto system = mesh.system(context_without_double(), loop());
        const Dense dense(system->plan(), m);
        for (const Solver solver : {Solver::automatic, Solver::gauss_seidel})
            check_converged(solve(*system, m, solve_options(solver, 1e-12)), dense, m, 1e-12, system->diagonal);
        CHECK_THROWS_AS(solve(*system, m, solve_options(Solver::automatic, 1e-6, Precision::full)), Unsupported);
    }
}

TEST_CASE("a CPU that is swept as a GPU gives the same solution", "[solver]") {
    DeviceInfo device = choose_device();
    device.is_gpu = true;
    device.max_work_group_size = 16;
    const auto context = Context::create(device);
    const Prepared mesh(shapes::rough(shapes::grid_triangles_with_creases(), 0.05, 3));
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(context, catmull_clark(0.5));
    const Dense dense(system->plan(), m);
    for (const Solver solver : {Solver::automatic, Solver::gauss_seidel})
        check_converged(solve(*system, m, solve_options(solver, 1e-10)), dense, m, 1e-10, system->diagonal);
}

TEST_CASE("single precision is honest about where it ends", "[solver][precision]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(300, 2), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), loop());
    const Dense dense(system->plan(), m);
    const Solved coarse = solve(*system, m, solve_options(Solver::automatic, 1e-5, Precision::single));
    check_converged(coarse, dense, m, 1e-5, system->diagonal);
    for (const Solver solver : {Solver::automatic, Solver::wpia, Solver::gauss_seidel, Solver::conjugate_gradients}) {
        INFO("solver " << static_cast<int>(solver));
        const Solved fine = solve(*system, m, solve_options(solver, 1e-10, Precision::single));
        CHECK(fine.report.status == SolveStatus::not_converged);
        CHECK(!fine.report.message.empty());
        CHECK(fine.report.max_error == Approx(residual_of(fine, dense, m)).epsilon(1e-6));  // in double, not what the device believes
        CHECK(fine.report.max_error > 1e-10 * system->diagonal);
        CHECK(fine.report.max_error < 1e-6 * system->diagonal);
        CHECK(fine.report.iterations < 200);
    }
}

TEST_CASE("1 to 9 channels are each solved as if they were alone", "[solver][channels]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(120, 7), 0.1, 1));
    Eigen::MatrixXd values(mesh.vertex_count(), 9);
    values.leftCols(3) = positions(mesh);
    values.rightCols(6) = rough_values(mesh.vertex_count(), 6, 4);
    values.col(3) *= 1e5;
    values.col(4).array() += 100;
    values.col(7).setConstant(5);
    const auto system = mesh.system(device_context(), loop());
    const Dense dense(system->plan(), values);
    for (int channels = 1; channels <= 9; ++channels)
        for (const Solver solver : {Solver::automatic, Solver::conjugate_gradients, Solver::gauss_seidel}) {
            INFO(channels << " channels, solver " << static_cast<int>(solver));
            const Eigen::MatrixXd m = values.leftCols(channels);
            const Solved solved = solve(*system, m, solve_options(solver, 1e-9));
            CHECK(solved.report.status == SolveStatus::converged);
            CHECK(solved.report.channel_error <= 1e-9);
            for (int c = 0; c < channels; ++c) {
                const double size = c < 3 ? system->diagonal : std::max(1.0, values.col(c).maxCoeff() - values.col(c).minCoeff());
                CHECK(largest(solved.points.col(c) - dense.solution.col(c)) <= dense.inverse_norm * 1.1e-9 * size);
            }
        }
}

TEST_CASE("a model of size 1 that is 1e6 away loses nothing", "[solver][scale]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(150, 7), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), loop());
    const Eigen::MatrixXd far = m.array() + 1e6;
    const SolveOptions options = solve_options(Solver::automatic, 1e-9);
    const Solved near = solve(*system, m, options), away = solve(*system, far, options);
    CHECK(away.report.status == SolveStatus::converged);
    CHECK(away.report.max_error <= 1e-6);
    CHECK(largest((away.points.array() - 1e6).matrix() - near.points) <=
          1e-9 + 2 * 1.2e-10 * Dense(system->plan(), m).inverse_norm);  // M's own rounding at 1e6
}

TEST_CASE("huge and tiny models are solved like others", "[solver][scale]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(150, 7), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), loop());
    const Solved plain = solve(*system, m, solve_options(Solver::automatic));
    for (const double scale : {1e30, 1e-30, 1e150, 1e-150}) {
        INFO(scale);
        const Prepared scaled(shapes::transformed(mesh.shape, scale, 0));
        const auto other = scaled.system(device_context(), loop());
        CHECK(other->diagonal == Approx(scale * system->diagonal));
        for (const Precision precision : {Precision::mixed, Precision::single}) {
            const Solved solved = solve(*other, positions(scaled), solve_options(Solver::automatic, precision == Precision::mixed ? 1e-6 : 1e-5, precision));
            CHECK(solved.report.status == SolveStatus::converged);
            CHECK(solved.report.max_error <= 1e-5 * other->diagonal);
            CHECK(solved.report.max_error > 0);
            CHECK(largest(solved.points / scale - plain.points) < 1e-4);
        }
    }
}

TEST_CASE("a mesh whose points coincide is its own control mesh", "[solver][scale]") {
    const Prepared mesh(shapes::transformed(shapes::octahedron(), 0, 7.25));
    const auto system = mesh.system(device_context(), loop());
    const Solved solved = solve(*system, positions(mesh), solve_options(Solver::automatic));
    CHECK(solved.report.status == SolveStatus::converged);
    CHECK(solved.points == positions(mesh));
    CHECK(solved.report.max_error == 0);
}

TEST_CASE("every solver gives the same bits for the same input", "[solver]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(500, 7), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), loop()), again = mesh.system(device_context(), loop());
    for (const Solver solver : all_solvers) {
        if (solver == Solver::jacobi) continue;
        INFO("solver " << static_cast<int>(solver));
        const Solved first = solve(*system, m, solve_options(solver)), second = solve(*system, m, solve_options(solver)),
                     third = solve(*again, m, solve_options(solver));
        CHECK(first.points == second.points);
        CHECK(first.points == third.points);
        CHECK(first.report.residuals == third.report.residuals);
    }
}

TEST_CASE("a warm start needs fewer iterations", "[solver][warm-start]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(300, 7), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh), moved = m + 1e-4 * rough_values(m.rows(), 3, 3);
    const auto system = mesh.system(device_context(), loop());
    const Dense dense(system->plan(), moved);
    for (const Solver solver : {Solver::automatic, Solver::pia, Solver::wpia, Solver::gauss_seidel, Solver::chebyshev, Solver::conjugate_gradients}) {
        INFO("solver " << static_cast<int>(solver));
        const Solved cold = solve(*system, m, solve_options(solver)), other = solve(*system, moved, solve_options(solver));
        const Solved warm = solve(*system, moved, solve_options(solver), &cold.points);
        check_converged(warm, dense, moved, 1e-6, system->diagonal);
        CHECK(warm.report.iterations < other.report.iterations);
        const Solved done = solve(*system, moved, solve_options(solver, 1e-5), &warm.points);
        CHECK(done.report.iterations == 0);
        CHECK(largest(done.points - warm.points) < 1e-12);
    }
}

TEST_CASE("fixed vertices hold the given values after a warm start from anywhere, and the residual is that of what comes back",
          "[solver][warm-start][boundary]") {
    const Prepared mesh(shapes::with_isolated_vertex(shapes::rough(shapes::grid_quads(6, 5), 0.05, 1), 4));
    const Eigen::MatrixXd m = positions(mesh), start = m + 0.3 * rough_values(m.rows(), 3, 3);
    const auto system = mesh.system(device_context(), catmull_clark());
    const Plan& plan = system->plan();
    const Dense dense(plan, m);
    for (const Solver solver : {Solver::automatic, Solver::pia, Solver::wpia, Solver::gauss_seidel, Solver::chebyshev, Solver::conjugate_gradients}) {
        INFO("solver " << static_cast<int>(solver));
        const Solved solved = solve(*system, m, solve_options(solver, 1e-6, Precision::mixed, 2000), &start);
        CHECK(solved.report.status == SolveStatus::converged);
        for (Index row = 0; row < plan.fixed.end_row(); ++row) CHECK(solved.points.row(plan.vertex_of_row[row]) == m.row(plan.vertex_of_row[row]));
        CHECK(residual_of(solved, dense, m) <= 1e-6 * system->diagonal);
        CHECK(residual_of(solved, dense, m) <= solved.report.max_error + 1e-13);
    }
}

TEST_CASE("subset rows are solved, the rest stays", "[solver][subset]") {
    for (const auto& scheme : {catmull_clark(), doo_sabin()}) {
        const Prepared mesh(shapes::rough(shapes::polygons_mixed(120, 6), 0.1, 2));
        std::vector<std::uint8_t> subset(mesh.vertex_count());
        for (Index v = 0; v < mesh.vertex_count(); ++v) subset[v] = v % 4 != 2;
        const Eigen::MatrixXd m = positions(mesh);
        const auto system = mesh.system(device_context(), scheme, subset);
        const Dense dense(system->plan(), m);
        for (const Solver solver : {Solver::automatic, Solver::pia, Solver::gauss_seidel, Solver::conjugate_gradients}) {
            INFO(scheme_name(scheme.scheme) << ", solver " << static_cast<int>(solver));
            const Solved solved = solve(*system, m, solve_options(solver, 1e-8, Precision::mixed, 4000));
            check_converged(solved, dense, m, 1e-8, system->diagonal);
            for (Index v = 2; v < mesh.vertex_count(); v += 4) CHECK(solved.points.row(v) == m.row(v));
        }
    }
}

TEST_CASE("isolated vertices come back to the bit and do not spoil the scale", "[solver][isolated]") {
    shapes::Shape shape = shapes::with_isolated_vertex(shapes::rough(shapes::torus_triangles(6, 5), 0.1, 1), 5);
    for (int c = 0; c < 3; ++c) shape.mesh.positions[15 + c] = 1e12 / 3;
    const Prepared mesh(shape);
    const auto system = mesh.system(device_context(), loop());
    const Eigen::MatrixXd m = positions(mesh);
    const Solved solved = solve(*system, m, solve_options(Solver::automatic, 1e-10));
    CHECK(solved.report.status == SolveStatus::converged);
    CHECK(system->diagonal < 10);
    CHECK(solved.points.row(5) == m.row(5));
    CHECK(oracle::largest_row(m - matrix_of(system->plan()) * solved.points) < 1e-9);
}

TEST_CASE("a progress callback sees every residual, and can cancel", "[solver][progress]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(200, 7), 0.1, 1));
    const Eigen::MatrixXd m = 100 * positions(mesh);
    const auto system = mesh.system(device_context(), loop());
    for (const Solver solver : {Solver::pia, Solver::gauss_seidel, Solver::chebyshev, Solver::conjugate_gradients})
        for (const Precision precision : {Precision::mixed, Precision::single}) {
            INFO("solver " << static_cast<int>(solver) << ", precision " << static_cast<int>(precision));
            std::vector<double> seen;
            SolveOptions options = solve_options(solver, 1e-4, precision);
            options.progress = [&](int iteration, double residual, double target) {
                seen.resize(iteration + 1, -1);
                seen[iteration] = residual;
                CHECK(target == Approx(1e-4 * system->diagonal));
                return true;
            };
            const Solved solved = solve(*system, m, options);
            REQUIRE(seen.size() == solved.report.residuals.size());
            for (std::size_t k = 0; k < seen.size(); ++k)
                CHECK(seen[k] == Approx(solved.report.residuals[k]).epsilon(1e-3).margin(1e-6 * solved.report.residuals[0]));
            options.progress = [](int iteration, double, double) { return iteration < 3; };
            CHECK_THROWS_AS(solve(*system, m, options), Cancelled);
            CHECK_THROWS_WITH(solve(*system, m, options), "the solve was cancelled after 3 iterations");
        }
}

TEST_CASE("two threads with two contexts solve at once", "[solver][thread]") {
    const Prepared mesh(shapes::rough(shapes::random_triangle_mesh(400, 7), 0.1, 1));
    const Eigen::MatrixXd m = positions(mesh);
    const auto alone = mesh.system(device_context(), loop());
    const Solved expected = solve(*alone, m, solve_options(Solver::automatic)), expected_gs = solve(*alone, m, solve_options(Solver::gauss_seidel));
    std::atomic<int> equal{0};
    const auto work = [&] {
        const auto context = Context::create(choose_device());
        for (int round = 0; round < 5; ++round) {
            const auto system = mesh.system(context, loop());
            equal += solve(*system, m, solve_options(Solver::automatic)).points == expected.points;
            equal += solve(*system, m, solve_options(Solver::gauss_seidel)).points == expected_gs.points;
        }
    };
    std::thread first(work), second(work);
    first.join();
    second.join();
    CHECK(equal == 20);
}

TEST_CASE("curves are solved directly, closed and open, double at the ends of a Doo-Sabin crease", "[solver][curves]") {
    for (const auto& shape : {shapes::grid_with_creases(), shapes::cylinder_open(5, 3), shapes::torus_with_dart(), shapes::cube_with_crease_loop(),
                              shapes::icosphere_with_crease_loop(), shapes::grid_with_hole(), shapes::disk_pole_triangles(9)})
        for (const auto& scheme : {catmull_clark(), catmull_clark(0.5, 0.25), loop(), doo_sabin()}) {
            if (!suits(shape, scheme)) continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme));
            const Prepared mesh(shape);
            const Plan plan = mesh.plan(scheme);
            if (plan.has_darts()) continue;  // curves then depend on darts, and all is iterated on
            const oracle::SparseMatrix a = matrix_of(plan);
            const Eigen::MatrixXd values = rough_values(plan.vertex_count, 2, 3);
            std::vector<double> m(values.size()), p(values.size());
            for (Index row = 0; row < plan.vertex_count; ++row)
                for (int c = 0; c < 2; ++c) m[2 * row + c] = p[2 * row + c] = values(plan.vertex_of_row[row], c);
            solve_curves(plan, m, p, 2);
            Eigen::MatrixXd points(plan.vertex_count, 2);
            for (Index row = 0; row < plan.vertex_count; ++row)
                for (int c = 0; c < 2; ++c) points(plan.vertex_of_row[row], c) = p[2 * row + c];
            const Eigen::MatrixXd residual = values - a * points;
            for (Index row = 0; row < plan.curves.end_row(); ++row) CHECK(largest(residual.row(plan.vertex_of_row[row])) < 1e-14);
            for (Index row = plan.curves.end_row(); row < plan.row_count; ++row)
                CHECK(points.row(plan.vertex_of_row[row]) == values.row(plan.vertex_of_row[row]));
        }
}

TEST_CASE("the surface error bound holds, and is not far from the truth", "[solver][certify]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shapes::rough(shape, 0.02, 3));
        const Eigen::MatrixXd m = positions(mesh);
        for (const auto& scheme : {catmull_clark(), catmull_clark(0.5), catmull_clark(0, 0.4), loop(), doo_sabin()}) {
            if (!suits(mesh.shape, scheme)) continue;
            const auto system = mesh.system(device_context(), scheme);
            if (system->plan().has_darts() || spectrum_of(*system).singular || spectrum_of(*system).indefinite) continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme) << ", alpha " << scheme.alpha << ", lambda " << scheme.lambda);
            const Dense dense(system->plan(), m);
            for (const Solver solver : {Solver::automatic, Solver::pia}) {
                SolveOptions options = solve_options(solver, 1e-4, Precision::mixed, 5000);
                options.certify = true;
                const Solved solved = solve(*system, m, options);
                REQUIRE(solved.report.status == SolveStatus::converged);
                const double bound = solved.report.surface_error_bound;
                CHECK(bound >= error_of(solved, dense) - 1e-13);
                CHECK(bound <= 20 * dense.inverse_norm * solved.report.max_error + 1e-13);  // curves add up to 3 times the residual, dominance is a loose bound
            }
        }
    }
}

TEST_CASE("the norm of the inverse is proven under dominance, and elsewhere estimated to 5 per cent, 8 at the worst", "[solver][certify]") {
    int estimates = 0, good_estimates = 0;
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : {catmull_clark(), catmull_clark(0.5), catmull_clark(0, 0.4), loop(), doo_sabin(), doo_sabin(DooSabinMask::classic)}) {
            if (!suits(shape, scheme)) continue;
            const auto system = mesh.system(device_context(), scheme);
            const Plan& plan = system->plan();
            if (plan.has_darts()) {
                CHECK_THROWS_AS(inverse_norm_of(*system), Unsupported);
                continue;
            }
            if (plan.smooth.row_count == 0 || spectrum_of(*system).singular || spectrum_of(*system).indefinite) continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme) << ", alpha " << scheme.alpha << ", lambda " << scheme.lambda);
            Eigen::MatrixXd block(plan.smooth.row_count, plan.smooth.row_count);
            const Eigen::MatrixXd a = matrix_of(plan);
            for (Index i = 0; i < plan.smooth.row_count; ++i)
                for (Index j = 0; j < plan.smooth.row_count; ++j)
                    block(i, j) = a(plan.vertex_of_row[plan.smooth.first_row + i], plan.vertex_of_row[plan.smooth.first_row + j]);
            const double truth = oracle::infinity_norm(block.inverse());
            const InverseNorm& norm = inverse_norm_of(*system);
            if (norm.proven) {
                CHECK(norm.value >= truth * (1 - 1e-12));
                continue;
            }
            CHECK(norm.value == Approx(truth).epsilon(0.08));
            ++estimates;
            good_estimates += std::abs(norm.value / truth - 1) <= 0.05;
        }
    }
    CHECK(estimates > 40);
    CHECK(good_estimates >= 0.95 * estimates);
}

TEST_CASE("operators with ghosts are not solved with", "[solver][ghosts][refused]") {
    const Prepared mesh(shapes::torus_quads(6, 4));
    PlanOptions options;
    options.owned.assign(24, 1);
    options.owned[3] = 0;
    const auto system = make_limit_system(device_context(), mesh.shape.mesh, mesh.topology, mesh.features, catmull_clark(), options);
    CHECK_THROWS_WITH(solve(*system, positions(mesh), solve_options(Solver::automatic)), Catch::Contains("rows for 23 of its 24 vertices"));
}

TEST_CASE("a detail far from where a large solve takes its first look is met like the rest", "[solver][field]") {
    shapes::Shape shape = shapes::torus_quads(390, 360);
    const Prepared smooth(shape);
    const Plan order = smooth.plan(catmull_clark(), PlanOptions{});
    std::vector<double>& points = shape.mesh.positions;
    for (int c = 0; c < 3; ++c) points[3 * static_cast<std::size_t>(order.vertex_of_row.front()) + c] *= 1.05;  // the middle rows are looked at
    const Prepared mesh(shape);
    const auto system = mesh.system(device_context(), catmull_clark());
    const Plan& plan = system->plan();
    const Transform transform = fit_transform(plan, points.data(), 3, 3);
    std::vector<double> m = to_plan_order(plan, transform, points.data(), 3, 3), p(m.size());
    for (const double tolerance : {1e-4, 1e-6}) {
        Field device_m = system->A->make_field(3, Real::single), device_p = system->A->make_field(3, Real::single);
        device_m.upload(m.data(), 0, plan.vertex_count);
        SolveOptions options = solve_options(Solver::automatic);
        options.tolerance = tolerance;
        const SolveReport report = solve_fields(*system, device_m, transform, options, false, device_p);
        CHECK(report.status == SolveStatus::converged);
        CHECK(report.iterations > 0);
        device_p.download(p.data(), 0, plan.vertex_count);
        CHECK(host_residual(plan, m, p, 3).position <= tolerance + 4 * std::ldexp(1, -25) * 3);
    }
}

TEST_CASE("fields that stay on the device are solved like host arrays", "[solver][field]") {
    for (const auto& shape : {shapes::rough(shapes::random_triangle_mesh(200, 7), 0.1, 1), shapes::rough(shapes::grid_triangles_with_creases(), 0.05, 1)}) {
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        const auto system = mesh.system(device_context(), loop());
        const Plan& plan = system->plan();
        const Dense dense(plan, m);
        const std::vector<double>& flat = shape.mesh.positions;
        const Transform transform = fit_transform(plan, flat.data(), 3, 3);
        const std::vector<double> rows = to_plan_order(plan, transform, flat.data(), 3, 3);
        for (const Real real : {Real::single, Real::wide})
            for (const Solver solver : {Solver::automatic, Solver::pia}) {
                INFO(shape.name << ", type " << static_cast<int>(real) << ", solver " << static_cast<int>(solver));
                Field device_m = system->A->make_field(3, real), device_p = system->A->make_field(3, real);
                device_m.upload(rows.data(), 0, plan.vertex_count);
                const SolveReport report = solve_fields(*system, device_m, transform, solve_options(solver), false, device_p);
                CHECK(report.status == SolveStatus::converged);
                std::vector<double> p(rows.size()), out(flat.size());
                device_p.download(p.data(), 0, plan.vertex_count);
                from_plan_order(plan, transform, p, 3, out.data(), 3);
                const Eigen::MatrixXd points = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(out.data(), plan.vertex_count, 3);
                // Single fields round M and P: half an ulp of numbers below 1/2, each times the diagonal, and a row's sum of P.
                const double rounding = real == Real::single ? 4 * std::ldexp(1, -25) * 3 * system->diagonal : 1e-13;
                CHECK(oracle::largest_row(m - dense.a * points) <= report.max_error + rounding);
                CHECK(oracle::largest_row(points - dense.solution) <= dense.inverse_norm * (1e-6 * system->diagonal + rounding));
            }
    }
}
