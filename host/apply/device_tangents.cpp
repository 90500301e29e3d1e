// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/device_tangents.h"

#include <algorithm>

#include "host/apply/real_values.h"

namespace lcl {

namespace {

constexpr std::size_t largest_group = 64;

}  // namespace

DeviceTangents::DeviceTangents(DeviceOperator& A, TangentPlan&& plan) : A_(A), plan_(std::move(plan)) {
    const auto upload_all = [&](const auto& values, const char* what) { return upload(values.data(), values.size() * sizeof values[0], what); };
    run_turns_ = upload_all(plan_.run_turns, "the tangents of runs");
    rows_ = upload_all(plan_.rows, "rows with tangent stencils");
    sector_offsets_ = upload_all(plan_.sector_offsets, "the sectors of tangent stencils");
    entry_offsets_ = upload_all(plan_.entry_offsets, "the offsets of tangent stencils");
    columns_ = upload_all(plan_.columns, "the columns of tangent stencils");
}

Buffer DeviceTangents::upload(const void* data, std::size_t bytes, const char* what) const {
    Buffer buffer(A_.shared_context(), std::max<std::size_t>(bytes, 16), what);
    // Not on the kernels' queue, where it would wait for what a caller has put there; nothing uses a new buffer yet.
    if (bytes > 0) A_.context().write_async(buffer, 0, bytes, data, {}, std::string("uploading ") + what).wait();
    return buffer;
}

const DeviceTangents::Weights& DeviceTangents::weights(Real real) {
    Weights& weights = weights_[real];
    if (weights.turns) return weights;
    const auto upload_reals = [&](const std::vector<double>& values, const char* what) {
        const std::vector<unsigned char> bytes = real_bytes(A_.context(), real, values);
        return upload(bytes.data(), bytes.size(), what);
    };
    weights.stored = upload_reals(plan_.weights, "the weights of tangent stencils");
    weights.turns = upload_reals(plan_.turns, "the weights of tangents");
    return weights;
}

void DeviceTangents::normals(const Field& x, Field* y, Field& normals) {
    const Buffer& turns = weights(x.real()).turns;
    if (y != nullptr) A_.launch_over_rows("normals", "lcl_limit_normals", x, run_turns_, turns, x.buffer(0), y->buffer(0), normals.buffer(0));
    else A_.launch_over_rows("normals", "lcl_normals", x, run_turns_, turns, x.buffer(0), normals.buffer(0));
    launch_sectors("lcl_sector_normals", x, normals);
}

void DeviceTangents::frames(const Field& x, Field& normals, Field& tangents, Field& bitangents) {
    A_.launch_over_rows("normals", "lcl_frames", x, run_turns_, weights(x.real()).turns, x.buffer(0), normals.buffer(0), tangents.buffer(0),
                        bitangents.buffer(0));
    launch_sectors("lcl_sector_frames", x, normals, tangents, bitangents);
}

template <class... Fields>
void DeviceTangents::launch_sectors(const char* name, const Field& x, const Fields&... fields) {
    if (!sides_ || sides_->real() != x.real()) sides_.emplace(A_.shared_context(), plan_.side_count(), 3, x.real());
    const std::size_t count = plan_.rows.size(), local = std::min(largest_group, A_.context().device().max_work_group_size);
    const cl_kernel kernel = A_.context().kernel("normals", name, kernel_options(A_.context(), x.real(), x.blocks()[0].width, A_.launch_shape().group));
    launch(A_.context(), kernel, {(count + local - 1) / local * local, local}, static_cast<Index>(count), plan_.side_count(), rows_, sector_offsets_,
           entry_offsets_, columns_, weights(x.real()).stored, x.buffer(0), fields.buffer(0)..., sides_->buffer(0));
}

std::vector<double> DeviceTangents::read_sides() const {
    std::vector<double> sides(3 * static_cast<std::size_t>(plan_.side_count()), 0.0);
    if (sides_ && !sides.empty()) sides_->download(sides.data(), 0, plan_.side_count());
    return sides;
}

}  // namespace lcl
