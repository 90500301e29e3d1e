// SPDX-License-Identifier: BSD-3-Clause
#include "opensubdiv_surface.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <stdexcept>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

namespace bench {
namespace {

constexpr float infinitely_sharp = 10.0f;  // Sdc::Crease::SHARPNESS_INFINITE

template <class Real>
struct Point {
    Real x[3];
    void Clear(void* = nullptr) { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(const Point& p, Real weight) {
        for (int c = 0; c < 3; ++c) x[c] += weight * p.x[c];
    }
};

}  // namespace

std::unique_ptr<Far::TopologyRefiner> make_refiner(const SharpMesh& mesh, bool is_loop) {
    const std::vector<float> edge_sharpness(mesh.creases.size(), infinitely_sharp), corner_sharpness(mesh.corners.size(), infinitely_sharp);
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(mesh.points.size() / 3);
    descriptor.numFaces = static_cast<int>(mesh.face_degrees.size());
    descriptor.numVertsPerFace = mesh.face_degrees.data();
    descriptor.vertIndicesPerFace = mesh.face_vertices.data();
    descriptor.numCreases = static_cast<int>(edge_sharpness.size());
    descriptor.creaseVertexIndexPairs = mesh.creases.empty() ? nullptr : mesh.creases[0].data();
    descriptor.creaseWeights = edge_sharpness.data();
    descriptor.numCorners = static_cast<int>(corner_sharpness.size());
    descriptor.cornerVertexIndices = mesh.corners.data();
    descriptor.cornerWeights = corner_sharpness.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(mesh.boundary_edge_only ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(descriptor, Factory::Options(is_loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, options)));
    if (!refiner) throw std::runtime_error("OpenSubdiv refuses the mesh");
    return refiner;
}

template <class Real>
OpenSubdivPatches<Real>::OpenSubdivPatches(const SharpMesh& mesh, const OpenSubdivOptions& options) : refiner_(make_refiner(mesh, options.is_loop)) {
    Far::PatchTableFactory::Options patch_options(static_cast<unsigned>(options.isolation));
    patch_options.SetEndCapType(options.cap);
    patch_options.SetPatchPrecision<Real>();
    patch_options.useInfSharpPatch = true;  // regular patches at boundaries and creases, which need no cap
    patch_options.generateLegacySharpCornerPatches = false;
    patch_options.generateVaryingTables = false;
    refiner_->RefineAdaptive(patch_options.GetRefineAdaptiveOptions());
    table_.reset(Far::PatchTableFactory::Create(*refiner_, patch_options));
    if (!table_) throw std::runtime_error("OpenSubdiv gives no patches");
    map_ = std::make_unique<Far::PatchMap>(*table_);
    faces_ = std::make_unique<Far::PtexIndices>(*refiner_);
}

template <class Real>
std::vector<Real> OpenSubdivPatches<Real>::control_points(const std::vector<double>& points) const {
    const std::size_t refined = static_cast<std::size_t>(refiner_->GetNumVerticesTotal());
    std::vector<Real> out(3 * (refined + static_cast<std::size_t>(table_->GetNumLocalPoints())));
    std::copy(points.begin(), points.end(), out.begin());
    auto* from = reinterpret_cast<Point<Real>*>(out.data());
    const Far::PrimvarRefinerReal<Real> primvar(*refiner_);
    for (int level = 1; level <= refiner_->GetMaxLevel(); ++level) {
        Point<Real>* to = from + refiner_->GetLevel(level - 1).GetNumVertices();
        primvar.Interpolate(level, from, to);
        from = to;
    }
    auto* all = reinterpret_cast<Point<Real>*>(out.data());
    if (table_->GetNumLocalPoints() > 0) table_->template GetLocalPointStencilTable<Real>()->UpdateValues(all, all + refined);
    return out;
}

template <class Real>
Jet OpenSubdivPatches<Real>::evaluate(const std::vector<Real>& control, int face_number, double u, double v, bool* is_regular) const {
    const Handle* patch = find(face_number, u, v);
    if (patch == nullptr) throw std::runtime_error("OpenSubdiv finds no patch in face " + std::to_string(face_number));
    *is_regular = table_->GetPatchParam(*patch).IsRegular();
    Real weights[6][20];
    table_->EvaluateBasis(*patch, static_cast<Real>(u), static_cast<Real>(v), weights[0], weights[1], weights[2], weights[3], weights[4], weights[5]);
    const Far::ConstIndexArray points = table_->GetPatchVertices(*patch);
    Jet jet{};
    for (std::size_t q = 0; q < jet.size(); ++q)
        for (int i = 0; i < points.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) jet[q][c] += static_cast<double>(weights[q][i] * control[3 * static_cast<std::size_t>(points[i]) + c]);
    return jet;
}

template class OpenSubdivPatches<float>;
template class OpenSubdivPatches<double>;

}  // namespace bench
