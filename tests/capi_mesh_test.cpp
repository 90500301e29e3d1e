// SPDX-License-Identifier: BSD-3-Clause
// Meshes through the C API: from arrays and files and back, defects, features, counts, properties, suitability, refinement.
#include <limits>
#include <map>

#include "tests/capi_support.h"
#include "tests/io_support.h"

using namespace capi_test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::vector<double> points_of(lcl_mesh mesh) {
    std::vector<double> points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    succeed(lcl_mesh_get_points(mesh, points.data(), 0));
    return points;
}

std::vector<shapes::Face> faces_of(lcl_mesh mesh) {
    std::vector<int32_t> degrees(lcl_mesh_face_count(mesh)), vertices(lcl_mesh_corner_count(mesh));
    succeed(lcl_mesh_get_faces(mesh, degrees.data(), vertices.data()));
    std::vector<shapes::Face> faces;
    auto next = vertices.begin();
    for (const int32_t degree : degrees) faces.emplace_back(next, next + degree), next += degree;
    return faces;
}

void expect_same(lcl_mesh mesh, const lcl::PolygonMesh& expected) {
    CHECK(points_of(mesh) == expected.positions);
    CHECK(faces_of(mesh) == shapes::faces_of(expected));
}

lcl_mesh_info info_of(lcl_mesh mesh) {
    lcl_mesh_info info = LCL_MESH_INFO_INIT;
    succeed(lcl_mesh_get_info(mesh, &info));
    return info;
}

struct Features {
    lcl_boundary boundary = LCL_BOUNDARY_DEFAULT;
    std::vector<int32_t> creases, corners;
};

Features features_of(lcl_mesh mesh) {
    Features found;
    std::size_t creases = 0, corners = 0;
    succeed(lcl_mesh_get_features(mesh, nullptr, nullptr, &creases, nullptr, &corners));
    found.creases.resize(2 * creases);
    found.corners.resize(corners);
    succeed(lcl_mesh_get_features(mesh, &found.boundary, found.creases.data(), nullptr, found.corners.data(), nullptr));
    return found;
}

std::map<int, int> histogram_of(lcl_mesh mesh, lcl_histogram which) {
    std::size_t size = 0;
    succeed(lcl_mesh_get_histogram(mesh, which, nullptr, nullptr, 0, &size));
    std::vector<int32_t> keys(size), counts(size);
    succeed(lcl_mesh_get_histogram(mesh, which, keys.data(), counts.data(), size, nullptr));
    std::map<int, int> histogram;
    for (std::size_t i = 0; i < size; ++i) histogram[keys[i]] = counts[i];
    return histogram;
}

lcl_suitability suitability_of(lcl_mesh mesh, const lcl_scheme_options& options) {
    lcl_suitability suitability = LCL_SUITABILITY_INIT;
    succeed(lcl_mesh_check_scheme(mesh, &options, &suitability));
    return suitability;
}

Mesh refined(lcl_mesh mesh, int levels, const lcl_scheme_options* options = nullptr) {
    lcl_refine_options refine = LCL_REFINE_OPTIONS_INIT;
    refine.levels = levels;
    lcl_mesh out = nullptr;
    succeed(lcl_mesh_refine(mesh, options, &refine, &out));
    return Mesh(out);
}

Mesh read_text(const std::string& text, lcl_format format) {
    lcl_mesh mesh = nullptr;
    succeed(lcl_mesh_read_memory(text.data(), text.size(), format, "text", &mesh));
    return Mesh(mesh);
}

std::vector<std::string> notes_of(lcl_mesh mesh, lcl_note kind) {
    std::vector<std::string> notes;
    for (int32_t i = 0; i < lcl_mesh_note_count(mesh, kind); ++i) notes.emplace_back(lcl_mesh_note(mesh, kind, i));
    return notes;
}

struct DefectCase {
    shapes::Shape shape;
    const char* kind;
    const char* sentence;
    std::vector<int32_t> vertices, faces;
};

}  // namespace

TEST_CASE("a mesh from arrays of the caller gives them back, whatever their layout", "[capi][mesh]") {
    const lcl::PolygonMesh quads = shapes::grid_quads(3, 2).mesh, mixed = shapes::triangular_prism().mesh;
    const MeshArrays arrays(quads);
    lcl_mesh_data data = arrays.data;
    lcl_mesh raw = nullptr;
    SECTION("a degree a face") { expect_same(make_mesh(mixed).get(), mixed); }
    SECTION("one degree for all") {
        data.face_degrees = nullptr;
        data.uniform_degree = 4;
        succeed(lcl_mesh_create(&data, &raw));
        expect_same(Mesh(raw).get(), quads);
    }
    SECTION("points apart") {
        std::vector<double> wide(quads.vertex_count * 5, not_a_number);
        for (lcl::Index v = 0; v < quads.vertex_count; ++v) std::copy_n(&quads.positions[3 * v], 3, &wide[5 * v]);
        data.points = wide.data();
        data.point_stride = 5;
        succeed(lcl_mesh_create(&data, &raw));
        expect_same(Mesh(raw).get(), quads);
    }
    SECTION("floats apart") {
        std::vector<float> wide(quads.vertex_count * 4, std::numeric_limits<float>::quiet_NaN());
        std::vector<double> rounded;
        for (std::size_t i = 0; i < quads.positions.size(); ++i) rounded.push_back(wide[i / 3 * 4 + i % 3] = static_cast<float>(quads.positions[i]));
        data.points = wide.data();
        data.point_type = LCL_TYPE_FLOAT;
        data.point_stride = 4;
        succeed(lcl_mesh_create(&data, &raw));
        CHECK(points_of(Mesh(raw).get()) == rounded);
    }
    SECTION("no vertices at all") {
        data = LCL_MESH_DATA_INIT;
        succeed(lcl_mesh_create(&data, &raw));
        const Mesh empty(raw);
        CHECK(lcl_mesh_vertex_count(raw) == 0);
        CHECK(lcl_mesh_corner_count(raw) == 0);
        refuse(lcl_mesh_validate(raw), LCL_ERROR_BAD_INPUT, "no faces");
    }
}

TEST_CASE("arrays that cannot be a mesh are refused when it is made", "[capi][mesh]") {
    const lcl::PolygonMesh quads = shapes::grid_quads(3, 2).mesh;
    const MeshArrays arrays(quads);
    lcl_mesh_data data = arrays.data;
    lcl_mesh mesh = nullptr;
    const auto expect = [&](const char* part) {
        refuse(lcl_mesh_create(&data, &mesh), LCL_ERROR_INVALID_ARGUMENT, part);
        CHECK(mesh == nullptr);
    };
    SECTION("negative vertex count") { data.vertex_count = -1, expect("negative"); }
    SECTION("negative face count") { data.face_count = -1, expect("negative"); }
    SECTION("stride of two") { data.point_stride = 2, expect("data.point_stride is 2"); }
    SECTION("unknown type") { data.point_type = static_cast<lcl_type>(2), expect("data.point_type is 2"); }
    SECTION("negative degree") {
        std::vector<int32_t> degrees = arrays.degrees;
        degrees[4] = -3;
        data.face_degrees = degrees.data();
        expect("face 4 has -3 sides");
    }
    SECTION("more corners than can be numbered") {
        data.face_degrees = nullptr;
        data.uniform_degree = std::numeric_limits<int32_t>::max();
        refuse(lcl_mesh_create(&data, &mesh), LCL_ERROR_MEMORY, "2147483647");
    }
}

TEST_CASE("points are read and replaced with any stride of three or more", "[capi][mesh]") {
    const shapes::Shape shape = shapes::octahedron();
    const Mesh mesh = make_mesh(shape);
    std::vector<double> wide(6 * 4, -1.0);
    succeed(lcl_mesh_get_points(mesh.get(), wide.data(), 4));
    for (int v = 0; v < 6; ++v) {
        CHECK(wide[4 * v + 1] == shape.mesh.positions[3 * v + 1]);
        CHECK(wide[4 * v + 3] == -1);
        wide[4 * v] += 10;
    }
    succeed(lcl_mesh_set_points(mesh.get(), wide.data(), 4));
    CHECK(points_of(mesh.get())[3] == shape.mesh.positions[3] + 10);
    refuse(lcl_mesh_get_points(mesh.get(), wide.data(), 2), LCL_ERROR_INVALID_ARGUMENT, "stride is 2");
    refuse(lcl_mesh_set_points(mesh.get(), wide.data(), 1), LCL_ERROR_INVALID_ARGUMENT, "stride is 1");
}

TEST_CASE("each defect is refused with its places, by validation and by every function that needs a sound mesh", "[capi][mesh][defects]") {
    const std::vector<DefectCase> cases{
        {shapes::face_with_index_out_of_range(), "index-range", "face 3 uses vertex 905, the mesh has 4", {905}, {3}},
        {shapes::face_with_negative_index(), "index-range", "face 1 uses vertex -1", {-1}, {1}},
        {shapes::repeated_vertex_in_face(), "repeated-vertex", "face 1 uses vertex 2 more than once", {2}, {1}},
        {shapes::two_sided_face(), "short-face", "face 2 has 2 corners, fewer than 3", {}, {2}},
        {shapes::edge_with_three_faces(), "edge-with-three-faces", "edge 0-1 belongs to 3 faces (0, 1, 2)", {0, 1}, {0, 1, 2}},
        {shapes::bow_tie_vertex(), "non-manifold-vertex", "vertex 2 joins 2 fans", {2}, {0, 1}},
        {shapes::inconsistent_orientation(), "orientation", "in the same direction, so their orientations disagree", {}, {}},
        {shapes::with_nan(), "not-finite", "vertex 5 has y = nan", {5}, {}},
        {shapes::with_infinity(), "not-finite", "vertex 5 has y = -inf", {5}, {}},
    };
    for (const DefectCase& c : cases) {
        INFO(c.shape.name);
        const Mesh mesh = make_mesh(c.shape.mesh);
        lcl_mesh raw = nullptr;
        lcl_operator A = nullptr;
        refuse(lcl_mesh_validate(mesh.get()), LCL_ERROR_BAD_INPUT, c.sentence);
        if (!c.vertices.empty()) CHECK(last_error_vertices() == c.vertices);
        if (!c.faces.empty()) CHECK(last_error_faces() == c.faces);
        refuse(lcl_operator_create(default_context(), mesh.get(), nullptr, &A), LCL_ERROR_BAD_INPUT, c.sentence);
        refuse(lcl_mesh_refine(mesh.get(), nullptr, nullptr, &raw), LCL_ERROR_BAD_INPUT, c.sentence);
        refuse(lcl_mesh_get_features(mesh.get(), nullptr, nullptr, nullptr, nullptr, nullptr), LCL_ERROR_BAD_INPUT, c.sentence);
        refuse(lcl_mesh_get_histogram(mesh.get(), LCL_HISTOGRAM_VALENCES, nullptr, nullptr, 0, nullptr), LCL_ERROR_BAD_INPUT, c.sentence);
        CHECK(histogram_of(mesh.get(), LCL_HISTOGRAM_FACE_DEGREES).size() >= 1);

        const lcl_mesh_info info = info_of(mesh.get());
        CHECK(info.faces == c.shape.mesh.face_count());
        CHECK(info.edges == -1);
        CHECK(info.corners == -1);
        CHECK((info.diagonal == 0) == (std::string(c.kind) == "index-range"));
        const lcl_suitability suitability = suitability_of(mesh.get(), LCL_SCHEME_OPTIONS_INIT);
        CHECK(suitability.suitable == 0);
        CHECK_THAT(suitability.reason, Catch::Matchers::Contains(c.sentence));

        REQUIRE(lcl_mesh_defect_count(mesh.get()) == 1);
        lcl_defect defect = LCL_DEFECT_INIT;
        succeed(lcl_mesh_get_defect(mesh.get(), 0, &defect));
        CHECK(std::string(defect.kind) == c.kind);
        CHECK_THAT(defect.message, Catch::Matchers::Contains(c.sentence));
        CHECK(defect.count >= 1);
        CHECK(std::vector<int32_t>(defect.vertices, defect.vertices + defect.vertex_count) == last_error_vertices());
        refuse(lcl_mesh_get_defect(mesh.get(), 1, &defect), LCL_ERROR_INVALID_ARGUMENT, "defect 1 of 1");
        refuse(lcl_mesh_get_defect(mesh.get(), -1, &defect), LCL_ERROR_INVALID_ARGUMENT, "defect -1 of 1");
    }
}

TEST_CASE("faces without area are listed and accepted", "[capi][mesh][defects]") {
    const Mesh mesh = make_mesh(shapes::zero_area_face());
    succeed(lcl_mesh_validate(mesh.get()));
    lcl_defect defect = LCL_DEFECT_INIT;
    REQUIRE(lcl_mesh_defect_count(mesh.get()) == 1);
    succeed(lcl_mesh_get_defect(mesh.get(), 0, &defect));
    CHECK(std::string(defect.kind) == "zero-area");
    CHECK(defect.faces[0] == 0);
}

TEST_CASE("points that are replaced are looked at anew", "[capi][mesh][defects]") {
    const shapes::Shape shape = shapes::octahedron();
    const Mesh mesh = make_mesh(shape);
    succeed(lcl_mesh_validate(mesh.get()));
    CHECK(lcl_mesh_defect_count(mesh.get()) == 0);
    std::vector<double> points = shape.mesh.positions;
    points[3 * 4 + 2] = not_a_number;
    succeed(lcl_mesh_set_points(mesh.get(), points.data(), 0));
    refuse(lcl_mesh_validate(mesh.get()), LCL_ERROR_BAD_INPUT, "vertex 4 has z = nan");
    CHECK(last_error_vertices() == std::vector<int32_t>{4});
    CHECK(lcl_mesh_defect_count(mesh.get()) == 1);
    succeed(lcl_mesh_set_points(mesh.get(), shape.mesh.positions.data(), 0));
    succeed(lcl_mesh_validate(mesh.get()));
    CHECK(lcl_mesh_defect_count(mesh.get()) == 0);
}

TEST_CASE("counts and histograms are those worked out by hand", "[capi][mesh]") {
    SECTION("a sheet with a hole") {
        const Mesh mesh = make_mesh(shapes::grid_with_hole());
        const lcl_mesh_info info = info_of(mesh.get());
        CHECK(info.vertices == 36);
        CHECK(info.faces == 24);
        CHECK(info.edges == 60);
        CHECK(info.boundary_edges == 24);
        CHECK(info.boundary_loops == 2);
        CHECK(info.components == 1);
        CHECK(info.isolated_vertices == 0);
        CHECK(info.creases == 0);
        CHECK(info.corners == 4);  // those with one face
        CHECK(histogram_of(mesh.get(), LCL_HISTOGRAM_FACE_DEGREES) == std::map<int, int>{{4, 24}});
        CHECK(histogram_of(mesh.get(), LCL_HISTOGRAM_VALENCES) == std::map<int, int>{{2, 4}, {3, 16}, {4, 16}});
    }
    SECTION("isolated vertices count for nothing") {
        const Mesh mesh = make_mesh(shapes::with_isolated_vertex(shapes::cube(), 3));
        const lcl_mesh_info info = info_of(mesh.get());
        CHECK(info.vertices == 9);
        CHECK(info.isolated_vertices == 1);
        CHECK(info.components == 1);
        CHECK(info.diagonal == Approx(2 * std::sqrt(3.0)).epsilon(1e-15));
        CHECK(histogram_of(mesh.get(), LCL_HISTOGRAM_VALENCES) == std::map<int, int>{{3, 8}});
    }
    SECTION("as many keys as there is room for") {
        const Mesh mesh = make_mesh(shapes::triangular_prism());
        int32_t key[2] = {-7, -7}, count[2] = {-7, -7};
        std::size_t size = 0;
        succeed(lcl_mesh_get_histogram(mesh.get(), LCL_HISTOGRAM_FACE_DEGREES, key, count, 1, &size));
        CHECK(size == 2);
        CHECK((key[0] == 3 && count[0] == 2 && key[1] == -7 && count[1] == -7));
        refuse(lcl_mesh_get_histogram(mesh.get(), static_cast<lcl_histogram>(2), key, count, 1, &size), LCL_ERROR_INVALID_ARGUMENT, "which is 2");
    }
}

TEST_CASE("creases, corners and boundary rules are resolved", "[capi][mesh][features]") {
    lcl_features features = LCL_FEATURES_INIT;
    SECTION("named ones") {
        const Mesh mesh = make_mesh(shapes::cube().mesh);
        const int32_t crease[] = {1, 0, 1, 2}, corner[] = {6};
        features.creases = crease;
        features.crease_count = 2;
        features.corners = corner;
        features.corner_count = 1;
        succeed(lcl_mesh_add_features(mesh.get(), &features));
        const Features found = features_of(mesh.get());
        CHECK(found.boundary == LCL_BOUNDARY_EDGE_AND_CORNER);
        CHECK(found.creases == std::vector<int32_t>{2, 1, 1, 0});  // edges in the order and direction in which the faces meet them
        CHECK(found.corners == std::vector<int32_t>{6});
        const int32_t more[] = {1, 5};
        features = LCL_FEATURES_INIT;
        features.creases = more;
        features.crease_count = 1;
        succeed(lcl_mesh_add_features(mesh.get(), &features));
        CHECK(info_of(mesh.get()).creases == 3);
        CHECK(features_of(mesh.get()).corners == std::vector<int32_t>{1, 6});  // three creases meet in 1
    }
    SECTION("by the angle of the faces") {
        const Mesh mesh = make_mesh(shapes::box_with_crease_angle().mesh);
        CHECK(info_of(mesh.get()).creases == 0);
        features.crease_angle_degrees = 45;
        succeed(lcl_mesh_add_features(mesh.get(), &features));
        CHECK(info_of(mesh.get()).creases == 12 * 3);
        CHECK(features_of(mesh.get()).corners.size() == 8);
        lcl_mesh raw = nullptr;
        succeed(lcl_mesh_copy(mesh.get(), &raw));
        const Mesh copy(raw);
        for (lcl_mesh flat : {mesh.get(), copy.get()}) {
            std::vector<double> points = points_of(flat);
            for (std::size_t i = 2; i < points.size(); i += 3) points[i] *= 1e-3;
            succeed(lcl_mesh_set_points(flat, points.data(), 0));
            CHECK(info_of(flat).creases == 12 * 3);  // found on the points as they were
        }
    }
    SECTION("the boundary") {
        const Mesh mesh = make_mesh(shapes::grid_quads(3, 3).mesh);
        const auto corners_with = [&](lcl_boundary rule) {
            features.boundary = rule;
            succeed(lcl_mesh_add_features(mesh.get(), &features));
            return features_of(mesh.get());
        };
        CHECK(features_of(mesh.get()).corners == std::vector<int32_t>{0, 3, 12, 15});
        CHECK(corners_with(LCL_BOUNDARY_EDGE_ONLY).corners.empty());
        CHECK(corners_with(LCL_BOUNDARY_DEFAULT).boundary == LCL_BOUNDARY_EDGE_ONLY);  // the default keeps what there is
        CHECK(corners_with(LCL_BOUNDARY_FIXED).corners.size() == 12);
        CHECK(corners_with(LCL_BOUNDARY_EDGE_AND_CORNER).corners.size() == 4);
        CHECK(features_of(mesh.get()).creases.empty());
    }
}

TEST_CASE("features that make no sense are refused", "[capi][mesh][features]") {
    const Mesh mesh = make_mesh(shapes::cube().mesh);
    lcl_features features = LCL_FEATURES_INIT;
    const auto refuse_options = [&](const char* part) { refuse(lcl_mesh_add_features(mesh.get(), &features), LCL_ERROR_INVALID_ARGUMENT, part); };
    SECTION("a boundary rule that is none") { features.boundary = static_cast<lcl_boundary>(4), refuse_options("features.boundary is 4"); }
    SECTION("an angle above 180") { features.crease_angle_degrees = 181, refuse_options("crease_angle_degrees"); }
    SECTION("an angle that is no number") { features.crease_angle_degrees = not_a_number, refuse_options("crease_angle_degrees"); }
    SECTION("a crease that is no edge") {
        const int32_t crease[] = {0, 6};
        features.creases = crease;
        features.crease_count = 1;
        succeed(lcl_mesh_add_features(mesh.get(), &features));
        refuse(lcl_mesh_validate(mesh.get()), LCL_ERROR_BAD_INPUT, "crease 0-6 is no edge");
    }
    SECTION("a corner that is no vertex") {
        const int32_t corner = 8;
        features.corners = &corner;
        features.corner_count = 1;
        succeed(lcl_mesh_add_features(mesh.get(), &features));
        refuse(lcl_mesh_validate(mesh.get()), LCL_ERROR_BAD_INPUT, "uses vertex 8, the mesh has 8");
    }
}

TEST_CASE("what a file carries beside its points is copied, written and read again", "[capi][mesh][io]") {
    const io_test::TemporaryFolder folder;
    const std::string text =
        "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0.125 1 1 1\nvp 1 2\nf 1 2 3\nf 1 3 4\nt crease 2/1/0 0 2 inf\nt corner 1/1/0 1 "
        "inf\nt holes 1/0/0 0\n";
    const Mesh mesh = read_text(text, LCL_FORMAT_OBJ);
    REQUIRE(lcl_mesh_property_count(mesh.get()) == 3);
    CHECK(std::string(lcl_mesh_property_name(mesh.get(), 1)) == "green");
    CHECK(lcl_mesh_property_is_colour(mesh.get(), 2) == 1);
    CHECK(lcl_mesh_property_name(mesh.get(), 3) == nullptr);
    CHECK(lcl_mesh_property_name(mesh.get(), -1) == nullptr);
    CHECK(lcl_mesh_property_is_colour(mesh.get(), 3) == 0);
    CHECK(notes_of(mesh.get(), LCL_NOTE_IGNORED_TAG) == std::vector<std::string>{"holes"});
    CHECK(notes_of(mesh.get(), LCL_NOTE_UNKNOWN_STATEMENT) == std::vector<std::string>{"vp 1"});
    CHECK(notes_of(mesh.get(), LCL_NOTE_REFUSED_TAG).empty());
    CHECK(lcl_mesh_note(mesh.get(), LCL_NOTE_WARNING, -1) == nullptr);
    CHECK(lcl_mesh_note(mesh.get(), LCL_NOTE_UNKNOWN_STATEMENT, 1) == nullptr);

    lcl_mesh raw = nullptr;
    succeed(lcl_mesh_copy(mesh.get(), &raw));
    const Mesh copy(raw);
    const std::vector<double> before = points_of(mesh.get()), heat{1, 0.1, -2.5, 1e-9};
    std::vector<double> moved = before;
    moved[0] = 0.3;
    succeed(lcl_mesh_set_points(copy.get(), moved.data(), 0));
    CHECK(points_of(mesh.get()) == before);
    succeed(lcl_mesh_set_property(copy.get(), "temperature", heat.data()));
    CHECK(lcl_mesh_property_count(mesh.get()) == 3);
    const auto [format, name] =
        GENERATE(table<lcl_format, std::string>({{LCL_FORMAT_BY_ENDING, "out.obj"}, {LCL_FORMAT_PLY, "out.bin"}, {LCL_FORMAT_BY_ENDING, "out.ply.gz"}}));
    INFO(name);
    succeed(lcl_mesh_write(copy.get(), folder.file(name).c_str(), format));
    succeed(lcl_mesh_read(folder.file(name).c_str(), format, &raw));
    const Mesh again(raw);
    CHECK(points_of(again.get()) == moved);
    CHECK(faces_of(again.get()) == faces_of(mesh.get()));
    std::vector<double> green(4);
    succeed(lcl_mesh_get_property(again.get(), 1, green.data()));
    CHECK(green == std::vector<double>{0, 1, 0, 1});
    if (name == "out.obj") {
        CHECK(features_of(again.get()).creases == features_of(mesh.get()).creases);
        CHECK(features_of(again.get()).corners == features_of(mesh.get()).corners);
        const std::vector<std::string> notes = notes_of(copy.get(), LCL_NOTE_WARNING);
        REQUIRE(notes.size() == 2);  // of reading, which the copy took over, and of writing
        CHECK_THAT(notes[0], Catch::Matchers::Contains("holes"));
        CHECK_THAT(notes[1], Catch::Matchers::Contains("temperature"));
    } else {
        std::vector<double> found(4);
        succeed(lcl_mesh_get_property(again.get(), 3, found.data()));
        CHECK(std::string(lcl_mesh_property_name(again.get(), 3)) == "temperature");
        CHECK(found == heat);
        CHECK_FALSE(notes_of(copy.get(), LCL_NOTE_WARNING).empty());  // creases and corners
    }
    refuse(lcl_mesh_get_property(again.get(), 99, green.data()), LCL_ERROR_INVALID_ARGUMENT, "property 99 was asked for");
    refuse(lcl_mesh_get_property(again.get(), 0, nullptr), LCL_ERROR_INVALID_ARGUMENT, "values is NULL");
}

TEST_CASE("properties are replaced by name and normals are written until the points change", "[capi][mesh][io]") {
    const io_test::TemporaryFolder folder;
    const shapes::Shape shape = shapes::octahedron();
    const Mesh mesh = make_mesh(shape);
    const std::vector<double> first{1, 2, 3, 4, 5, 6}, second{6, 5, 4, 3, 2, 1};
    succeed(lcl_mesh_set_property(mesh.get(), "mass", first.data()));
    succeed(lcl_mesh_set_property(mesh.get(), "mass", second.data()));
    CHECK(lcl_mesh_property_count(mesh.get()) == 1);
    CHECK(lcl_mesh_property_is_colour(mesh.get(), 0) == 0);
    std::vector<double> found(6);
    succeed(lcl_mesh_get_property(mesh.get(), 0, found.data()));
    CHECK(found == second);

    const auto written = [&] {
        succeed(lcl_mesh_write(mesh.get(), folder.file("x.obj").c_str(), LCL_FORMAT_BY_ENDING));
        return io_test::file_bytes(folder.file("x.obj"));
    };
    CHECK_FALSE(contains(written(), "vn "));
    succeed(lcl_mesh_set_normals(mesh.get(), shape.mesh.positions.data()));
    CHECK(contains(written(), "vn 0 1 0\n"));
    succeed(lcl_mesh_set_normals(mesh.get(), nullptr));
    CHECK_FALSE(contains(written(), "vn "));
    succeed(lcl_mesh_set_normals(mesh.get(), shape.mesh.positions.data()));
    succeed(lcl_mesh_set_points(mesh.get(), shape.mesh.positions.data(), 0));
    CHECK_FALSE(contains(written(), "vn "));
}

TEST_CASE("files and formats that cannot be served are refused with the right status", "[capi][mesh][io]") {
    const io_test::TemporaryFolder folder;
    const Mesh mesh = make_mesh(shapes::cube());
    lcl_mesh raw = nullptr;
    lcl_format format = LCL_FORMAT_BY_ENDING;
    const auto bad_format = static_cast<lcl_format>(9);
    refuse(lcl_mesh_read(folder.file("none.obj").c_str(), LCL_FORMAT_BY_ENDING, &raw), LCL_ERROR_FILE, "none.obj");
    refuse(lcl_mesh_read("x.doc", LCL_FORMAT_BY_ENDING, &raw), LCL_ERROR_INVALID_ARGUMENT, "names no mesh format");
    refuse(lcl_mesh_read("-", LCL_FORMAT_BY_ENDING, &raw), LCL_ERROR_INVALID_ARGUMENT, "need a format");
    refuse(lcl_mesh_read("x.obj", bad_format, &raw), LCL_ERROR_INVALID_ARGUMENT, "format is 9");
    refuse(lcl_mesh_read("x.obj", static_cast<lcl_format>(-1), &raw), LCL_ERROR_INVALID_ARGUMENT, "format is -1");
    refuse(lcl_mesh_read_memory("v 0 0", 5, LCL_FORMAT_OBJ, "five bytes", &raw), LCL_ERROR_BAD_INPUT, "five bytes");
    refuse(lcl_mesh_read_memory("v 0 0", 5, bad_format, "x", &raw), LCL_ERROR_INVALID_ARGUMENT, "format is 9");
    refuse(lcl_mesh_write(mesh.get(), folder.file("no/such/folder.obj").c_str(), LCL_FORMAT_BY_ENDING), LCL_ERROR_WRITE, "folder.obj");
    refuse(lcl_mesh_write(mesh.get(), folder.file("x.obj").c_str(), bad_format), LCL_ERROR_INVALID_ARGUMENT, "format is 9");
    refuse(lcl_mesh_write(mesh.get(), folder.file("x.stl").c_str(), LCL_FORMAT_BY_ENDING), LCL_ERROR_INVALID_ARGUMENT,
           "STL holds triangles only; face 0 has 4");
    CHECK_FALSE(std::filesystem::exists(folder.file("x.stl")));
    CHECK(raw == nullptr);
    for (const auto& [path, expected] : std::vector<std::pair<const char*, lcl_format>>{
             {"a.obj", LCL_FORMAT_OBJ}, {"a.OFF", LCL_FORMAT_OFF}, {"a/b.ply.gz", LCL_FORMAT_PLY}, {"a.stl", LCL_FORMAT_STL}, {".om", LCL_FORMAT_OM}}) {
        succeed(lcl_format_of_path(path, &format));
        CHECK(format == expected);
    }
    refuse(lcl_format_of_path("mesh", &format), LCL_ERROR_INVALID_ARGUMENT, "names no mesh format");
}

TEST_CASE("tags that are refused stop every function that needs a sound mesh, and are noted", "[capi][mesh][io]") {
    const std::string faces = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    lcl_operator A = nullptr;
    SECTION("semi-sharp creases") {
        const Mesh mesh = read_text(faces + "t crease 2/1/0 0 1 2.5\n", LCL_FORMAT_OBJ);
        REQUIRE(notes_of(mesh.get(), LCL_NOTE_REFUSED_TAG).size() == 1);
        refuse(lcl_mesh_validate(mesh.get()), LCL_ERROR_BAD_INPUT, notes_of(mesh.get(), LCL_NOTE_REFUSED_TAG)[0]);
        refuse(lcl_operator_create(default_context(), mesh.get(), nullptr, &A), LCL_ERROR_BAD_INPUT, "crease");
    }
    SECTION("no surface along the boundary, until a rule is chosen") {
        const Mesh mesh = read_text(faces + "t interpolateboundary 1/0/0 0\n", LCL_FORMAT_OBJ);
        refuse(lcl_mesh_validate(mesh.get()), LCL_ERROR_BAD_INPUT, "interpolateboundary 0");
        lcl_features features = LCL_FEATURES_INIT;
        features.boundary = LCL_BOUNDARY_EDGE_ONLY;
        succeed(lcl_mesh_add_features(mesh.get(), &features));
        succeed(lcl_mesh_validate(mesh.get()));
    }
}

TEST_CASE("a scheme's suitability is told without a device", "[capi][mesh][scheme]") {
    const Mesh cube = make_mesh(shapes::cube()), octahedron = make_mesh(shapes::octahedron());
    const lcl_suitability plain = suitability_of(cube.get(), scheme(LCL_SCHEME_CATMULL_CLARK));
    CHECK(plain.suitable == 1);
    CHECK(plain.singular == 1);
    CHECK_THAT(plain.reason, Catch::Matchers::Contains("alpha 0.5"));
    CHECK(plain.vertex_count == 8);
    const lcl_suitability cured = suitability_of(cube.get(), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5)),
                          blended = suitability_of(cube.get(), scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.3));
    CHECK((cured.suitable == 1 && cured.singular == 0 && cured.reason[0] == '\0' && cured.vertex_count == 0));
    CHECK((blended.suitable == 1 && blended.singular == 0));
    const int32_t subset[] = {0, 1, 2};
    lcl_scheme_options part = scheme(LCL_SCHEME_CATMULL_CLARK);
    part.subset = subset;
    part.subset_count = 3;
    CHECK(suitability_of(cube.get(), part).singular == 0);
    const lcl_suitability loop = suitability_of(cube.get(), scheme(LCL_SCHEME_LOOP));
    CHECK((loop.suitable == 0 && loop.singular == 0));
    CHECK_THAT(loop.reason, Catch::Matchers::Contains("face 0 has 4 sides"));
    CHECK(suitability_of(octahedron.get(), scheme(LCL_SCHEME_LOOP)).suitable == 1);
    CHECK(suitability_of(octahedron.get(), scheme(LCL_SCHEME_DEFAULT)).suitable == 1);
    CHECK(suitability_of(cube.get(), scheme(LCL_SCHEME_DOO_SABIN)).singular == 0);
    lcl_suitability out = LCL_SUITABILITY_INIT;
    lcl_scheme_options wrong = scheme(LCL_SCHEME_CATMULL_CLARK, 2);
    refuse(lcl_mesh_check_scheme(cube.get(), &wrong, &out), LCL_ERROR_INVALID_ARGUMENT, "alpha is 2");
}

TEST_CASE("a mesh is refined by its scheme, once unless told otherwise", "[capi][mesh][refine]") {
    const shapes::Shape shape = shapes::cube();
    const Mesh mesh = make_mesh(shape);
    CHECK(lcl_mesh_vertex_count(refined(mesh.get(), 0).get()) == 8 + 12 + 6);
    CHECK(lcl_mesh_vertex_count(refined(mesh.get(), 2).get()) == 26 + 48 + 24);
    expect_same(refined(mesh.get(), -1).get(), shape.mesh);
    const std::vector<double> once = points_of(refined(mesh.get(), 1).get());
    for (int c = 0; c < 3; ++c) CHECK(once[3 * 6 + c] == Approx(5.0 / 9).epsilon(1e-15));  // (Q + 2 R + 0 V)/3 with Q = 1/3, R = 2/3
    const lcl_scheme_options alpha = scheme(LCL_SCHEME_CATMULL_CLARK, 1), lambda = scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.5),
                             doo_sabin = scheme(LCL_SCHEME_DOO_SABIN);
    CHECK(points_of(refined(mesh.get(), 1, &alpha).get())[3 * 6] == Approx(7.0 / 9).epsilon(1e-15));
    CHECK(lcl_mesh_vertex_count(refined(mesh.get(), 1, &lambda).get()) == 8 + 24 + 24);
    CHECK(lcl_mesh_vertex_count(refined(mesh.get(), 1, &doo_sabin).get()) == 24);
    lcl_mesh out = nullptr;
    const lcl_scheme_options loop = scheme(LCL_SCHEME_LOOP);
    refuse(lcl_mesh_refine(mesh.get(), &loop, nullptr, &out), LCL_ERROR_BAD_INPUT, "face 0 has 4 sides");
    lcl_refine_options deep = LCL_REFINE_OPTIONS_INIT;
    deep.levels = 40;
    refuse(lcl_mesh_refine(mesh.get(), nullptr, &deep, &out), LCL_ERROR_MEMORY, "use fewer levels");
    CHECK(out == nullptr);
}

TEST_CASE("a refined mesh stands for the same surface, creases and corners included", "[capi][mesh][refine]") {
    const shapes::Shape shape = shapes::grid_with_creases();
    const Mesh mesh = make_mesh(shape), fine = refined(mesh.get(), 1);
    const lcl_mesh_info coarse_info = info_of(mesh.get()), fine_info = info_of(fine.get());
    CHECK(fine_info.creases == 2 * coarse_info.creases);
    CHECK(fine_info.corners == coarse_info.corners);
    const Operator A = make_operator(default_context(), mesh.get()), B = make_operator(default_context(), fine.get());
    std::vector<double> limit(shape.mesh.positions.size()), fine_limit(3 * static_cast<std::size_t>(fine_info.vertices));
    succeed(lcl_limit_points(A.get(), shape.mesh.positions.data(), 0, 3, LCL_PRECISION_DOUBLE, limit.data(), 0));
    succeed(lcl_limit_points(B.get(), points_of(fine.get()).data(), 0, 3, LCL_PRECISION_DOUBLE, fine_limit.data(), 0));
    fine_limit.resize(limit.size());                        // old vertices keep their numbers
    CHECK(largest_difference(fine_limit, limit) <= 1e-14);  // coordinates up to 1, rows of up to 13 rounded weights in two steps
}

TEST_CASE("creases by angle stay those of the points that the mesh had when it was interpolated", "[capi][mesh][refine]") {
    const Mesh mesh = make_mesh(shapes::box_with_crease_angle());
    const int32_t creases = info_of(mesh.get()).creases;
    REQUIRE(creases == 12 * 3);
    std::vector<double> points = points_of(mesh.get());
    for (std::size_t i = 2; i < points.size(); i += 3) points[i] = 0;  // flat: no angle is left but half turns
    succeed(lcl_mesh_set_points(mesh.get(), points.data(), 3));
    CHECK(info_of(mesh.get()).creases == creases);
    CHECK(info_of(refined(mesh.get(), 1).get()).creases == 2 * creases);
    CHECK(info_of(refined(mesh.get(), -1).get()).creases == creases);
}

TEST_CASE("without a refinement a mesh keeps texture coordinates, groups and materials", "[capi][mesh][refine]") {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nmtllib m.mtl\ng side\nusemtl m\nf 1/1 2/2 3/2 4/1\n";
    const Mesh copy = refined(read_text(text, LCL_FORMAT_OBJ).get(), -1);
    CHECK(notes_of(copy.get(), LCL_NOTE_WARNING).empty());
    const io_test::TemporaryFolder folder;
    succeed(lcl_mesh_write(copy.get(), folder.file("copy.obj").c_str(), LCL_FORMAT_OBJ));
    CHECK(io_test::file_bytes(folder.file("copy.obj")) == text);
}

TEST_CASE("colours are set in 8 bits, in the place of those that were there", "[capi][mesh][io]") {
    const io_test::TemporaryFolder folder;
    const Mesh mesh = read_text("v 0 0 0 0.1 0.2 0.3 0.5\nv 1 0 0 0.4 0.5 0.6 0.5\nv 0 1 0 0.7 0.8 0.9 0.5\nf 1 2 3\n", LCL_FORMAT_OBJ);
    const std::vector<double> colours{1, 0, 0.5, 0, 1, 0.2, 0.002, 0.999, 1};
    succeed(lcl_mesh_set_colours(mesh.get(), colours.data()));
    REQUIRE(lcl_mesh_property_count(mesh.get()) == 4);
    const double expected[4][3] = {
        {255, 0, 1}, {0, 255, 255}, {128, 51, 255}, {0.5, 0.5, 0.5}};  // 127.5 is rounded up; 0.002 * 255 = 0.51; 0.999 * 255 = 254.7
    for (int32_t index = 0; index < 4; ++index) {
        CHECK(lcl_mesh_property_is_colour(mesh.get(), index) == 1);
        std::vector<double> found(3);
        succeed(lcl_mesh_get_property(mesh.get(), index, found.data()));
        CHECK(found == std::vector<double>(expected[index], expected[index] + 3));
    }
    succeed(lcl_mesh_write(mesh.get(), folder.file("x.ply").c_str(), LCL_FORMAT_BY_ENDING));
    CHECK_THAT(io_test::file_bytes(folder.file("x.ply")), Catch::Matchers::Contains("property uchar red"));

    const Mesh plain = make_mesh(shapes::octahedron());
    std::vector<double> white(18, 1.0);
    succeed(lcl_mesh_set_colours(plain.get(), white.data()));
    succeed(lcl_mesh_write(plain.get(), folder.file("x.obj").c_str(), LCL_FORMAT_BY_ENDING));
    CHECK_THAT(io_test::file_bytes(folder.file("x.obj")), Catch::Matchers::Contains(" 1 1 1\n"));
    white[4] = 1.5;
    refuse(lcl_mesh_set_colours(plain.get(), white.data()), LCL_ERROR_INVALID_ARGUMENT, "green of vertex 1 is 1.5");
}

TEST_CASE("colours and properties are refined as the points are, texture coordinates are dropped with a note", "[capi][mesh][refine]") {
    const lcl_scheme scheme_name = GENERATE(LCL_SCHEME_CATMULL_CLARK, LCL_SCHEME_DOO_SABIN);
    const shapes::Shape shape = shapes::grid_with_creases();
    const Mesh mesh = make_mesh(shape);
    const auto affine = [](const double* p) { return 3 + 2 * p[0] - p[1] + 0.5 * p[2]; };
    std::vector<double> values;
    for (lcl::Index v = 0; v < shape.mesh.vertex_count; ++v) values.push_back(affine(&shape.mesh.positions[3 * v]));
    succeed(lcl_mesh_set_property(mesh.get(), "heat", values.data()));
    const lcl_scheme_options options = scheme(scheme_name);
    const Mesh fine = refined(mesh.get(), 2, &options);
    REQUIRE(lcl_mesh_property_count(fine.get()) == 1);
    const std::vector<double> points = points_of(fine.get());
    std::vector<double> found(points.size() / 3), expected;
    succeed(lcl_mesh_get_property(fine.get(), 0, found.data()));
    for (std::size_t v = 0; v < found.size(); ++v) expected.push_back(affine(&points[3 * v]));
    CHECK(largest_difference(found, expected) <= 1e-13);  // stencils add up to 1

    const Mesh textured =
        read_text("v 0 0 0 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 0 0\nv 0 1 0 0 0 0\nvt 0 0\nvt 1 0\nusemtl m\nf 1/1 2/2 3/2 4/1\n", LCL_FORMAT_OBJ);
    const Mesh plain = refined(textured.get(), 1);
    const std::vector<std::string> notes = notes_of(plain.get(), LCL_NOTE_WARNING);
    REQUIRE(notes.size() == 2);
    CHECK_THAT(notes[0], Catch::Matchers::Contains("texture coordinates"));
    CHECK_THAT(notes[1], Catch::Matchers::Contains("materials"));
    std::vector<double> red(9);
    succeed(lcl_mesh_get_property(plain.get(), 0, red.data()));
    CHECK(red[8] == 0.25);  // the face point
}

TEST_CASE("refined vertices know where they lie", "[capi][mesh][refine]") {
    const Mesh mesh = make_mesh(shapes::with_isolated_vertex(shapes::single_quad(), 4));
    const Mesh fine = refined(mesh.get(), 1);
    const auto count = static_cast<std::size_t>(lcl_mesh_vertex_count(fine.get()));
    REQUIRE(count == 5 + 4 + 1);
    std::vector<int32_t> faces(count), corners(count);
    std::vector<double> uv(2 * count);
    succeed(lcl_mesh_get_locations(fine.get(), faces.data(), corners.data(), uv.data()));
    CHECK(faces == std::vector<int32_t>{0, 0, 0, 0, -1, 0, 0, 0, 0, 0});
    CHECK(std::vector<double>(uv.begin(), uv.begin() + 8) == std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1});
    CHECK(std::vector<double>(uv.begin() + 10, uv.end()) == std::vector<double>{0.5, 0, 1, 0.5, 0.5, 1, 0, 0.5, 0.5, 0.5});
    succeed(lcl_mesh_get_locations(fine.get(), nullptr, nullptr, nullptr));
    refuse(lcl_mesh_get_locations(mesh.get(), faces.data(), corners.data(), uv.data()), LCL_ERROR_INVALID_ARGUMENT, "was not made by lcl_mesh_refine");
}
