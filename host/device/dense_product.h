// SPDX-License-Identifier: BSD-3-Clause
// Dense matrix products on the device, by CLBlast where the library was built with it.
#pragma once

#include "host/device/device.h"

namespace lcl {

/// Operations from which on a product is worth CLBlast, whose first call on a machine compiles for seconds.
constexpr double least_dense_operations = 4e9;

/// Whether there is CLBlast, and a product of rows x inner with inner x columns has so many operations.
bool has_dense_product(std::size_t rows, std::size_t inner, std::size_t columns, double least_operations = least_dense_operations);

/// c = a b, all row after row; c from value c_offset on.. Enqueued on the kernels' queue. DeviceError where CLBlast fails.
void dense_product(Context& context, bool is_double, std::size_t rows, std::size_t inner, std::size_t columns, const Buffer& a, const Buffer& b,
                   const Buffer& c, std::size_t c_offset);

}  // namespace lcl
