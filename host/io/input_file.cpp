// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/input_file.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/error.h"

namespace lcl {
namespace {

/// Closes what it opened; standard input stays open.
struct InputDescriptor {
    explicit InputDescriptor(const std::string& path) : number(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
    ~InputDescriptor() {
        if (number > STDIN_FILENO) ::close(number);
    }
    InputDescriptor(const InputDescriptor&) = delete;
    InputDescriptor& operator=(const InputDescriptor&) = delete;
    int number;
};

[[noreturn]] void fail(const std::string& path, int code) {
    throw FileError("cannot read " + (path == "-" ? "standard input" : path) + ": " + std::generic_category().message(code));
}

void grow(OwnedBytes& bytes, std::size_t capacity) {
    std::unique_ptr<char[]> larger(new char[capacity]);
    if (bytes.size > 0) std::memcpy(larger.get(), bytes.data.get(), bytes.size);
    bytes.data = std::move(larger);
}

}  // namespace

OwnedBytes read_whole_file(const std::string& path) {
    const InputDescriptor descriptor(path);
    struct stat status;
    if (descriptor.number < 0 || ::fstat(descriptor.number, &status) != 0) fail(path, errno);
    if (S_ISDIR(status.st_mode)) throw FileError(path + " is a directory; name a mesh file in it");
    // One byte more than the file has: the read that finds its end then needs no larger buffer. Pipes say 0.
    std::size_t capacity = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : 0;
    capacity = capacity > 65536 ? capacity : 65536;
    OwnedBytes bytes;
    grow(bytes, capacity);
    for (;;) {
        if (bytes.size == capacity) grow(bytes, capacity *= 2);
        const ssize_t count = ::read(descriptor.number, bytes.data.get() + bytes.size, capacity - bytes.size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(path, errno);
        if (count == 0) return bytes;
        bytes.size += static_cast<std::size_t>(count);
    }
}

}  // namespace lcl
