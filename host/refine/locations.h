// SPDX-License-Identifier: BSD-3-Clause
// Follows refined vertices back to the parameters of the original mesh. Internal to host/refine.
#pragma once

#include <cstdint>
#include <vector>

#include "host/refine/steps.h"

namespace lcl {

/// A square (Loop: a triangle) in the parameters of one patch: origin (u, v) and two sides a and b, in face order.
struct ParameterFrame {
    Index face = -1, corner = 0;
    double u = 0, v = 0;
    double au = 0, av = 0, bu = 0, bv = 0;
};

/// Kept beside the mesh while it is refined. Frames belong to:
/// - Catmull-Clark: corners, each a quarter of a quad or the sub-quad of a polygon (which is the child that the next step puts there);
///   after a step only faces, one frame a quad, since its four quarters follow.
/// - Loop: faces.
/// - Doo-Sabin: vertices, each the square round the control point, whose middle is its limit; at a boundary the side that is the curve.
class LocationTracker {
public:
    LocationTracker(const Topology& topology, const Features& features, Scheme scheme);

    /// Follows one step.
    void step(const StepInput& input);

    /// One entry for each vertex of the mesh as it is now, whose faces these are.
    std::vector<SurfaceLocation> locations(const Topology& faces) const;

private:
    ParameterFrame corner_frame(Index corner) const;
    void step_two_phase(const Topology& topology);
    void step_loop();
    void step_doo_sabin(const StepInput& input, const DooSabinLayout& layout);
    void locate_by_corners(const Topology& faces, std::vector<SurfaceLocation>& out) const;
    void locate_doo_sabin(std::vector<SurfaceLocation>& out) const;

    Scheme scheme_;
    bool by_corner_ = false;  ///< Catmull-Clark: frames are those of corners
    std::vector<ParameterFrame> frames_;
    // Doo-Sabin: which refined vertices are corners of faces, then boundary points, then kept corners, then isolated ones; and the way to the patches.
    std::vector<SurfaceLocation> original_;
    std::vector<Index> vertex_of_corner_;
    std::vector<std::uint8_t> quadrants_;
    Index points_begin_ = 0, kept_begin_ = 0, isolated_begin_ = 0;
};

}  // namespace lcl
