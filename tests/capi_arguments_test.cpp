// SPDX-License-Identifier: BSD-3-Clause
// Missing arguments: every pointer that every function of the C API needs.
#include <functional>

#include "tests/capi_support.h"

using namespace capi_test;

namespace {

/// A call that has to fail because of one missing argument, and that argument's name.
struct MissingArgument {
    const char* name;
    std::function<lcl_status()> call;
};

void check_all(const std::vector<MissingArgument>& calls) {
    for (std::size_t i = 0; i < calls.size(); ++i) {
        INFO("call " << i);
        refuse(calls[i].call(), LCL_ERROR_INVALID_ARGUMENT, std::string(calls[i].name) + " is NULL");
    }
}

const shapes::Shape octahedron = shapes::octahedron();
const std::vector<double>& octahedron_points = octahedron.mesh.positions;

}  // namespace

TEST_CASE("a missing argument of a mesh function is refused by its name", "[capi]") {
    const Mesh owner = make_mesh(octahedron);
    lcl_mesh mesh = owner.get(), made = nullptr;
    const MeshArrays arrays(octahedron.mesh);
    const lcl_mesh_data data = arrays.data;
    lcl_mesh_data without_points = data, without_faces = data;
    without_points.points = nullptr;
    without_faces.face_degrees = nullptr;
    without_faces.uniform_degree = 3;
    without_faces.face_vertices = nullptr;
    lcl_features features = LCL_FEATURES_INIT;
    lcl_features no_creases = features, no_corners = features;
    no_creases.crease_count = no_corners.corner_count = 1;
    lcl_format format = LCL_FORMAT_OBJ;
    double points[18];
    lcl_refiner refiner = nullptr;
    check_all({
        {"data", [&] { return lcl_mesh_create(nullptr, &made); }},
        {"mesh", [&] { return lcl_mesh_create(&data, nullptr); }},
        {"data.points", [&] { return lcl_mesh_create(&without_points, &made); }},
        {"data.face_vertices", [&] { return lcl_mesh_create(&without_faces, &made); }},
        {"path", [&] { return lcl_mesh_read(nullptr, LCL_FORMAT_OBJ, &made); }},
        {"mesh", [&] { return lcl_mesh_read("x.obj", LCL_FORMAT_OBJ, nullptr); }},
        {"bytes", [&] { return lcl_mesh_read_memory(nullptr, 10, LCL_FORMAT_OBJ, "x", &made); }},
        {"mesh", [&] { return lcl_mesh_read_memory("", 0, LCL_FORMAT_OBJ, "x", nullptr); }},
        {"mesh", [&] { return lcl_mesh_write(nullptr, "x.obj", LCL_FORMAT_OBJ); }},
        {"path", [&] { return lcl_mesh_write(mesh, nullptr, LCL_FORMAT_OBJ); }},
        {"path", [&] { return lcl_format_of_path(nullptr, &format); }},
        {"format", [&] { return lcl_format_of_path("x.obj", nullptr); }},
        {"mesh", [&] { return lcl_mesh_copy(nullptr, &made); }},
        {"copy", [&] { return lcl_mesh_copy(mesh, nullptr); }},
        {"mesh", [&] { return lcl_mesh_get_faces(nullptr, nullptr, nullptr); }},
        {"mesh", [&] { return lcl_mesh_get_points(nullptr, points, 0); }},
        {"points", [&] { return lcl_mesh_get_points(mesh, nullptr, 0); }},
        {"mesh", [&] { return lcl_mesh_set_points(nullptr, points, 0); }},
        {"points", [&] { return lcl_mesh_set_points(mesh, nullptr, 0); }},
        {"mesh", [&] { return lcl_mesh_set_normals(nullptr, points); }},
        {"mesh", [&] { return lcl_mesh_add_features(nullptr, &features); }},
        {"features", [&] { return lcl_mesh_add_features(mesh, nullptr); }},
        {"features.creases", [&] { return lcl_mesh_add_features(mesh, &no_creases); }},
        {"features.corners", [&] { return lcl_mesh_add_features(mesh, &no_corners); }},
        {"mesh", [&] { return lcl_mesh_get_features(nullptr, nullptr, nullptr, nullptr, nullptr, nullptr); }},
        {"mesh",
         [&] {
             lcl_mesh_info info = LCL_MESH_INFO_INIT;
             return lcl_mesh_get_info(nullptr, &info);
         }},
        {"info", [&] { return lcl_mesh_get_info(mesh, nullptr); }},
        {"mesh", [&] { return lcl_mesh_get_histogram(nullptr, LCL_HISTOGRAM_VALENCES, nullptr, nullptr, 0, nullptr); }},
        {"mesh", [&] { return lcl_mesh_validate(nullptr); }},
        {"mesh",
         [&] {
             lcl_defect defect = LCL_DEFECT_INIT;
             return lcl_mesh_get_defect(nullptr, 0, &defect);
         }},
        {"mesh", [&] { return lcl_mesh_get_property(nullptr, 0, points); }},
        {"mesh", [&] { return lcl_mesh_set_property(nullptr, "x", points); }},
        {"name", [&] { return lcl_mesh_set_property(mesh, nullptr, points); }},
        {"values", [&] { return lcl_mesh_set_property(mesh, "x", nullptr); }},
        {"mesh", [&] { return lcl_mesh_set_colours(nullptr, points); }},
        {"colours", [&] { return lcl_mesh_set_colours(mesh, nullptr); }},
        {"mesh",
         [&] {
             lcl_suitability out = LCL_SUITABILITY_INIT;
             return lcl_mesh_check_scheme(nullptr, nullptr, &out);
         }},
        {"suitability", [&] { return lcl_mesh_check_scheme(mesh, nullptr, nullptr); }},
        {"mesh", [&] { return lcl_mesh_refine(nullptr, nullptr, nullptr, &made); }},
        {"refined", [&] { return lcl_mesh_refine(mesh, nullptr, nullptr, nullptr); }},
        {"refined", [&] { return lcl_mesh_get_locations(nullptr, nullptr, nullptr, nullptr); }},
        {"mesh", [&] { return lcl_refiner_create(nullptr, nullptr, nullptr, nullptr, &refiner); }},
        {"refiner", [&] { return lcl_refiner_create(nullptr, mesh, nullptr, nullptr, nullptr); }},
        {"refiner", [&] { return lcl_refiner_get_mesh(nullptr, &made); }},
        {"refiner", [&] { return lcl_refiner_apply(nullptr, points, 0, 3, LCL_PRECISION_MIXED, points, 0); }},
    });
    CHECK(made == nullptr);
    CHECK(lcl_mesh_property_count(mesh) == 0);
}

TEST_CASE("a missing argument of a context, an operator or a solve is refused by its name", "[capi]") {
    const Mesh owner = make_mesh(octahedron);
    const Operator operator_owner = make_operator(octahedron);
    lcl_context context = default_context();
    lcl_mesh mesh = owner.get();
    lcl_operator A = operator_owner.get(), made = nullptr;
    const double* M = octahedron_points.data();
    double P[18], number = 0;
    lcl_task task = nullptr;
    lcl_device_info device = LCL_DEVICE_INFO_INIT;
    lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
    lcl_scheme_options options = LCL_SCHEME_OPTIONS_INIT, no_subset = options, no_owned = options;
    no_subset.subset_count = no_owned.owned_count = 2;
    lcl_feature_options features = LCL_FEATURE_OPTIONS_INIT;
    features.subset_count = 2;
    const int64_t offsets[] = {0, 1};
    const int32_t column = 0;
    const double weight = 1;
    const auto create_rows = [&](const int64_t* starts, const int32_t* columns, const double* weights, lcl_operator* out) {
        lcl_rows rows = LCL_ROWS_INIT;
        rows.row_count = 1;
        rows.offsets = starts, rows.columns = columns, rows.weights = weights;
        return lcl_operator_create_rows(context, &rows, out);
    };
    const lcl_rows rows = LCL_ROWS_INIT;
    check_all({
        {"info", [&] { return lcl_device_get_info(0, nullptr); }},
        {"context", [&] { return lcl_context_create(nullptr, nullptr); }},
        {"context", [&] { return lcl_context_get_device(nullptr, &device); }},
        {"info", [&] { return lcl_context_get_device(context, nullptr); }},
        {"context", [&] { return lcl_context_finish(nullptr); }},
        {"context", [&] { return lcl_context_selftest(nullptr, nullptr, nullptr); }},
        {"context", [&] { return lcl_operator_create(nullptr, mesh, nullptr, &made); }},
        {"mesh", [&] { return lcl_operator_create(context, nullptr, nullptr, &made); }},
        {"A", [&] { return lcl_operator_create(context, mesh, nullptr, nullptr); }},
        {"subset", [&] { return lcl_operator_create(context, mesh, &no_subset, &made); }},
        {"owned", [&] { return lcl_operator_create(context, mesh, &no_owned, &made); }},
        {"context", [&] { return lcl_operator_create_rows(nullptr, &rows, &made); }},
        {"rows", [&] { return lcl_operator_create_rows(context, nullptr, &made); }},
        {"A", [&] { return lcl_operator_create_rows(context, &rows, nullptr); }},
        {"rows.offsets", [&] { return create_rows(nullptr, &column, &weight, &made); }},
        {"rows.columns", [&] { return create_rows(offsets, nullptr, &weight, &made); }},
        {"rows.weights", [&] { return create_rows(offsets, &column, nullptr, &made); }},
        {"context", [&] { return lcl_operator_create_features(nullptr, mesh, nullptr, &made); }},
        {"mesh", [&] { return lcl_operator_create_features(context, nullptr, nullptr, &made); }},
        {"A", [&] { return lcl_operator_create_features(context, mesh, nullptr, nullptr); }},
        {"subset", [&] { return lcl_operator_create_features(context, mesh, &features, &made); }},
        {"A", [&] { return lcl_operator_get_scheme(nullptr, &options); }},
        {"options", [&] { return lcl_operator_get_scheme(A, nullptr); }},
        {"A", [&] { return lcl_operator_get_row(nullptr, 0, nullptr, nullptr, 0, nullptr); }},
        {"A", [&] { return lcl_operator_diagnose(nullptr, &diagnosis); }},
        {"diagnosis", [&] { return lcl_operator_diagnose(A, nullptr); }},
        {"A", [&] { return lcl_operator_inverse_norm(nullptr, &number, nullptr); }},
        {"norm", [&] { return lcl_operator_inverse_norm(A, nullptr, nullptr); }},
        {"A", [&] { return lcl_limit_points(nullptr, M, 0, 3, LCL_PRECISION_MIXED, P, 0); }},
        {"points", [&] { return lcl_limit_points(A, nullptr, 0, 3, LCL_PRECISION_MIXED, P, 0); }},
        {"out", [&] { return lcl_limit_points(A, M, 0, 3, LCL_PRECISION_MIXED, nullptr, 0); }},
        {"A", [&] { return lcl_interpolate(nullptr, M, 0, 3, nullptr, P, 0, nullptr); }},
        {"M", [&] { return lcl_interpolate(A, nullptr, 0, 3, nullptr, P, 0, nullptr); }},
        {"P", [&] { return lcl_interpolate(A, M, 0, 3, nullptr, nullptr, 0, nullptr); }},
        {"A", [&] { return lcl_interpolate_mesh(nullptr, mesh, nullptr, nullptr); }},
        {"mesh", [&] { return lcl_interpolate_mesh(A, nullptr, nullptr, nullptr); }},
        {"A", [&] { return lcl_interpolate_async(nullptr, M, 0, 3, nullptr, P, 0, nullptr, &task); }},
        {"task", [&] { return lcl_interpolate_async(A, M, 0, 3, nullptr, P, 0, nullptr, nullptr); }},
        {"task", [&] { return lcl_task_wait(nullptr); }},
    });
    CHECK(made == nullptr);
    CHECK(task == nullptr);
}

TEST_CASE("a missing argument of a field function is refused by its name", "[capi][field]") {
    const Operator operator_owner = make_operator(octahedron);
    lcl_operator A = operator_owner.get();
    const FieldHandle first = make_field(A, octahedron_points), second = make_field(A, octahedron_points, LCL_PRECISION_DOUBLE, first.get());
    lcl_field x = first.get(), y = second.get(), made = nullptr;
    const int32_t vertex = 0;
    double values[18];
    check_all({
        {"A", [&] { return lcl_field_create(nullptr, 3, LCL_PRECISION_SINGLE, &made); }},
        {"field", [&] { return lcl_field_create(A, 3, LCL_PRECISION_SINGLE, nullptr); }},
        {"field", [&] { return lcl_field_upload(nullptr, values, LCL_TYPE_DOUBLE, 0); }},
        {"values", [&] { return lcl_field_upload(x, nullptr, LCL_TYPE_DOUBLE, 0); }},
        {"field", [&] { return lcl_field_download(nullptr, values, LCL_TYPE_DOUBLE, 0); }},
        {"values", [&] { return lcl_field_download(x, nullptr, LCL_TYPE_DOUBLE, 0); }},
        {"field", [&] { return lcl_field_match(nullptr, x); }},
        {"of", [&] { return lcl_field_match(x, nullptr); }},
        {"field", [&] { return lcl_field_read_vertices(nullptr, &vertex, 1, values); }},
        {"vertices", [&] { return lcl_field_read_vertices(x, nullptr, 1, values); }},
        {"values", [&] { return lcl_field_read_vertices(x, &vertex, 1, nullptr); }},
        {"field", [&] { return lcl_field_write_vertices(nullptr, &vertex, 1, values); }},
        {"vertices", [&] { return lcl_field_write_vertices(x, nullptr, 1, values); }},
        {"values", [&] { return lcl_field_write_vertices(x, &vertex, 1, nullptr); }},
        {"A", [&] { return lcl_operator_apply(nullptr, x, y); }},
        {"x", [&] { return lcl_operator_apply(A, nullptr, y); }},
        {"y", [&] { return lcl_operator_apply(A, x, nullptr); }},
        {"A", [&] { return lcl_operator_step(nullptr, 1, 1, 0, x, x, nullptr, y, 0, -1, nullptr); }},
        {"M", [&] { return lcl_operator_step(A, 1, 1, 0, nullptr, x, nullptr, y, 0, -1, nullptr); }},
        {"x", [&] { return lcl_operator_step(A, 1, 1, 0, x, nullptr, nullptr, y, 0, -1, nullptr); }},
        {"d", [&] { return lcl_operator_step(A, 1, 1, 1, x, x, nullptr, y, 0, -1, nullptr); }},
        {"y", [&] { return lcl_operator_step(A, 1, 1, 0, x, x, nullptr, nullptr, 0, -1, nullptr); }},
        {"A", [&] { return lcl_interpolate_field(nullptr, x, nullptr, y, nullptr); }},
        {"M", [&] { return lcl_interpolate_field(A, nullptr, nullptr, y, nullptr); }},
        {"P", [&] { return lcl_interpolate_field(A, x, nullptr, nullptr, nullptr); }},
    });
    CHECK(made == nullptr);
    CHECK(download(x, 6) == octahedron_points);  // the box of the octahedron is centred, with a diagonal of 2 sqrt 3, and came back unharmed
}

TEST_CASE("what asks a missing handle for a number gets nothing", "[capi]") {
    CHECK(lcl_mesh_vertex_count(nullptr) == 0);
    CHECK(lcl_mesh_face_count(nullptr) == 0);
    CHECK(lcl_mesh_corner_count(nullptr) == 0);
    CHECK(lcl_mesh_defect_count(nullptr) == 0);
    CHECK(lcl_mesh_property_count(nullptr) == 0);
    CHECK(lcl_mesh_property_name(nullptr, 0) == nullptr);
    CHECK(lcl_mesh_property_is_colour(nullptr, 0) == 0);
    CHECK(lcl_mesh_note_count(nullptr, LCL_NOTE_WARNING) == 0);
    CHECK(lcl_mesh_note(nullptr, LCL_NOTE_WARNING, 0) == nullptr);
    CHECK(lcl_operator_vertex_count(nullptr) == 0);
    CHECK(lcl_operator_row_count(nullptr) == 0);
    CHECK(lcl_operator_block_count(nullptr) == 0);
    CHECK(lcl_field_channels(nullptr) == 0);
    CHECK(lcl_task_is_done(nullptr) == 1);
    CHECK(lcl_context_compile_seconds(nullptr) == 0);
    CHECK(lcl_context_allocated_bytes(nullptr) == 0);
    lcl_context_retain(nullptr), lcl_context_release(nullptr);
    lcl_mesh_retain(nullptr), lcl_mesh_release(nullptr);
    lcl_operator_retain(nullptr), lcl_operator_release(nullptr);
    lcl_field_retain(nullptr), lcl_field_release(nullptr);
    lcl_task_release(nullptr);
}
