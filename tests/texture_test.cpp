// SPDX-License-Identifier: BSD-3-Clause
// Textures against dense algebra: brute-force subdivision matrices, limit rows, LU solves and the oracle's noise.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "host/filter/texture.h"
#include "tests/oracle/noise.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

TextureOptions texture_options(int octaves, int levels, double tolerance = 1e-12, Precision precision = Precision::full) {
    TextureOptions options;
    options.octaves = octaves;
    options.levels = levels;
    options.frequency = 3.7;
    options.seed = 5;
    options.solve.tolerance = tolerance;
    options.solve.precision = precision;
    options.solve.max_iterations = 2000;
    return options;
}

/// In double where the device has it.
Precision finest() { return device_context()->device().has_double ? Precision::full : Precision::mixed; }

/// Of the values of vertices that a face uses.
std::pair<double, double> range_of(const Eigen::VectorXd& values, const std::vector<bool>& is_used) {
    double low = INFINITY, high = -INFINITY;
    for (Eigen::Index v = 0; v < values.size(); ++v)
        if (is_used[v]) low = std::min(low, values[v]), high = std::max(high, values[v]);
    return {low, high};
}

std::vector<bool> used_vertices(const oracle::Surface& surface) {
    std::vector<bool> is_used(surface.vertex_count, false);
    for (const auto& face : surface.faces)
        for (const int v : face) is_used[v] = true;
    return is_used;
}

/// The faces of a refined surface in the library's order, which the numbers of the next refinement's vertices follow.
oracle::Surface in_order_of(const PolygonMesh& refined, oracle::Surface surface, const Eigen::MatrixXd& points) {
    const bool same_faces = oracle::sorted_faces(refined) == oracle::sorted_faces(oracle::to_mesh(surface, points));
    REQUIRE(same_faces);
    surface.faces = shapes::faces_of(refined);
    return surface;
}

struct Reference {
    Eigen::MatrixXd points;  // limit points of G_K
    Eigen::VectorXd noise;   // t
    double noise_error = 0;  // how far t may be off
};

/// The dense way. `noise_rounding`: of values of noise.
Reference reference(const shapes::Shape& shape, const SchemeOptions& scheme, const TextureOptions& options, const std::vector<int>& subset = {},
                    double noise_rounding = 1e-13) {
    SchemeOptions rules = scheme;
    oracle::Surface surface = oracle::make_surface(shape.mesh, shape.features);
    Eigen::MatrixXd x = oracle::positions(shape.mesh), A;
    Eigen::RowVector3d low = Eigen::RowVector3d::Constant(INFINITY), high = -low;
    const std::vector<bool> is_used = used_vertices(surface);
    for (Eigen::Index v = 0; v < x.rows(); ++v)
        if (is_used[v]) low = low.cwiseMin(x.row(v)), high = high.cwiseMax(x.row(v));
    const Eigen::RowVector3d centre = (low + high) / 2;
    const double diagonal = (high - low).norm();
    const auto offset = noise_offset(options.seed);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.rows());
    double error = 0;
    for (int level = 0; level <= options.levels; ++level) {
        if (level > 0) {
            const oracle::Step step = oracle::subdivide(surface, rules);
            x = step.weights * x;
            sum = step.weights * sum;
            surface = in_order_of(refine(shape.mesh, shape.features, scheme, level).mesh, step.surface, x);
            rules = oracle::after_first_step(rules);
        }
        A.resize(surface.vertex_count, surface.vertex_count);
        for (int v = 0; v < surface.vertex_count; ++v) A.row(v) = oracle::limit_row(surface, rules, v);
        if (level >= options.octaves) continue;
        const double cells = std::ldexp(1, level);
        Eigen::VectorXd values(x.rows());
        for (Eigen::Index v = 0; v < x.rows(); ++v) {
            const Eigen::RowVector3d p = options.frequency / diagonal * (x.row(v) - centre) + Eigen::RowVector3d(offset[0], offset[1], offset[2]);
            values[v] = oracle::improved_noise(cells * p[0], cells * p[1], cells * p[2]) / cells;
        }
        const Eigen::MatrixXd solved = subset.empty() || level > 0 ? A : oracle::with_identity_rows(A, subset);
        sum += oracle::solve(solved, values);
        // |P - A^-1 N| <= |A^-1| (|R| + what N is off)
        const auto [least, greatest] = range_of(values, used_vertices(surface));
        error += oracle::infinity_norm(solved.inverse()) * (options.solve.tolerance * (greatest - least) + noise_rounding / cells);
    }
    const Eigen::VectorXd limit = A * sum;
    const auto [least, greatest] = range_of(limit, used_vertices(surface));
    const Eigen::VectorXd t = ((limit.array() - least) / (greatest - least)).cwiseMax(0.0).cwiseMin(1.0);
    // t = (N - min) / (max - min), each of the three off by `error`; N and its refinements are rounded in double.
    return {A * x, t, 3 * (error + 1e-14) / (greatest - least)};
}

Texture texture_of(const shapes::Shape& shape, const SchemeOptions& scheme, const TextureOptions& options, const std::vector<int>& subset = {},
                   const std::shared_ptr<Context>& context = device_context(), FurtherChannels further = {}) {
    std::vector<std::uint8_t> marks;
    if (!subset.empty()) marks.assign(shape.mesh.vertex_count, 0);
    for (const int v : subset) marks[v] = 1;
    const std::unique_ptr<LimitSystem> system = Prepared(shape).system(context, scheme, marks);
    return make_texture(*system, shape.mesh, shape.features, std::move(further), options);
}

NoiseFrame frame_of(const shapes::Shape& shape, const SchemeOptions& scheme, const TextureOptions& options) {
    const Transform box = fit_transform(Prepared(shape).plan(scheme), shape.mesh.positions.data(), 3, 3);
    return {{box.centre[0], box.centre[1], box.centre[2]}, noise_offset(options.seed), options.frequency * box.scale[0]};
}

void check_against(const Reference& expected, const Texture& texture) {
    REQUIRE(texture.is_given);
    CHECK(texture.report.status == SolveStatus::converged);
    REQUIRE(texture.refined.mesh.vertex_count == expected.points.rows());
    const Eigen::MatrixXd points = oracle::positions(texture.refined.mesh);
    CHECK(largest(points - expected.points) <= 1e-13);  // some tens of rounded weights, coordinates of a few units
    const Eigen::VectorXd t = Eigen::Map<const Eigen::VectorXd>(texture.noise.data(), static_cast<Eigen::Index>(texture.noise.size()));
    INFO("t may be off by " << expected.noise_error);
    CHECK(largest(t - expected.noise) <= expected.noise_error);
    CHECK(expected.noise_error < 1e-3);  // else nothing was compared
    CHECK(t.minCoeff() == 0);
    CHECK(t.maxCoeff() == 1);
}

struct Case {
    shapes::Shape shape;
    SchemeOptions scheme;
};

/// Small shapes with every scheme that can interpolate on them.
std::vector<Case> small_cases() {
    const std::vector<shapes::Shape> all{shapes::octahedron(),
                                         shapes::cube(),
                                         shapes::triangular_prism(),
                                         shapes::grid_quads(3, 2),
                                         shapes::disk_pole_triangles(5),
                                         shapes::cube_with_crease_loop(),
                                         shapes::cube_with_dart(),
                                         shapes::single_quad(),
                                         shapes::with_isolated_vertex(shapes::grid_with_marked_corner(), 3)};
    std::vector<Case> cases;
    for (const shapes::Shape& shape : all)
        for (const NamedScheme& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            const Prepared prepared(shapes::rough(shape, 0.05, 2));
            const Eigen::MatrixXd rows = oracle::limit_rows(prepared.shape.mesh, prepared.shape.features, scheme.options);
            if (oracle::lowest_eigenvalue(rows) > 0.01) cases.push_back({prepared.shape, scheme.options});
        }
    return cases;
}

}  // namespace

TEST_CASE("textures equal dense algebra, all schemes, with boundaries, creases, alpha and lambda", "[texture]") {
    const TextureOptions options = texture_options(2, 2, 1e-12, finest());
    for (const Case& c : small_cases()) {
        INFO(c.shape.name << ", " << scheme_name(c.scheme.scheme) << ", alpha " << c.scheme.alpha << ", lambda " << c.scheme.lambda);
        check_against(reference(c.shape, c.scheme, options), texture_of(c.shape, c.scheme, options));
    }
}

TEST_CASE("textures equal dense algebra for any number of octaves and levels", "[texture]") {
    const auto [octaves, levels] = GENERATE(std::pair(1, 0), std::pair(1, 2), std::pair(3, 2));
    const TextureOptions options = texture_options(octaves, levels, 1e-12, finest());
    INFO(octaves << " octaves, " << levels << " levels");
    for (const auto& [shape, scheme] :
         {Case{shapes::octahedron(), loop()}, Case{shapes::cube(), catmull_clark(0.5)}, Case{shapes::cube(), catmull_clark(0.25, 0.4)},
          Case{shapes::grid_quads(2, 3), catmull_clark()}, Case{shapes::tetrahedron(), doo_sabin()}})
        check_against(reference(shape, scheme, options), texture_of(shape, scheme, options));
}

TEST_CASE("textures have the precision that was asked for", "[texture]") {
    const shapes::Shape shape = shapes::rough(shapes::icosahedron(), 0.1, 1);
    TextureOptions options = texture_options(2, 1, 1e-6, Precision::mixed);
    const double float_noise = 256 * std::ldexp(1, -24);  // as in the tests of the kernel
    check_against(reference(shape, loop(), options), texture_of(shape, loop(), options));
    options.solve.tolerance = 1e-12;
    check_against(reference(shape, loop(), options, {}, float_noise), texture_of(shape, loop(), options, {}, context_without_double()));
    options.solve.precision = Precision::single;
    options.solve.tolerance = 1e-5;
    check_against(reference(shape, loop(), options, {}, float_noise), texture_of(shape, loop(), options));
    options.solve.precision = Precision::full;
    CHECK_THROWS_AS(texture_of(shape, loop(), options, {}, context_without_double()), Unsupported);
}

TEST_CASE("vertices outside the subset keep their noise as control values", "[texture]") {
    const shapes::Shape shape = shapes::rough(shapes::grid_quads(3, 3), 0.1, 4);
    const std::vector<int> subset{5, 6, 9};
    for (const int levels : {0, 1}) {
        const TextureOptions options = texture_options(levels + 1, levels, 1e-12, finest());
        check_against(reference(shape, catmull_clark(0.5), options, subset), texture_of(shape, catmull_clark(0.5), options, subset));
    }
}

TEST_CASE("one octave passes through the noise at the mesh's own vertices", "[texture]") {
    // Old vertices keep their numbers with these schemes, and A_K C_K = A_0 P_0 = N there; t is an affine map of it.
    const SchemeOptions scheme = GENERATE(catmull_clark(), catmull_clark(0.7), catmull_clark(0.2, 0.3), loop());
    const shapes::Shape shape = scheme.scheme == Scheme::loop ? shapes::icosphere(2) : shapes::rough(shapes::torus_quads(12, 9), 0.05, 1);
    const TextureOptions options = texture_options(1, 2, 1e-10, Precision::mixed);
    const Texture texture = texture_of(shape, scheme, options);
    const std::vector<double> noise = noise_octave(device_context(), frame_of(shape, scheme, options), shape.mesh.positions, 0, Real::wide);
    const auto low = std::min_element(noise.begin(), noise.end()) - noise.begin(), high = std::max_element(noise.begin(), noise.end()) - noise.begin();
    const double slope = (texture.noise[high] - texture.noise[low]) / (noise[high] - noise[low]);
    REQUIRE(slope > 0.1);
    for (std::size_t v = 0; v < noise.size(); ++v)
        CHECK_THAT(texture.noise[v], Catch::Matchers::WithinAbs(texture.noise[low] + slope * (noise[v] - noise[low]), 10 * 1e-10 * slope));
}

TEST_CASE("textures are the same bits for the same seed and differ for others", "[texture]") {
    const shapes::Shape shape = shapes::random_triangle_mesh(200, 3);
    TextureOptions options = texture_options(3, 2, 1e-6, Precision::mixed);
    const Texture once = texture_of(shape, loop(), options), again = texture_of(shape, loop(), options);
    CHECK(once.noise == again.noise);
    CHECK(once.refined.mesh.positions == again.refined.mesh.positions);
    for (const std::uint32_t seed : {0u, 6u, 4294967295u}) {
        options.seed = seed;
        CHECK(texture_of(shape, loop(), options).noise != once.noise);
    }
}

TEST_CASE("a texture does not depend on where and how large the model is", "[texture]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(6, 5), 0.05, 1);
    const TextureOptions options = texture_options(3, 2, 1e-9, Precision::mixed);
    const std::vector<double> expected = texture_of(shape, catmull_clark(), options).noise;
    // Places are rounded to 2^-53 of the offset, half a million model sizes; octaves have up to 15 cells, in which noise changes by up to 20 a cell.
    for (const auto& moved : {shapes::transformed(shape, 1e-200, 0), shapes::transformed(shape, 1e6, 1e12), shapes::transformed(shape, 1e150, -3e150)}) {
        const Texture texture = texture_of(moved, catmull_clark(), options);
        double largest = 0;
        for (std::size_t v = 0; v < expected.size(); ++v) largest = std::max(largest, std::fabs(texture.noise[v] - expected[v]));
        CHECK(largest <= 10 * (options.solve.tolerance + 5e5 * std::ldexp(1, -53) * 15 * 20));
    }
}

TEST_CASE("a model without extent has noise 1/2 everywhere", "[texture]") {
    shapes::Shape shape = shapes::octahedron();
    for (double& coordinate : shape.mesh.positions) coordinate = 0.3;
    const Texture texture = texture_of(shape, loop(), texture_options(3, 2, 1e-6, Precision::mixed));
    REQUIRE(texture.is_given);
    CHECK(texture.report.status == SolveStatus::converged);
    CHECK(texture.noise == std::vector<double>(texture.noise.size(), 0.5));
}

TEST_CASE("vertices without faces have a value but do not stretch the others", "[texture]") {
    shapes::Shape plain = shapes::rough(shapes::octahedron(), 0.1, 1), lonely = shapes::with_isolated_vertex(plain, 6);
    for (int c = 0; c < 3; ++c) lonely.mesh.positions[18 + c] = 1e308;
    const TextureOptions options = texture_options(2, 1, 1e-9, Precision::mixed);
    const std::vector<double> expected = texture_of(plain, loop(), options).noise, found = texture_of(lonely, loop(), options).noise;
    REQUIRE(found.size() == expected.size() + 1);
    CHECK((found[6] >= 0 && found[6] <= 1));
    for (std::size_t v = 0; v < expected.size(); ++v)
        CHECK_THAT(found[v < 6 ? v : v + 1], Catch::Matchers::WithinAbs(expected[v], 100 * options.solve.tolerance));  // the blocks of the solve differ
}

TEST_CASE("further channels are refined and taken to the limit like the points", "[texture]") {
    const shapes::Shape shape = shapes::rough(shapes::with_isolated_vertex(shapes::grid_with_creases(), 2), 0.1, 3);
    const SchemeOptions scheme = GENERATE(catmull_clark(0.5), doo_sabin());
    for (const int levels : {0, 2}) {
        FurtherChannels further{2, {}};
        for (Index v = 0; v < shape.mesh.vertex_count; ++v)
            further.values.insert(further.values.end(), {shape.mesh.positions[3 * v + 2], shape.mesh.positions[3 * v]});
        const Texture texture = texture_of(shape, scheme, texture_options(1, levels, 1e-6, Precision::mixed), {}, device_context(), further);
        const std::vector<double>& points = texture.refined.mesh.positions;
        REQUIRE(3 * texture.further.values.size() == 2 * points.size());
        for (std::size_t v = 0; 3 * v < points.size(); ++v) {
            CHECK_THAT(texture.further.values[2 * v], Catch::Matchers::WithinAbs(points[3 * v + 2], 1e-13));
            CHECK_THAT(texture.further.values[2 * v + 1], Catch::Matchers::WithinAbs(points[3 * v], 1e-13));
        }
    }
}

TEST_CASE("a solve that fails ends a texture with its report, unless it is to keep going", "[texture]") {
    TextureOptions options = texture_options(2, 1, 1e-6, Precision::mixed);
    SECTION("singular") {
        Texture texture = texture_of(shapes::cube(), catmull_clark(), options);
        CHECK(!texture.is_given);
        CHECK(texture.report.status == SolveStatus::singular);
        CHECK_THAT(texture.report.message, Catch::Matchers::StartsWith("octave 0: ") && Catch::Matchers::Contains("alpha"));
        options.solve.keep_going = true;
        texture = texture_of(shapes::cube(), catmull_clark(), options);
        CHECK(texture.is_given);
        CHECK(texture.report.status == SolveStatus::singular);
        CHECK(std::all_of(texture.noise.begin(), texture.noise.end(), [](double t) { return t >= 0 && t <= 1; }));
    }
    SECTION("indefinite") {
        const Texture texture = texture_of(shapes::cube_split_edges(), catmull_clark(), options);
        CHECK(!texture.is_given);
        CHECK(texture.report.status == SolveStatus::indefinite);
    }
    SECTION("not converged, in a later octave") {
        // All vertices of a single quad are corners; refined, there is something to iterate on.
        options.solve.max_iterations = 1;
        const shapes::Shape shape = shapes::rough(shapes::single_quad(), 0.1, 1);
        Texture texture = texture_of(shape, catmull_clark(), options);
        CHECK(!texture.is_given);
        CHECK(texture.report.status == SolveStatus::not_converged);
        CHECK_THAT(texture.report.message, Catch::Matchers::StartsWith("octave 1, on the mesh refined 1 time: "));
        options.solve.keep_going = true;
        texture = texture_of(shape, catmull_clark(), options);
        CHECK(texture.is_given);
        CHECK_THAT(texture.report.message, Catch::Matchers::StartsWith("octave 1"));
    }
}

TEST_CASE("the report is that of the solve with the largest error for its tolerance", "[texture]") {
    const TextureOptions options = texture_options(3, 2, 1e-6, Precision::mixed);
    const shapes::Shape shape = shapes::rough(shapes::icosphere(1), 0.1, 1);
    const NoiseFrame frame = frame_of(shape, loop(), options);
    std::vector<double> errors, shares;  // of every octave, on its own
    for (int octave = 0; octave < 3; ++octave) {
        const Refinement refined = refine(shape.mesh, shape.features, loop(), octave);
        std::vector<double> values = noise_octave(device_context(), frame, refined.mesh.positions, octave, Real::wide);
        SolveOptions solve = options.solve;
        solve.diagonal = *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end());
        const auto system = Prepared({"refined", refined.mesh, refined.features}).system(device_context(), loop());
        errors.push_back(solve_host(*system, values.data(), 1, 1, solve, false, values.data(), 1).max_error);
        shares.push_back(errors.back() / (solve.tolerance * solve.diagonal));
        CHECK(shares.back() <= 1);
    }
    const auto worst = std::max_element(shares.begin(), shares.end()) - shares.begin();
    const SolveReport report = texture_of(shape, loop(), options).report;
    // Points of the two refinements differ by rounding, which is 1e-9 of what the tolerance leaves.
    CHECK_THAT(report.max_error, Catch::Matchers::WithinRel(errors[worst], 1e-6));
    CHECK(report.iterations > 1);
}

TEST_CASE("a texture can be cancelled in any octave", "[texture]") {
    TextureOptions options = texture_options(2, 1, 1e-6, Precision::mixed);
    double first_target = 0;
    options.solve.progress = [&](int, double, double target) {
        if (first_target == 0) first_target = target;
        return target == first_target;
    };
    CHECK_THROWS_AS(texture_of(shapes::icosahedron(), loop(), options), Cancelled);
}

TEST_CASE("levels that do not fit are refused with the number before they are made", "[texture]") {
    CHECK_THROWS_WITH(texture_of(shapes::octahedron(), loop(), texture_options(2, 40)),
                      Catch::Matchers::Contains("refinement level") && Catch::Matchers::EndsWith("use fewer levels"));
    const auto context_with = [](std::size_t memory, std::size_t allocation) {
        DeviceInfo device = choose_device();
        device.memory_bytes = memory, device.max_allocation_bytes = allocation;
        return Context::create(device);
    };
    // 4 * 4^6 + 2 = 16386 vertices and 24 * 4^6 corners: 104 and 8 bytes
    const TextureOptions options = texture_options(7, 6, 1e-6, Precision::mixed);
    const std::size_t needed = 16386 * 104 + 98304 * 8;
    CHECK_THROWS_WITH(texture_of(shapes::octahedron(), loop(), options, {}, context_with(1000000, 1000000)),
                      Catch::Matchers::Contains("16386 vertices") && Catch::Matchers::Contains(std::to_string(needed) + " bytes on") &&
                          Catch::Matchers::Contains("left: use fewer levels"));
    CHECK_THROWS_WITH(texture_of(shapes::octahedron(), loop(), options, {}, context_with(2 * needed, 500000)),
                      Catch::Matchers::Contains("786432 bytes in one piece") && Catch::Matchers::Contains("at most 500000"));
    CHECK(texture_of(shapes::octahedron(), loop(), options, {}, context_with(needed + 100000, 1000000)).is_given);  // and that is enough
    if (physical_memory() < 100000000000)                                                                           // 268 million vertices: 134 GB
        CHECK_THROWS_WITH(texture_of(shapes::octahedron(), loop(), texture_options(1, 13)),
                          Catch::Matchers::Contains("268435458 vertices") && Catch::Matchers::Contains("this machine has"));
}
