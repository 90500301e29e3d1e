// SPDX-License-Identifier: BSD-3-Clause
// Volumes of closed meshes, and points moved along their normals until a volume is met, against solids whose volumes are known.
#include <limits>

#include <Eigen/Dense>

#include "host/mesh/topology.h"
#include "tests/capi_support.h"

using namespace capi_test;

namespace {

using shapes::Shape;

/// Tetrahedra from the origin to every triangle of the fans round the faces' means.
double plain_volume(const lcl::PolygonMesh& mesh, const std::vector<double>& points) {
    double volume = 0;
    for (const shapes::Face& face : shapes::faces_of(mesh)) {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        const auto point = [&](std::size_t i) { return Eigen::Map<const Eigen::Vector3d>(&points[3 * static_cast<std::size_t>(face[i % face.size()])]); };
        for (std::size_t i = 0; i < face.size(); ++i) mean += point(i) / static_cast<double>(face.size());
        for (std::size_t i = 0; i < face.size(); ++i) volume += mean.dot(point(i).cross(point(i + 1))) / 6;
    }
    return volume;
}

double volume_of(lcl_mesh mesh) {
    double volume = std::nan("");
    succeed(lcl_mesh_get_volume(mesh, &volume));
    return volume;
}

std::vector<double> points_of(lcl_mesh mesh) {
    std::vector<double> points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    succeed(lcl_mesh_get_points(mesh, points.data(), 0));
    return points;
}

std::vector<std::string> warnings_of(lcl_mesh mesh) {
    std::vector<std::string> notes;
    for (int32_t i = 0; i < lcl_mesh_note_count(mesh, LCL_NOTE_WARNING); ++i) notes.emplace_back(lcl_mesh_note(mesh, LCL_NOTE_WARNING, i));
    return notes;
}

Shape scaled(const Shape& shape, double factor) { return shapes::transformed(shape, factor, 0); }

/// Every face turned round.
Shape inside_out(Shape shape) {
    for (lcl::Index f = 0; f < shape.mesh.face_count(); ++f)
        std::reverse(shape.mesh.face_vertices.begin() + shape.mesh.face_offsets[f], shape.mesh.face_vertices.begin() + shape.mesh.face_offsets[f + 1]);
    return shape;
}

struct Matched {
    std::vector<double> points;
    std::vector<std::string> warnings;
    double volume;
};

/// `shape` with the volumes that its faces enclose at `before`.
Matched match(const Shape& shape, const std::vector<double>& before, const std::vector<int32_t>& fixed = {}) {
    const Mesh mesh = make_mesh(shape);
    succeed(lcl_mesh_match_volume(mesh.get(), before.data(), 0, fixed.empty() ? nullptr : fixed.data(), fixed.size()));
    return {points_of(mesh.get()), warnings_of(mesh.get()), volume_of(mesh.get())};
}

/// How far each vertex went.
std::vector<double> moves(const Shape& shape, const std::vector<double>& points) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < points.size(); i += 3)
        distances.push_back(
            std::hypot(points[i] - shape.mesh.positions[i], points[i + 1] - shape.mesh.positions[i + 1], points[i + 2] - shape.mesh.positions[i + 2]));
    return distances;
}

}  // namespace

TEST_CASE("volumes of solids are those worked out by hand", "[volume]") {
    const auto box = shapes::make("box", {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {0, 0, 5}, {2, 0, 5}, {2, 3, 5}, {0, 3, 5}},
                                  {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
    const auto corner = shapes::make("corner", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
    CHECK(volume_of(make_mesh(box).get()) == Approx(30));
    CHECK(volume_of(make_mesh(corner).get()) == Approx(1.0 / 6));
    CHECK(volume_of(make_mesh(inside_out(box)).get()) == Approx(-30));
    CHECK(volume_of(make_mesh(shapes::combined(box, corner)).get()) == Approx(30 + 1.0 / 6));
    CHECK(volume_of(make_mesh(shapes::with_isolated_vertex(box, 3)).get()) == Approx(30));
    CHECK(volume_of(make_mesh(shapes::icosphere(4)).get()) == Approx(4 * std::acos(-1.0) / 3).epsilon(0.005));
    const double offset = 1e6;  // loses no more than the points do
    CHECK(volume_of(make_mesh(shapes::transformed(box, 1, offset)).get()) == Approx(30).epsilon(1e-12));
    CHECK(volume_of(make_mesh(scaled(box, 1e-30)).get()) == Approx(30e-90).epsilon(1e-12));
    for (const Shape& shape : shapes::closed_shapes()) {
        const Shape crooked = shapes::rough(shape, 0.1, 3);  // faces that are not flat: fans round their means
        INFO(shape.name);
        CHECK(volume_of(make_mesh(crooked).get()) == Approx(plain_volume(crooked.mesh, crooked.mesh.positions)).epsilon(1e-12));
    }
}

TEST_CASE("regular solids come back from any scale, since their normals point away from the centre", "[volume]") {
    for (const Shape& shape : {shapes::octahedron(), shapes::cube(), shapes::icosahedron(), shapes::dodecahedron(), shapes::tetrahedron()})
        for (const double factor : {0.01, 0.1, 0.5, 0.9, 1.0, 1.1, 3.0, 20.0})
            for (const Shape& given : {shape, inside_out(shape)}) {
                CAPTURE(shape.name, factor);
                const Matched matched = match(scaled(given, factor), given.mesh.positions);
                CHECK(matched.warnings.empty());
                CHECK(largest_difference(matched.points, given.mesh.positions) <= 1e-10);
            }
}

TEST_CASE("a smoothed mesh gets its volume back, all of its points by one distance", "[volume]") {
    for (const Shape& shape : {shapes::icosphere(3), shapes::rough(shapes::polygons_mixed(80, 3), 0.03, 1), shapes::torus_quads(16, 9),
                               shapes::dual_of(shapes::random_triangle_mesh(60, 2))})
        for (const double factor : {0.3, 0.8, 1.25}) {
            CAPTURE(shape.name, factor);
            const Shape small = scaled(shape, factor);
            const Matched matched = match(small, shape.mesh.positions);
            CHECK(matched.warnings.empty());
            CHECK(matched.volume == Approx(plain_volume(shape.mesh, shape.mesh.positions)).epsilon(2e-10));
            const std::vector<double> distances = moves(small, matched.points);
            for (const double distance : distances) CHECK(distance == Approx(distances[0]).epsilon(1e-9));
        }
}

TEST_CASE("points that have the volume already stay", "[volume]") {
    const Shape shape = shapes::rough(shapes::polygons_mixed(80, 3), 0.03, 1);
    const Matched matched = match(shape, shape.mesh.positions);
    CHECK(largest_difference(matched.points, shape.mesh.positions) == 0);
    CHECK(matched.warnings.empty());
    std::vector<int32_t> all(shape.mesh.vertex_count);
    for (int32_t v = 0; v < shape.mesh.vertex_count; ++v) all[v] = v;
    const Matched held = match(shape, shape.mesh.positions, all);
    CHECK(largest_difference(held.points, shape.mesh.positions) == 0);
    CHECK(held.warnings.empty());
}

TEST_CASE("every component gets its own volume back, isolated vertices stay", "[volume]") {
    Shape both = shapes::combined(shapes::icosphere(2), shapes::icosahedron());
    Shape before = both;
    const std::size_t first = 3 * static_cast<std::size_t>(shapes::icosphere(2).mesh.vertex_count);
    std::array<double, 3> centre{0, 0, 0};
    for (std::size_t i = first; i < both.mesh.positions.size(); ++i) centre[i % 3] += both.mesh.positions[i] / 12;
    for (std::size_t i = 0; i < both.mesh.positions.size(); ++i) {
        double& value = both.mesh.positions[i];
        value = i < first ? 0.7 * value : centre[i % 3] + 1.3 * (value - centre[i % 3]);
    }
    both = shapes::with_isolated_vertex(both, 5);
    before = shapes::with_isolated_vertex(before, 5);
    before.mesh.positions[15] = 77;  // says nothing
    const Matched matched = match(both, before.mesh.positions);
    CHECK(matched.warnings.empty());
    CHECK(matched.volume == Approx(plain_volume(before.mesh, before.mesh.positions)).epsilon(1e-10));
    for (int c = 0; c < 3; ++c) CHECK(matched.points[15 + c] == both.mesh.positions[15 + c]);
    for (std::size_t i = first + 3; i < matched.points.size(); ++i)
        CHECK(matched.points[i] == Approx(before.mesh.positions[i]).margin(1e-10));  // the regular one as it was
}

TEST_CASE("a component of a thousandth of the model's size is a component like others", "[volume]") {
    const Shape ball = shapes::icosahedron();
    Shape both = shapes::combined(scaled(ball, 1000), ball);
    const Shape before = both;
    const std::size_t first = 36;
    std::array<double, 3> centre{0, 0, 0};
    for (std::size_t i = first; i < 72; ++i) centre[i % 3] += both.mesh.positions[i] / 12;
    for (std::size_t i = first; i < 72; ++i) both.mesh.positions[i] = centre[i % 3] + 0.8 * (both.mesh.positions[i] - centre[i % 3]);
    const Matched matched = match(both, before.mesh.positions);
    CHECK(matched.warnings.empty());
    for (std::size_t i = first; i < 72; ++i) CHECK(matched.points[i] == Approx(before.mesh.positions[i]).margin(1e-9));
}

TEST_CASE("corners and fixed vertices stay, the others make up for them", "[volume]") {
    Shape shape = scaled(shapes::icosphere(2), 0.8);
    const std::vector<double> before = shapes::icosphere(2).mesh.positions;
    shape.features.corners = {3, 17};
    const std::vector<int32_t> fixed{0, 17, 40, 41, 42};
    const std::vector<int32_t> still{0, 3, 17, 40, 41, 42};
    const Matched matched = match(shape, before, fixed);
    CHECK(matched.warnings.empty());
    CHECK(matched.volume == Approx(plain_volume(shape.mesh, before)).epsilon(1e-10));
    const std::vector<double> distances = moves(shape, matched.points);
    for (int32_t v = 0; v < shape.mesh.vertex_count; ++v) {
        if (std::binary_search(still.begin(), still.end(), v)) CHECK(distances[v] == 0);
        else CHECK(distances[v] == Approx(distances[1]).epsilon(1e-9));
    }
    CHECK(distances[1] > 0.2);
}

TEST_CASE("what has no volume, was turned inside out, or cannot move stays as it is, with a note", "[volume]") {
    const Shape ball = shapes::icosahedron(), small = scaled(ball, 0.5);
    const auto check_stays = [](const Shape& shape, const std::vector<double>& before, const std::vector<int32_t>& fixed, const std::string& part) {
        const Matched matched = match(shape, before, fixed);
        CHECK(largest_difference(matched.points, shape.mesh.positions) == 0);
        REQUIRE(matched.warnings.size() == 1);
        CHECK_THAT(matched.warnings[0], Catch::Matchers::Contains("the volume of the component of vertex 0 was not kept") && Catch::Matchers::Contains(part));
    };
    check_stays(small, scaled(ball, -1).mesh.positions, {}, "turned inside out");
    check_stays(small, std::vector<double>(36, 2.5), {}, "it encloses none");
    Shape flat = ball;
    for (std::size_t i = 2; i < 36; i += 3) flat.mesh.positions[i] = 0;
    check_stays(flat, ball.mesh.positions, {}, "it encloses none");
    Shape slanted = ball;  // flat but for rounding
    for (std::size_t i = 0; i < 36; i += 3) {
        double* const p = &slanted.mesh.positions[i];
        const double height = (0.3 * p[0] + 0.5 * p[1] + 0.7 * p[2]) / (0.09 + 0.25 + 0.49);
        p[0] -= 0.3 * height, p[1] -= 0.5 * height, p[2] -= 0.7 * height;
    }
    REQUIRE(volume_of(make_mesh(slanted).get()) != 0);
    check_stays(slanted, ball.mesh.positions, {}, "it encloses none");
    check_stays(ball, slanted.mesh.positions, {}, "it encloses none");
    check_stays(small, ball.mesh.positions, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, "no distance along the normals gives it back");
    // The other component is restored all the same.
    Shape both = shapes::combined(small, ball), before = shapes::combined(ball, ball);
    for (std::size_t i = 0; i < 36; ++i) before.mesh.positions[i] *= -1;
    for (std::size_t i = 36; i < 72; ++i) before.mesh.positions[i] *= 1.5;
    const Matched matched = match(both, before.mesh.positions);
    CHECK(matched.warnings.size() == 1);
    CHECK(std::equal(matched.points.begin(), matched.points.begin() + 36, both.mesh.positions.begin()));
    CHECK(plain_volume(both.mesh, matched.points) ==
          Approx(plain_volume(small.mesh, small.mesh.positions) + std::pow(1.5, 3) * plain_volume(ball.mesh, ball.mesh.positions)));
}

TEST_CASE("creases by angle stay those of the points before", "[volume][features]") {
    const Shape box = shapes::box_with_crease_angle();
    const Mesh mesh = make_mesh(box);
    std::size_t before = 0, after = 0;
    succeed(lcl_mesh_get_features(mesh.get(), nullptr, nullptr, &before, nullptr, nullptr));
    CHECK(before == 36);
    std::vector<double> points = scaled(box, 1.5).mesh.positions;
    succeed(lcl_mesh_match_volume(mesh.get(), points.data(), 0, nullptr, 0));
    succeed(lcl_mesh_get_features(mesh.get(), nullptr, nullptr, &after, nullptr, nullptr));
    CHECK(after == before);
    CHECK(warnings_of(mesh.get()).empty());
    CHECK(volume_of(mesh.get()) == Approx(plain_volume(box.mesh, points)).epsilon(1e-10));
}

TEST_CASE("points before may have a stride", "[volume]") {
    const Shape ball = shapes::icosahedron();
    std::vector<double> wide(12 * 5, 99.0);
    for (std::size_t v = 0; v < 12; ++v) std::copy_n(&ball.mesh.positions[3 * v], 3, &wide[5 * v]);
    const Mesh mesh = make_mesh(scaled(ball, 0.7));
    succeed(lcl_mesh_match_volume(mesh.get(), wide.data(), 5, nullptr, 0));
    CHECK(largest_difference(points_of(mesh.get()), ball.mesh.positions) <= 1e-10);
}

TEST_CASE("volumes that cannot be asked for are refused", "[volume][errors]") {
    const Mesh open = make_mesh(shapes::grid_quads(3, 3)), ball = make_mesh(shapes::icosahedron());
    const std::vector<double> points(3 * 16, 1.0);
    double volume = 5;
    refuse(lcl_mesh_get_volume(open.get(), &volume), LCL_ERROR_BAD_INPUT, "the mesh has a boundary, such as at vertex");
    CHECK(last_error_vertices().size() == 1);
    refuse(lcl_mesh_match_volume(open.get(), points.data(), 0, nullptr, 0), LCL_ERROR_BAD_INPUT, "encloses no volume");
    CHECK(last_error_faces().size() == 1);
    refuse(lcl_mesh_get_volume(make_mesh(shapes::inconsistent_orientation()).get(), &volume), LCL_ERROR_BAD_INPUT, "");
    refuse(lcl_mesh_get_volume(nullptr, &volume), LCL_ERROR_INVALID_ARGUMENT, "mesh is NULL");
    refuse(lcl_mesh_get_volume(ball.get(), nullptr), LCL_ERROR_INVALID_ARGUMENT, "volume is NULL");
    CHECK(volume == 5);
    refuse(lcl_mesh_match_volume(nullptr, points.data(), 0, nullptr, 0), LCL_ERROR_INVALID_ARGUMENT, "mesh is NULL");
    refuse(lcl_mesh_match_volume(ball.get(), nullptr, 0, nullptr, 0), LCL_ERROR_INVALID_ARGUMENT, "points is NULL");
    refuse(lcl_mesh_match_volume(ball.get(), points.data(), 2, nullptr, 0), LCL_ERROR_INVALID_ARGUMENT, "stride is 2, a point has three values");
    const int32_t beyond = 12, negative = -1;
    refuse(lcl_mesh_match_volume(ball.get(), points.data(), 0, &beyond, 1), LCL_ERROR_INVALID_ARGUMENT, "12");
    refuse(lcl_mesh_match_volume(ball.get(), points.data(), 0, &negative, 1), LCL_ERROR_INVALID_ARGUMENT, "-1");
    std::vector<double> bad = points;
    bad[3 * 4 + 2] = std::numeric_limits<double>::quiet_NaN();
    refuse(lcl_mesh_match_volume(ball.get(), bad.data(), 0, nullptr, 0), LCL_ERROR_BAD_INPUT, "points of vertex 4 is nan in channel 2");
    CHECK(largest_difference(points_of(ball.get()), shapes::icosahedron().mesh.positions) == 0);
    CHECK(warnings_of(ball.get()).empty());
}
