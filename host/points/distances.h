// SPDX-License-Identifier: BSD-3-Clause
// Distances of a cloud's points from the limit surface that is fitted to them.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "host/evaluate/closest.h"
#include "host/points/fit_mesh.h"
#include "host/points/insert.h"

namespace lcl {

struct FitDistances {
    static constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
    double rms = not_measured, p95 = not_measured, max = not_measured;  ///< model units
    std::size_t outside = 0;                                            ///< farther away than the tolerance
};

class CloudDistances {
public:
    /// points: n x 3; measured: numbers of those that count, in ascending order, not empty.
    CloudDistances(const std::vector<double>& points, std::vector<Index> measured);

    std::size_t count() const { return measured_.size(); }
    const std::vector<double>& points() const { return points_; }  ///< the measured ones, count x 3
    /// Distances of all points. mesh: whose limit surface is searched, its sources numbers of points; no vertex is farther from the surface than vertex_bound,
    /// whatever the search says.
    void measure_all(ClosestSearch& search, const FitMesh& mesh, double vertex_bound);
    /// Only those of the points near vertices that were added since they were measured last: the surface moves farther off by little.
    void measure_changed(ClosestSearch& search, const FitMesh& mesh, double vertex_bound);
    /// Distances that were found elsewhere, count of them.
    void set(std::vector<double> distances) { distances_ = std::move(distances); }

    FitDistances statistics(double tolerance) const;
    /// Points farther away than `least`; their numbers are those of the cloud.
    std::vector<FarPoint> far_points(double least) const;

private:
    void measure(ClosestSearch& search, const std::vector<Index>& places, const FitMesh& mesh, double vertex_bound);
    std::vector<Index> places_of_changed_faces(const FitMesh& mesh) const;

    std::vector<Index> measured_, place_of_point_;
    std::vector<double> points_;
    std::vector<Index> faces_;  // of the closest places
    std::vector<double> distances_;
    std::size_t vertex_count_ = 0;  // of the mesh when they were measured last
};

}  // namespace lcl
