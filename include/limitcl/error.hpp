// SPDX-License-Identifier: BSD-3-Clause
// Errors of the C++ API. Every function of the API that fails throws limitcl::Error; bad input of the C library never turns into silence.
#ifndef LIMITCL_ERROR_HPP
#define LIMITCL_ERROR_HPP

#include "limitcl.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace limitcl {

/// A failure: the sentence (what, where, what to do), the status of the C API and the vertices and faces it speaks of.
class Error : public std::runtime_error {
public:
    Error(lcl_status status, const std::string& sentence, std::vector<std::int32_t> vertices = {}, std::vector<std::int32_t> faces = {})
        : std::runtime_error(sentence), status_(status), vertices_(std::move(vertices)), faces_(std::move(faces)) {}

    /// The last failure of this thread, as the C API remembers it.
    static Error last(lcl_status status);

    /// LCL_ERROR_*, or an OpenCL error (-1 to -99).
    lcl_status status() const { return status_; }
    /// "LCL_ERROR_BAD_INPUT", "CL_OUT_OF_RESOURCES".
    const char* status_name() const { return lcl_status_string(status_); }
    /// Up to ten vertices, zero-based.
    const std::vector<std::int32_t>& vertices() const { return vertices_; }
    /// Up to ten faces, zero-based.
    const std::vector<std::int32_t>& faces() const { return faces_; }

private:
    lcl_status status_;
    std::vector<std::int32_t> vertices_, faces_;
};

inline Error Error::last(lcl_status status) {
    const char* sentence = lcl_last_error();
    std::vector<std::int32_t> vertices(lcl_last_error_vertices(nullptr, 0)), faces(lcl_last_error_faces(nullptr, 0));
    lcl_last_error_vertices(vertices.data(), vertices.size());
    lcl_last_error_faces(faces.data(), faces.size());
    return Error(status, *sentence ? sentence : lcl_status_string(status), std::move(vertices), std::move(faces));
}

/// Throws Error unless `status` is LCL_OK. For code that mixes both APIs.
inline void check(lcl_status status) {
    if (status != LCL_OK) throw Error::last(status);
}

/// Version of the library that runs, for example "0.1.0".
inline std::string version() { return lcl_version_string(); }

}  // namespace limitcl

#endif
