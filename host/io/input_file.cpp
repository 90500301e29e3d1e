// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/error.h"

namespace lcl {
namespace {

[[noreturn]] void fail(const std::string& path, int code) {
    throw FileError("cannot read " + (path == "-" ? "standard input" : path) + ": " + std::generic_category().message(code));
}

void grow(OwnedBytes& bytes, std::size_t capacity) {
    std::unique_ptr<char[]> larger(new char[capacity]);
    if (bytes.size > 0) std::memcpy(larger.get(), bytes.data.get(), bytes.size);
    bytes.data = std::move(larger);
}

}  // namespace

InputFile::InputFile(const std::string& path) : path_(path), descriptor_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat status;
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) fail(path, errno);
    if (S_ISDIR(status.st_mode)) throw FileError(path + " is a directory; name a mesh file in it");
    if (S_ISREG(status.st_mode) && path != "-") size_ = static_cast<std::size_t>(status.st_size);
}

InputFile::~InputFile() {
    if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
}

OwnedBytes InputFile::read_all() const {
    // One byte more than the file has: the read that finds its end then needs no larger buffer. Pipes say 0.
    std::size_t capacity = std::max<std::size_t>(size_ + 1, 65536);
    OwnedBytes bytes;
    grow(bytes, capacity);
    for (;;) {
        if (bytes.size == capacity) grow(bytes, capacity *= 2);
        const ssize_t count = ::read(descriptor_, bytes.data.get() + bytes.size, capacity - bytes.size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(path_, errno);
        if (count == 0) return bytes;
        bytes.size += static_cast<std::size_t>(count);
    }
}

}  // namespace lcl
