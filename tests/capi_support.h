// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the C API share: handles that release themselves, meshes from named shapes, and checks that show the library's sentence.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <catch2/catch.hpp>

#include "limitcl/limitcl.h"
#include "tests/at_end.h"
#include "tests/shapes/shapes.h"

namespace capi_test {

struct Release {
    void operator()(lcl_context handle) const { lcl_context_release(handle); }
    void operator()(lcl_mesh handle) const { lcl_mesh_release(handle); }
    void operator()(lcl_operator handle) const { lcl_operator_release(handle); }
    void operator()(lcl_field handle) const { lcl_field_release(handle); }
    void operator()(lcl_task handle) const { lcl_task_release(handle); }
    void operator()(lcl_refiner handle) const { lcl_refiner_release(handle); }
    void operator()(lcl_tangents handle) const { lcl_tangents_release(handle); }
    void operator()(lcl_limit_surface handle) const { lcl_limit_surface_release(handle); }
    void operator()(lcl_samples handle) const { lcl_samples_release(handle); }
    void operator()(lcl_cloud handle) const { lcl_cloud_release(handle); }
};
template <class Raw>
using Owned = std::unique_ptr<std::remove_pointer_t<Raw>, Release>;
using Context = Owned<lcl_context>;
using Mesh = Owned<lcl_mesh>;
using Operator = Owned<lcl_operator>;
using FieldHandle = Owned<lcl_field>;
using Task = Owned<lcl_task>;
using Refiner = Owned<lcl_refiner>;
using Tangents = Owned<lcl_tangents>;
using LimitSurface = Owned<lcl_limit_surface>;
using Samples = Owned<lcl_samples>;

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline void succeed(lcl_status status) {
    INFO(lcl_status_string(status) << ": " << lcl_last_error());
    REQUIRE(status == LCL_OK);
}

/// The call failed with this status, and the thread's sentence holds `part`.
inline void refuse(lcl_status status, lcl_status expected, const std::string& part) {
    INFO(lcl_status_string(status) << ": " << lcl_last_error());
    CHECK(std::string(lcl_status_string(status)) == lcl_status_string(expected));
    CHECK_THAT(lcl_last_error(), Catch::Matchers::Contains(part));
}

inline std::vector<int32_t> last_error_vertices() {
    std::vector<int32_t> vertices(10);
    vertices.resize(lcl_last_error_vertices(vertices.data(), vertices.size()));
    return vertices;
}

inline std::vector<int32_t> last_error_faces() {
    std::vector<int32_t> faces(10);
    faces.resize(lcl_last_error_faces(faces.data(), faces.size()));
    return faces;
}

inline Context open_context(const char* device = nullptr, bool profiling = false) {
    lcl_context_options options = LCL_CONTEXT_OPTIONS_INIT;
    options.device = device;
    options.profiling = profiling;
    lcl_context context = nullptr;
    succeed(lcl_context_create(&options, &context));
    return Context(context);
}

/// One context for all tests that need no other: programs are built once.
inline lcl_context default_context() {
    static Context context;
    if (!context) {
        context = open_context();
        at_end().push_back([] { context.reset(); });
    }
    return context.get();
}

/// Polygons of a shape as the C API takes them.
struct MeshArrays {
    std::vector<int32_t> degrees, vertices;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;

    MeshArrays(const MeshArrays&) = delete;
    explicit MeshArrays(const lcl::PolygonMesh& mesh) : vertices(mesh.face_vertices) {
        for (lcl::Index f = 0; f < mesh.face_count(); ++f) degrees.push_back(mesh.degree(f));
        data.vertex_count = mesh.vertex_count;
        data.face_count = mesh.face_count();
        data.face_degrees = degrees.data();
        data.face_vertices = vertices.data();
        data.points = mesh.positions.data();
    }
};

inline Mesh make_mesh(const lcl::PolygonMesh& polygons) {
    const MeshArrays arrays(polygons);
    lcl_mesh mesh = nullptr;
    succeed(lcl_mesh_create(&arrays.data, &mesh));
    return Mesh(mesh);
}

inline Mesh make_mesh(const shapes::Shape& shape) {
    Mesh mesh = make_mesh(shape.mesh);
    std::vector<int32_t> creases;
    for (const auto& crease : shape.features.creases) creases.insert(creases.end(), crease.begin(), crease.end());
    lcl_features features = LCL_FEATURES_INIT;
    features.boundary = static_cast<lcl_boundary>(static_cast<int>(shape.features.boundary) + 1);
    features.creases = creases.data();
    features.crease_count = creases.size() / 2;
    features.corners = shape.features.corners.data();
    features.corner_count = shape.features.corners.size();
    features.crease_angle_degrees = std::max(0.0, shape.features.crease_angle_degrees);
    succeed(lcl_mesh_add_features(mesh.get(), &features));
    return mesh;
}

/// Of the box of the vertices that a face uses.
inline double diagonal_of(const shapes::Shape& shape) {
    lcl_mesh_info info = LCL_MESH_INFO_INIT;
    succeed(lcl_mesh_get_info(make_mesh(shape.mesh).get(), &info));
    return info.diagonal;
}

inline Operator make_operator(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* options = nullptr) {
    lcl_operator A = nullptr;
    succeed(lcl_operator_create(context, mesh, options, &A));
    return Operator(A);
}

inline Operator make_operator(const shapes::Shape& shape, const lcl_scheme_options* options = nullptr) {
    return make_operator(default_context(), make_mesh(shape).get(), options);
}

inline lcl_scheme_options scheme(lcl_scheme which, double alpha = 0, double lambda = 0) {
    lcl_scheme_options options = LCL_SCHEME_OPTIONS_INIT;
    options.scheme = which;
    options.alpha = alpha;
    options.lambda = lambda;
    return options;
}

inline FieldHandle make_field(lcl_operator A, int channels = 3, lcl_precision precision = LCL_PRECISION_DOUBLE) {
    lcl_field field = nullptr;
    succeed(lcl_field_create(A, channels, precision, &field));
    return FieldHandle(field);
}

/// A field that holds `values`, in the centre and scale of `like` if there is one.
inline FieldHandle make_field(lcl_operator A, const std::vector<double>& values, lcl_precision precision = LCL_PRECISION_DOUBLE, lcl_field like = nullptr) {
    FieldHandle field = make_field(A, static_cast<int>(values.size() / lcl_operator_vertex_count(A)), precision);
    if (like != nullptr) succeed(lcl_field_match(field.get(), like));
    succeed(lcl_field_upload(field.get(), values.data(), LCL_TYPE_DOUBLE, 0));
    return field;
}

inline std::vector<double> download(lcl_field field, std::size_t rows) {
    std::vector<double> values(rows * lcl_field_channels(field));
    succeed(lcl_field_download(field, values.data(), LCL_TYPE_DOUBLE, 0));
    return values;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::abs(a[i] - b[i]) <= largest)) largest = std::abs(a[i] - b[i]);  // keeps a not-a-number
    return largest;
}

/// The first three channels of n x channels are the points, the others waves of sizes from 1 to 1000.
inline std::vector<double> with_channels(const std::vector<double>& points, int channels) {
    const std::size_t rows = points.size() / 3;
    std::vector<double> values(rows * channels);
    for (std::size_t v = 0; v < rows; ++v)
        for (int c = 0; c < channels; ++c)
            values[v * channels + c] =
                c < 3 ? points[3 * v + c] : std::pow(10, c % 4) * std::sin(points[3 * v] * (c - 1) + points[3 * v + 1] - 2 * points[3 * v + 2]);
    return values;
}

}  // namespace capi_test
