// SPDX-License-Identifier: BSD-3-Clause
// The program as scripts see it: exit codes, files, streams, report. It is run as a process of its own.

#include "tests/cli_support.h"

using namespace cli_test;

namespace {

const double grid_diagonal_6 = std::sqrt(6.0 * 6.0 + 6.0 * 6.0 + 0.8 * 0.8);

}  // namespace

TEST_CASE("help lists the commands of this version and the program says what it is", "[cli]") {
    const Folder folder;
    const Outcome help = run(folder, "--help");
    CHECK(help.exit_code == 0);
    CHECK(help.err.empty());
    for (const char* command : {"devices", "selftest", "info", "interpolate", "limit", "refine", "expand", "spectrum", "denoise", "sharpen", "morph", "texture",
                                "evaluate", "closest", "surface"})
        CHECK(contains(help.out, std::string("\n  ") + command + " "));
    const Outcome command_help = run(folder, "interpolate --help");
    CHECK(command_help.exit_code == 0);
    for (const char* option :
         {"--output", "--solver", "--subset", "--sweeps", "--alpha", "--boundary", "--tol", "--report", "--handles", "--fair", "--normals"})
        CHECK(contains(command_help.out, option));
    const Outcome version = run(folder, "--version");
    CHECK(version.exit_code == 0);
    CHECK(contains(version.out, "limitcl "));
    CHECK(contains(version.out, ".obj"));
}

TEST_CASE("wrong usage is exit code 2 with one line that says what to do", "[cli][exit]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    folder.file("in.xyz", "0 0 0\n");
    const std::string arguments = GENERATE(
        as<std::string>(), "", "bogus", "interpolate", "interpolate in.obj", "interpolate in.obj -o", "interpolate in.obj -o out.obj --bogus",
        "interpolate in.obj extra.obj -o out.obj", "interpolate in.obj -o out.xyz", "interpolate in.xyz -o out.obj", "interpolate in.obj -o out",
        "interpolate in.obj -o out.obj --scheme bogus", "interpolate in.obj -o out.obj --alpha 1.5", "interpolate in.obj -o out.obj --alpha -0.1",
        "interpolate in.obj -o out.obj --alpha soon", "interpolate in.obj -o out.obj --lambda 2", "interpolate in.obj -o out.obj --lambda=-1",
        "interpolate in.obj -o out.obj --tol 0", "interpolate in.obj -o out.obj --tol nan", "interpolate in.obj -o out.obj --tol 1e-6x",
        "interpolate in.obj -o out.obj --max-iter 0", "interpolate in.obj -o out.obj --max-iter 1.5", "interpolate in.obj -o out.obj --sweeps 0",
        "interpolate in.obj -o out.obj --crease-angle 0", "interpolate in.obj -o out.obj --crease-angle 181", "interpolate in.obj -o out.obj --boundary open",
        "interpolate in.obj -o out.obj --precision half", "interpolate in.obj -o out.obj --solver sor", "interpolate in.obj -o out.obj --color blue",
        "interpolate in.obj -o out.obj --mask classic --alpha 0", "interpolate in.obj -o out.obj --mask classic --lambda 0.3",
        "interpolate in.obj -o out.obj --scheme loop --alpha 0", "interpolate in.obj -o out.obj --scheme doo-sabin --lambda 0",
        "interpolate in.obj -o out.obj --scheme loop --mask catmull", "interpolate in.obj -o out.obj --quiet -v", "interpolate - -o out.obj",
        "interpolate in.obj -o -", "interpolate in.obj -o out.obj --format obj", "interpolate in.obj -o - --format obj --report -",
        "interpolate in.obj -o out.obj --report out.obj", "interpolate in.obj -o out.obj --channels heat", "refine in.obj -o out.obj --levels -1",
        "refine in.obj -o out.obj --levels 0", "refine in.obj -o out.obj --map out.obj", "refine in.obj -o out.obj --map -", "devices --alpha 0",
        "selftest --tol 1", "devices in.obj");
    const Outcome outcome = run(folder, arguments);
    INFO(arguments << "\n" << outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(last_line(outcome.err).rfind("limitcl: error: ", 0) == 0);
    CHECK(folder.entries() == 2);
}

TEST_CASE("bad input is exit code 3, says where, and leaves the output as it was", "[cli][exit]") {
    const Folder folder;
    folder.file("good.obj", octahedron);
    folder.file("quad.obj", cube);
    folder.file("malformed.obj", "v 0 0 0\nv 1 0\nf 1 2 1\n");
    folder.file("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    folder.file("twice.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n");
    folder.file("three.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
    folder.file("flipped.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\n");
    folder.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    folder.file("empty.off", "");
    folder.file("header.ply",
                "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\nproperty double x\nproperty double y\nproperty double z\nend_header\n");
    folder.file("semi.obj", octahedron + "t crease 2/1/0 0 1 2.5\n");
    folder.file("list.txt", "0\n1\n\n1\n");
    folder.file("far.txt", "0\n6\n");
    folder.file("word.txt", "zero\n");
    folder.file("none.txt", "\n");
    folder.file("noedge.txt", "0 1\n0 3\n");
    folder.file("header.csv", "vertex;lambda\n0,0.5\n");
    folder.file("ratio.csv", "vertex,lambda\n0,0.5\n1,1.5\n");
    folder.file("twice.csv", "vertex,lambda\n0,0.5\n0,0.25\n");
    folder.file("cells.csv", "vertex,lambda\n0,0.5,1\n");
    folder.file("out.obj", "what was there before\n");
    const std::size_t entries = folder.entries();
    const auto [arguments, part] = GENERATE(table<std::string, std::string>({{"missing.obj", "missing.obj"},
                                                                             {"malformed.obj", "malformed.obj:2"},
                                                                             {"range.obj", "8"},
                                                                             {"twice.obj", "face 0"},
                                                                             {"three.obj", "edge"},
                                                                             {"flipped.obj", "orient"},
                                                                             {"points.obj", "no faces"},
                                                                             {"empty.off", "empty.off"},
                                                                             {"header.ply", "header.ply"},
                                                                             {"semi.obj", "crease"},
                                                                             {"quad.obj --scheme loop", "face 0"},
                                                                             {"good.obj --subset missing.txt", "missing.txt"},
                                                                             {"good.obj --subset list.txt", "list.txt:4"},
                                                                             {"good.obj --corners far.txt", "far.txt:2"},
                                                                             {"good.obj --subset word.txt", "word.txt:1"},
                                                                             {"good.obj --subset none.txt", "none.txt"},
                                                                             {"good.obj --creases noedge.txt", "noedge.txt:2"},
                                                                             {"good.obj --creases far.txt", "far.txt:1"},
                                                                             {"good.obj --lambda missing.csv", "missing.csv"},
                                                                             {"good.obj --lambda header.csv", "header.csv:1"},
                                                                             {"good.obj --lambda ratio.csv", "ratio.csv:3"},
                                                                             {"good.obj --lambda twice.csv", "twice.csv:3"},
                                                                             {"good.obj --lambda cells.csv", "cells.csv:2"}}));
    const Outcome outcome = run(folder, "interpolate " + arguments + " -o out.obj --report -");
    INFO(arguments << "\n" << outcome.err);
    CHECK(outcome.exit_code == 3);
    CHECK(last_line(outcome.err).rfind("limitcl: error: ", 0) == 0);
    CHECK(contains(last_line(outcome.err), part));
    CHECK(folder.read("out.obj") == "what was there before\n");
    CHECK(folder.entries() == entries);
    const json report = report_of(outcome);
    CHECK(report.at("status") == "bad-input");
    CHECK(report.at("command") == "interpolate");
    CHECK(contains(last_line(outcome.err), report.at("message").get<std::string>()));
}

TEST_CASE("the cube is singular at alpha 0, is written only with --keep-going, and works with alpha auto", "[cli][exit]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    const Outcome plain = run(folder, "interpolate cube.obj -o out.obj --report report.json");
    INFO(plain.err);
    CHECK(plain.exit_code == 4);
    CHECK_FALSE(folder.has("out.obj"));
    CHECK(contains(plain.err, "alpha"));
    const json report = json::parse(folder.read("report.json"));
    CHECK(report.at("status") == "singular");
    CHECK_FALSE(report.at("where").at("vertices").empty());
    CHECK(report.at("mesh").at("valences") == json({{"3", 8}}));

    const Outcome going = run(folder, "interpolate cube.obj -o out.obj --keep-going --report -");
    CHECK(going.exit_code == 4);
    CHECK(obj_points(folder.read("out.obj")).size() == 8);
    CHECK(report_of(going).at("status") == "singular");

    const Outcome cured = run(folder, "interpolate cube.obj -o cured.obj --alpha auto --report -");
    CHECK(cured.exit_code == 0);
    CHECK(report_of(cured).at("parameters").at("alpha") == 0.5);
    CHECK(report_of(cured).at("scheme") == "catmull-clark");
    REQUIRE(run(folder, "limit cured.obj -o back.obj --alpha 0.5").exit_code == 0);
    CHECK(largest_difference(obj_points(folder.read("back.obj")), obj_points(cube)) <= 1e-6 * std::sqrt(12.0));
}

TEST_CASE("the limit points of a singular operator exist", "[cli]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    REQUIRE(run(folder, "limit cube.obj -o out.obj").exit_code == 0);
    const std::vector<Point> limits = obj_points(folder.read("out.obj"));
    // valence 3, d = 4: (6 V + 2 (sum of edge ends) + sum of all corners of the three faces) / 24 = (6 + 2 + 4) / 24 of V for the cube round the origin
    std::vector<Point> expected = obj_points(cube);
    for (Point& point : expected) {
        for (double& coordinate : point) coordinate *= 12.0 / 24.0;
    }
    CHECK(largest_difference(limits, expected) <= 1e-12);
}

TEST_CASE("an iteration limit that is too low is exit code 4, --sweeps is exit code 0", "[cli][exit]") {
    const Folder folder;
    folder.file("grid.obj", bumpy_grid(6));
    const Outcome short_run = run(folder, "interpolate grid.obj -o out.obj --solver pia --max-iter 3 --report -");
    CHECK(short_run.exit_code == 4);
    CHECK(report_of(short_run).at("status") == "not-converged");
    CHECK(report_of(short_run).at("converged") == false);
    CHECK_FALSE(folder.has("out.obj"));
    const Outcome sweeps = run(folder, "interpolate grid.obj -o out.obj --solver pia --sweeps 3 --report -");
    CHECK(sweeps.exit_code == 0);
    const json report = report_of(sweeps);
    CHECK(report.at("status") == "ok");
    CHECK(report.at("converged") == false);
    CHECK(report.at("iterations") == 3);
    CHECK(report_of(run(folder, "interpolate grid.obj -o out.obj --solver pia --sweeps 1000 --report -")).at("iterations") == 1000);
    REQUIRE(report.at("residuals").size() == 4);
    CHECK(report.at("residuals")[3].get<double>() < report.at("residuals")[0].get<double>());
    CHECK(folder.has("out.obj"));
}

TEST_CASE("without a device: exit code 5, an empty list, and the ways to install one", "[cli][exit]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    fs::create_directory(folder.path / "no-vendors");
    const std::string none = "OCL_ICD_VENDORS='" + (folder.path / "no-vendors").string() + "'";
    const Outcome devices = run(folder, "devices --report -", none);
    CHECK(devices.exit_code == 5);
    CHECK(report_of(devices).at("devices").empty());
    CHECK(report_of(devices).at("status") == "no-device");
    CHECK(contains(devices.err, "install"));
    const Outcome solve = run(folder, "interpolate in.obj -o out.obj --quiet", none);
    CHECK(solve.exit_code == 5);
    CHECK(line_count(solve.err) == 1);
    CHECK_FALSE(folder.has("out.obj"));
    CHECK(run(folder, "info in.obj", none).exit_code == 0);
    CHECK(run(folder, "refine in.obj -o out.obj", none).exit_code == 0);
}

TEST_CASE("a device that is not there is exit code 5", "[cli][exit]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    const Outcome outcome = run(folder, "interpolate in.obj -o out.obj --device no-such-device-anywhere --report -");
    CHECK(outcome.exit_code == 5);
    CHECK(report_of(outcome).at("status") == "no-device");
    CHECK(contains(outcome.err, "no-such-device-anywhere"));
}

TEST_CASE("output that cannot be written is exit code 1", "[cli][exit]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    CHECK(run(folder, "interpolate in.obj -o no-such-folder/out.obj").exit_code == 1);
    CHECK(run(folder, "interpolate in.obj -o out.obj --report no-such-folder/report.json").exit_code == 1);
    CHECK(run(folder, "refine in.obj -o out.obj --map no-such-folder/map.csv").exit_code == 1);
}

TEST_CASE("interpolation then limit gives the input back, in every format", "[cli][io]") {
    const Folder folder;
    folder.file("tri.obj", octahedron);
    const std::string ending = GENERATE(as<std::string>(), ".obj", ".OBJ", ".off", ".ply", ".stl", ".om", ".obj.gz", ".off.gz", ".ply.gz", ".stl.gz", ".om.gz");
    // with blend ratio 1 every vertex is its own limit point: a conversion
    const Outcome conversion = run(folder, "limit tri.obj --lambda 1 -o in" + ending);
    INFO(ending << "\n" << conversion.err);
    REQUIRE(conversion.exit_code == 0);
    const Outcome forth = run(folder, "interpolate in" + ending + " -o P" + ending);
    INFO(forth.err);
    REQUIRE(forth.exit_code == 0);
    const Outcome back = run(folder, "limit P" + ending + " -o back.obj");
    INFO(back.err);
    REQUIRE(back.exit_code == 0);
    const double diagonal = std::sqrt(4.0 + 6.25 + 9.0);
    // STL holds floats: each coordinate of P, up to 4 in size, is off by at most 2^-23
    const double rounding = ending.find("stl") != std::string::npos ? std::sqrt(3.0) * std::ldexp(1.0, -23) * 2.0 : 0.0;
    std::vector<Point> expected = obj_points(octahedron);
    // STL numbers by first appearance, which is 0 1 2 3 4 5 here as well
    CHECK(largest_difference(obj_points(folder.read("back.obj")), expected) <= 1e-6 * diagonal + rounding);
}

TEST_CASE("interpolation then limit gives the input back, with every scheme and option", "[cli]") {
    const Folder folder;
    folder.file("grid.obj", bumpy_grid(6));
    folder.file("creases.txt", "8 9\n9 10\n10 11\n");
    folder.file("corners.txt", "24\n");
    folder.file("lambda.csv", "vertex,lambda\n8,0.5\n20,0.3\n");
    const std::string options =
        GENERATE(as<std::string>(), "", "--alpha 0.5", "--lambda 0.3", "--lambda lambda.csv", "--scheme doo-sabin", "--mask classic", "--boundary fixed",
                 "--boundary edge-only", "--corners corners.txt", "--alpha 0.3 --lambda 0.2 --boundary fixed", "--device cpu --precision double");
    REQUIRE(run(folder, "interpolate grid.obj -o P.ply " + options).exit_code == 0);
    REQUIRE(run(folder, options + " limit P.ply -o back.obj").exit_code == 0);
    CHECK(largest_difference(obj_points(folder.read("back.obj")), obj_points(bumpy_grid(6))) <= 1.0000001e-6 * grid_diagonal_6);
}

TEST_CASE("the report has the fields of the contract", "[cli][report]") {
    const Folder folder;
    folder.file("grid.obj", bumpy_grid(6));
    const Outcome outcome = run(folder, "--tol 1e-8 interpolate grid.obj -o out.obj --report -");
    REQUIRE(outcome.exit_code == 0);
    const json report = report_of(outcome);
    for (const char* field : {"limitcl", "command", "status", "message", "warnings", "where", "device", "mesh", "diagonal", "scheme", "parameters", "solver",
                              "converged", "iterations", "residuals", "lambda_min", "max_error", "surface_error_bound", "seconds"})
        CHECK(report.contains(field));
    CHECK(report.at("status") == "ok");
    CHECK(report.at("message") == "");
    CHECK(report.at("command") == "interpolate");
    for (const char* field : {"platform", "name", "version"}) CHECK(report.at("device").at(field).is_string());
    CHECK(report.at("mesh") == json({{"vertices", 49},
                                     {"faces", 36},
                                     {"edges", 84},
                                     {"boundary_edges", 24},
                                     {"boundary_loops", 1},
                                     {"components", 1},
                                     {"isolated_vertices", 0},
                                     {"face_degrees", {{"4", 36}}},
                                     {"valences", {{"2", 4}, {"3", 20}, {"4", 25}}},
                                     {"creases", 0},
                                     {"corners", 4}}));
    CHECK(report.at("diagonal").get<double>() == Approx(grid_diagonal_6).epsilon(1e-14));
    CHECK(report.at("scheme") == "catmull-clark");
    const json parameters = report.at("parameters");
    CHECK(parameters.at("alpha") == 0.0);
    CHECK(parameters.at("lambda") == 0.0);
    CHECK(parameters.at("boundary") == "edge-and-corner");
    CHECK(parameters.at("tolerance") == 1e-8);
    CHECK(parameters.at("max_iter") == 200);
    CHECK(parameters.at("precision") == "mixed");
    CHECK(report.at("converged") == true);
    CHECK(report.at("max_error").get<double>() <= 1e-8 * grid_diagonal_6);
    CHECK(report.at("surface_error_bound").get<double>() >= report.at("max_error").get<double>());  // |A^-1| is at least 1: rows sum to one
    CHECK(report.at("residuals").size() == report.at("iterations").get<std::size_t>() + 1);
    for (const char* phase : {"read", "topology", "compile", "upload", "solve", "download", "write", "total"})
        CHECK(report.at("seconds").at(phase).get<double>() >= 0.0);
}

TEST_CASE("meshes go through pipes", "[cli][io]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    const Outcome forth = run(folder, "interpolate - -o - --format obj --quiet", "", (folder.path / "in.obj").string());
    REQUIRE(forth.exit_code == 0);
    CHECK(forth.err.empty());
    folder.file("P.obj", forth.out);
    const Outcome back = run(folder, "limit P.obj -o - --format obj");
    REQUIRE(back.exit_code == 0);
    CHECK(largest_difference(obj_points(back.out), obj_points(octahedron)) <= 1e-6 * std::sqrt(4.0 + 6.25 + 9.0));
}

TEST_CASE("--quiet leaves standard error empty, a failure is one line", "[cli][text]") {
    const Folder folder;
    folder.file("in.obj", octahedron + "t hole 1/0/0 3\n");
    folder.file("creases.txt", "0 1\n");
    const Outcome good = run(folder, "interpolate in.obj -o out.ply --creases creases.txt --quiet --report -");
    CHECK(good.exit_code == 0);
    CHECK(good.err.empty());
    CHECK_FALSE(report_of(good).at("warnings").empty());
    CHECK_FALSE(run(folder, "interpolate in.obj -o out.ply").err.empty());
    CHECK(line_count(run(folder, "interpolate missing.obj -o out.ply --quiet").err) == 1);
}

TEST_CASE("colours are for terminals, or where they are asked for", "[cli][text]") {
    const Folder folder;
    const std::string escape = "\033[";
    CHECK_FALSE(contains(run(folder, "info missing.obj").err, escape));
    CHECK(contains(run(folder, "info missing.obj --color always").err, escape));
    CHECK(contains(run(folder, "--color always info missing.obj", "NO_COLOR=1").err, escape));
    CHECK_FALSE(contains(run(folder, "info missing.obj --color never").err, escape));
    if (std::system("script -qec true /dev/null > /dev/null 2>&1 < /dev/null") != 0) {
        WARN("no pseudo-terminal can be opened here; colours on a terminal were not looked at");
        return;
    }
    const auto on_terminal = [&](const std::string& environment) {
        const std::string command = "cd '" + folder.path.string() + "' && " + environment + " TERM=xterm script -qec \"'" + program() +
                                    "' info missing.obj\" typescript > /dev/null 2>&1 < /dev/null";
        CHECK(std::system(command.c_str()) != 0);
        return folder.read("typescript");
    };
    CHECK(contains(on_terminal(""), escape + "31m"));
    CHECK_FALSE(contains(on_terminal("NO_COLOR=1"), escape + "31m"));
}

TEST_CASE("-o may name the input", "[cli][io]") {
    const Folder folder;
    folder.file("mesh.obj", octahedron);
    REQUIRE(run(folder, "interpolate mesh.obj -o mesh.obj").exit_code == 0);
    CHECK(largest_difference(obj_points(folder.read("mesh.obj")), obj_points(octahedron)) > 0.1);
    REQUIRE(run(folder, "limit mesh.obj -o mesh.obj").exit_code == 0);
    CHECK(largest_difference(obj_points(folder.read("mesh.obj")), obj_points(octahedron)) <= 1e-6 * std::sqrt(4.0 + 6.25 + 9.0));
    CHECK(folder.entries() == 1);
}

TEST_CASE("vertices outside the subset keep their control points", "[cli]") {
    const Folder folder;
    folder.file("grid.obj", bumpy_grid(6));
    folder.file("subset.txt", "8\n16\n24\n17\n");
    const Outcome outcome = run(folder, "interpolate grid.obj -o P.obj --subset subset.txt --report -");
    REQUIRE(outcome.exit_code == 0);
    CHECK(report_of(outcome).at("parameters").at("subset") == 4);
    REQUIRE(run(folder, "limit P.obj -o S.obj").exit_code == 0);
    const std::vector<Point> given = obj_points(bumpy_grid(6)), control = obj_points(folder.read("P.obj")), limit = obj_points(folder.read("S.obj"));
    for (std::size_t vertex = 0; vertex < given.size(); ++vertex) {
        const bool listed = vertex == 8 || vertex == 16 || vertex == 24 || vertex == 17;
        const std::vector<Point>& met = listed ? limit : control;
        INFO(vertex);
        CHECK(largest_difference({met[vertex]}, {given[vertex]}) <= (listed ? 1e-6 * grid_diagonal_6 : 0.0));
    }
}

TEST_CASE("per-vertex data passes through, or is solved like x, y, z", "[cli][channels]") {
    const Folder folder;
    folder.file("in.ply", coloured_tetrahedron_ply());
    const auto values = [&](const std::string& name) {
        const std::string text = folder.read(name);
        std::istringstream stream(text.substr(text.find("end_header\n") + 11));
        std::vector<double> numbers(28);
        for (double& number : numbers) stream >> number;
        return numbers;
    };
    const std::vector<double> given = values("in.ply");
    REQUIRE(run(folder, "interpolate in.ply -o plain.ply").exit_code == 0);
    const std::vector<double> plain = values("plain.ply");
    const Outcome outcome = run(folder, "interpolate in.ply -o P.ply --channels all --report -");
    REQUIRE(outcome.exit_code == 0);
    CHECK(report_of(outcome).at("parameters").at("channels") == json({"red", "green", "blue", "quality"}));
    const std::vector<double> solved = values("P.ply");
    REQUIRE(run(folder, "limit P.ply -o back.ply --channels all").exit_code == 0);
    const std::vector<double> back = values("back.ply");
    for (std::size_t index = 0; index < given.size(); ++index) {
        INFO(index);
        const bool position = index % 7 < 3;
        CHECK((position ? solved[index] : given[index]) == Approx(plain[index]).margin(2e-6));  // two solves to 1e-6 of the diagonal
        // tolerance 1e-6 of the channel's range, at most 10; quality is a float in the file: 2^-23 of values up to 32
        CHECK(back[index] == Approx(given[index]).margin(index % 7 == 6 ? 1.4e-5 : 2e-6));
    }
    CHECK(std::abs(solved[6] - given[6]) > 0.5);
    const Outcome colours = run(folder, "interpolate in.ply -o P.ply --channels colours --report -");
    CHECK(report_of(colours).at("parameters").at("channels") == json({"red", "green", "blue"}));
    CHECK(report_of(run(folder, "interpolate in.ply -o P.ply --channels quality,blue --report -")).at("parameters").at("channels") ==
          json({"quality", "blue"}));
}

TEST_CASE("tags are refused, ignored with a warning, or carried to the output", "[cli][tags]") {
    const Folder folder;
    folder.file("semi.obj", octahedron + "t corner 1/1/0 0 3\n");
    folder.file("open.obj", bumpy_grid(3) + "t interpolateboundary 1/0/0 0\n");
    folder.file("hole.obj", octahedron + "t hole 1/0/0 3\n");
    folder.file("grid.obj", bumpy_grid(3));
    for (const char* command : {"interpolate", "limit", "refine"}) {
        CHECK(run(folder, std::string(command) + " semi.obj -o out.obj").exit_code == 3);
        CHECK(run(folder, std::string(command) + " open.obj -o out.obj").exit_code == 3);
    }
    CHECK(run(folder, "info semi.obj").exit_code == 0);
    const Outcome ignored = run(folder, "info hole.obj --report -");
    CHECK(ignored.exit_code == 0);
    CHECK(report_of(ignored).at("tags_ignored") == json({"hole"}));
    CHECK_FALSE(report_of(ignored).at("warnings").empty());

    folder.file("creases.txt", "5 6\n6 10\n");
    folder.file("corners.txt", "9\n");
    REQUIRE(run(folder, "interpolate grid.obj -o out.obj --boundary edge-only --creases creases.txt --corners corners.txt").exit_code == 0);
    const std::string written = folder.read("out.obj");
    CHECK(contains(written, "t interpolateboundary 1/0/0 2"));
    CHECK(contains(written, "t crease"));
    CHECK(contains(written, "t corner"));
    const json carried = report_of(run(folder, "info out.obj --report -"));
    CHECK(carried.at("mesh").at("creases") == 2);
    CHECK(carried.at("mesh").at("corners") == 1);  // edge-only: the grid's own corners are none
    CHECK(carried.at("parameters").at("boundary") == "edge-only");
    const Outcome dropped = run(folder, "interpolate grid.obj -o out.ply --creases creases.txt --report -");
    CHECK(dropped.exit_code == 0);
    CHECK(report_of(dropped).at("warnings").size() == 1);
}

TEST_CASE("info answers for every file that can be parsed", "[cli][info]") {
    const Folder folder;
    folder.file("cube.obj", cube + "w 1 2\nw 2 3\n");
    folder.file("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\nf 1 1 2\n");
    folder.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    folder.file("malformed.obj", "v 0 0\n");
    const json sound = report_of(run(folder, "info cube.obj --report -"));
    CHECK(sound.at("mesh").at("edges") == 12);
    CHECK(sound.at("schemes").at("catmull-clark").at("suitable") == true);
    CHECK(sound.at("schemes").at("catmull-clark").at("singular") == true);
    CHECK(sound.at("schemes").at("loop").at("suitable") == false);
    CHECK(sound.at("schemes").at("doo-sabin").at("suitable") == true);
    CHECK(sound.at("schemes").at("doo-sabin").at("singular") == false);
    CHECK(sound.at("defects").empty());
    CHECK(sound.at("unknown_statements") == json({{"w", 2}}));
    CHECK(report_of(run(folder, "info cube.obj --alpha 0.5 --report -")).at("schemes").at("catmull-clark").at("singular") == false);

    const Outcome broken = run(folder, "info broken.obj --report -");
    CHECK(broken.exit_code == 0);
    std::vector<std::string> kinds;
    const json defects = report_of(broken).at("defects");
    for (const json& defect : defects) kinds.push_back(defect.at("kind"));
    CHECK(std::find(kinds.begin(), kinds.end(), "edge-with-three-faces") != kinds.end());
    CHECK(std::find(kinds.begin(), kinds.end(), "repeated-vertex") != kinds.end());
    CHECK(report_of(broken).at("schemes").at("catmull-clark").at("suitable") == false);

    const Outcome table = run(folder, "info cube.obj");
    CHECK(table.exit_code == 0);
    CHECK(contains(table.out, "4: 6"));
    CHECK(contains(table.out, "singular"));
    CHECK(run(folder, "info points.obj").exit_code == 0);
    CHECK(run(folder, "info malformed.obj").exit_code == 3);
}

TEST_CASE("refinement gives known points, their places, and limit points", "[cli][refine]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    REQUIRE(run(folder, "refine cube.obj -o fine.obj --map map.csv").exit_code == 0);
    const std::vector<Point> fine = obj_points(folder.read("fine.obj"));
    REQUIRE(fine.size() == 26);
    // Catmull-Clark, valence 3: (F mean + 2 R mean) / 3 with F mean = V/3, R mean = 2V/3: 5/9 of V; the last six are face centres
    CHECK(largest_difference({fine[6]}, {{5.0 / 9.0, 5.0 / 9.0, 5.0 / 9.0}}) <= 1e-15);
    CHECK(largest_difference({fine[21]}, {{0.0, 0.0, 1.0}}) <= 1e-15);
    const std::string map = folder.read("map.csv");
    CHECK(map.rfind("vertex,face,corner,u,v\n", 0) == 0);
    CHECK(line_count(map) == 27);
    CHECK(contains(map, "\n21,1,0,0.5,0.5\n"));

    // alpha and lambda are used up by the first refinement: limit points of vertex 0 agree before and after
    REQUIRE(run(folder, "refine cube.obj -o limit2.obj --levels 2 --limit --alpha 0.5").exit_code == 0);
    REQUIRE(run(folder, "limit cube.obj -o limit0.obj --alpha 0.5").exit_code == 0);
    const std::vector<Point> limit0 = obj_points(folder.read("limit0.obj")), limit2 = obj_points(folder.read("limit2.obj"));
    for (std::size_t vertex = 0; vertex < 8; ++vertex) CHECK(largest_difference({limit2[vertex]}, {limit0[vertex]}) <= 1e-13);
    REQUIRE(run(folder, "refine cube.obj -o same.obj --levels 0 --limit --alpha 0.5").exit_code == 0);
    CHECK(largest_difference(obj_points(folder.read("same.obj")), limit0) <= 1e-14);
    const Outcome chosen = run(folder, "refine cube.obj -o auto.obj --alpha auto --report -");
    CHECK(chosen.exit_code == 0);
    CHECK(report_of(chosen).at("parameters").at("alpha") == 0.5);
    REQUIRE(run(folder, "refine cube.obj -o half.obj --alpha 0.5").exit_code == 0);
    CHECK(folder.read("auto.obj") == folder.read("half.obj"));
}

TEST_CASE("STL takes triangles only", "[cli][exit]") {
    const Folder folder;
    folder.file("grid.obj", bumpy_grid(3));
    const Outcome outcome = run(folder, "interpolate grid.obj -o out.stl --quiet");
    CHECK(outcome.exit_code == 2);
    CHECK(contains(outcome.err, "STL"));
    CHECK_FALSE(folder.has("out.stl"));
    CHECK(run(folder, "refine grid.obj -o out.stl").exit_code == 2);
}

TEST_CASE("devices are listed and pass the self-test", "[cli][devices]") {
    const Folder folder;
    const Outcome devices = run(folder, "devices");
    REQUIRE(devices.exit_code == 0);
    CHECK(line_count(devices.out) >= 2);
    const json list = report_of(run(folder, "devices --report -")).at("devices");
    REQUIRE_FALSE(list.empty());
    CHECK(list[0].at("index") == 0);
    CHECK(list[0].at("memory_bytes").get<double>() > 0.0);
    CHECK(report_of(run(folder, "devices --device 0 --report -")).at("devices").size() == 1);
    CHECK(run(folder, "devices --device no-such-device-anywhere").exit_code == 5);
    const Outcome selftest = run(folder, "selftest --report report.json");
    INFO(selftest.out << selftest.err);
    CHECK(selftest.exit_code == 0);
    const json kernels = json::parse(folder.read("report.json")).at("kernels");
    CHECK_FALSE(kernels.empty());
    for (const json& kernel : kernels) CHECK(kernel.at("passed") == true);
    CHECK(line_count(selftest.out) == kernels.size() + 1);
}

TEST_CASE("Ctrl-C is exit code 130 with nothing written", "[cli][exit]") {
    const Folder folder;
    folder.file("grid.obj", bumpy_grid(40));
    // one that iterates for minutes, one that waits for standard input
    const std::vector<std::string> arguments =
        GENERATE(values<std::vector<std::string>>({{"grid.obj", "--solver", "pia", "--sweeps", "3000000"}, {"-", "--format", "obj"}}));
    std::vector<std::string> words = {program(), "interpolate", "-o", "out.obj", "--report", "report.json"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    check_interrupt(folder, words);
}

TEST_CASE("real meshes are interpolated to tolerance", "[cli][meshes]") {
    const char* meshes = std::getenv("LIMITCL_MESHES");
    if (meshes == nullptr) return;
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "boundary/cat_head.obj", "boundary/hemisphere.off", "boundary/stanford-bunny.obj.gz",
                                      "boundary/doorman.obj.gz", "boundary/compas_tubemesh.ply");
    const std::string path = (fs::path(meshes) / name).string();
    if (!fs::exists(path)) return;
    const Outcome outcome = run(folder, "interpolate '" + path + "' -o P.obj --report -");
    INFO(name << "\n" << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const json report = report_of(outcome);
    const double tolerance = 1e-6 * report.at("diagonal").get<double>();
    CHECK(report.at("max_error").get<double>() <= tolerance);
    REQUIRE(run(folder, "limit P.obj -o back.obj").exit_code == 0);
    REQUIRE(run(folder, "limit '" + path + "' --lambda 1 -o given.obj").exit_code == 0);
    CHECK(largest_difference(obj_points(folder.read("back.obj")), obj_points(folder.read("given.obj"))) <= 1.0001 * tolerance);
}
