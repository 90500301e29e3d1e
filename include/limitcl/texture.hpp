// SPDX-License-Identifier: BSD-3-Clause
// Procedural textures by interpolated octaves of noise.
#ifndef LIMITCL_TEXTURE_HPP
#define LIMITCL_TEXTURE_HPP

#include "solve.hpp"

namespace limitcl {

struct TextureOptions {
    int octaves = 4;       ///< 1 to 20
    int levels = 0;        ///< refinements of the result, octaves - 1 at least; 0: so many
    double frequency = 8;  ///< noise cells across the diagonal of the bounding box in the first octave
    std::uint32_t seed = 0;
    std::vector<double> colours;  ///< red, green, blue from 0 to 1, one colour after the other; empty: five of marble
    Precision precision = Precision::mixed;
    double tolerance = 1e-6;  ///< of the solves, relative to the range of the noise
    int max_iterations = 200;
    bool keep_going = false;  ///< take what the solves give although A is singular, indefinite or they did not converge
    /// Of the solves. Return false to cancel (Error LCL_ERROR_CANCELLED). What it throws reaches the caller of make_texture.
    std::function<bool(int iteration, double residual, double target)> progress;
};

struct Texture {
    Mesh mesh;           ///< refined, at its limit points, with the properties "noise" (0 to 1) and "red", "green", "blue" (0 to 255)
    SolveReport report;  ///< of the worst solve; lengths are values of noise. Its status is LCL_OK unless keep_going was set
};

/// Octave i is improved Perlin noise at the vertices of the mesh refined i times, interpolated by a limit surface; their sum is a texture on the surface of
/// `mesh`. See lcl_texture. Deterministic by seed. With Catmull-Clark and Loop the first vertices are those of `mesh`.
/// Errors: LCL_ERROR_SINGULAR, LCL_ERROR_INDEFINITE, LCL_ERROR_NOT_CONVERGED (unless keep_going), LCL_ERROR_MEMORY, LCL_ERROR_BAD_INPUT,
/// LCL_ERROR_INVALID_ARGUMENT.
///     limitcl::write_mesh(limitcl::make_texture(context, mesh).mesh, "marble.ply");
[[nodiscard]] inline Texture make_texture(const Context& context, const Mesh& mesh, const TextureOptions& options = {}, const SchemeOptions& scheme = {}) {
    if (options.colours.size() % 3 != 0)
        throw Error(LCL_ERROR_INVALID_ARGUMENT, std::to_string(options.colours.size()) + " numbers are no whole number of colours; give three a colour");
    detail::require_ratios(scheme, mesh);
    SolveOptions solve;
    solve.max_iterations = options.max_iterations;
    solve.progress = options.progress;
    detail::SolveCall call(solve);
    lcl_texture_options c = LCL_TEXTURE_OPTIONS_INIT;
    c.octaves = options.octaves;
    c.levels = options.levels;
    c.frequency = options.frequency;
    c.seed = options.seed;
    c.colours = options.colours.empty() ? nullptr : options.colours.data();
    c.colour_count = options.colours.size() / 3;
    c.precision = static_cast<lcl_precision>(options.precision);
    c.tolerance = options.tolerance;
    c.max_iterations = options.max_iterations;
    c.keep_going = options.keep_going;
    c.progress = call.options()->progress;
    c.progress_user = call.options()->progress_user;
    const lcl_scheme_options rules = scheme.to_c();
    lcl_mesh textured = nullptr;
    const lcl_status status = lcl_texture(context.get(), mesh.get(), &rules, &c, &textured, call.report());
    MeshHandle handle(textured);
    SolveReport report = call.finish(status);
    if (!handle) report.require_ok();
    return {Mesh(std::move(handle)), std::move(report)};
}

}  // namespace limitcl

#endif
