// SPDX-License-Identifier: BSD-3-Clause
// Checks that the patches of every scheme have to pass.
#pragma once

#include <memory>
#include <string>

#include <Eigen/Dense>

#include "host/evaluate/patch_table.h"
#include "host/evaluate/reference.h"
#include "tests/shapes/shapes.h"

namespace patches {

/// A place as callers name it.
struct At {
    lcl::Index face = 0, corner = 0;
    double u = 0, v = 0;
};

/// S, S_u, S_v, S_uu, S_uv, S_vv, one a row.
using Jet = Eigen::Matrix<double, 6, 3>;

/// The limit surface of a shape on the host.
class Surface {
public:
    Surface(const shapes::Shape& shape, const lcl::SchemeOptions& options);
    lcl::PatchPlace locate(const At& at) const;
    Jet jet(const At& at) const;
    lcl::Index refined_corner(lcl::Index face, lcl::Index corner) const { return topology.face_offsets[face] + corner; }

    shapes::Shape shape;
    lcl::SchemeOptions options;
    lcl::Topology topology;
    lcl::Features features;
    lcl::PatchTable table;

private:
    std::vector<double> control_;
};

/// Refined vertices, of 0 to `levels` refinements, have their limits where they say that they lie, to 1e-13 of the coordinates' size of about 1.
void check_limits(const Surface& surface, int levels);

/// Derivatives at a place are what differences of positions tend to: by halves of `reach`, none of which may leave the patch. First and second ones.
void check_derivatives(const Surface& surface, const At& at, double reach);

/// Rows of kinds sum to 1 and all numbers are in range.
void check_table(const lcl::PatchTable& table);

/// The jet by new parameters, (u, v) = (u_0 + ua a + ub b, v_0 + va a + vb b).
Jet turned(const Jet& jet, double ua, double ub, double va, double vb);

/// Two ways to the same jet at a place about `distance` from a tip: points to 1e-14, derivatives to 1e-12 of the largest of their order (the rounding of
/// control points has derivatives that grow towards the tip as those of any points), second ones also but for the rounding of first ones over the distance:
/// where modes that have no second derivatives shrink more slowly than the others.
bool is_same(const Jet& a, const Jet& b, double distance);

}  // namespace patches
