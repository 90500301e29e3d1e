// SPDX-License-Identifier: BSD-3-Clause
// Control meshes of limit surfaces through point clouds (Doo-Sabin paper): approximation, simplification, interpolation, and fitting to a tolerance.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "host/device/device.h"
#include "host/mesh/features.h"
#include "host/points/approximate.h"
#include "host/points/distances.h"
#include "host/solve/solve.h"

namespace lcl {

enum class FitKind { interpolate, least_squares };                          // order of lcl_fit
enum class SurfacePhase { approximate, simplify, solve, measure, refine };  // order of lcl_surface_phase

struct SurfaceOptions {
    SchemeOptions scheme;
    bool alpha_auto = false;
    FitKind fit = FitKind::interpolate;
    double tolerance = 1e-3;  ///< of every point, relative to the diagonal
    Index max_vertices = 0;   ///< 0: no matter how many
    int max_rounds = 30;
    int fill_holes = 0;  ///< boundary loops of so many edges; 0: none
    double fair = 1e-3;
    BoundaryRule boundary = BoundaryRule::edge_and_corner;
    double crease_angle_degrees = -1;  ///< below 0: off
    EngineOptions engine_options;
    SolveOptions solve;
    /// round, fraction of the phase (negative: not known), largest distance of the last round (NaN before); false stops (Cancelled).
    std::function<bool(SurfacePhase, int, double, double)> progress;
};

struct SurfaceReport {
    std::size_t point_count = 0, duplicate_count = 0, left_out_count = 0, unused_count = 0;
    Index approximation_vertices = 0, approximation_faces = 0, components = 0, boundary_loops = 0;
    Index filled_holes = 0, dropped_faces = 0, split_vertices = 0, simplified_vertices = 0;
    Index creases = 0;
    int rounds = 0, iterations = 0;
    double alpha = 0;  ///< Catmull-Clark: the one in use
    double diagonal = 0;
    FitDistances distances;
    double interpolation_error = std::numeric_limits<double>::quiet_NaN();
    double seconds_approximate = 0, seconds_simplify = 0, seconds_solve = 0, seconds_measure = 0, seconds_refine = 0;
    bool converged = false;
    std::string message;
};

struct SurfaceResult {
    PolygonMesh mesh;             ///< control points; no vertices where a solve gave none
    FeatureOptions features;      ///< what the mesh has to be read with
    std::vector<double> colours;  ///< vertex_count x 3, or empty
    SurfaceReport report;
    SolveReport solve;  ///< the last one
    std::vector<std::string> warnings;
};

/// As lcl_surface in limitcl.h. Singular, indefinite and not converged are results.
SurfaceResult surface_from_points(const std::shared_ptr<Context>& context, const PointCloud& cloud, const lcl_engine& engine, const SurfaceOptions& options);

}  // namespace lcl
