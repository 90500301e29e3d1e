// SPDX-License-Identifier: BSD-3-Clause
// The content of a file, packed or not, given to a reader.
#pragma once

#include <new>
#include <stdexcept>
#include <string>

#include "host/io/gzip.h"
#include "host/io/input_file.h"

namespace lcl {

/// What stands for a path in messages.
inline std::string shown_name(const std::string& path) { return path == "-" ? "standard input" : path; }

/// read(), with memory that cannot be had told in words.
template <class Read>
auto within_memory(const Read& read, std::size_t size, const std::string& name) try {
    return read();
} catch (const std::bad_alloc&) {
    throw OutOfMemory("there is not enough memory to read " + name + " (" + std::to_string(size) + " bytes)");
} catch (const std::length_error&) {
    throw OutOfMemory("there is not enough memory to read " + name + " (" + std::to_string(size) + " bytes)");
}

/// read(bytes, size) of bytes as they are, or unpacked.
template <class Read>
auto read_unpacked(const char* bytes, std::size_t size, const std::string& name, const Read& read) {
    const auto unpack_and_read = [&] {
        if (!is_gzip(bytes, size)) return read(bytes, size);
        const OwnedBytes unpacked = unpack_gzip(bytes, size, name);
        return read(static_cast<const char*>(unpacked.data.get()), unpacked.size);
    };
    return within_memory(unpack_and_read, size, name);
}

/// The same of a whole file. BadInput if only its name says that it is packed.
template <class Read>
auto read_unpacked(const InputFile& file, bool ends_in_gz, const std::string& name, const Read& read) {
    const OwnedBytes bytes = file.read_all();
    if (ends_in_gz && bytes.size > 0 && !is_gzip(bytes.data.get(), bytes.size))
        throw BadInput(name + " is no gzip file; drop .gz from its name if it is not packed");
    return read_unpacked(bytes.data.get(), bytes.size, name, read);
}

}  // namespace lcl
