// SPDX-License-Identifier: BSD-3-Clause
// Files that appear complete or not at all, and standard output.
#pragma once

#include <string>

#include "host/io/format.h"

namespace lcl {

/// Writes a temporary file in the folder of `path`; commit() renames it to `path`, else the destructor removes it. A file that is replaced leaves its
/// permissions; a symbolic link stays and what it points at is replaced. Devices and pipes cannot be replaced: they are written to directly. Throws WriteError.
class AtomicFile : public ByteSink {
public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile() override;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    void write(const char* bytes, std::size_t size) override;
    void commit();

private:
    void create_temporary(const std::string& folder);
    [[noreturn]] void fail(int code) const;

    std::string path_;       // as the caller gave it, for messages
    std::string target_;     // symbolic links resolved
    std::string temporary_;  // empty: written directly, or already renamed
    int descriptor_ = -1;
};

/// Standard output, without a buffer of its own.
struct StandardOutput : ByteSink {
    void write(const char* bytes, std::size_t size) override;
};

}  // namespace lcl
