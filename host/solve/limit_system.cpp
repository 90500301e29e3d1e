// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/limit_system.h"

namespace lcl {
namespace {

void find_weakest(const Topology& topology, const Features& features, LimitSystem& system) {
    for (Index v = 0; v < topology.vertex_count; ++v) {
        const int n = topology.vertex_face_count[v];
        if (features.kind[v] != VertexKind::smooth || (system.lowest_valence > 0 && n > system.lowest_valence)) continue;
        if (n != system.lowest_valence) system.weakest.clear();
        system.lowest_valence = n;
        if (system.weakest.size() < 10) system.weakest.push_back(v);
    }
}

}  // namespace

Field& LimitSystem::work_field(Purpose purpose, int channels, Real real) {
    const auto key = std::make_tuple(purpose, channels, real);
    const auto found = work_fields.find(key);
    return found != work_fields.end() ? found->second : work_fields.emplace(key, A->make_field(channels, real)).first->second;
}

std::unique_ptr<LimitSystem> make_limit_system(std::shared_ptr<Context> context, const PolygonMesh& mesh, const Topology& topology, const Features& features,
                                               const SchemeOptions& scheme, PlanOptions plan_options) {
    const Objection objection = scheme_objection(topology, scheme);
    if (!objection.message.empty()) throw BadInput(objection.message, {objection.vertices, objection.faces});
    const LaunchShape shape = launch_shape(context->device());
    plan_options.block_rows = shape.block_rows;
    auto system = std::make_unique<LimitSystem>();
    system->scheme = scheme;
    system->diagonal = bounding_box_diagonal(mesh);
    system->singular = find_singular_component(topology, features, scheme, plan_options.subset);
    find_weakest(topology, features, *system);
    auto plan = std::make_shared<const Plan>(build_plan(mesh, topology, features, scheme, plan_options));
    system->A = std::make_unique<DeviceOperator>(std::move(context), std::move(plan), shape);
    return system;
}

}  // namespace lcl
