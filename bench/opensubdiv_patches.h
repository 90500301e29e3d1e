// SPDX-License-Identifier: BSD-3-Clause
// limitcl's limit surfaces against OpenSubdiv's patches.
#ifndef LIMITCL_BENCH_OPENSUBDIV_PATCHES_H
#define LIMITCL_BENCH_OPENSUBDIV_PATCHES_H

#include <limitcl/limitcl.hpp>

#include "opensubdiv_limit.h"

namespace bench {

/// Largest differences at places in OpenSubdiv's regular patches, where both are exact; all relative to the diagonal (a derivative by u or v is a length).
struct PatchErrors {
    int places = 0, irregular = 0;                                  ///< compared; left out since they lie in end caps
    double points = 0, first = 0, second = 0;                       ///< both in double
    double single_points = 0, single_first = 0, single_second = 0;  ///< both in float
};

/// mesh: the vertices, faces and features of `surface_of`, with other points, which both take.
PatchErrors compare_patches(const limitcl::Mesh& surface_of, const SharpMesh& mesh, bool is_loop);

/// Prints a table: how far OpenSubdiv's end caps are from the limit surface in the faces round one extraordinary vertex whose edges are about 1 long: largest
/// distance from the surface, angle of the normals there, and distance from the surface's point at the same (u, v).
void print_end_caps();

}  // namespace bench

#endif
