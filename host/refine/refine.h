// SPDX-License-Identifier: BSD-3-Clause
// Uniform refinement: topology of the refined mesh and the stencils that give its points.
//
// Order of refined vertices and faces:
// - Catmull-Clark, Loop: old vertices with their numbers, then edge points (edges by first appearance walking the faces), then face points. The children of a
//   face follow each other, one a corner, each beginning at its corner's old vertex; Loop's middle triangle is the last.
// - Doo-Sabin: one vertex per face corner; then the two points of each boundary edge ab, 3/4 a + 1/4 b and 1/4 a + 3/4 b, in the direction of its face (edges
// by
//   first appearance; a crease edge has a pair for the half-edge that appeared first, then a pair for its twin); then kept corners, by vertex, one for each
//   sector between sharp edges in face order; then isolated vertices. Faces: old faces, edges, vertices.
// - Two-phase (M^1): old vertices with their numbers; then two points an edge ab (edges by first appearance, a b as they appeared), the one next to a first;
// then one
//   point per face corner. Faces: old faces; for each edge one quad on each of its sides; for each vertex one quad in each of its faces.
//
// Sharp features: Catmull-Clark, Loop and two-phase keep creases as creases. Doo-Sabin cuts the mesh along them: the two sides become boundaries whose points
// lie at the same places, so the refined mesh has no creases left and stands for the same surface. Old corners remain corners. Points that are put on a `fixed`
// boundary are no corners: the boundary between two corners is a straight line anyway.
#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/features.h"
#include "host/mesh/polygon_mesh.h"
#include "host/scheme/scheme.h"

namespace lcl {

/// Where the limit of a refined vertex lies on the original mesh, in the parameters of `limitcl evaluate`.
/// Catmull-Clark: quads have corner 0 and (u, v) over the whole face; other faces a sub-quad per corner. Loop: corner 0, barycentric (1 - u - v, u, v).
/// Doo-Sabin: the patch of (face, corner), whose control point has its limit at (1/2, 1/2); a boundary point lies at (1/2, -1) or (-1, 1/2), a kept corner at
/// (-1, -1). M^1 of the two-phase scheme is no patch structure of the original mesh: there the old edges are cut in thirds, faces likewise.
struct SurfaceLocation {
    Index face = -1;  ///< -1: isolated vertex
    Index corner = 0;
    double u = 0, v = 0;
};

/// Rows of a refinement: point i = sum over j in [offsets[i], offsets[i + 1]) of weights[j] * old point indices[j].
struct Stencils {
    std::vector<std::size_t> offsets{0};
    std::vector<Index> indices;
    std::vector<double> weights;
};

/// Channels of the vertices that are refined beside their positions: vertex_count x count.
struct FurtherChannels {
    int count = 0;
    std::vector<double> values;
};

/// One refinement step.
struct Refinement {
    PolygonMesh mesh;   ///< refined faces and positions
    Stencils stencils;  ///< vertex_count rows over the old vertices; refine_once only
    FeatureOptions
        features;  ///< what the refined mesh has to be read with: crease edges, corners that the boundary rule does not find, the rule; no crease angle
    std::vector<Index> face_parent;  ///< refined face -> face of the original mesh; -1 for the faces that Doo-Sabin puts on edges and vertices
};

/// Refines once. alpha and lambda of `options` rule this step (lambda: the two-phase first step, which gives M^1);
/// the result is refined and read with alpha 0 and lambda 0. Time and memory linear in the mesh and in the squares of the face degrees (stencils).
/// BadInput: Loop on other than triangles; Doo-Sabin at a vertex with just two faces all round it. InvalidArgument: lambda with another scheme than
/// Catmull-Clark.
Refinement refine_once(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options);

/// Refines `levels` times (0: a copy). `locations`, if asked for, receives one entry per refined vertex. Makes no stencils (they stay empty: refine level by
/// level with refine_once for those), so time and memory are linear in the result whatever the degrees. Errors as refine_once and build_topology, and:
/// OutOfMemory, with the number, when a level would have more than 2^31 - 1 of anything or more bytes than the machine has.
Refinement refine(const PolygonMesh& mesh, const FeatureOptions& features, const SchemeOptions& options, int levels,
                  std::vector<SurfaceLocation>* locations = nullptr);

/// Numbers of a refined mesh.
struct RefinedSize {
    std::int64_t vertices = 0, edges = 0, faces = 0, corners = 0;
};

/// What refine() with so many levels will make of this mesh, foretold in linear time. Errors as refine().
RefinedSize refined_size(const Topology& topology, const Features& features, const SchemeOptions& options, int levels);

/// Bytes of memory that the machine has.
std::int64_t physical_memory();

/// Applies stencils to points with c channels (old_count x c in, rows x c out), in double.
std::vector<double> apply_stencils(const Stencils& stencils, const std::vector<double>& points, int channels);

}  // namespace lcl
