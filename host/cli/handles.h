// SPDX-License-Identifier: BSD-3-Clause
// Owners of the library's handles.
#pragma once

#include <memory>

#include <limitcl/limitcl.h>

namespace lcl::cli {

struct Release {
    void operator()(lcl_context context) const { lcl_context_release(context); }
    void operator()(lcl_mesh mesh) const { lcl_mesh_release(mesh); }
    void operator()(lcl_operator A) const { lcl_operator_release(A); }
    void operator()(lcl_limit_surface surface) const { lcl_limit_surface_release(surface); }
    void operator()(lcl_cloud cloud) const { lcl_cloud_release(cloud); }
};

using Context = std::unique_ptr<lcl_context_s, Release>;
using Mesh = std::unique_ptr<lcl_mesh_s, Release>;
using Operator = std::unique_ptr<lcl_operator_s, Release>;
using LimitSurface = std::unique_ptr<lcl_limit_surface_s, Release>;
using Cloud = std::unique_ptr<lcl_cloud_s, Release>;

}  // namespace lcl::cli
