/* SPDX-License-Identifier: BSD-3-Clause */
/* A regular octahedron. Its Loop limit points are 24/55 of its vertices (valence 4: beta = 31/256, weight of a neighbour 1 / (4 + 3 / (8 beta)) = 31/220,
 * and the four neighbours of a vertex add up to 0), so the control points that interpolate it are 55/24 of them. */
static const double octahedron_points[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
static const int octahedron_faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
static const double octahedron_control_scale = 55.0 / 24.0;
/* The solve stops at a residual of 1e-6 of the diagonal, 2 sqrt(3); the smallest eigenvalue is above 0.155. */
static const double octahedron_tolerance = 1e-6 * 3.4642 / 0.155;
