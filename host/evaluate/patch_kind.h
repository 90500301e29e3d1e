// SPDX-License-Identifier: BSD-3-Clause
// Kinds of irregular patches, each given by the matrices of its local subdivision (Stam 1998; Doo-Sabin paper, chapter 5).
//
// An irregular patch has its extraordinary vertex (Doo-Sabin: the centre of its extraordinary face) at (s, t) = (0, 0). It is an infinite sequence of rings,
// each of three regular cells, numbered k = 0 (at the s-axis), 1 (in the middle), 2 (at the t-axis):
// - squares (Catmull-Clark, Doo-Sabin): depth m holds 2^-(m+1) < max(s, t) <= 2^-m. With s' = 2^(m+1) s, t' likewise, the cells are the unit squares at
//   (s', t') = (1, 0), (1, 1), (0, 1), each with its own parameters (s', t') minus that corner.
// - triangles (Loop): depth m holds 2^-(m+1) < s + t <= 2^-m. Cell 0 has the parameters (s' - 1, t'), cell 2 (s', t' - 1), and cell 1, the turned one in the
//   middle, (1 - s', 1 - t'): its derivatives by (s, t) change their sign.
// The control points of cell (m, k) are cells[k] step^m C.
//
// Order of a regular patch's control points, i along s, j along t, the patch beginning at point (0, 0) of the lattice:
// - Catmull-Clark, 16: j = -1 .. 2, in each i = -1 .. 2.
// - Loop, 12, on the lattice of directions s and t: j = -1: i = 0, 1, 2; j = 0: i = -1 .. 2; j = 1: i = -1, 0, 1; j = 2: i = -1, 0.
// - Doo-Sabin, 9: j = -1, 0, 1, in each i = -1, 0, 1; the patch is that of the middle point (0, 0): its (s, t) = (0, 0) lies in the middle of the face of the
//   points (-1, -1), (0, -1), (0, 0), (-1, 0).
#pragma once

#include <array>
#include <vector>

#include <Eigen/Dense>

#include "host/scheme/scheme.h"

namespace lcl {

/// Control points of a regular patch: 16, 12 or 9.
inline int regular_point_count(Scheme scheme) { return scheme == Scheme::catmull_clark ? 16 : scheme == Scheme::loop ? 12 : 9; }

/// Control points first .. first + size - 1 of a kind that a turn round the extraordinary point by one face takes each to the next one, the last to the first.
/// In the plane point j lies at the angle (j + phase) 2 pi / size. size 1: the extraordinary vertex itself.
struct Orbit {
    int first = 0, size = 1;
    double phase = 0;
};

struct PatchKind {
    int point_count = 0;                   ///< K
    Eigen::MatrixXd step;                  ///< K x K: the control points one depth on. Rows sum to 1
    std::array<Eigen::MatrixXd, 3> cells;  ///< each regular_point_count x K
    /// The inner points, where the surroundings look alike from every face (closed and smooth): rows of `step` at inner points have no entries elsewhere. They
    /// are the first points. Empty at sharp features.
    std::vector<Orbit> orbits;
};

}  // namespace lcl
