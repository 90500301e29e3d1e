// SPDX-License-Identifier: BSD-3-Clause
// What a plan needs beside its rows to give limit tangents and normals: plain arrays, made without a device.
#pragma once

#include <cstdint>
#include <vector>

#include "host/operator/plan.h"

namespace lcl {

/// Ring rows of smooth vertices take two weights a neighbour from a table that all of a valence share; all other rows have stored stencils, three tangents over
/// the same columns, for each of their sectors (tangent_rows.h). Everything in the plan's numbering.
struct TangentPlan {
    std::vector<std::int32_t> run_turns;  ///< of each run: place of its first pair in `turns`, -1: its rows are stored ones
    std::vector<double> turns;            ///< cosine and sine weight of each neighbour of a ring

    // Stored rows, those with more than one sector first; isolated vertices have none.
    std::vector<Index> rows;
    std::vector<std::uint32_t> sector_offsets{0};  ///< rows + 1
    std::vector<std::uint32_t> entry_offsets{0};   ///< sectors + 1
    std::vector<Index> columns;                    ///< entries
    std::vector<double> weights;                   ///< entries x 3

    // Sides: the first sectors, those of the rows with more than one.
    std::vector<Index> side_vertices;  ///< caller's vertex
    std::vector<Index> side_faces;     ///< first face of the sector, in face order

    Index side_count() const { return static_cast<Index>(side_vertices.size()); }
};

/// Linear time, on all cores. InvalidArgument where mesh or features are not those that the plan was made of; OutOfMemory where stencils would pass 2^32 - 1
/// entries.
TangentPlan build_tangent_plan(const Plan& plan, const Topology& topology, const Features& features, const SchemeOptions& options);

}  // namespace lcl
