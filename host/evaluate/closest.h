// SPDX-License-Identifier: BSD-3-Clause
// Closest points on a limit surface.
#pragma once

#include <memory>
#include <vector>

#include "host/evaluate/charts.h"
#include "host/evaluate/device_surface.h"

namespace lcl {

/// Where closest points go; arrays of the caller or null, as in limitcl.h.
struct ClosestPoints {
    Index *faces = nullptr, *corners = nullptr;
    double *uv = nullptr, *points = nullptr, *normals = nullptr, *distances = nullptr;
};

/// Seeds, points of the surface on a grid in every chart, in a k-d tree; from the nearest seed Newton's method on the square of the distance, on the exact
/// surface and across charts.
class ClosestSearch {
public:
    /// Keeps a reference. Evaluates the seeds at the surface's control points of now.
    explicit ClosestSearch(DeviceSurface& surface);
    ~ClosestSearch();

    /// points: count rows of three, `stride` values apart, finite. start: null, or `count` places to begin at instead of the nearest seeds, from which the
    /// nearest local minimum is found: where the points' closest ones were before the surface moved a little. Its arrays may be those of `out`.
    void find(const double* points, std::size_t stride, std::size_t count, const ClosestPoints& out, const Places* start = nullptr);

private:
    struct Seeds;
    class Piece;
    struct Cell;
    template <class PlaceOf, class Body>
    void evaluate_all(std::size_t count, const PlaceOf& place_of, const Body& body);
    std::vector<Cell> find_cells();
    void place_seeds();
    float normalised(double coordinate, std::size_t axis) const;

    DeviceSurface& surface_;
    Charts charts_;
    std::unique_ptr<Seeds> seeds_;
};

}  // namespace lcl
