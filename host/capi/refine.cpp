// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/refine.h"

#include <algorithm>
#include <cmath>

#include "host/capi/arguments.h"
#include "host/capi/handles.h"

using namespace lcl;

namespace {

constexpr std::int64_t device_row_bytes = 16;  // of a field of floats, the least that the device has to hold at once

int levels_of(const lcl_refine_options* options) {
    const int32_t levels = options_or(options, LCL_REFINE_OPTIONS_INIT, "options").levels;
    return levels == 0 ? 1 : std::max(0, levels);
}

/// Colours and scalar properties are refined as channels, all at once; texture coordinates are not.
std::vector<VertexProperty> refined_properties(const std::vector<VertexProperty>& properties, const Refiner& refiner) {
    const std::size_t count = properties.size(), rows = refiner.control_count(), refined_rows = refiner.vertex_count();
    std::vector<VertexProperty> out;
    Array<double> values(rows * count), refined(refined_rows * count);
    for (std::size_t p = 0; p < count; ++p)
        for (std::size_t v = 0; v < rows; ++v) values[v * count + p] = properties[p].values[v];
    refiner.apply(values.data(), count, static_cast<int>(count), refined.data(), count);
    for (std::size_t p = 0; p < count; ++p) {
        out.push_back({properties[p].name, properties[p].kind, properties[p].type, std::vector<double>(refined_rows)});
        for (std::size_t v = 0; v < refined_rows; ++v) out[p].values[v] = refined[v * count + p];
    }
    round_integers(out);
    return out;
}

/// The scheme of the options, which fits the mesh.
SchemeOptions rules_of(lcl_mesh_s& mesh, const lcl_scheme_options* scheme) {
    SchemeOptions rules = scheme_options(mesh, options_or(scheme, LCL_SCHEME_OPTIONS_INIT, "scheme"));
    const Objection objection = scheme_objection(mesh.topology(), rules);
    if (!objection.message.empty()) throw BadInput(objection.message, {objection.vertices, objection.faces});
    return rules;
}

std::shared_ptr<const Refiner> make_refiner(lcl_mesh_s& mesh, const SchemeOptions& rules, int levels) {
    return std::make_shared<const Refiner>(mesh.topology(), mesh.features(), rules, levels);
}

std::unique_ptr<lcl_mesh_s> refined_handle(lcl_mesh_s& mesh, const std::shared_ptr<const Refiner>& refiner) {
    mesh.topology();  // refuses points that are not finite, as they are now
    const PolygonMesh& polygons = mesh.file.mesh;
    const int levels = refiner->levels();
    Refinement refined = levels > 0 ? refined_mesh(*refiner, polygons.positions.data(), 3) : refine(polygons, mesh.named_features(), refiner->options(), 0);
    auto out = make_refined_mesh(mesh, std::move(refined), levels);
    out->locations = std::make_shared<RefinedLocations>(refiner);
    out->file.properties = levels > 0 && !mesh.file.properties.empty() ? refined_properties(mesh.file.properties, *refiner) : mesh.file.properties;
    return out;
}

void check_device_holds(const Context& context, const RefinedSize& size) {
    const std::int64_t bytes = device_row_bytes * size.vertices;
    const auto most = static_cast<std::int64_t>(context.device().max_allocation_bytes);
    if (bytes > most)
        throw OutOfMemory("the refined mesh would have " + std::to_string(size.vertices) + " vertices and take " + std::to_string(bytes) +
                          " bytes in one piece on " + context.device().name + ", which gives at most " + std::to_string(most) + ": use fewer levels");
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
        const int levels = levels_of(options);
        const SchemeOptions rules = rules_of(*mesh, scheme);
        *refined = refined_handle(*mesh, make_refiner(*mesh, rules, levels)).release();
        return LCL_OK;
    });
}

lcl_status lcl_mesh_get_locations(lcl_mesh refined, int32_t* faces, int32_t* corners, double* uv) {
    return guarded([&] {
        if (!required(refined, "refined")->locations) throw InvalidArgument("this mesh was not made by lcl_mesh_refine");
        const std::vector<SurfaceLocation>& locations = refined->locations->get();
        for (std::size_t i = 0; i < locations.size(); ++i) {
            if (faces != nullptr) faces[i] = locations[i].face;
            if (corners != nullptr) corners[i] = locations[i].corner;
            if (uv != nullptr) uv[2 * i] = locations[i].u, uv[2 * i + 1] = locations[i].v;
        }
        return LCL_OK;
    });
}

lcl_status lcl_refiner_create(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* scheme, const lcl_refine_options* options, lcl_refiner* refiner) {
    return guarded([&] {
        required(refiner, "refiner");
        required(mesh, "mesh");
        const int levels = levels_of(options);
        const SchemeOptions rules = rules_of(*mesh, scheme);
        if (context) check_device_holds(*context->context, refined_size(mesh->topology(), mesh->features(), rules, levels));
        auto out = std::make_unique<lcl_refiner_s>();
        out->mesh = share(mesh);
        out->context = share(context);
        out->refiner = make_refiner(*mesh, rules, levels);
        if (context) out->on_device = std::make_unique<DeviceRefiner>(context->context, out->refiner);
        *refiner = out.release();
        return LCL_OK;
    });
}

void lcl_refiner_retain(lcl_refiner refiner) { retain(refiner); }
void lcl_refiner_release(lcl_refiner refiner) { release(refiner); }

int32_t lcl_refiner_vertex_count(lcl_refiner refiner) { return refiner ? refiner->refiner->vertex_count() : 0; }

lcl_status lcl_refiner_get_mesh(lcl_refiner refiner, lcl_mesh* refined) {
    return guarded([&] {
        required(refined, "refined");
        required(refiner, "refiner");
        *refined = refined_handle(*refiner->mesh, refiner->refiner).release();
        return LCL_OK;
    });
}

lcl_status lcl_refiner_apply(lcl_refiner refiner, const double* values, size_t stride, int32_t channels, lcl_precision precision, double* out,
                             size_t out_stride) {
    return guarded([&] {
        const Refiner& inner = *required(refiner, "refiner")->refiner;
        required(values, "values");
        required(out, "out");
        if (stride == 0) stride = static_cast<std::size_t>(channels);
        if (out_stride == 0) out_stride = static_cast<std::size_t>(channels);
        check_channels(channels, stride, "stride");
        check_channels(channels, out_stride, "out_stride");
        const Real real = real_of(inner_precision(precision));
        require_finite(values, stride, channels, inner.control_count(), "values");
        if (refiner->on_device) refiner->on_device->apply(values, stride, channels, real, out, out_stride);
        else inner.apply(values, stride, channels, out, out_stride);
        return LCL_OK;
    });
}

}  // extern "C"
