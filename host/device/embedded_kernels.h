// SPDX-License-Identifier: BSD-3-Clause
// The texts of kernels/, put into the library at build time by cmake/EmbedKernels.cmake.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lcl {

struct EmbeddedKernel {
    std::string_view name;  ///< "relax.cl", "types.cl.h"
    std::string_view text;
};

/// All embedded files, in the order of the build's list.
struct EmbeddedKernels {
    const EmbeddedKernel* files;
    std::size_t count;
    const EmbeddedKernel* begin() const { return files; }
    const EmbeddedKernel* end() const { return files + count; }
};
EmbeddedKernels embedded_kernels();

/// The whole source of kernels/`file`.cl: lines `#include "x.cl.h"` replaced by that file's text (once each), `#line` directives so that a build log names
/// kernels/... and the true line. InvalidArgument if `file` or an included file is not embedded.
std::string kernel_source(const std::string& file);

}  // namespace lcl
