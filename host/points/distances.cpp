// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/distances.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lcl {
namespace {

constexpr std::uint8_t changed_rings = 3;  // of faces round a new vertex; rows of the inverse of A fall by about a half a ring, and the last round measures all

using Vertex = OpenMesh::VertexHandle;

/// 1 for new vertices, 2 for those of the faces round them, and so on; 0 for those farther off.
std::vector<std::uint8_t> rings_round_new_vertices(const FitMesh& mesh, std::size_t old_count) {
    std::vector<std::uint8_t> ring_of(mesh.n_vertices(), 0);
    std::fill(ring_of.begin() + static_cast<std::ptrdiff_t>(old_count), ring_of.end(), std::uint8_t{1});
    for (std::uint8_t ring = 1; ring <= changed_rings; ++ring)
        for (const OpenMesh::FaceHandle face : mesh.faces()) {
            const auto corners = mesh.fv_range(face);
            const auto is_reached = [&](Vertex v) { return ring_of[v.idx()] != 0 && ring_of[v.idx()] <= ring; };
            if (std::none_of(corners.begin(), corners.end(), is_reached)) continue;
            for (const Vertex v : corners)
                if (ring_of[v.idx()] == 0) ring_of[v.idx()] = static_cast<std::uint8_t>(ring + 1);
        }
    return ring_of;
}

}  // namespace

CloudDistances::CloudDistances(const std::vector<double>& points, std::vector<Index> measured)
    : measured_(std::move(measured)),
      place_of_point_(points.size() / 3, -1),
      points_(3 * measured_.size()),
      faces_(measured_.size(), 0),
      distances_(measured_.size(), 0.0) {
    for (std::size_t i = 0; i < measured_.size(); ++i) {
        std::copy_n(&points[3 * static_cast<std::size_t>(measured_[i])], 3, &points_[3 * i]);
        place_of_point_[measured_[i]] = static_cast<Index>(i);
    }
}

void CloudDistances::measure_all(ClosestSearch& search, const FitMesh& mesh, double vertex_bound) {
    std::vector<Index> all(count());
    std::iota(all.begin(), all.end(), 0);
    measure(search, all, mesh, vertex_bound);
}

void CloudDistances::measure_changed(ClosestSearch& search, const FitMesh& mesh, double vertex_bound) {
    measure(search, places_of_changed_faces(mesh), mesh, vertex_bound);
}

std::vector<Index> CloudDistances::places_of_changed_faces(const FitMesh& mesh) const {
    const std::vector<std::uint8_t> ring_of = rings_round_new_vertices(mesh, vertex_count_);
    std::vector<Index> places;
    for (std::size_t i = 0; i < count(); ++i) {
        const auto corners = mesh.fv_range(mesh.face_handle(faces_[i]));
        if (std::any_of(corners.begin(), corners.end(), [&](Vertex v) { return ring_of[v.idx()] != 0; })) places.push_back(static_cast<Index>(i));
    }
    return places;
}

void CloudDistances::measure(ClosestSearch& search, const std::vector<Index>& places, const FitMesh& mesh, double vertex_bound) {
    std::vector<double> points(3 * places.size()), distances(places.size());
    std::vector<Index> faces(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) std::copy_n(&points_[3 * static_cast<std::size_t>(places[i])], 3, &points[3 * i]);
    ClosestPoints found;
    found.faces = faces.data();
    found.distances = distances.data();
    search.find(points.data(), 3, places.size(), found);
    for (std::size_t i = 0; i < places.size(); ++i) {
        faces_[places[i]] = faces[i];
        distances_[places[i]] = std::fabs(distances[i]);
    }
    for (const Vertex vertex : mesh.vertices()) {
        const Index source = mesh.data(vertex).source, place = source >= 0 ? place_of_point_[source] : -1;
        if (place >= 0) distances_[place] = std::min(distances_[place], vertex_bound);
    }
    vertex_count_ = mesh.n_vertices();
}

FitDistances CloudDistances::statistics(double tolerance) const {
    FitDistances out;
    out.rms = 0;
    std::vector<double> sorted = distances_;
    for (const double distance : sorted) {
        out.rms += distance * distance;
        out.outside += !(distance <= tolerance);
    }
    out.rms = std::sqrt(out.rms / static_cast<double>(count()));
    const auto at_95 = sorted.begin() + static_cast<std::ptrdiff_t>((count() * 95 + 99) / 100 - 1);
    std::nth_element(sorted.begin(), at_95, sorted.end());
    out.p95 = *at_95;
    out.max = *std::max_element(at_95, sorted.end());
    return out;
}

std::vector<FarPoint> CloudDistances::far_points(double least) const {
    std::vector<FarPoint> far;
    for (std::size_t i = 0; i < count(); ++i)
        if (distances_[i] > least) far.push_back({measured_[i], faces_[i], distances_[i]});
    return far;
}

}  // namespace lcl
