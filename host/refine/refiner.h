// SPDX-License-Identifier: BSD-3-Clause
// A refinement that is made once and applied often: to the points of every frame, to colours and other channels; on the host here, on a device by
// host/refine/device_refiner.h. Topology of each level follows from that of the one before (child_topology.h).
#pragma once

#include <vector>

#include "host/refine/refine.h"
#include "host/refine/rows.h"

namespace lcl {

/// How the rows of a step are had that have no stored weights: from the topology before it, face points first, which edge and vertex points take.
enum class BulkRule : std::uint8_t { none, catmull_clark, loop };

/// One step of a refinement.
struct RefinerStep {
    Topology topology;  ///< of the mesh before the step
    Features features;
    SchemeOptions options;           ///< of this step: alpha and lambda only at the first one
    Index vertex_count = 0;          ///< after the step
    BulkRule bulk = BulkRule::none;  ///< of all rows, before those of `rows` are put in
    SparseRows rows;                 ///< Catmull-Clark and Loop: of sharp edges, curve vertices, corners and isolated vertices; else all
    std::vector<Index> face_parent;  ///< refined face -> face, -1 for none; empty where it follows from the number: Catmull-Clark, Loop
};

class Refiner {
public:
    /// Time and memory linear in the result, and in all before it. Errors as refine(). The topology has to be that of build_topology.
    Refiner(Topology topology, Features features, const SchemeOptions& options, int levels);

    int levels() const { return static_cast<int>(steps_.size()); }
    const SchemeOptions& options() const { return options_; }
    const std::vector<RefinerStep>& steps() const { return steps_; }
    Index control_count() const { return steps_.empty() ? finest_.vertex_count : steps_.front().topology.vertex_count; }
    Index vertex_count() const { return finest_.vertex_count; }
    /// vertex_count, face_count, uniform_degree and face_vertices of the refined mesh; face_offsets where degrees differ. Without levels all of it.
    const Topology& finest_faces() const { return finest_; }

    /// What build_topology and find_features give for the refined mesh.
    Topology finest_topology() const;
    Features finest_features(const Topology& finest) const;
    /// What the refined mesh has to be read with. At least one level.
    FeatureOptions feature_options() const;
    /// Face of the original mesh in which each refined face lies, -1 for none.
    std::vector<Index> face_parents() const;
    /// One entry a refined vertex.
    std::vector<SurfaceLocation> locations() const;

    /// Refined values, in double: control_count rows of `channels` in, vertex_count rows out, `stride` values from one to the next. Not in place.
    void apply(const double* values, std::size_t stride, int channels, double* out, std::size_t out_stride) const;

private:
    SchemeOptions options_;
    std::vector<RefinerStep> steps_;
    Topology finest_;
    Features features_;  ///< of the mesh where there are no steps
};

/// The refined mesh with these control points, `stride` values from one to the next. At least one level. It has no stencils.
Refinement refined_mesh(const Refiner& refiner, const double* points, std::size_t stride);

/// One step of apply().
void apply_step(const RefinerStep& step, const double* values, std::size_t stride, int channels, double* out, std::size_t out_stride);

}  // namespace lcl
