// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/capi/handles.h"

using namespace lcl;

namespace lcl {
namespace {

void check_ratio(double value, const std::string& name) {
    if (!(value >= 0 && value <= 1)) throw InvalidArgument(name + " is " + std::to_string(value) + ", it goes from 0 to 1");
}

Scheme resolve(const lcl_mesh_s& mesh, const lcl_scheme_options& options) {
    switch (options.scheme) {
        case LCL_SCHEME_CATMULL_CLARK: return Scheme::catmull_clark;
        case LCL_SCHEME_LOOP: return Scheme::loop;
        case LCL_SCHEME_DOO_SABIN: return Scheme::doo_sabin;
        case LCL_SCHEME_DEFAULT: break;
        default: throw InvalidArgument("options.scheme is " + std::to_string(options.scheme) + ", it goes from 0 to 3");
    }
    for (Index f = 0; f < mesh.file.mesh.face_count(); ++f)
        if (mesh.file.mesh.degree(f) != 3) return Scheme::catmull_clark;
    return Scheme::loop;
}

}  // namespace

SchemeOptions scheme_options(lcl_mesh_s& mesh, const lcl_scheme_options& options) {
    SchemeOptions out;
    out.scheme = resolve(mesh, options);
    if (options.mask != LCL_MASK_CATMULL && options.mask != LCL_MASK_CLASSIC)
        throw InvalidArgument("options.mask is " + std::to_string(options.mask) + ", it is 0 or 1");
    out.mask = options.mask == LCL_MASK_CLASSIC ? DooSabinMask::classic : DooSabinMask::catmull;
    check_ratio(options.alpha, "alpha");
    check_ratio(options.lambda, "lambda");
    const bool two_phase = options.lambda != 0 || options.lambda_per_vertex != nullptr;
    if (out.scheme != Scheme::catmull_clark && (options.alpha != 0 || two_phase))
        throw InvalidArgument(std::string("alpha and lambda belong to Catmull-Clark, and the scheme is ") + scheme_name(out.scheme) +
                              ": leave them out or set the scheme");
    out.alpha = options.alpha;
    out.lambda = options.lambda;
    if (options.lambda_per_vertex == nullptr) return out;
    out.lambda_per_vertex.assign(options.lambda_per_vertex, options.lambda_per_vertex + mesh.file.mesh.vertex_count);
    for (Index v = 0; v < mesh.file.mesh.vertex_count; ++v) check_ratio(out.lambda_per_vertex[v], "lambda of vertex " + std::to_string(v));
    return out;
}

std::unique_ptr<LimitSystem> make_system(lcl_context_s& context, lcl_mesh_s& mesh, const lcl_scheme_options& given) {
    SchemeOptions scheme = scheme_options(mesh, given);
    if (given.alpha_auto != 0 && given.alpha != 0) throw InvalidArgument("alpha is given and alpha_auto is set: choose one");
    PlanOptions plan;
    plan.subset = vertex_marks(given.subset, given.subset_count, mesh.file.mesh.vertex_count, "subset");
    plan.owned = vertex_marks(given.owned, given.owned_count, mesh.file.mesh.vertex_count, "owned");
    const auto make = [&] { return make_limit_system(context.context, mesh.file.mesh, mesh.topology(), mesh.features(), scheme, plan); };
    if (given.alpha_auto == 0) return make();
    auto system = make_with_auto_alpha(scheme, make);
    if (scheme.alpha != 0) context.write_log(LCL_LOG_INFO, "alpha 0.5, since 0 is singular, indefinite or nearly so on this mesh");
    return system;
}

void require_finite(double value, Index v, int channel, const char* name) {
    if (std::isfinite(value)) return;
    const std::string shown = std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
    throw BadInput(std::string(name) + " of vertex " + std::to_string(v) + " is " + shown + " in channel " + std::to_string(channel) + ": correct the value",
                   {{v}, {}});
}

template <class Real>
void require_finite(const Real* values, std::size_t stride, int channels, std::size_t rows, const char* name) {
    for (std::size_t v = 0; v < rows; ++v)
        for (int c = 0; c < channels; ++c) require_finite(values[v * stride + c], static_cast<Index>(v), c, name);
}

template void require_finite(const float*, std::size_t, int, std::size_t, const char*);
template void require_finite(const double*, std::size_t, int, std::size_t, const char*);

std::vector<std::uint8_t> vertex_marks(const int32_t* vertices, std::size_t count, Index vertex_count, const char* name) {
    if (count > 0) required(vertices, name);
    if (vertices == nullptr) return {};
    std::vector<std::uint8_t> marks(vertex_count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        if (vertices[i] < 0 || vertices[i] >= vertex_count)
            throw InvalidArgument(std::string(name) + " names vertex " + std::to_string(vertices[i]) + ", the mesh has " + std::to_string(vertex_count),
                                  {{vertices[i]}, {}});
        marks[vertices[i]] = 1;
    }
    return marks;
}

}  // namespace lcl

extern "C" {

lcl_status lcl_operator_create(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* options, lcl_operator* A) {
    return guarded([&] {
        required(A, "A");
        required(context, "context");
        required(mesh, "mesh");
        auto handle = std::make_unique<lcl_operator_s>();
        handle->context = share(context);
        handle->system = make_system(*context, *mesh, options_or(options, LCL_SCHEME_OPTIONS_INIT, "options"));
        *A = handle.release();
        return LCL_OK;
    });
}

void lcl_operator_retain(lcl_operator A) { retain(A); }
void lcl_operator_release(lcl_operator A) { release(A); }
int32_t lcl_operator_vertex_count(lcl_operator A) { return A ? A->system->plan().vertex_count : 0; }
int32_t lcl_operator_row_count(lcl_operator A) { return A ? A->system->plan().row_count : 0; }
int32_t lcl_operator_block_count(lcl_operator A) { return A ? static_cast<int32_t>(A->system->plan().blocks.size()) : 0; }

lcl_status lcl_operator_get_scheme(lcl_operator A, lcl_scheme_options* options) {
    return guarded([&] {
        const LimitSystem& system = *required(A, "A")->system;
        const SchemeOptions& scheme = system.scheme;
        lcl_scheme_options out = LCL_SCHEME_OPTIONS_INIT;
        if (system.origin == Origin::scheme) out.scheme = static_cast<lcl_scheme>(static_cast<int>(scheme.scheme) + 1);
        out.mask = scheme.mask == DooSabinMask::classic ? LCL_MASK_CLASSIC : LCL_MASK_CATMULL;
        out.alpha = scheme.alpha;
        out.lambda = scheme.lambda;
        give(options, out, "options");
        return LCL_OK;
    });
}

lcl_status lcl_operator_get_row(lcl_operator A, int32_t vertex, int32_t* columns, double* weights, size_t capacity, size_t* size) {
    return guarded([&] {
        const Plan& plan = required(A, "A")->system->plan();
        if (vertex < 0 || vertex >= plan.vertex_count)
            throw InvalidArgument("row " + std::to_string(vertex) + " was asked for, the operator has " + std::to_string(plan.vertex_count) + " vertices");
        const Index row = plan.row_of_vertex[vertex];
        if (row >= plan.row_count) throw InvalidArgument("vertex " + std::to_string(vertex) + " is a ghost: it has no row in this part");
        const LimitRow entries = plan_row(plan, run_of_row(plan, row), row);
        std::map<Index, double> sums;  // a vertex that is met several times gets one entry
        for (std::size_t i = 0; i < entries.columns.size(); ++i) sums[plan.vertex_of_row[entries.columns[i]]] += entries.weights[i];
        if (size != nullptr) *size = sums.size();
        std::size_t place = 0;
        for (const auto& [column, weight] : sums) {
            if (place == capacity) break;
            if (columns != nullptr) columns[place] = column;
            if (weights != nullptr) weights[place] = weight;
            ++place;
        }
        return LCL_OK;
    });
}

lcl_status lcl_operator_diagnose(lcl_operator A, lcl_diagnosis* diagnosis) {
    return guarded([&] {
        const Spectrum& spectrum = spectrum_of(*required(A, "A")->system);
        lcl_diagnosis out = LCL_DIAGNOSIS_INIT;
        out.lambda_min_bound = spectrum.bound;
        out.lambda_min_estimate = spectrum.estimate;
        out.singular = spectrum.singular;
        out.indefinite = spectrum.indefinite;
        copy_text(out.reason, spectrum.message.empty() ? spectrum.warning : spectrum.message);
        out.vertex_count = copy_first(out.vertices, spectrum.vertices);
        give(diagnosis, out, "diagnosis");
        return LCL_OK;
    });
}

lcl_status lcl_operator_inverse_norm(lcl_operator A, double* norm, int32_t* proven) {
    return guarded([&] {
        const InverseNorm& inverse = inverse_norm_of(*required(A, "A")->system);
        *required(norm, "norm") = inverse.value;
        if (proven != nullptr) *proven = inverse.proven;
        return LCL_OK;
    });
}

lcl_status lcl_mesh_check_scheme(lcl_mesh mesh, const lcl_scheme_options* options, lcl_suitability* suitability) {
    return guarded([&] {
        const lcl_scheme_options given = options_or(options, LCL_SCHEME_OPTIONS_INIT, "options");
        const SchemeOptions scheme = scheme_options(*required(mesh, "mesh"), given);
        const std::vector<std::uint8_t> subset = vertex_marks(given.subset, given.subset_count, mesh->file.mesh.vertex_count, "subset");
        lcl_suitability out = LCL_SUITABILITY_INIT;
        Objection objection;
        try {
            objection = scheme_objection(mesh->topology(), scheme);
            out.suitable = objection.message.empty();
            if (out.suitable) objection = find_singular_component(mesh->topology(), mesh->features(), scheme, subset);
            out.singular = out.suitable && !objection.message.empty();
        } catch (const BadInput& unsound) {
            objection = {unsound.what(), unsound.where.vertices, unsound.where.faces};
        }
        copy_text(out.reason, objection.message);
        out.vertex_count = copy_first(out.vertices, objection.vertices);
        give(suitability, out, "suitability");
        return LCL_OK;
    });
}

}  // extern "C"
