// SPDX-License-Identifier: BSD-3-Clause
// Uniform refinement.
#ifndef LIMITCL_REFINE_HPP
#define LIMITCL_REFINE_HPP

#include "limit_operator.hpp"

namespace limitcl {

/// Where the vertices of a refined mesh lie on the surface of the mesh that it was made from.
struct Locations {
    std::vector<std::int32_t> faces;    ///< vertex_count; -1: isolated vertex
    std::vector<std::int32_t> corners;  ///< vertex_count: corner of the face; 0 where the face has one parameter domain
    std::vector<double> uv;             ///< vertex_count x 2
};

namespace detail {

inline lcl_refine_options refine_options(int levels) {
    if (levels < 0) throw Error(LCL_ERROR_INVALID_ARGUMENT, "levels is " + std::to_string(levels) + "; give 0 or more");
    lcl_refine_options options = LCL_REFINE_OPTIONS_INIT;
    options.levels = levels == 0 ? -1 : levels;
    return options;
}

}  // namespace detail

/// Refines `levels` times (0: a copy with locations), in double on the host. alpha and lambda of `scheme` rule the first refinement alone: read the
/// result with both 0. It carries refined creases and corners; colours and scalar properties are refined like points.
/// Errors: LCL_ERROR_BAD_INPUT, LCL_ERROR_MEMORY.
inline Mesh refine(const Mesh& mesh, int levels = 1, const SchemeOptions& scheme = {}) {
    const lcl_refine_options options = detail::refine_options(levels);
    const lcl_scheme_options c = scheme.to_c();
    lcl_mesh refined = nullptr;
    check(lcl_mesh_refine(mesh.get(), &c, &options, &refined));
    return Mesh(MeshHandle(refined));
}

/// A refinement made once and applied often, to points of every frame and any channels, on a device. Copies share it.
class Refiner {
public:
    /// Options and errors as refine().
    Refiner(const Context& context, const Mesh& mesh, int levels = 1, const SchemeOptions& scheme = {}) : vertex_count_(mesh.vertex_count()) {
        const lcl_refine_options options = detail::refine_options(levels);
        const lcl_scheme_options c = scheme.to_c();
        lcl_refiner refiner = nullptr;
        check(lcl_refiner_create(context.get(), mesh.get(), &c, &options, &refiner));
        handle_ = RefinerHandle(refiner);
    }

    lcl_refiner get() const { return handle_.get(); }
    /// Of refined vertices.
    std::int32_t vertex_count() const { return lcl_refiner_vertex_count(get()); }
    /// What refine() gives, with the points and properties that the mesh has now.
    Mesh mesh() const {
        lcl_mesh refined = nullptr;
        check(lcl_refiner_get_mesh(get(), &refined));
        return Mesh(MeshHandle(refined));
    }
    /// Refined values, vertex_count() x channels, of values that are the mesh's vertex count x channels.
    std::vector<double> apply(ArrayView<double> values, int channels = 3, Precision precision = Precision::mixed) const {
        const std::size_t count = static_cast<std::size_t>(std::max(channels, 1));
        if (values.size() != count * static_cast<std::size_t>(vertex_count_))
            throw Error(LCL_ERROR_INVALID_ARGUMENT, std::to_string(values.size()) + " values were given, " + std::to_string(vertex_count_) + " vertices need " +
                                                        std::to_string(count * static_cast<std::size_t>(vertex_count_)));
        std::vector<double> out(count * static_cast<std::size_t>(vertex_count()));
        check(lcl_refiner_apply(get(), values.data(), 0, channels, static_cast<lcl_precision>(precision), out.data(), 0));
        return out;
    }

private:
    RefinerHandle handle_;
    std::int32_t vertex_count_;
};

/// Places of a refined mesh's vertices. Error LCL_ERROR_INVALID_ARGUMENT for a mesh that refine did not make.
inline Locations locations(const Mesh& refined) {
    const std::size_t n = static_cast<std::size_t>(refined.vertex_count());
    Locations result{std::vector<std::int32_t>(n), std::vector<std::int32_t>(n), std::vector<double>(2 * n)};
    check(lcl_mesh_get_locations(refined.get(), result.faces.data(), result.corners.data(), result.uv.data()));
    return result;
}

}  // namespace limitcl

#endif
