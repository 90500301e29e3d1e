// SPDX-License-Identifier: BSD-3-Clause
// Points and derivatives anywhere on a limit surface by brute force: the faces round a place are subdivided again and again, in long double, until the patch
// that holds the place is a B-spline or a box spline, which is summed up by its definition. Shares nothing with the library but plain data types.
#pragma once

#include <vector>

#include <Eigen/Dense>

#include "tests/oracle/subdivide.h"

namespace oracle {

using Vector = Eigen::Matrix<long double, 3, 1>;

/// A place on the surface, in the parameters of limitcl.h.
struct Place {
    int face = 0, corner = 0;
    long double u = 0, v = 0;
};

struct SurfacePoint {
    Vector point;
    Vector du, dv;         ///< by u and v; at an extraordinary point unit tangents along the sides if it is at u = v = 0, else not numbers
    Vector duu, duv, dvv;  ///< not numbers at an extraordinary point
    bool is_extraordinary = false;
    int levels = 0;  ///< refinements that were made
};

/// The limit surface of one set of control points. Differences within a patch keep some 18 digits at any depth, since points are kept relative to one of the
/// patch; so do all derivatives, but for what the second ones lose to the size of the first: 1e-19 2^levels.
/// Not offered: two-phase surfaces, and Doo-Sabin patches next to corners that are marked inside or stay on a fixed boundary (std::invalid_argument).
class LimitSurface {
public:
    LimitSurface(const Surface& surface, const Eigen::MatrixXd& points, const lcl::SchemeOptions& options);

    SurfacePoint at(const Place& place) const;
    /// The point alone, at an extraordinary point much sooner.
    Vector point(const Place& place) const { return evaluate(place).point; }

private:
    SurfacePoint evaluate(const Place& place) const;
    SurfacePoint on_face(const Place& place) const;
    SurfacePoint on_doo_sabin_patch(const Place& place) const;

    Surface surface_;
    std::vector<Vector> points_;
    lcl::SchemeOptions options_;
    std::vector<std::vector<int>> vertex_faces_;
};

}  // namespace oracle
