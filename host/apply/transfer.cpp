// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/transfer.h"

namespace lcl {
namespace {

/// Centre, scale and inverse scale of a block's components, as lcl_import_points takes them.
Buffer frame(DeviceOperator& A, const Transform& transform, const ChannelBlock& block, bool as_double) {
    std::vector<double> values(3 * block.width, 0.0);
    for (int c = 0; c < block.count; ++c) {
        values[c] = transform.centre[block.first + c];
        values[block.width + c] = transform.scale[block.first + c];
        values[2 * block.width + c] = 1 / transform.scale[block.first + c];
    }
    const std::vector<float> narrow(values.begin(), values.end());
    Buffer buffer(A.shared_context(), values.size() * sizeof(double), "centre and scale of a field");
    const void* const from = as_double ? static_cast<const void*>(values.data()) : narrow.data();
    // Beside the kernels' queue: that one may stand still until an event that the caller sets after this call.
    A.context()
        .write_async(buffer, 0, values.size() * (as_double ? sizeof(double) : sizeof(float)), from, {}, "uploading the centre and scale of a field")
        .wait();
    return buffer;
}

void transfer(DeviceOperator& A, const Transform& transform, const Field& field, const CallerRows& rows, bool imports) {
    Context& context = A.context();
    const bool as_double = field.real() == Real::full || rows.is_double;
    for (std::size_t b = 0; b < field.blocks().size(); ++b) {
        const ChannelBlock& block = field.blocks()[b];
        const std::string options = kernel_options(context, field.real(), block.width, 1) + " -D LCL_SOURCE=" + (rows.is_double ? "double" : "float");
        launch(context, context.kernel("transfer", imports ? "lcl_import_points" : "lcl_export_points", options), {static_cast<std::size_t>(field.rows()), 0},
               static_cast<cl_uint>(field.rows()), static_cast<cl_ulong>(rows.stride), static_cast<cl_ulong>(rows.offset), static_cast<cl_uint>(block.first),
               static_cast<cl_uint>(block.count), A.vertex_order(), frame(A, transform, block, as_double), imports ? *rows.buffer : field.buffer(b),
               imports ? field.buffer(b) : *rows.buffer);
    }
}

}  // namespace

void import_rows(DeviceOperator& A, const Transform& transform, const CallerRows& rows, Field& field) { transfer(A, transform, field, rows, true); }
void export_rows(DeviceOperator& A, const Transform& transform, const Field& field, const CallerRows& rows) { transfer(A, transform, field, rows, false); }

}  // namespace lcl
