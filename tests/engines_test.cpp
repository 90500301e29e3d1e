// SPDX-License-Identifier: BSD-3-Clause
// Engines of point clouds: how the program finds their libraries, and what those of this project make of clouds whose surface is known. Cases of an engine that
// was not built say so and end.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "host/cli/engine_library.h"
#include "host/cli/failure.h"
#include "tests/cli_support.h"
#include "tests/device_support.h"
#include "tests/shapes/shapes.h"

using cli_test::contains;
using cli_test::Folder;
using device_test::Environment;
using lcl::cli::choose_engine;
using lcl::cli::Engine;
using lcl::cli::exit_error;
using lcl::cli::exit_usage;
using lcl::cli::Failure;
using lcl::cli::installed_engines;

namespace {

namespace fs = std::filesystem;
using Values = std::vector<double>;
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Points of a unit sphere, none of them at the poles or in rows.
Values sphere(int count, double radius = 1.0, std::array<double, 3> middle = {0, 0, 0}, double noise = 0.0) {
    shapes::Random random(7);
    Values points;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / count, angle = i * 2.399963229728653 + 0.3 * random.symmetric();  // the golden angle, disturbed
        const double side = std::sqrt(1.0 - z * z), r = radius * (1.0 + noise * random.symmetric());
        for (const double value : {middle[0] + r * side * std::cos(angle), middle[1] + r * side * std::sin(angle), middle[2] + r * z}) points.push_back(value);
    }
    return points;
}

Values joined(Values a, const Values& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// What an engine gave.
struct Result {
    std::int32_t status = 0;
    std::string sentence;
    bool given = false, own_points = false;
    Values points;
    std::vector<std::int32_t> triangles, left_out;
    int progress_calls = 0, stop_at = 0;  ///< stop_at: the progress call that asks to stop, from 1; 0: none
    std::function<void()> meanwhile;      ///< every progress call does this
};

Result run(const Engine& engine, const Values& points, const Settings& settings = {}, const Values& normals = {}, int stop_at = 0,
           const std::function<void()>& meanwhile = {}) {
    Result result;
    result.stop_at = stop_at;
    result.meanwhile = meanwhile;
    result.points = points;
    lcl_engine_sink sink = {};
    sink.struct_size = sizeof(sink);
    sink.self = &result;
    sink.progress = [](void* self, double fraction) -> std::int32_t {
        CHECK(fraction <= 1.0);
        auto& here = *static_cast<Result*>(self);
        if (here.meanwhile) here.meanwhile();
        return ++here.progress_calls != here.stop_at;
    };
    sink.give = [](void* self, std::int32_t count, const double* values, std::int32_t triangle_count, const std::int32_t* triangles) {
        auto& here = *static_cast<Result*>(self);
        CHECK_FALSE(std::exchange(here.given, true));
        here.own_points = values;
        if (values) here.points.assign(values, values + 3 * count);
        else CHECK(here.points.size() == 3 * static_cast<std::size_t>(count));
        here.triangles.assign(triangles, triangles + 3 * triangle_count);
    };
    sink.leave_out = [](void* self, std::int32_t count, const std::int32_t* indices) { static_cast<Result*>(self)->left_out.assign(indices, indices + count); };
    sink.warn = [](void*, const char*) {};
    sink.fail = [](void* self, const char* sentence) { static_cast<Result*>(self)->sentence = sentence; };
    std::vector<lcl_engine_option> options;
    for (const auto& setting : settings) options.push_back({setting.first.c_str(), setting.second.c_str()});
    const lcl_engine_points in = {sizeof(in), static_cast<std::int32_t>(points.size() / 3), points.data(), normals.empty() ? nullptr : normals.data()};
    result.status = engine.engine->run(engine.engine->user, &in, options.data(), options.size(), &sink);
    return result;
}

/// Counts over the triangles alone.
struct Topology {
    int vertices = 0, edges = 0, faces = 0, boundary_edges = 0, components = 0;
    int doubled_half_edges = 0;  ///< 0: no edge has three faces, and neighbours agree on their orientation
    int euler() const { return vertices - edges + faces; }
};

Topology topology_of(const std::vector<std::int32_t>& triangles) {
    Topology result;
    std::map<std::pair<int, int>, int> half_edges;
    std::map<int, int> parents;
    const std::function<int(int)> root = [&](int v) { return parents[v] == v ? v : parents[v] = root(parents[v]); };
    for (const int v : triangles) parents[v] = v;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = triangles[i + k], b = triangles[i + (k + 1) % 3];
            result.doubled_half_edges += ++half_edges[{a, b}] > 1;
            parents[root(a)] = root(b);
        }
    }
    for (const auto& entry : half_edges) {
        const bool has_twin = half_edges.count({entry.first.second, entry.first.first}) > 0;
        result.boundary_edges += !has_twin;
        result.edges += !has_twin || entry.first.first < entry.first.second;
    }
    for (const auto& entry : parents) result.components += root(entry.first) == entry.first;
    result.vertices = static_cast<int>(parents.size());
    result.faces = static_cast<int>(triangles.size() / 3);
    return result;
}

/// Volume inside; below 0 where the triangles are seen clockwise from outside.
double volume(const Result& result) {
    double sum = 0.0;
    for (std::size_t i = 0; i < result.triangles.size(); i += 3) {
        const double *a = &result.points[3 * result.triangles[i]], *b = &result.points[3 * result.triangles[i + 1]],
                     *c = &result.points[3 * result.triangles[i + 2]];
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum / 6.0;
}

/// Largest | |v| - 1 | over the vertices in use.
double largest_distance_to_sphere(const Result& result) {
    double largest = 0.0;
    for (const int v : result.triangles)
        largest = std::max(largest, std::abs(std::hypot(result.points[3 * v], result.points[3 * v + 1], result.points[3 * v + 2]) - 1.0));
    return largest;
}

/// The engine of that name, if it was built.
std::optional<Engine> built(const std::string& name) {
    if (fs::exists(LIMITCL_ENGINE_FOLDER)) {
        const Environment folder("LIMITCL_ENGINE_DIR", LIMITCL_ENGINE_FOLDER);
        std::vector<std::string> warnings;
        const std::vector<Engine> engines = installed_engines(warnings);
        CHECK(warnings.empty());
        for (const Engine& engine : engines) {
            if (engine.name == name) return engine;
        }
    }
    WARN("the engine " << name << " was not built: this case checks nothing");
    return std::nullopt;
}

/// What is written to the process's standard streams while `work` runs, by whatever means.
std::string printed_by(const std::function<void()>& work) {
    const Folder folder;
    const std::string file = (folder.path / "printed").string();
    std::fflush(nullptr);
    const int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO), to = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    dup2(to, STDOUT_FILENO);
    dup2(to, STDERR_FILENO);
    work();
    std::fflush(nullptr);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    for (const int descriptor : {out, err, to}) close(descriptor);
    return folder.read("printed");
}

Failure failure_of_choice(const std::string& name) {
    std::vector<std::string> warnings;
    try {
        choose_engine(name, warnings);
    } catch (const Failure& failure) {
        return failure;
    }
    FAIL("there is an engine '" << name << "'");
    return {};
}

}  // namespace

TEST_CASE("a folder without engine libraries gives none, and the sentence says how to get one", "[engines]") {
    const Folder folder;
    folder.file("limitcl_engine_.so", "no name");
    folder.file("limitcl_engine_notes.txt", "another ending");
    const Environment variable("LIMITCL_ENGINE_DIR", folder.path.c_str());
    std::vector<std::string> warnings;
    CHECK(installed_engines(warnings).empty());
    CHECK(warnings.empty());
    const Failure any = failure_of_choice(""), named = failure_of_choice("poisson");
    CHECK(any.exit_code == exit_error);
    CHECK(named.exit_code == exit_usage);
    for (const std::string& text : {any.message, named.message}) {
        CHECK(contains(text, folder.path.string()));
        CHECK(contains(text, "apt-get install libcgal-dev"));
        CHECK(contains(text, "libopen3d-dev"));
    }
}

TEST_CASE("a folder that cannot be read is told", "[engines]") {
    const Environment variable("LIMITCL_ENGINE_DIR", "/there/is/no/such/folder");
    std::vector<std::string> warnings;
    CHECK(installed_engines(warnings).empty());
    REQUIRE(warnings.size() == 1);
    CHECK(contains(warnings.front(), "/there/is/no/such/folder"));
    CHECK(contains(failure_of_choice("").message, "cannot be read"));
}

TEST_CASE("what is no engine library, or one of another version, is told and passed over", "[engines]") {
    const Folder folder;
    folder.file("limitcl_engine_broken.so", "this is no library");
    fs::copy_file(LIMITCL_OTHER_ABI, folder.path / "limitcl_engine_older.so");
    const Environment variable("LIMITCL_ENGINE_DIR", folder.path.c_str());
    std::vector<std::string> warnings;
    CHECK(installed_engines(warnings).empty());
    REQUIRE(warnings.size() == 2);  // by name
    CHECK(contains(warnings[0], "limitcl_engine_broken.so cannot be loaded"));
    CHECK(contains(warnings[1], "limitcl_engine_older.so is made for another version of limitcl"));
    for (const std::string& warning : warnings) CHECK(cli_test::line_count(warning) == 0);
    CHECK(contains(failure_of_choice("").message, "limitcl_engine_broken.so cannot be loaded"));

    const cli_test::Outcome version = cli_test::run(folder, "--version", "LIMITCL_ENGINE_DIR=.");
    CHECK(version.exit_code == 0);
    CHECK(contains(version.out, "engines: none"));
    CHECK(contains(version.out, "limitcl_engine_older.so is made for another version"));
}

TEST_CASE("engines come in a fixed order, with all that people are told about them", "[engines]") {
    if (!built("advancing-front") || !built("poisson")) return;
    const Environment variable("LIMITCL_ENGINE_DIR", LIMITCL_ENGINE_FOLDER);
    std::vector<std::string> warnings, names;
    for (const Engine& engine : installed_engines(warnings)) {
        names.push_back(engine.name);
        CHECK_FALSE(engine.description.empty());
        CHECK_FALSE(engine.licence.empty());
        CHECK(fs::exists(engine.file));
        Settings defaults;  // a line an option: "KEY=DEFAULT  what it does"
        std::istringstream lines(engine.options);
        for (std::string line; std::getline(lines, line);) {
            const std::size_t equals = line.find('='), blanks = line.find("  ");
            INFO(line);
            REQUIRE((equals != std::string::npos && equals < blanks));
            defaults.push_back({line.substr(0, equals), line.substr(equals + 1, blanks - equals - 1)});
        }
        const Result with = run(engine, sphere(100), defaults), without = run(engine, sphere(100));
        CHECK(with.status == LCL_ENGINE_OK);
        CHECK((with.triangles == without.triangles && with.points == without.points));
    }
    CHECK(names == std::vector<std::string>{"advancing-front", "poisson", "ball-pivoting"});
    CHECK(choose_engine("", warnings).name == "advancing-front");
    CHECK(choose_engine("ball-pivoting", warnings).name == "ball-pivoting");
    CHECK(choose_engine("poisson", warnings).licence == "MIT");
    CHECK(choose_engine("advancing-front", warnings).licence == "GPL-3.0-or-later");
    CHECK(warnings.empty());
    const Failure failure = failure_of_choice("advancing");
    CHECK(failure.exit_code == exit_usage);
    CHECK(contains(failure.message, "'advancing'"));
    CHECK(contains(failure.message, "advancing-front, poisson, ball-pivoting"));
}

TEST_CASE("options that an engine does not have or take are refused in one sentence", "[engines]") {
    const std::string name = GENERATE("advancing-front", "poisson", "ball-pivoting");
    const auto engine = built(name);
    if (!engine) return;
    const Values points = sphere(50);
    const Result unknown = run(*engine, points, {{"no-such-key", "1"}});
    CHECK(unknown.status == LCL_ENGINE_OPTION);
    CHECK(contains(unknown.sentence, "'no-such-key'"));
    CHECK(contains(unknown.sentence, "outlier-neighbours"));  // the list of those there are
    CHECK_FALSE(unknown.given);
    const std::string outliers = name == "advancing-front" ? "outlier-percent" : "outlier-deviations";
    const Settings bad = {{outliers, "-1"},  {outliers, ""},    {outliers, "many"},           {outliers, "1x"},
                          {outliers, "nan"}, {outliers, "1,2"}, {"outlier-neighbours", "2.5"}};
    for (const auto& setting : bad) {
        const Result result = run(*engine, points, {setting});
        INFO(result.sentence);
        CHECK(result.status == LCL_ENGINE_OPTION);
        CHECK(contains(result.sentence, setting.first + "=" + setting.second + ": it takes "));
        CHECK_FALSE(result.given);
    }
    const Settings edges = {{"beta", "1.58"}, {"smooth", "5"}, {"depth", "4"}, {"depth", "13"}, {"radii", "1,"}, {"radii", "1,0"}};
    for (const auto& setting : edges) {
        if (contains(engine->options, setting.first + "=")) CHECK(run(*engine, points, {setting}).status == LCL_ENGINE_OPTION);
    }
}

TEST_CASE("a caller can stop an engine at every report of its progress", "[engines]") {
    const std::string name = GENERATE("advancing-front", "poisson", "ball-pivoting");
    const auto engine = built(name);
    if (!engine) return;
    const Values points = sphere(600);
    const int calls = run(*engine, points).progress_calls;
    REQUIRE(calls >= 2);
    for (int call = 1; call <= calls; ++call) {
        const Result result = run(*engine, points, {}, {}, call);
        CHECK(result.status == LCL_ENGINE_CANCELLED);
        CHECK(result.progress_calls == call);
        CHECK_FALSE(result.given);
    }
    CHECK(run(*engine, points).status == LCL_ENGINE_OK);  // and it works afterwards
}

TEST_CASE("a function of the caller may run another engine", "[engines]") {
    const auto outer = built("poisson"), inner = built("ball-pivoting");
    if (!outer || !inner) return;
    const Values points = sphere(200);
    std::vector<std::int32_t> statuses;
    const auto run_inner = [&] { statuses.push_back(run(*inner, points).status); };
    CHECK(run(*outer, points, {}, {}, 0, run_inner).status == LCL_ENGINE_OK);
    REQUIRE(statuses.size() > 1);
    CHECK(std::count(statuses.begin(), statuses.end(), LCL_ENGINE_OK) == static_cast<std::ptrdiff_t>(statuses.size()));
}

TEST_CASE("engines print nothing", "[engines]") {
    const std::string name = GENERATE("advancing-front", "poisson", "ball-pivoting");
    const auto engine = built(name);
    if (!engine) return;
    Values line;
    for (int i = 0; i < 20; ++i) line.insert(line.end(), {double(i), 0.0, 0.0});
    CHECK(printed_by([&] {
              run(*engine, sphere(300, 1.0, {0, 0, 0}, 0.3), {{name == "advancing-front" ? "outlier-percent" : "outlier-deviations", "1"}});
              run(*engine, line);  // not what the interface allows
          }) == "");
}

TEST_CASE("every run of an engine gives the same triangles", "[engines]") {
    const std::string name = GENERATE("advancing-front", "poisson", "ball-pivoting");
    const auto engine = built(name);
    if (!engine) return;
    Values grid;  // full of equal distances and angles
    for (int i = 0; i < 400; ++i) grid.insert(grid.end(), {double(i % 20), double(i / 20), 0.0625 * (i % 20) * (i % 20)});
    const Result first = run(*engine, grid);
    REQUIRE(first.status == LCL_ENGINE_OK);
    std::vector<std::string> in_the_way;  // other addresses each time
    for (int again = 0; again < 2; ++again) {
        in_the_way.resize(in_the_way.size() + 333, std::string(100 * (again + 1), 'x'));
        const Result next = run(*engine, grid);
        CHECK((next.triangles == first.triangles && next.points == first.points));
    }
}

TEST_CASE("the advancing front closes a sphere with all of its points", "[engines]") {
    const auto engine = built("advancing-front");
    if (!engine) return;
    const Result result = run(*engine, sphere(1000));
    REQUIRE(result.status == LCL_ENGINE_OK);
    CHECK_FALSE(result.own_points);
    CHECK(result.left_out.empty());
    const Topology topology = topology_of(result.triangles);
    CHECK(topology.vertices == 1000);
    CHECK(topology.faces == 1996);
    CHECK(topology.euler() == 2);
    CHECK(topology.boundary_edges == 0);
    CHECK(topology.doubled_half_edges == 0);
    // A polyhedron of points of the unit sphere is inside it, and its faces are farther out than cos r for circles of r around their corners, here r < 0.13:
    // three times the mean spacing's half.
    CHECK(volume(result) > 4.18879 * std::pow(std::cos(0.13), 3));
    CHECK(volume(result) < 4.18880);
}

TEST_CASE("the advancing front keeps all parts of a cloud", "[engines]") {
    const auto engine = built("advancing-front");
    if (!engine) return;
    const Result result = run(*engine, joined(sphere(500), sphere(400, 0.5, {2.0, 0.3, 0.1})));
    const Topology topology = topology_of(result.triangles);
    CHECK(topology.vertices == 900);
    CHECK(topology.components == 2);
    CHECK(topology.euler() == 4);
    CHECK(topology.boundary_edges == 0);
    CHECK(volume(result) > 0.97 * 4.18879 * (1.0 + 0.5 * 0.5 * 0.5));  // both outwards
}

TEST_CASE("the advancing front does not hang on where the cloud is and how large", "[engines]") {
    const auto engine = built("advancing-front");
    if (!engine) return;
    Values points = sphere(500);
    for (double& value : points) value = std::round(std::ldexp(value, 20)) / std::ldexp(1.0, 20);  // so that what follows loses no digit
    const std::vector<std::int32_t> triangles = run(*engine, points).triangles;
    for (const int exponent : {-60, 60}) {
        Values scaled = points;
        for (double& value : scaled) value = std::ldexp(value, exponent);
        CHECK(run(*engine, scaled).triangles == triangles);
    }
    Values far = points;
    for (double& value : far) value += std::ldexp(1.0, 24);
    CHECK(run(*engine, far).triangles == triangles);
}

TEST_CASE("no triangle of the advancing front is larger than its bound", "[engines]") {
    const auto engine = built("advancing-front");
    if (!engine) return;
    Values cap;  // a sphere without the part above z = 0.6
    const Values all = sphere(1000);
    for (std::size_t i = 0; i < all.size(); i += 3) {
        if (all[i + 2] < 0.6) cap.insert(cap.end(), &all[i], &all[i] + 3);
    }
    const Result result = run(*engine, cap, {{"perimeter-bound", "1.2"}});
    REQUIRE(result.status == LCL_ENGINE_OK);
    double largest = 0.0;
    for (std::size_t i = 0; i < result.triangles.size(); i += 3) {
        double perimeter = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double *a = &cap[3 * result.triangles[i + k]], *b = &cap[3 * result.triangles[i + (k + 1) % 3]];
            perimeter += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        }
        largest = std::max(largest, perimeter);
    }
    CHECK(largest <= 1.2);
    const Topology topology = topology_of(result.triangles);
    CHECK(topology.vertices == static_cast<int>(cap.size() / 3));
    CHECK(topology.euler() == 1);  // a disk: the opening, 1.6 wide, stays
    CHECK(topology.boundary_edges > 20);
    CHECK(run(*engine, cap, {{"perimeter-bound", "1e-3"}}).status == LCL_ENGINE_FAILED);
}

TEST_CASE("points far from all others are left out on request", "[engines]") {
    const auto [name, setting] = GENERATE(table<std::string, std::pair<std::string, std::string>>({{"advancing-front", {"outlier-percent", "2"}},
                                                                                                   {"advancing-front", {"outlier-distance", "4"}},
                                                                                                   {"poisson", {"outlier-deviations", "3"}},
                                                                                                   {"ball-pivoting", {"outlier-deviations", "3"}}}));
    const auto engine = built(name);
    if (!engine) return;
    Values points = sphere(490);
    std::vector<std::int32_t> outliers;
    for (int i = 0; i < 10; ++i) {  // between the others in the order of the file, 2 and more from the middle and 1 from each other
        const double outlier[] = {2.0 * std::cos(0.6 * i), 2.0 * std::sin(0.6 * i), i % 2 ? 1.5 : -1.5};
        points.insert(points.begin() + 3 * 45 * i, outlier, outlier + 3);
        outliers.push_back(45 * i);
    }
    const Result result = run(*engine, points, {setting});
    REQUIRE(result.status == LCL_ENGINE_OK);
    CHECK(result.left_out == outliers);
    CHECK(largest_distance_to_sphere(result) < 0.05);  // the outliers are 1 and more away
    if (!result.own_points) {
        for (const int outlier : outliers) CHECK(std::count(result.triangles.begin(), result.triangles.end(), outlier) == 0);
    }
}

TEST_CASE("smoothing takes most of the noise away", "[engines]") {
    const auto engine = built("advancing-front");
    if (!engine) return;
    const Values noisy = sphere(1500, 1.0, {0, 0, 0}, 0.02);
    const Result plain = run(*engine, noisy), smoothed = run(*engine, noisy, {{"smooth", "40"}});
    REQUIRE(smoothed.status == LCL_ENGINE_OK);
    CHECK(smoothed.own_points);
    // A quadric has six coefficients: through 40 points about sqrt(6 / 40) = 0.39 of the noise stays, and the largest of 1500 deviates like that too.
    CHECK(largest_distance_to_sphere(plain) > 0.019);
    CHECK(largest_distance_to_sphere(smoothed) < 0.6 * largest_distance_to_sphere(plain));
    CHECK(topology_of(smoothed.triangles).euler() == 2);
}

TEST_CASE("Poisson closes a sphere outwards, with normals and without", "[engines]") {
    const auto engine = built("poisson");
    if (!engine) return;
    const Values points = sphere(1000);
    const bool with_normals = GENERATE(true, false);
    const Result result = run(*engine, points, {}, with_normals ? points : Values());
    REQUIRE(result.status == LCL_ENGINE_OK);
    CHECK(result.own_points);
    const Topology topology = topology_of(result.triangles);
    CHECK(topology.euler() == 2);
    CHECK(topology.components == 1);
    CHECK(topology.boundary_edges == 0);
    CHECK(volume(result) > 4.1);
    // Cells of the octree are 2.2 / 2^5 wide here, and the surface is linear in them: their sagitta is below 0.07^2 / 4. The rest is the method's own
    // smoothing.
    CHECK(largest_distance_to_sphere(result) < 0.02);
}

TEST_CASE("parts of a cloud without normals are all turned outwards", "[engines]") {
    const std::string name = GENERATE("poisson", "ball-pivoting");
    const auto engine = built(name);
    if (!engine) return;
    const Result result = run(*engine, joined(sphere(700), sphere(500, 0.8, {3.0, 0.3, 1.1})), name == "poisson" ? Settings{} : Settings{{"radii", "2,4,8"}});
    REQUIRE(result.status == LCL_ENGINE_OK);
    const Topology topology = topology_of(result.triangles);
    CHECK(topology.components == 2);
    CHECK(topology.euler() == 4);
    CHECK(topology.boundary_edges == 0);
    CHECK(volume(result) > 0.97 * 4.18879 * (1.0 + 0.8 * 0.8 * 0.8));  // with one of them inwards it would be 0.49 of the first
}

TEST_CASE("Poisson leaves open clouds open", "[engines]") {
    const auto engine = built("poisson");
    if (!engine) return;
    Values half;
    const Values all = sphere(1500);
    for (std::size_t i = 0; i < all.size(); i += 3) {
        if (all[i + 2] > -0.2) half.insert(half.end(), &all[i], &all[i] + 3);
    }
    const auto largest_gap = [&half](const Result& result) {
        double largest = 0.0;
        for (const int v : result.triangles) {
            double least = 9.0;
            for (std::size_t i = 0; i < half.size(); i += 3)
                least =
                    std::min(least, std::hypot(result.points[3 * v] - half[i], result.points[3 * v + 1] - half[i + 1], result.points[3 * v + 2] - half[i + 2]));
            largest = std::max(largest, least);
        }
        return largest;
    };
    const Result trimmed = run(*engine, half, {}, half), whole = run(*engine, half, {{"trim", "0"}}, half);
    const Topology topology = topology_of(trimmed.triangles);
    CHECK(topology.euler() == 1);
    CHECK(topology.boundary_edges > 20);
    // What is left is within 4 spacings of a point, which are means over six neighbours: at most 0.2 at the rim of 1500 points.
    CHECK(largest_gap(trimmed) <= 0.8);
    CHECK(largest_gap(trimmed) < largest_gap(whole));
}

TEST_CASE("ball pivoting goes through the points, outwards", "[engines]") {
    const auto engine = built("ball-pivoting");
    if (!engine) return;
    const Values points = sphere(1000);
    const Result result = run(*engine, points, {}, points);
    REQUIRE(result.status == LCL_ENGINE_OK);
    CHECK_FALSE(result.own_points);
    const Topology topology = topology_of(result.triangles);
    CHECK(topology.vertices > 990);
    CHECK(topology.doubled_half_edges == 0);
    CHECK(topology.components == 1);
    CHECK(volume(result) > 4.1);
    CHECK(run(*engine, points, {{"radii", "0.01"}}, points).status == LCL_ENGINE_FAILED);
}
