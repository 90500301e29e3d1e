// SPDX-License-Identifier: BSD-3-Clause
// The commands of the mesh expansion, as scripts see them. Results are compared with plain loops in double over the rows of A.
#include <functional>
#include <map>

#include "tests/capi_support.h"
#include "tests/cli_support.h"

using namespace cli_test;

namespace {

using Values = std::vector<double>;

capi_test::Mesh read_mesh(const std::string& path) {
    lcl_mesh handle = nullptr;
    capi_test::succeed(lcl_mesh_read(path.c_str(), LCL_FORMAT_BY_ENDING, &handle));
    return capi_test::Mesh(handle);
}

Values points_of(lcl_mesh mesh) {
    Values points(3 * static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    capi_test::succeed(lcl_mesh_get_points(mesh, points.data(), 0));
    return points;
}

Values property_of(lcl_mesh mesh, const std::string& name) {
    Values values(static_cast<std::size_t>(lcl_mesh_vertex_count(mesh)));
    for (std::int32_t index = 0; index < lcl_mesh_property_count(mesh); ++index) {
        if (lcl_mesh_property_name(mesh, index) != name) continue;
        capi_test::succeed(lcl_mesh_get_property(mesh, index, values.data()));
        return values;
    }
    FAIL("no property " << name);
    return {};
}

/// A mesh file with its points and the rows of A.
class Plain {
public:
    Plain(const std::string& path, const lcl_scheme_options& options) : mesh(read_mesh(path)), points(points_of(mesh.get())) {
        lcl_operator A = nullptr;
        capi_test::succeed(lcl_operator_create(capi_test::default_context(), mesh.get(), &options, &A));
        read_rows(capi_test::Operator(A));
    }
    Plain(const std::string& path, const lcl_feature_options& options) : mesh(read_mesh(path)), points(points_of(mesh.get())) {
        lcl_operator A = nullptr;
        capi_test::succeed(lcl_operator_create_features(capi_test::default_context(), mesh.get(), &options, &A));
        read_rows(capi_test::Operator(A));
    }

    /// A x, any number of channels.
    Values apply(const Values& x) const {
        const std::size_t channels = x.size() / columns_.size();
        Values y(x.size(), 0.0);
        for (std::size_t vertex = 0; vertex < columns_.size(); ++vertex) {
            for (std::size_t entry = 0; entry < columns_[vertex].size(); ++entry) {
                for (std::size_t channel = 0; channel < channels; ++channel)
                    y[vertex * channels + channel] += weights_[vertex][entry] * x[static_cast<std::size_t>(columns_[vertex][entry]) * channels + channel];
            }
        }
        return y;
    }

    const capi_test::Mesh mesh;
    const Values points;
    double diagonal = 0.0;

private:
    void read_rows(const capi_test::Operator& A) {
        columns_.resize(points.size() / 3);
        weights_.resize(points.size() / 3);
        for (std::size_t vertex = 0; vertex < columns_.size(); ++vertex) read_row(A.get(), vertex);
        lcl_mesh_info info = LCL_MESH_INFO_INIT;
        capi_test::succeed(lcl_mesh_get_info(mesh.get(), &info));
        diagonal = info.diagonal;
    }

    void read_row(lcl_operator A, std::size_t vertex) {
        std::size_t size = 0;
        capi_test::succeed(lcl_operator_get_row(A, static_cast<std::int32_t>(vertex), nullptr, nullptr, 0, &size));
        columns_[vertex].resize(size);
        weights_[vertex].resize(size);
        capi_test::succeed(lcl_operator_get_row(A, static_cast<std::int32_t>(vertex), columns_[vertex].data(), weights_[vertex].data(), size, &size));
    }

    std::vector<std::vector<std::int32_t>> columns_;
    std::vector<Values> weights_;
};

Values sum(const Values& a, double factor, const Values& b) {
    Values out = a;
    for (std::size_t index = 0; index < a.size(); ++index) out[index] += factor * b[index];
    return out;
}

/// sum w_i (E - A)^i A x + r (E - A)^(m + 1) x, or sum w_i (E - A)^i x.
Values series(const Plain& A, const Values& x, const std::vector<double>& weights, bool interpolation, double remainder = 0.0) {
    Values out(x.size(), 0.0), rest = x;
    for (const double weight : weights) {
        const Values limit = A.apply(rest);
        out = sum(out, weight, interpolation ? rest : limit);
        rest = sum(rest, -1.0, limit);
    }
    return sum(out, remainder, rest);
}

/// D x, D = E - (E - A)^(m + 1).
Values filtered(const Plain& A, const Values& x, int m) {
    Values rest = x;
    for (int i = 0; i <= m; ++i) rest = sum(rest, -1.0, A.apply(rest));
    return sum(x, -1.0, rest);
}

Values denoised(const Plain& A, const Values& x, int m, int k, bool plain) {
    Values out = plain ? x : A.apply(x);
    for (int i = 0; i < k; ++i) out = filtered(A, out, m);
    return out;
}

Values sharpened(const Plain& A, const Values& x, int first, int last, int k) {
    std::vector<double> weights(static_cast<std::size_t>(last) + 1, 0.0);
    weights[0] = 1.0;
    std::fill(weights.begin() + first, weights.end(), 1.0);
    Values out = x;
    for (int i = 0; i < k; ++i) out = series(A, out, weights, true);
    return out;
}

Values points_of(const Folder& folder, const std::string& name) {
    Values values;
    for (const Point& point : obj_points(folder.read(name))) values.insert(values.end(), point.begin(), point.end());
    REQUIRE_FALSE(values.empty());
    return values;
}

double largest_difference(const Values& a, const Values& b) {
    REQUIRE(a.size() == b.size());
    double largest = 0.0;
    for (std::size_t index = 0; index < a.size(); ++index) largest = std::max(largest, std::abs(a[index] - b[index]));
    return largest;
}

/// What the filters may be off by, relative to the diagonal: floats, or doubles (pairs of floats under mixed).
double tolerance_of(const std::string& precision) { return precision == "single" ? 1e-5 : 1e-12; }

lcl_scheme_options scheme_of(lcl_scheme scheme, double alpha = 0.0) {
    lcl_scheme_options options = LCL_SCHEME_OPTIONS_INIT;
    options.scheme = scheme;
    options.alpha = alpha;
    return options;
}

/// A mesh by name, and how it is subdivided.
struct Case {
    std::string text, options;
    lcl_scheme_options scheme;
};

Case case_of(const std::string& name) {
    const std::map<std::string, Case> cases = {
        {"grid", {bumpy_grid(6), "", scheme_of(LCL_SCHEME_CATMULL_CLARK)}},
        {"grid, alpha 0.5", {bumpy_grid(6), "--alpha 0.5", scheme_of(LCL_SCHEME_CATMULL_CLARK, 0.5)}},
        {"grid, Doo-Sabin", {bumpy_grid(6), "--scheme doo-sabin", scheme_of(LCL_SCHEME_DOO_SABIN)}},
        {"octahedron", {octahedron, "", scheme_of(LCL_SCHEME_LOOP)}},
        {"cube", {cube, "", scheme_of(LCL_SCHEME_CATMULL_CLARK)}},
    };
    return cases.at(name);
}

/// A 40 x 40 grid: a long filter on it takes seconds, whatever the machine.
const std::string large_grid = bumpy_grid(40);

/// The closed mesh of an n x n x n block of cubes, its vertices pushed about: volume, valences 3 and 4, noise.
std::string rough_block(int n) {
    std::map<std::array<int, 3>, int> numbers;
    std::ostringstream vertices, faces;
    const auto vertex = [&](std::array<int, 3> at) {
        const auto [place, is_new] = numbers.emplace(at, static_cast<int>(numbers.size()) + 1);
        if (is_new) {
            const int mix = at[0] * 7 + at[1] * 13 + at[2] * 29;
            vertices << "v " << at[0] + 0.1 * (mix % 5) << " " << at[1] + 0.1 * (mix % 3) << " " << at[2] - 0.1 * (mix % 4) << "\n";
        }
        return place->second;
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, n}) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int a, int b) {
                        std::array<int, 3> at{};
                        at[static_cast<std::size_t>(axis)] = side;
                        at[static_cast<std::size_t>((axis + 1) % 3)] = i + a;
                        at[static_cast<std::size_t>((axis + 2) % 3)] = j + b;
                        return vertex(at);
                    };
                    const int ring[] = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                    faces << "f";
                    for (int k = 0; k < 4; ++k) faces << " " << ring[side == 0 ? 3 - k : k];
                    faces << "\n";
                }
            }
        }
    }
    return vertices.str() + faces.str();
}

double volume_of(const std::string& path) {
    const capi_test::Mesh mesh = read_mesh(path);
    lcl_mesh handle = mesh.get();
    std::vector<std::int32_t> degrees(static_cast<std::size_t>(lcl_mesh_face_count(handle))), corners(static_cast<std::size_t>(lcl_mesh_corner_count(handle)));
    const Values points = points_of(handle);
    capi_test::succeed(lcl_mesh_get_faces(handle, degrees.data(), corners.data()));
    double volume = 0.0;
    std::size_t first = 0;
    for (const std::int32_t degree : degrees) {
        const auto sides = static_cast<std::size_t>(degree);
        Point mean{};
        const auto at = [&](std::size_t side) { return &points[3 * static_cast<std::size_t>(corners[first + side % sides])]; };
        for (std::size_t side = 0; side < sides; ++side) {
            for (std::size_t axis = 0; axis < 3; ++axis) mean[axis] += at(side)[axis] / degree;
        }
        for (std::size_t side = 0; side < sides; ++side) {  // the tetrahedron of the origin, the face's mean and an edge
            const double *a = at(side), *b = at(side + 1);
            volume += (mean[0] * (a[1] * b[2] - a[2] * b[1]) + mean[1] * (a[2] * b[0] - a[0] * b[2]) + mean[2] * (a[0] * b[1] - a[1] * b[0])) / 6.0;
        }
        first += sides;
    }
    return volume;
}

std::vector<std::vector<double>> csv_rows(const std::string& text, const std::string& header) {
    std::istringstream lines(text);
    std::string line;
    REQUIRE(std::getline(lines, line));
    CHECK(line == header);
    std::vector<std::vector<double>> rows;
    while (std::getline(lines, line)) {
        std::vector<double> row;
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

TEST_CASE("expand gives the sums of terms that plain loops give", "[cli][expand]") {
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "grid", "grid, alpha 0.5", "grid, Doo-Sabin", "octahedron");
    const Case mesh = case_of(name);
    folder.file("in.obj", mesh.text);
    const Plain A((folder.path / "in.obj").string(), mesh.scheme);
    struct Way {
        std::string arguments;
        std::vector<double> weights;
        bool interpolation;
        double remainder;
    };
    const std::vector<Way> ways = {
        {"--term 0", {1}, false, 0},
        {"--term 3", {0, 0, 0, 1}, false, 0},
        {"--sum 4", {1, 1, 1, 1, 1}, false, 0},
        {"--band 1:2", {0, 1, 1}, false, 0},
        {"--equaliser 1,0.5,-2", {1, 0.5, -2}, false, 1},
        {"--equaliser 1,1,1", {1, 1, 1}, false, 1},
        {"--equaliser=-0.5:0.25", {-0.5}, false, 0.25},
        {"--series interpolation --term 0", {1}, true, 0},
        {"--series interpolation --sum 3", {1, 1, 1, 1}, true, 0},
        {"--series interpolation --band 2:3", {0, 0, 1, 1}, true, 0},
        {"--series interpolation --equaliser 1,0.5", {1, 0.5}, true, 0},
    };
    const std::string precision = name == "grid" ? GENERATE(as<std::string>(), "single", "mixed", "double") : std::string("mixed");
    for (const Way& way : ways) {
        const Outcome outcome = run(folder, "expand in.obj -o out.obj " + mesh.options + " --precision " + precision + " " + way.arguments);
        INFO(name << ", " << precision << ", " << way.arguments << "\n" << outcome.err);
        REQUIRE(outcome.exit_code == 0);
        const Values expected = series(A, A.points, way.weights, way.interpolation, way.remainder);
        CHECK(largest_difference(points_of(folder, "out.obj"), expected) <= tolerance_of(precision) * A.diagonal);
    }
}

TEST_CASE("expand says where a result without term 0 lies, and reports what was used", "[cli][expand]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    CHECK(contains(run(folder, "expand in.obj -o out.obj --term 2").err, "around the origin"));
    CHECK(contains(run(folder, "expand in.obj -o out.obj --band 1:4").err, "around the origin"));
    CHECK(contains(run(folder, "expand in.obj -o out.obj --equaliser 0,1").err, "around the origin"));
    CHECK(contains(run(folder, "expand in.obj -o out.obj --equaliser 3,1").err, "times 3"));
    for (const char* way : {"--sum 2", "--term 0", "--band 0:1", "--equaliser 1,2", "--series interpolation --sum 1"})
        CHECK_FALSE(contains(run(folder, std::string("expand in.obj -o out.obj ") + way).err, "place"));

    const json band = report_of(run(folder, "expand in.obj -o out.obj --band 1:4 --report -"));
    CHECK(band.at("status") == "ok");
    CHECK(band.at("command") == "expand");
    CHECK(band.at("scheme") == "loop");
    CHECK(band.at("mesh").at("vertices") == 6);
    CHECK(band.at("device").at("name").is_string());
    CHECK(band.at("parameters").at("series") == "representation");
    CHECK(band.at("parameters").at("band") == json({1, 4}));
    CHECK(band.at("parameters").at("precision") == "mixed");
    for (const char* phase : {"read", "topology", "solve", "write", "total"}) CHECK(band.at("seconds").at(phase).get<double>() > 0.0);
    const json equaliser = report_of(run(folder, "expand in.obj -o out.obj --equaliser 1,0.5:2 --report -")).at("parameters");
    CHECK(equaliser.at("weights") == json({1.0, 0.5}));
    CHECK(equaliser.at("remainder") == 2.0);
    CHECK(report_of(run(folder, "expand in.obj -o out.obj --term 5 --report -")).at("parameters").at("term") == 5);
    const json sum = report_of(run(folder, "expand in.obj -o out.obj --sum 5 --series interpolation --report -")).at("parameters");
    CHECK(sum.at("sum") == 5);
    CHECK(sum.at("series") == "interpolation");
}

TEST_CASE("the interpolation series of a singular operator is written only with --keep-going", "[cli][expand][exit]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    const Outcome refused = run(folder, "expand cube.obj -o out.obj --series interpolation --sum 2 --report -");
    INFO(refused.err);
    CHECK(refused.exit_code == 4);
    CHECK_FALSE(folder.has("out.obj"));
    CHECK(contains(last_line(refused.err), "alpha"));
    CHECK(report_of(refused).at("status") == "singular");
    CHECK_FALSE(report_of(refused).at("where").at("vertices").empty());

    const Plain A((folder.path / "cube.obj").string(), scheme_of(LCL_SCHEME_CATMULL_CLARK));
    const Outcome going = run(folder, "expand cube.obj -o out.obj --series interpolation --sum 2 --keep-going");
    CHECK(going.exit_code == 4);
    CHECK(largest_difference(points_of(folder, "out.obj"), series(A, A.points, {1, 1, 1}, true)) <= 1e-12 * A.diagonal);

    CHECK(run(folder, "expand cube.obj -o out.obj --series interpolation --sum 2 --alpha auto").exit_code == 0);
    REQUIRE(run(folder, "expand cube.obj -o out.obj --sum 2").exit_code == 0);
    CHECK(largest_difference(points_of(folder, "out.obj"), series(A, A.points, {1, 1, 1}, false)) <= 1e-12 * A.diagonal);
}

TEST_CASE("spectrum gives the energies of the terms", "[cli][spectrum]") {
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "grid", "grid, Doo-Sabin", "octahedron", "cube");
    const Case mesh = case_of(name);
    folder.file("in.obj", mesh.text);
    const Plain A((folder.path / "in.obj").string(), mesh.scheme);
    const std::size_t vertices = A.points.size() / 3;
    std::vector<double> faces_at(vertices, 0.0), D(vertices);
    std::vector<std::int32_t> corners(static_cast<std::size_t>(lcl_mesh_corner_count(A.mesh.get())));
    capi_test::succeed(lcl_mesh_get_faces(A.mesh.get(), nullptr, corners.data()));
    for (const std::int32_t vertex : corners) faces_at[static_cast<std::size_t>(vertex)] += 1.0;
    for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
        const double n = faces_at[vertex], c = 0.375 + std::cos(2.0 * std::acos(-1.0) / n) / 4.0;
        const double alpha = 3.0 / (11.0 - 8.0 * (0.375 + c * c));
        D[vertex] = mesh.scheme.scheme == LCL_SCHEME_LOOP ? n / (1.0 - alpha) : mesh.scheme.scheme == LCL_SCHEME_DOO_SABIN ? n : n * (n + 5.0);
    }
    const auto energy = [&](const Values& term, std::size_t axis) {
        double weight = 0.0, mean = 0.0, square = 0.0;
        for (std::size_t vertex = 0; vertex < vertices; ++vertex) weight += D[vertex], mean += D[vertex] * term[3 * vertex + axis];
        mean /= weight;
        for (std::size_t vertex = 0; vertex < vertices; ++vertex) square += D[vertex] * std::pow(term[3 * vertex + axis] - mean, 2);
        return square / weight;
    };
    const std::string precision = GENERATE(as<std::string>(), "single", "double");
    const Outcome outcome = run(folder, "spectrum in.obj --terms 5 " + mesh.options + " --precision " + precision);
    INFO(name << ", " << precision << "\n" << outcome.out << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto rows = csv_rows(outcome.out, "term,energy,x,y,z");
    REQUIRE(rows.size() == 5);
    Values rest = A.points;
    for (std::size_t term = 0; term < rows.size(); ++term) {
        const Values limit = A.apply(rest);
        REQUIRE(rows[term].size() == 5);
        CHECK(rows[term][0] == static_cast<double>(term));
        CHECK(rows[term][1] == rows[term][2] + rows[term][3] + rows[term][4]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            CHECK(rows[term][2 + axis] == Approx(energy(limit, axis)).margin(tolerance_of(precision) * A.diagonal * A.diagonal));
        rest = sum(rest, -1.0, limit);
    }
}

TEST_CASE("a spectrum goes to standard output, a table, a chart, or the report", "[cli][spectrum]") {
    const Folder folder;
    folder.file("a&b.obj", octahedron);
    folder.file("in.ply", coloured_tetrahedron_ply());
    const Outcome plain = run(folder, "spectrum 'a&b.obj'");
    REQUIRE(plain.exit_code == 0);
    CHECK(csv_rows(plain.out, "term,energy,x,y,z").size() == 16);
    REQUIRE(run(folder, "spectrum 'a&b.obj' -o table.csv").exit_code == 0);
    CHECK(folder.read("table.csv") == plain.out);
    CHECK(run(folder, "spectrum - --format obj --quiet", "", (folder.path / "a&b.obj").string()).out == plain.out);

    REQUIRE(run(folder, "spectrum 'a&b.obj' --terms 7 -o chart.SVG").exit_code == 0);
    const std::string chart = folder.read("chart.SVG");
    CHECK(chart.rfind("<svg xmlns=\"http://www.w3.org/2000/svg\"", 0) == 0);
    CHECK(contains(chart, "a&amp;b.obj"));
    CHECK(contains(chart, "prefers-color-scheme"));
    std::size_t bars = 0;
    for (std::size_t place = chart.find("class=\"bar\""); place != std::string::npos; place = chart.find("class=\"bar\"", place + 1)) ++bars;
    CHECK(bars == 7);
    CHECK(chart.substr(chart.size() - 7) == "</svg>\n");
    CHECK_FALSE(contains(chart, "nan"));

    const Outcome channels = run(folder, "spectrum in.ply --terms 3 --channels quality,red");
    const auto rows = csv_rows(channels.out, "term,energy,x,y,z,quality,red");
    REQUIRE(rows.size() == 3);
    CHECK(rows[0][5] > 0.0);
    CHECK(rows[0][1] == rows[0][2] + rows[0][3] + rows[0][4]);

    const Outcome report = run(folder, "spectrum in.ply --terms 3 --channels quality,red --report -");
    const json json_rows = report_of(report).at("spectrum");
    REQUIRE(json_rows.size() == 3);
    for (std::size_t term = 0; term < 3; ++term) {
        CHECK(json_rows[term].at("term") == term);
        CHECK(json_rows[term].at("energy") == rows[term][1]);
        CHECK(json_rows[term].at("quality") == rows[term][5]);
    }
    CHECK(report_of(report).at("parameters").at("terms") == 3);
    CHECK(run(folder, "spectrum in.ply -o no-such-folder/out.csv").exit_code == 1);
}

TEST_CASE("denoise gives D^k A and D^k", "[cli][denoise]") {
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "grid", "grid, Doo-Sabin", "octahedron", "cube");
    const Case mesh = case_of(name);
    folder.file("in.obj", mesh.text);
    const Plain A((folder.path / "in.obj").string(), mesh.scheme);
    struct Way {
        std::string arguments;
        int m, k;
        bool plain;
    };
    for (const Way& way :
         {Way{"", 2, 3, false}, Way{"--plain", 2, 3, true}, Way{"--m 0 --k 1", 0, 1, false}, Way{"--m 5 --k 2 --plain", 5, 2, true},
          Way{"--strength 0", 2, 0, false}, Way{"--strength 0.5", 2, 3, false}, Way{"--strength 1", 1, 100, false}, Way{"--k 0 --plain", 2, 0, true}}) {
        for (const char* precision : {"single", "mixed"}) {
            const Outcome outcome =
                run(folder, "denoise in.obj -o out.obj " + mesh.options + " " + way.arguments + " --precision " + precision + " --report -");
            INFO(name << ", " << precision << ", " << way.arguments << "\n" << outcome.err);
            REQUIRE(outcome.exit_code == 0);
            CHECK(largest_difference(points_of(folder, "out.obj"), denoised(A, A.points, way.m, way.k, way.plain)) <= tolerance_of(precision) * A.diagonal);
            const json report = report_of(outcome);
            CHECK(report.at("parameters").at("plain") == way.plain);
            CHECK(report.at("parameters").at("operator") == "limit");
            if (way.k > 0) CHECK(report.at("parameters").at("m") == way.m);
            CHECK(report.at("parameters").at("k") == way.k);
            CHECK(report.contains("volume") == (name == "octahedron" || name == "cube"));
        }
    }
}

TEST_CASE("--keep-volume gives a closed mesh its volume back", "[cli][denoise]") {
    const Folder folder;
    folder.file("in.obj", rough_block(4));
    folder.file("open.obj", bumpy_grid(4));
    folder.file("pins.txt", "0\n17\n40\n");
    const double before = volume_of((folder.path / "in.obj").string());
    CHECK(before > 30.0);  // a block of 4 x 4 x 4 with dents
    const json shrunk = report_of(run(folder, "denoise in.obj -o out.obj --report -")).at("volume");
    CHECK(shrunk[0].get<double>() == Approx(before).epsilon(1e-12));
    CHECK(shrunk[1].get<double>() == Approx(volume_of((folder.path / "out.obj").string())).epsilon(1e-12));
    CHECK(shrunk[1].get<double>() < 0.95 * before);

    const std::string pins = GENERATE(as<std::string>(), "", " --pin pins.txt");
    const Outcome kept = run(folder, "denoise in.obj -o out.obj --keep-volume --report -" + pins);
    REQUIRE(kept.exit_code == 0);
    CHECK(volume_of((folder.path / "out.obj").string()) == Approx(before).epsilon(1e-9));
    CHECK(report_of(kept).at("volume")[1].get<double>() == Approx(before).epsilon(1e-9));
    CHECK(report_of(kept).at("parameters").at("keep_volume") == true);
    CHECK(report_of(kept).at("warnings").empty());
    if (!pins.empty()) {
        const Values given = points_of(folder, "in.obj"), out = points_of(folder, "out.obj");
        for (const std::size_t vertex : {0u, 17u, 40u}) {
            for (std::size_t axis = 0; axis < 3; ++axis) CHECK(out[3 * vertex + axis] == given[3 * vertex + axis]);
        }
    }

    fs::remove(folder.path / "out.obj");
    const Outcome open = run(folder, "denoise open.obj -o out.obj --keep-volume --device no-such-device-anywhere");
    CHECK(open.exit_code == 3);  // before a device is asked for
    CHECK(contains(open.err, "boundary"));
    CHECK(contains(open.err, "--keep-volume"));
    CHECK_FALSE(folder.has("out.obj"));
}

TEST_CASE("pinned vertices stay to the bit, the others are filtered as if they were given", "[cli][denoise]") {
    const Folder folder;
    folder.file("in.obj", bumpy_grid(6));
    folder.file("pins.txt", "8\n24\n25\n40\n");
    std::string all;
    for (int vertex = 0; vertex < 49; ++vertex) all += std::to_string(vertex) + "\n";
    folder.file("all.txt", all);
    const Values given = points_of(folder, "in.obj");
    std::vector<std::int32_t> free;
    for (std::int32_t vertex = 0; vertex < 49; ++vertex) {
        if (vertex != 8 && vertex != 24 && vertex != 25 && vertex != 40) free.push_back(vertex);
    }
    lcl_scheme_options options = scheme_of(LCL_SCHEME_CATMULL_CLARK);
    options.subset = free.data();
    options.subset_count = free.size();
    const Plain A((folder.path / "in.obj").string(), options);
    const Outcome outcome = run(folder, "denoise in.obj -o out.obj --pin pins.txt --report -");
    REQUIRE(outcome.exit_code == 0);
    CHECK(report_of(outcome).at("parameters").at("pinned") == 4);
    const Values out = points_of(folder, "out.obj");
    for (const std::size_t vertex : {8u, 24u, 25u, 40u}) {
        for (std::size_t axis = 0; axis < 3; ++axis) CHECK(out[3 * vertex + axis] == given[3 * vertex + axis]);
    }
    CHECK(largest_difference(out, denoised(A, A.points, 2, 3, false)) <= 1e-12 * A.diagonal);
    CHECK(largest_difference(out, given) > 0.1);
    REQUIRE(run(folder, "denoise in.obj -o out.obj --pin all.txt").exit_code == 0);
    CHECK(points_of(folder, "out.obj") == given);
}

TEST_CASE("--operator features denoises with the feature-preserving operator", "[cli][denoise]") {
    const Folder folder;
    folder.file("in.obj", rough_block(4));
    folder.file("pins.txt", "3\n50\n");
    const std::string path = (folder.path / "in.obj").string();
    const Plain A(path, lcl_feature_options(LCL_FEATURE_OPTIONS_INIT));
    const Outcome outcome = run(folder, "denoise in.obj -o out.obj --operator features --m 1 --k 2 --report -");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const Values out = points_of(folder, "out.obj");
    CHECK(largest_difference(out, denoised(A, A.points, 1, 2, false)) <= 1e-12 * A.diagonal);
    CHECK(largest_difference(out, A.points) > 0.01);
    const json report = report_of(outcome);
    CHECK(report.at("parameters").at("operator") == "features");
    CHECK_FALSE(report.contains("scheme"));  // it is no scheme's
    CHECK_FALSE(report.at("parameters").contains("alpha"));

    std::vector<std::int32_t> free;
    for (std::int32_t vertex = 0; vertex < static_cast<std::int32_t>(A.points.size() / 3); ++vertex) {
        if (vertex != 3 && vertex != 50) free.push_back(vertex);
    }
    lcl_feature_options options = LCL_FEATURE_OPTIONS_INIT;
    options.subset = free.data();
    options.subset_count = free.size();
    const Plain pinned(path, options);
    REQUIRE(run(folder, "denoise in.obj -o out.obj --operator features --plain --pin pins.txt").exit_code == 0);
    const Values held = points_of(folder, "out.obj");
    CHECK(largest_difference(held, denoised(pinned, A.points, 2, 3, true)) <= 1e-12 * A.diagonal);
    for (const std::size_t vertex : {3u, 50u}) {
        for (std::size_t axis = 0; axis < 3; ++axis) CHECK(held[3 * vertex + axis] == A.points[3 * vertex + axis]);
    }
}

TEST_CASE("sharpen adds the terms of its band", "[cli][sharpen]") {
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "grid", "octahedron", "cube");
    const Case mesh = case_of(name);
    folder.file("in.obj", mesh.text);
    const Plain A((folder.path / "in.obj").string(), mesh.scheme);
    struct Way {
        std::string arguments;
        int first, last, k;
    };
    for (const Way& way : {Way{"", 1, 3, 1}, Way{"--band 2:2 --k 3", 2, 2, 3}, Way{"--band 1:1 --k 2", 1, 1, 2}}) {
        for (const char* precision : {"single", "double"}) {
            const Outcome outcome =
                run(folder, "sharpen in.obj -o out.obj " + mesh.options + " " + way.arguments + " --precision " + precision + " --report -");
            INFO(name << ", " << precision << ", " << way.arguments << "\n" << outcome.err);
            REQUIRE(outcome.exit_code == 0);
            CHECK(largest_difference(points_of(folder, "out.obj"), sharpened(A, A.points, way.first, way.last, way.k)) <= tolerance_of(precision) * A.diagonal);
            CHECK(report_of(outcome).at("parameters").at("band") == json({way.first, way.last}));
            CHECK(report_of(outcome).at("parameters").at("k") == way.k);
        }
    }
    const Outcome refused = run(folder, "sharpen in.obj -o loud.obj --k 30 " + mesh.options);
    CHECK(refused.exit_code == 2);
    CHECK(contains(last_line(refused.err), "10^6"));
    CHECK_FALSE(folder.has("loud.obj"));
}

TEST_CASE("morph writes every frame of the recursion", "[cli][morph]") {
    const Folder folder;
    folder.file("from.obj", bumpy_grid(6));
    REQUIRE(run(folder, "sharpen from.obj -o to.obj --band 1:2 --k 2").exit_code == 0);
    const Plain A((folder.path / "from.obj").string(), scheme_of(LCL_SCHEME_CATMULL_CLARK));
    const Values to = points_of(folder, "to.obj");
    struct Way {
        std::string arguments;
        std::vector<int> m;
        std::vector<double> rho;
    };
    for (const Way& way : {Way{"", {2, 2, 2, 2}, {0.5, 0.5, 0.5, 0.5}}, Way{"--m 0,3 --rho 1,0.25,0.75", {0, 3, 3, 3}, {1, 0.25, 0.75, 0.75}}}) {
        for (const char* precision : {"single", "mixed"}) {
            const std::size_t entries = folder.entries();
            const Outcome outcome = run(folder, "morph from.obj to.obj -o f_%03d.obj --frames 4 --precision " + std::string(precision) + " " + way.arguments);
            INFO(way.arguments << ", " << precision << "\n" << outcome.err);
            REQUIRE(outcome.exit_code == 0);
            CHECK(folder.entries() == entries + 5);
            CHECK(points_of(folder, "f_000.obj") == A.points);
            Values difference = sum(A.points, -1.0, to);
            for (std::size_t step = 0; step < 4; ++step) {
                difference = filtered(A, difference, way.m[step]);
                for (double& value : difference) value *= way.rho[step];
                const Values frame = points_of(folder, "f_00" + std::to_string(step + 1) + ".obj");
                CHECK(largest_difference(frame, sum(to, 1.0, difference)) <= tolerance_of(precision) * A.diagonal);
            }
            for (int frame = 0; frame <= 4; ++frame) fs::remove(folder.path / ("f_00" + std::to_string(frame) + ".obj"));
        }
    }
}

TEST_CASE("morph names its frames and has three paths", "[cli][morph]") {
    const Folder folder;
    folder.file("from.obj", octahedron);
    REQUIRE(run(folder, "denoise from.obj -o to.obj --k 1").exit_code == 0);
    const Values from = points_of(folder, "from.obj"), to = points_of(folder, "to.obj");
    REQUIRE(run(folder, "morph from.obj to.obj -o n%d.obj").exit_code == 0);
    for (int frame = 0; frame <= 10; ++frame) CHECK(folder.has("n" + std::to_string(frame) + ".obj"));
    CHECK(folder.entries() == 13);

    const Outcome even = run(folder, "morph from.obj to.obj -o e%02d.ply --even --frames 3 --m 3 --report report.json");
    REQUIRE(even.exit_code == 0);
    for (const char* frame : {"e00.ply", "e01.ply", "e02.ply", "e03.ply"}) CHECK(folder.has(frame));
    const json report = json::parse(folder.read("report.json"));
    CHECK(report.at("parameters").at("path") == "even");
    CHECK(report.at("parameters").at("frames") == 3);
    CHECK(report.at("parameters").at("m") == json({3}));
    CHECK_FALSE(report.at("parameters").contains("rho"));
    CHECK(report.at("parameters").at("to") == "to.obj");
    CHECK(report.at("seconds").at("write").get<double>() > 0.0);
    REQUIRE(run(folder, "limit e03.ply --lambda 1 -o last.obj").exit_code == 0);
    CHECK(points_of(folder, "last.obj") == to);

    REQUIRE(run(folder, "morph from.obj to.obj -o l%d.obj --linear --frames 4").exit_code == 0);
    CHECK(points_of(folder, "l4.obj") == to);
    CHECK(largest_difference(points_of(folder, "l1.obj"), sum(from, 0.25, sum(to, -1.0, from))) <= 1e-15 * 4.0);
    const Outcome unused = run(folder, "morph from.obj to.obj -o l%d.obj --linear --m 3 --report -");
    CHECK(unused.exit_code == 0);
    CHECK(report_of(unused).at("warnings").size() == 1);
    const Outcome more = run(folder, "morph from.obj to.obj -o l%d.obj --rho 0.5,0.4,0.3 --frames 2 --report -");
    CHECK(report_of(more).at("warnings").size() == 1);
    CHECK(report_of(more).at("parameters").at("rho") == json({0.5, 0.4}));
    CHECK(report_of(more).at("parameters").at("m") == json({2}));
}

TEST_CASE("meshes of a morph have the same faces", "[cli][morph][exit]") {
    const Folder folder;
    folder.file("from.obj", octahedron);
    folder.file("quads.obj", cube);
    std::string turned = octahedron;  // the same face, begun elsewhere
    turned.replace(turned.find("f 1 5 6"), 7, "f 6 1 5");
    folder.file("turned.obj", turned);
    folder.file("more.obj", "v 9 9 9\n" + octahedron);
    folder.file("broken.obj", "v 0 0 0\nv 1 0\n");
    const std::size_t entries = folder.entries();
    const auto [to, part] = GENERATE(table<std::string, std::string>(
        {{"quads.obj", "vertices"}, {"turned.obj", "face 7"}, {"more.obj", "vertices"}, {"broken.obj", "broken.obj:2"}, {"missing.obj", "missing.obj"}}));
    const Outcome outcome = run(folder, "morph from.obj " + to + " -o f%d.obj --report -");
    INFO(to << "\n" << outcome.err);
    CHECK(outcome.exit_code == 3);
    CHECK(contains(last_line(outcome.err), to));
    CHECK(contains(last_line(outcome.err), part));
    CHECK(report_of(outcome).at("status") == "bad-input");
    CHECK(folder.entries() == entries);
}

TEST_CASE("colours of FROM pass through a morph, or go to those of TO", "[cli][morph][channels]") {
    const Folder folder;
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\nproperty uchar "
        "green\nproperty uchar blue\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    folder.file("from.ply", header + "0 0 0 255 0 10\n1 0 0 0 255 20\n0 1 0 0 0 255\n0 0 1 128 128 30\n" + faces);
    folder.file("to.ply", header + "0 0 0 0 0 0\n2 0 0 0 0 0\n0 2 0 0 0 0\n0 0 2 0 0 0\n" + faces);
    folder.file("plain.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    const auto colours = [&](const std::string& name) {
        const std::string text = folder.read(name);
        CHECK(contains(text, "property uchar red"));
        std::istringstream stream(text.substr(text.find("end_header\n") + 11));
        Values values;
        for (int index = 0; index < 24; ++index) {
            double value = 0.0;
            stream >> value;
            if (index % 6 >= 3) values.push_back(value);
        }
        return values;
    };
    REQUIRE(run(folder, "morph from.ply to.ply -o p%d.ply --frames 3").exit_code == 0);
    for (const char* frame : {"p0.ply", "p1.ply", "p3.ply"}) CHECK(colours(frame) == colours("from.ply"));
    const Outcome channels = run(folder, "morph from.ply to.ply -o c%d.ply --frames 3 --linear --channels colours --report -");
    REQUIRE(channels.exit_code == 0);
    CHECK(report_of(channels).at("warnings").empty());
    CHECK(colours("c0.ply") == colours("from.ply"));
    CHECK(colours("c3.ply") == colours("to.ply"));
    CHECK(colours("c1.ply")[0] == 170.0);
    const Outcome missing = run(folder, "morph from.ply plain.obj -o m%d.ply --channels colours");
    CHECK(missing.exit_code == 3);
    CHECK(contains(missing.err, "plain.obj"));
    CHECK_FALSE(folder.has("m0.ply"));
    CHECK(run(folder, "morph from.ply plain.obj -o m%d.ply --frames 2").exit_code == 0);
}

TEST_CASE("filters keep whole-number colours in their range", "[cli][channels]") {
    const Folder folder;
    std::ostringstream text;
    text << "ply\nformat ascii 1.0\nelement vertex 49\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\nproperty uchar green\n"
            "property uchar blue\nproperty int label\nelement face 36\nproperty list uchar int vertex_indices\nend_header\n";
    for (int vertex = 0; vertex < 49; ++vertex)
        text << vertex % 7 << " " << vertex / 7 << " 0 " << (vertex % 2 == 0 ? 25 : 230) << " " << vertex * 5 << " 255 " << vertex % 3 << "\n";
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 6; ++x) text << "4 " << 7 * y + x << " " << 7 * y + x + 1 << " " << 7 * y + x + 8 << " " << 7 * y + x + 7 << "\n";
    }
    folder.file("in.ply", text.str());
    const auto red = [&](const std::string& name) {
        const std::string written = folder.read(name);
        std::istringstream stream(written.substr(written.find("end_header\n") + 11));
        Values values;
        for (int index = 0; index < 49 * 7; ++index) {
            double value = 0.0;
            stream >> value;
            if (index % 7 == 3) values.push_back(value);
        }
        return values;
    };
    for (const char* command : {"denoise", "sharpen --k 3"}) {
        const Outcome outcome = run(folder, std::string(command) + " in.ply -o out.ply --channels colours --report -");
        INFO(command << outcome.err);
        REQUIRE(outcome.exit_code == 0);
        CHECK(report_of(outcome).at("warnings").empty());
        CHECK(report_of(outcome).at("parameters").at("channels") == json({"red", "green", "blue"}));
        CHECK(contains(folder.read("out.ply"), "property uchar red"));
        CHECK(contains(folder.read("out.ply"), "property int label"));
        CHECK(red("out.ply") != red("in.ply"));
    }
    const Values loud = red("out.ply");
    CHECK(*std::max_element(loud.begin(), loud.end()) == 255.0);  // overshoot is cut
    CHECK(*std::min_element(loud.begin(), loud.end()) == 0.0);
    // terms are no colours: they are kept as they are, with a warning
    const Outcome term = run(folder, "expand in.ply -o term.ply --term 1 --channels red --report -");
    CHECK(report_of(term).at("warnings").size() == 1);
    CHECK(contains(folder.read("term.ply"), "property double red"));
}

TEST_CASE("texture colours the refined mesh at its limit points", "[cli][texture]") {
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "octahedron", "grid", "grid, Doo-Sabin");
    const Case mesh = case_of(name);
    folder.file("in.obj", mesh.text);
    const std::string common = "texture in.obj --octaves 3 --colors '#102030,#f0e0d0' --frequency 5 " + mesh.options;
    const Outcome outcome = run(folder, common + " -o out.ply --levels 3 --seed 7 --report -");
    INFO(name << "\n" << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    REQUIRE(run(folder, "refine in.obj -o fine.ply --limit --levels 3 " + mesh.options).exit_code == 0);
    const capi_test::Mesh out = read_mesh((folder.path / "out.ply").string()), fine = read_mesh((folder.path / "fine.ply").string());
    CHECK(lcl_mesh_compare_faces(out.get(), fine.get()) == LCL_OK);
    CHECK(largest_difference(points_of(out.get()), points_of(fine.get())) <= 1e-12 * 10.0);  // diagonals up to 8.5
    const Values noise = property_of(out.get(), "noise");
    CHECK(*std::min_element(noise.begin(), noise.end()) == 0.0);
    CHECK(*std::max_element(noise.begin(), noise.end()) == 1.0);
    // a spline through two colours is the straight line between them
    const double first[] = {16, 32, 48}, second[] = {240, 224, 208};
    std::size_t channel = 0;
    for (const char* colour : {"red", "green", "blue"}) {
        const Values values = property_of(out.get(), colour);
        double largest = 0.0;
        for (std::size_t vertex = 0; vertex < noise.size(); ++vertex)
            largest = std::max(largest, std::abs(values[vertex] - (first[channel] + noise[vertex] * (second[channel] - first[channel]))));
        CHECK(largest <= 0.5 + 1e-9);  // whole numbers
        ++channel;
    }
    CHECK(contains(folder.read("out.ply").substr(0, 500), "property uchar red"));
    const json report = report_of(outcome);
    CHECK(report.at("parameters").at("octaves") == 3);
    CHECK(report.at("parameters").at("levels") == 3);
    CHECK(report.at("parameters").at("frequency") == 5.0);
    CHECK(report.at("parameters").at("seed") == 7);
    CHECK(report.at("parameters").at("colors").size() == 6);
    CHECK(report.at("parameters").at("tolerance") == 1e-6);
    CHECK(report.at("converged") == true);
    CHECK(report.at("max_error").get<double>() > 0.0);
    CHECK(report.at("residuals").size() == report.at("iterations").get<std::size_t>() + 1);

    REQUIRE(run(folder, common + " -o again.ply --levels 3 --seed 7").exit_code == 0);
    CHECK(folder.read("again.ply") == folder.read("out.ply"));
    REQUIRE(run(folder, common + " -o other.ply --levels 3 --seed 8").exit_code == 0);
    CHECK(largest_difference(property_of(read_mesh((folder.path / "other.ply").string()).get(), "noise"), noise) > 0.1);
    const json standard = report_of(run(folder, common + " -o least.ply --report -"));
    CHECK(standard.at("parameters").at("levels") == 2);
}

TEST_CASE("texture --on-mesh gives the mesh itself the colours of its vertices", "[cli][texture]") {
    const Folder folder;
    folder.file("grid.obj", bumpy_grid(4) + "vt 0 0\n");
    folder.file("in.ply", coloured_tetrahedron_ply());
    REQUIRE(run(folder, "texture grid.obj -o fine.ply --octaves 2").exit_code == 0);
    const Outcome outcome = run(folder, "texture grid.obj -o out.ply --octaves 2 --on-mesh --report -");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(report_of(outcome).at("parameters").at("on_mesh") == true);
    const capi_test::Mesh fine = read_mesh((folder.path / "fine.ply").string()), out = read_mesh((folder.path / "out.ply").string()),
                          given = read_mesh((folder.path / "grid.obj").string());
    CHECK(lcl_mesh_compare_faces(out.get(), given.get()) == LCL_OK);
    CHECK(points_of(out.get()) == points_of(given.get()));
    for (const char* name : {"red", "green", "blue", "noise"}) {
        Values all = property_of(fine.get(), name);
        all.resize(25);
        CHECK(property_of(out.get(), name) == all);
    }
    CHECK(contains(folder.read("out.ply").substr(0, 500), "property uchar red"));
    REQUIRE(run(folder, "texture grid.obj -o out.obj --octaves 2 --on-mesh").exit_code == 0);
    const Values red = property_of(read_mesh((folder.path / "out.obj").string()).get(), "red"), in_bytes = property_of(out.get(), "red");
    for (std::size_t vertex = 0; vertex < red.size(); ++vertex) CHECK(std::lround(255.0 * red[vertex]) == std::lround(in_bytes[vertex]));
    // colours that were there are replaced, other data stays
    REQUIRE(run(folder, "texture in.ply -o coloured.ply --octaves 2 --on-mesh").exit_code == 0);
    const capi_test::Mesh coloured = read_mesh((folder.path / "coloured.ply").string());
    CHECK(property_of(coloured.get(), "quality") == Values{5, -3, 7, 1});
    CHECK(lcl_mesh_property_count(coloured.get()) == 5);
}

TEST_CASE("a texture on a singular operator is written only with --keep-going", "[cli][texture][exit]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    const Outcome refused = run(folder, "texture cube.obj -o out.ply --octaves 2 --report -");
    INFO(refused.err);
    CHECK(refused.exit_code == 4);
    CHECK_FALSE(folder.has("out.ply"));
    CHECK(contains(last_line(refused.err), "alpha"));
    CHECK(report_of(refused).at("status") == "singular");
    const Outcome going = run(folder, "texture cube.obj -o out.ply --octaves 2 --keep-going");
    CHECK(going.exit_code == 4);
    CHECK(property_of(read_mesh((folder.path / "out.ply").string()).get(), "noise").size() == 26);
    const Outcome cured = run(folder, "texture cube.obj -o out.ply --octaves 2 --alpha auto --report -");
    CHECK(cured.exit_code == 0);
    CHECK(report_of(cured).at("parameters").at("alpha") == 0.5);
}

TEST_CASE("a texture that does not fit is exit code 5 with the number", "[cli][texture][exit]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    const Outcome outcome = run(folder, "texture in.obj -o out.ply --levels 15");
    INFO(outcome.err);
    CHECK(outcome.exit_code == 5);
    CHECK(contains(last_line(outcome.err), "level"));
    CHECK_FALSE(folder.has("out.ply"));
}

TEST_CASE("filters work through pipes and in place", "[cli][io]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    const Plain A((folder.path / "in.obj").string(), scheme_of(LCL_SCHEME_LOOP));
    const Outcome piped = run(folder, "denoise - -o - --format obj --quiet", "", (folder.path / "in.obj").string());
    REQUIRE(piped.exit_code == 0);
    CHECK(piped.err.empty());
    folder.file("out.obj", piped.out);
    CHECK(largest_difference(points_of(folder, "out.obj"), denoised(A, A.points, 2, 3, false)) <= 1e-12 * A.diagonal);
    REQUIRE(run(folder, "denoise in.obj -o in.obj --quiet").err.empty());
    CHECK(points_of(folder, "in.obj") == points_of(folder, "out.obj"));
    REQUIRE(run(folder, "morph - out.obj -o f%d.obj --format obj --frames 1", "", (folder.path / "in.obj").string()).exit_code == 0);
    CHECK(points_of(folder, "f0.obj") == points_of(folder, "in.obj"));
    CHECK(run(folder, "sharpen in.obj -o no-such-folder/out.obj").exit_code == 1);
    CHECK(run(folder, "morph in.obj out.obj -o no-such-folder/%d.obj").exit_code == 1);
}

TEST_CASE("wrong usage of the filters is exit code 2 with one line that says what to do", "[cli][exit]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    folder.file("quads.obj", cube);
    const auto [arguments, part] = GENERATE(table<std::string, std::string>({
        {"expand in.obj -o out.obj", "--term"},
        {"expand in.obj --sum 1", "--output"},
        {"expand in.obj -o out.obj --term 1 --sum 2", "exactly one"},
        {"expand in.obj -o out.obj --term -1", "from 0 to 100000"},
        {"expand in.obj -o out.obj --term 100001", "from 0 to 100000"},
        {"expand in.obj -o out.obj --sum two", "from 0 to 100000"},
        {"expand in.obj -o out.obj --band 3", "I:J"},
        {"expand in.obj -o out.obj --band 3:1", "I <= J"},
        {"expand in.obj -o out.obj --band 1:2:3", "I:J"},
        {"expand in.obj -o out.obj --band 1:", "I:J"},
        {"expand in.obj -o out.obj --equaliser ''", "no number"},
        {"expand in.obj -o out.obj --equaliser 1,,2", "no number"},
        {"expand in.obj -o out.obj --equaliser 1,nan", "no number"},
        {"expand in.obj -o out.obj --equaliser 1:2:3", "w0,..,wm"},
        {"expand in.obj -o out.obj --equaliser 1:", "no number"},
        {"expand in.obj -o out.obj --equaliser 1,2:1 --series interpolation", "remainder"},
        {"expand in.obj -o out.obj --sum 1 --series fourier", "interpolation"},
        {"expand in.obj -o out.xyz --sum 1", "out.xyz"},
        {"spectrum in.obj --terms 0", "from 1 to 100000"},
        {"spectrum in.obj -o out.txt", ".csv or .svg"},
        {"spectrum in.obj -o out.obj", ".csv or .svg"},
        {"spectrum in.obj -o - --report -", "--report"},
        {"spectrum in.obj -o out.csv --report out.csv", "out.csv"},
        {"spectrum -", "--format"},
        {"denoise in.obj -o out.obj --m -1", "from 0 to 100000"},
        {"denoise in.obj -o out.obj --m 1,2", "from 0 to 100000"},
        {"denoise in.obj -o out.obj --k 1.5", "from 0 to 100000"},
        {"denoise in.obj -o out.obj --strength 1.1", "from 0 to 1"},
        {"denoise in.obj -o out.obj --strength nan", "from 0 to 1"},
        {"denoise in.obj -o out.obj --strength 0.5 --m 2", "--strength"},
        {"denoise in.obj -o out.obj --strength 0.5 --k 3", "--strength"},
        {"denoise in.obj -o out.obj --operator bilateral", "features"},
        {"denoise in.obj -o out.obj --operator features --scheme loop", "--scheme"},
        {"denoise in.obj -o out.obj --operator features --alpha 0", "--alpha"},
        {"denoise in.obj -o out.obj --operator features --lambda 0.3", "--lambda"},
        {"denoise in.obj -o out.obj --operator features --mask classic", "--mask"},
        {"denoise in.obj -o out.obj --channels heat", "heat"},
        {"denoise quads.obj -o out.stl", "STL"},
        {"sharpen in.obj -o out.obj --band 0:3", "1 <= I"},
        {"sharpen in.obj -o out.obj --band 3:2", "I <= J"},
        {"sharpen in.obj -o out.obj --k 0", "from 1 to 100000"},
        {"sharpen in.obj -o out.obj --band 1:10000 --k 2", "10^6"},
        {"morph in.obj in.obj", "--output"},
        {"morph in.obj -o f%d.obj", "TO"},
        {"morph in.obj in.obj -o out.obj", "%d"},
        {"morph in.obj in.obj -o -", "pattern"},
        {"morph in.obj in.obj -o f%d_%d.obj", "exactly one"},
        {"morph in.obj in.obj -o f%s.obj", "exactly one"},
        {"morph in.obj in.obj -o f%3d.obj", "exactly one"},
        {"morph in.obj in.obj -o f%012d.obj", "exactly one"},
        {"morph in.obj in.obj -o f%d%n.obj", "exactly one"},
        {"morph in.obj in.obj -o f%d%%.obj", "exactly one"},
        {"morph in.obj in.obj -o f%-3d.obj", "exactly one"},
        {"morph in.obj in.obj -o f%ld.obj", "exactly one"},
        {"morph in.obj in.obj -o f.obj%", "exactly one"},
        {"morph in.obj in.obj -o f%d.xyz", "xyz"},
        {"morph in.obj in.xyz -o f%d.obj", "in.xyz"},
        {"morph - - -o f%d.obj --format obj", "both"},
        {"morph in.obj in.obj -o f%d.obj --frames 0", "from 1 to 1000000"},
        {"morph in.obj in.obj -o f%d.obj --m 1,x", "from 0 to 100000"},
        {"morph in.obj in.obj -o f%d.obj --m ''", "from 0 to 100000"},
        {"morph in.obj in.obj -o f%d.obj --rho 0", "above 0 and up to 1"},
        {"morph in.obj in.obj -o f%d.obj --rho 0.5,1.5", "above 0 and up to 1"},
        {"morph in.obj in.obj -o f%d.obj --even --rho 0.5", "--rho"},
        {"morph in.obj in.obj -o f%d.obj --even --linear", "--linear"},
        {"morph in.obj in.obj -o f%d.obj --report f10.obj", "f10.obj"},
        {"morph in.obj quads.obj -o f%d.obj --scheme loop --mask classic", "--mask"},
        {"texture in.obj", "--output"},
        {"texture in.obj -o out.ply --octaves 0", "from 1 to 20"},
        {"texture in.obj -o out.ply --octaves 21", "from 1 to 20"},
        {"texture in.obj -o out.ply --levels 2", "3 levels"},
        {"texture in.obj -o out.ply --octaves 6 --levels 0", "5 levels"},
        {"texture in.obj -o out.ply --frequency 0", "above 0"},
        {"texture in.obj -o out.ply --colors ''", "#rrggbb"},
        {"texture in.obj -o out.ply --colors red", "#rrggbb"},
        {"texture in.obj -o out.ply --colors '#ff0000,'", "#rrggbb"},
        {"texture in.obj -o out.ply --colors '#ff00'", "#rrggbb"},
        {"texture in.obj -o out.ply --colors '#ff00gg'", "#rrggbb"},
        {"texture in.obj -o out.ply --seed -1", "4294967295"},
        {"texture in.obj -o out.ply --seed 4294967296", "4294967295"},
        {"texture in.obj -o out.ply --on-mesh --scheme doo-sabin", "doo-sabin"},
        {"texture in.obj -o out.ply --on-mesh --mask classic", "doo-sabin"},
        {"denoise in.obj -o out.obj --frames 3", "--frames"},
    }));
    const Outcome outcome = run(folder, arguments);
    INFO(arguments << "\n" << outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(last_line(outcome.err).rfind("limitcl: error: ", 0) == 0);
    CHECK(contains(last_line(outcome.err), part));
    CHECK(folder.entries() == 2);
}

TEST_CASE("bad input of the filters is exit code 3 and says where", "[cli][exit]") {
    const Folder folder;
    folder.file("good.obj", octahedron);
    folder.file("quads.obj", cube);
    folder.file("points.obj", "v 0 0 0\n");
    folder.file("far.txt", "0\n6\n");
    folder.file("twice.txt", "0\n0\n");
    const std::size_t entries = folder.entries();
    const auto [arguments, part] = GENERATE(table<std::string, std::string>({
        {"expand missing.obj -o out.obj --sum 1", "missing.obj"},
        {"spectrum points.obj", "no faces"},
        {"denoise good.obj -o out.obj --pin missing.txt", "missing.txt"},
        {"denoise good.obj -o out.obj --pin far.txt", "far.txt:2"},
        {"denoise good.obj -o out.obj --pin twice.txt", "twice.txt:2"},
        {"sharpen quads.obj -o out.obj --scheme loop", "face 0"},
        {"texture points.obj -o out.ply", "no faces"},
        {"texture quads.obj -o out.ply --scheme loop", "face 0"},
    }));
    const Outcome outcome = run(folder, arguments);
    INFO(arguments << "\n" << outcome.err);
    CHECK(outcome.exit_code == 3);
    CHECK(contains(last_line(outcome.err), part));
    CHECK(folder.entries() == entries);
}

TEST_CASE("Ctrl-C ends a filter with nothing written", "[cli][exit]") {
    const Folder folder;
    folder.file("grid.obj", large_grid);
    const pid_t child = start(folder, {program(), "denoise", "grid.obj", "-o", "out.obj", "--m", "100000", "--k", "100000", "--report", "report.json"});
    CHECK(exit_code_after_interrupt(child, 1500) == 130);
    CHECK_FALSE(folder.has("out.obj"));
    CHECK(json::parse(folder.read("report.json")).at("status") == "cancelled");
}

TEST_CASE("Ctrl-C ends a morph between frames, which stay", "[cli][morph][exit]") {
    const Folder folder;
    folder.file("grid.obj", large_grid);
    const pid_t child = start(folder, {program(), "morph", "grid.obj", "grid.obj", "-o", "f%d.obj", "--frames", "1000000", "--report", "report.json"});
    CHECK(exit_code_after_interrupt(child, 1500) == 130);
    const json report = json::parse(folder.read("report.json"));
    CHECK(report.at("status") == "cancelled");
    const std::size_t frames = folder.entries() - 2;  // beside the mesh and the report
    INFO(report.at("message"));
    CHECK(contains(report.at("message"), std::to_string(frames) + " frames were written"));
    CHECK(points_of(folder, "f" + std::to_string(frames - 1) + ".obj").size() == points_of(folder, "grid.obj").size());
}

TEST_CASE("filters of real meshes", "[cli][meshes]") {
    const char* meshes = std::getenv("LIMITCL_MESHES");
    if (meshes == nullptr) return;
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "noisy/trim-star_noisy.obj.gz", "noisy/Fandisk0.7_Noisy.obj.gz", "morph/cylinder-1.obj");
    const std::string path = (fs::path(meshes) / name).string();
    REQUIRE(fs::exists(path));
    const Plain A(path, scheme_of(LCL_SCHEME_LOOP));
    const Outcome denoise = run(folder, "denoise '" + path + "' -o out.obj");
    INFO(name << "\n" << denoise.err);
    REQUIRE(denoise.exit_code == 0);
    CHECK(largest_difference(points_of(folder, "out.obj"), denoised(A, A.points, 2, 3, false)) <= 1e-12 * A.diagonal);
    REQUIRE(run(folder, "expand '" + path + "' -o out.obj --precision single --band 2:3").exit_code == 0);
    CHECK(largest_difference(points_of(folder, "out.obj"), series(A, A.points, {0, 0, 1, 1}, false)) <= 1e-5 * A.diagonal);
    REQUIRE(run(folder, "sharpen '" + path + "' -o out.obj").exit_code == 0);
    CHECK(largest_difference(points_of(folder, "out.obj"), sharpened(A, A.points, 1, 3, 1)) <= 1e-12 * A.diagonal);
}

TEST_CASE("morphs of real pairs", "[cli][meshes]") {
    const char* meshes = std::getenv("LIMITCL_MESHES");
    if (meshes == nullptr) return;
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "morph/cheburashka-0", "morph/cylinder-", "morph/cube-");
    const std::string ending = name == "morph/cheburashka-0" ? ".obj.gz" : ".obj";
    const std::string from = (fs::path(meshes) / (name + "1" + ending)).string();
    const std::string to = (fs::path(meshes) / (name + (ending == ".obj" ? "3" : "4") + ending)).string();
    REQUIRE((fs::exists(from) && fs::exists(to)));
    const Plain A(from, scheme_of(LCL_SCHEME_LOOP)), B(to, scheme_of(LCL_SCHEME_LOOP));
    const Outcome outcome = run(folder, "morph '" + from + "' '" + to + "' -o f%d.obj --even --frames 5");
    INFO(name << "\n" << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(points_of(folder, "f0.obj") == A.points);
    CHECK(points_of(folder, "f5.obj") == B.points);
    const Outcome recursion = run(folder, "morph '" + from + "' '" + to + "' -o r%d.obj --frames 2 --rho 0.9,0.5");
    REQUIRE(recursion.exit_code == 0);
    Values difference = sum(A.points, -1.0, B.points);
    difference = filtered(A, difference, 2);
    for (double& value : difference) value *= 0.9;
    CHECK(largest_difference(points_of(folder, "r1.obj"), sum(B.points, 1.0, difference)) <= 1e-12 * A.diagonal);
}
