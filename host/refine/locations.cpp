// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/locations.h"

#include <utility>

namespace lcl {
namespace {

/// The frame at origin + x a + y b whose first side is (ax, ay) and whose second is (bx, by), all in the sides of `frame`.
ParameterFrame inside(const ParameterFrame& frame, double x, double y, double ax, double ay, double bx, double by) {
    const auto u = [&](double s, double t) { return s * frame.au + t * frame.bu; };
    const auto v = [&](double s, double t) { return s * frame.av + t * frame.bv; };
    return {frame.face, frame.corner, frame.u + u(x, y), frame.v + v(x, y), u(ax, ay), v(ax, ay), u(bx, by), v(bx, by)};
}

SurfaceLocation place(const ParameterFrame& frame, double x, double y) {
    const ParameterFrame at = inside(frame, x, y, 0, 0, 0, 0);
    return {at.face, at.corner, at.u, at.v};
}

/// The quarter of a square at its corner k, which begins at that corner and keeps the face's orientation.
ParameterFrame quarter_at(const ParameterFrame& frame, Index k) {
    switch (k) {
        case 0: return inside(frame, 0, 0, 0.5, 0, 0, 0.5);
        case 1: return inside(frame, 1, 0, 0, 0.5, -0.5, 0);
        case 2: return inside(frame, 1, 1, -0.5, 0, 0, -0.5);
        default: return inside(frame, 0, 1, 0, -0.5, 0.5, 0);
    }
}

/// The quarter of a square towards its corner (1,1), (1,0), (0,0) or (0,1), which begins in the middle of the square: a Doo-Sabin child.
ParameterFrame quarter_towards(const ParameterFrame& frame, std::uint8_t quadrant) {
    switch (quadrant) {
        case 0: return inside(frame, 0.5, 0.5, 0.5, 0, 0, 0.5);
        case 1: return inside(frame, 0.5, 0.5, 0, -0.5, 0.5, 0);
        case 2: return inside(frame, 0.5, 0.5, -0.5, 0, 0, -0.5);
        default: return inside(frame, 0.5, 0.5, 0, 0.5, -0.5, 0);
    }
}

std::vector<ParameterFrame> corner_frames_of_polygons(const Topology& topology) {
    std::vector<ParameterFrame> frames;
    frames.reserve(topology.half_edge_count());
    for (Index f = 0; f < topology.face_count; ++f) {
        const Index degree = topology.degree(f);
        for (Index k = 0; k < degree; ++k) frames.push_back(degree == 4 ? quarter_at({f, 0, 0, 0, 1, 0, 0, 1}, k) : ParameterFrame{f, k, 0, 0, 1, 0, 0, 1});
    }
    return frames;
}

/// Where the limit of an old vertex lies on the Doo-Sabin patches: the patch point (0,0) in the interior, the side of a patch on the boundary curve, the
/// outer corner at a corner.
SurfaceLocation doo_sabin_vertex(const Topology& topology, const Features& features, Index v) {
    const Index start = topology.vertex_half_edge[v];
    if (start < 0) return {};
    Index h = start;
    bool sharp = false;
    do {
        sharp = features.edge_is_sharp[topology.half_edge_edge[h]] != 0;
        if (!sharp) h = topology.rotate(h);
    } while (!sharp && h >= 0 && h != start);
    const Index corner = sharp ? h : start, face = topology.half_edge_face[corner];
    const double v_side = sharp ? -1 : 0, u_side = sharp && features.kind[v] == VertexKind::corner ? -1 : 0;
    return {face, corner - topology.face_offsets[face], u_side, v_side};
}

}  // namespace

LocationTracker::LocationTracker(const Topology& topology, const Features& features, Scheme scheme) : scheme_(scheme) {
    if (scheme == Scheme::catmull_clark) {
        by_corner_ = true;
        frames_ = corner_frames_of_polygons(topology);
    } else if (scheme == Scheme::loop) {
        frames_.reserve(topology.face_count);
        for (Index f = 0; f < topology.face_count; ++f) frames_.push_back({f, 0, 0, 0, 1, 0, 0, 1});
    } else {
        for (Index v = 0; v < topology.vertex_count; ++v) original_.push_back(doo_sabin_vertex(topology, features, v));
    }
}

ParameterFrame LocationTracker::corner_frame(Index corner) const { return by_corner_ ? frames_[corner] : quarter_at(frames_[corner / 4], corner % 4); }

void LocationTracker::step(const StepInput& input) {
    if (scheme_ == Scheme::loop) return step_loop();
    if (scheme_ == Scheme::doo_sabin) return step_doo_sabin(input, *layout_of(input));
    if (input.options.is_two_phase()) return step_two_phase(input.topology);
    if (!by_corner_) {
        std::vector<ParameterFrame> children;
        children.reserve(4 * frames_.size());
        for (Index c = 0; c < input.topology.half_edge_count(); ++c) children.push_back(corner_frame(c));
        frames_ = std::move(children);
    }
    by_corner_ = false;  // the frame of a corner is that of the child which the step puts there
}

/// The old edges are cut in thirds: the points next to a vertex lie at 2/3 of the way to the middle of an edge, those of faces at 2/3 both ways.
void LocationTracker::step_two_phase(const Topology& topology) {
    constexpr double near = 2.0 / 3, half = 1.0 / 3;
    std::vector<ParameterFrame> refined;
    refined.reserve(9 * static_cast<std::size_t>(topology.half_edge_count()));
    for (Index h = 0; h < topology.half_edge_count(); ++h) refined.push_back(inside(corner_frame(h), near, near, half, 0, 0, half));
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index first = topology.edge_half_edge[e];
        for (const Index h : {first, topology.twin[first]}) {
            if (h < 0) continue;
            const ParameterFrame here = corner_frame(h), there = corner_frame(topology.next(h));
            refined.push_back(inside(here, near, 0, half, 0, 0, half));
            refined.push_back(inside(there, 0, near, half, 0, 0, half));
            refined.push_back(inside(there, near, near, 0, half, -half, 0));
            refined.push_back(inside(here, near, near, 0, -half, half, 0));
        }
    }
    for (Index v = 0; v < topology.vertex_count; ++v) {
        const Index start = topology.vertex_half_edge[v];
        for (Index h = start; h >= 0;) {
            const ParameterFrame whole = inside(corner_frame(h), 0, 0, near, 0, 0, near);
            for (Index k = 0; k < 4; ++k) refined.push_back(quarter_at(whole, k));
            h = topology.rotate(h);
            if (h == start) break;
        }
    }
    frames_ = std::move(refined);
    by_corner_ = true;
}

void LocationTracker::step_loop() {
    std::vector<ParameterFrame> children;
    children.reserve(4 * frames_.size());
    for (const ParameterFrame& frame : frames_) {
        children.push_back(inside(frame, 0, 0, 0.5, 0, 0, 0.5));
        children.push_back(inside(frame, 1, 0, -0.5, 0.5, -0.5, 0));
        children.push_back(inside(frame, 0, 1, 0, -0.5, 0.5, -0.5));
        children.push_back(inside(frame, 0.5, 0, 0, 0.5, -0.5, 0.5));
    }
    frames_ = std::move(children);
}

void LocationTracker::step_doo_sabin(const StepInput& input, const DooSabinLayout& layout) {
    const Topology& topology = input.topology;
    std::vector<ParameterFrame> refined(layout.vertex_count);
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
        const Index face = topology.half_edge_face[h];
        refined[h] = original_.empty() ? quarter_towards(frames_[topology.face_vertices[h]], quadrants_[h])
                                       : ParameterFrame{face, h - topology.face_offsets[face], 0, 0, 1, 0, 0, 1};
    }
    // Beyond a sharp edge the ghost row's squares continue those of the corners.
    for (Index e = 0; e < topology.edge_count; ++e) {
        if (layout.first_point[e] < 0) continue;
        const Index first = topology.edge_half_edge[e];
        for (const Index h : {first, topology.twin[first]}) {
            if (h < 0) continue;
            refined[layout.point(topology, h)] = inside(refined[h], 0, -1, 1, 0, 0, 1);
            refined[layout.point(topology, h) + 1] = inside(refined[topology.next(h)], -1, 0, 1, 0, 0, 1);
        }
    }
    for (const auto& sector : layout.sectors) {
        if (sector.kept < 0) continue;
        // A corner without sharp edges is the meeting point of the patches round it, not a square of its own.
        refined[sector.kept] = sector.closed ? inside(refined[sector.first], 0, 0, 0, 0, 0, 0) : inside(refined[sector.first], -1, -1, 1, 0, 0, 1);
    }
    frames_ = std::move(refined);
    Refinement faces;
    quadrants_.clear();
    doo_sabin_faces(input, layout, faces, &quadrants_);
    original_.clear();
    points_begin_ = topology.half_edge_count();
    kept_begin_ = layout.kept_begin;
    isolated_begin_ = layout.isolated_begin;
}

void LocationTracker::locate_by_corners(const Topology& faces, std::vector<SurfaceLocation>& out) const {
    for (Index c = 0; c < faces.half_edge_count(); ++c) {
        SurfaceLocation& location = out[faces.face_vertices[c]];
        if (location.face >= 0) continue;
        if (scheme_ == Scheme::loop) location = place(frames_[c / 3], c % 3 == 1, c % 3 == 2);
        else location = place(corner_frame(c), 0, 0);
    }
}

/// The limit of a corner point is the middle of its square, of a boundary point the middle of its outer side, of a kept corner the outer corner.
void LocationTracker::locate_doo_sabin(std::vector<SurfaceLocation>& out) const {
    for (Index v = 0; v < isolated_begin_; ++v) {
        if (v < points_begin_) out[v] = place(frames_[v], 0.5, 0.5);
        else if (v >= kept_begin_) out[v] = place(frames_[v], 0, 0);
        else if ((v - points_begin_) % 2 == 0) out[v] = place(frames_[v], 0.5, 0);
        else out[v] = place(frames_[v], 0, 0.5);
    }
}

std::vector<SurfaceLocation> LocationTracker::locations(const Topology& faces) const {
    if (!original_.empty()) return original_;
    std::vector<SurfaceLocation> out(faces.vertex_count);
    scheme_ == Scheme::doo_sabin ? locate_doo_sabin(out) : locate_by_corners(faces, out);
    return out;
}

}  // namespace lcl
