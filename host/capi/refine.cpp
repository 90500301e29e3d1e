// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/refine.h"

#include <algorithm>
#include <cmath>

#include "host/capi/handles.h"

using namespace lcl;

namespace {

/// Colours and scalar properties are refined as channels; texture coordinates are not.
std::vector<VertexProperty> refined_properties(const std::vector<VertexProperty>& properties, const Stencils& stencils) {
    std::vector<VertexProperty> out;
    for (const VertexProperty& property : properties)
        out.push_back({property.name, property.kind, property.type, apply_stencils(stencils, property.values, 1)});
    return out;
}

void note_dropped(lcl_mesh_s& out, const lcl_mesh_s& mesh) {
    std::vector<std::string>& warnings = out.notes[LCL_NOTE_WARNING];
    if (!mesh.file.uvs.corner_indices.empty()) warnings.push_back("texture coordinates are not refined and were dropped");
    for (const PassThroughLine& line : mesh.file.lines)
        if (line.text.rfind("mtllib", 0) != 0) {
            warnings.push_back("groups and materials are not refined and were dropped");
            return;
        }
}

}  // namespace

std::unique_ptr<lcl_mesh_s> lcl::make_refined_mesh(const lcl_mesh_s& mesh, Refinement&& refined, int levels) {
    auto out = std::make_unique<lcl_mesh_s>();
    out->file.mesh = std::move(refined.mesh);
    out->file.ply_encoding = mesh.file.ply_encoding;
    out->file.ply_position_type = mesh.file.ply_position_type;
    out->boundary = static_cast<lcl_boundary>(static_cast<int>(refined.features.boundary) + 1);
    out->feature_options = std::move(refined.features);
    if (levels > 0) {
        note_dropped(*out, mesh);
    } else {
        out->file.uvs = mesh.file.uvs;
        out->file.lines = mesh.file.lines;
    }
    return out;
}

void lcl::round_integers(std::vector<VertexProperty>& properties) {
    for (VertexProperty& property : properties) {
        if (property.type.rfind("float", 0) == 0 || property.type.rfind("double", 0) == 0) continue;
        for (double& value : property.values) value = std::round(value);
    }
}

extern "C" {

lcl_status lcl_mesh_refine(lcl_mesh mesh, const lcl_scheme_options* scheme, const lcl_refine_options* options, lcl_mesh* refined) {
    return guarded([&] {
        required(refined, "refined");
        required(mesh, "mesh");
        const int levels = std::max(
            0, options_or(options, LCL_REFINE_OPTIONS_INIT, "options").levels == 0 ? 1 : options_or(options, LCL_REFINE_OPTIONS_INIT, "options").levels);
        SchemeOptions rules = scheme_options(*mesh, options_or(scheme, LCL_SCHEME_OPTIONS_INIT, "scheme"));
        const Objection objection = scheme_objection(mesh->topology(), rules);
        if (!objection.message.empty()) throw BadInput(objection.message, {objection.vertices, objection.faces});
        FeatureOptions features = mesh->named_features();
        std::vector<SurfaceLocation> locations;
        auto out = make_refined_mesh(*mesh, refine(mesh->file.mesh, features, rules, levels, &locations), levels);
        out->locations = std::move(locations);
        out->file.properties = mesh->file.properties;
        if (!out->file.properties.empty()) {
            PolygonMesh polygons = mesh->file.mesh;
            for (int level = 0; level < levels; ++level, rules.alpha = rules.lambda = 0, rules.lambda_per_vertex.clear()) {
                const Topology topology = build_topology(polygons);
                Refinement step = refine_once(polygons, topology, find_features(polygons, topology, features), rules);
                out->file.properties = refined_properties(out->file.properties, step.stencils);
                polygons = std::move(step.mesh);
                features = step.features;
            }
            round_integers(out->file.properties);
        }
        *refined = out.release();
        return LCL_OK;
    });
}

lcl_status lcl_mesh_get_locations(lcl_mesh refined, int32_t* faces, int32_t* corners, double* uv) {
    return guarded([&] {
        const std::vector<SurfaceLocation>& locations = required(refined, "refined")->locations;
        if (locations.empty() && refined->file.mesh.vertex_count > 0) throw InvalidArgument("this mesh was not made by lcl_mesh_refine");
        for (std::size_t i = 0; i < locations.size(); ++i) {
            if (faces != nullptr) faces[i] = locations[i].face;
            if (corners != nullptr) corners[i] = locations[i].corner;
            if (uv != nullptr) uv[2 * i] = locations[i].u, uv[2 * i + 1] = locations[i].v;
        }
        return LCL_OK;
    });
}

}  // extern "C"
