// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "host/capi/arguments.h"

using namespace lcl;

namespace {

TangentPlan plan_tangents(lcl_operator A, lcl_mesh mesh) {
    const LimitSystem& system = *required(A, "A")->system;
    required(mesh, "mesh");
    if (system.origin != Origin::scheme) throw InvalidArgument("this operator is of no subdivision scheme: only limit operators have limit normals");
    return build_tangent_plan(system.plan(), mesh->topology(), mesh->features(), system.scheme);
}

void check_positions(lcl_field x) {
    if (x->field.channels() != 3) throw InvalidArgument("x has " + std::to_string(x->field.channels()) + " channels, normals are those of points: give three");
    const Transform& transform = transform_of(x, "x");
    if (transform.scale[0] != transform.scale[1] || transform.scale[0] != transform.scale[2])
        throw InvalidArgument("the channels of x are scaled each in its own way, so that they are no points: upload points");
}

void check_distinct(std::initializer_list<lcl_field> fields) {
    for (auto a = fields.begin(); a != fields.end(); ++a)
        if (*a != nullptr && std::find(a + 1, fields.end(), *a) != fields.end()) throw InvalidArgument("one field was given twice: x and all results differ");
}

std::size_t stride_of(std::size_t stride, const char* name) {
    if (stride == 0) return 3;
    check_channels(3, stride, name);
    return stride;
}

}  // namespace

extern "C" {

lcl_status lcl_tangents_create(lcl_operator A, lcl_mesh mesh, lcl_tangents* tangents) {
    return guarded([&] {
        required(tangents, "tangents");
        *tangents = new lcl_tangents_s(A, plan_tangents(A, mesh));
        return LCL_OK;
    });
}

void lcl_tangents_retain(lcl_tangents tangents) { retain(tangents); }
void lcl_tangents_release(lcl_tangents tangents) { release(tangents); }
int32_t lcl_tangents_side_count(lcl_tangents tangents) { return tangents ? tangents->tangents.plan().side_count() : 0; }

lcl_status lcl_tangents_apply(lcl_tangents tangents, lcl_field x, lcl_field limit, lcl_field normals, lcl_field tangent, lcl_field bitangent) {
    return guarded([&] {
        lcl_operator A = required(tangents, "tangents")->A.get();
        check_same_operator(A, {required(x, "x"), limit, required(normals, "normals"), tangent, bitangent});
        check_distinct({x, limit, normals, tangent, bitangent});
        if ((tangent == nullptr) != (bitangent == nullptr)) throw InvalidArgument("tangent and bitangent go together: give both or neither");
        check_positions(x);
        const bool writes_all = A->system->plan().row_count == A->system->plan().vertex_count;
        if (limit != nullptr) set_transform(limit, transform_of(x, "x"), writes_all);
        for (const lcl_field direction : {normals, tangent, bitangent})
            if (direction != nullptr) set_transform(direction, unscaled(3), writes_all);
        Field* const y = limit != nullptr ? &limit->field : nullptr;
        if (tangent == nullptr) {
            tangents->tangents.normals(x->field, y, normals->field);
        } else {
            if (y != nullptr) A->system->A->limit_points(x->field, *y, A->system->plan().all_rows());
            tangents->tangents.frames(x->field, normals->field, tangent->field, bitangent->field);
        }
        tangents->is_applied = true;
        return LCL_OK;
    });
}

lcl_status lcl_tangents_get_sides(lcl_tangents tangents, int32_t* vertices, int32_t* faces, double* normals) {
    return guarded([&] {
        const TangentPlan& plan = required(tangents, "tangents")->tangents.plan();
        if (vertices != nullptr) std::copy(plan.side_vertices.begin(), plan.side_vertices.end(), vertices);
        if (faces != nullptr) std::copy(plan.side_faces.begin(), plan.side_faces.end(), faces);
        if (normals == nullptr) return LCL_OK;
        if (!tangents->is_applied) throw InvalidArgument("there are no normals yet: call lcl_tangents_apply before");
        const std::vector<double> found = tangents->tangents.read_sides();
        std::copy(found.begin(), found.end(), normals);
        return LCL_OK;
    });
}

lcl_status lcl_limit_normals(lcl_operator A, lcl_mesh mesh, const double* points, size_t stride, lcl_precision precision, double* limit_points,
                             size_t limit_stride, double* normals, size_t normal_stride) {
    return guarded([&] {
        const Precision inner = inner_precision(precision);
        stride = points == nullptr ? 3 : stride_of(stride, "stride");
        limit_stride = stride_of(limit_stride, "limit_stride");
        normal_stride = stride_of(normal_stride, "normal_stride");
        required(normals, "normals");
        DeviceTangents tangents(*required(A, "A")->system->A, plan_tangents(A, mesh));
        if (points == nullptr) points = mesh->file.mesh.positions.data();
        limit_normals(*A->system->A, tangents, points, stride, inner, limit_points, limit_stride, normals, normal_stride);
        return LCL_OK;
    });
}

}  // extern "C"
