// SPDX-License-Identifier: BSD-3-Clause
// lcl_refiner: the mesh and the values that it gives, beside lcl_mesh_refine.
#include "tests/capi_support.h"

using namespace capi_test;

namespace {

Refiner make_refiner(lcl_context context, lcl_mesh mesh, int levels, const lcl_scheme_options* options = nullptr) {
    lcl_refine_options refine = LCL_REFINE_OPTIONS_INIT;
    refine.levels = levels;
    lcl_refiner refiner = nullptr;
    succeed(lcl_refiner_create(context, mesh, options, &refine, &refiner));
    return Refiner(refiner);
}

Mesh refined(lcl_mesh mesh, int levels, const lcl_scheme_options* options = nullptr) {
    lcl_refine_options refine = LCL_REFINE_OPTIONS_INIT;
    refine.levels = levels;
    lcl_mesh out = nullptr;
    succeed(lcl_mesh_refine(mesh, options, &refine, &out));
    return Mesh(out);
}

Mesh mesh_of(const Refiner& refiner) {
    lcl_mesh out = nullptr;
    succeed(lcl_refiner_get_mesh(refiner.get(), &out));
    return Mesh(out);
}

std::vector<double> points_of(lcl_mesh mesh) {
    std::vector<double> points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    succeed(lcl_mesh_get_points(mesh, points.data(), 0));
    return points;
}

std::vector<int32_t> faces_of(lcl_mesh mesh) {
    std::vector<int32_t> vertices(lcl_mesh_corner_count(mesh)), degrees(lcl_mesh_face_count(mesh));
    succeed(lcl_mesh_get_faces(mesh, degrees.data(), vertices.data()));
    vertices.insert(vertices.end(), degrees.begin(), degrees.end());
    return vertices;
}

std::vector<double> applied(const Refiner& refiner, const std::vector<double>& values, int channels, lcl_precision precision) {
    std::vector<double> out(static_cast<std::size_t>(lcl_refiner_vertex_count(refiner.get())) * channels);
    succeed(lcl_refiner_apply(refiner.get(), values.data(), 0, channels, precision, out.data(), 0));
    return out;
}

}  // namespace

TEST_CASE("a refiner gives the mesh and the values of lcl_mesh_refine", "[capi][refine]") {
    const shapes::Shape shape = shapes::grid_with_creases();
    const Mesh mesh = make_mesh(shape);
    const lcl_scheme_options options = scheme(GENERATE(LCL_SCHEME_CATMULL_CLARK, LCL_SCHEME_DOO_SABIN));
    const Mesh expected = refined(mesh.get(), 2, &options);
    const std::vector<double> points = points_of(expected.get());
    for (lcl_context context : {default_context(), lcl_context(nullptr)}) {
        const Refiner refiner = make_refiner(context, mesh.get(), 2, &options);
        REQUIRE(lcl_refiner_vertex_count(refiner.get()) == lcl_mesh_vertex_count(expected.get()));
        const Mesh found = mesh_of(refiner);
        CHECK(faces_of(found.get()) == faces_of(expected.get()));
        CHECK(points_of(found.get()) == points);
        // Two levels of rows of at most some tens of products on coordinates up to 6.
        CHECK(largest_difference(applied(refiner, shape.mesh.positions, 3, LCL_PRECISION_MIXED), points) < 1e-13);
        CHECK(largest_difference(applied(refiner, shape.mesh.positions, 3, LCL_PRECISION_SINGLE), points) < 2e-5);
        const std::vector<double> values = with_channels(shape.mesh.positions, 7), refined_values = applied(refiner, values, 7, LCL_PRECISION_MIXED);
        for (std::size_t v = 0; v < points.size() / 3; ++v)
            for (int c = 0; c < 3; ++c) REQUIRE(std::abs(refined_values[7 * v + c] - points[3 * v + c]) < 1e-13);

        size_t creases = 0, expected_creases = 0;
        succeed(lcl_mesh_get_features(found.get(), nullptr, nullptr, &creases, nullptr, nullptr));
        succeed(lcl_mesh_get_features(expected.get(), nullptr, nullptr, &expected_creases, nullptr, nullptr));
        CHECK(creases == expected_creases);
    }
}

TEST_CASE("a refiner follows new points and properties, and its mesh knows where its vertices lie", "[capi][refine]") {
    const Mesh mesh = make_mesh(shapes::cube());
    const Refiner refiner = make_refiner(nullptr, mesh.get(), 1);
    std::vector<double> points = points_of(mesh.get()), heat(8);
    for (double& x : points) x = 2 * x + 1;
    for (std::size_t v = 0; v < 8; ++v) heat[v] = points[3 * v];
    succeed(lcl_mesh_set_points(mesh.get(), points.data(), 0));
    succeed(lcl_mesh_set_property(mesh.get(), "heat", heat.data()));
    const Mesh found = mesh_of(refiner), expected = refined(mesh.get(), 1);
    CHECK(points_of(found.get()) == points_of(expected.get()));
    std::vector<double> refined_heat(26);
    REQUIRE(lcl_mesh_property_count(found.get()) == 1);
    succeed(lcl_mesh_get_property(found.get(), 0, refined_heat.data()));
    for (std::size_t v = 0; v < 26; ++v) CHECK(std::abs(refined_heat[v] - points_of(found.get())[3 * v]) < 1e-14);
    std::vector<int32_t> faces(26), of_copy(26);
    lcl_mesh copy = nullptr;
    succeed(lcl_mesh_copy(found.get(), &copy));
    const Mesh owner(copy);
    succeed(lcl_mesh_get_locations(found.get(), faces.data(), nullptr, nullptr));
    succeed(lcl_mesh_get_locations(copy, of_copy.data(), nullptr, nullptr));
    CHECK(faces == of_copy);
    for (std::size_t f = 0; f < 6; ++f) CHECK(faces[20 + f] == static_cast<int32_t>(f));
}

TEST_CASE("a refiner without levels copies, keeps what it needs, and takes strides", "[capi][refine]") {
    Refiner refiner;
    {
        const Mesh mesh = make_mesh(shapes::octahedron());
        refiner = make_refiner(default_context(), mesh.get(), -1);
    }
    lcl_refiner_retain(refiner.get());
    lcl_refiner_release(refiner.get());
    const std::vector<double> points = points_of(mesh_of(refiner).get());
    REQUIRE(points.size() == 18);
    std::vector<double> spread(6 * 5, 7), out(6 * 4, 9);
    for (std::size_t v = 0; v < 6; ++v) std::copy_n(&points[3 * v], 3, &spread[5 * v]);
    succeed(lcl_refiner_apply(refiner.get(), spread.data(), 5, 3, LCL_PRECISION_SINGLE, out.data(), 4));
    for (std::size_t v = 0; v < 6; ++v) {
        for (int c = 0; c < 3; ++c) CHECK(std::abs(out[4 * v + c] - points[3 * v + c]) < 1e-6);
        CHECK(out[4 * v + 3] == 9);
    }
}

TEST_CASE("what a refiner cannot take is refused in one sentence", "[capi][refine]") {
    const Mesh cube = make_mesh(shapes::cube());
    const Refiner refiner = make_refiner(default_context(), cube.get(), 1);
    std::vector<double> values = shapes::cube().mesh.positions, out(26 * 3);
    refuse(lcl_refiner_apply(refiner.get(), values.data(), 2, 3, LCL_PRECISION_MIXED, out.data(), 0), LCL_ERROR_INVALID_ARGUMENT, "stride is 2");
    refuse(lcl_refiner_apply(refiner.get(), values.data(), 0, 0, LCL_PRECISION_MIXED, out.data(), 0), LCL_ERROR_INVALID_ARGUMENT, "channels is 0");
    refuse(lcl_refiner_apply(refiner.get(), values.data(), 0, 3, static_cast<lcl_precision>(7), out.data(), 0), LCL_ERROR_INVALID_ARGUMENT, "precision");
    refuse(lcl_refiner_apply(refiner.get(), nullptr, 0, 3, LCL_PRECISION_MIXED, out.data(), 0), LCL_ERROR_INVALID_ARGUMENT, "values is NULL");
    refuse(lcl_refiner_apply(refiner.get(), values.data(), 0, 3, LCL_PRECISION_MIXED, nullptr, 0), LCL_ERROR_INVALID_ARGUMENT, "out is NULL");
    values[7] = std::nan("");
    refuse(lcl_refiner_apply(refiner.get(), values.data(), 0, 3, LCL_PRECISION_MIXED, out.data(), 0), LCL_ERROR_BAD_INPUT, "vertex 2");
    succeed(lcl_mesh_set_points(cube.get(), values.data(), 0));
    lcl_mesh refined = nullptr;
    refuse(lcl_refiner_get_mesh(refiner.get(), &refined), LCL_ERROR_BAD_INPUT, "vertex 2");
    succeed(lcl_mesh_set_points(cube.get(), shapes::cube().mesh.positions.data(), 0));
    lcl_refine_options deep = LCL_REFINE_OPTIONS_INIT;
    deep.levels = 40;
    lcl_refiner none = nullptr;
    refuse(lcl_refiner_create(nullptr, cube.get(), nullptr, &deep, &none), LCL_ERROR_MEMORY, "use fewer levels");
    const lcl_scheme_options loop = scheme(LCL_SCHEME_LOOP);
    refuse(lcl_refiner_create(default_context(), cube.get(), &loop, nullptr, &none), LCL_ERROR_BAD_INPUT, "face 0 has 4 sides");
    CHECK(none == nullptr);
    CHECK(lcl_refiner_vertex_count(nullptr) == 0);
}
