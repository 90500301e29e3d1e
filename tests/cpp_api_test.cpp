// SPDX-License-Identifier: BSD-3-Clause
// The C++ headers: ownership, errors, and that every call reaches the C API with the right arguments.
#include <catch2/catch.hpp>

#include <limitcl/limitcl.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <type_traits>

using namespace limitcl;

namespace {

const std::vector<double> octahedron_points{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
const std::vector<std::int32_t> octahedron_faces{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
const std::vector<double> cube_points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
const std::vector<std::int32_t> cube_faces{0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};

constexpr double loop_alpha_4 = 24.0 / 55.0;     // 3 / (11 - 8 (3/8 + (3/8)^2)): A of the octahedron is this times the identity
constexpr double octahedron_inverse = 1 / 0.15;  // above |A^-1|, from the lower bound of the spectrum for valence 4
constexpr double octahedron_diagonal = 3.4641016;

Mesh octahedron() { return Mesh::from_uniform_faces(octahedron_points, 3, octahedron_faces); }
Mesh cube() { return Mesh::from_uniform_faces(cube_points, 4, cube_faces); }

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
    for (double& value : values) value *= factor;
    return values;
}

template <class Action>
lcl_status status_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        CHECK(std::string(error.what()).size() > 10);
        return error.status();
    }
    return LCL_OK;
}

}  // namespace

TEST_CASE("handles of the C++ API are shared by copies and empty after a move", "[cpp]") {
    static_assert(std::is_nothrow_move_constructible<Mesh>::value, "meshes can be moved");
    Mesh mesh = octahedron();
    const Mesh shared = mesh;
    CHECK(shared.get() == mesh.get());
    const Mesh moved = std::move(mesh);
    CHECK(moved.vertex_count() == 6);
    mesh = moved;
    CHECK(mesh.get() == moved.get());
    const Mesh own = moved.copy();
    CHECK(own.get() != moved.get());
    CHECK(own.points() == octahedron_points);
}

TEST_CASE("a mesh from arrays gives them back", "[cpp][mesh]") {
    const std::vector<double> points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0.5, 0};
    const std::vector<std::int32_t> degrees{4, 3}, vertices{0, 1, 2, 3, 1, 4, 2};
    Mesh mesh = Mesh::from_faces(points, degrees, vertices);
    CHECK(mesh.vertex_count() == 5);
    CHECK(mesh.face_count() == 2);
    CHECK(mesh.corner_count() == 7);
    CHECK(mesh.face_degrees() == degrees);
    CHECK(mesh.face_vertices() == vertices);
    CHECK(mesh.points() == points);
    CHECK(mesh.face_degree_counts() == std::map<int, int>{{3, 1}, {4, 1}});
    CHECK(mesh.valence_counts() == std::map<int, int>{{2, 3}, {3, 2}});
    const MeshInfo info = mesh.info();
    CHECK(info.edges == 6);
    CHECK(info.boundary_edges == 5);
    CHECK(info.boundary_loops == 1);
    CHECK(info.components == 1);
    CHECK(info.diagonal == Approx(std::sqrt(5.0)));
    CHECK(mesh.defects().empty());

    SECTION("rows may be floats and longer than a point") {
        const std::vector<float> wide{0, 0, 0, 9, 1, 0, 0, 9, 1, 1, 0, 9};
        CHECK(Mesh::from_uniform_faces(PointView(wide.data(), 3, 4), 3, {std::vector<std::int32_t>{0, 1, 2}}).points() ==
              std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0});
    }
    SECTION("points can be replaced") {
        mesh.set_points(scaled(points, 2));
        CHECK(mesh.points() == scaled(points, 2));
        CHECK(status_of([&] { mesh.set_points(octahedron_points); }) == LCL_ERROR_INVALID_ARGUMENT);
    }
    SECTION("properties can be added, replaced and read by name") {
        mesh.set_property("temperature", {std::vector<double>{1, 2, 3, 4, 5}});
        mesh.set_property("temperature", {std::vector<double>{5, 4, 3, 2, 1}});
        CHECK(mesh.property_names() == std::vector<std::string>{"temperature"});
        CHECK(mesh.property("temperature") == std::vector<double>{5, 4, 3, 2, 1});
        CHECK(status_of([&] { mesh.property("pressure"); }) == LCL_ERROR_INVALID_ARGUMENT);
    }
}

TEST_CASE("sharp features come back resolved", "[cpp][features]") {
    Mesh mesh = cube();
    Features features;
    features.creases = {0, 1, 1, 2};
    features.corners = {6};
    mesh.add_features(features);
    const Features found = mesh.features();
    CHECK(found.creases.size() == 4);
    CHECK(found.corners == std::vector<std::int32_t>{6});
    CHECK(mesh.info().creases == 2);
    features.creases = {0, 1, 2};
    CHECK(status_of([&] { mesh.add_features(features); }) == LCL_ERROR_INVALID_ARGUMENT);
}

TEST_CASE("sizes that do not fit are refused before the C API sees them", "[cpp]") {
    CHECK(status_of([] { Mesh::from_uniform_faces(std::vector<double>(7), 3, octahedron_faces); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([] { Mesh::from_uniform_faces(octahedron_points, 5, octahedron_faces); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([] { Mesh::from_faces(octahedron_points, {std::vector<std::int32_t>{3, 3}}, octahedron_faces); }) == LCL_ERROR_INVALID_ARGUMENT);
    const LimitOperator A(Context(), octahedron());
    CHECK(status_of([&] { A.limit_points({std::vector<double>(17)}); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([&] { (void)interpolate(A, octahedron_points, 4); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([&] { Field(A).upload(std::vector<double>(17)); }) == LCL_ERROR_INVALID_ARGUMENT);
}

TEST_CASE("an Error has the sentence, the status and the places", "[cpp][error]") {
    const Mesh mesh = Mesh::from_uniform_faces(octahedron_points, 3, {std::vector<std::int32_t>{0, 1, 2, 0, 3, 1, 0, 1, 4}});
    try {
        mesh.validate();
        FAIL("an edge with three faces was accepted");
    } catch (const Error& error) {
        CHECK(error.status() == LCL_ERROR_BAD_INPUT);
        CHECK(std::string(error.status_name()) == "LCL_ERROR_BAD_INPUT");
        CHECK_FALSE(error.vertices().empty());
    }
    const std::vector<Defect> defects = mesh.defects();
    REQUIRE_FALSE(defects.empty());
    CHECK(defects[0].count >= 1);
    CHECK(status_of([] { read_mesh("there-is-no-such-file.off"); }) == LCL_ERROR_FILE);
    CHECK(status_of([] {
              ContextOptions options;
              options.device = "no device has this name";
              Context{options};
          }) == LCL_ERROR_NO_DEVICE);
}

TEST_CASE("the octahedron is interpolated through arrays, a mesh, fields and a task", "[cpp][solve]") {
    const Context context;
    const LimitOperator A(context, octahedron());
    CHECK(A.vertex_count() == 6);
    CHECK(A.row_count() == 6);
    CHECK(A.scheme().scheme == Scheme::loop);
    const std::vector<double> expected = scaled(octahedron_points, 1 / loop_alpha_4);
    SolveOptions options;
    options.tolerance = 1e-9;
    options.certify = true;
    const double tolerance = options.tolerance * octahedron_diagonal * octahedron_inverse;

    SECTION("arrays") {
        const auto [P, report] = interpolate(A, octahedron_points, 3, options);
        CHECK(report.status == LCL_OK);
        CHECK(report.converged);
        CHECK(report.message.empty());
        CHECK(report.residuals.size() == static_cast<std::size_t>(report.iterations) + 1);
        CHECK(report.max_error <= options.tolerance * octahedron_diagonal);
        CHECK(largest_difference(P, expected) <= report.surface_error_bound);
        CHECK(report.surface_error_bound <= tolerance);
        CHECK(largest_difference(P, expected) <= tolerance);
        CHECK(largest_difference(A.limit_points(P), octahedron_points) <= 5 * 2.3 * 1.2e-7);  // floats, rows of five entries up to 55/24
    }
    SECTION("a mesh") {
        Mesh mesh = octahedron();
        interpolate(A, mesh, options).require_ok();
        CHECK(largest_difference(mesh.points(), expected) <= tolerance);
    }
    SECTION("fields") {
        options.tolerance = 1e-5;  // fields of floats
        Field M(A), P(A);
        M.upload(octahedron_points);
        interpolate(A, M, P, options).require_ok();
        CHECK(largest_difference(P.download(), expected) <= 2e-5 * octahedron_diagonal * octahedron_inverse);
        CHECK(largest_difference(P.read_vertices({std::vector<std::int32_t>{4}}), {0, 0, 1 / loop_alpha_4}) <= 2e-5 * octahedron_diagonal * octahedron_inverse);
    }
    SECTION("a task") {
        std::vector<double> P(18);
        SolveTask first(A, octahedron_points, 3, P.data(), options);
        SolveTask task = std::move(first);
        task.wait().require_ok();
        CHECK(task.is_done());
        CHECK(largest_difference(P, expected) <= tolerance);
    }
    SECTION("a warm start from the answer takes no iteration") {
        std::vector<double> P = expected;
        options.warm_start = true;
        CHECK(interpolate(A, octahedron_points, 3, P.data(), options).iterations == 0);
        CHECK(status_of([&] { (void)interpolate(A, octahedron_points, 3, options); }) == LCL_ERROR_INVALID_ARGUMENT);
    }
}

TEST_CASE("apply and step are the limit operator and a PIA sweep", "[cpp][field]") {
    const Context context;
    const LimitOperator A(context, octahedron());
    Field M(A), P(A), y(A);
    M.upload(octahedron_points);
    P.match(M);
    y.match(M);
    P.upload(octahedron_points);
    apply(A, P, y);
    context.finish();
    CHECK(largest_difference(y.download(), scaled(octahedron_points, loop_alpha_4)) <= 6e-7);
    CHECK(step(A, 1, 1, M, P, y) == Approx(1 - loop_alpha_4).epsilon(1e-6));
    CHECK(largest_difference(y.download(), scaled(octahedron_points, 2 - loop_alpha_4)) <= 1.2e-6);

    const auto row = A.row(0);
    REQUIRE(row.size() == 5);
    CHECK(row[0].first == 0);
    CHECK(row[0].second == Approx(loop_alpha_4).epsilon(1e-14));
    CHECK(row[4].first == 5);
    CHECK(row[4].second == Approx((1 - loop_alpha_4) / 4).epsilon(1e-14));
    CHECK(A.block_count() >= 1);
    const InverseNorm inverse = A.inverse_norm();
    CHECK(inverse.norm >= 1 / loop_alpha_4 * (1 - 1e-6));  // the octahedron itself is amplified by 55/24
}

TEST_CASE("operators of rows and of features stand in the place of limit operators", "[cpp][rows]") {
    const Context context;
    Rows rows;  // 0.6 x_i and the mean of the two neighbours round a ring
    for (int i = 0; i < 5; ++i) {
        rows.add(i, 0.6), rows.add((i + 1) % 5, 0.2), rows.add((i + 4) % 5, 0.2);
        rows.end_row();
        rows.scaling.push_back(1);
    }
    const LimitOperator A = LimitOperator::from_rows(context, rows);
    CHECK(A.vertex_count() == 5);
    CHECK(A.scheme().scheme == Scheme::by_faces);
    CHECK(A.row(2) == std::vector<std::pair<std::int32_t, double>>{{1, 0.2}, {2, 0.6}, {3, 0.2}});
    CHECK(A.diagnose().lambda_min_bound == Approx(0.2));
    const std::vector<double> M{0, 0, 0, 1, 0, 2, 0, 3, 0, 1, 1, 1, 2, 0, 4};
    SolveOptions options;
    options.solver = Solver::cg;
    options.tolerance = 1e-9;
    const auto [P, report] = interpolate(A, M, 3, options);
    CHECK(report.converged);
    CHECK(largest_difference(A.limit_points(P, 3, Precision::full), M) <= 6e-9);  // the box has a diagonal of 5.4

    rows.scaling.pop_back();
    CHECK(status_of([&] { LimitOperator::from_rows(context, rows); }) == LCL_ERROR_INVALID_ARGUMENT);
    rows.scaling.clear();
    const LimitOperator without = LimitOperator::from_rows(context, rows);
    CHECK(status_of([&] { (void)interpolate(without, M, 3, options); }) == LCL_ERROR_INVALID_ARGUMENT);
    rows.weights[7] = -3;
    CHECK(status_of([&] { LimitOperator::from_rows(context, rows); }) == LCL_ERROR_UNSUPPORTED);
    rows.columns.pop_back();
    CHECK(status_of([&] { LimitOperator::from_rows(context, rows); }) == LCL_ERROR_INVALID_ARGUMENT);
    rows.offsets.clear();
    CHECK(status_of([&] { LimitOperator::from_rows(context, rows); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([&] { LimitOperator::from_rows(context, {}); }) == LCL_ERROR_INVALID_ARGUMENT);

    FeatureWeights weights;
    weights.diagonal_factor = 4;
    weights.subset = {4, 5};
    const LimitOperator features = LimitOperator::keeping_features(context, octahedron(), weights);
    CHECK(features.row(0) == std::vector<std::pair<std::int32_t, double>>{{0, 1.0}});
    REQUIRE(features.row(4).size() == 5);
    CHECK(features.row(4)[4].second == Approx(0.75));
    CHECK(features.row(4)[0].second == Approx(0.25 / 4));  // four neighbours alike
    weights.diagonal_factor = 1;
    CHECK(status_of([&] { LimitOperator::keeping_features(context, octahedron(), weights); }) == LCL_ERROR_INVALID_ARGUMENT);
}

TEST_CASE("singular is a result that can be made an exception", "[cpp][solve]") {
    const Context context;
    const LimitOperator A(context, cube());
    CHECK(A.diagnose().singular);
    const Interpolation result = interpolate(A, cube_points);
    CHECK(result.report.status == LCL_ERROR_SINGULAR);
    CHECK_FALSE(result.report.message.empty());
    CHECK(status_of([&] { result.report.require_ok(); }) == LCL_ERROR_SINGULAR);
    CHECK(check_scheme(cube()).singular);

    SchemeOptions scheme;
    scheme.alpha_auto = true;
    const LimitOperator cured(context, cube(), scheme);
    CHECK(cured.scheme().alpha == 0.5);
    CHECK(interpolate(cured, cube_points).report.converged);
}

TEST_CASE("a progress callback may cancel, and what it throws arrives", "[cpp][solve]") {
    const LimitOperator A(Context(), octahedron());
    SolveOptions options;
    options.solver = Solver::pia;
    std::vector<int> iterations;
    options.progress = [&](int iteration, double, double) {
        iterations.push_back(iteration);
        return iteration < 2;
    };
    CHECK(status_of([&] { (void)interpolate(A, octahedron_points, 3, options); }) == LCL_ERROR_CANCELLED);
    CHECK(iterations.back() == 2);
    options.progress = [](int, double, double) -> bool { throw std::length_error("from the callback"); };
    CHECK_THROWS_AS((void)interpolate(A, octahedron_points, 3, options), std::length_error);
}

TEST_CASE("log messages reach a function of the caller", "[cpp][device]") {
    std::vector<std::string> messages;
    ContextOptions options;
    options.log = [&](LogLevel, const std::string& message) { messages.push_back(message); };
    options.log_level = LogLevel::debug;
    const LimitOperator A(Context(options), octahedron());  // the context lives on in the operator, and so must the function
    interpolate(A, octahedron_points).report.require_ok();
    CHECK_FALSE(messages.empty());
    CHECK(devices().size() >= 1);
    CHECK_FALSE(A.context().device().name.empty());
}

TEST_CASE("refined vertices keep their numbers and know their places", "[cpp][refine]") {
    const Mesh refined = refine(cube(), 1);
    CHECK(refined.vertex_count() == 26);
    CHECK(refined.face_count() == 24);
    const std::vector<double> points = refined.points();
    CHECK(std::abs(points[0] - 2.0 / 9) <= 1e-15);  // (Q + 2R + 0 S)/3 at valence 3: Q = (1/2 + 1/2 + 0)/3, R = (1/2)/3 in each coordinate
    const Locations places = locations(refined);
    CHECK(places.faces.size() == 26);
    CHECK(places.uv.size() == 52);
    CHECK(refine(cube(), 0).points() == cube_points);
    CHECK(status_of([] { refine(cube(), -1); }) == LCL_ERROR_INVALID_ARGUMENT);
}

TEST_CASE("a refiner refines points and channels of one mesh again and again", "[cpp][refine]") {
    const Mesh refined = refine(cube(), 2);
    const Refiner refiner(Context(), cube(), 2);
    REQUIRE(refiner.vertex_count() == refined.vertex_count());
    CHECK(refiner.mesh().points() == refined.points());
    const std::vector<double> points = refined.points(), found = refiner.apply(cube_points), ones = refiner.apply(std::vector<double>(8 * 5, 1.0), 5);
    REQUIRE(found.size() == points.size());
    for (std::size_t i = 0; i < points.size(); ++i) CHECK(std::abs(found[i] - points[i]) <= 1e-14);  // rows of up to 9 weights in two steps
    CHECK(ones == std::vector<double>(5 * points.size() / 3, 1.0));                                  // constants are the centre, which is kept apart
    CHECK(status_of([&] { refiner.apply(std::vector<double>(7), 3); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([] { Refiner(Context(), cube(), -1); }) == LCL_ERROR_INVALID_ARGUMENT);
}

TEST_CASE("a mesh goes through a file and through memory", "[cpp][io]") {
    const std::string path = "cpp_api_test.off";
    write_mesh(octahedron(), path);
    CHECK(read_mesh(path).points() == octahedron_points);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    CHECK(read_mesh(bytes.data(), bytes.size(), Format::off).face_vertices() == octahedron_faces);
    CHECK(format_of_path("a/b.PLY.gz") == Format::ply);
    CHECK(format_of_path("a.xyz") == Format::xyz);
    CHECK(status_of([] { format_of_path("a.txt"); }) == LCL_ERROR_INVALID_ARGUMENT);
    std::remove(path.c_str());
}

TEST_CASE("textures come with their report, and failures of their solves are errors unless one insists", "[cpp][texture]") {
    const Context context;
    TextureOptions options;
    options.octaves = 2;
    options.levels = 2;
    options.colours = {1, 0, 0, 0, 0, 1};
    int calls = 0;
    options.progress = [&](int, double, double) { return ++calls > 0; };
    const Texture texture = make_texture(context, octahedron(), options);
    CHECK(texture.report.status == LCL_OK);
    CHECK(texture.report.converged);
    CHECK(calls > 0);
    REQUIRE(texture.mesh.vertex_count() == 4 * 16 + 2);
    const std::vector<double> noise = texture.mesh.property("noise"), red = texture.mesh.property("red"), blue = texture.mesh.property("blue");
    for (std::size_t v = 0; v < noise.size(); ++v) {
        CHECK(red[v] == std::round(255 * (1 - noise[v])));  // two colours: a straight line
        CHECK(blue[v] == std::round(255 * noise[v]));
    }
    options.seed = 1;
    CHECK(make_texture(context, octahedron(), options).mesh.property("noise") != noise);
    options.seed = 0;
    options.frequency = 3;
    CHECK(make_texture(context, octahedron(), options).mesh.property("noise") != noise);

    CHECK(status_of([&] { return make_texture(context, cube(), options); }) == LCL_ERROR_SINGULAR);
    options.keep_going = true;
    const Texture insisted = make_texture(context, cube(), options);
    CHECK(insisted.report.status == LCL_ERROR_SINGULAR);
    CHECK(insisted.mesh.vertex_count() == 98);
    SchemeOptions scheme;
    scheme.alpha_auto = true;
    CHECK(make_texture(context, cube(), options, scheme).report.status == LCL_OK);
    options.max_iterations = 1;
    options.tolerance = 1e-12;
    CHECK(make_texture(context, cube(), options, scheme).report.status == LCL_ERROR_NOT_CONVERGED);

    options.progress = [](int, double, double) { return false; };
    CHECK(status_of([&] { return make_texture(context, octahedron(), options); }) == LCL_ERROR_CANCELLED);
    options.progress = [](int, double, double) -> bool { throw std::runtime_error("from the caller"); };
    CHECK_THROWS_WITH(make_texture(context, octahedron(), options), "from the caller");
    options.progress = nullptr;
    options.colours.pop_back();
    CHECK(status_of([&] { return make_texture(context, octahedron(), options); }) == LCL_ERROR_INVALID_ARGUMENT);
    options.colours.clear();
    scheme.lambda_per_vertex = {0.5};
    CHECK(status_of([&] { return make_texture(context, cube(), options, scheme); }) == LCL_ERROR_INVALID_ARGUMENT);
}

TEST_CASE("limit surfaces give values and closest points, and samples follow new points", "[cpp][evaluate]") {
    const Context context;
    const LimitSurface surface(context, cube(), Scheme::catmull_clark, Precision::full);
    CHECK(surface.vertex_count() == 8);
    Places places;
    places.add(1, 0.5, 0.5);
    places.add(1, 0, 0);
    CHECK(places.corners.empty());
    SurfaceValues values = surface.evaluate(places, Derivatives::second);
    CHECK(values.points.size() == 6);
    CHECK(values.normals[2] == Approx(1).margin(1e-14));  // face 1 is the upper one
    CHECK(values.mean[0] > 0);
    CHECK(std::isnan(values.gauss[1]));
    CHECK(surface.evaluate(places).duu.empty());
    CHECK(surface.evaluate(places, Derivatives::none).du.empty());

    const ClosestPoints closest = surface.closest(std::vector<double>{0.5, 0.5, 3});
    CHECK(closest.places.faces == std::vector<std::int32_t>{1});
    CHECK(closest.distances[0] == Approx(3 - values.points[2]));
    CHECK(largest_difference(closest.points, {values.points[0], values.points[1], values.points[2]}) < 1e-9);
    CHECK(closest.normals[2] == Approx(1));

    const Samples samples(surface, places);
    CHECK(samples.size() == 2);
    LimitSurface same = surface;
    same.set_points(scaled(cube_points, 2));
    CHECK(largest_difference(samples.evaluate(Derivatives::none).points, scaled(values.points, 2)) < 1e-14);

    // Where refined vertices lie, they are evaluated.
    const SchemeOptions loop(Scheme::loop);
    const Mesh refined = refine(octahedron(), 2, loop);
    const std::vector<double> limits = LimitOperator(context, refined, loop).limit_points(refined.points(), 3, Precision::full);
    const SurfaceValues there = LimitSurface(context, octahedron(), loop, Precision::full).evaluate(locations(refined), Derivatives::none);
    CHECK(largest_difference(there.points, limits) < 1e-14);

    places.add(1, 0.25, 0.25, 2);
    CHECK(places.corners == std::vector<std::int32_t>{0, 0, 2});
    CHECK(status_of([&] { surface.evaluate(places); }) == LCL_ERROR_BAD_INPUT);  // quads have corner 0 alone
    places.uv.pop_back();
    CHECK(status_of([&] { surface.evaluate(places); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([&] { same.set_points(octahedron_points); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([&] { surface.closest(std::vector<double>{1, 2}); }) == LCL_ERROR_INVALID_ARGUMENT);
    SchemeOptions two_phase(Scheme::catmull_clark);
    two_phase.lambda = 0.3;
    CHECK(status_of([&] { LimitSurface(context, cube(), two_phase); }) == LCL_ERROR_INVALID_ARGUMENT);
}

TEST_CASE("clouds hold points, and what stands beside them in a file", "[cpp][cloud]") {
    const Cloud cloud(octahedron_points, octahedron_points);
    CHECK(cloud.count() == 6);
    CHECK(cloud.points() == octahedron_points);
    CHECK(cloud.normals() == octahedron_points);
    CHECK_FALSE(cloud.has_colours());
    CHECK(status_of([&] { cloud.colours(); }) == LCL_ERROR_INVALID_ARGUMENT);
    const Cloud shared = cloud;
    CHECK(shared.get() == cloud.get());
    CHECK_FALSE(Cloud(octahedron_points).has_normals());

    const std::string text = "0 0 0 255 0 0\n1 0 0 0 255 0\n";
    const Cloud coloured = read_cloud(text.data(), text.size(), Format::xyz);
    CHECK(coloured.count() == 2);
    CHECK(coloured.colours() == std::vector<double>{1, 0, 0, 0, 1, 0});
    CHECK(coloured.warnings().empty());
    CHECK(status_of([] { read_cloud("no such file.xyz"); }) == LCL_ERROR_FILE);
    CHECK(status_of([] { read_cloud("0 0\n", 4, Format::xyz); }) == LCL_ERROR_BAD_INPUT);
    CHECK(status_of([] { Cloud(std::vector<double>{1, 2}); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([] { Cloud(cube_points, octahedron_points); }) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(status_of([] { Cloud(std::vector<double>{1, 2, NAN}); }) == LCL_ERROR_BAD_INPUT);
}

TEST_CASE("surfaces are fitted with engines that are functions", "[cpp][cloud]") {
    const Context context;
    std::vector<double> points = octahedron_points;
    points.insert(points.end(), {0, 0, 9});
    const Cloud cloud(points);
    const auto join = [](const EngineInput& input) {
        CHECK(input.points.size() == 21);
        CHECK(input.normals.empty());
        CHECK(input.settings == EngineSettings{{"key", "value"}});
        CHECK(input.progress(0.5));
        return Approximation{{}, octahedron_faces, {6}, {"the last point lies elsewhere"}};
    };
    FitOptions options;
    options.engine = {{"key", "value"}};
    std::vector<FitPhase> phases;
    options.progress = [&](FitPhase phase, int, double, double) {
        phases.push_back(phase);
        return true;
    };
    const Fit fit = fit_surface(context, cloud, Engine("join", join), options);
    CHECK(fit.report.require_ok().converged);
    CHECK(fit.report.points == 6);
    CHECK(fit.report.left_out == 1);
    CHECK(fit.report.vertices == 6);
    CHECK(fit.report.diagonal == Approx(octahedron_diagonal));
    CHECK(fit.report.max <= 1e-3 * octahedron_diagonal);
    CHECK(fit.report.interpolation_error <= 1e-6 * octahedron_diagonal);
    CHECK(fit.report.approximation_faces == 8);
    CHECK(fit.report.seconds_total > 0);
    CHECK(fit.mesh.face_count() == 8);
    const std::vector<std::string> warnings = fit.mesh.warnings();
    CHECK(std::find(warnings.begin(), warnings.end(), "the last point lies elsewhere") != warnings.end());
    CHECK(std::find(phases.begin(), phases.end(), FitPhase::approximate) != phases.end());
    CHECK(std::find(phases.begin(), phases.end(), FitPhase::measure) != phases.end());
    const ClosestPoints closest = LimitSurface(context, fit.mesh, Scheme::doo_sabin).closest(octahedron_points);
    for (const double distance : closest.distances) CHECK(std::abs(distance) <= fit.report.max + 1e-6);

    // Engines of C, other schemes, and results that are no success.
    static const lcl_engine c_engine = {
        static_cast<std::uint32_t>(sizeof(lcl_engine)),
        "c",
        "",
        "",
        "",
        [](void*, const lcl_engine_points* given, const lcl_engine_option*, std::size_t, const lcl_engine_sink* sink) -> std::int32_t {
            sink->give(sink->self, given->count, nullptr, 8, octahedron_faces.data());
            return LCL_ENGINE_OK;
        },
        nullptr};
    const Cloud all(octahedron_points);
    CHECK(Engine(c_engine).name() == "c");
    CHECK(fit_surface(context, all, Engine(c_engine), {}, Scheme::loop).report.require_ok().vertices == 6);
    FitOptions strict;
    strict.tolerance = 1e-15;
    strict.precision = Precision::single;
    strict.keep_going = true;
    const Cloud uneven(std::vector<double>{1, 0, 0.1, -1, 0.25, 0, 0, 1.5, 0.3, 0.7, -1, 0, 0, 0, 1.1, 0, 0, -2});
    const Fit far = fit_surface(context, uneven, Engine(c_engine), strict);
    CHECK(far.report.status == LCL_ERROR_NOT_CONVERGED);
    CHECK(far.report.message.find(" iterations") != std::string::npos);  // the solve's reason, which comes first
    CHECK(far.mesh.vertex_count() == 6);
    CHECK(status_of([&] { far.report.require_ok(); }) == LCL_ERROR_NOT_CONVERGED);
}

TEST_CASE("what engines and progress of a fit throw reaches the caller", "[cpp][cloud]") {
    const Context context;
    const Cloud cloud(octahedron_points);
    const auto fit_with = [&](const Engine::Function& function) { return fit_surface(context, cloud, Engine("test", function)); };
    CHECK_THROWS_WITH(fit_with([](const EngineInput&) -> Approximation { throw std::runtime_error("from the engine"); }), "from the engine");
    CHECK(status_of([&] { fit_with([](const EngineInput&) { return Approximation(); }); }) == LCL_ERROR_BAD_INPUT);  // no faces
    CHECK(status_of([&] { fit_with([](const EngineInput&) { return Approximation{{}, {0, 1}, {}, {}}; }); }) == LCL_ERROR_INVALID_ARGUMENT);

    const Engine engine("octahedron", [](const EngineInput& input) {
        while (input.progress(-1)) continue;
        return Approximation{{}, octahedron_faces, {}, {}};
    });
    FitOptions options;
    options.progress = [](FitPhase, int, double, double) { return false; };
    CHECK(status_of([&] { return fit_surface(context, cloud, engine, options); }) == LCL_ERROR_CANCELLED);
    options.progress = [](FitPhase, int, double, double) -> bool { throw std::runtime_error("from progress"); };
    CHECK_THROWS_WITH(fit_surface(context, cloud, engine, options), "from progress");
}
