// SPDX-License-Identifier: BSD-3-Clause
// interpolate with --normals, --handles, --refined, --fair and --map, as scripts see it: exit codes, files, report.
#include "tests/capi_support.h"
#include "tests/cli_support.h"

using namespace cli_test;

namespace {

/// Limit points of a control mesh in a file, by the program itself.
std::vector<Point> limit_points(const Folder& folder, const std::string& name) {
    const Outcome outcome = run(folder, "limit " + name + " -o limits.obj --scheme catmull-clark --precision double --quiet");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return obj_points(folder.read("limits.obj"));
}

/// The first limit points of M^1 in m1.obj are the vertices of the input.
double largest_miss(const Folder& folder, const std::string& input) {
    const std::vector<Point> given = obj_points(folder.read(input));
    std::vector<Point> limits = limit_points(folder, "m1.obj");
    REQUIRE(limits.size() > given.size());
    limits.resize(given.size());
    return largest_difference(limits, given);
}

Outcome interpolate(const Folder& folder, const std::string& options) { return run(folder, "interpolate in.obj -o m1.obj --report - " + options); }

}  // namespace

TEST_CASE("interpolate --refined writes M^1, whose limit points are the vertices", "[cli][two-phase]") {
    const Folder folder;
    folder.file("in.obj", bumpy_grid(5));
    folder.file("lambda.csv", [] {
        std::string text = "vertex,lambda\n";
        for (int v = 0; v < 36; ++v) text += std::to_string(v) + (v % 2 ? ",0.25\n" : ",0.45\n");
        return text;
    }());
    for (const std::string options :
         {"--lambda 0.3 --refined --map map.csv", "--lambda lambda.csv --refined --sweeps 5 --solver gs", "--lambda 0.5 --handles 1.3,0.6",
          "--lambda 0.3 --fair 10", "--lambda 0.3 --refined --max-iter 1", "--lambda 0.3 --alpha 0.5 --refined --channels none"}) {
        const Outcome outcome = interpolate(folder, options);
        INFO(options << ": " << outcome.err);
        CHECK(outcome.exit_code == 0);
        CHECK(largest_miss(folder, "in.obj") <= 1e-13);
        const json report = report_of(outcome);
        CHECK(report["two_phase"]["max_error"].get<double>() <= 1e-14);
        CHECK(report.contains("energy") == contains(options, "--fair"));
        if (report.contains("energy")) CHECK(report["energy"][1].get<double>() < report["energy"][0].get<double>());
        if (contains(options, "--sweeps")) CHECK(report["iterations"] == 5);
        if (contains(options, "--max-iter")) CHECK(report["converged"] == false);
    }
    const std::string map = folder.read("map.csv");
    CHECK(map.substr(0, map.find('\n')) == "vertex,refined_vertex");
    CHECK(line_count(map) == 37);
    CHECK(contains(map, "\n35,35\n"));
}

TEST_CASE("interpolate --normals takes a CSV or the normals of IN", "[cli][two-phase]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    folder.file("normals.csv", "vertex,nx,ny,nz\n2,0,0,1\n0,2,0,0\n");
    Outcome outcome = interpolate(folder, "--lambda 0.3 --normals normals.csv");
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(largest_miss(folder, "in.obj") <= 1e-14);
    json report = report_of(outcome);
    CHECK(report["two_phase"]["normals"] == 2);
    CHECK(contains(outcome.err, "1 normal was not of unit length and was normalised"));

    folder.file("normals.csv", "vertex,nx,ny,nz\n2,0,0,-1\n");
    outcome = interpolate(folder, "--lambda 0.3 --normals normals.csv");
    CHECK(outcome.exit_code == 0);
    report = report_of(outcome);
    CHECK(report["two_phase"]["normals_on_the_other_side"] == 1);
    CHECK(report["where"]["vertices"] == json::array({2}));
    CHECK(contains(outcome.err, "vertex 2 is on the other side of the surface"));

    std::string with_normals = octahedron;
    for (const char* line : {"vn 1 0 0", "vn 0 1 0", "vn 0 0 1", "vn -1 0 0", "vn 0 -1 0", "vn 0 0 -1"}) with_normals = std::string(line) + "\n" + with_normals;
    for (int v = 1; v <= 6; ++v) {  // v -> v//n; the normals stand in reverse order
        const std::string digit = std::to_string(v), with = digit + "//" + std::to_string(7 - v);
        const std::size_t faces = with_normals.find("f ");
        std::string head = with_normals.substr(0, faces), tail = with_normals.substr(faces);
        for (std::size_t at = tail.find(" " + digit); at != std::string::npos; at = tail.find(" " + digit, at + with.size() + 1))
            if (at + 2 >= tail.size() || tail[at + 2] == ' ' || tail[at + 2] == '\n') tail.replace(at + 1, 1, with);
        with_normals = head + tail;
    }
    folder.file("in.obj", with_normals);
    outcome = interpolate(folder, "--lambda 0.3 --normals mesh");
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    report = report_of(outcome);
    CHECK(report["two_phase"]["normals"] == 6);
    CHECK(report["two_phase"]["normals_on_the_other_side"] == 0);
    outcome = run(folder, "interpolate - -o m1.obj --format obj --report - --lambda 0.3 --normals mesh", "", (folder.path / "in.obj").string());
    CHECK(outcome.exit_code == 0);
    CHECK(report_of(outcome)["two_phase"]["normals"] == 6);

    folder.file("few.txt", "0\n1\n");
    outcome = interpolate(folder, "--lambda 0.3 --normals mesh --subset few.txt");
    CHECK(outcome.exit_code == 0);
    CHECK(report_of(outcome)["two_phase"]["normals"] == 2);
}

TEST_CASE("normals of a mesh with a boundary are left out where none can be asked for", "[cli][two-phase]") {
    const Folder folder;
    std::string text = bumpy_grid(2);
    for (std::size_t at = text.find("f "); at != std::string::npos; at = text.find("f ", at + 1)) {
        std::istringstream words(text.substr(at + 2, text.find('\n', at) - at - 2));
        std::string face = "f";
        for (int v; words >> v;) face += " " + std::to_string(v) + "//1";
        text.replace(at, text.find('\n', at) - at, face);
    }
    folder.file("in.obj", "vn 0 0 1\n" + text);
    const Outcome outcome = interpolate(folder, "--lambda 0.3 --normals mesh");
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(report_of(outcome)["two_phase"]["normals"] == 5);
    CHECK(report_of(outcome)["two_phase"]["normals_left_out"] == 4);
    CHECK(contains(outcome.err, "4 normals were left out"));
}

TEST_CASE("wrong use of the two-phase options ends with exit code 2, bad files with 3", "[cli][two-phase]") {
    const Folder folder;
    folder.file("in.obj", cube);
    folder.file("few.txt", "0\n1\n");
    folder.file("zero.csv", "vertex,nx,ny,nz\n0,1,0,0\n3,0,0,0\n");
    folder.file("outside.csv", "vertex,nx,ny,nz\n2,0,0,1\n");
    folder.file("twice.csv", "vertex,nx,ny,nz\n2,0,0,1\n2,0,0,1\n");
    folder.file("far.csv", "vertex,nx,ny,nz\n8,0,0,1\n");
    folder.file("nan.csv", "vertex,nx,ny,nz\n1,0,nan,1\n");
    folder.file("header.csv", "vertex,x,y,z\n1,0,0,1\n");
    folder.file("handle.csv", "vertex,s\n1,1.5\n2,0\n");
    folder.file("handles.csv", "vertex,s\n1,1.5\n2,0.5\n");
    folder.file("lambda.csv", "vertex,lambda\n0,0.3\n");
    folder.file("corner.txt", "0\n");
    folder.file("at_corner.csv", "vertex,nx,ny,nz\n0,0,0,-1\n");
    struct Case {
        std::string options;
        int exit_code;
        std::string sentence;
    };
    for (const Case& c : {Case{"--refined", 2, "needs --lambda L"},
                          {"--refined --lambda 0", 2, "above 0 and below 1"},
                          {"--fair 1 --lambda 1", 2, "--fair is of the two-phase scheme"},
                          {"--fair 0 --lambda 0.3", 2, "not a number above 0"},
                          {"--handles 1,0 --lambda 0.3", 2, "'1,0' is neither"},
                          {"--handles 2 --lambda 0.3", 2, "'2' is neither"},
                          {"--refined --lambda 0.3 --scheme loop", 2, "--lambda is of catmull-clark"},
                          {"--map map.csv --lambda 0.3", 2, "add --refined"},
                          {"--map in.obj -o in.obj --lambda 0.3", 2, ""},
                          {"--refined --lambda lambda.csv", 3, "lambda of vertex 1"},
                          {"--normals zero.csv --lambda 0.3", 3, "zero.csv:3: the normal is zero"},
                          {"--normals outside.csv --lambda 0.3 --subset few.txt", 3, "outside.csv:2: vertex 2 is not in the subset"},
                          {"--normals twice.csv --lambda 0.3", 3, "twice.csv:3"},
                          {"--normals far.csv --lambda 0.3", 3, "far.csv:2"},
                          {"--normals nan.csv --lambda 0.3", 3, "nan.csv:2: a normal needs finite numbers"},
                          {"--normals header.csv --lambda 0.3", 3, "'vertex,nx,ny,nz'"},
                          {"--normals none.csv --lambda 0.3", 3, "none.csv"},
                          {"--normals mesh --lambda 0.3", 3, "holds no normals"},
                          {"--normals at_corner.csv --lambda 0.3 --corners corner.txt", 3, "vertex 0 can have no prescribed normal"},
                          {"--handles handle.csv --lambda 0.3", 3, "handle.csv:3: the shape handle 0"},
                          {"--handles handles.csv --lambda 0.3", 0, ""}}) {
        const Outcome outcome = run(folder, "interpolate in.obj" + std::string(contains(c.options, "-o ") ? " " : " -o m1.obj ") + c.options);
        INFO(c.options << ": " << outcome.err);
        CHECK(outcome.exit_code == c.exit_code);
        CHECK(contains(outcome.err, c.sentence));
    }
    for (const char* empty : {"--normals ''", "--handles ''"})
        CHECK(run(folder, std::string("interpolate in.obj -o m1.obj --lambda 0.3 ") + empty).exit_code == 2);
    const Outcome map = run(folder, "interpolate in.obj -o unmapped.obj --lambda 0.3 --refined --map nowhere/map.csv");
    CHECK(map.exit_code == 1);
    CHECK_FALSE(folder.has("unmapped.obj"));
    const Outcome stl = run(folder, "interpolate in.obj -o m1.stl --refined --lambda 0.3");
    CHECK(stl.exit_code == 2);
    CHECK(contains(stl.err, "STL holds triangles only"));
}
