// SPDX-License-Identifier: BSD-3-Clause
// Textures through the C API: the mesh that is given out, its noise and colours, options that are refused, and every status. The values themselves:
// texture_test.
#include <array>
#include <functional>
#include <limits>
#include <set>

#include "host/filter/colour_curve.h"
#include "tests/capi_support.h"
#include "tests/io_support.h"

using namespace capi_test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

struct Textured {
    Mesh mesh;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    lcl_status status;

    Textured(lcl_mesh from, const lcl_scheme_options* scheme, const lcl_texture_options& options) {
        lcl_mesh out = nullptr;
        status = lcl_texture(default_context(), from, scheme, &options, &out, &report);
        mesh = Mesh(out);
    }
};

lcl_texture_options texture_options(int32_t octaves, int32_t levels = 0) {
    lcl_texture_options options = LCL_TEXTURE_OPTIONS_INIT;
    options.octaves = octaves;
    options.levels = levels;
    return options;
}

Textured texture(const Mesh& mesh, const lcl_texture_options& options, const lcl_scheme_options* scheme = nullptr) {
    Textured textured(mesh.get(), scheme, options);
    succeed(textured.status);
    REQUIRE(textured.mesh);
    return textured;
}

std::vector<std::string> property_names(lcl_mesh mesh) {
    std::vector<std::string> names;
    for (int32_t i = 0; i < lcl_mesh_property_count(mesh); ++i) names.emplace_back(lcl_mesh_property_name(mesh, i));
    return names;
}

std::vector<double> property(lcl_mesh mesh, const std::string& name) {
    const std::vector<std::string> names = property_names(mesh);
    const auto found = std::find(names.begin(), names.end(), name);
    REQUIRE(found != names.end());
    std::vector<double> values(static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    succeed(lcl_mesh_get_property(mesh, static_cast<int32_t>(found - names.begin()), values.data()));
    return values;
}

std::vector<double> points_of(lcl_mesh mesh) {
    std::vector<double> points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    succeed(lcl_mesh_get_points(mesh, points.data(), 0));
    return points;
}

std::vector<int32_t> faces_of(lcl_mesh mesh) {
    std::vector<int32_t> faces(static_cast<std::size_t>(lcl_mesh_corner_count(mesh)));
    succeed(lcl_mesh_get_faces(mesh, nullptr, faces.data()));
    return faces;
}

Mesh refined(lcl_mesh mesh, int32_t levels, const lcl_scheme_options* scheme) {
    lcl_refine_options options = LCL_REFINE_OPTIONS_INIT;
    options.levels = levels;
    lcl_mesh out = nullptr;
    succeed(lcl_mesh_refine(mesh, scheme, &options, &out));
    return Mesh(out);
}

Mesh read_text(const std::string& text, lcl_format format) {
    lcl_mesh mesh = nullptr;
    succeed(lcl_mesh_read_memory(text.data(), text.size(), format, "text", &mesh));
    return Mesh(mesh);
}

std::string written(lcl_mesh mesh, const std::string& name) {
    const io_test::TemporaryFolder folder;
    succeed(lcl_mesh_write(mesh, folder.file(name).c_str(), LCL_FORMAT_BY_ENDING));
    return io_test::file_bytes(folder.file(name));
}

}  // namespace

TEST_CASE("a texture comes on the refined mesh at its limit points", "[texture][capi]") {
    const lcl_scheme_options options = GENERATE(scheme(LCL_SCHEME_CATMULL_CLARK, 0.3), scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.4), scheme(LCL_SCHEME_DOO_SABIN));
    const Mesh mesh = make_mesh(shapes::rough(shapes::grid_with_creases(), 0.1, 1));
    const Textured textured = texture(mesh, texture_options(2, 2), &options);
    const Mesh fine = refined(mesh.get(), 2, &options);
    CHECK(faces_of(textured.mesh.get()) == faces_of(fine.get()));
    const lcl_scheme_options rest = scheme(options.scheme);
    std::vector<double> limit = points_of(fine.get());
    succeed(lcl_limit_points(make_operator(default_context(), fine.get(), &rest).get(), limit.data(), 0, 3, LCL_PRECISION_MIXED, limit.data(), 0));
    CHECK(largest_difference(points_of(textured.mesh.get()), limit) <= 1e-13);  // coordinates of a few units; steps are rounded in another order
    std::size_t creases = 0, corners = 0, fine_creases = 0, fine_corners = 0;
    succeed(lcl_mesh_get_features(textured.mesh.get(), nullptr, nullptr, &creases, nullptr, &corners));
    succeed(lcl_mesh_get_features(fine.get(), nullptr, nullptr, &fine_creases, nullptr, &fine_corners));
    CHECK((creases == fine_creases && corners == fine_corners));
    CHECK(textured.report.converged == 1);
    CHECK(textured.report.iterations > 0);
}

TEST_CASE("the defaults of a texture are four octaves and three levels, and are marble", "[texture][capi]") {
    const Mesh mesh = make_mesh(shapes::rough(shapes::octahedron(), 0.1, 1));
    lcl_mesh raw = nullptr;
    succeed(lcl_texture(default_context(), mesh.get(), nullptr, nullptr, &raw, nullptr));
    const Mesh textured(raw);
    CHECK(lcl_mesh_vertex_count(textured.get()) == 4 * 4 * 4 * 4 + 2);
    lcl_texture_options options = texture_options(4, 3);
    options.frequency = 8;
    options.tolerance = 1e-6;
    options.max_iterations = 200;
    CHECK(property(texture(mesh, options).mesh.get(), "noise") == property(textured.get(), "noise"));
    CHECK(property_names(textured.get()) == std::vector<std::string>{"noise", "red", "green", "blue"});
    const std::set<double> reds = [&] {
        const std::vector<double> values = property(textured.get(), "red");
        return std::set<double>(values.begin(), values.end());
    }();
    CHECK(*reds.begin() == 41);    // 0.16
    CHECK(*reds.rbegin() == 250);  // 0.98
    CHECK(reds.size() > 30);
    options.octaves = 3;  // fewer octaves on the same mesh, and more levels than needed
    CHECK(property(texture(mesh, options).mesh.get(), "noise") != property(textured.get(), "noise"));
}

TEST_CASE("colours are the curve through the given ones at the noise, in 8 bits", "[texture][capi]") {
    const std::vector<lcl::Colour> colours{{1, 0, 0}, {1, 1, 0}, {0, 0.5, 1}, {0.2, 0.2, 0.2}};
    lcl_texture_options options = texture_options(2, 3);
    options.colours = colours[0].data();
    options.colour_count = colours.size();
    const Textured textured = texture(make_mesh(shapes::rough(shapes::octahedron(), 0.1, 1)), options);
    const std::vector<double> t = property(textured.mesh.get(), "noise");
    const lcl::ColourCurve curve(colours);
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<double> values = property(textured.mesh.get(), c == 0 ? "red" : c == 1 ? "green" : "blue");
        for (std::size_t v = 0; v < t.size(); ++v) CHECK(values[v] == std::round(255 * curve.at(t[v])[c]));
    }
    for (int32_t i = 1; i <= 3; ++i) CHECK(lcl_mesh_property_is_colour(textured.mesh.get(), i) == 1);
    CHECK(lcl_mesh_property_is_colour(textured.mesh.get(), 0) == 0);
    options.colour_count = 1;
    const std::vector<double> green = property(texture(make_mesh(shapes::octahedron()), options).mesh.get(), "green");
    CHECK(std::all_of(green.begin(), green.end(), [](double value) { return value == 0; }));
}

TEST_CASE("textures are written as files have colours", "[texture][capi][io]") {
    const Textured textured = texture(make_mesh(shapes::octahedron()), texture_options(1, 1));
    const std::string ply = written(textured.mesh.get(), "a.ply"), obj = written(textured.mesh.get(), "a.obj");
    CHECK_THAT(ply, Catch::Matchers::Contains("property double z\nproperty double noise\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"));
    std::istringstream lines(obj);
    int rows = 0;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string keyword;
        words >> keyword;
        if (keyword != "v") continue;
        std::vector<double> numbers{std::istream_iterator<double>(words), {}};
        REQUIRE(numbers.size() == 6);
        for (std::size_t c = 3; c < 6; ++c) CHECK((numbers[c] >= 0.16 - 1.0 / 510 && numbers[c] <= 0.98 + 1.0 / 510));  // of marble, rounded to 8 bits
        ++rows;
    }
    CHECK(rows == 18);
}

TEST_CASE("colours and noise of the input are replaced, other properties follow the surface", "[texture][capi]") {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nproperty uchar alpha\nproperty short level\nproperty double noise\nproperty double heat\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const Mesh mesh =
        read_text(head + "0 0 0 1 2 3 100 10 7 0\n1 0 0 1 2 3 200 20 7 1\n1 1 0 1 2 3 100 11 7 nan\n0 1 0 1 2 3 200 20 7 3\n4 0 1 2 3\n", LCL_FORMAT_PLY);
    const Textured textured = texture(mesh, texture_options(1, 1));
    CHECK(property_names(textured.mesh.get()) == std::vector<std::string>{"alpha", "level", "heat", "noise", "red", "green", "blue"});
    CHECK(written(textured.mesh.get(), "a.ply").substr(0, 400).find("property short level\nproperty double heat\nproperty double noise\nproperty uchar red") !=
          std::string::npos);
    const std::vector<double> alpha = property(textured.mesh.get(), "alpha"), level = property(textured.mesh.get(), "level"),
                              heat = property(textured.mesh.get(), "heat"), points = points_of(textured.mesh.get());
    REQUIRE(alpha.size() == 9);
    CHECK((alpha[0] == 100 && alpha[1] == 200 && level[0] == 10 && heat[0] == 0 && heat[3] == 3));  // corners stay
    // Rows of the limit: (L + 4 V + R)/6 at the middle of an edge between corners a and b, V = (a + b)/2, which is V again; the mean of all in the middle of
    // the face, and 25/2 and 61/4 are rounded.
    CHECK((alpha[4] == 150 && level[4] == 15 && alpha[8] == 150 && level[8] == 15));
    CHECK(heat[4] == Approx(0.5));
    CHECK(std::isnan(heat[8]));
    for (const double t : property(textured.mesh.get(), "noise")) CHECK((t >= 0 && t <= 1));
    CHECK(lcl_mesh_property_is_colour(textured.mesh.get(), 0) == 1);
}

TEST_CASE("texture coordinates and materials are dropped with notes where the mesh is refined", "[texture][capi]") {
    const Mesh mesh = read_text("v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 1 1 0 1 1 1\nv 0 1 0 1 1 1\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1 4/1\n", LCL_FORMAT_OBJ);
    const Textured fine = texture(mesh, texture_options(1, 1)), same = texture(mesh, texture_options(1));
    REQUIRE(lcl_mesh_note_count(fine.mesh.get(), LCL_NOTE_WARNING) == 2);
    CHECK_THAT(lcl_mesh_note(fine.mesh.get(), LCL_NOTE_WARNING, 0), Catch::Matchers::Contains("texture coordinates"));
    CHECK_THAT(lcl_mesh_note(fine.mesh.get(), LCL_NOTE_WARNING, 1), Catch::Matchers::Contains("materials"));
    CHECK(lcl_mesh_note_count(same.mesh.get(), LCL_NOTE_WARNING) == 0);
    CHECK_THAT(written(same.mesh.get(), "a.obj"), Catch::Matchers::Contains("usemtl m\nf 1/1 2/1 3/1 4/1"));
}

TEST_CASE("seeds make different textures, the same one the same", "[texture][capi]") {
    const Mesh mesh = make_mesh(shapes::rough(shapes::torus_quads(5, 4), 0.1, 1));
    lcl_texture_options options = texture_options(2);
    const std::vector<double> zero = property(texture(mesh, options).mesh.get(), "noise");
    CHECK(property(texture(mesh, options).mesh.get(), "noise") == zero);
    options.seed = 1;
    CHECK(property(texture(mesh, options).mesh.get(), "noise") != zero);
    options.seed = 0;
    options.frequency = 7.5;
    CHECK(property(texture(mesh, options).mesh.get(), "noise") != zero);
}

TEST_CASE("the mesh's own colours are those of its vertices, which come first", "[texture][capi]") {
    const Mesh mesh = make_mesh(shapes::rough(shapes::torus_quads(5, 4), 0.1, 1));
    const Textured textured = texture(mesh, texture_options(2));
    std::vector<double> limit = points_of(mesh.get()), points = points_of(textured.mesh.get());
    succeed(lcl_limit_points(make_operator(default_context(), mesh.get()).get(), limit.data(), 0, 3, LCL_PRECISION_MIXED, limit.data(), 0));
    points.resize(limit.size());
    CHECK(largest_difference(points, limit) <= 1e-14);
}

TEST_CASE("texture options that make no sense are refused in a sentence", "[texture][capi]") {
    const Mesh mesh = make_mesh(shapes::octahedron());
    const std::vector<double> colours{0, 0.5, 1, 0, 0.5, 1.25};
    struct Refused {
        const char* part;
        std::function<void(lcl_texture_options&)> change;
    };
    const Refused all[] = {
        {"options.octaves is 21, it goes from 1 to 20", [](auto& o) { o.octaves = 21; }},
        {"options.octaves is -1", [](auto& o) { o.octaves = -1; }},
        {"options.levels is 2, and 4 octaves need at least 3", [](auto& o) { o.levels = 2; }},
        {"options.levels is -1", [](auto& o) { o.octaves = 1, o.levels = -1; }},
        {"options.frequency is -8", [](auto& o) { o.frequency = -8; }},
        {"options.frequency is nan", [](auto& o) { o.frequency = not_a_number; }},
        {"options.frequency is inf", [](auto& o) { o.frequency = infinity; }},
        {"octave 3 would have 8000000000", [](auto& o) { o.frequency = 1e9; }},
        {"options.tolerance is -1", [](auto& o) { o.tolerance = -1; }},
        {"options.tolerance is nan", [](auto& o) { o.tolerance = not_a_number; }},
        {"options.max_iterations is -5", [](auto& o) { o.max_iterations = -5; }},
        {"precision is 3", [](auto& o) { o.precision = static_cast<lcl_precision>(3); }},
        {"the list of colours is empty", [&](auto& o) { o.colours = colours.data(); }},
        {"options.colours is NULL", [](auto& o) { o.colour_count = 2; }},
        {"component 2 of colour 1 is 1.25", [&](auto& o) { o.colours = colours.data(), o.colour_count = 2; }},
    };
    for (const Refused& refused : all) {
        lcl_texture_options options = LCL_TEXTURE_OPTIONS_INIT;
        refused.change(options);
        lcl_mesh out = nullptr;
        refuse(lcl_texture(default_context(), mesh.get(), nullptr, &options, &out, nullptr), LCL_ERROR_INVALID_ARGUMENT, refused.part);
        CHECK(out == nullptr);
    }
}

TEST_CASE("arguments and schemes that do not fit a texture are refused", "[texture][capi]") {
    const Mesh mesh = make_mesh(shapes::octahedron()), quads = make_mesh(shapes::torus_quads(4, 3));
    lcl_mesh out = nullptr;
    lcl_solve_report no_report{};
    lcl_texture_options no_size{};
    const auto call = [&](lcl_context context, lcl_mesh m, const lcl_scheme_options* rules, const lcl_texture_options* options, lcl_mesh* textured,
                          lcl_solve_report* report) { return lcl_texture(context, m, rules, options, textured, report); };
    refuse(call(nullptr, mesh.get(), nullptr, nullptr, &out, nullptr), LCL_ERROR_INVALID_ARGUMENT, "context is NULL");
    refuse(call(default_context(), nullptr, nullptr, nullptr, &out, nullptr), LCL_ERROR_INVALID_ARGUMENT, "mesh is NULL");
    refuse(call(default_context(), mesh.get(), nullptr, nullptr, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "textured is NULL");
    refuse(call(default_context(), mesh.get(), nullptr, &no_size, &out, nullptr), LCL_ERROR_INVALID_ARGUMENT, "options.struct_size is not set");
    refuse(call(default_context(), mesh.get(), nullptr, nullptr, &out, &no_report), LCL_ERROR_INVALID_ARGUMENT, "report.struct_size is not set");
    lcl_scheme_options rules = scheme(LCL_SCHEME_LOOP);
    refuse(call(default_context(), quads.get(), &rules, nullptr, &out, nullptr), LCL_ERROR_BAD_INPUT, "face 0 has 4 sides");
    const int32_t list[] = {0, 8};
    rules = LCL_SCHEME_OPTIONS_INIT;
    rules.owned = list;
    rules.owned_count = 1;
    refuse(call(default_context(), mesh.get(), &rules, nullptr, &out, nullptr), LCL_ERROR_INVALID_ARGUMENT, "scheme.owned is set");
    rules = LCL_SCHEME_OPTIONS_INIT;
    rules.subset = list;
    rules.subset_count = 2;
    refuse(call(default_context(), mesh.get(), &rules, nullptr, &out, nullptr), LCL_ERROR_INVALID_ARGUMENT, "subset names vertex 8");
    const Mesh broken = make_mesh(shapes::edge_with_three_faces().mesh);
    refuse(call(default_context(), broken.get(), nullptr, nullptr, &out, nullptr), LCL_ERROR_BAD_INPUT, "face");
    lcl_texture_options deep = texture_options(4, 40);
    refuse(call(default_context(), mesh.get(), nullptr, &deep, &out, nullptr), LCL_ERROR_MEMORY, "use fewer levels");
    const Mesh huge = make_mesh(shapes::transformed(shapes::octahedron(), 1e308, 0));
    refuse(call(default_context(), huge.get(), nullptr, nullptr, &out, nullptr), LCL_ERROR_BAD_INPUT, "use other units");
    CHECK(out == nullptr);
}

TEST_CASE("a texture tells singular, indefinite and not converged by its status, and is given only if one insists", "[texture][capi]") {
    const Mesh cube = make_mesh(shapes::cube()), split = make_mesh(shapes::cube_split_edges());
    lcl_scheme_options rules = scheme(LCL_SCHEME_CATMULL_CLARK);
    lcl_texture_options options = texture_options(2);
    const auto expect = [&](const Mesh& mesh, lcl_status status, const char* part) {
        options.keep_going = 0;
        const Textured refused(mesh.get(), &rules, options);
        refuse(refused.status, status, part);
        CHECK(!refused.mesh);
        CHECK(std::string(refused.report.message) == lcl_last_error());
        CHECK(refused.report.converged == 0);
        options.keep_going = 1;
        const Textured insisted(mesh.get(), &rules, options);
        refuse(insisted.status, status, part);
        REQUIRE(insisted.mesh);
        for (const double t : property(insisted.mesh.get(), "noise")) CHECK((t >= 0 && t <= 1));
    };
    SECTION("singular") {
        expect(cube, LCL_ERROR_SINGULAR, "octave 0: ");
        CHECK(last_error_vertices() == std::vector<int32_t>{0, 1, 2, 3, 4, 5, 6, 7});
    }
    SECTION("indefinite") { expect(split, LCL_ERROR_INDEFINITE, "octave 0: "); }
    SECTION("not converged") {
        rules.alpha = 0.5;
        options.max_iterations = 1;
        options.tolerance = 1e-9;
        expect(make_mesh(shapes::rough(shapes::icosphere(1), 0.1, 1)), LCL_ERROR_NOT_CONVERGED, "octave");
    }
    SECTION("cured by alpha auto") {
        rules.alpha_auto = 1;
        const Textured textured = texture(cube, options, &rules);
        rules = scheme(LCL_SCHEME_CATMULL_CLARK, 0.5);
        CHECK(property(texture(cube, options, &rules).mesh.get(), "noise") == property(textured.mesh.get(), "noise"));
        rules.alpha_auto = 1;
        refuse(Textured(cube.get(), &rules, options).status, LCL_ERROR_INVALID_ARGUMENT, "choose one");
    }
}

TEST_CASE("a texture tells its progress and can be cancelled", "[texture][capi]") {
    const Mesh mesh = make_mesh(shapes::rough(shapes::icosphere(1), 0.1, 1));
    lcl_texture_options options = texture_options(2);
    struct Calls {
        int count = 0, most = 1 << 30;
    } calls;
    options.progress = [](void* user, int32_t, double residual, double target) -> int32_t {
        CHECK((residual >= 0 && target > 0));
        auto& own = *static_cast<Calls*>(user);
        return ++own.count < own.most;
    };
    options.progress_user = &calls;
    texture(mesh, options);
    CHECK(calls.count >= 2);
    calls = {0, 1};
    const Textured cancelled(mesh.get(), nullptr, options);
    refuse(cancelled.status, LCL_ERROR_CANCELLED, "");
    CHECK(!cancelled.mesh);
    CHECK(calls.count == 1);
}

TEST_CASE("a texture leaves nothing on the device", "[texture][capi]") {
    const Mesh mesh = make_mesh(shapes::octahedron());
    const Context context = open_context();
    lcl_mesh out = nullptr;
    succeed(lcl_texture(context.get(), mesh.get(), nullptr, nullptr, &out, nullptr));
    const Mesh owner(out);
    CHECK(lcl_context_allocated_bytes(context.get()) == 0);
}
