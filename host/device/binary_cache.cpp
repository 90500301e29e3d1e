// SPDX-License-Identifier: BSD-3-Clause
#include "host/device/binary_cache.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace lcl {

namespace {

constexpr std::string_view magic = "limitcl program binary 2\n";

/// FNV-1a with words of 64 bits in place of bytes, of which binaries have millions; two starting values give two hashes that differ enough for file names.
std::uint64_t hash(std::string_view text, std::uint64_t state) {
    for (std::size_t at = 0; at < text.size(); at += sizeof state) {
        std::uint64_t word = 0;
        std::memcpy(&word, text.data() + at, std::min(sizeof word, text.size() - at));
        state = (state ^ word) * 0x100000001b3u;
        state ^= state >> 32;
    }
    return state;
}

std::string hexadecimal(std::uint64_t value) {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value));
    return digits;
}

std::string fingerprint(std::string_view text) { return hexadecimal(hash(text, 0xcbf29ce484222325u)) + hexadecimal(hash(text, 0x9ae16a3b2f90404fu)); }

std::string environment(const char* name) {
    const char* const value = std::getenv(name);
    return value ? value : "";
}

/// What the file of `key` begins with; the binary follows.
std::string header(const std::string& key, std::string_view binary) {
    return std::string(magic) + std::to_string(key.size()) + " " + std::to_string(binary.size()) + " " + fingerprint(binary) + "\n" + key;
}

/// A name beside `path` that no other thread or process writes to.
std::string temporary_path(const std::string& path) {
    static std::atomic<unsigned> serial{0};
    return path + "." + std::to_string(getpid()) + "." + std::to_string(serial++) + ".tmp";
}

bool read_file(const std::string& path, std::string& content) {
    std::error_code failed;
    if (std::filesystem::is_directory(path, failed)) return false;
    std::ifstream file(path, std::ios::binary | std::ios::ate);  // the size is that of the file that is open: another may take its name at any time
    const std::streamoff size = file.tellg();
    if (!file || size < 0) return false;
    content.resize(static_cast<std::size_t>(size));
    file.seekg(0);
    return file.read(content.data(), size).good();
}

bool write_file(const std::string& path, const std::string& head, const std::string& body) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(head.data(), static_cast<std::streamsize>(head.size()));
    file.write(body.data(), static_cast<std::streamsize>(body.size()));
    file.close();
    return file.good();
}

}  // namespace

std::string cache_directory(const std::string& asked) {
    if (!asked.empty()) return asked;
    const std::string own = environment("LIMITCL_CACHE_DIR");
    if (!own.empty()) return own;
    const std::string user = environment("XDG_CACHE_HOME");
    if (!user.empty() && user.front() == '/') return user + "/limitcl";  // the XDG specification: a relative path counts as not set
    const std::string home = environment("HOME");
    return home.empty() ? "" : home + "/.cache/limitcl";
}

std::string BinaryCache::path(const std::string& key) const { return directory_ + "/" + fingerprint(key) + ".bin"; }

std::optional<std::string> BinaryCache::load(const std::string& key) const {
    if (directory_.empty()) return std::nullopt;
    std::string content;
    if (!read_file(path(key), content)) return std::nullopt;
    // The header of the true binary is known but for the binary itself, which is whatever follows the key.
    const std::size_t head_end = content.find('\n', magic.size());
    if (head_end == std::string::npos || content.size() < head_end + 1 + key.size()) return std::nullopt;
    const std::size_t head_size = head_end + 1 + key.size();
    const std::string_view binary = std::string_view(content).substr(head_size);
    if (binary.empty() || content.compare(0, head_size, header(key, binary)) != 0) return std::nullopt;
    content.erase(0, head_size);
    return content;
}

void BinaryCache::store(const std::string& key, const std::string& binary) const {
    if (directory_.empty()) return;
    std::error_code ignored;
    std::filesystem::create_directories(directory_, ignored);
    const std::string target = path(key), temporary = temporary_path(target);
    bool done = write_file(temporary, header(key, binary), binary);
    if (done) {
        std::error_code failed;
        std::filesystem::rename(temporary, target, failed);
        done = !failed;
    }
    if (!done) std::filesystem::remove(temporary, ignored);
}

}  // namespace lcl
