// SPDX-License-Identifier: BSD-3-Clause
#include "host/mesh/volume.h"

#include <algorithm>
#include <numeric>

#include "host/capi/handles.h"

using namespace lcl;

extern "C" {

lcl_status lcl_mesh_get_volume(lcl_mesh mesh, double* volume) {
    return guarded([&] {
        const Topology& topology = required(mesh, "mesh")->topology();
        const std::vector<double> volumes = component_volumes(mesh->file.mesh, topology, mesh->file.mesh.positions);
        *required(volume, "volume") = std::accumulate(volumes.begin(), volumes.end(), 0.0);
        return LCL_OK;
    });
}

lcl_status lcl_mesh_match_volume(lcl_mesh mesh, const double* points, size_t stride, const int32_t* fixed, size_t fixed_count) {
    return guarded([&] {
        const Topology& topology = required(mesh, "mesh")->topology();
        PolygonMesh& polygons = mesh->file.mesh;
        if (stride == 0) stride = 3;
        if (stride < 3) throw InvalidArgument("stride is " + std::to_string(stride) + ", a point has three values");
        require_finite(required(points, "points"), stride, 3, polygons.vertex_count, "points");
        std::vector<double> before(3 * static_cast<std::size_t>(polygons.vertex_count));
        for (std::size_t v = 0; v < static_cast<std::size_t>(polygons.vertex_count); ++v) std::copy_n(points + v * stride, 3, &before[3 * v]);
        std::vector<std::uint8_t> is_fixed = vertex_marks(fixed, fixed_count, polygons.vertex_count, "fixed");
        is_fixed.resize(polygons.vertex_count, 0);
        const Features& features = mesh->features();
        for (Index v = 0; v < polygons.vertex_count; ++v) is_fixed[v] = is_fixed[v] || features.kind[v] == VertexKind::corner;
        std::vector<double> positions = polygons.positions;
        const std::vector<std::string> notes = match_volumes(polygons, topology, before, is_fixed, positions);
        mesh->keep_features_of_positions();
        polygons.positions = std::move(positions);
        mesh->forget_positions();
        std::vector<std::string>& warnings = mesh->notes[LCL_NOTE_WARNING];
        warnings.insert(warnings.end(), notes.begin(), notes.end());
        return LCL_OK;
    });
}

}  // extern "C"
