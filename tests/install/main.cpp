// SPDX-License-Identifier: BSD-3-Clause
// Uses the installed library from C++.
#include <limitcl/limitcl.hpp>

#include <cmath>
#include <iostream>
#include <vector>

#include "octahedron.h"

int main() {
    const std::vector<double> M(octahedron_points, octahedron_points + 18);
    const limitcl::Context context;
    const limitcl::Mesh mesh = limitcl::Mesh::from_uniform_faces(M, 3, octahedron_faces);
    const limitcl::LimitOperator A(context, mesh);
    const limitcl::Interpolation result = limitcl::interpolate(A, M);
    result.report.require_ok();
    double largest = 0;
    for (int i = 0; i < 18; ++i) largest = std::fmax(largest, std::fabs(result.points[i] - octahedron_control_scale * M[i]));
    std::cout << "limitcl from C++: control points right to " << largest << '\n';
    return largest <= octahedron_tolerance ? 0 : 1;
}
