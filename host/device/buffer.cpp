// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "host/device/device.h"
#include "host/device/query.h"

namespace lcl {

namespace {

void refuse_too_large(const Context& context, std::size_t bytes, const std::string& what) {
    const DeviceInfo& device = context.device();
    const std::string needs = what + " needs " + std::to_string(bytes) + " bytes, ";
    const std::string cure = ": use a device with more memory, or split the mesh";
    if (bytes > device.max_allocation_bytes) {
        throw OutOfMemory(needs + "the largest allocation of " + device.name + " is " + std::to_string(device.max_allocation_bytes) + " bytes" + cure);
    }
    if (bytes > device.memory_bytes || context.allocated_bytes() > device.memory_bytes - bytes) {
        throw OutOfMemory(needs + "the memory of " + device.name + " is " + std::to_string(device.memory_bytes) + " bytes, of which " +
                          std::to_string(context.allocated_bytes()) + " are in use" + cure);
    }
}

}  // namespace

Buffer::Buffer(std::shared_ptr<Context> context, std::size_t bytes, const std::string& what, const void* data) : bytes_(bytes) {
    refuse_too_large(*context, bytes, what);
    cl_int code = CL_SUCCESS;
    const std::size_t size = data != nullptr ? bytes : std::max<std::size_t>(bytes, sizeof(cl_double4));
    // PoCL takes plain memory at a buffer's first use and aborts the process if it gets none; host memory it takes at once and answers with an error code.
    const cl_mem_flags place = context->device().is_cpu ? CL_MEM_ALLOC_HOST_PTR : 0;
    memory_ = clCreateBuffer(context->get(), CL_MEM_READ_WRITE | place | (data != nullptr ? CL_MEM_COPY_HOST_PTR : 0), size, const_cast<void*>(data), &code);
    check(code, "clCreateBuffer", "allocating " + std::to_string(bytes) + " bytes for " + what + " on " + context->device().name);
    context_ = std::move(context);
    counted_bytes_ = bytes;
    context_->allocated_bytes_ += bytes;
}

Buffer::Buffer(std::shared_ptr<Context> context, cl_mem memory, std::size_t offset, std::size_t bytes) : bytes_(bytes), offset_(offset) {
    if (!memory) throw InvalidArgument("the OpenCL memory object is null");
    if (memory_value<cl_context>(memory, CL_MEM_CONTEXT) != context->get()) throw InvalidArgument("the OpenCL memory object belongs to another OpenCL context");
    const auto size = memory_value<std::size_t>(memory, CL_MEM_SIZE);
    if (offset > size || bytes > size - offset) {
        throw InvalidArgument("the OpenCL memory object has " + std::to_string(size) + " bytes, too few for " + std::to_string(bytes) + " from byte " +
                              std::to_string(offset));
    }
    check(clRetainMemObject(memory), "clRetainMemObject", "taking over a memory object");
    memory_ = memory;
    context_ = std::move(context);
}

Buffer::Buffer(Buffer&& other) noexcept
    : context_(std::move(other.context_)),
      memory_(std::exchange(other.memory_, nullptr)),
      bytes_(std::exchange(other.bytes_, 0)),
      offset_(std::exchange(other.offset_, 0)),
      counted_bytes_(std::exchange(other.counted_bytes_, 0)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    Buffer taken(std::move(other));
    std::swap(context_, taken.context_);
    std::swap(memory_, taken.memory_);
    std::swap(bytes_, taken.bytes_);
    std::swap(offset_, taken.offset_);
    std::swap(counted_bytes_, taken.counted_bytes_);
    return *this;
}

Buffer::~Buffer() {
    if (context_) context_->allocated_bytes_ -= counted_bytes_;
    if (memory_) clReleaseMemObject(memory_);
}

std::size_t memory_bytes(cl_mem memory) { return memory_value<std::size_t>(memory, CL_MEM_SIZE); }

}  // namespace lcl
