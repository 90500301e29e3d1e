// SPDX-License-Identifier: BSD-3-Clause
// Interpolation by the two-phase scheme (two-phase paper): A_lambda P = Q is solved, M^1 is made of P by the first refinement, and then each old vertex's
// umbrella in M^1 is changed until the Catmull-Clark surface of M^1 passes through Q, has the tangent planes asked for, is fair, and has the shape asked for.
#pragma once

#include <array>
#include <vector>

#include "host/solve/solve.h"
#include "host/two_phase/umbrellas.h"

namespace lcl {

struct TwoPhaseOptions {
    SolveOptions solve;
    std::vector<double> normals;  ///< empty, or vertex_count x 3 of any length; 0 0 0: free
    bool skip_normals = false;    ///< leave out normals where none can be asked for, and count them, instead of refusing them
    std::vector<double> handles;  ///< empty, or one S > 0 a vertex; rules over the next two
    double convex_handle = 1, other_handle = 1;
    double fair = 0;  ///< W; 0: none
};

/// Lengths in model units.
struct TwoPhaseReport {
    double largest_repair = 0;       ///< |Q - V_inf| before the repair
    double max_error = 0;            ///< the same at the end
    Index normal_count = 0;          ///< that hold
    Index skipped_normals = 0;       ///< left out
    Index scaled_normals = 0;        ///< were not of unit length
    Index convex_count = 0;          ///< convex vertices; counted where the two handles differ
    Index wrong_side_count = 0;      ///< where the normal asked for is on the other side of the surface
    std::vector<Index> wrong_side;   ///< the first ten
    std::array<double, 2> energy{};  ///< |L X|^2 before and after fairness; NaN without
    int fair_iterations = 0;
    bool fair_converged = true;
    double seconds = 0;  ///< after the solve
};

struct TwoPhase {
    Refinement refined;       ///< M^1
    FurtherChannels further;  ///< on M^1
    SolveReport report;
    TwoPhaseReport findings;
    bool is_given = false;  ///< false where the solve failed and options do not say to keep going: then only the report is filled
};

/// `system`: of `mesh` (or of another one with its faces), Catmull-Clark with blend ratios above 0 and below 1; vertices outside its subset are not
/// constrained. `further`: channels of the vertices, interpolated like the positions where `is_interpolated` says so (one flag a channel), refined in any case.
/// - P: A_lambda P = Q. A solve that did not converge does too, unless it ran away: the rest is repaired.
/// - Repair: each umbrella of a vertex of the subset is moved by the least-norm step to its limit point Q and, where there is a normal, its tangent plane.
/// - Fairness: X that minimises |X - X_0|^2 + W |L X|^2 under the same constraints, X_0 the repaired M^1, by projected conjugate gradients.
/// - Handles come last, so that S scales the umbrella of the fair surface: a fairness after them would take much of it back. They change neither limit points
/// nor planes. Errors: InvalidArgument: no blend ratios above 0 and below 1, W or S out of range. BadInput: a normal outside the subset, or where there is no
/// tangent plane to ask for; with the vertex.
TwoPhase interpolate_two_phase(LimitSystem& system, const PolygonMesh& mesh, const Topology& topology, const Features& features, const FeatureOptions& named,
                               const FurtherChannels& further, const std::vector<std::uint8_t>& is_interpolated, const TwoPhaseOptions& options);

/// What such a solve leaves can be repaired: it converged, or did not run away.
bool can_be_repaired(const SolveReport& report);

}  // namespace lcl
