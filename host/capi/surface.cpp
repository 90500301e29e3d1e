// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "host/capi/arguments.h"
#include "host/capi/surface_handle.h"

using namespace lcl;

namespace {

PatchTable table_of(lcl_mesh_s& mesh, const lcl_scheme_options& options) {
    const SchemeOptions scheme = scheme_options(mesh, options);
    if (scheme.is_two_phase())
        throw InvalidArgument("lambda is given: a two-phase surface is evaluated through its refined control mesh M^1, which is read with lambda 0");
    if (options.alpha_auto != 0) throw InvalidArgument("alpha_auto is set: give the alpha that lcl_operator_get_scheme names");
    if (options.subset != nullptr || options.owned != nullptr) throw InvalidArgument("subset and owned belong to operators: leave them out");
    const Objection objection = scheme_objection(mesh.topology(), scheme);
    if (!objection.message.empty()) throw BadInput(objection.message, {objection.vertices, objection.faces});
    return build_patch_table(mesh.topology(), mesh.features(), scheme);
}

Places places_of(size_t count, const int32_t* faces, const int32_t* corners, const double* uv) {
    if (count > 0) required(faces, "faces"), required(uv, "uv");
    return {count, faces, corners, uv};
}

SurfaceValues values_of(const lcl_surface_values* given) {
    required(given, "values");
    const lcl_surface_values values = options_or(given, LCL_SURFACE_VALUES_INIT, "values");
    if (values.type != LCL_TYPE_DOUBLE && values.type != LCL_TYPE_FLOAT)
        throw InvalidArgument("values.type is " + std::to_string(values.type) + ", it is 0 or 1");
    return {values.type == LCL_TYPE_FLOAT, values.points, values.du, values.dv, values.normals, values.duu, values.duv, values.dvv, values.gauss, values.mean};
}

/// Farther away than this many times the surface's size no digit of its shape is left in a distance.
constexpr double farthest = 1e12;

void check_point(const DeviceSurface& surface, const double* point, std::size_t i) {
    for (std::size_t c = 0; c < 3; ++c) {
        if (!std::isfinite(point[c])) throw BadInput("point " + std::to_string(i) + " is not finite: correct or remove it");
        if (!(std::fabs(point[c] - surface.centre()[c]) <= farthest * surface.size()))
            throw BadInput("point " + std::to_string(i) + " is more than 1e12 times as far away as the surface is large: correct or remove it");
    }
}

/// body(first, count) for one piece after the other.
template <class Body>
void for_each_sample_piece(std::size_t count, const Body& body) {
    for (std::size_t first = 0; first < count; first += DeviceSurface::piece_samples) body(first, std::min(DeviceSurface::piece_samples, count - first));
}

}  // namespace

extern "C" {

lcl_status lcl_limit_surface_create(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* scheme, lcl_precision precision, lcl_limit_surface* surface) {
    return guarded([&] {
        required(surface, "surface");
        required(context, "context");
        required(mesh, "mesh");
        const Precision asked = inner_precision(precision);
        const bool is_double = asked == Precision::full || (asked == Precision::mixed && context->context->device().has_double);
        const Real real = is_double ? Real::full : Real::single;
        auto out = std::make_unique<lcl_limit_surface_s>(
            context, DeviceSurface(context->context, table_of(*mesh, options_or(scheme, LCL_SCHEME_OPTIONS_INIT, "scheme")), real));
        out->surface.set_points(mesh->file.mesh.positions.data(), 3);
        *surface = out.release();
        return LCL_OK;
    });
}

void lcl_limit_surface_retain(lcl_limit_surface surface) { retain(surface); }
void lcl_limit_surface_release(lcl_limit_surface surface) { release(surface); }

lcl_status lcl_limit_surface_set_points(lcl_limit_surface surface, const double* points, size_t stride) {
    return guarded([&] {
        required(surface, "surface");
        if (stride != 0) check_channels(3, stride, "stride");
        required(points, "points");
        surface->search.reset();
        surface->surface.set_points(points, stride == 0 ? 3 : stride);
        return LCL_OK;
    });
}

lcl_status lcl_samples_create(lcl_limit_surface surface, size_t count, const int32_t* faces, const int32_t* corners, const double* uv, lcl_samples* samples) {
    return guarded([&] {
        required(samples, "samples");
        required(surface, "surface");
        const Places places = places_of(count, faces, corners, uv);
        surface->surface.prepare_for(count);
        auto out = std::make_unique<lcl_samples_s>(surface);
        for_each_sample_piece(count, [&](std::size_t first, std::size_t piece) { out->pieces.push_back(surface->surface.make_samples(places, first, piece)); });
        *samples = out.release();
        return LCL_OK;
    });
}

void lcl_samples_retain(lcl_samples samples) { retain(samples); }
void lcl_samples_release(lcl_samples samples) { release(samples); }

lcl_status lcl_samples_evaluate(lcl_samples samples, const lcl_surface_values* values) {
    return guarded([&] {
        required(samples, "samples");
        const SurfaceValues to = values_of(values);
        for (const SamplePiece& piece : samples->pieces) samples->surface->surface.evaluate(piece, to);
        return LCL_OK;
    });
}

lcl_status lcl_limit_surface_evaluate(lcl_limit_surface surface, size_t count, const int32_t* faces, const int32_t* corners, const double* uv,
                                      const lcl_surface_values* values) {
    return guarded([&] {
        required(surface, "surface");
        const Places places = places_of(count, faces, corners, uv);
        const SurfaceValues to = values_of(values);
        surface->surface.prepare_for(count);
        SamplePiece samples;
        for_each_sample_piece(count, [&](std::size_t first, std::size_t piece) {
            surface->surface.make_samples(places, first, piece, samples);
            surface->surface.evaluate(samples, to);
        });
        return LCL_OK;
    });
}

lcl_status lcl_limit_surface_closest(lcl_limit_surface surface, size_t count, const double* points, size_t stride, const lcl_closest_points* closest) {
    return guarded([&] {
        required(surface, "surface");
        const lcl_closest_points to = options_or(required(closest, "closest"), LCL_CLOSEST_POINTS_INIT, "closest");
        if (count == 0) return LCL_OK;
        required(points, "points");
        if (stride != 0) check_channels(3, stride, "stride");
        const std::size_t step = stride == 0 ? 3 : stride;
        for (std::size_t i = 0; i < count; ++i) check_point(surface->surface, points + i * step, i);
        if (!surface->search) surface->search = std::make_unique<ClosestSearch>(surface->surface);
        surface->search->find(points, step, count, {to.faces, to.corners, to.uv, to.points, to.normals, to.distances});
        return LCL_OK;
    });
}

}  // extern "C"
