// SPDX-License-Identifier: BSD-3-Clause
// The mesh that is simplified and refined while a surface is fitted: OpenMesh triangles that know which point of the cloud each vertex is.
#pragma once

#include <vector>

#include <OpenMesh/Core/Geometry/VectorT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "host/mesh/polygon_mesh.h"

namespace lcl {

struct FitMeshTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexTraits { Index source = -1; };  ///< of the cloud; -1: no point of it
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
};
using FitMesh = OpenMesh::TriMesh_ArrayKernelT<FitMeshTraits>;

/// source: vertex_count, or empty: all -1. The mesh has to be sound.
FitMesh fit_mesh(const PolygonMesh& mesh, const std::vector<Index>& source);
/// Vertices and faces keep their numbers; nothing may be marked as deleted.
PolygonMesh polygon_mesh(const FitMesh& mesh);

}  // namespace lcl
