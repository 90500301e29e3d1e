// SPDX-License-Identifier: BSD-3-Clause
// How large refined meshes get, foretold before anything is built. Internal to host/refine.
#pragma once

#include <cstdint>

#include "host/refine/steps.h"

namespace lcl {

/// Numbers of a mesh, in 64 bits: refined ones are foretold before anything is built.
struct MeshCounts {
    std::int64_t vertices = 0, edges = 0, faces = 0, corners = 0, isolated = 0;
    // Doo-Sabin only: half-edges of sharp edges, corners that are kept (one a sector), vertex-faces, and faces round corners without sharp edges.
    std::int64_t sharp = 0, kept = 0, sectors = 0, fan_faces = 0, fans = 0;
};

/// layout: of Doo-Sabin, else null.
MeshCounts count(const StepInput& input, const DooSabinLayout* layout);

/// Counts of the last level. OutOfMemory, with the number, where a level does not fit.
MeshCounts check_levels_fit(MeshCounts counts, const SchemeOptions& options, int levels);

/// Stencils repeat the corners of a face for each of its points: the square of the face degrees counts. OutOfMemory where they do not fit.
void check_stencils_fit(const Topology& topology);

}  // namespace lcl
