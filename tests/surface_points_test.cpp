// SPDX-License-Identifier: BSD-3-Clause
// Surfaces from point clouds: simplification, points that become vertices, and the whole fit, on clouds whose true distance is known. The triangulations are
// those of the samplings, so no engine library is needed; engines_test has those.
#include "host/points/surface.h"

#include <cmath>
#include <numeric>

#include "host/points/insert.h"
#include "host/points/simplify.h"
#include "tests/capi_support.h"
#include "tests/shapes/clouds.h"

using namespace capi_test;
using Catch::Matchers::Contains;

namespace {

struct CloudRelease {
    void operator()(lcl_cloud cloud) const { lcl_cloud_release(cloud); }
};
using Cloud = std::unique_ptr<lcl_cloud_s, CloudRelease>;

Cloud make_cloud(const shapes::Shape& shape) {
    lcl_cloud cloud = nullptr;
    succeed(lcl_cloud_create(static_cast<std::size_t>(shape.mesh.vertex_count), shape.mesh.positions.data(), 0, nullptr, 0, &cloud));
    return Cloud(cloud);
}

struct Fitted {
    lcl_status status = LCL_OK;
    Mesh mesh;
    lcl_surface_report report = LCL_SURFACE_REPORT_INIT;
};

Fitted fit(const shapes::Shape& shape, const lcl_engine& engine, const lcl_surface_options& options, lcl_scheme which = LCL_SCHEME_DEFAULT) {
    Fitted out;
    const lcl_scheme_options options_of_scheme = scheme(which);
    lcl_mesh mesh = nullptr;
    out.status = lcl_surface(default_context(), make_cloud(shape).get(), &engine, &options_of_scheme, &options, &mesh, &out.report);
    out.mesh = Mesh(mesh);
    return out;
}

Fitted fit(const shapes::Shape& shape, const lcl_surface_options& options, lcl_scheme which = LCL_SCHEME_DEFAULT) {
    return fit(shape, shapes::KnownEngine(shape).engine(), options, which);
}

lcl_surface_options tolerance(double value) {
    lcl_surface_options options = LCL_SURFACE_OPTIONS_INIT;
    options.tolerance = value;
    return options;
}

/// Distances of the points to the mesh's limit surface, by a search of its own.
std::vector<double> distances(lcl_mesh mesh, const std::vector<double>& points, lcl_scheme which = LCL_SCHEME_DOO_SABIN) {
    const lcl_scheme_options options = scheme(which);
    lcl_limit_surface handle = nullptr;
    succeed(lcl_limit_surface_create(default_context(), mesh, &options, LCL_PRECISION_DOUBLE, &handle));
    const LimitSurface surface(handle);
    std::vector<double> out(points.size() / 3);
    lcl_closest_points closest = LCL_CLOSEST_POINTS_INIT;
    closest.distances = out.data();
    succeed(lcl_limit_surface_closest(surface.get(), out.size(), points.data(), 0, &closest));
    for (double& distance : out) distance = std::fabs(distance);
    return out;
}

/// Largest distance of the limit surface, sampled at its refined mesh, from the true shape.
double largest_error(lcl_mesh mesh, const shapes::SampledShape& truth, lcl_scheme which = LCL_SCHEME_DOO_SABIN) {
    const lcl_scheme_options options = scheme(which);
    lcl_refine_options refine = LCL_REFINE_OPTIONS_INIT;
    refine.levels = 2;
    lcl_mesh refined = nullptr;
    succeed(lcl_mesh_refine(mesh, &options, &refine, &refined));
    const Mesh owner(refined);
    std::vector<double> points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(refined)));
    succeed(lcl_mesh_get_points(refined, points.data(), 0));
    succeed(lcl_limit_points(make_operator(default_context(), refined, &options).get(), points.data(), 0, 3, LCL_PRECISION_DOUBLE, points.data(), 0));
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); i += 3) largest = std::max(largest, std::fabs(truth.distance({points[i], points[i + 1], points[i + 2]})));
    return largest;
}

lcl_mesh_info info_of(lcl_mesh mesh) {
    lcl_mesh_info info = LCL_MESH_INFO_INIT;
    succeed(lcl_mesh_get_info(mesh, &info));
    return info;
}

int euler(const lcl_mesh_info& info) { return info.vertices - info.edges + info.faces; }

lcl::FitMesh fit_mesh_of(const shapes::Shape& shape) {
    std::vector<lcl::Index> source(static_cast<std::size_t>(shape.mesh.vertex_count));
    std::iota(source.begin(), source.end(), 0);
    return lcl::fit_mesh(shape.mesh, source);
}

}  // namespace

TEST_CASE("simplification keeps every point within the tolerance, and the vertices it leaves where they were", "[simplify]") {
    const double allowed = 0.01;
    for (const shapes::SampledShape& cloud : {shapes::sphere_cloud(4), shapes::wave_cloud(30), shapes::rounded_box_cloud(14, 0.3)}) {
        lcl::FitMesh mesh = fit_mesh_of(cloud.shape);
        lcl::SimplifyOptions options;
        options.tolerance = allowed;
        lcl::simplify(mesh, options);
        const lcl::PolygonMesh out = lcl::polygon_mesh(mesh);
        CAPTURE(cloud.shape.name, out.vertex_count);
        CHECK(out.vertex_count < cloud.shape.mesh.vertex_count / 2);
        const lcl::Topology before = lcl::build_topology(cloud.shape.mesh), after = lcl::build_topology(out);
        CHECK(after.vertex_count - after.edge_count + after.face_count == before.vertex_count - before.edge_count + before.face_count);
        CHECK(lcl::boundary_loops(after).size() == lcl::boundary_loops(before).size());
        for (const OpenMesh::VertexHandle v : mesh.vertices())
            for (int c = 0; c < 3; ++c) CHECK(mesh.point(v)[c] == cloud.shape.mesh.positions[3 * static_cast<std::size_t>(mesh.data(v).source) + c]);
        // Distances to the triangles: the limit surface of corners alone is the polyhedron itself.
        shapes::Shape polyhedron{"polyhedron", out, {}};
        for (lcl::Index v = 0; v < out.vertex_count; ++v) polyhedron.features.corners.push_back(v);
        for (lcl::Index e = 0; e < after.edge_count; ++e)
            polyhedron.features.creases.push_back({after.origin(after.edge_half_edge[e]), after.destination(after.edge_half_edge[e])});
        const std::vector<double> far = distances(make_mesh(polyhedron).get(), cloud.shape.mesh.positions, LCL_SCHEME_LOOP);
        CHECK(*std::max_element(far.begin(), far.end()) <= allowed * (1 + 1e-6));
    }
}

TEST_CASE("simplification goes on to a number of vertices, and stops on request", "[simplify]") {
    lcl::FitMesh mesh = fit_mesh_of(shapes::sphere_cloud(3).shape);
    lcl::SimplifyOptions options;
    options.tolerance = 1e-9;
    options.max_vertices = 100;
    lcl::simplify(mesh, options);
    CHECK(mesh.n_vertices() == 100);
    CHECK_NOTHROW(lcl::build_topology(lcl::polygon_mesh(mesh)));
    lcl::FitMesh large = fit_mesh_of(shapes::sphere_cloud(5).shape);
    options.tolerance = 0.1;
    options.progress = [](std::size_t) { return false; };
    CHECK_THROWS_AS(lcl::simplify(large, options), lcl::Cancelled);
}

TEST_CASE("far points become vertices inside faces and on edges, and flips keep the mesh sound", "[insert]") {
    const shapes::SampledShape cloud = shapes::sphere_cloud(2);
    lcl::FitMesh mesh = fit_mesh_of(cloud.shape);
    const lcl::PolygonMesh before = lcl::polygon_mesh(mesh);
    std::vector<double> points;
    std::vector<lcl::FarPoint> far;
    for (lcl::Index f = 0; f < before.face_count(); f += 7) {
        const bool on_edge = f % 2 == 0;
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (int k = 0; k < (on_edge ? 2 : 3); ++k)
                sum += before.positions[3 * static_cast<std::size_t>(before.face_vertices[3 * static_cast<std::size_t>(f) + k]) + c];
            points.push_back(1.02 * sum / (on_edge ? 2 : 3));
        }
        far.push_back({static_cast<lcl::Index>(far.size()), f, 0.02 + f});
    }
    const std::size_t inserted = lcl::insert_points(mesh, far, points, {});
    CHECK(inserted > far.size() / 2);  // some are next to others
    const lcl::Topology after = lcl::build_topology(lcl::polygon_mesh(mesh));
    CHECK(after.is_closed());
    CHECK(after.vertex_count - after.edge_count + after.face_count == 2);
    CHECK(after.vertex_count == before.vertex_count + static_cast<lcl::Index>(inserted));
    for (std::size_t v = static_cast<std::size_t>(before.vertex_count); v < mesh.n_vertices(); ++v) {
        const OpenMesh::VertexHandle vertex(static_cast<int>(v));
        const auto from = 3 * static_cast<std::size_t>(mesh.data(vertex).source);
        CHECK(mesh.point(vertex) == lcl::FitMesh::Point(points[from], points[from + 1], points[from + 2]));
    }
    // A point far off would turn normals too much: it stays out until that is allowed.
    const std::vector<double> spike = {3 * points[0], 3 * points[1], 3 * points[2]};
    CHECK(lcl::insert_points(mesh, {{0, 3, 2.0}}, spike, {}) == 0);
    lcl::InsertOptions any;
    any.most_turn_degrees = 175;
    CHECK(lcl::insert_points(mesh, {{0, 3, 2.0}}, spike, any) == 1);
    any.max_vertices = mesh.n_vertices();
    CHECK(lcl::insert_points(mesh, {{0, 3, 2.0}}, {2, 2, 2}, any) == 0);
}

TEST_CASE("the limit surface passes within the tolerance of every point and near the true shape", "[points]") {
    const lcl_scheme which = GENERATE(LCL_SCHEME_DOO_SABIN, LCL_SCHEME_CATMULL_CLARK, LCL_SCHEME_LOOP);
    struct Case {
        shapes::SampledShape cloud;
        int euler, loops;
    };
    for (const Case& c : {Case{shapes::sphere_cloud(4), 2, 0}, Case{shapes::torus_cloud(60, 24), 0, 0}, Case{shapes::blend_cloud(40, 40), 2, 0},
                          Case{shapes::wave_cloud(30), 1, 1}, Case{shapes::rounded_box_cloud(14, 0.3), 2, 0}}) {
        const Fitted found = fit(c.cloud.shape, tolerance(2e-3), which);
        CAPTURE(c.cloud.shape.name, which, found.report.simplified_vertices, found.report.vertices, found.report.rounds);
        REQUIRE(found.status == LCL_OK);
        const double allowed = 2e-3 * found.report.diagonal;
        CHECK(found.report.converged == 1);
        CHECK(found.report.max <= allowed);
        CHECK(found.report.rms <= found.report.max);
        CHECK(found.report.p95 <= found.report.max);
        CHECK(found.report.outside_count == 0);
        CHECK(found.report.point_count == c.cloud.shape.mesh.vertex_count);
        CHECK(found.report.interpolation_error <= 1e-6 * found.report.diagonal);
        const std::vector<double> far = distances(found.mesh.get(), c.cloud.shape.mesh.positions, which);
        CHECK(*std::max_element(far.begin(), far.end()) <= allowed * (1 + 1e-6));
        CHECK(largest_error(found.mesh.get(), c.cloud, which) <= 6 * allowed);  // between the points it is theirs plus what a face bends
        const lcl_mesh_info info = info_of(found.mesh.get());
        CHECK(info.vertices == found.report.vertices);
        CHECK(info.vertices < c.cloud.shape.mesh.vertex_count);
        CHECK(euler(info) == c.euler);
        CHECK(info.boundary_loops == c.loops);
        CHECK(info.components == 1);
    }
}

TEST_CASE("as many vertices as are allowed: the fit says what it reached", "[points]") {
    const shapes::SampledShape cloud = shapes::blend_cloud(40, 40);
    lcl_surface_options options = tolerance(1e-4);
    options.max_vertices = 120;
    const Fitted few = fit(cloud.shape, options);
    CHECK(few.status == LCL_OK);
    CHECK(few.report.converged == 0);
    CHECK(few.report.vertices <= 120);
    CHECK(few.report.vertices > 100);
    CHECK(few.report.outside_count > 0);
    CHECK_THAT(few.report.message, Contains("120 vertices, as many as are allowed"));
    const std::vector<double> far = distances(few.mesh.get(), cloud.shape.mesh.positions);
    CHECK(*std::max_element(far.begin(), far.end()) == Approx(few.report.max).epsilon(1e-3));
    options.max_vertices = 480;
    const Fitted more = fit(cloud.shape, options);
    CHECK(more.report.max < few.report.max / 2);
}

TEST_CASE("a bound of the vertices that is not reached changes nothing", "[points]") {
    const shapes::SampledShape cloud = shapes::torus_cloud(60, 24);
    lcl_surface_options options = tolerance(2e-3);
    const Fitted free = fit(cloud.shape, options);
    options.max_vertices = 100000;
    const Fitted bounded = fit(cloud.shape, options);
    CHECK(bounded.report.converged == 1);
    CHECK(bounded.report.vertices == free.report.vertices);
    CHECK(bounded.report.simplified_vertices == free.report.simplified_vertices);
}

TEST_CASE("all parts of a cloud are kept", "[points]") {
    const shapes::Shape both = shapes::two_parts(shapes::sphere_cloud(3).shape, shapes::torus_cloud(30, 14).shape, {3, 0, 0.5});
    const Fitted found = fit(both, tolerance(3e-3));
    REQUIRE(found.status == LCL_OK);
    CHECK(found.report.components == 2);
    const lcl_mesh_info info = info_of(found.mesh.get());
    CHECK(info.components == 2);
    CHECK(euler(info) == 2 + 0);
    CHECK(info.boundary_edges == 0);
}

TEST_CASE("creases by angle keep the edges of a box sharp", "[points]") {
    const shapes::SampledShape box = shapes::rounded_box_cloud(13, 0);
    lcl_surface_options options = tolerance(2e-3);
    options.max_vertices = 200;
    const Fitted smooth = fit(box.shape, options);
    options.crease_angle_degrees = 40;
    const Fitted sharp = fit(box.shape, options);
    REQUIRE(sharp.status == LCL_OK);
    CHECK(smooth.report.creases == 0);
    CHECK(sharp.report.creases >= 12);
    CHECK(sharp.report.converged == 1);
    CHECK(sharp.report.vertices < smooth.report.vertices);
    const double sharp_error = largest_error(sharp.mesh.get(), box), smooth_error = largest_error(smooth.mesh.get(), box);
    CHECK(sharp_error < 0.5 * smooth_error);
    // Every crease runs along an edge: both ends lie on two faces of the box.
    std::vector<int32_t> creases(2 * static_cast<std::size_t>(sharp.report.creases));
    std::vector<double> limit(3 * static_cast<std::size_t>(sharp.report.vertices));
    succeed(lcl_mesh_get_features(sharp.mesh.get(), nullptr, creases.data(), nullptr, nullptr, nullptr));
    succeed(lcl_mesh_get_points(sharp.mesh.get(), limit.data(), 0));
    const lcl_scheme_options doo_sabin = scheme(LCL_SCHEME_DOO_SABIN);
    succeed(lcl_limit_points(make_operator(default_context(), sharp.mesh.get(), &doo_sabin).get(), limit.data(), 0, 3, LCL_PRECISION_DOUBLE, limit.data(), 0));
    for (const int32_t vertex : creases) {
        int faces = 0;
        for (int c = 0; c < 3; ++c) faces += std::fabs(std::fabs(limit[3 * static_cast<std::size_t>(vertex) + c]) - 1) < 1e-5;
        CHECK(faces >= 2);
    }
}

TEST_CASE("holes are filled on request", "[points]") {
    const shapes::SampledShape cloud = shapes::sphere_cloud(3);
    shapes::KnownEngine engine(cloud.shape);
    engine.triangles.erase(engine.triangles.begin(), engine.triangles.begin() + 3);
    const Fitted open = fit(cloud.shape, engine.engine(), tolerance(3e-3));
    CHECK(open.report.boundary_loops == 1);
    lcl_surface_options options = tolerance(3e-3);
    options.fill_holes = 3;
    const Fitted closed = fit(cloud.shape, engine.engine(), options);
    CHECK(closed.report.filled_holes == 1);
    CHECK(closed.report.boundary_loops == 0);
    CHECK(info_of(closed.mesh.get()).boundary_edges == 0);
}

TEST_CASE("duplicates and outliers are counted and not measured", "[points]") {
    shapes::Shape shape = shapes::sphere_cloud(3).shape;
    shapes::KnownEngine engine(shape);
    const lcl::Index count = shape.mesh.vertex_count;
    std::vector<double>& points = shape.mesh.positions;
    points.insert(points.end(), {9, 9, 9});
    for (int i = 0; i < 5; ++i) points.insert(points.end(), {points[0], points[1], points[2]});
    shape.mesh.vertex_count += 6;
    engine.outliers = {count};
    const Fitted found = fit(shape, engine.engine(), tolerance(3e-3));
    REQUIRE(found.status == LCL_OK);
    CHECK(found.report.duplicate_count == 5);
    CHECK(found.report.left_out_count == 1);
    CHECK(found.report.unused_count == 0);
    CHECK(found.report.point_count == count);
    CHECK(found.report.diagonal == Approx(2 * std::sqrt(3.0)).epsilon(0.02));  // of the vertices, without the outlier
}

TEST_CASE("points that the approximation left off become vertices too", "[points]") {
    const shapes::SampledShape cloud = shapes::sphere_cloud(3);
    shapes::Shape shape = cloud.shape;
    shapes::KnownEngine engine(shape);
    shape.mesh.positions.insert(shape.mesh.positions.end(), {1.2, 0.1, 0.05});
    ++shape.mesh.vertex_count;
    const Fitted found = fit(shape, engine.engine(), tolerance(3e-3));
    REQUIRE(found.status == LCL_OK);
    CHECK(found.report.unused_count == 1);
    CHECK(found.report.converged == 1);
    CHECK(distances(found.mesh.get(), {1.2, 0.1, 0.05})[0] <= 3e-3 * found.report.diagonal);
}

TEST_CASE("an engine's own vertices and colours of the cloud", "[points]") {
    const shapes::SampledShape cloud = shapes::sphere_cloud(3);
    shapes::KnownEngine engine(shapes::sphere_cloud(2).shape);
    engine.own_points = shapes::sphere_cloud(2).shape.mesh.positions;
    for (double& value : engine.own_points) value *= 0.999;
    std::string text;  // as a file has them: coordinates and colours
    for (const shapes::Point& p : shapes::points_of(cloud.shape.mesh)) {
        for (const double coordinate : p) text += std::to_string(coordinate) + " ";
        text += p[0] > 0 ? "255 128 0\n" : "0 128 0\n";
    }
    lcl_cloud colourful = nullptr;
    succeed(lcl_cloud_read_memory(text.data(), text.size(), LCL_FORMAT_XYZ, "colourful", &colourful));
    const Cloud owner(colourful);
    const lcl_surface_options options = tolerance(3e-3);
    lcl_mesh handle = nullptr;
    lcl_surface_report report = LCL_SURFACE_REPORT_INIT;
    succeed(lcl_surface(default_context(), colourful, &engine.engine(), nullptr, &options, &handle, &report));
    const Mesh mesh(handle);
    CHECK(report.max <= 3e-3 * report.diagonal);
    REQUIRE(lcl_mesh_property_count(handle) == 3);
    std::vector<double> red(static_cast<std::size_t>(report.vertices)), points(3 * red.size());
    succeed(lcl_mesh_get_property(handle, 0, red.data()));
    succeed(lcl_mesh_get_points(handle, points.data(), 0));
    const double red_of_full = *std::max_element(red.begin(), red.end());
    CHECK(red_of_full > 0);
    for (std::size_t v = 0; v < red.size(); ++v)
        if (std::fabs(points[3 * v]) > 0.2) CHECK(red[v] == (points[3 * v] > 0 ? red_of_full : 0.0));
}

TEST_CASE("least squares see through noise that interpolation follows", "[points]") {
    shapes::SampledShape cloud = shapes::sphere_cloud(4);
    shapes::add_noise(cloud.shape, 0.02, 5);
    lcl_surface_options options = tolerance(1e-3);
    options.max_vertices = 200;
    const Fitted through = fit(cloud.shape, options, LCL_SCHEME_LOOP);
    options.fit = LCL_FIT_LEAST_SQUARES;
    const Fitted near = fit(cloud.shape, options, LCL_SCHEME_LOOP);
    REQUIRE(near.status == LCL_OK);
    CHECK(near.report.vertices <= 200);
    CHECK(near.report.rms < 0.012);
    CHECK(near.report.rms < through.report.rms);
    CHECK(std::isnan(near.report.interpolation_error));
    CHECK(largest_error(near.mesh.get(), cloud, LCL_SCHEME_LOOP) < 0.01);
    CHECK(largest_error(through.mesh.get(), cloud, LCL_SCHEME_LOOP) > 0.01);
}

TEST_CASE("what cannot become a surface fails in one sentence", "[points]") {
    const shapes::Shape shape = shapes::sphere_cloud(2).shape;
    shapes::KnownEngine known(shape);
    const auto failure = [&](lcl_status status, const lcl_surface_options& options) {
        CHECK(fit(shape, known.engine(), options).status == status);
        return std::string(lcl_last_error());
    };
    lcl_surface_options options = LCL_SURFACE_OPTIONS_INIT;
    lcl_engine_option pair = {"fail", "1"};
    options.engine_options = &pair;
    options.engine_option_count = 1;
    CHECK_THAT(failure(LCL_ERROR_BAD_INPUT, options), Contains("engine known: it was told to fail"));
    pair = {"colour", "red"};
    CHECK_THAT(failure(LCL_ERROR_INVALID_ARGUMENT, options), Contains("there is no such option"));
    pair = {"key", "1"};
    CHECK(fit(shape, known.engine(), options).status == LCL_OK);
    CHECK(known.seen_options == "key=1;");
    CHECK_THAT(failure(LCL_ERROR_INVALID_ARGUMENT, tolerance(-1)), Contains("options.tolerance"));
    options = LCL_SURFACE_OPTIONS_INIT;
    options.max_vertices = 3;
    CHECK_THAT(failure(LCL_ERROR_INVALID_ARGUMENT, options), Contains("options.max_vertices"));
    options = LCL_SURFACE_OPTIONS_INIT;
    options.progress = [](void*, lcl_surface_phase phase, int32_t, double, double) { return static_cast<int32_t>(phase != LCL_SURFACE_MEASURE); };
    failure(LCL_ERROR_CANCELLED, options);
    known.triangles[0] = 1 << 20;
    CHECK_THAT(failure(LCL_ERROR_INTERNAL, LCL_SURFACE_OPTIONS_INIT), Contains("engine known is defective: triangle 0 uses vertex 1048576"));
    known.triangles.clear();
    CHECK_THAT(failure(LCL_ERROR_BAD_INPUT, LCL_SURFACE_OPTIONS_INIT), Contains("found no surface"));
}

TEST_CASE("the phases of a fit are told", "[points]") {
    struct Seen {
        bool phases[5] = {};
        double last = NAN;
    } seen;
    lcl_surface_options options = tolerance(2e-3);
    options.progress_user = &seen;
    options.progress = [](void* user, lcl_surface_phase phase, int32_t round, double fraction, double max_distance) {
        Seen& all = *static_cast<Seen*>(user);
        all.phases[phase] = true;
        CHECK(fraction <= 1);
        CHECK(std::isnan(max_distance) == (round == 0));
        all.last = max_distance;
        return int32_t{1};
    };
    const Fitted found = fit(shapes::torus_cloud(60, 24).shape, options);
    CHECK(found.report.rounds > 1);
    for (const bool was_told : seen.phases) CHECK(was_told);
    CHECK(seen.last > 0);
}
