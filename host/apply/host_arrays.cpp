// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/host_arrays.h"

#include <algorithm>

#include "host/field/host_rows.h"

namespace lcl {

Real real_of(Precision precision) { return precision == Precision::mixed ? Real::wide : precision == Precision::single ? Real::single : Real::full; }

std::vector<double> kept_rows(const Plan& plan, const double* values, std::size_t stride, int channels) {
    std::vector<double> kept;
    kept.reserve(static_cast<std::size_t>(plan.fixed.row_count) * channels);
    for (Index row = 0; row < plan.fixed.end_row(); ++row) {
        const double* value = values + plan.vertex_of_row[row] * stride;
        kept.insert(kept.end(), value, value + channels);
    }
    return kept;
}

void restore_rows(const Plan& plan, const std::vector<double>& kept, int channels, double* values, std::size_t stride) {
    for (Index row = 0; row < plan.fixed.end_row(); ++row)
        std::copy_n(&kept[static_cast<std::size_t>(row) * channels], channels, values + plan.vertex_of_row[row] * stride);
}

void limit_points(DeviceOperator& A, const double* points, std::size_t stride, int channels, Precision precision, double* out, std::size_t out_stride) {
    const Plan& plan = A.plan();
    const Transform transform = fit_transform(plan, points, stride, channels);
    Field x = A.make_field(channels, real_of(precision)), y = A.make_field(channels, real_of(precision));
    upload_rows(plan, transform, {points, stride}, x);
    if (plan.row_count < plan.vertex_count) y.copy_from(x);
    A.limit_points(x, y, plan.all_rows());
    const std::vector<double> kept = kept_rows(plan, points, stride, channels);
    download_rows(plan, transform, y, {out, out_stride});
    restore_rows(plan, kept, channels, out, out_stride);
}

void limit_normals(DeviceOperator& A, DeviceTangents& tangents, const double* points, std::size_t stride, Precision precision, double* out,
                   std::size_t out_stride, double* normals, std::size_t normal_stride) {
    constexpr int channels = 3;
    const Plan& plan = A.plan();
    const Transform transform = fit_transform(plan, points, stride, channels);
    Field x = A.make_field(channels, real_of(precision)), n = A.make_field(channels, real_of(precision));
    upload_rows(plan, transform, {points, stride}, x);
    n.fill_zero();
    if (out == nullptr) {
        tangents.normals(x, nullptr, n);
    } else {
        Field y = A.make_field(channels, real_of(precision));
        if (plan.row_count < plan.vertex_count) y.copy_from(x);
        tangents.normals(x, &y, n);
        const std::vector<double> kept = kept_rows(plan, points, stride, channels);
        download_rows(plan, transform, y, {out, out_stride});
        restore_rows(plan, kept, channels, out, out_stride);
    }
    download_rows(plan, unscaled(channels), n, {normals, normal_stride});
}

}  // namespace lcl
