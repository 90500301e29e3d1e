// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/limit_system.h"

#include <algorithm>
#include <limits>

#include "host/apply/smoothed_points.h"
#include "host/operator/user_rows.h"
#include "host/parallel.h"

namespace lcl {
namespace {

/// Lowest valence of the smooth vertices, 0 without any.
int find_lowest_valence(const Topology& topology, const Features& features) {
    constexpr int none = std::numeric_limits<int>::max();
    const std::size_t pieces = piece_count(topology.vertex_count);
    std::vector<int> lowest(pieces, none);
    for_each_piece(topology.vertex_count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        int valence = none;
        for (std::size_t v = begin; v < end; ++v)
            if (features.kind[v] == VertexKind::smooth) valence = std::min(valence, topology.vertex_face_count[v]);
        lowest[piece] = valence;
    });
    const int valence = *std::min_element(lowest.begin(), lowest.end());
    return valence == none ? 0 : valence;
}

void find_weakest(const Topology& topology, const Features& features, LimitSystem& system) {
    constexpr std::size_t most = 10;
    system.lowest_valence = find_lowest_valence(topology, features);
    for (Index v = 0; system.lowest_valence > 0 && v < topology.vertex_count && system.weakest.size() < most; ++v)
        if (features.kind[v] == VertexKind::smooth && topology.vertex_face_count[v] == system.lowest_valence) system.weakest.push_back(v);
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
    const LaunchShape shape = launch_shape(context->device(), mesh.vertex_count);
    plan_options.block_rows = shape.block_rows;
    auto system = std::make_unique<LimitSystem>();
    system->scheme = scheme;
    system->diagonal = bounding_box_diagonal(mesh, topology);
    system->singular = find_singular_component(topology, features, scheme, plan_options.subset);
    find_weakest(topology, features, *system);
    auto plan = std::make_shared<const Plan>(build_plan(mesh, topology, features, scheme, plan_options));
    system->A = std::make_unique<DeviceOperator>(std::move(context), std::move(plan), shape);
    return system;
}

std::unique_ptr<LimitSystem> make_rows_system(std::shared_ptr<Context> context, const RowMatrix& rows) {
    const LaunchShape shape = launch_shape(context->device(), rows.count);
    auto system = std::make_unique<LimitSystem>();
    system->origin = Origin::rows;
    system->A = std::make_unique<DeviceOperator>(std::move(context), std::make_shared<const Plan>(build_user_plan(rows, shape.block_rows)), shape);
    check_spectrum(*system);
    return system;
}

std::unique_ptr<LimitSystem> make_feature_system(std::shared_ptr<Context> context, const PolygonMesh& mesh, const Topology& topology, const Features& features,
                                                 const FeatureOperatorOptions& options) {
    const LaunchShape shape = launch_shape(context->device(), mesh.vertex_count);
    auto system = std::make_unique<LimitSystem>();
    system->origin = Origin::features;
    system->diagonal = bounding_box_diagonal(mesh, topology);
    const std::vector<double> points = smoothed_points(mesh, topology, features, options.smoothing);
    auto plan = std::make_shared<const Plan>(build_feature_plan(mesh, topology, features, points, options, shape.block_rows));
    system->A = std::make_unique<DeviceOperator>(std::move(context), std::move(plan), shape);
    return system;
}

void require_scaling(const Plan& plan, const char* what) {
    if (!plan.has_scaling)
        throw InvalidArgument(std::string(what) + " need the scaling D that makes D A symmetric, and this operator was made without: give lcl_rows.scaling");
}

void refuse_ghosts(const Plan& plan) {
    if (plan.row_count < plan.vertex_count)
        throw Unsupported("this operator has rows for " + std::to_string(plan.row_count) + " of its " + std::to_string(plan.vertex_count) +
                          " vertices: drive its parts by single sweeps (lcl_operator_step) and exchange the ghosts between them");
}

}  // namespace lcl
