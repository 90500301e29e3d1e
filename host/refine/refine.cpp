// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/refine.h"

#include <optional>
#include <utility>

#include "host/refine/refiner.h"
#include "host/refine/size.h"
#include "host/refine/steps.h"

namespace lcl {
namespace {

/// Level 0: the features as the original mesh has them, with the creases of the angle named.
FeatureOptions named_features(const Topology& topology, const Features& features, const FeatureOptions& options) {
    FeatureOptions named{options.boundary, {}, options.corners, -1};
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index h = topology.edge_half_edge[e];
        if (features.edge_is_sharp[e] && topology.twin[h] >= 0) named.creases.push_back({topology.origin(h), topology.destination(h)});
    }
    return named;
}

Refinement unrefined(const PolygonMesh& mesh, const Topology& topology, const Features& features, const FeatureOptions& options) {
    Refinement copy;
    copy.mesh = mesh;
    copy.features = named_features(topology, features, options);
    copy.face_parent.resize(mesh.face_count());
    for (Index f = 0; f < mesh.face_count(); ++f) copy.face_parent[f] = f;
    return copy;
}

}  // namespace

Refinement refine_once(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options) {
    const StepInput input{topology, features, options};
    check_options(input);
    const std::optional<DooSabinLayout> layout = layout_of(input);
    check_levels_fit(count(input, pointer_to(layout)), options, 1);
    check_stencils_fit(topology);
    Child child = make_child(input, pointer_to(layout), TopologyPart::faces);
    Refinement refined;
    copy_faces(child.topology, refined.mesh);
    refined.features = step_features(input, pointer_to(layout));
    refined.face_parent = child_parents(topology, options.scheme, std::move(child.face_parent));
    StencilRows rows(topology, refined.mesh.vertex_count);
    write_all_rows(input, pointer_to(layout), rows);
    refined.stencils = rows.take();
    refined.mesh.positions = apply_stencils(refined.stencils, mesh.positions, 3);
    return refined;
}

Refinement refine(const PolygonMesh& mesh, const FeatureOptions& feature_options, const SchemeOptions& options, int levels,
                  std::vector<SurfaceLocation>* locations) {
    check_levels(levels);
    Topology topology = build_topology(mesh);
    Features features = find_features(mesh, topology, feature_options);
    Refinement refined;
    if (levels == 0) refined = unrefined(mesh, topology, features, feature_options);
    const Refiner refiner(std::move(topology), std::move(features), options, levels);
    if (levels > 0) refined = refined_mesh(refiner, mesh.positions.data(), 3);
    if (locations) *locations = refiner.locations();
    return refined;
}

RefinedSize refined_size(const Topology& topology, const Features& features, const SchemeOptions& options, int levels) {
    const StepInput input{topology, features, options};
    check_options(input);
    const std::optional<DooSabinLayout> layout = layout_of(input);
    const MeshCounts counts = check_levels_fit(count(input, pointer_to(layout)), options, levels);
    return {counts.vertices, counts.edges, counts.faces, counts.corners};
}

std::vector<double> apply_stencils(const Stencils& stencils, const std::vector<double>& points, int channels) {
    const std::size_t rows = stencils.offsets.size() - 1, c = static_cast<std::size_t>(channels);
    std::vector<double> out(rows * c, 0.0);
    for (std::size_t i = 0; i < rows; ++i) {
        double* result = &out[i * c];
        for (std::size_t j = stencils.offsets[i]; j < stencils.offsets[i + 1]; ++j) {
            const double weight = stencils.weights[j];
            const double* point = &points[static_cast<std::size_t>(stencils.indices[j]) * c];
            for (std::size_t k = 0; k < c; ++k) result[k] += weight * point[k];
        }
    }
    return out;
}

}  // namespace lcl
