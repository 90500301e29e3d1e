// SPDX-License-Identifier: BSD-3-Clause
// Whole files into memory.
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

/// Reads a file, or standard input for "-". FileError if it cannot be opened or read, or is a directory.
OwnedBytes read_whole_file(const std::string& path);

}  // namespace lcl
