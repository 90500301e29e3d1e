// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>

#include "host/capi/arguments.h"
#include "host/io/points_file.h"

using namespace lcl;

namespace {

lcl_cloud adopt(PointCloud cloud) {
    auto handle = std::make_unique<lcl_cloud_s>();
    handle->cloud = std::move(cloud);
    return handle.release();
}

std::vector<double> copy_rows(std::size_t count, const double* rows, std::size_t stride, const char* stride_name) {
    if (stride != 0) check_channels(3, stride, stride_name);
    const std::size_t step = stride == 0 ? 3 : stride;
    if (step == 3) return {rows, rows + 3 * count};
    std::vector<double> copy(3 * count);
    for (std::size_t i = 0; i < count; ++i) std::copy_n(rows + i * step, 3, &copy[3 * i]);
    return copy;
}

void check_rows(const PointCloud& cloud) {
    if (const BadRows bad = bad_points(cloud.points); bad.count > 0)
        throw BadInput("point " + std::to_string(bad.first[0]) + not_finite_text(bad), {bad.first, {}});
    if (const BadRows bad = bad_normals(cloud.normals); bad.count > 0)
        throw BadInput("the normal of point " + std::to_string(bad.first[0]) + " is zero or not finite (" + std::to_string(bad.count) + " of " +
                           std::to_string(cloud.count()) + "): correct it, or give no normals",
                       {bad.first, {}});
}

void give_rows(const std::vector<double>& rows, double* out) {
    if (out != nullptr) std::copy(rows.begin(), rows.end(), out);
}

}  // namespace

extern "C" {

lcl_status lcl_cloud_create(size_t count, const double* points, size_t stride, const double* normals, size_t normal_stride, lcl_cloud* cloud) {
    return guarded([&] {
        required(cloud, "cloud");
        if (count > 0) required(points, "points");
        if (count > INT32_MAX) throw InvalidArgument("count is " + std::to_string(count) + ", a cloud has at most 2147483647 points");
        PointCloud made;
        made.points = copy_rows(count, points, stride, "stride");
        if (normals != nullptr) made.normals = copy_rows(count, normals, normal_stride, "normal_stride");
        check_rows(made);
        *cloud = adopt(std::move(made));
        return LCL_OK;
    });
}

lcl_status lcl_cloud_read(const char* path, lcl_format format, lcl_cloud* cloud) {
    return guarded([&] {
        required(cloud, "cloud");
        *cloud = adopt(read_points(required(path, "path"), inner_format(format)));
        return LCL_OK;
    });
}

lcl_status lcl_cloud_read_memory(const void* bytes, size_t size, lcl_format format, const char* name, lcl_cloud* cloud) {
    return guarded([&] {
        required(cloud, "cloud");
        if (size > 0) required(bytes, "bytes");
        *cloud = adopt(read_points_memory(static_cast<const char*>(bytes), size, inner_format(format), name ? name : "memory"));
        return LCL_OK;
    });
}

void lcl_cloud_retain(lcl_cloud cloud) { retain(cloud); }
void lcl_cloud_release(lcl_cloud cloud) { release(cloud); }

size_t lcl_cloud_count(lcl_cloud cloud) { return cloud ? cloud->cloud.count() : 0; }
int32_t lcl_cloud_has_normals(lcl_cloud cloud) { return cloud && !cloud->cloud.normals.empty(); }
int32_t lcl_cloud_has_colours(lcl_cloud cloud) { return cloud && !cloud->cloud.colours.empty(); }

lcl_status lcl_cloud_get(lcl_cloud cloud, double* points, double* normals, double* colours) {
    return guarded([&] {
        const PointCloud& from = required(cloud, "cloud")->cloud;
        if (normals != nullptr && from.normals.empty()) throw InvalidArgument("the cloud has no normals: ask lcl_cloud_has_normals first");
        if (colours != nullptr && from.colours.empty()) throw InvalidArgument("the cloud has no colours: ask lcl_cloud_has_colours first");
        give_rows(from.points, points);
        give_rows(from.normals, normals);
        give_rows(from.colours, colours);
        return LCL_OK;
    });
}

int32_t lcl_cloud_note_count(lcl_cloud cloud) { return cloud ? static_cast<int32_t>(cloud->cloud.warnings.size()) : 0; }

const char* lcl_cloud_note(lcl_cloud cloud, int32_t index) {
    return index >= 0 && index < lcl_cloud_note_count(cloud) ? cloud->cloud.warnings[static_cast<std::size_t>(index)].c_str() : nullptr;
}

}  // extern "C"
