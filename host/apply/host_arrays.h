// SPDX-License-Identifier: BSD-3-Clause
// Device operations on values in a caller's memory.
#pragma once

#include <vector>

#include "host/apply/device_tangents.h"

namespace lcl {

enum class Precision { mixed, single, full };  // order of lcl_precision

/// Number type of the fields that a result of this precision is computed in.
Real real_of(Precision precision);

/// Values of the fixed rows (corners, isolated vertices, vertices outside the subset), which come back to the bit: fixed rows x channels.
std::vector<double> kept_rows(const Plan& plan, const double* values, std::size_t stride, int channels);
void restore_rows(const Plan& plan, const std::vector<double>& kept, int channels, double* values, std::size_t stride);

/// out = A points. points, out: vertex_count rows of `channels`, stride apart, in the caller's order; out may be points. Ghosts keep their values. BadInput as
/// fit_transform.
void limit_points(DeviceOperator& A, const double* points, std::size_t stride, int channels, Precision precision, double* out, std::size_t out_stride);

/// The same with unit normals; out (rows out_stride apart) may be null. Three channels. Normals of ghosts are 0.
void limit_normals(DeviceOperator& A, DeviceTangents& tangents, const double* points, std::size_t stride, Precision precision, double* out,
                   std::size_t out_stride, double* normals, std::size_t normal_stride);

}  // namespace lcl
