// SPDX-License-Identifier: BSD-3-Clause
// Limit normals through the C and C++ API.
#include <Eigen/Dense>
#include <limitcl/limitcl.hpp>

#include "tests/capi_support.h"

using namespace capi_test;

namespace {

Tangents make_tangents(lcl_operator A, lcl_mesh mesh) {
    lcl_tangents tangents = nullptr;
    succeed(lcl_tangents_create(A, mesh, &tangents));
    return Tangents(tangents);
}

std::vector<double> limit_normals(lcl_operator A, lcl_mesh mesh, const std::vector<double>& points, lcl_precision precision = LCL_PRECISION_DOUBLE) {
    std::vector<double> normals(points.size());
    succeed(lcl_limit_normals(A, mesh, points.data(), 0, precision, nullptr, 0, normals.data(), 0));
    return normals;
}

double length(const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

}  // namespace

TEST_CASE("normals of a cube look outwards along its diagonals", "[capi][normals]") {
    const shapes::Shape cube = shapes::cube();
    const Mesh mesh = make_mesh(cube);
    const std::vector<double>& p = cube.mesh.positions;
    std::vector<double> centre(3, 0.0);
    for (std::size_t i = 0; i < p.size(); ++i) centre[i % 3] += p[i] / 8;
    for (const lcl_scheme which : {LCL_SCHEME_CATMULL_CLARK, LCL_SCHEME_DOO_SABIN}) {
        const lcl_scheme_options options = scheme(which);
        const Operator A = make_operator(default_context(), mesh.get(), &options);
        std::vector<double> expected(p.size()), normals(p.size()), limit(p.size()), by_apply(p.size());
        for (std::size_t i = 0; i < p.size(); ++i) expected[i] = (p[i] > centre[i % 3] ? 1 : -1) / std::sqrt(3.0);
        succeed(lcl_limit_normals(A.get(), mesh.get(), nullptr, 0, LCL_PRECISION_DOUBLE, limit.data(), 0, normals.data(), 0));
        CHECK(largest_difference(normals, expected) <= 1e-14);
        succeed(lcl_limit_points(A.get(), p.data(), 0, 3, LCL_PRECISION_DOUBLE, by_apply.data(), 0));
        CHECK(largest_difference(limit, by_apply) <= 1e-15);
    }
}

TEST_CASE("fields, host memory and all precisions give the same normals", "[capi][normals]") {
    const shapes::Shape shape = shapes::rough(shapes::grid_with_creases(), 0.2, 3);
    const Mesh mesh = make_mesh(shape);
    const Operator A = make_operator(default_context(), mesh.get());
    const std::size_t rows = static_cast<std::size_t>(shape.mesh.vertex_count);
    const std::vector<double> expected = limit_normals(A.get(), mesh.get(), shape.mesh.positions);
    for (std::size_t v = 0; v < rows; ++v) CHECK(std::abs(length(&expected[3 * v]) - 1) <= 1e-14);
    CHECK(largest_difference(limit_normals(A.get(), mesh.get(), shape.mesh.positions, LCL_PRECISION_MIXED), expected) <=
          1e-6);  // pairs of floats end in floats
    // Points are rounded to 6e-8 of the diagonal of 9, edges are 1 long, and a tangent sums some ten of them.
    CHECK(largest_difference(limit_normals(A.get(), mesh.get(), shape.mesh.positions, LCL_PRECISION_SINGLE), expected) <= 1e-5);

    const Tangents tangents = make_tangents(A.get(), mesh.get());
    const FieldHandle x = make_field(A.get(), shape.mesh.positions), limit = make_field(A.get()), normals = make_field(A.get()), t = make_field(A.get()),
                      b = make_field(A.get()), y = make_field(A.get());
    succeed(lcl_operator_apply(A.get(), x.get(), y.get()));
    succeed(lcl_tangents_apply(tangents.get(), x.get(), limit.get(), normals.get(), nullptr, nullptr));
    CHECK(largest_difference(download(normals.get(), rows), expected) <= 1e-14);
    CHECK(largest_difference(download(limit.get(), rows), download(y.get(), rows)) <= 1e-14);
    succeed(lcl_tangents_apply(tangents.get(), x.get(), limit.get(), normals.get(), t.get(), b.get()));
    CHECK(largest_difference(download(normals.get(), rows), expected) <= 1e-14);
    CHECK(largest_difference(download(limit.get(), rows), download(y.get(), rows)) <= 1e-14);
    for (std::size_t v = 0; v < rows; ++v) CHECK(std::abs(length(&download(t.get(), rows)[3 * v]) - 1) <= 1e-14);
}

TEST_CASE("a box with sharp edges has the normals of its sides on them", "[capi][normals]") {
    const shapes::Shape box = shapes::box_with_crease_angle();
    const Mesh mesh = make_mesh(box);
    const Operator A = make_operator(default_context(), mesh.get());
    const Tangents tangents = make_tangents(A.get(), mesh.get());
    const FieldHandle x = make_field(A.get(), box.mesh.positions), normals = make_field(A.get());
    const std::size_t count = static_cast<std::size_t>(lcl_tangents_side_count(tangents.get()));
    CHECK(count == 12 * 2 * 2 + 8 * 3);  // two inner vertices an edge with two sides each, eight corners with three
    std::vector<int32_t> vertices(count), faces(count);
    std::vector<double> sides(3 * count);
    refuse(lcl_tangents_get_sides(tangents.get(), nullptr, nullptr, sides.data()), LCL_ERROR_INVALID_ARGUMENT, "call lcl_tangents_apply before");
    succeed(lcl_tangents_apply(tangents.get(), x.get(), nullptr, normals.get(), nullptr, nullptr));
    succeed(lcl_tangents_get_sides(tangents.get(), vertices.data(), faces.data(), sides.data()));
    std::vector<double> sums(box.mesh.positions.size(), 0.0);
    const std::vector<double> found = download(normals.get(), static_cast<std::size_t>(box.mesh.vertex_count));
    for (std::size_t s = 0; s < count; ++s) {
        const auto& mesh_faces = shapes::faces_of(box.mesh);
        const auto& face = mesh_faces[faces[s]];
        CHECK(std::count(face.begin(), face.end(), vertices[s]) == 1);
        // The side is flat, and so is the surface there: all of the face lies at one height.
        const auto points = shapes::points_of(box.mesh);
        for (const int v : face)
            for (int c = 0; c < 3; ++c) CHECK(std::abs((points[v][c] - points[face[0]][c]) * sides[3 * s + c]) <= 1e-12);
        CHECK(std::abs(length(&sides[3 * s]) - 1) <= 1e-14);
        for (int c = 0; c < 3; ++c) sums[3 * vertices[s] + c] += sides[3 * s + c];
    }
    for (std::size_t s = 0; s < count; ++s) {
        const double* sum = &sums[3 * vertices[s]];
        for (int c = 0; c < 3; ++c) CHECK(std::abs(found[3 * vertices[s] + c] - sum[c] / length(sum)) <= 1e-12);
    }
}

TEST_CASE("normals follow affine maps as normals do, and the origin does not matter", "[capi][normals]") {
    const shapes::Shape shape = shapes::rough(shapes::cube_with_crease(), 0.1, 5);
    const Mesh mesh = make_mesh(shape);
    const Operator A = make_operator(default_context(), mesh.get());
    Eigen::Matrix3d map;
    map << 2, 0.5, -0.25, 0, 1.5, 1, 0.75, 0, 0.8;
    std::vector<double> moved(shape.mesh.positions.size());
    for (std::size_t i = 0; i < moved.size(); i += 3) {
        const Eigen::Vector3d at = map * Eigen::Map<const Eigen::Vector3d>(&shape.mesh.positions[i]) + Eigen::Vector3d(1000, -2000, 500);
        std::copy_n(at.data(), 3, &moved[i]);
    }
    const Tangents tangents = make_tangents(A.get(), mesh.get());
    std::vector<int32_t> vertices(static_cast<std::size_t>(lcl_tangents_side_count(tangents.get())));
    succeed(lcl_tangents_get_sides(tangents.get(), vertices.data(), nullptr, nullptr));
    const std::vector<double> before = limit_normals(A.get(), mesh.get(), shape.mesh.positions), after = limit_normals(A.get(), mesh.get(), moved);
    for (int v = 0; v < shape.mesh.vertex_count; ++v) {
        if (std::count(vertices.begin(), vertices.end(), v) > 0) continue;  // a mean of two normals does not
        const Eigen::Vector3d expected = (map.inverse().transpose() * Eigen::Map<const Eigen::Vector3d>(&before[3 * v])).normalized();
        CHECK((Eigen::Map<const Eigen::Vector3d>(&after[3 * v]) - expected).norm() <= 1e-11);  // 2000 of 2^-53 in edges of size 1
    }
}

TEST_CASE("a subset, blend ratios and alpha change no normal of quads", "[capi][normals]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(6, 5), 0.1, 7);
    const Mesh mesh = make_mesh(shape);
    const std::vector<double> expected = limit_normals(make_operator(default_context(), mesh.get()).get(), mesh.get(), shape.mesh.positions);
    const std::vector<int32_t> subset{3, 4, 11};
    lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    options.subset = subset.data(), options.subset_count = subset.size();
    const Operator some = make_operator(default_context(), mesh.get(), &options);
    std::vector<double> normals(expected.size()), limit(expected.size());
    succeed(lcl_limit_normals(some.get(), mesh.get(), nullptr, 0, LCL_PRECISION_DOUBLE, limit.data(), 0, normals.data(), 0));
    CHECK(largest_difference(normals, expected) <= 1e-13);
    CHECK(std::equal(limit.begin(), limit.begin() + 9, shape.mesh.positions.begin()));  // outside: the points stay
    for (const double lambda : {0.0, 0.4, 1.0})
        for (const double alpha : {0.0, 0.6}) {
            const lcl_scheme_options other = scheme(LCL_SCHEME_CATMULL_CLARK, alpha, lambda);
            CHECK(largest_difference(limit_normals(make_operator(default_context(), mesh.get(), &other).get(), mesh.get(), shape.mesh.positions), expected) <=
                  1e-13);
        }
}

TEST_CASE("bad arguments of normals are refused with a sentence", "[capi][normals]") {
    const shapes::Shape shape = shapes::torus_quads(5, 4);
    const Mesh mesh = make_mesh(shape), other = make_mesh(shapes::torus_quads(4, 5));
    const Operator A = make_operator(default_context(), mesh.get());
    lcl_tangents handle = nullptr;
    refuse(lcl_tangents_create(nullptr, mesh.get(), &handle), LCL_ERROR_INVALID_ARGUMENT, "A is NULL");
    refuse(lcl_tangents_create(A.get(), nullptr, &handle), LCL_ERROR_INVALID_ARGUMENT, "mesh is NULL");
    refuse(lcl_tangents_create(A.get(), mesh.get(), nullptr), LCL_ERROR_INVALID_ARGUMENT, "tangents is NULL");
    refuse(lcl_tangents_create(A.get(), other.get(), &handle), LCL_ERROR_INVALID_ARGUMENT, "is not the one that the operator was made of");
    lcl_feature_options weights = LCL_FEATURE_OPTIONS_INIT;
    lcl_operator features = nullptr;
    succeed(lcl_operator_create_features(default_context(), mesh.get(), &weights, &features));
    const Operator owner(features);
    refuse(lcl_tangents_create(features, mesh.get(), &handle), LCL_ERROR_INVALID_ARGUMENT, "of no subdivision scheme");

    const Tangents tangents = make_tangents(A.get(), mesh.get());
    const FieldHandle x = make_field(A.get(), shape.mesh.positions), n = make_field(A.get()), t = make_field(A.get()), wide = make_field(A.get(), 4),
                      empty = make_field(A.get()), single = make_field(A.get(), 3, LCL_PRECISION_SINGLE),
                      foreign = make_field(owner.get(), shape.mesh.positions);
    const auto apply = [&](lcl_field from, lcl_field limit, lcl_field normals, lcl_field tangent = nullptr) {
        return lcl_tangents_apply(tangents.get(), from, limit, normals, tangent, nullptr);
    };
    refuse(apply(nullptr, nullptr, n.get()), LCL_ERROR_INVALID_ARGUMENT, "x is NULL");
    refuse(apply(x.get(), nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "normals is NULL");
    refuse(apply(x.get(), x.get(), n.get()), LCL_ERROR_INVALID_ARGUMENT, "given twice");
    refuse(apply(x.get(), n.get(), n.get()), LCL_ERROR_INVALID_ARGUMENT, "given twice");
    refuse(apply(x.get(), nullptr, n.get(), t.get()), LCL_ERROR_INVALID_ARGUMENT, "both or neither");
    refuse(apply(x.get(), nullptr, single.get()), LCL_ERROR_INVALID_ARGUMENT, "differ in channels or precision");
    refuse(apply(x.get(), nullptr, wide.get()), LCL_ERROR_INVALID_ARGUMENT, "differ in channels or precision");
    refuse(apply(empty.get(), nullptr, n.get()), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    refuse(apply(foreign.get(), nullptr, n.get()), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    const FieldHandle four = make_field(A.get(), with_channels(shape.mesh.positions, 4)), four_normals = make_field(A.get(), 4);
    refuse(apply(four.get(), nullptr, four_normals.get()), LCL_ERROR_INVALID_ARGUMENT, "has 4 channels");
    CHECK(lcl_tangents_side_count(nullptr) == 0);

    std::vector<double> out(shape.mesh.positions.size()), points = shape.mesh.positions;
    refuse(lcl_limit_normals(A.get(), mesh.get(), points.data(), 2, LCL_PRECISION_DOUBLE, nullptr, 0, out.data(), 0), LCL_ERROR_INVALID_ARGUMENT,
           "stride is 2");
    refuse(lcl_limit_normals(A.get(), mesh.get(), points.data(), 0, LCL_PRECISION_DOUBLE, nullptr, 0, nullptr, 0), LCL_ERROR_INVALID_ARGUMENT,
           "normals is NULL");
    points[7] = NAN;
    CHECK(lcl_limit_normals(A.get(), mesh.get(), points.data(), 0, LCL_PRECISION_DOUBLE, nullptr, 0, out.data(), 0) == LCL_ERROR_BAD_INPUT);
}

TEST_CASE("the C++ API gives normals, sides and frames", "[cpp][normals]") {
    namespace lcpp = limitcl;
    const shapes::Shape shape = shapes::box_with_crease_angle();
    const MeshArrays arrays(shape.mesh);
    lcl_mesh handle = nullptr;
    succeed(lcl_mesh_create(&arrays.data, &handle));
    lcpp::Mesh mesh{lcpp::MeshHandle(handle)};
    const lcpp::Context context = lcpp::Context();
    lcpp::LimitOperator A(context, mesh);
    const lcpp::LimitNormals all = A.limit_normals(mesh);
    CHECK(all.points == A.limit_points(shape.mesh.positions));
    const lcpp::LimitTangents tangents(A, mesh);
    lcpp::Field x(A), limit(A), normals(A), t(A), b(A);
    x.upload(lcpp::ArrayView<double>(shape.mesh.positions));
    tangents.apply(x, limit, normals);
    CHECK(largest_difference(normals.download(), all.normals) <= 1e-5);
    tangents.frames(x, normals, t, b);
    CHECK(largest_difference(normals.download(), all.normals) <= 1e-5);
    CHECK(tangents.sides().empty());  // no features were added
}
