// SPDX-License-Identifier: BSD-3-Clause
// Dense matrix products on the device, by CLBlast where the library was built with it.
#pragma once

#include "host/device/device.h"

namespace lcl {

/// Whether a product of rows x inner with inner x columns is worth CLBlast: it has to be there, and its first call on a machine compiles for seconds.
bool has_dense_product(std::size_t rows, std::size_t inner, std::size_t columns);

/// c = a b, all row after row; c from value c_offset on.. Enqueued on the kernels' queue. DeviceError where CLBlast fails.
void dense_product(Context& context, bool is_double, std::size_t rows, std::size_t inner, std::size_t columns, const Buffer& a, const Buffer& b,
                   const Buffer& c, std::size_t c_offset);

}  // namespace lcl
