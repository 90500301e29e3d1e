// SPDX-License-Identifier: BSD-3-Clause
// The C boundary: exceptions become statuses here and nowhere else; options structs of older and newer callers are read and written by their own size.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "host/error.h"
#include "limitcl/limitcl.h"

namespace lcl {

/// What lcl_last_error() and its companions give on this thread.
struct LastError {
    std::string message;
    Where where;
};
LastError& last_error();

/// The status of the exception that is being handled, which becomes the thread's last error.
lcl_status current_failure() noexcept;

/// Runs body; no exception leaves it.
template <class Body>
lcl_status guarded(const Body& body) noexcept {
    try {
        return body();
    } catch (...) {
        return current_failure();
    }
}

/// Fails unless the pointer is there: "mesh is NULL".
template <class T>
T* required(T* pointer, const char* name) {
    if (pointer == nullptr) throw InvalidArgument(std::string(name) + " is NULL");
    return pointer;
}

/// The caller's options over the defaults; fields that the caller's header did not have keep theirs.
template <class Options>
Options options_or(const Options* given, const Options& defaults, const char* name) {
    if (given == nullptr) return defaults;
    if (given->struct_size < 2 * sizeof(uint32_t)) throw InvalidArgument(std::string(name) + ".struct_size is not set: start from its _INIT value");
    Options options = defaults;
    std::memcpy(static_cast<void*>(&options), given, std::min<std::size_t>(given->struct_size, sizeof options));
    return options;
}

/// Fills a caller's struct as far as its header knew it.
template <class Result>
void give(Result* out, Result value, const char* name) {
    if (required(out, name)->struct_size < 2 * sizeof(uint32_t))
        throw InvalidArgument(std::string(name) + ".struct_size is not set: start from its _INIT value");
    value.struct_size = out->struct_size;
    std::memcpy(static_cast<void*>(out), &value, std::min<std::size_t>(out->struct_size, sizeof value));
}

/// Copies text into a char array of a struct, cut to fit.
template <std::size_t size>
void copy_text(char (&to)[size], const std::string& text) {
    const std::size_t count = std::min(text.size(), size - 1);
    std::memcpy(to, text.data(), count);
    to[count] = '\0';
}

/// Copies the first ten indices; returns their number.
inline int32_t copy_first(int32_t (&to)[10], const std::vector<Index>& indices) {
    const std::size_t count = std::min<std::size_t>(10, indices.size());
    std::copy_n(indices.begin(), count, to);
    return static_cast<int32_t>(count);
}

}  // namespace lcl
