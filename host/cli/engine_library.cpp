// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/engine_library.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

#include "host/cli/failure.h"
#include "host/cli/terminal.h"

namespace lcl::cli {

namespace {

namespace fs = std::filesystem;

const std::string file_prefix = "limitcl_engine_", file_ending = ".so";

/// Engines of this project, and the Debian package that each is built with.
const std::pair<const char*, const char*> own_engines[] = {
    {"advancing-front", "libcgal-dev"}, {"poisson", "libopen3d-dev"}, {"ball-pivoting", "libopen3d-dev"}};

/// `limitcl` beside the library that this program runs with, in the build folder as where it is installed.
fs::path folder_beside_library() {
    Dl_info info = {};
    const void* symbol = dlsym(RTLD_DEFAULT, "lcl_version");
    if (!symbol || !dladdr(symbol, &info) || !info.dli_fname) return {};
    std::error_code error;
    const fs::path library = fs::canonical(info.dli_fname, error);
    return error ? fs::path() : library.parent_path() / "limitcl";
}

fs::path engine_folder() {
    const char* given = std::getenv("LIMITCL_ENGINE_DIR");
    return given && *given ? fs::path(given) : folder_beside_library();
}

/// "limitcl_engine_cgal.so" -> "cgal"; nothing for other files.
std::optional<std::string> library_name(const fs::path& file) {
    const std::string name = file.filename().string();
    const std::size_t around = file_prefix.size() + file_ending.size();
    if (name.size() <= around || name.compare(0, file_prefix.size(), file_prefix) != 0) return std::nullopt;
    if (file.extension() != file_ending) return std::nullopt;
    return name.substr(file_prefix.size(), name.size() - around);
}

/// The place in the order of libraries: our two first, CGAL's before Open3D's since it keeps the points; others by name.
std::pair<int, std::string> rank(const fs::path& file) {
    const std::string name = library_name(file).value_or("");
    return {name == "cgal" ? 0 : name == "open3d" ? 1 : 2, name};
}

std::vector<fs::path> engine_files(std::vector<std::string>& warnings) {
    std::vector<fs::path> files;
    const fs::path folder = engine_folder();
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (library_name(entry->path())) files.push_back(fs::absolute(entry->path()));  // dlopen takes a bare name for one of the system's
    }
    const char* given = std::getenv("LIMITCL_ENGINE_DIR");
    if (error && given && *given) warnings.push_back("LIMITCL_ENGINE_DIR: the folder " + folder.string() + " cannot be read: " + error.message());
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) { return rank(a) < rank(b); });
    return files;
}

bool is_complete(const lcl_engine& engine) { return engine.struct_size == sizeof(lcl_engine) && engine.name && *engine.name && engine.run; }

std::string text_or_none(const char* text) { return text ? text : ""; }

/// The engines of one library, or none and a warning.
std::vector<Engine> load(const std::string& file, std::vector<std::string>& warnings) {
    const auto refuse = [&](const std::string& why) {
        warnings.push_back("the engine library " + file + " " + why);
        return std::vector<Engine>();
    };
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) return refuse(one_line(std::string("cannot be loaded: ") + dlerror()));
    const auto get_engines = reinterpret_cast<lcl_engines_function>(dlsym(library, "lcl_engines"));
    if (!get_engines) return refuse("is none: it has no function lcl_engines");
    std::size_t count = 0;
    const lcl_engine* found = get_engines(LCL_ENGINE_ABI, &count);
    if (!found) return refuse("is made for another version of limitcl: build it with this one");
    std::vector<Engine> engines;
    for (const lcl_engine* engine = found; engine != found + count; ++engine) {
        if (!is_complete(*engine)) return refuse("gives an engine without a name or a function: build it with this version of limitcl");
        engines.push_back({engine->name, text_or_none(engine->description), text_or_none(engine->licence), text_or_none(engine->options), file, engine});
    }
    return engines;
}

std::string package_of(const std::string& name) {
    for (const auto& [engine, package] : own_engines) {
        if (name == engine) return package;
    }
    return "";
}

/// Nothing of that name, which may be empty, among the engines that are installed.
[[noreturn]] void fail_without(const std::string& name, const std::vector<Engine>& engines, const std::vector<std::string>& warnings) {
    const std::string folder = engine_folder().string(), where = folder.empty() ? "" : " in " + folder;
    if (engines.empty()) {
        const std::string broken = warnings.empty() ? "" : " (" + warnings.front() + ")";
        fail(name.empty() ? exit_error : exit_usage,
             "no engine for point clouds is installed" + where + broken +
                 ": apt-get install libcgal-dev (CGAL's advancing front, GPL) or libopen3d-dev (Open3D's Poisson and ball "
                 "pivoting, MIT), and build limitcl again");
    }
    std::vector<std::string> names;
    for (const Engine& engine : engines) names.push_back(engine.name);
    std::string sentence = "--engine: there is no '" + name + "'" + where + "; installed: " + join(names, ", ");
    const std::string package = package_of(name);
    if (!package.empty()) sentence += "; for '" + name + "' apt-get install " + package + " and build limitcl again";
    fail(exit_usage, sentence);
}

}  // namespace

std::vector<Engine> installed_engines(std::vector<std::string>& warnings) {
    std::vector<Engine> engines;
    for (const fs::path& file : engine_files(warnings)) {
        for (Engine& engine : load(file.string(), warnings)) engines.push_back(std::move(engine));
    }
    return engines;
}

Engine choose_engine(const std::string& name, std::vector<std::string>& warnings) {
    std::vector<Engine> others;
    for (const fs::path& file : engine_files(warnings)) {
        for (Engine& engine : load(file.string(), warnings)) {
            if (name.empty() || engine.name == name) return std::move(engine);
            others.push_back(std::move(engine));
        }
    }
    fail_without(name, others, warnings);
}

void require_option(const Engine& engine, const std::string& key) {
    std::vector<std::string> keys;
    std::istringstream lines(engine.options);
    for (std::string line; std::getline(lines, line);) keys.push_back(line.substr(0, line.find('=')));
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) return;
    fail(exit_usage, "--engine-option: the engine '" + engine.name + "' has no option '" + key +
                         (keys.empty() ? "': it has none at all" : "': its options are " + join(keys, ", ")));
}

}  // namespace lcl::cli
