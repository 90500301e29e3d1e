// SPDX-License-Identifier: BSD-3-Clause
// The mesh M^1 of the two-phase scheme as umbrellas: an old vertex with its edge and face points. Every vertex of M^1 is in exactly one (two-phase paper,
// section 3.3), so whatever is done umbrella by umbrella is done at once.
#pragma once

#include <string>
#include <vector>

#include "host/refine/refine.h"
#include "host/scheme/umbrella_masks.h"
#include "kernels/two_phase.cl.h"

namespace lcl {

/// Umbrella u has old vertex u as its centre, which is vertex u of M^1 too.
struct Umbrellas {
    Index count = 0;         ///< old vertices
    Index vertex_count = 0;  ///< of M^1
    Array<Index> offsets;    ///< count + 1, into `order`
    Array<Index> order;      ///< vertex_count: vertices of M^1, umbrella after umbrella, each in the order of UmbrellaMask, the centre first
    Array<Index> mask_of;    ///< count: which of `masks`
    std::vector<UmbrellaMask> masks;
};

/// Layout of the M^1 that refine() makes of a mesh with a blend ratio. Linear time.
Umbrellas build_umbrellas(const Topology& topology, const Features& features);

/// Why no tangent plane can be asked for at a vertex: "it lies on a crease, ..". Empty where one can.
std::string tangent_objection(const Topology& topology, const Features& features, Index v);

/// For each vertex with faces whether every edge at it that has two faces is convex: the angle between them inside the solid is below 180 degrees (Newell's
/// normals). Flat edges are not convex.
std::vector<std::uint8_t> convex_vertices(const Topology& topology, const std::vector<double>& points);

/// What the umbrellas have to hold.
struct UmbrellaTargets {
    std::vector<double> points;             ///< count x 3: limit points Q
    std::vector<std::uint8_t> constrained;  ///< count: 1 where Q is met
    std::vector<double> normals;            ///< count x 3: unit, or 0 0 0 where the tangent plane is free (always where the mask has no tangents)
    std::vector<double> handles;            ///< count: S > 0
};

/// Rows of the umbrella Laplacian L of M^1: the mean of a vertex's edge neighbours minus the vertex; on boundary and crease curves, whose limit no other
/// points have a part in, the mean of the two along the curve; 0 at corners and isolated vertices.
/// Vertices are numbered by their place in Umbrellas::order, so that neighbours are near each other in memory.
struct FairRows {
    static constexpr std::uint32_t counts = LCL_COUNTS, is_counted = LCL_IS_COUNTED, place = LCL_PLACE;
    std::vector<std::uint32_t> offsets;  ///< vertex_count + 1
    Array<std::uint32_t>
        neighbours;        ///< all edge neighbours of each vertex: a place, `counts` where the vertex's row counts it, `is_counted` where its row does
    Array<Index> lengths;  ///< vertex_count: how many neighbours the row counts
};

/// Of M^1 with its topology and features. OutOfMemory above 2^30 vertices or 2^32 - 1 entries.
FairRows build_fair_rows(const Umbrellas& umbrellas, const Topology& topology, const Features& features);

}  // namespace lcl
