// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lcl {
namespace {

std::string reason(int code) { return std::generic_category().message(code); }

/// The file behind symbolic links; the path itself where there is none yet.
std::string resolve_links(const std::string& path) {
    const std::unique_ptr<char, decltype(&std::free)> resolved(::realpath(path.c_str(), nullptr), &std::free);
    return resolved ? resolved.get() : path;
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
}

/// Writes all; 0 or the error code.
int write_all(int descriptor, const char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t count = ::write(descriptor, bytes, size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno;
        bytes += count;
        size -= static_cast<std::size_t>(count);
    }
    return 0;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(resolve_links(path)) {
    struct stat status;
    const bool exists = ::stat(target_.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) throw WriteError("cannot write " + path_ + ": it is a directory; name a file in it");
    if (exists && ::access(target_.c_str(), W_OK) != 0) fail(errno);
    if (exists && !S_ISREG(status.st_mode)) {
        descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor_ < 0) fail(errno);
        return;
    }
    create_temporary(folder_of(target_));
    if (exists) ::fchmod(descriptor_, status.st_mode & 07777);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::create_temporary(const std::string& folder) {
    static std::atomic<unsigned> number{0};
    do {
        // Not mkstemp: it fixes the mode at 0600, where a new file should have what the umask leaves.
        temporary_ = folder + ".limitcl-" + std::to_string(::getpid()) + "-" + std::to_string(number++) + ".tmp";
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ >= 0) return;
    const int code = errno;
    temporary_.clear();
    throw WriteError("cannot write " + path_ + ": no file can be made in " + (folder.empty() ? "this folder" : folder) + " (" + reason(code) + ")");
}

void AtomicFile::write(const char* bytes, std::size_t size) {
    const int code = write_all(descriptor_, bytes, size);
    if (code != 0) fail(code);
}

void AtomicFile::commit() {
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) fail(errno);
    if (temporary_.empty()) return;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
    temporary_.clear();
}

void AtomicFile::fail(int code) const { throw WriteError("cannot write " + path_ + ": " + reason(code)); }

void StandardOutput::write(const char* bytes, std::size_t size) {
    const int code = write_all(STDOUT_FILENO, bytes, size);
    if (code != 0) throw WriteError("cannot write standard output: " + reason(code));
}

}  // namespace lcl
