// SPDX-License-Identifier: BSD-3-Clause
// Subdivision schemes and their parameters.
#ifndef LIMITCL_SCHEME_HPP
#define LIMITCL_SCHEME_HPP

#include "mesh.hpp"

namespace limitcl {

enum class Scheme {
    by_faces = LCL_SCHEME_DEFAULT,  ///< Loop if all faces are triangles, else Catmull-Clark
    catmull_clark = LCL_SCHEME_CATMULL_CLARK,
    loop = LCL_SCHEME_LOOP,
    doo_sabin = LCL_SCHEME_DOO_SABIN
};

enum class Mask {
    catmull = LCL_MASK_CATMULL,  ///< Doo-Sabin paper, chapter 4
    classic = LCL_MASK_CLASSIC   ///< Doo & Sabin 1978
};

/// A scheme with its parameters, and which vertices get rows.
struct SchemeOptions {
    SchemeOptions() = default;
    SchemeOptions(Scheme which) : scheme(which) {}

    Scheme scheme = Scheme::by_faces;
    Mask mask = Mask::catmull;              ///< Doo-Sabin
    double alpha = 0;                       ///< Catmull-Clark, 0 to 1: rule of the first refinement (mesh expansion paper)
    bool alpha_auto = false;                ///< alpha is 0, or 0.5 where 0 is singular, indefinite or close to it
    double lambda = 0;                      ///< Catmull-Clark, 0 to 1: blend ratio, A_lambda = lambda E + (1 - lambda) A (two-phase paper, eq. 5)
    std::vector<double> lambda_per_vertex;  ///< empty, or one ratio a vertex, which rules over lambda
    std::vector<std::int32_t> subset;       ///< empty: all; else the vertices to interpolate, the others keep their control points
    std::vector<std::int32_t> owned;        ///< empty: all; else the vertices that get rows, the others are ghosts

    /// The struct of the C API. It points into this object: use it before this object changes or goes.
    lcl_scheme_options to_c() const;
    static SchemeOptions from_c(const lcl_scheme_options& options);
};

/// Whether a scheme fits a mesh.
struct Suitability {
    bool suitable = false;               ///< the scheme can be used
    bool singular = false;               ///< its limit operator has no inverse: interpolation is not possible with these parameters
    std::string reason;                  ///< why not suitable, or why singular and the cure; "" otherwise
    std::vector<std::int32_t> vertices;  ///< where, at most ten
};

inline lcl_scheme_options SchemeOptions::to_c() const {
    lcl_scheme_options c = LCL_SCHEME_OPTIONS_INIT;
    c.scheme = static_cast<lcl_scheme>(scheme);
    c.mask = static_cast<lcl_mask>(mask);
    c.alpha = alpha;
    c.alpha_auto = alpha_auto;
    c.lambda = lambda;
    c.lambda_per_vertex = lambda_per_vertex.empty() ? nullptr : lambda_per_vertex.data();
    c.subset = subset.empty() ? nullptr : subset.data();
    c.subset_count = subset.size();
    c.owned = owned.empty() ? nullptr : owned.data();
    c.owned_count = owned.size();
    return c;
}

inline SchemeOptions SchemeOptions::from_c(const lcl_scheme_options& c) {
    SchemeOptions options(static_cast<Scheme>(c.scheme));
    options.mask = static_cast<Mask>(c.mask);
    options.alpha = c.alpha;
    options.alpha_auto = c.alpha_auto != 0;
    options.lambda = c.lambda;
    return options;
}

namespace detail {

inline void require_ratios(const SchemeOptions& options, const Mesh& mesh) {
    if (!options.lambda_per_vertex.empty() && options.lambda_per_vertex.size() != static_cast<std::size_t>(mesh.vertex_count()))
        throw Error(LCL_ERROR_INVALID_ARGUMENT, "lambda_per_vertex has " + std::to_string(options.lambda_per_vertex.size()) + " values, the mesh has " +
                                                    std::to_string(mesh.vertex_count()) + " vertices");
}

}  // namespace detail

/// Tests a scheme on a mesh in linear time, without a device. Error LCL_ERROR_INVALID_ARGUMENT for options out of range.
inline Suitability check_scheme(const Mesh& mesh, const SchemeOptions& options = {}) {
    detail::require_ratios(options, mesh);
    const lcl_scheme_options c = options.to_c();
    lcl_suitability suitability = LCL_SUITABILITY_INIT;
    check(lcl_mesh_check_scheme(mesh.get(), &c, &suitability));
    return {suitability.suitable != 0, suitability.singular != 0, suitability.reason, {suitability.vertices, suitability.vertices + suitability.vertex_count}};
}

}  // namespace limitcl

#endif
