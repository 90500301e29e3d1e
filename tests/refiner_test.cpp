// SPDX-License-Identifier: BSD-3-Clause
// Refinement made once: topology by arithmetic against topology that is found, values of any channels against stencils.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "host/refine/device_refiner.h"
#include "tests/shapes/shapes.h"
#include "tests/solver_support.h"

using namespace lcl;

namespace {

SchemeOptions scheme_of(Scheme scheme, double alpha = 0, double lambda = 0, DooSabinMask mask = DooSabinMask::catmull) {
    SchemeOptions options;
    options.scheme = scheme;
    options.alpha = alpha;
    options.lambda = lambda;
    options.mask = mask;
    return options;
}

std::vector<SchemeOptions> options_for(const shapes::Shape& shape) {
    std::vector<SchemeOptions> all{scheme_of(Scheme::catmull_clark), scheme_of(Scheme::catmull_clark, 0.5), scheme_of(Scheme::catmull_clark, 0.25, 0.3)};
    if (shape.name.find("valence_2") == std::string::npos && shape.name.find("split_edges") == std::string::npos) {
        all.push_back(scheme_of(Scheme::doo_sabin));
        all.push_back(scheme_of(Scheme::doo_sabin, 0, 0, DooSabinMask::classic));
    }
    if (shapes::is_triangle_mesh(shape.mesh)) all.push_back(scheme_of(Scheme::loop));
    return all;
}

std::vector<shapes::Shape> shapes_with_all_rules() {
    std::vector<shapes::Shape> all = shapes::all_shapes();
    for (shapes::Shape shape : shapes::boundary_shapes())
        for (const BoundaryRule rule : {BoundaryRule::edge_only, BoundaryRule::fixed}) {
            shape.features.boundary = rule;
            all.push_back(shape);
        }
    for (const shapes::Shape& shape : shapes::all_shapes()) all.push_back(shapes::shuffled(shape, 5));
    return all;
}

Refiner refiner_of(const shapes::Shape& shape, const SchemeOptions& options, int levels) {
    Topology topology = build_topology(shape.mesh);
    Features features = find_features(shape.mesh, topology, shape.features);
    return Refiner(std::move(topology), std::move(features), options, levels);
}

/// Compared as a whole: a failure names the array and not its numbers.
void check_same(const Topology& found, const Topology& expected) {
    CHECK(found.vertex_count == expected.vertex_count);
    CHECK(found.face_count == expected.face_count);
    CHECK(found.edge_count == expected.edge_count);
    CHECK(found.boundary_edge_count == expected.boundary_edge_count);
    CHECK(found.uniform_degree == expected.uniform_degree);
    CHECK((found.face_offsets == expected.face_offsets));
    CHECK((found.face_vertices == expected.face_vertices));
    CHECK((found.half_edge_face == expected.half_edge_face));
    CHECK((found.twin == expected.twin));
    CHECK((found.half_edge_edge == expected.half_edge_edge));
    CHECK((found.edge_half_edge == expected.edge_half_edge));
    CHECK((found.vertex_half_edge == expected.vertex_half_edge));
    CHECK((found.vertex_face_count == expected.vertex_face_count));
    CHECK((found.fan_offsets == expected.fan_offsets));
    CHECK((found.fan_half_edges == expected.fan_half_edges));
}

void check_same(const Features& found, const Features& expected) {
    CHECK((found.edge_is_sharp == expected.edge_is_sharp));
    CHECK((found.kind == expected.kind));
    CHECK((found.curve_neighbours == expected.curve_neighbours));
    CHECK(found.crease_count == expected.crease_count);
    CHECK(found.corner_count == expected.corner_count);
}

/// The topology and features of the refined mesh against those found in its faces.
void check_finest(const Refiner& refiner, const shapes::Shape& shape) {
    const Refinement refined = refined_mesh(refiner, shape.mesh.positions.data(), 3);
    const Topology expected = build_topology(refined.mesh), found = refiner.finest_topology();
    check_same(found, expected);
    check_same(refiner.finest_features(found), find_features(refined.mesh, expected, refined.features));
}

std::vector<double> rough_values(Index rows, int channels) {
    shapes::Random random(11);
    std::vector<double> values(static_cast<std::size_t>(rows) * channels);
    for (double& value : values) value = random.symmetric();
    return values;
}

/// Level by level with stencils.
std::vector<double> refined_by_stencils(const shapes::Shape& shape, SchemeOptions options, int levels, std::vector<double> values, int channels) {
    Refinement current;
    current.mesh = shape.mesh;
    current.features = shape.features;
    for (int level = 0; level < levels; ++level) {
        const Topology topology = build_topology(current.mesh);
        current = refine_once(current.mesh, topology, find_features(current.mesh, topology, current.features), options);
        values = apply_stencils(current.stencils, values, channels);
        options = scheme_of(options.scheme, 0, 0, options.mask);
    }
    return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::fabs(a[i] - b[i]) <= largest)) largest = std::fabs(a[i] - b[i]);
    return largest;
}

/// What a level may be off in units of the values' size: rows of at most 60 products, weights that sum to 1.
double rounding_of(const Context& context, Real real) {
    const bool pairs = real == Real::wide && !context.device().has_double;
    return 64 * std::ldexp(1, real == Real::single ? -24 : pairs ? -46 : -52);
}

/// Values from the device against those of the host.
void check_device(const shapes::Shape& shape, const SchemeOptions& options, int levels, int channels, Real real,
                  const std::shared_ptr<Context>& context = solver_test::device_context()) {
    INFO(shape.name << ", " << scheme_name(options.scheme) << ", lambda " << options.lambda << ", " << channels << " channels, type "
                    << static_cast<int>(real));
    const auto refiner = std::make_shared<const Refiner>(refiner_of(shape, options, levels));
    DeviceRefiner device(context, refiner);
    const std::vector<double> values = rough_values(shape.mesh.vertex_count, channels);
    std::vector<double> found(static_cast<std::size_t>(refiner->vertex_count()) * channels), expected = found;
    refiner->apply(values.data(), channels, channels, expected.data(), channels);
    constexpr double largest_size = 3.5;  // of values between -1 and 1: the diagonal of a cube of side 2
    for (int run = 0; run < 2; ++run) {   // the second one finds what lies between the levels
        device.apply(values.data(), channels, channels, real, found.data(), channels);
        CHECK(largest_difference(found, expected) < largest_size * levels * rounding_of(device.context(), real));
        std::fill(found.begin(), found.end(), 99);
    }
}

}  // namespace

TEST_CASE("refined topology and features are those that are found in the refined mesh", "[refine][topology]") {
    for (const shapes::Shape& shape : shapes_with_all_rules())
        for (const SchemeOptions& options : options_for(shape)) {
            INFO(shape.name << ", " << scheme_name(options.scheme) << ", lambda " << options.lambda);
            for (int level = 1; level <= (shape.mesh.face_count() > 100 ? 1 : shape.mesh.face_count() > 30 ? 2 : 3); ++level)
                check_finest(refiner_of(shape, options, level), shape);
        }
}

TEST_CASE("refined values of any channels are those of stencils", "[refine]") {
    // A row sums some tens of products of numbers up to 1 with weights that sum to 1 (Doo-Sabin's sums: to at most the degree); two levels.
    constexpr double rounding = 1e-14;
    for (const shapes::Shape& shape : shapes::all_shapes())
        for (const SchemeOptions& options : options_for(shape)) {
            INFO(shape.name << ", " << scheme_name(options.scheme) << ", lambda " << options.lambda);
            const int channels = 6, stride = 7, levels = 2;
            const Refiner refiner = refiner_of(shape, options, levels);
            const std::vector<double> values = rough_values(shape.mesh.vertex_count, channels);
            std::vector<double> spread(static_cast<std::size_t>(shape.mesh.vertex_count) * stride, 99),
                found(static_cast<std::size_t>(refiner.vertex_count()) * channels);
            for (Index v = 0; v < shape.mesh.vertex_count; ++v) std::copy_n(&values[v * channels], channels, &spread[v * stride]);
            refiner.apply(spread.data(), stride, channels, found.data(), channels);
            CHECK(largest_difference(found, refined_by_stencils(shape, options, levels, values, channels)) < rounding);
        }
}

TEST_CASE("a refiner with blend ratios a vertex refines like stencils, and without levels it copies", "[refine]") {
    const shapes::Shape shape = shapes::polygons_mixed(60, 3);
    SchemeOptions options;
    for (Index v = 0; v < shape.mesh.vertex_count; ++v) options.lambda_per_vertex.push_back(0.1 + 0.8 * v / shape.mesh.vertex_count);
    const Refiner refiner = refiner_of(shape, options, 2), none = refiner_of(shape, options, 0);
    const std::vector<double> values = rough_values(shape.mesh.vertex_count, 2);
    std::vector<double> found(2 * static_cast<std::size_t>(refiner.vertex_count())), copy(values.size());
    refiner.apply(values.data(), 2, 2, found.data(), 2);
    CHECK(largest_difference(found, refined_by_stencils(shape, options, 2, values, 2)) < 1e-14);
    REQUIRE(none.vertex_count() == shape.mesh.vertex_count);
    none.apply(values.data(), 2, 2, copy.data(), 2);
    CHECK(copy == values);
    check_same(none.finest_topology(), build_topology(shape.mesh));
}

TEST_CASE("a pole of a hundred thousand faces and a face of as many sides refine in linear time", "[refine]") {
    const shapes::Shape pole = shapes::disk_pole_triangles(100000);
    std::vector<shapes::Point> points;
    shapes::Face face;
    for (int k = 0; k < 100000; ++k) {
        points.push_back({std::cos(6.283185307179586 * k / 100000), std::sin(6.283185307179586 * k / 100000), 0});
        face.push_back(k);
    }
    const shapes::Shape disk = shapes::make("disk", points, {face});
    for (const SchemeOptions& options :
         {scheme_of(Scheme::catmull_clark), scheme_of(Scheme::catmull_clark, 0, 0.3), scheme_of(Scheme::doo_sabin, 0, 0, DooSabinMask::classic)}) {
        CHECK(refiner_of(pole, options, 1).vertex_count() > 300000);
        CHECK(refiner_of(disk, options, 1).vertex_count() > 200000);
    }
}

TEST_CASE("a device refines values as the host does", "[refine][kernel]") {
    for (const shapes::Shape& shape : shapes::all_shapes())
        for (const SchemeOptions& options : options_for(shape)) {
            check_device(shape, options, 2, 3, Real::single);
            check_device(shape, options, 1, 3, Real::wide);
        }
    for (const int channels : {1, 2, 11}) check_device(shapes::grid_with_creases(), scheme_of(Scheme::catmull_clark), 3, channels, Real::wide);
    check_device(shapes::torus_quads(60, 50), scheme_of(Scheme::catmull_clark), 2, 3, Real::single);  // several chunks of rows
    check_device(shapes::torus_triangles(60, 50), scheme_of(Scheme::loop), 2, 3, Real::wide);
    if (solver_test::device_context()->device().has_double)
        check_device(shapes::polygons_mixed(80, 2), scheme_of(Scheme::catmull_clark, 0.5), 2, 3, Real::full);
}

TEST_CASE("pairs of floats refine values where there is no double precision", "[refine][kernel]") {
    for (const shapes::Shape& shape : {shapes::grid_with_creases(), shapes::polygons_mixed(60, 4), shapes::icosphere(1)})
        for (const SchemeOptions& options : options_for(shape)) check_device(shape, options, 2, 3, Real::wide, solver_test::context_without_double());
}

TEST_CASE("every refinement kernel runs once on a small mesh", "[refine][kernel][tiny]") {
    check_device(shapes::cube_with_crease(), scheme_of(Scheme::catmull_clark), 2, 3, Real::single);
    check_device(shapes::triangular_prism(), scheme_of(Scheme::catmull_clark, 0.5), 2, 3, Real::wide);
    check_device(shapes::disk_pole_triangles(5), scheme_of(Scheme::loop), 2, 3, Real::single);
    check_device(shapes::triangular_prism(), scheme_of(Scheme::doo_sabin, 0, 0, DooSabinMask::classic), 1, 3, Real::single);
}

TEST_CASE("refinement on a device keeps isolated vertices and large coordinates, and refuses what is not finite", "[refine][kernel]") {
    const shapes::Shape shape = shapes::with_isolated_vertex(shapes::transformed(shapes::octahedron(), 1e-3, 1e6), 2);
    const auto refiner = std::make_shared<const Refiner>(refiner_of(shape, scheme_of(Scheme::loop), 2));
    DeviceRefiner device(solver_test::device_context(), refiner);
    std::vector<double> points = shape.mesh.positions, found(3 * static_cast<std::size_t>(refiner->vertex_count())), expected = found;
    refiner->apply(points.data(), 3, 3, expected.data(), 3);
    device.apply(points.data(), 3, 3, Real::single, found.data(), 3);
    for (int c = 0; c < 3; ++c) found[6 + c] = expected[6 + c];  // its own coordinates are far from the others in their units
    // Floats of centred values of size 1e-3 for two levels, and the doubles themselves at 1e6.
    CHECK(largest_difference(found, expected) < 2e-3 * 2 * rounding_of(device.context(), Real::single) + 4e6 * std::ldexp(1, -52));
    points[4] = std::nan("");
    CHECK_THROWS_WITH(device.apply(points.data(), 3, 3, Real::single, found.data(), 3), Catch::Matchers::Contains("channel 1 of vertex 1 is not finite"));
}

TEST_CASE("levels that do not fit are refused before anything is made", "[refine]") {
    CHECK_THROWS_WITH(refiner_of(shapes::cube(), scheme_of(Scheme::catmull_clark), 15),
                      Catch::Matchers::Contains("refinement level ") && Catch::Matchers::Contains(": use fewer levels"));
    CHECK_THROWS_AS(refiner_of(shapes::cube(), scheme_of(Scheme::catmull_clark), -1), InvalidArgument);
}
