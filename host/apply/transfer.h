// SPDX-License-Identifier: BSD-3-Clause
// Fields from and to a caller's device buffers, without a way through the host.
#pragma once

#include "host/apply/device_operator.h"

namespace lcl {

/// n x c values of a caller in device memory, in the caller's vertex order: row v begins at value offset + v * stride of the buffer.
struct CallerRows {
    const Buffer* buffer = nullptr;
    std::size_t offset = 0;  ///< values
    std::size_t stride = 0;  ///< values
    bool is_double = false;  ///< doubles, else floats
};

/// Caller's rows into the field, centred and scaled; enqueued. rows hold the field's channels. field: single or full.
void import_rows(DeviceOperator& A, const Transform& transform, const CallerRows& rows, Field& field);
/// The way back, to the rows' channels and nowhere else.
void export_rows(DeviceOperator& A, const Transform& transform, const Field& field, const CallerRows& rows);

}  // namespace lcl
