// SPDX-License-Identifier: BSD-3-Clause
// limitcl evaluate and limitcl closest, as scripts see them. Values are those of the C API, which has proofs of its own.
#include <limits>
#include <map>

#include "tests/capi_support.h"
#include "tests/cli_support.h"
#include "tests/compressed.h"

using namespace cli_test;

namespace {

/// A table by the names of its columns.
struct Csv {
    std::string header;
    std::map<std::string, std::vector<double>> columns;
    std::size_t rows = 0;

    explicit Csv(const std::string& text) {
        std::istringstream lines(text);
        std::getline(lines, header);
        std::vector<std::string> names;
        std::istringstream cells(header);
        for (std::string name; std::getline(cells, name, ',');) names.push_back(name);
        for (std::string line; std::getline(lines, line); ++rows) {
            std::istringstream row(line);
            std::size_t column = 0;
            for (std::string cell; std::getline(row, cell, ','); ++column) {
                REQUIRE(column < names.size());
                columns[names[column]].push_back(cell == "nan" ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell));
            }
            REQUIRE(column == names.size());
        }
    }
    /// Three columns, "x" and "u": xu, yu, zu.
    std::vector<double> vectors(const std::string& suffix, const std::string& first = "xyz", const std::string& prefix = "") const {
        std::vector<double> result;
        for (std::size_t row = 0; row < rows; ++row)
            for (const char axis : first) result.push_back(columns.at(prefix + axis + suffix)[row]);
        return result;
    }
};

const std::string first_columns = "face,corner,u,v,x,y,z", second_columns = ",xu,yu,zu,xv,yv,zv,nx,ny,nz",
                  third_columns = ",xuu,yuu,zuu,xuv,yuv,zuv,xvv,yvv,zvv,gauss,mean", closest_columns = "x,y,z,face,corner,u,v,distance,nx,ny,nz";

const std::string places_of_cube = "face,corner,u,v\n1,0,0.5,0.25\n3,0,0,0\n5,0,1,0.125\n";

capi_test::LimitSurface surface_of(const std::string& path, const lcl_scheme_options& options) {
    lcl_mesh mesh = nullptr;
    capi_test::succeed(lcl_mesh_read(path.c_str(), LCL_FORMAT_BY_ENDING, &mesh));
    const capi_test::Mesh owned(mesh);
    lcl_limit_surface surface = nullptr;
    capi_test::succeed(lcl_limit_surface_create(capi_test::default_context(), mesh, &options, LCL_PRECISION_DOUBLE, &surface));
    return capi_test::LimitSurface(surface);
}

/// Equal, or both not a number.
bool same(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
    if (a.size() != b.size() || a.empty()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::isnan(a[i]) != std::isnan(b[i]) || std::abs(a[i] - b[i]) > tolerance) return false;
    return true;
}

}  // namespace

TEST_CASE("evaluate writes the values of the C API in the columns that were asked for", "[cli][evaluate]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    folder.file("at.csv", places_of_cube);
    const auto surface = surface_of((folder.path / "cube.obj").string(), capi_test::scheme(LCL_SCHEME_CATMULL_CLARK, 0.5));
    const std::int32_t faces[] = {1, 3, 5};
    const double uv[] = {0.5, 0.25, 0, 0, 1, 0.125};
    std::vector<double> points(9), du(9), dv(9), normals(9), duu(9), duv(9), dvv(9), gauss(3), mean(3);
    lcl_surface_values values = LCL_SURFACE_VALUES_INIT;
    values.points = points.data(), values.du = du.data(), values.dv = dv.data(), values.normals = normals.data();
    values.duu = duu.data(), values.duv = duv.data(), values.dvv = dvv.data(), values.gauss = gauss.data(), values.mean = mean.data();
    capi_test::succeed(lcl_limit_surface_evaluate(surface.get(), 3, faces, nullptr, uv, &values));

    const std::string arguments = "evaluate cube.obj --at at.csv -o out.csv --alpha 0.5 --precision double ";
    for (const int derivatives : {0, 1, 2}) {
        const Outcome outcome = run(folder, arguments + (derivatives == 1 ? "" : "--derivatives " + std::to_string(derivatives)));
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        CHECK(outcome.out.empty());
        CHECK(contains(outcome.err, "out.csv: 3 places"));
        const Csv table(folder.read("out.csv"));
        CHECK(table.header == first_columns + (derivatives > 0 ? second_columns : "") + (derivatives > 1 ? third_columns : ""));
        REQUIRE(table.rows == 3);
        CHECK(table.columns.at("face") == std::vector<double>{1, 3, 5});
        CHECK(table.columns.at("corner") == std::vector<double>{0, 0, 0});
        CHECK(table.columns.at("u") == std::vector<double>{0.5, 0, 1});
        CHECK(same(table.vectors(""), points, 1e-15));
        if (derivatives == 0) continue;
        CHECK(same(table.vectors("u"), du, 1e-14));
        CHECK(same(table.vectors("v"), dv, 1e-14));
        CHECK(same(table.vectors("", "xyz", "n"), normals, 1e-14));
        if (derivatives == 1) continue;
        CHECK(same(table.vectors("uu"), duu, 1e-13));
        CHECK(same(table.vectors("uv"), duv, 1e-13));
        CHECK(same(table.vectors("vv"), dvv, 1e-13));
        CHECK(same(table.columns.at("gauss"), gauss, 1e-13));
        CHECK(same(table.columns.at("mean"), mean, 1e-13));
        CHECK(std::isnan(table.columns.at("gauss")[1]));  // a vertex of valence 3
        CHECK(contains(folder.read("out.csv"), ",nan"));
    }
    CHECK(folder.entries() == 3);
}

TEST_CASE("evaluate reports, is quiet, and writes to standard output", "[cli][evaluate]") {
    const Folder folder;
    folder.file("in.obj", octahedron);
    folder.file("at.csv", "face, corner, u, v\r\n\r\n0, 0, 0.25, 0.5\r\n");
    const Outcome quiet = run(folder, "evaluate in.obj --at at.csv -o out.csv --quiet --report -");
    CHECK(quiet.exit_code == 0);
    CHECK(quiet.err.empty());
    const json report = report_of(quiet);
    CHECK(report["command"] == "evaluate");
    CHECK(report["status"] == "ok");
    CHECK(report["scheme"] == "loop");
    CHECK(report["parameters"]["derivatives"] == 1);
    CHECK(report["parameters"]["places"] == 1);
    CHECK(report["parameters"]["precision"] == "mixed");
    CHECK(report["mesh"]["faces"] == 8);
    const Outcome shown = run(folder, "evaluate in.obj --at at.csv -o - --quiet");
    CHECK(shown.exit_code == 0);
    CHECK(shown.out == folder.read("out.csv"));
    CHECK(line_count(shown.out) == 2);
    // Nothing to do is done; IN may come from a pipe.
    folder.file("none.csv", "face,corner,u,v\n");
    CHECK(run(folder, "evaluate - --format obj --at none.csv -o - --quiet", "", "in.obj").out == first_columns + second_columns + "\n");
    const std::string packed = compressed(folder.read("at.csv"));
    folder.file("at.csv.gz", packed);
    CHECK(run(folder, "evaluate in.obj --at at.csv.gz -o - --quiet").out == shown.out);
    // The other schemes, by their options.
    for (const std::string scheme : {"--scheme catmull-clark --alpha auto", "--scheme doo-sabin", "--mask classic"})
        CHECK(run(folder, "evaluate in.obj --at at.csv -o other.csv --quiet " + scheme).exit_code == 0);
}

TEST_CASE("places that are not there are exit code 3 with file and line, and leave the output as it was", "[cli][evaluate][exit]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    folder.file("out.csv", "as before");
    struct Bad {
        std::string places, line;
    };
    for (const auto& [places, line] :
         {Bad{"face,corner,u,v\n0,0,0.5,0.5\n\n6,0,0,0\n", ":4:"}, Bad{"face,corner,u,v\n0,1,0,0\n", ":2:"}, Bad{"face,corner,u,v\n0,0,1.5,0\n", ":2:"},
          Bad{"face,corner,u,v\n0,0,nan,0\n", ":2:"}, Bad{"face,corner,u,v\n0.5,0,0,0\n", ":2:"}, Bad{"face,corner,u,v\n0,1e10,0,0\n", ":2:"},
          Bad{"face,corner,u,v\n0,0,0\n", ":2:"}, Bad{"face,corner,u,v\n0,0,a,0\n", ":2:"}, Bad{"face,corner,s,t\n0,0,0,0\n", ":1:"}, Bad{"", ":1:"}}) {
        folder.file("at.csv", places);
        const Outcome outcome = run(folder, "evaluate cube.obj --at at.csv -o out.csv");
        INFO(places << outcome.err);
        CHECK(outcome.exit_code == 3);
        CHECK(contains(last_line(outcome.err), "at.csv" + line));
        CHECK_FALSE(contains(outcome.err, "place "));  // the file's line says it
        CHECK(folder.read("out.csv") == "as before");
    }
    // One that lies behind the first piece of the table.
    std::string many = "face,corner,u,v\n";
    for (int i = 0; i < 70000; ++i) many += "0,0,0.5,0.5\n";
    folder.file("many.csv", many + "0,0,2,0\n");
    CHECK(contains(last_line(run(folder, "evaluate cube.obj --at many.csv -o out.csv").err), "many.csv:70002:"));
    CHECK(folder.read("out.csv") == "as before");
    const Outcome nothing = run(folder, "evaluate cube.obj --at many.csv -o - --quiet");
    CHECK(nothing.exit_code == 3);
    CHECK(nothing.out.empty());
    CHECK(run(folder, "evaluate cube.obj --at nowhere.csv -o out.csv").exit_code == 3);
    CHECK(run(folder, "evaluate nowhere.obj --at many.csv -o out.csv").exit_code == 3);
    CHECK(folder.entries() == 4);
}

TEST_CASE("wrong usage of evaluate and closest is exit code 2", "[cli][evaluate][closest][exit]") {
    const Folder folder;
    folder.file("in.obj", cube);
    folder.file("at.csv", places_of_cube);
    folder.file("p.xyz", "0 0 2\n");
    const std::string arguments = GENERATE(
        "evaluate in.obj --at at.csv", "evaluate in.obj -o o.csv", "evaluate in.obj --at at.csv -o o.csv --derivatives 3",
        "evaluate in.obj --at at.csv -o o.csv --lambda 0.3", "evaluate in.obj --at at.csv -o o.csv --lambda 0", "evaluate in.obj --at at.csv -o o.obj",
        "evaluate in.obj --at - -o o.csv", "evaluate in.obj --at at.csv -o - --report -", "evaluate in.obj --at at.csv -o o.csv --report o.csv",
        "evaluate - --at at.csv -o o.csv", "evaluate in.obj --at at.csv -o o.csv --format obj", "evaluate in.obj --at at.csv -o o.csv --points p.xyz",
        "closest in.obj --points p.xyz", "closest in.obj -o o.csv", "closest in.obj --points p.abc -o o.csv", "closest in.obj --points p.xyz -o o.ply",
        "closest in.obj --points p.xyz -o o.csv --lambda 0.5", "closest in.obj --points - -o o.csv", "closest in.obj --points p.xyz -o o.csv --derivatives 1");
    const Outcome outcome = run(folder, arguments);
    INFO(arguments << "\n" << outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(line_count(outcome.err) == 1);
    CHECK(folder.entries() == 3);
}

TEST_CASE("closest takes points from every format and gives the values of the C API", "[cli][closest]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    const std::vector<double> points{0, 0, 2, 0.125, 0.25, 0.5, -3, 1, 0.75};
    folder.file("p.xyz", "# x y z and more\n0 0 2 9 9\n\n0.125 0.25 0.5 1 7\n-3\t1 0.75 1 0\n");
    folder.file("p.pts", "3\n0 0 2 7\n0.125 0.25 0.5 128\n-3 1 0.75 9\n");
    folder.file("p.csv", "id,z,y,x\n1,2,0,0\n2,0.5,0.25,0.125\n3,0.75,1,-3\n");
    folder.file("p.obj", "v 0 0 2\nv 0.125 0.25 0.5\nv -3 1 0.75\n");
    folder.file("p.off", "OFF\n3 0 0\n0 0 2\n0.125 0.25 0.5\n-3 1 0.75\n");
    folder.file("p.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nend_header\n0 0 2\n0.125 0.25 0.5\n"
                "-3 1 0.75\n");
    folder.file("q.xyz.gz", compressed(folder.read("p.xyz")));
    folder.file("q.PTS", folder.read("p.pts"));
    folder.file("q.ply.gz", compressed(folder.read("p.ply")));

    const auto surface = surface_of((folder.path / "cube.obj").string(), capi_test::scheme(LCL_SCHEME_CATMULL_CLARK));
    std::vector<double> found(9), normals(9), distances(3), uv(6);
    std::vector<std::int32_t> faces(3);
    lcl_closest_points closest = LCL_CLOSEST_POINTS_INIT;
    closest.points = found.data(), closest.normals = normals.data(), closest.distances = distances.data(), closest.uv = uv.data(), closest.faces = faces.data();
    capi_test::succeed(lcl_limit_surface_closest(surface.get(), 3, points.data(), 0, &closest));
    for (const char* name : {"p.xyz", "p.pts", "p.csv", "p.obj", "p.off", "p.ply", "q.xyz.gz", "q.PTS", "q.ply.gz"}) {
        const Outcome outcome = run(folder, std::string("closest cube.obj --precision double -o out.csv --points ") + name);
        INFO(name << outcome.err);
        REQUIRE(outcome.exit_code == 0);
        CHECK(contains(outcome.err, "out.csv: 3 closest points"));
        const Csv table(folder.read("out.csv"));
        CHECK(table.header == closest_columns);
        REQUIRE(table.rows == 3);
        CHECK(same(table.vectors(""), found, 1e-9));
        CHECK(same(table.vectors("", "xyz", "n"), normals, 1e-9));
        CHECK(same(table.columns.at("distance"), distances, 1e-12));
        CHECK(table.columns.at("face") == std::vector<double>(faces.begin(), faces.end()));
        CHECK(table.columns.at("distance")[0] > 0);  // outside
        CHECK(table.columns.at("distance")[1] < 0);  // inside
    }
    const json report = report_of(run(folder, "closest cube.obj --points p.xyz -o out.csv --quiet --report -"));
    CHECK(report["command"] == "closest");
    CHECK(report["parameters"]["points"] == 3);
    const Outcome shown = run(folder, "closest cube.obj --points p.xyz -o - --quiet");
    CHECK(shown.out == folder.read("out.csv"));
}

TEST_CASE("points that cannot be read are exit code 3", "[cli][closest][exit]") {
    const Folder folder;
    folder.file("cube.obj", cube);
    struct Bad {
        std::string name, text, part;
    };
    for (const auto& [name, text, part] :
         {Bad{"a.xyz", "0 0 1\n0 nan 1\n", "a.xyz:2:"}, Bad{"b.xyz", "0 0\n", "b.xyz:1:"}, Bad{"c.xyz", "0 0 x\n", "c.xyz:1:"},
          Bad{"d.pts", "2\n0 0 1\n", "d.pts:1: the first line says 2 points, 1 line follows"}, Bad{"e.pts", "0 0 1\n0 0 2\n", "e.pts:1:"},
          Bad{"f.csv", "x,y\n0,0\n", "column z"}, Bad{"g.csv", "x,y,z\n0,0\n", "g.csv:2:"}, Bad{"h.csv", "x,y,z\n0,inf,0\n", "h.csv:2:"},
          Bad{"i.csv", "", "i.csv is empty"}, Bad{"m.xyz", "0 0 1\n0 0 1 7\n", "m.xyz:2: mixed columns"}, Bad{"j.obj", "v 0 0 1\nv nan 0 0\n", "j.obj"},
          Bad{"k.pts", "", "k.pts"}, Bad{"l.xyz.gz", compressed("0 0 1\n").substr(0, 12), "l.xyz.gz"}}) {
        folder.file(name, text);
        const Outcome outcome = run(folder, "closest cube.obj -o out.csv --points " + name);
        INFO(name << outcome.err);
        CHECK(outcome.exit_code == 3);
        CHECK(contains(last_line(outcome.err), part));
    }
    CHECK(run(folder, "closest cube.obj -o out.csv --points nowhere.xyz").exit_code == 3);
    CHECK(run(folder, "closest cube.obj -o out.csv --points nowhere.ply").exit_code == 3);
    CHECK_FALSE(folder.has("out.csv"));
    folder.file("none.xyz", "# no points\n");
    CHECK(run(folder, "closest cube.obj -o - --quiet --points none.xyz").out == closest_columns + "\n");
}
