// SPDX-License-Identifier: BSD-3-Clause
// The two-phase scheme through the C API: limit points of M^1 by its own operator, reports, channels, the map, normals of files, every refusal. The
// mathematics: two_phase_test.
#include "tests/capi_support.h"

using namespace capi_test;

namespace {

struct Made {
    Mesh mesh;
    lcl_solve_report solve = LCL_SOLVE_REPORT_INIT;
    lcl_two_phase_report report = LCL_TWO_PHASE_REPORT_INIT;
    lcl_status status;

    Made(lcl_operator A, lcl_mesh from, const lcl_solve_options* options, const lcl_two_phase_options* two_phase) {
        lcl_mesh out = nullptr;
        status = lcl_two_phase_mesh(A, from, options, two_phase, &out, &solve, &report);
        mesh = Mesh(out);
    }
};

shapes::Shape ball() { return shapes::rough(shapes::icosphere_quads(1), 0.02, 3); }

std::vector<double> points_of(lcl_mesh mesh) {
    std::vector<double> points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    succeed(lcl_mesh_get_points(mesh, points.data(), 0));
    return points;
}

/// Largest coordinate difference between the given vertices and the limit points of M^1's first vertices.
double largest_miss(lcl_mesh refined, const std::vector<double>& vertices) {
    const lcl_scheme_options plain = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Operator A = make_operator(default_context(), refined, &plain);
    std::vector<double> limits = points_of(refined);
    succeed(lcl_limit_points(A.get(), limits.data(), 0, 3, LCL_PRECISION_DOUBLE, limits.data(), 0));
    limits.resize(vertices.size());
    return largest_difference(limits, vertices);
}

std::vector<double> radial_normals(const std::vector<double>& points) { return points; }  // of a ball round the origin

}  // namespace

TEST_CASE("a two-phase mesh meets every vertex, and its report says how", "[two-phase][capi]") {
    const shapes::Shape shape = ball();
    const Mesh mesh = make_mesh(shape);
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK, 0.25, 0.3);
    const Operator A = make_operator(default_context(), mesh.get(), &options);
    const std::vector<double> normals = radial_normals(shape.mesh.positions);
    lcl_two_phase_options two_phase = LCL_TWO_PHASE_OPTIONS_INIT;
    two_phase.normals = normals.data();
    two_phase.convex_handle = 1.2, two_phase.other_handle = 0.8;
    two_phase.fair = 1;
    const Made made(A.get(), mesh.get(), nullptr, &two_phase);
    succeed(made.status);
    CHECK(largest_miss(made.mesh.get(), shape.mesh.positions) <= 1e-14);
    CHECK(points_of(mesh.get()) == shape.mesh.positions);
    CHECK(made.solve.converged);
    CHECK(made.report.normal_count == shape.mesh.vertex_count);
    CHECK(made.report.wrong_side_count == 0);
    CHECK(made.report.max_error <= 1e-14);
    CHECK(made.report.largest_repair > 0);
    CHECK(made.report.largest_repair <= 1e-6 * diagonal_of(shape));
    CHECK(made.report.energy[1] < made.report.energy[0]);
    CHECK((made.report.convex_count > 0 && made.report.convex_count < shape.mesh.vertex_count));
    CHECK((made.report.fair_converged && made.report.fair_iterations > 1));

    std::size_t count = 0;
    succeed(lcl_two_phase_get_map(made.mesh.get(), nullptr, &count));
    REQUIRE(count == static_cast<std::size_t>(shape.mesh.vertex_count));
    std::vector<int32_t> map(count);
    succeed(lcl_two_phase_get_map(made.mesh.get(), map.data(), nullptr));
    for (std::size_t v = 0; v < count; ++v) CHECK(map[v] == static_cast<int32_t>(v));
    refuse(lcl_two_phase_get_map(mesh.get(), nullptr, &count), LCL_ERROR_INVALID_ARGUMENT, "was not made by lcl_two_phase_mesh");
}

TEST_CASE("a two-phase mesh carries creases, corners and the boundary rule", "[two-phase][capi]") {
    for (const shapes::Shape& shape : {shapes::grid_with_creases(), shapes::grid_with_marked_corner(), shapes::torus_with_dart()}) {
        const Mesh mesh = make_mesh(shape);
        const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.4);
        const Made made(make_operator(default_context(), mesh.get(), &options).get(), mesh.get(), nullptr, nullptr);
        succeed(made.status);
        lcl_mesh_info before = LCL_MESH_INFO_INIT, after = LCL_MESH_INFO_INIT;
        succeed(lcl_mesh_get_info(mesh.get(), &before));
        succeed(lcl_mesh_get_info(made.mesh.get(), &after));
        CHECK(after.creases == 3 * before.creases);
        CHECK(after.corners == before.corners);
        CHECK(largest_miss(made.mesh.get(), shape.mesh.positions) <= 1e-13);
        CHECK(std::isnan(made.report.energy[0]));
    }
}

TEST_CASE("a solve that stops early is repaired, one that runs away is not", "[two-phase][capi]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(8, 6), 0.05, 1);
    const Mesh mesh = make_mesh(shape);
    lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.3);
    Operator A = make_operator(default_context(), mesh.get(), &options);
    lcl_solve_options solve = LCL_SOLVE_OPTIONS_INIT;
    solve.max_iterations = 2;
    const Made early(A.get(), mesh.get(), &solve, nullptr);
    succeed(early.status);
    CHECK_FALSE(early.solve.converged);
    CHECK(early.report.largest_repair > 1e-4);
    CHECK(largest_miss(early.mesh.get(), shape.mesh.positions) <= 1e-14);

    const shapes::Shape split = shapes::rough(shapes::cube_split_edges(), 0.05, 1);  // valence 2: A_0 has the eigenvalue -1/14
    const Mesh odd = make_mesh(split);
    options.lambda = 0.01;
    A = make_operator(default_context(), odd.get(), &options);
    const Made away(A.get(), odd.get(), nullptr, nullptr);
    CHECK(away.status == LCL_ERROR_INDEFINITE);
    CHECK_FALSE(away.mesh);
    solve.keep_going = 1;
    const Made kept(A.get(), odd.get(), &solve, nullptr);
    CHECK(kept.status == LCL_ERROR_INDEFINITE);
    REQUIRE(kept.mesh);
    CHECK(largest_miss(kept.mesh.get(), split.mesh.positions) <= 1e-13);
    options.lambda = 0.1;
    succeed(Made(make_operator(default_context(), odd.get(), &options).get(), odd.get(), nullptr, nullptr).status);
}

TEST_CASE("properties are refined, and interpolated where they are named", "[two-phase][capi]") {
    const shapes::Shape shape = ball();
    const Mesh mesh = make_mesh(shape);
    std::vector<double> heat(static_cast<std::size_t>(shape.mesh.vertex_count)), cold(heat.size());
    for (std::size_t v = 0; v < heat.size(); ++v) heat[v] = cold[v] = std::sin(7.0 * static_cast<double>(v));
    succeed(lcl_mesh_set_property(mesh.get(), "cold", cold.data()));
    succeed(lcl_mesh_set_property(mesh.get(), "heat", heat.data()));
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.3), plain = scheme(LCL_SCHEME_CATMULL_CLARK);
    const char* names[] = {"heat"};
    lcl_two_phase_options two_phase = LCL_TWO_PHASE_OPTIONS_INIT;
    two_phase.channels = names;
    two_phase.channel_count = 1;
    const Operator A = make_operator(default_context(), mesh.get(), &options);
    const Made made(A.get(), mesh.get(), nullptr, &two_phase);
    succeed(made.status);
    CHECK(largest_miss(made.mesh.get(), shape.mesh.positions) <= 1e-14);
    const Operator fine = make_operator(default_context(), made.mesh.get(), &plain);
    for (int32_t index = 0; index < 2; ++index) {
        std::vector<double> values(static_cast<std::size_t>(lcl_mesh_vertex_count(made.mesh.get())));
        succeed(lcl_mesh_get_property(made.mesh.get(), index, values.data()));
        succeed(lcl_limit_points(fine.get(), values.data(), 0, 1, LCL_PRECISION_DOUBLE, values.data(), 0));
        values.resize(heat.size());
        const bool is_heat = std::string(lcl_mesh_property_name(made.mesh.get(), index)) == "heat";
        CHECK((largest_difference(values, heat) <= 1e-14) == is_heat);
    }
    names[0] = "colour";
    const Made missing(A.get(), mesh.get(), nullptr, &two_phase);
    refuse(missing.status, LCL_ERROR_INVALID_ARGUMENT, "'colour'");
}

TEST_CASE("a two-phase mesh refuses what it cannot take", "[two-phase][capi]") {
    const shapes::Shape shape = ball();
    const Mesh mesh = make_mesh(shape);
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.3);
    const Operator A = make_operator(default_context(), mesh.get(), &options), plain = make_operator(shapes::cube());
    lcl_mesh out = nullptr;
    refuse(lcl_two_phase_mesh(nullptr, mesh.get(), nullptr, nullptr, &out, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "A is NULL");
    refuse(lcl_two_phase_mesh(A.get(), nullptr, nullptr, nullptr, &out, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "mesh is NULL");
    refuse(lcl_two_phase_mesh(A.get(), mesh.get(), nullptr, nullptr, nullptr, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "refined is NULL");
    refuse(lcl_two_phase_mesh(plain.get(), mesh.get(), nullptr, nullptr, &out, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "8 vertices");
    refuse(lcl_two_phase_mesh(plain.get(), make_mesh(shapes::cube()).get(), nullptr, nullptr, &out, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT,
           "lambda is 0.0");
    lcl_solve_options solve = LCL_SOLVE_OPTIONS_INIT;
    solve.warm_start = 1;
    refuse(lcl_two_phase_mesh(A.get(), mesh.get(), &solve, nullptr, &out, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "warm_start");
    lcl_two_phase_options two_phase = LCL_TWO_PHASE_OPTIONS_INIT;
    two_phase.struct_size = 0;
    refuse(lcl_two_phase_mesh(A.get(), mesh.get(), nullptr, &two_phase, &out, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "struct_size");
    two_phase = LCL_TWO_PHASE_OPTIONS_INIT;
    std::vector<double> normals(shape.mesh.positions);
    normals[3 * 4] = HUGE_VAL;
    two_phase.normals = normals.data();
    refuse(lcl_two_phase_mesh(A.get(), mesh.get(), nullptr, &two_phase, &out, nullptr, nullptr), LCL_ERROR_BAD_INPUT, "vertex 4 is not finite");
    CHECK(last_error_vertices() == std::vector<int32_t>{4});
    two_phase.normals = nullptr;
    two_phase.convex_handle = -1;
    refuse(lcl_two_phase_mesh(A.get(), mesh.get(), nullptr, &two_phase, &out, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "handle of convex vertices is -1");
    CHECK(out == nullptr);
}

TEST_CASE("normals of a file are read where they are asked for", "[two-phase][capi][io]") {
    struct File {
        lcl_format format;
        std::string text;
    };
    const std::string obj = "vn 0 0 1\nvn 0 2 0\nvn 1 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1//1 2//-1 3//2\nf 2//3 4 3//1\n";
    const std::string off = "NOFF\n4 2 0\n0 0 0 0 0 1\n1 0 0 1 0 0\n0 1 0 0 1 0.5\n1 1 0 nan nan nan\n3 0 1 2\n3 1 3 2\n";
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
        "property float nz\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 1\n1 0 0 1 0 0\n0 1 0 0 1 0.5\n"
        "1 1 0 nan nan nan\n3 0 1 2\n3 1 3 2\n";
    const std::vector<double> expected{0, 0, 1, 1, 0, 0, 0, 1, 0.5};
    for (const File& file : {File{LCL_FORMAT_OBJ, obj}, {LCL_FORMAT_OFF, off}, {LCL_FORMAT_PLY, ply}}) {
        lcl_mesh handle = nullptr;
        succeed(lcl_mesh_read_memory_with_normals(file.text.data(), file.text.size(), file.format, "a file", &handle));
        const Mesh mesh(handle);
        std::vector<double> normals(12, 7.0);
        succeed(lcl_mesh_get_normals(mesh.get(), normals.data()));
        INFO("format " << file.format);
        CHECK(std::vector<double>(normals.begin(), normals.begin() + 9) == expected);  // OBJ: vertex 2 has the mean of two corners
        CHECK(std::isnan(normals[9]));
        const std::vector<double> points = points_of(mesh.get());
        CHECK(points[3] == 1);
        CHECK(lcl_mesh_property_count(mesh.get()) == 0);
        succeed(lcl_mesh_set_points(mesh.get(), points.data(), 0));
        refuse(lcl_mesh_get_normals(mesh.get(), normals.data()), LCL_ERROR_INVALID_ARGUMENT, "points have changed");
        succeed(lcl_mesh_read_memory(file.text.data(), file.text.size(), file.format, "a file", &handle));
        refuse(lcl_mesh_get_normals(Mesh(handle).get(), normals.data()), LCL_ERROR_INVALID_ARGUMENT, "lcl_mesh_read_with_normals");
    }
    const std::string none = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", wrong = "v 0 0 0\nvn 1 0\n";
    lcl_mesh handle = nullptr;
    succeed(lcl_mesh_read_memory_with_normals(none.data(), none.size(), LCL_FORMAT_OBJ, "none", &handle));
    std::vector<double> normals(9);
    refuse(lcl_mesh_get_normals(Mesh(handle).get(), normals.data()), LCL_ERROR_BAD_INPUT, "holds no normals");
    refuse(lcl_mesh_read_memory_with_normals(wrong.data(), wrong.size(), LCL_FORMAT_OBJ, "wrong", &handle), LCL_ERROR_BAD_INPUT,
           "wrong:2: a normal needs three");
}
