// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "host/mesh/features.h"
#include "host/operator/plan.h"

namespace lcl {

struct FeatureOperatorOptions {
    double angle_degrees = 20;         ///< at which a weight has fallen to 1/e
    double diagonal_factor = 2.5;      ///< above 2
    int smoothing = 3;                 ///< of the points from which tangent planes are taken
    std::vector<std::uint8_t> subset;  ///< empty, or 1 for each vertex that may move
};

/// The plan of A = D^-1 (D - L): A_ii = 1 - 1/factor, A_ij = w_ij / (factor sum w) for the neighbours j over edges, D_ii = factor sum w. L is their graph
/// Laplacian with w_ij = exp(-(phi_ij / angle)^2), phi_ij the angle between the vertex normals at both ends. Vertex normals, and not those of the two faces at
/// the edge: the faces' angle is large where an edge runs ALONG a sharp feature, which would cut the feature apart and tie it to its flanks.
/// Curve vertices hold to their neighbours on the curve alone, darts to all. Corners, isolated vertices, those outside the subset, and those at which all
/// weights underflow have identity rows; D_ii is filled in for them too where they have neighbours. Eigenvalues lie in [1 - 2/factor, 1] (Gershgorin).
/// points: from which normals are taken, x, y, z of every vertex, of a size about 1; options.smoothing is not looked at.
Plan build_feature_plan(const PolygonMesh& mesh, const Topology& topology, const Features& features, const std::vector<double>& points,
                        const FeatureOperatorOptions& options, Index block_rows);

}  // namespace lcl
