// SPDX-License-Identifier: BSD-3-Clause
// Files that are read.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace lcl {

/// Bytes that were not cleared before they were filled.
struct OwnedBytes {
    std::unique_ptr<char[]> data;
    std::size_t size = 0;
};

/// An open file, or standard input for "-", which stays open. FileError if it cannot be opened or read, or is a directory.
class InputFile {
public:
    explicit InputFile(const std::string& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    int descriptor() const { return descriptor_; }
    /// Bytes of a plain file, which can be read from any place; 0 for all else.
    std::size_t size() const { return size_; }
    OwnedBytes read_all() const;

private:
    bool read_pieces(char* bytes) const;

    std::string path_;
    void close();
    int descriptor_;
    std::size_t size_ = 0;
};

}  // namespace lcl
