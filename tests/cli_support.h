// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the program share: folders, the program as a process of its own, reports, and small meshes as text.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace cli_test {

namespace fs = std::filesystem;
using nlohmann::json;
using Point = std::array<double, 3>;

inline std::string program() {
    if (const char* path = std::getenv("LIMITCL_PROGRAM")) return path;
#ifdef LIMITCL_PROGRAM
    return LIMITCL_PROGRAM;
#else
    return "limitcl";
#endif
}

/// A folder of its own for each test case, gone at its end.
struct Folder {
    fs::path path;
    Folder() {
        std::string pattern = (fs::temp_directory_path() / "limitcl-cli-XXXXXX").string();
        path = mkdtemp(pattern.data());
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string file(const std::string& name, const std::string& content) const {
        std::ofstream(path / name, std::ios::binary) << content;
        return name;
    }
    std::string read(const std::string& name) const {
        std::ifstream stream(path / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    bool has(const std::string& name) const { return fs::exists(path / name); }
    std::size_t entries() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), {})); }
};

struct Outcome {
    int exit_code;
    std::string out, err;
};

/// Runs the program in the folder. `arguments` and `environment` are shell text.
inline Outcome run(const Folder& folder, const std::string& arguments, const std::string& environment = "", const std::string& input = "/dev/null") {
    const Folder streams;
    const std::string out = (streams.path / "out").string(), err = (streams.path / "err").string();
    const std::string command =
        "cd '" + folder.path.string() + "' && " + environment + " '" + program() + "' " + arguments + " < '" + input + "' > '" + out + "' 2> '" + err + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, streams.read("out"), streams.read("err")};
}

/// Starts a program in the folder with a standard input that says nothing until this process ends.
inline pid_t start(const Folder& folder, const std::vector<std::string>& words) {
    int silent[2];
    REQUIRE(pipe2(silent, O_CLOEXEC) == 0);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(silent[0], STDIN_FILENO);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        if (chdir(folder.path.c_str()) == 0) execvp(arguments[0], arguments.data());
        _exit(127);
    }
    close(silent[0]);
    return child;
}

/// Waits a while, presses Ctrl-C, and waits for the end.
inline int exit_code_after_interrupt(pid_t child, int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    REQUIRE(kill(child, SIGINT) == 0);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(WIFEXITED(status));
    return WEXITSTATUS(status);
}

/// Starts a program that writes out.obj and report.json, presses Ctrl-C after a while, and checks that it ends as interrupted, with nothing written.
inline void check_interrupt(const Folder& folder, const std::vector<std::string>& words) {
    CHECK(exit_code_after_interrupt(start(folder, words), 1500) == 130);
    CHECK_FALSE(folder.has("out.obj"));
    CHECK(json::parse(folder.read("report.json")).at("status") == "cancelled");
}

inline json report_of(const Outcome& outcome) {
    INFO(outcome.out << outcome.err);
    REQUIRE(json::accept(outcome.out));
    return json::parse(outcome.out);
}

inline std::size_t line_count(const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')); }

/// The last line: with the summary before it, the line of a failure.
inline std::string last_line(const std::string& text) {
    const std::size_t end = text.find_last_not_of('\n');
    if (end == std::string::npos) return "";
    const std::size_t before = text.rfind('\n', end);
    return text.substr(before == std::string::npos ? 0 : before + 1, end - (before == std::string::npos ? 0 : before + 1) + 1);
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline std::vector<Point> obj_points(const std::string& text) {
    std::vector<Point> points;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string word;
        Point point{};
        if (words >> word && word == "v" && words >> point[0] >> point[1] >> point[2]) points.push_back(point);
    }
    return points;
}

inline double largest_difference(const std::vector<Point>& a, const std::vector<Point>& b) {
    REQUIRE(a.size() == b.size());
    REQUIRE_FALSE(a.empty());
    double largest = 0.0;
    for (std::size_t index = 0; index < a.size(); ++index)
        largest = std::max(largest, std::hypot(a[index][0] - b[index][0], a[index][1] - b[index][1], a[index][2] - b[index][2]));
    return largest;
}

inline const std::string cube = R"(v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

inline const std::string octahedron = R"(v 1 0 0
v 0 1.5 0
v 0 0 1
v -1 0.25 0
v 0 -1 0
v 0 0 -2
f 1 2 3
f 2 4 3
f 4 5 3
f 5 1 3
f 2 1 6
f 4 2 6
f 5 4 6
f 1 5 6
)";

/// (n+1)^2 vertices of a quad grid with heights that no polynomial gives: rough data, and a boundary.
inline std::string bumpy_grid(int n) {
    std::ostringstream text;
    for (int y = 0; y <= n; ++y) {
        for (int x = 0; x <= n; ++x) text << "v " << x << " " << y << " " << ((x * 7 + y * 13) % 5) * 0.2 << "\n";
    }
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            const int first = y * (n + 1) + x + 1;
            text << "f " << first << " " << first + 1 << " " << first + n + 2 << " " << first + n + 1 << "\n";
        }
    }
    return text.str();
}

inline std::string coloured_tetrahedron_ply() {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty double red\nproperty double green\n"
           "property double blue\nproperty float quality\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0 1 0 0 5\n1 0 0 0 1 0 -3\n0 1 0 0 0 1 7\n0 0 1 0.5 0.5 0.5 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
}

}  // namespace cli_test
