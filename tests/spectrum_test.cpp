// SPDX-License-Identifier: BSD-3-Clause
// What is found out of an operator before it is solved with: singular components, bounds and estimates of the smallest eigenvalue.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

Eigen::MatrixXd positions(const Prepared& mesh) { return oracle::positions(mesh.shape.mesh); }

Objection singular_component(const Prepared& mesh, const SchemeOptions& scheme, const std::vector<std::uint8_t>& subset = {}) {
    return find_singular_component(mesh.topology, mesh.features, scheme, subset);
}

bool is_singular(const shapes::Shape& shape, const SchemeOptions& scheme) { return !singular_component(Prepared(shape), scheme).message.empty(); }

/// The dense smallest eigenvalue of the smooth block.
double smallest_eigenvalue(const Plan& plan) {
    const Eigen::MatrixXd a = matrix_of(plan);
    const Index first = plan.smooth.first_row, count = plan.smooth.row_count;
    Eigen::MatrixXd block(count, count);
    for (Index i = 0; i < count; ++i)
        for (Index j = 0; j < count; ++j) block(i, j) = a(plan.vertex_of_row[first + i], plan.vertex_of_row[first + j]);
    return oracle::scaled_spectrum(block, Eigen::Map<const Eigen::VectorXd>(plan.scaling.data() + first, count))[0];
}

std::vector<shapes::Shape> bipartite_shapes() {
    return {shapes::cube(), shapes::hexagonal_prism(), shapes::truncated_octahedron(), shapes::hexagonal_torus(3, 4), shapes::hexagonal_torus(5, 3)};
}

}  // namespace

TEST_CASE("Catmull-Clark is singular on the cube, even prisms, the truncated octahedron and hexagonal tori", "[spectrum][singular]") {
    for (const auto& shape : bipartite_shapes()) {
        INFO(shape.name);
        const Prepared mesh(shape);
        const Eigen::MatrixXd m = positions(mesh);
        const auto system = mesh.system(device_context(), catmull_clark());
        CHECK(std::abs(smallest_eigenvalue(system->plan())) < 1e-12);
        const Spectrum& spectrum = spectrum_of(*system);
        CHECK(spectrum.singular);
        CHECK(!spectrum.indefinite);
        CHECK(spectrum.estimate == 0);
        for (const Solver solver : {Solver::automatic, Solver::pia, Solver::conjugate_gradients}) {
            const Solved solved = solve(*system, m, solve_options(solver));
            CHECK(solved.report.status == SolveStatus::singular);
            CHECK(solved.report.iterations == 0);
            CHECK(solved.report.message == spectrum.message);
            CHECK(!solved.report.vertices.empty());
            CHECK(solved.report.vertices.size() <= 10);
            CHECK(largest(solved.points - m) < 1e-15);
        }
        CHECK(!is_singular(shape, catmull_clark(0.5)));
        CHECK(!is_singular(shape, catmull_clark(0, 0.01)));
        for (const auto& scheme : {doo_sabin(), doo_sabin(DooSabinMask::classic)}) CHECK(!is_singular(shape, scheme));
    }
}

TEST_CASE("the cube's message names the vertices and the cure", "[spectrum][singular]") {
    const Objection objection = singular_component(Prepared(shapes::cube()), catmull_clark());
    CHECK_THAT(objection.message, Catch::Contains("the closed component of vertices 0, 1, 2, ... (8) has only valence 3 and no odd cycle of edges"));
    CHECK_THAT(objection.message, Catch::EndsWith(": use alpha 0.5 (alpha auto does so) or a lambda above 0"));
    CHECK(objection.vertices == std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7});
    const Objection second = singular_component(Prepared(shapes::combined(shapes::octahedron(), shapes::cube())), catmull_clark());
    CHECK(second.vertices == std::vector<Index>{6, 7, 8, 9, 10, 11, 12, 13});  // only this component is to blame
    CHECK(singular_component(Prepared(shapes::hexagonal_torus(4, 4)), catmull_clark()).vertices == std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
}

TEST_CASE("the cube works with alpha 0.5, and a singular system can be iterated on if one insists", "[spectrum][singular]") {
    const Prepared mesh(shapes::cube());
    const Eigen::MatrixXd m = positions(mesh);
    for (const auto& scheme : {catmull_clark(0.5), catmull_clark(0, 1.0 / 3)}) {
        const auto system = mesh.system(device_context(), scheme);
        const Solved solved = solve(*system, m, solve_options(Solver::automatic, 1e-10));
        CHECK(solved.report.status == SolveStatus::converged);
        CHECK(oracle::largest_row(solved.points - oracle::solve(matrix_of(system->plan()), m)) < 8 * 1e-10 * system->diagonal);  // lambda_min >= 1/8
    }
    const auto singular = mesh.system(device_context(), catmull_clark());
    SolveOptions options = solve_options(Solver::pia, 1e-6);
    options.keep_going = true;
    const Solved solved = solve(*singular, m, options);  // the cube's own corners have no part of the null vector
    CHECK(solved.report.iterations > 0);
    CHECK(solved.report.max_error <= 1e-6 * singular->diagonal);
    CHECK(solved.report.status == SolveStatus::singular);
}

TEST_CASE("all-valence-3 meshes with an odd cycle are only nearly singular", "[spectrum][singular]") {
    struct Known {
        shapes::Shape shape;
        double lambda_min;
    };
    for (const auto& [shape, lambda_min] : {Known{shapes::tetrahedron(), 2.0 / 9}, Known{shapes::dodecahedron(), (10 - 3.6 * std::sqrt(5.0)) / 24},
                                            Known{shapes::triangular_prism(), 1.0 / 12}}) {
        INFO(shape.name);
        CHECK(!is_singular(shape, catmull_clark()));
        const Prepared mesh(shape);
        const auto system = mesh.system(device_context(), catmull_clark());
        const Spectrum& spectrum = spectrum_of(*system);
        CHECK(!spectrum.singular);
        CHECK(spectrum.bound == 0);
        CHECK(spectrum.estimate == Approx(lambda_min).epsilon(1e-4));  // so small that Lanczos sees it all
        const Solved solved = solve(*system, positions(mesh), solve_options(Solver::automatic, 1e-8));
        CHECK(solved.report.status == SolveStatus::converged);
        CHECK(solved.report.lambda_min == spectrum.estimate);
    }
    const shapes::Shape dual = shapes::dual_of(shapes::random_triangle_mesh(150, 3));
    CHECK(!is_singular(dual, catmull_clark()));
    const auto system = Prepared(dual).system(device_context(), catmull_clark());
    CHECK(!spectrum_of(*system).singular);
    CHECK(!spectrum_of(*system).warning.empty());
    CHECK(!spectrum_of(*system).vertices.empty());
}

TEST_CASE("a subset, a lambda at one vertex, a corner, a crease or a boundary cures the cube", "[spectrum][singular][subset]") {
    const Prepared cube(shapes::cube());
    const Eigen::MatrixXd m = positions(cube) + 0.1 * rough_values(8, 3, 1);
    std::vector<std::uint8_t> subset(8, 1);
    subset[5] = 0;
    SchemeOptions one_ratio = catmull_clark();
    one_ratio.lambda_per_vertex.assign(8, 0.0);
    CHECK(!singular_component(cube, one_ratio).message.empty());
    one_ratio.lambda_per_vertex[3] = 0.5;
    CHECK(singular_component(cube, catmull_clark(), subset).message.empty());
    CHECK(singular_component(cube, one_ratio).message.empty());
    shapes::Shape cornered = shapes::cube();
    cornered.features.corners = {6};
    CHECK(!is_singular(cornered, catmull_clark()));
    CHECK(!is_singular(shapes::cube_with_crease_loop(), catmull_clark()));
    CHECK(!is_singular(shapes::grid_quads(1, 2), catmull_clark()));
    for (const auto& system : {cube.system(device_context(), catmull_clark(), subset).release(), cube.system(device_context(), one_ratio).release(),
                               Prepared(cornered).system(device_context(), catmull_clark()).release()}) {
        const std::unique_ptr<LimitSystem> owner(system);
        CHECK(smallest_eigenvalue(system->plan()) > 1e-3);
        const Solved solved = solve(*system, m, solve_options(Solver::automatic, 1e-9));
        CHECK(solved.report.status == SolveStatus::converged);
        CHECK(oracle::largest_row(m - matrix_of(system->plan()) * solved.points) <= 1e-9 * system->diagonal);
    }
}

TEST_CASE("a cube with split edges is indefinite at alpha 0 and not at alpha 0.5", "[spectrum][valence]") {
    const Prepared mesh(shapes::cube_split_edges());
    const Eigen::MatrixXd m = positions(mesh);
    const auto system = mesh.system(device_context(), catmull_clark()), cured = mesh.system(device_context(), catmull_clark(0.5));
    const Spectrum& spectrum = spectrum_of(*system);
    CHECK(spectrum.indefinite);
    CHECK(!spectrum.singular);
    CHECK(std::isnan(spectrum.bound));
    CHECK(spectrum.estimate == Approx(-1.0 / 14).epsilon(0.05));
    CHECK(spectrum.message.find("eigenvalue of about -0.07") != std::string::npos);
    REQUIRE(!spectrum.vertices.empty());
    for (const Index v : spectrum.vertices) CHECK(mesh.topology.vertex_face_count[v] == 2);
    const Solved refused = solve(*system, m, solve_options(Solver::automatic));
    CHECK(refused.report.status == SolveStatus::indefinite);
    CHECK(refused.report.message == spectrum.message);
    CHECK(largest(refused.points - m) < 1e-15);
    CHECK(!spectrum_of(*cured).indefinite);
    CHECK(smallest_eigenvalue(cured->plan()) > -1e-12);
}

TEST_CASE("Loop and Doo-Sabin are never singular", "[spectrum][singular]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : {loop(), doo_sabin(), doo_sabin(DooSabinMask::classic)}) {
            if (!suits(shape, scheme)) continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme));
            const auto system = mesh.system(device_context(), scheme);
            const Spectrum& spectrum = spectrum_of(*system);
            CHECK(!spectrum.singular);
            CHECK(!spectrum.indefinite);
            CHECK(spectrum.smooth >= (scheme.scheme == Scheme::loop ? 0.1 : 0.25));
        }
    }
}

TEST_CASE("the smallest eigenvalue is estimated from above, within 7 per cent, and not below its bound", "[spectrum]") {
    auto list = shapes::closed_shapes();
    for (const auto& shape :
         {shapes::grid_quads(9, 8), shapes::grid_triangles(7, 9), shapes::icosphere_with_crease_loop(), shapes::grid_with_hole(),
          shapes::box_with_crease_angle(), shapes::random_triangle_mesh(400, 5), shapes::polygons_mixed(300, 6), shapes::torus_quads(16, 12)})
        list.push_back(shape);
    for (const auto& shape : list) {
        const Prepared mesh(shape);
        for (const auto& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            const auto system = mesh.system(device_context(), scheme.options);
            if (!system->singular.message.empty() || system->plan().smooth.row_count == 0) continue;
            INFO(shape.name << ", " << scheme.name);
            const double truth = smallest_eigenvalue(system->plan());
            const Spectrum& spectrum = spectrum_of(*system);
            CHECK(spectrum.smooth >= system->plan().lambda_min_bound);
            CHECK(spectrum.smooth >= truth - 2e-5);  // rounding of float sweeps
            CHECK(spectrum.smooth <= 1.07 * truth + 2e-5);
            CHECK(spectrum.bound <= truth + 1e-12);
        }
    }
}

TEST_CASE("of a large torus only a part is looked at, and the estimate is that of the whole", "[spectrum]") {
    const Prepared mesh(shapes::torus_quads(390, 360));  // more smooth rows than are looked at
    const auto system = mesh.system(device_context(), catmull_clark());
    const double truth = 1.0 / 9;  // (4 - 2)/6 along either direction, at the highest frequency
    CHECK(spectrum_of(*system).smooth >= truth - 2e-5);
    CHECK(spectrum_of(*system).smooth <= 1.07 * truth);
}

TEST_CASE("nearly singular duals of triangle meshes are estimated within 20 per cent", "[spectrum][singular]") {
    for (const std::uint64_t seed : {3, 4}) {
        const auto system = Prepared(shapes::dual_of(shapes::random_triangle_mesh(500, seed))).system(device_context(), catmull_clark());
        const double truth = smallest_eigenvalue(system->plan());
        CHECK(truth < 0.03);
        CHECK(spectrum_of(*system).smooth >= truth - 2e-5);
        CHECK(spectrum_of(*system).smooth <= 1.2 * truth + 2e-5);
    }
}

TEST_CASE("with darts nothing is claimed of the spectrum", "[spectrum][crease]") {
    const auto system = Prepared(shapes::torus_with_dart()).system(device_context(), catmull_clark());
    const Spectrum& spectrum = spectrum_of(*system);
    CHECK(std::isnan(spectrum.bound));
    CHECK(std::isnan(spectrum.estimate));
    CHECK(spectrum.smooth > 0);
    CHECK(!spectrum.singular);
}

TEST_CASE("curves bring their own bound, 1/3 or 1/2 for Doo-Sabin", "[spectrum][boundary]") {
    const Prepared mesh(shapes::cylinder_open(7, 1));  // every vertex is on a boundary curve
    const auto cubic = mesh.system(device_context(), catmull_clark()), quadratic = mesh.system(device_context(), doo_sabin()),
               blended = mesh.system(device_context(), catmull_clark(0, 0.4));
    CHECK(spectrum_of(*cubic).estimate == Approx(1.0 / 3));
    CHECK(spectrum_of(*quadratic).estimate == Approx(0.5));
    CHECK(spectrum_of(*blended).estimate == Approx(0.4 + 0.6 / 3));
    CHECK(oracle::lowest_eigenvalue(matrix_of(cubic->plan())) >= 1.0 / 3 - 1e-12);
    CHECK(oracle::lowest_eigenvalue(matrix_of(quadratic->plan())) >= 0.5 - 1e-12);
}
