// SPDX-License-Identifier: BSD-3-Clause
// Interpolation by the two-phase scheme: exact positions, tangent planes, shape handles, fairness.
#ifndef LIMITCL_TWO_PHASE_HPP
#define LIMITCL_TWO_PHASE_HPP

#include "solve.hpp"

#include <array>

namespace limitcl {

struct TwoPhaseOptions {
    std::vector<double> normals;        ///< empty, or vertex_count x 3: the normal that the surface is to have, of any length above 0; 0 0 0: free
    bool skip_normals = false;          ///< leave out and count normals that cannot be asked for, instead of refusing them
    std::vector<double> handles;        ///< empty, or one shape handle S > 0 a vertex; rules over the next two
    double convex_handle = 1;           ///< S of convex vertices
    double other_handle = 1;            ///< S of the others
    double fair = 0;                    ///< W, weight of fairness; 0: none
    std::vector<std::string> channels;  ///< names of properties that are interpolated like x, y, z; the others are only refined
    SolveOptions solve;                 ///< of A_lambda P = Q; without warm_start
};

/// What was done to the refined mesh. Lengths in model units.
struct TwoPhaseReport {
    SolveReport solve;                     ///< its status is LCL_OK also where the solve ended early: the rest is repaired
    int normal_count = 0;                  ///< normals that the surface has now
    int skipped_normals = 0;               ///< left out, with skip_normals
    int scaled_normals = 0;                ///< that were not of unit length
    int wrong_side_count = 0;              ///< normals on the other side of the surface than the one it had
    std::vector<std::int32_t> wrong_side;  ///< the first ten of these vertices
    int convex_count = 0;                  ///< convex vertices; counted where the two handles differ
    int fair_iterations = 0;
    bool fair_converged = true;
    double largest_repair = 0;       ///< largest distance from a vertex to its limit point before the repair
    double max_error = 0;            ///< the same in the result: rounding
    std::array<double, 2> energy{};  ///< |L X|^2 before and after fairness; NaN without
    double seconds = 0;              ///< of all but the solve
};

struct TwoPhaseMesh {
    Mesh mesh;  ///< M^1: vertex i of the input is vertex i; to be read with alpha 0 and lambda 0
    TwoPhaseReport report;
};

/// Refined control mesh M^1 whose Catmull-Clark surface passes through the vertices of `mesh` exactly, however far the solve went, and has the normals and the
/// shape asked for. See lcl_two_phase_mesh. A: of `mesh`, Catmull-Clark with a blend ratio lambda above 0 and below 1.
/// Errors: LCL_ERROR_INVALID_ARGUMENT; LCL_ERROR_BAD_INPUT: a normal that cannot be asked for; LCL_ERROR_SINGULAR, LCL_ERROR_INDEFINITE,
/// LCL_ERROR_NOT_CONVERGED (unless solve.keep_going): the solve ran away.
///     limitcl::SchemeOptions scheme;
///     scheme.scheme = limitcl::Scheme::catmull_clark;
///     scheme.lambda = 1.0 / 3;
///     const limitcl::LimitOperator A(context, mesh, scheme);
///     limitcl::write_mesh(limitcl::interpolate_two_phase(A, mesh).mesh, "refined.obj");
[[nodiscard]] inline TwoPhaseMesh interpolate_two_phase(const LimitOperator& A, const Mesh& mesh, const TwoPhaseOptions& options = {}) {
    const std::size_t n = static_cast<std::size_t>(mesh.vertex_count());
    const auto require_size = [](const std::vector<double>& values, std::size_t expected, const char* what) {
        if (!values.empty() && values.size() != expected)
            throw Error(LCL_ERROR_INVALID_ARGUMENT,
                        std::to_string(values.size()) + " values were given as " + what + ", the mesh needs " + std::to_string(expected) + " or none");
    };
    require_size(options.normals, 3 * n, "normals");
    require_size(options.handles, n, "handles");
    if (options.convex_handle == 0 || options.other_handle == 0) throw Error(LCL_ERROR_INVALID_ARGUMENT, "a shape handle is 0; give numbers above 0");
    std::vector<const char*> channels;
    for (const std::string& name : options.channels) channels.push_back(name.c_str());
    detail::SolveCall call(options.solve);
    lcl_two_phase_options c = LCL_TWO_PHASE_OPTIONS_INIT;
    c.normals = options.normals.empty() ? nullptr : options.normals.data();
    c.skip_normals = options.skip_normals;
    c.handles = options.handles.empty() ? nullptr : options.handles.data();
    c.convex_handle = options.convex_handle;
    c.other_handle = options.other_handle;
    c.fair = options.fair;
    c.channels = channels.data();
    c.channel_count = channels.size();
    lcl_two_phase_report found = LCL_TWO_PHASE_REPORT_INIT;
    lcl_mesh refined = nullptr;
    const lcl_status status = lcl_two_phase_mesh(A.get(), mesh.get(), call.options(), &c, &refined, call.report(), &found);
    MeshHandle handle(refined);
    TwoPhaseReport report;
    report.solve = call.finish(status);
    if (!handle) report.solve.require_ok();
    report.normal_count = found.normal_count;
    report.skipped_normals = found.skipped_normals;
    report.scaled_normals = found.scaled_normals;
    report.wrong_side_count = found.wrong_side_count;
    report.wrong_side.assign(found.wrong_side, found.wrong_side + (found.wrong_side_count < 10 ? found.wrong_side_count : 10));
    report.convex_count = found.convex_count;
    report.fair_iterations = found.fair_iterations;
    report.fair_converged = found.fair_converged != 0;
    report.largest_repair = found.largest_repair;
    report.max_error = found.max_error;
    report.energy = {found.energy[0], found.energy[1]};
    report.seconds = found.seconds;
    return {Mesh(std::move(handle)), std::move(report)};
}

}  // namespace limitcl

#endif
