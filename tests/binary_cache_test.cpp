// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "host/device/binary_cache.h"
#include "tests/device_support.h"
#include "tests/io_support.h"

using device_test::Environment;
using io_test::TemporaryFolder;
using lcl::BinaryCache;
using lcl::cache_directory;

namespace {

const std::string key = "a device\na driver 3.1\n-D LCL_WIDTH=4\n__kernel void f() {}\n";
const std::string binary = std::string("\0\1\2\xff", 4) + "the rest\n";

std::size_t file_count(const TemporaryFolder& folder) {
    std::filesystem::recursive_directory_iterator all(folder.path());
    return static_cast<std::size_t>(std::count_if(begin(all), end(all), [](const auto& entry) { return entry.is_regular_file(); }));
}

}  // namespace

TEST_CASE("a stored binary is found again, byte for byte, by its key alone", "[device][cache]") {
    const TemporaryFolder folder;
    const BinaryCache cache(folder.file("not/yet/there"));
    CHECK_FALSE(cache.load(key));
    cache.store(key, binary);
    CHECK(cache.load(key) == binary);
    CHECK(BinaryCache(folder.file("not/yet/there")).load(key) == binary);
    CHECK_FALSE(cache.load(key + " "));
    CHECK_FALSE(cache.load(key.substr(1)));
    CHECK_FALSE(cache.load(""));
    CHECK(file_count(folder) == 1);
}

TEST_CASE("storing again replaces the binary", "[device][cache]") {
    const TemporaryFolder folder;
    const BinaryCache cache(folder.path());
    cache.store(key, binary);
    cache.store(key, "shorter");
    CHECK(cache.load(key) == std::string("shorter"));
    CHECK(file_count(folder) == 1);
}

TEST_CASE("a damaged cache file is not taken for the binary", "[device][cache]") {
    const TemporaryFolder folder;
    const BinaryCache cache(folder.path());
    cache.store(key, binary);
    const std::string whole = io_test::file_bytes(cache.path(key));

    SECTION("cut anywhere") {
        for (std::size_t size = 0; size < whole.size(); ++size) {
            io_test::write_bytes(cache.path(key), whole.substr(0, size));
            INFO("the first " << size << " bytes of " << whole.size());
            CHECK_FALSE(cache.load(key));
        }
    }
    SECTION("one byte changed anywhere") {
        for (std::size_t place = 0; place < whole.size(); ++place) {
            std::string changed = whole;
            changed[place] = static_cast<char>(changed[place] ^ 1);
            io_test::write_bytes(cache.path(key), changed);
            INFO("byte " << place);
            CHECK_FALSE(cache.load(key));
        }
    }
    SECTION("bytes added") {
        io_test::write_bytes(cache.path(key), whole + "x");
        CHECK_FALSE(cache.load(key));
    }
    SECTION("another key's file under this name, as after a collision of hashes") {
        cache.store(key + "2", binary);
        std::filesystem::rename(cache.path(key + "2"), cache.path(key));
        CHECK_FALSE(cache.load(key));
    }
    cache.store(key, binary);
    CHECK(cache.load(key) == binary);
}

TEST_CASE("a folder that cannot be written is no error, and nothing is found in it", "[device][cache]") {
    const TemporaryFolder folder;
    io_test::write_bytes(folder.file("file"), "in the way");
    const BinaryCache below_a_file(folder.file("file/cache"));
    below_a_file.store(key, binary);
    CHECK_FALSE(below_a_file.load(key));
    CHECK(io_test::file_bytes(folder.file("file")) == "in the way");

    const BinaryCache nowhere("");
    nowhere.store(key, binary);
    CHECK_FALSE(nowhere.load(key));
}

TEST_CASE("what stands where the file should go is left alone, and no temporary file stays", "[device][cache]") {
    const TemporaryFolder folder;
    const BinaryCache cache(folder.path());
    std::filesystem::create_directories(cache.path(key) + "/taken");
    cache.store(key, binary);
    CHECK_FALSE(cache.load(key));
    CHECK(std::filesystem::is_directory(cache.path(key) + "/taken"));
    CHECK(file_count(folder) == 0);
}

TEST_CASE("writers at the same time leave one whole file, and readers never see a part", "[device][cache][thread]") {
    const TemporaryFolder folder;
    const auto version = [](int writer) { return std::string(20000 + 5000 * static_cast<std::size_t>(writer), static_cast<char>('a' + writer)); };
    std::atomic<int> wrong{0}, seen{0};
    std::vector<std::thread> threads;
    BinaryCache(folder.path()).store(key, version(0));
    for (int writer = 0; writer < 4; ++writer) {
        threads.emplace_back([&, writer] {
            const BinaryCache cache(folder.path());
            for (int i = 0; i < 20; ++i) {
                cache.store(key, version(writer));
                const auto found = cache.load(key);
                ++(found && *found == version(found->front() - 'a') ? seen : wrong);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(wrong == 0);
    CHECK(seen == 80);
    CHECK(file_count(folder) == 1);
}

TEST_CASE("the cache folder is the one asked for, LIMITCL_CACHE_DIR, XDG_CACHE_HOME/limitcl, HOME/.cache/limitcl, or none", "[device][cache]") {
    const Environment own("LIMITCL_CACHE_DIR", "/own"), user("XDG_CACHE_HOME", "/user"), home("HOME", "/home/me");
    CHECK(cache_directory("/asked") == "/asked");
    CHECK(cache_directory("") == "/own");
    const Environment no_own("LIMITCL_CACHE_DIR", "");
    CHECK(cache_directory("") == "/user/limitcl");
    const Environment relative("XDG_CACHE_HOME", "user");
    CHECK(cache_directory("") == "/home/me/.cache/limitcl");
    const Environment no_user("XDG_CACHE_HOME", nullptr);
    CHECK(cache_directory("") == "/home/me/.cache/limitcl");
    const Environment no_home("HOME", nullptr);
    CHECK(cache_directory("").empty());
}
