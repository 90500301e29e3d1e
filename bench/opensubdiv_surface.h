// SPDX-License-Identifier: BSD-3-Clause
// Limit surfaces by OpenSubdiv: adaptive refinement, patches with end caps at what is irregular, and the map that finds them.
#ifndef LIMITCL_BENCH_OPENSUBDIV_SURFACE_H
#define LIMITCL_BENCH_OPENSUBDIV_SURFACE_H

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <array>
#include <memory>
#include <vector>

#include "opensubdiv_limit.h"

namespace bench {

using EndCap = OpenSubdiv::Far::PatchTableFactory::Options::EndCapType;
using Jet = std::array<std::array<double, 3>, 6>;  ///< S, S_u, S_v, S_uu, S_uv, S_vv

struct OpenSubdivOptions {
    bool is_loop = false;
    EndCap cap = EndCap::ENDCAP_GREGORY_BASIS;
    int isolation = 6;  ///< refinements round what is irregular
};

/// The patches of a mesh in float or double. std::runtime_error where OpenSubdiv refuses the mesh.
template <class Real>
class OpenSubdivPatches {
public:
    using Handle = OpenSubdiv::Far::PatchTable::PatchHandle;
    OpenSubdivPatches(const SharpMesh& mesh, const OpenSubdivOptions& options);

    const OpenSubdiv::Far::TopologyRefiner& refiner() const { return *refiner_; }
    const OpenSubdiv::Far::PatchTable& table() const { return *table_; }
    /// The patch that holds (u, v) of a face, or of a face's sub-quad, numbered as OpenSubdiv does; null where there is none.
    const Handle* find(int face, double u, double v) const { return map_->FindPatch(face, u, v); }
    /// OpenSubdiv's number of a face, or of the sub-quad at a corner.
    int face_number(int face, int corner) const { return faces_->GetFaceId(face) + corner; }

    /// Points of all levels and of the end caps, from those of the mesh (vertex_count x 3).
    std::vector<Real> control_points(const std::vector<double>& points) const;
    /// By the weights of the patch's points. is_regular: whether the patch is none of the end caps.
    Jet evaluate(const std::vector<Real>& control, int face_number, double u, double v, bool* is_regular) const;

private:
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_;
    std::unique_ptr<OpenSubdiv::Far::PatchTable> table_;
    std::unique_ptr<OpenSubdiv::Far::PatchMap> map_;
    std::unique_ptr<OpenSubdiv::Far::PtexIndices> faces_;
};

extern template class OpenSubdivPatches<float>;
extern template class OpenSubdivPatches<double>;

/// OpenSubdiv's topology of a mesh without isolated vertices.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> make_refiner(const SharpMesh& mesh, bool is_loop);

}  // namespace bench

#endif
