// SPDX-License-Identifier: BSD-3-Clause
#include "host/device/dense_product.h"

#include <string>

#ifdef LIMITCL_CLBLAST
#include <clblast.h>
#endif

namespace lcl {

#ifdef LIMITCL_CLBLAST

namespace {

template <class Number>
clblast::StatusCode multiply(std::size_t rows, std::size_t inner, std::size_t columns, cl_mem a, cl_mem b, cl_mem c, std::size_t c_offset,
                             cl_command_queue queue) {
    return clblast::Gemm<Number>(clblast::Layout::kRowMajor, clblast::Transpose::kNo, clblast::Transpose::kNo, rows, columns, inner, Number(1), a, 0, inner, b,
                                 0, columns, Number(0), c, c_offset, columns, &queue);
}

}  // namespace

bool has_dense_product(std::size_t rows, std::size_t inner, std::size_t columns, double least_operations) {
    return 2.0 * static_cast<double>(rows) * static_cast<double>(inner) * static_cast<double>(columns) >= least_operations;
}

void dense_product(Context& context, bool is_double, std::size_t rows, std::size_t inner, std::size_t columns, const Buffer& a, const Buffer& b,
                   const Buffer& c, std::size_t c_offset) {
    const auto product = is_double ? multiply<double> : multiply<float>;
    const clblast::StatusCode status = product(rows, inner, columns, a.get(), b.get(), c.get(), c_offset, context.queue());
    if (status != clblast::StatusCode::kSuccess)
        throw DeviceError(static_cast<int>(status),
                          "CLBlast failed with status " + std::to_string(static_cast<int>(status)) + " while projecting control points");
}

#else

bool has_dense_product(std::size_t, std::size_t, std::size_t, double) { return false; }
void dense_product(Context&, bool, std::size_t, std::size_t, std::size_t, const Buffer&, const Buffer&, const Buffer&, std::size_t) {
    throw Unsupported("this build has no CLBlast");
}

#endif

}  // namespace lcl
