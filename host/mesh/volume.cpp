// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/volume.h"

#include <algorithm>
#include <cmath>

#include "host/mesh/box.h"
#include "host/mesh/normals.h"

namespace lcl {
namespace {

constexpr double no_volume = 1e-9;  // of the cube of the component's diagonal: rounding, or a sheet folded on itself
constexpr double reached = 1e-10;   // of the volume: what is left of the difference

class Volumes {
public:
    Volumes(const PolygonMesh& mesh, const Topology& topology) : mesh_(mesh), topology_(topology), component_(connected_components(topology, count_)) {
        if (topology.is_closed()) return;
        const Index h = boundary_loops(topology).front().front();
        throw BadInput("the mesh has a boundary, such as at vertex " + std::to_string(topology.origin(h)) +
                           ", so it encloses no volume: close its holes, or do without the volume",
                       {{topology.origin(h)}, {topology.half_edge_face[h]}});
    }

    Index count() const { return count_; }
    Index component_of(Index v) const { return component_[v]; }
    Index component_of_face(Index f) const { return component_[mesh_.face_vertices[mesh_.face_offsets[f]]]; }

    /// A vertex of each component.
    std::vector<Index> first_vertices() const {
        std::vector<Index> first(count_, -1);
        for (Index v = topology_.vertex_count; v-- > 0;)
            if (component_[v] >= 0) first[component_[v]] = v;
        return first;
    }

    // mean of the corners . Newell's normal / 6, from a vertex of the component, which keeps digits far from the origin
    std::vector<double> measure(const std::vector<double>& positions) const {
        const std::vector<Index> origins = first_vertices();
        std::vector<double> volumes(count_, 0.0);
        for (Index f = 0; f < topology_.face_count; ++f) {
            const Index component = component_of_face(f);
            const double* const origin = &positions[3 * static_cast<std::size_t>(origins[component])];
            const Vector normal = newell_normal(topology_, f, positions);
            double sum = 0;
            for (Index h = mesh_.face_offsets[f]; h < mesh_.face_offsets[f + 1]; ++h)
                for (int c = 0; c < 3; ++c) sum += (positions[3 * static_cast<std::size_t>(mesh_.face_vertices[h]) + c] - origin[c]) * normal[c];
            volumes[component] += sum / (6 * mesh_.degree(f));
        }
        return volumes;
    }

    /// The least volume of each component that is one: some part of its bounding box.
    std::vector<double> least(const std::vector<double>& positions) const {
        std::vector<Box> boxes(count_);
        for (std::size_t v = 0; v < component_.size(); ++v)
            for (int c = 0; c < 3 && component_[v] >= 0; ++c) {
                Box& box = boxes[component_[v]];
                box.low[c] = std::min(box.low[c], positions[3 * v + c]);
                box.high[c] = std::max(box.high[c], positions[3 * v + c]);
            }
        std::vector<double> least;
        for (const Box& box : boxes) least.push_back(no_volume * std::pow(box.diagonal(), 3));
        return least;
    }

private:
    const PolygonMesh& mesh_;
    const Topology& topology_;
    Index count_ = 0;
    const std::vector<Index> component_;
};

/// The root of a cubic polynomial that Newton's method finds from 0.
double root_near_zero(double c0, double c1, double c2, double c3) {
    double t = 0;
    for (int step = 0; step < 60; ++step) {
        const double value = c0 + t * (c1 + t * (c2 + t * c3)), slope = c1 + t * (2 * c2 + t * 3 * c3);
        if (value == 0) break;
        const double next = t - value / slope;
        if (next == t) break;
        t = next;
    }
    return t;
}

std::vector<double> moved(const std::vector<double>& positions, const Array<Vector>& directions, const Volumes& volumes, const std::vector<double>& distances) {
    std::vector<double> out = positions;
    for (std::size_t v = 0; v < directions.size(); ++v)
        if (volumes.component_of(static_cast<Index>(v)) >= 0)
            for (int c = 0; c < 3; ++c) out[3 * v + c] += distances[volumes.component_of(static_cast<Index>(v))] * directions[v][c];
    return out;
}

}  // namespace

std::vector<double> component_volumes(const PolygonMesh& mesh, const Topology& topology, const std::vector<double>& positions) {
    return Volumes(mesh, topology).measure(positions);
}

// The volume is a cubic polynomial of the distance: four values give it, at distances of the component's own size, so that it holds as far as that is changed.
std::vector<std::string> match_volumes(const PolygonMesh& mesh, const Topology& topology, const std::vector<double>& before,
                                       const std::vector<std::uint8_t>& is_fixed, std::vector<double>& positions) {
    const Volumes volumes(mesh, topology);
    const std::vector<double> wanted = volumes.measure(before), now = volumes.measure(positions);
    Array<Vector> directions = vertex_normals(topology, positions);
    for (std::size_t v = 0; v < directions.size(); ++v) {
        const double length = is_fixed[v] ? 0 : std::hypot(directions[v][0], directions[v][1], directions[v][2]);
        for (double& component : directions[v]) component = length > 0 ? component / length : 0;
    }
    std::vector<double> unit(volumes.count());
    for (std::size_t i = 0; i < unit.size(); ++i) unit[i] = std::cbrt(std::fabs(now[i]));
    const auto at = [&](double factor) {
        std::vector<double> distances = unit;
        for (double& distance : distances) distance *= factor;
        return volumes.measure(moved(positions, directions, volumes, distances));
    };
    const std::vector<double> back = at(-1), one = at(1), two = at(2);
    std::vector<double> distances(unit.size(), 0.0);
    for (std::size_t i = 0; i < unit.size(); ++i) {
        const double second = (one[i] + back[i]) / 2 - now[i], odd = (one[i] - back[i]) / 2, third = (two[i] - now[i] - 4 * second - 2 * odd) / 6;
        distances[i] = unit[i] * root_near_zero(now[i] - wanted[i], odd - third, second, third);
    }
    const std::vector<double> candidate = moved(positions, directions, volumes, distances), found = volumes.measure(candidate);
    const std::vector<Index> first = volumes.first_vertices();
    const std::vector<double> least_before = volumes.least(before), least = volumes.least(positions);
    std::vector<std::string> notes;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        const bool is_volume = std::fabs(wanted[i]) > least_before[i] && std::fabs(now[i]) > least[i] && (now[i] > 0) == (wanted[i] > 0);
        if (is_volume && std::fabs(found[i] - wanted[i]) <= reached * std::fabs(wanted[i])) continue;
        distances[i] = 0;
        notes.push_back("the volume of the component of vertex " + std::to_string(first[i]) +
                        " was not kept: " + (is_volume ? "no distance along the normals gives it back" : "it encloses none, or was turned inside out"));
    }
    positions = moved(positions, directions, volumes, distances);
    return notes;
}

}  // namespace lcl
