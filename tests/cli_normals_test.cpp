// SPDX-License-Identifier: BSD-3-Clause
// limitcl limit --normals.
#include "tests/cli_support.h"

using namespace cli_test;

namespace {

/// The three numbers after `word` on every line that begins with it.
std::vector<Point> lines_of(const std::string& text, const std::string& word) {
    std::vector<Point> found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string first;
        Point point{};
        if (words >> first && first == word && words >> point[0] >> point[1] >> point[2]) found.push_back(point);
    }
    return found;
}

/// The cube's, whose mean is at the origin.
std::vector<Point> diagonals() {
    std::vector<Point> out = obj_points(cube);
    for (Point& p : out)
        for (double& c : p) c /= std::sqrt(3.0);
    return out;
}

}  // namespace

TEST_CASE("limit --normals writes one vn a vertex to OBJ, and 0 0 0 where it is isolated", "[cli][normals]") {
    const Folder folder;
    folder.file("cube.obj", cube + "v 5 5 5\n");
    const Outcome outcome = run(folder, "limit cube.obj -o out.obj --normals --report -");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(report_of(outcome).at("parameters").at("normals") == true);
    const std::string text = folder.read("out.obj");
    std::vector<Point> normals = lines_of(text, "vn");
    REQUIRE(normals.size() == 9);
    CHECK(normals.back() == Point{0, 0, 0});
    normals.pop_back();
    CHECK(largest_difference(normals, diagonals()) <= 1e-6);
    CHECK(contains(text, "f 4//4 3//3 2//2 1//1"));
    REQUIRE(run(folder, "limit cube.obj -o plain.obj").exit_code == 0);
    CHECK(lines_of(folder.read("plain.obj"), "vn").empty());
    CHECK(largest_difference(obj_points(text), obj_points(folder.read("plain.obj"))) <= 1e-12);
}

TEST_CASE("limit --normals writes nx ny nz to PLY and NOFF to OFF", "[cli][normals]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    REQUIRE(run(folder, "limit cube.obj -o out.off --normals --precision double").exit_code == 0);
    const std::string off = folder.read("out.off");
    CHECK(off.rfind("NOFF", 0) == 0);
    std::istringstream numbers(off.substr(off.find('\n')));
    int vertices = 0, faces = 0, edges = 0;
    numbers >> vertices >> faces >> edges;
    std::vector<Point> normals(8);
    for (Point& n : normals) {
        Point p{};
        numbers >> p[0] >> p[1] >> p[2] >> n[0] >> n[1] >> n[2];
    }
    CHECK(largest_difference(normals, diagonals()) <= 1e-14);
    folder.file("ascii.ply", coloured_tetrahedron_ply());
    REQUIRE(run(folder, "limit ascii.ply -o out.ply --normals --channels colours").exit_code == 0);
    const std::string ply = folder.read("out.ply");
    for (const char* name : {"nx", "ny", "nz"}) CHECK(contains(ply, std::string("property double ") + name + "\n"));
    const Outcome stl = run(folder, "limit ascii.ply -o out.stl --normals");
    CHECK(stl.exit_code == 0);
    CHECK(contains(stl.err, "cannot hold vertex normals"));
}

TEST_CASE("limit --normals gives the mean of the sides at a crease", "[cli][normals]") {
    const Folder folder;
    // Two squares at a right angle, the edge between them sharp.
    folder.file("roof.obj", "v 0 0 0\nv 0 1 0\nv 0 2 0\nv 1 0 0\nv 1 1 0\nv 1 2 0\nv 0 0 -1\nv 0 1 -1\nv 0 2 -1\nf 1 4 5 2\nf 2 5 6 3\nf 7 1 2 8\nf 8 2 3 9\n");
    folder.file("creases", "0 1\n1 2\n");
    REQUIRE(run(folder, "limit roof.obj -o out.obj --normals --scheme catmull-clark --creases creases").exit_code == 0);
    const std::vector<Point> normals = lines_of(folder.read("out.obj"), "vn");
    REQUIRE(normals.size() == 9);
    const double half = std::sqrt(0.5);
    CHECK(largest_difference({normals[1]}, {{-half, 0, half}}) <= 1e-6);
    CHECK(largest_difference({normals[4]}, {{0, 0, 1}}) <= 1e-6);
    CHECK(largest_difference({normals[7]}, {{-1, 0, 0}}) <= 1e-6);
}
