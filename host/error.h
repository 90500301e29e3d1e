// SPDX-License-Identifier: BSD-3-Clause
// Exceptions of the host library. They stop at the C boundary (host/capi/guard.h), which turns each into its status.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lcl {

using Index = std::int32_t;  // vertices, faces, edges and half-edges: at most 2^31 - 1 of anything

/// Zero-based vertices and faces that a message speaks of (the first ten).
struct Where {
    std::vector<Index> vertices;
    std::vector<Index> faces;
};

/// Base of all: `what()` is one sentence that says what was found, where, and what to do.
struct Error : std::runtime_error {
    explicit Error(const std::string& message, Where where_ = {}) : std::runtime_error(message), where(std::move(where_)) {}
    Where where;
};

struct InvalidArgument : Error {
    using Error::Error;
};  ///< an option or a call is wrong (exit 2)
struct BadInput : Error {
    using Error::Error;
};  ///< a mesh or a file's content is wrong (exit 3)
struct Unsupported : Error {
    using Error::Error;
};  ///< right, but not offered (here)
struct FileError : Error {
    using Error::Error;
};  ///< cannot be opened or read (exit 3)
struct WriteError : Error {
    using Error::Error;
};  ///< cannot be written (exit 1)
struct NoDevice : Error {
    using Error::Error;
};  ///< no such OpenCL device (exit 5)
struct OutOfMemory : Error {
    using Error::Error;
};  ///< too large for the device or the memory, with the numbers (exit 5)
struct Cancelled : Error {
    using Error::Error;
};  ///< the progress callback asked to stop (exit 130)

/// An OpenCL call failed: `what()` holds OpenCL's own name for the code, what was being done, and the build log if there is one.
struct DeviceError : Error {
    DeviceError(int code_, const std::string& message) : Error(message), code(code_) {}
    int code;  ///< CL_* value, below zero
};

}  // namespace lcl
