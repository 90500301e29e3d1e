// SPDX-License-Identifier: BSD-3-Clause
// Uniform refinement.
#ifndef LIMITCL_REFINE_HPP
#define LIMITCL_REFINE_HPP

#include "scheme.hpp"

namespace limitcl {

/// Where the vertices of a refined mesh lie on the surface of the mesh that it was made from.
struct Locations {
    std::vector<std::int32_t> faces;    ///< vertex_count; -1: isolated vertex
    std::vector<std::int32_t> corners;  ///< vertex_count: corner of the face; 0 where the face has one parameter domain
    std::vector<double> uv;             ///< vertex_count x 2
};

/// Refines `levels` times (0: a copy with locations), in double on the host. alpha and lambda of `scheme` rule the first refinement alone: read the
/// result with both 0. It carries refined creases and corners; colours and scalar properties are refined like points.
/// Errors: LCL_ERROR_BAD_INPUT, LCL_ERROR_MEMORY.
inline Mesh refine(const Mesh& mesh, int levels = 1, const SchemeOptions& scheme = {}) {
    if (levels < 0) throw Error(LCL_ERROR_INVALID_ARGUMENT, "levels is " + std::to_string(levels) + "; give 0 or more");
    const lcl_scheme_options c = scheme.to_c();
    lcl_refine_options options = LCL_REFINE_OPTIONS_INIT;
    options.levels = levels == 0 ? -1 : levels;
    lcl_mesh refined = nullptr;
    check(lcl_mesh_refine(mesh.get(), &c, &options, &refined));
    return Mesh(MeshHandle(refined));
}

/// Places of a refined mesh's vertices. Error LCL_ERROR_INVALID_ARGUMENT for a mesh that refine did not make.
inline Locations locations(const Mesh& refined) {
    const std::size_t n = static_cast<std::size_t>(refined.vertex_count());
    Locations result{std::vector<std::int32_t>(n), std::vector<std::int32_t>(n), std::vector<double>(2 * n)};
    check(lcl_mesh_get_locations(refined.get(), result.faces.data(), result.corners.data(), result.uv.data()));
    return result;
}

}  // namespace limitcl

#endif
