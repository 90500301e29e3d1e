// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <sstream>

#include "host/device/binary_cache.h"
#include "host/device/embedded_kernels.h"
#include "tests/device_support.h"
#include "tests/io_support.h"

using device_test::contains;
using io_test::TemporaryFolder;
using lcl::BinaryCache;
using lcl::Buffer;
using lcl::Context;

namespace {

std::vector<std::string> lines_of(std::string_view text) {
    std::istringstream stream{std::string(text)};
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::map<std::string, std::vector<std::string>> embedded_lines() {
    std::map<std::string, std::vector<std::string>> files;
    for (const lcl::EmbeddedKernel& file : lcl::embedded_kernels()) files["kernels/" + std::string(file.name)] = lines_of(file.text);
    return files;
}

std::shared_ptr<Context> context_with_cache(const std::string& folder) {
    lcl::ContextOptions options;
    options.cache_directory = folder;
    return Context::create(lcl::choose_device(), options);
}

std::vector<std::string> files_in(const TemporaryFolder& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

struct Entry {
    std::string key, binary;
};

/// The two parts of a cache file: after the line of the magic come the sizes of key and binary, then both.
Entry parse_entry(const std::string& path) {
    const std::string content = io_test::file_bytes(path);
    const std::size_t sizes = content.find('\n') + 1, head = content.find('\n', sizes) + 1;
    const std::size_t key_size = std::stoul(content.substr(sizes));
    return {content.substr(head, key_size), content.substr(head + key_size)};
}

/// Imports the values 1..8 as rows of one channel and returns what the device wrote: 1 2 3 .. for LCL_WIDTH 1, 1 0 2 0 .. for LCL_WIDTH 2.
std::vector<float> imported(const std::shared_ptr<Context>& context, const std::string& options) {
    const std::vector<float> frame(16, 1.0f), source{2, 3, 4, 5, 6, 7, 8, 9};
    const std::vector<cl_int> order{0, 1, 2, 3};
    const Buffer rows(context, 8 * sizeof(float), "rows");
    context->fill_zero(rows, "clearing rows");
    device_test::transfer(*context, context->kernel("transfer", "lcl_import_points", options), 4, {}, device_test::upload(context, order, "order"),
                          device_test::upload(context, frame, "frame"), device_test::upload(context, source, "source"), rows);
    std::vector<float> result(8);
    context->read(rows, 0, 8 * sizeof(float), result.data(), "reading rows");
    return result;
}

const std::string narrow = "-D LCL_WIDTH=1", wide = "-D LCL_WIDTH=2";
const std::vector<float> narrow_rows{1, 2, 3, 4, 0, 0, 0, 0}, wide_rows{1, 0, 2, 0, 3, 0, 4, 0};

}  // namespace

TEST_CASE("every line of a kernel's source is a line of the file and number that its #line directives say", "[device][program]") {
    const auto files = embedded_lines();
    std::size_t sources = 0;
    for (const lcl::EmbeddedKernel& kernel : lcl::embedded_kernels()) {
        const std::string name(kernel.name);
        if (name.size() < 3 || name.substr(name.size() - 3) != ".cl") continue;
        ++sources;
        const std::vector<std::string> lines = lines_of(lcl::kernel_source(name.substr(0, name.size() - 3)));
        REQUIRE(lines.at(0) == "#line 1 \"kernels/" + name + "\"");
        std::string file;
        std::size_t number = 0;
        std::set<std::pair<std::string, std::size_t>> seen;
        for (const std::string& line : lines) {
            if (line.substr(0, 6) == "#line ") {
                number = std::stoul(line.substr(6));
                file = line.substr(line.find('"') + 1, line.rfind('"') - line.find('"') - 1);
                continue;
            }
            INFO(file << " line " << number << " in the source of " << name);
            REQUIRE(line == files.at(file).at(number - 1));
            REQUIRE(seen.emplace(file, number).second);  // a header comes once
            REQUIRE(line.substr(0, 10) != "#include \"");
            ++number;
        }
        // All of the file itself is there, but for its #include lines.
        const std::vector<std::string>& own = files.at("kernels/" + name);
        for (std::size_t i = 0; i < own.size(); ++i) CHECK(seen.count({"kernels/" + name, i + 1}) == (own[i].substr(0, 10) == "#include \"" ? 0 : 1));
    }
    CHECK(sources > 0);
}

TEST_CASE("a kernel file that is not embedded is refused by name", "[device][program]") {
    const std::string sentence = io_test::error_of<lcl::InvalidArgument>([] { lcl::kernel_source("no_such"); });
    CHECK(contains(sentence, "kernels/no_such.cl"));
    CHECK(contains(sentence, "transfer.cl"));
}

TEST_CASE("a build error says what failed, for which device, and where in which kernel file", "[device][program]") {
    const TemporaryFolder folder;
    const auto context = context_with_cache(folder.path());
    std::string sentence;
    try {
        context->kernel("transfer", "lcl_import_points", "-D LCL_REAL=nonsense");
    } catch (const lcl::DeviceError& error) {
        sentence = error.what();
        CHECK(error.code == CL_BUILD_PROGRAM_FAILURE);
    }
    INFO(sentence);
    CHECK(contains(sentence, "clBuildProgram failed with CL_BUILD_PROGRAM_FAILURE (-11) while building kernels/transfer.cl for " + context->device().name));
    CHECK(contains(sentence, "nonsense"));
    // The first line of the file that uses the type.
    const std::vector<std::string> lines = embedded_lines().at("kernels/transfer.cl");
    const auto first = std::find_if(lines.begin(), lines.end(), [](const std::string& line) { return contains(line, "__global LCL_REAL*"); });
    REQUIRE(first != lines.end());
    CHECK(contains(sentence, "transfer.cl:" + std::to_string(first - lines.begin() + 1)));
    CHECK(files_in(folder).empty());
    CHECK(imported(context, narrow) == narrow_rows);  // the context is none the worse
}

TEST_CASE("a kernel that its file lacks is an error with both names", "[device][program]") {
    const TemporaryFolder folder;
    const auto context = context_with_cache(folder.path());
    const std::string sentence = io_test::error_of<lcl::DeviceError>([&] { context->kernel("transfer", "lcl_no_such_kernel"); });
    CHECK(contains(sentence, "CL_INVALID_KERNEL_NAME (-46)"));
    CHECK(contains(sentence, "lcl_no_such_kernel"));
    CHECK(contains(sentence, "kernels/transfer.cl"));
}

TEST_CASE("a kernel is built once for each set of options", "[device][program]") {
    const TemporaryFolder folder;
    const auto context = context_with_cache(folder.path());
    const cl_kernel first = context->kernel("transfer", "lcl_import_points", narrow);
    const double seconds = context->compile_seconds();
    CHECK(seconds > 0);
    CHECK(context->kernel("transfer", "lcl_import_points", narrow) == first);
    CHECK(context->compile_seconds() == seconds);
    CHECK(context->kernel("transfer", "lcl_import_points", wide) != first);
    CHECK(context->compile_seconds() > seconds);
    CHECK(files_in(folder).size() == 2);
    context->kernel("transfer", "lcl_export_points", narrow);
    CHECK(files_in(folder).size() == 2);  // of the same program
}

TEST_CASE("a second context takes the program from the cache on disk", "[device][program][cache]") {
    const TemporaryFolder folder;
    CHECK(imported(context_with_cache(folder.path()), wide) == wide_rows);
    const std::vector<std::string> files = files_in(folder);
    REQUIRE(files.size() == 1);
    const auto written = std::filesystem::last_write_time(files[0]);
    const std::string content = io_test::file_bytes(files[0]);
    CHECK(imported(context_with_cache(folder.path()), wide) == wide_rows);
    CHECK(files_in(folder) == files);
    CHECK(io_test::file_bytes(files[0]) == content);
    CHECK(std::filesystem::last_write_time(files[0]) == written);
    CHECK(contains(parse_entry(files[0]).key, lcl::choose_device().name));
}

TEST_CASE("it is the cached binary that runs, not a program built again", "[device][program][cache]") {
    // Under the key of the narrow program lies the wide one: if that is what runs, it came from the file.
    const TemporaryFolder narrow_folder, wide_folder;
    CHECK(imported(context_with_cache(narrow_folder.path()), narrow) == narrow_rows);
    CHECK(imported(context_with_cache(wide_folder.path()), wide) == wide_rows);
    const std::string key = parse_entry(files_in(narrow_folder).at(0)).key;
    BinaryCache(narrow_folder.path()).store(key, parse_entry(files_in(wide_folder).at(0)).binary);
    CHECK(imported(context_with_cache(narrow_folder.path()), narrow) == wide_rows);
}

TEST_CASE("a cache file that is damaged or that the driver refuses is built from source and replaced", "[device][program][cache]") {
    const TemporaryFolder folder;
    const BinaryCache cache(folder.path());
    CHECK(imported(context_with_cache(folder.path()), wide) == wide_rows);
    const std::string file = files_in(folder).at(0);
    const Entry good = parse_entry(file);

    SECTION("cut short") { std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2); }
    SECTION("empty") { std::filesystem::resize_file(file, 0); }
    SECTION("not a binary of any driver") { cache.store(good.key, "not a binary"); }
    CHECK(imported(context_with_cache(folder.path()), wide) == wide_rows);
    const auto replaced = cache.load(good.key);
    REQUIRE(replaced);
    CHECK(*replaced != "not a binary");
    CHECK(imported(context_with_cache(folder.path()), wide) == wide_rows);
    CHECK(files_in(folder).size() == 1);
}

TEST_CASE("programs are built where the cache folder cannot be written", "[device][program][cache]") {
    const TemporaryFolder folder;
    io_test::write_bytes(folder.file("file"), "in the way");
    CHECK(imported(context_with_cache(folder.file("file/cache")), narrow) == narrow_rows);
    CHECK(io_test::file_bytes(folder.file("file")) == "in the way");
}
