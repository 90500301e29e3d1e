// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/input_file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/error.h"
#include "host/parallel.h"

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
    if (descriptor_ < 0) fail(path, errno);
    const int code = ::fstat(descriptor_, &status) == 0 ? 0 : errno;
    if (code != 0 || S_ISDIR(status.st_mode)) {
        close();
        if (code != 0) fail(path, code);
        throw FileError(path + " is a directory; name a file in it");
    }
    if (S_ISREG(status.st_mode) && path != "-") size_ = static_cast<std::size_t>(status.st_size);
}

InputFile::~InputFile() { close(); }

void InputFile::close() {
    if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
}

/// Pieces of a plain file by all cores: memory that is new to the process takes longer than the copying. False if the file has become shorter.
bool InputFile::read_pieces(char* bytes) const {
    std::atomic<bool> is_whole{true};
    parallel_for(
        size_,
        [&](std::size_t first, std::size_t last) {
            while (first < last && is_whole) {
                const ssize_t count = ::pread(descriptor_, bytes + first, last - first, static_cast<off_t>(first));
                if (count < 0 && errno == EINTR) continue;
                if (count < 0) fail(path_, errno);
                if (count == 0) is_whole = false;
                first += static_cast<std::size_t>(count);
            }
        },
        std::size_t(1) << 20);
    return is_whole;
}

OwnedBytes InputFile::read_all() const {
    // One byte more than the file has: the read that finds its end then needs no larger buffer. Pipes say 0.
    std::size_t capacity = std::max<std::size_t>(size_ + 1, 65536);
    OwnedBytes bytes;
    grow(bytes, capacity);
    // What was appended since the file was opened is read behind it; one that has become shorter is read again.
    if (size_ > 0 && read_pieces(bytes.data.get()) && ::lseek(descriptor_, static_cast<off_t>(size_), SEEK_SET) >= 0) bytes.size = size_;
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
