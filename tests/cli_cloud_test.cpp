// SPDX-License-Identifier: BSD-3-Clause
// limitcl surface, as scripts see it. Most cases take the faces of the first mesh from a file (given_faces_engine.c), so that they run on every machine; those
// of the engines that people use are at the end and say so where none was built.
#include <iomanip>

#include "tests/cli_support.h"

using namespace cli_test;

namespace {

using Triangle = std::array<int, 3>;

/// A cloud with the faces that join it.
struct Shape {
    std::vector<Point> points;
    std::vector<Triangle> faces;
};

Shape operator+(Shape a, const Shape& b) {
    const int first = static_cast<int>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (const Triangle& face : b.faces) a.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    return a;
}

/// Quads of a grid of rows x columns points, cut in two; closed: the last row or column meets the first.
void join_grid(Shape& shape, int rows, int columns, bool closed) {
    const auto at = [&](int row, int column) { return row % rows * columns + column % columns; };
    for (int row = 0; row < rows - (closed ? 0 : 1); ++row)
        for (int column = 0; column < columns - (closed ? 0 : 1); ++column) {
            shape.faces.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
            shape.faces.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
        }
}

Shape torus(int rows, int columns) {
    Shape shape;
    const double turn = 2 * std::acos(-1.0);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double u = turn * row / rows, v = turn * column / columns;
            shape.points.push_back({(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)});
        }
    join_grid(shape, rows, columns, true);
    return shape;
}

/// A wavy sheet over a square; its faces are seen from above.
Shape sheet(int size) {
    Shape shape;
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const double x = 3.0 * row / (size - 1), y = 3.0 * column / (size - 1);
            shape.points.push_back({x, y, 0.3 * std::sin(1.5 * x) * std::cos(y)});
        }
    join_grid(shape, size, size, false);
    return shape;
}

/// The octahedron's faces cut into size^2 triangles each, on the unit sphere or, without `round`, flat. 4 size^2 + 2 points.
Shape octahedron_grid(int size, bool round, double shift = 0.0) {
    Shape shape;
    std::vector<std::array<int, 3>> keys;
    const auto index_of = [&](std::array<int, 3> key) {
        const auto found = std::find(keys.begin(), keys.end(), key);
        if (found != keys.end()) return static_cast<int>(found - keys.begin());
        keys.push_back(key);
        const double length = round ? std::hypot(key[0], key[1], key[2]) : size;
        shape.points.push_back({key[0] / length + shift, key[1] / length, key[2] / length});
        return static_cast<int>(keys.size()) - 1;
    };
    for (int octant = 0; octant < 8; ++octant) {
        const int signs[3] = {octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
        const bool flip = signs[0] * signs[1] * signs[2] < 0;
        const auto add = [&](std::array<int, 3> a, std::array<int, 3> b, std::array<int, 3> c) {
            int corners[3], corner = 0;
            for (std::array<int, 3> key : {a, b, c}) {
                for (int axis = 0; axis < 3; ++axis) key[static_cast<std::size_t>(axis)] *= signs[axis];
                corners[corner++] = index_of(key);
            }
            shape.faces.push_back({corners[0], corners[flip ? 2 : 1], corners[flip ? 1 : 2]});
        };
        for (int i = 0; i < size; ++i)
            for (int j = 0; i + j < size; ++j) {
                const int k = size - i - j;
                add({i, j, k}, {i + 1, j, k - 1}, {i, j + 1, k - 1});
                if (k > 1) add({i + 1, j, k - 1}, {i + 1, j + 1, k - 2}, {i, j + 1, k - 1});
            }
    }
    return shape;
}

Shape sphere(int size, double shift = 0.0) { return octahedron_grid(size, true, shift); }

std::string rows_of(const std::vector<Point>& points, const std::string& separator = " ", const std::string& begin = "", const std::string& end = "") {
    std::ostringstream text;
    text << std::setprecision(17);
    for (const Point& point : points) text << begin << point[0] << separator << point[1] << separator << point[2] << end << "\n";
    return text.str();
}

std::string rows_of(const std::vector<Triangle>& faces) {
    std::string text;
    for (const Triangle& face : faces) text += std::to_string(face[0]) + " " + std::to_string(face[1]) + " " + std::to_string(face[2]) + "\n";
    return text;
}

std::string ply_of(const std::vector<Point>& points) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\nend_header\n" + rows_of(points);
}

void put(const Folder& folder, const Shape& shape) {
    folder.file("in.xyz", rows_of(shape.points));
    folder.file("faces.txt", rows_of(shape.faces));
}

const std::string given_faces = std::string("LIMITCL_ENGINE_DIR='") + LIMITCL_TEST_ENGINES + "'";

/// With the faces of faces.txt.
Outcome surface(const Folder& folder, const std::string& arguments, const std::string& input = "/dev/null") {
    return run(folder, "surface --engine-option faces=faces.txt " + arguments, given_faces, input);
}

json surface_report(const Folder& folder, const std::string& arguments, int exit_code = 0) {
    const Outcome outcome = surface(folder, arguments + " --report -");
    INFO(arguments << "\n" << outcome.err);
    REQUIRE(outcome.exit_code == exit_code);
    return report_of(outcome);
}

/// Distances of the points of a file to the surface of a control mesh, by the program itself.
std::vector<double> distances(const Folder& folder, const std::string& mesh, const std::string& points, const std::string& options) {
    const Outcome outcome = run(folder, "closest " + mesh + " --points " + points + " -o distances.csv --quiet " + options);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    std::istringstream lines(folder.read("distances.csv"));
    std::vector<double> values;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        std::string cell;
        for (int column = 0; column < 8; ++column) std::getline(cells, cell, ',');
        values.push_back(std::abs(std::stod(cell)));
    }
    return values;
}

/// What the report says of the distances is what `closest` finds on the mesh that was written. Both search to 1e-12 of the size in double; devices without it,
/// to some 1e-6.
void check_distances(const json& report, const std::vector<double>& found) {
    const json& fit = report.at("fit");
    const double margin = 1e-6 * report.at("diagonal").get<double>(), count = static_cast<double>(found.size());
    double largest = 0, squares = 0;
    for (const double distance : found) largest = std::max(largest, distance), squares += distance * distance;
    const double rms = std::sqrt(squares / count), p95 = fit.at("p95").get<double>();
    CHECK(fit.at("points") == found.size());
    CHECK(fit.at("max").get<double>() <= largest + margin);
    CHECK(fit.at("rms").get<double>() <= rms + margin);
    const auto below = std::count_if(found.begin(), found.end(), [&](double distance) { return distance < p95 - margin; });
    CHECK(static_cast<double>(below) <= 0.95 * count + 1);
    CHECK(fit.at("max").get<double>() >= largest - margin);
    CHECK(fit.at("rms").get<double>() >= rms - margin);
    const auto within = std::count_if(found.begin(), found.end(), [&](double distance) { return distance <= p95 + margin; });
    CHECK(static_cast<double>(within) >= 0.95 * count - 1);
}

bool is_one_failure(const Outcome& outcome) { return line_count(outcome.err) == 1 && outcome.err.rfind("limitcl: error: ", 0) == 0; }

}  // namespace

TEST_CASE("surface writes a control mesh whose limit surface is within the tolerance of all points", "[cli][cli_surface]") {
    const Folder folder;
    put(folder, sphere(8));  // 258 points
    const std::string scheme = GENERATE(as<std::string>(), "doo-sabin", "loop", "catmull-clark");
    const std::string options = scheme == "doo-sabin" ? "" : "--scheme " + scheme;
    const Outcome outcome = surface(folder, "in.xyz -o out.obj --tolerance 5e-3 --report report.json " + options);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, "in.xyz: 258 points"));
    CHECK(contains(outcome.err, "given-faces: 258 vertices, 512 faces, 1 component, closed"));
    CHECK(contains(outcome.err, ": converged"));
    CHECK_FALSE(contains(outcome.err, "warning"));

    const json report = json::parse(folder.read("report.json"));
    CHECK(report.at("command") == "surface");
    CHECK(report.at("status") == "ok");
    CHECK(report.at("scheme") == scheme);
    CHECK(report.at("converged") == true);
    CHECK(report.at("iterations") > 0);
    CHECK(report.at("warnings").empty());
    const double diagonal = report.at("diagonal").get<double>();
    CHECK(diagonal == Approx(2 * std::sqrt(3.0)).epsilon(1e-12));
    const json& fit = report.at("fit");
    CHECK(fit.at("tolerance").get<double>() == Approx(5e-3 * diagonal));
    CHECK(fit.at("max") <= fit.at("tolerance"));
    CHECK(fit.at("outside") == 0);
    CHECK(fit.at("rounds") >= 1);
    CHECK(fit.at("interpolation_error").get<double>() <= 1e-6 * diagonal);
    CHECK(report.at("max_error") == fit.at("interpolation_error"));
    CHECK(report.at("solver") == "auto");
    CHECK(fit.at("approximation") == json({{"vertices", 258}, {"faces", 512}, {"components", 1}, {"boundary_loops", 0}}));
    for (const char* count : {"duplicates", "left_out", "unused", "filled_holes", "dropped_faces", "split_vertices"}) CHECK(fit.at(count) == 0);
    for (const char* phase : {"approximate", "simplify", "solve", "measure", "refine"}) CHECK(fit.at("seconds").at(phase) >= 0);
    CHECK(fit.at("seconds").at("total") > 0);
    CHECK(report.at("seconds").at("solve") <= fit.at("seconds").at("solve"));  // the same without the building of kernels

    const std::vector<Point> control = obj_points(folder.read("out.obj"));
    CHECK(control.size() < 258);
    CHECK(fit.at("vertices") == control.size());
    CHECK(report.at("mesh").at("vertices") == control.size());
    CHECK(report.at("mesh").at("components") == 1);
    CHECK(report.at("mesh").at("boundary_loops") == 0);
    const json& parameters = report.at("parameters");
    CHECK(parameters.at("engine") == "given-faces");
    CHECK(parameters.at("engine_options") == json({"faces=faces.txt"}));
    CHECK(parameters.at("fit") == "interpolate");
    CHECK(parameters.at("tolerance") == 5e-3);
    CHECK_FALSE(parameters.contains("fair"));
    check_distances(report, distances(folder, "out.obj", "in.xyz", "--scheme " + scheme));
    CHECK(folder.entries() == 5);
}

TEST_CASE("surface reads every format of points and writes every format of meshes", "[cli][cli_surface]") {
    const Folder folder;
    const Shape shape = torus(20, 12);
    put(folder, shape);
    const std::string count = std::to_string(shape.points.size());
    const std::string options = "--tolerance 2e-2 --quiet ";
    REQUIRE(surface(folder, "in.xyz -o out.obj " + options).exit_code == 0);
    const std::string expected = folder.read("out.obj");
    folder.file("in.pts", count + "\n" + rows_of(shape.points));
    folder.file("in.csv", "x,y,z\n" + rows_of(shape.points, ","));
    folder.file("in.obj", rows_of(shape.points, " ", "v "));
    folder.file("in.off", "OFF\n" + count + " 0 0\n" + rows_of(shape.points));
    folder.file("in.ply", ply_of(shape.points));
    for (const std::string ending : {"pts", "csv", "obj", "off", "ply"}) {
        const Outcome outcome = surface(folder, "in." + ending + " -o same.obj " + options);
        INFO(ending << ": " << outcome.err);
        REQUIRE(outcome.exit_code == 0);
        CHECK(outcome.err.empty());
        CHECK(folder.read("same.obj") == expected);
    }
    const Outcome piped = surface(folder, "- -o - --format ply " + options, (folder.path / "in.ply").string());
    REQUIRE(piped.exit_code == 0);
    CHECK(piped.out.rfind("ply\n", 0) == 0);
    for (const std::string ending : {"off", "ply", "stl", "om", "obj.gz"}) {
        REQUIRE(surface(folder, "in.csv -o mesh." + ending + " " + options).exit_code == 0);
        const Outcome info = run(folder, "info mesh." + ending + " --report -");
        REQUIRE(info.exit_code == 0);
        CHECK(report_of(info).at("mesh").at("vertices") == obj_points(expected).size());
    }
    REQUIRE(surface(folder, "in.obj -o in.obj " + options).exit_code == 0);  // -o may name the cloud
    CHECK(folder.read("in.obj") == expected);
}

TEST_CASE("surface keeps colours, and all parts of a cloud", "[cli][cli_surface]") {
    const Folder folder;
    const Shape shape = sphere(6) + sphere(6, 3.0);
    folder.file("faces.txt", rows_of(shape.faces));
    std::ostringstream text;
    text << std::setprecision(17);
    for (const Point& point : shape.points) text << point[0] << " " << point[1] << " " << point[2] << (point[0] < 1.5 ? " 255 0 0\n" : " 0 0 255\n");
    folder.file("in.xyz", text.str());
    const json report = surface_report(folder, "in.xyz -o out.ply --tolerance 1e-2");
    CHECK(report.at("fit").at("approximation").at("components") == 2);
    CHECK(report.at("mesh").at("components") == 2);
    CHECK(report.at("mesh").at("boundary_loops") == 0);
    CHECK(contains(run(folder, "info out.ply").out, "red, green, blue"));
    REQUIRE(surface(folder, "in.xyz -o out.obj --tolerance 1e-2 --quiet").exit_code == 0);
    int coloured = 0;  // each part in its own colour
    std::istringstream vertices(folder.read("out.obj"));
    for (std::string line; std::getline(vertices, line);) {
        std::istringstream words(line);
        std::string word;
        double x = 0, y = 0, z = 0, red = 0, green = 0, blue = 0;
        if (!(words >> word >> x >> y >> z >> red >> green >> blue) || word != "v") continue;
        ++coloured;
        CHECK((x < 1.5 ? red - blue : blue - red) == Approx(1));
    }
    CHECK(coloured == report.at("fit").at("vertices"));
}

TEST_CASE("surface stops at the vertices that it may have, with a warning", "[cli][cli_surface]") {
    const Folder folder;
    put(folder, sphere(8));
    const Outcome outcome = surface(folder, "in.xyz -o out.obj --tolerance 1e-4 --vertices 60 --report report.json");
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(contains(outcome.err, "limitcl: warning: "));
    const json report = json::parse(folder.read("report.json"));
    CHECK(report.at("status") == "ok");
    CHECK(report.at("converged") == false);
    CHECK(report.at("warnings").size() == 1);
    CHECK(report.at("parameters").at("vertices") == 60);
    const json& fit = report.at("fit");
    CHECK(fit.at("vertices") <= 60);
    CHECK(fit.at("max") > fit.at("tolerance"));
    CHECK(fit.at("outside") > 0);
    check_distances(report, distances(folder, "out.obj", "in.xyz", "--scheme doo-sabin"));
    const std::string looser = "in.xyz -o out.obj --tolerance 2e-2 ";
    const json few = surface_report(folder, looser + "--vertices 250");
    CHECK(few.at("converged") == true);
    CHECK(few.at("fit").at("vertices") <= 250);
    const json fit_without = surface_report(folder, looser).at("fit");
    const std::string mesh_without = folder.read("out.obj");
    CHECK(surface_report(folder, looser + "--vertices 1000000").at("fit").at("vertices") == fit_without.at("vertices"));
    CHECK(folder.read("out.obj") == mesh_without);  // a bound that is not reached changes nothing
}

TEST_CASE("a tolerance that is not reached is exit code 4, and --keep-going writes what there is", "[cli][cli_surface][exit]") {
    const Folder folder;
    put(folder, sphere(4));
    folder.file("out.obj", "as it was");
    const std::string arguments = "in.xyz -o out.obj --tolerance 1e-15 --quiet --report report.json";  // beyond rounding
    Outcome outcome = surface(folder, arguments);
    CHECK(outcome.exit_code == 4);
    CHECK(is_one_failure(outcome));
    CHECK(folder.read("out.obj") == "as it was");
    CHECK(json::parse(folder.read("report.json")).at("status") == "not-converged");
    CHECK(json::parse(folder.read("report.json")).at("converged") == false);
    outcome = surface(folder, arguments + " --keep-going");
    CHECK(outcome.exit_code == 4);
    CHECK(is_one_failure(outcome));
    CHECK_FALSE(obj_points(folder.read("out.obj")).empty());
    CHECK(json::parse(folder.read("report.json")).at("fit").at("max").get<double>() > 0);
}

TEST_CASE("a surface whose solve fails tells that, and not how far points are", "[cli][cli_surface][exit]") {
    const Folder folder;
    put(folder, torus(8, 6));
    const std::string arguments = "in.xyz -o out.obj --max-iter 1 --tolerance 1e-5 --quiet --report report.json";  // where some twenty are needed
    Outcome outcome = surface(folder, arguments);
    CHECK(outcome.exit_code == 4);
    CHECK(is_one_failure(outcome));
    CHECK(contains(outcome.err, "after 1 iteration"));
    CHECK_FALSE(folder.has("out.obj"));
    json report = json::parse(folder.read("report.json"));
    CHECK(report.at("status") == "not-converged");
    CHECK_FALSE(report.contains("mesh"));
    CHECK(report.at("diagonal").get<double>() > 0);
    CHECK(report.at("max_error").is_null());
    CHECK(report.at("fit").at("max").is_null());
    outcome = surface(folder, arguments + " --keep-going");
    CHECK(outcome.exit_code == 4);
    CHECK(is_one_failure(outcome));
    CHECK(contains(outcome.err, "after 1 iteration"));
    CHECK(folder.has("out.obj"));
    report = json::parse(folder.read("report.json"));
    CHECK(report.at("fit").at("outside") > 0);
    CHECK(report.at("max_error").get<double>() > 1e-6 * report.at("diagonal").get<double>());
}

TEST_CASE("surface fills holes up to the size that is asked for", "[cli][cli_surface]") {
    const Folder folder;
    Shape shape = sphere(6);
    shape.faces.pop_back();  // three edges
    put(folder, shape);
    CHECK(surface_report(folder, "in.xyz -o out.obj --tolerance 1e-2").at("mesh").at("boundary_loops") == 1);
    const json report = surface_report(folder, "in.xyz -o out.obj --tolerance 1e-2 --fill-holes 3");
    CHECK(report.at("mesh").at("boundary_loops") == 0);
    CHECK(report.at("fit").at("filled_holes") == 1);
    put(folder, sheet(8));  // 28 edges round
    CHECK(surface_report(folder, "in.xyz -o out.obj --tolerance 1e-2 --fill-holes 27").at("fit").at("filled_holes") == 0);
}

TEST_CASE("surface keeps creases, and tells them to whoever reads the mesh", "[cli][cli_surface]") {
    const Folder folder;
    put(folder, octahedron_grid(6, false));  // face normals differ by 70.5 degrees across its twelve edges
    const json report = surface_report(folder, "in.xyz -o out.obj --tolerance 1e-3 --crease-angle 40");
    CHECK(report.at("parameters").at("crease_angle") == 40);
    CHECK(report.at("mesh").at("creases") >= 12);
    CHECK(report.at("mesh").at("corners") == 6);
    CHECK(report.at("fit").at("max").get<double>() <= 1e-6 * report.at("diagonal").get<double>());  // a polyhedron whose edges are sharp is its own surface
    CHECK(contains(folder.read("out.obj"), "t crease "));
    check_distances(report, distances(folder, "out.obj", "in.xyz", "--scheme doo-sabin"));
    const Outcome off = surface(folder, "in.xyz -o out.off --tolerance 1e-3 --crease-angle 40");
    CHECK(off.exit_code == 0);
    CHECK(contains(off.err, "crease"));  // which OFF cannot hold
}

TEST_CASE("surface fits a sheet by its boundary rule", "[cli][cli_surface]") {
    const Folder folder;
    put(folder, sheet(12));
    const std::string rule = GENERATE(as<std::string>(), "edge-and-corner", "edge-only", "fixed");
    const json report = surface_report(folder, "in.xyz -o out.obj --tolerance 5e-3 --boundary " + rule);
    CHECK(report.at("parameters").at("boundary") == rule);
    CHECK(report.at("mesh").at("boundary_loops") == 1);
    check_distances(report, distances(folder, "out.obj", "in.xyz", "--scheme doo-sabin"));  // OUT says the rule
}

TEST_CASE("surface --fit least-squares comes nearer with as many vertices", "[cli][cli_surface]") {
    const Folder folder;
    put(folder, torus(24, 16));
    const std::string arguments = "in.xyz -o out.obj --vertices 80 --tolerance 1e-4 ";
    const json plain = surface_report(folder, arguments);
    const json fitted = surface_report(folder, arguments + "--fit least-squares --fair 1e-5");
    CHECK(fitted.at("parameters").at("fit") == "least-squares");
    CHECK(fitted.at("parameters").at("fair") == 1e-5);
    CHECK(fitted.at("fit").at("interpolation_error").is_null());
    CHECK(fitted.at("fit").at("vertices") <= 80);
    CHECK(fitted.at("fit").at("rms") < plain.at("fit").at("rms"));
    check_distances(fitted, distances(folder, "out.obj", "in.xyz", "--scheme doo-sabin"));
    CHECK(surface_report(folder, arguments + "--fit least-squares").at("parameters").at("fair") == 1e-3);
}

TEST_CASE("surface resolves --alpha auto and takes Doo-Sabin's masks", "[cli][cli_surface]") {
    const Folder folder;
    put(folder, sphere(4));
    const json automatic = surface_report(folder, "in.xyz -o out.obj --tolerance 1e-2 --alpha auto");
    CHECK(automatic.at("scheme") == "catmull-clark");
    const json& alpha = automatic.at("parameters").at("alpha");
    REQUIRE(alpha.is_number());
    CHECK((alpha == 0.0 || alpha == 0.5));
    check_distances(automatic, distances(folder, "out.obj", "in.xyz", "--alpha " + alpha.dump()));
    const json classic = surface_report(folder, "in.xyz -o out.obj --tolerance 1e-2 --mask classic --precision double --tol 1e-9");
    CHECK(classic.at("scheme") == "doo-sabin");
    CHECK(classic.at("parameters").at("mask") == "classic");
    check_distances(classic, distances(folder, "out.obj", "in.xyz", "--mask classic"));
}

TEST_CASE("surface tells what an engine left out or gave wrongly", "[cli][cli_surface]") {
    const Folder folder;
    Shape shape = sphere(6);
    put(folder, shape);
    const std::string outlier = "0.1 0.2 5\n", duplicates = "0.1 0.2 5\n0.1 0.2 5\n";
    folder.file("in.xyz", rows_of(shape.points) + outlier + duplicates);
    const json report = surface_report(folder, "in.xyz -o out.obj --tolerance 1e-2 --engine-option outliers=1 --engine-option 'warn=the sun was low'");
    CHECK(report.at("fit").at("points") == shape.points.size());
    CHECK(report.at("fit").at("left_out") == 1);
    CHECK(report.at("fit").at("duplicates") == 2);
    CHECK(contains(report.at("warnings").dump(), "the sun was low"));
    put(folder, shape);
    folder.file("faces.txt", rows_of(shape.faces) + "0 1 999\n");
    const Outcome outside = surface(folder, "in.xyz -o out2.obj --quiet");
    CHECK(outside.exit_code == 1);  // no change of the command line cures it
    CHECK(is_one_failure(outside));
    CHECK_FALSE(folder.has("out2.obj"));
    folder.file("faces.txt", "");
    const Outcome nothing = surface(folder, "in.xyz -o out2.obj --quiet");
    CHECK(nothing.exit_code == 3);
    CHECK(is_one_failure(nothing));
}

TEST_CASE("clouds that carry no surface are exit code 3 with one sentence, and leave the output as it was", "[cli][cli_surface][exit]") {
    const Folder folder;
    const auto [rows, part] = GENERATE(table<std::string, std::string>({{"0 0 0\n1 0 0\n0 1 0\n", "3"},
                                                                        {"", ""},
                                                                        {"1 2 3\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n", ""},
                                                                        {"0 0 0\n1 1 1\n2 2 2\n3 3 3\n7 7 7\n", "line"},
                                                                        {"0 0 1\n1 0 1\n0 1 1\n1 1 1\n3 5 1\n", "plane"},
                                                                        {"0 0 0\n1 0 0\nnan 1 0\n0 0 1\n1 1 1\n", "in.xyz:3"},
                                                                        {"0 0 0\n1 0 0\n0 1 0 255 0 0\n0 0 1\n1 1 1\n", "in.xyz:3"},
                                                                        {"0 0 0\n1 0 0\n0 1\n0 0 1\n1 1 1\n", "in.xyz:3"}}));
    folder.file("in.xyz", rows);
    folder.file("faces.txt", "0 1 2\n0 2 3\n0 3 1\n1 3 2\n");
    folder.file("out.obj", "as it was");
    const Outcome outcome = surface(folder, "in.xyz -o out.obj --quiet --report report.json");
    INFO(rows << outcome.err);
    CHECK(outcome.exit_code == 3);
    CHECK(is_one_failure(outcome));
    CHECK(contains(outcome.err, "in.xyz"));
    CHECK(contains(outcome.err, part));
    CHECK(folder.read("out.obj") == "as it was");
    CHECK(json::parse(folder.read("report.json")).at("status") == "bad-input");
    CHECK(folder.entries() == 4);
}

TEST_CASE("many duplicates of few points are one point each", "[cli][cli_surface]") {
    const Folder folder;
    const Shape shape = sphere(2);  // 18 points
    folder.file("faces.txt", rows_of(shape.faces));
    std::string rows;
    for (int time = 0; time < 5000; ++time) rows += rows_of(shape.points);
    folder.file("in.xyz", rows);
    const json report = surface_report(folder, "in.xyz -o out.obj --tolerance 1e-2");
    CHECK(report.at("fit").at("points") == 18);
    CHECK(report.at("fit").at("duplicates") == 4999 * 18);
    std::string few;
    for (int time = 0; time < 5000; ++time) few += "0 0 0\n1 0 0\n0 1 0\n";
    folder.file("in.xyz", few);
    CHECK(surface(folder, "in.xyz -o out2.obj --quiet").exit_code == 3);
}

TEST_CASE("wrong usage of surface is exit code 2 with one line", "[cli][cli_surface][exit]") {
    const Folder folder;
    put(folder, sphere(2));
    folder.file("list.txt", "0\n");
    const auto [arguments, part] = GENERATE(
        table<std::string, std::string>({{"in.xyz", "--output"},
                                         {"-o out.obj", "POINTS"},
                                         {"in.xyz -o out.xyz", ".xyz"},
                                         {"in.stl -o out.obj", "points are read from"},
                                         {"in -o out.obj", "points are read from"},
                                         {"in.xyz -o out.obj --tolerance 0", "--tolerance"},
                                         {"in.xyz -o out.obj --tolerance=-1e-3", "--tolerance"},
                                         {"in.xyz -o out.obj --tolerance inf", "--tolerance"},
                                         {"in.xyz -o out.obj --tolerance nan", "--tolerance"},
                                         {"in.xyz -o out.obj --vertices 3", "--vertices"},
                                         {"in.xyz -o out.obj --vertices 10.5", "--vertices"},
                                         {"in.xyz -o out.obj --fill-holes 2", "--fill-holes"},
                                         {"in.xyz -o out.obj --fill-holes 1001", "--fill-holes"},
                                         {"in.xyz -o out.obj --fair 1e-3", "least-squares"},
                                         {"in.xyz -o out.obj --fit least-squares --fair=-1", "--fair"},
                                         {"in.xyz -o out.obj --fit best", "--fit"},
                                         {"in.xyz -o out.obj --engine-option radius", "KEY=VALUE"},
                                         {"in.xyz -o out.obj --engine-option =3", "KEY=VALUE"},
                                         {"in.xyz -o out.obj --engine-option faces=faces.txt --engine-option faces=faces.txt", "twice"},
                                         {"in.xyz -o out.obj --engine ''", "--engine"},
                                         {"missing.xyz -o out.obj --engine nothing", "given-faces"},
                                         {"missing.xyz -o out.obj --engine-option roundness=3", "'roundness': its options are faces, outliers, wait, warn"},
                                         {"in.xyz -o out.obj --lambda 0.3", "--lambda"},
                                         {"in.xyz -o out.obj --creases list.txt", "--crease-angle"},
                                         {"in.xyz -o out.obj --corners list.txt", "--crease-angle"},
                                         {"in.xyz -o out.obj --channels colours", "--channels"},
                                         {"in.xyz -o out.obj --scheme loop --alpha 0.5", "--alpha"},
                                         {"in.xyz -o out.obj --refined", "--refined"},
                                         {"in.xyz -o out.obj --format xyz", "--format"},
                                         {"- -o out.obj", "ply, xyz, csv, off, obj or pts"},
                                         {"in.xyz -o -", "obj, off, ply, stl or om"},
                                         {"- -o - --format xyz", "obj, off or ply"},
                                         {"- -o out.obj --format stl", "ply, xyz, csv, off, obj or pts"},
                                         {"in.xyz -o - --format csv", "obj, off, ply, stl or om"}}));
    const Outcome outcome = run(folder, "surface --quiet " + arguments, given_faces);
    INFO(arguments << "\n" << outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(is_one_failure(outcome));
    CHECK(contains(outcome.err, part));
    CHECK(folder.entries() == 3);
}

TEST_CASE("formats of points are none of meshes", "[cli][exit]") {
    const Folder folder;
    folder.file("in.xyz", "0 0 0\n");
    for (const char* arguments : {"info in.xyz", "info - --format xyz", "interpolate in.xyz -o out.obj", "limit - -o - --format pts"}) {
        const Outcome outcome = run(folder, arguments);
        INFO(arguments << "\n" << outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(is_one_failure(outcome));
    }
}

TEST_CASE("the help of surface tells its options, and the engines with theirs", "[cli][cli_surface]") {
    const Folder folder;
    const Outcome help = run(folder, "surface --help", given_faces);
    CHECK(help.exit_code == 0);
    CHECK(help.err.empty());
    for (const char* text : {"POINTS", "--output", "--tolerance", "--vertices", "--fit", "--fair", "--fill-holes", "--engine", "--engine-option", "--scheme",
                             "--crease-angle", "--keep-going", "given-faces: triangles from a file", "faces=FILE"})
        CHECK(contains(help.out, text));
    for (const char* text : {"--lambda", "--creases ", "--corners", "--channels"}) CHECK_FALSE(contains(help.out, text));
    CHECK(contains(run(folder, "--help").out, "\n  surface "));
    CHECK(contains(run(folder, "--version", given_faces).out, "given-faces"));
}

TEST_CASE("without an engine surface says how to get one", "[cli][cli_surface][exit]") {
    const Folder folder;
    put(folder, sphere(2));
    const Folder none;
    const std::string nowhere = "LIMITCL_ENGINE_DIR='" + none.path.string() + "'";
    const Outcome outcome = run(folder, "surface in.xyz -o out.obj --quiet", nowhere);
    CHECK(outcome.exit_code == 1);
    CHECK(is_one_failure(outcome));
    CHECK(contains(outcome.err, "no engine"));
    CHECK(contains(outcome.err, "libcgal-dev"));
    CHECK(run(folder, "surface in.xyz -o out.obj --engine advancing-front", nowhere).exit_code == 2);
    CHECK(contains(run(folder, "surface --help", nowhere).out, "none"));
    CHECK(contains(run(folder, "--version", nowhere).out, "none"));
    CHECK(folder.entries() == 2);
}

TEST_CASE("Ctrl-C ends an engine at work, with nothing written", "[cli][cli_surface][exit]") {
    const Folder folder;
    put(folder, sphere(2));
    const std::vector<std::string> arguments = GENERATE(values<std::vector<std::string>>({{"in.xyz", "--engine-option", "wait=1"}, {"-", "--format", "xyz"}}));
    std::vector<std::string> words = {
        "env", std::string("LIMITCL_ENGINE_DIR=") + LIMITCL_TEST_ENGINES, program(), "surface", "-o", "out.obj", "--report", "report.json"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    check_interrupt(folder, words);
}

TEST_CASE("the engines that are installed find the surface of a cloud by themselves", "[cli][cli_surface][engine]") {
    const Folder folder;
    const auto [engine, needs_normals] = GENERATE(table<std::string, bool>({{"advancing-front", false}, {"poisson", true}, {"ball-pivoting", true}}));
    if (!contains(run(folder, "--version").out, "engine: " + engine)) {
        WARN("the engine " + engine + " was not built, and nothing was tested of it");
        return;
    }
    const Shape shape = sphere(14);  // 786 points, whose normals are the points themselves
    std::ostringstream text;
    text << std::setprecision(17);
    for (const Point& p : shape.points) {
        text << p[0] << " " << p[1] << " " << p[2];
        if (needs_normals) text << " " << p[0] << " " << p[1] << " " << p[2];
        text << "\n";
    }
    folder.file("in.xyz", text.str());
    const Outcome outcome = run(folder, "surface in.xyz -o out.obj --tolerance 1e-2 --report - --engine " + engine);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const json report = report_of(outcome);
    CHECK(report.at("converged") == true);
    CHECK(report.at("mesh").at("components") == 1);
    if (engine != "ball-pivoting") {  // it may leave holes
        CHECK(report.at("mesh").at("boundary_loops") == 0);
        const json& mesh = report.at("mesh");
        CHECK(mesh.at("vertices").get<int>() - mesh.at("edges").get<int>() + mesh.at("faces").get<int>() == 2);
    }
    check_distances(report, distances(folder, "out.obj", "in.xyz", "--scheme doo-sabin"));
    const Outcome option = run(folder, "surface in.xyz -o out2.obj --quiet --engine-option no-such-option=1 --engine " + engine);
    CHECK(option.exit_code == 2);
    CHECK(is_one_failure(option));
    CHECK(contains(option.err, "no-such-option"));
}
