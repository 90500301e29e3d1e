// SPDX-License-Identifier: BSD-3-Clause
// limitcl as the benchmark uses it: a device, and one shape ready to be interpolated with its fields on it.
#ifndef LIMITCL_BENCH_INTERPOLATION_H
#define LIMITCL_BENCH_INTERPOLATION_H

#include <limitcl/limitcl_opencl.h>

#include <limitcl/handle.hpp>

#include "limit_matrix.h"

namespace bench {

using limitcl::ContextHandle;
using limitcl::FieldHandle;
using limitcl::MeshHandle;
using limitcl::OperatorHandle;

void check(lcl_status status);  ///< std::runtime_error with the library's sentence unless LCL_OK
void check_cl(cl_int status);   ///< the same for OpenCL's own calls

ContextHandle open_device(const std::string& device, bool profiling = false);
MeshHandle make_mesh(const Shape& shape);
OperatorHandle make_operator(const ContextHandle& context, const MeshHandle& mesh, Scheme scheme);
FieldHandle make_field(const OperatorHandle& A, int channels = 3);

/// clEnqueueCopyBuffer of a field of float4 rows on the context's queue: the unit of the targets.
class DeviceCopy {
public:
    DeviceCopy(const ContextHandle& context, std::int32_t vertex_count);
    ~DeviceCopy();
    DeviceCopy(const DeviceCopy&) = delete;
    DeviceCopy& operator=(const DeviceCopy&) = delete;
    /// Seconds of one copy out of `copies` that are put on the queue together.
    double seconds(int copies = 50);

private:
    cl_command_queue queue_;
    cl_mem from_ = nullptr, to_ = nullptr;
    std::size_t bytes_;
};

struct Interpolation {
    Interpolation(const ContextHandle& context, const Shape& shape, Scheme scheme);
    /// Fields on the device; throws unless it converges.
    lcl_solve_report solve(lcl_precision precision);
    std::vector<double> control_points() const;  ///< what the last solve gave, vertex_count x 3
    void finish() const { check(lcl_context_finish(context.get())); }

    ContextHandle context;
    OperatorHandle A;
    FieldHandle M, P;
    std::int32_t vertex_count;
};

}  // namespace bench

#endif
