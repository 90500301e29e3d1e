// SPDX-License-Identifier: BSD-3-Clause
// OpenCL devices, contexts, buffers, programs and launches: the only folder that calls OpenCL.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/error.h"

namespace lcl {

struct DeviceInfo {
    int index = -1;  ///< place in list_devices(), -1 for an adopted context
    std::string platform, platform_version, name, vendor, version, driver;
    cl_platform_id platform_id = nullptr;
    cl_device_id id = nullptr;
    bool is_gpu = false;
    bool is_cpu = false;
    bool has_double = false;       ///< cl_khr_fp64 / double-precision arithmetic
    std::size_t memory_bytes = 0;  ///< global memory
    std::size_t max_allocation_bytes = 0;
    std::size_t max_work_group_size = 0;
    std::size_t cache_bytes = 0;  ///< global memory cache; 0 where the driver does not say
    unsigned compute_units = 0;
    unsigned clock_mhz = 0;
};

/// Every device of every platform that can run the library: available, with a compiler, OpenCL 1.2 or later. Empty if there is none (or the OpenCL loader
/// finds no platform); never throws for that.
std::vector<DeviceInfo> list_devices();

/// An index, part of a name or platform (any case, the first that matches), "cpu" or "gpu"; empty: LIMITCL_DEVICE, else the GPU with the
/// largest compute units x clock, else the first CPU, else the first device. NoDevice names what was asked for, what there is, and the ways to install one.
DeviceInfo choose_device(const std::string& spec = "");

/// OpenCL's own name of an error code: "CL_OUT_OF_RESOURCES".
const char* opencl_error_name(int code);

/// Throws DeviceError "clFinish failed with CL_OUT_OF_RESOURCES (-5) while <doing>" unless code is CL_SUCCESS.
/// CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_HOST_MEMORY and CL_INVALID_BUFFER_SIZE become OutOfMemory.
void check(int code, const char* call, const std::string& doing);

/// A reference-counted OpenCL event; empty for "already done".
class Event {
public:
    Event() = default;
    explicit Event(cl_event event) : event_(event) {}  ///< takes over one reference
    Event(const Event& other);
    Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
    Event& operator=(Event other) noexcept {
        std::swap(event_, other.event_);
        return *this;
    }
    ~Event();
    cl_event get() const { return event_; }
    cl_event release() { return std::exchange(event_, nullptr); }  ///< hands the reference on
    void wait() const;
    double seconds() const;  ///< waits, then start to end on the device; needs a profiling context, else DeviceError; 0 for an empty event

private:
    cl_event event_ = nullptr;
};

struct ContextOptions {
    bool profiling = false;
    /// Of built programs. Empty: LIMITCL_CACHE_DIR, else the user's cache folder (XDG_CACHE_HOME or ~/.cache, then /limitcl); not writable: no cache, no error.
    std::string cache_directory;
};

class Context;

/// Device memory. Movable, released with its last owner. Keeps its context alive.
class Buffer {
public:
    Buffer() = default;
    /// Allocates, contents undefined; 0 bytes give a buffer that kernels can take too. `what` names it in messages ("the control points").
    /// OutOfMemory, with the numbers, above the device's largest allocation, above its memory together with this context's other buffers, or when the device
    /// refuses.
    /// `data`, if given, is what it holds, copied before the call returns and by no queue.
    Buffer(std::shared_ptr<Context> context, std::size_t bytes, const std::string& what, const void* data = nullptr);
    /// Refers to a caller's cl_mem (retained), from byte `offset` on; kernels get the whole memory object, so they take the offset as an argument.
    /// InvalidArgument for memory of another OpenCL context or too small for offset + bytes.
    Buffer(std::shared_ptr<Context> context, cl_mem memory, std::size_t offset, std::size_t bytes);
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    ~Buffer();
    cl_mem get() const { return memory_; }
    std::size_t bytes() const { return bytes_; }
    std::size_t offset() const { return offset_; }
    explicit operator bool() const { return memory_ != nullptr; }

private:
    std::shared_ptr<Context> context_;
    cl_mem memory_ = nullptr;
    std::size_t bytes_ = 0, offset_ = 0;
    std::size_t counted_bytes_ = 0;  // in the context's allocated_bytes(); 0 for a caller's memory
};

/// Bytes of a buffer that the host may touch until unmap(), which waits. Not to outlive its context and buffer.
class Mapping {
public:
    Mapping(cl_command_queue queue, cl_mem memory, void* data) : queue_(queue), memory_(memory), data_(data) {}
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;
    ~Mapping();  ///< unmaps after an exception
    void* data() const { return data_; }
    void unmap(const std::string& doing);

private:
    cl_command_queue queue_;
    cl_mem memory_;
    void* data_;
};

/// One device with its queues and built programs. One thread at a time; different contexts are independent, also of one device.
class Context : public std::enable_shared_from_this<Context> {
public:
    static std::shared_ptr<Context> create(const DeviceInfo& device, const ContextOptions& options = {});
    /// On a caller's context and in-order queue, both retained; the device is the queue's. InvalidArgument for an out-of-order queue, a null one or one of
    /// another context. Kernels can be timed if the caller's queue can.
    static std::shared_ptr<Context> adopt(cl_context context, cl_command_queue queue, const ContextOptions& options = {});
    ~Context();

    const DeviceInfo& device() const { return device_; }
    cl_context get() const { return context_; }
    cl_command_queue queue() const { return queue_; }  ///< in order: kernels
    cl_command_queue transfer_queue() const {
        return transfer_queue_;
    }  ///< in order, a second one: transfers that overlap with kernels, and every other launch of a Pipeline

    /// The kernel `name` of kernels/`file`.cl, built with `options` ("-D LCL_REAL=double ..."); built once, then from memory or from the binary cache on disk,
    /// which is keyed by device, driver, options and source. -cl-std=CL1.2 is always passed. DeviceError holds the build log.
    cl_kernel kernel(const std::string& file, const std::string& name, const std::string& options = "");

    /// Blocking copies on the kernels' queue, in bytes from the buffer's own start. All copies: 0 bytes do nothing, InvalidArgument beyond the buffer's end.
    void write(const Buffer& buffer, std::size_t offset, std::size_t bytes, const void* from, const std::string& doing);
    void read(const Buffer& buffer, std::size_t offset, std::size_t bytes, void* to, const std::string& doing);
    /// Copies that return at once, on the transfer queue; `from` and `to` must live until the event is done. They start after `after`.
    Event write_async(const Buffer& buffer, std::size_t offset, std::size_t bytes, const void* from, const Event& after, const std::string& doing);
    Event read_async(const Buffer& buffer, std::size_t offset, std::size_t bytes, void* to, const Event& after, const std::string& doing);
    /// Maps bytes for the host after `after` and waits. On a CPU that is the device's own memory, without a copy. for_writing: what was there is lost, and all
    /// of it is to be written; else it is only read.
    Mapping map(const Buffer& buffer, std::size_t offset, std::size_t bytes, bool for_writing, const Event& after, const std::string& doing);
    /// Device to device on the kernels' queue.
    void copy(const Buffer& from, std::size_t from_offset, const Buffer& to, std::size_t to_offset, std::size_t bytes, const std::string& doing);
    void fill_zero(const Buffer& buffer, const std::string& doing);

    Event marker();                                      ///< done when all that was put on the kernels' queue before is
    void wait_for(const std::vector<cl_event>& events);  ///< later kernels and copies on the kernels' queue start after these
    void finish();
    double compile_seconds() const;                                   ///< spent in kernel() so far
    std::size_t allocated_bytes() const { return allocated_bytes_; }  ///< by this context's Buffers now

private:
    friend class Buffer;
    friend class Pipeline;
    struct Programs;  // built programs and kernels by (file, options)
    Context() = default;
    DeviceInfo device_;
    cl_context context_ = nullptr;
    cl_command_queue queue_ = nullptr, transfer_queue_ = nullptr;
    bool owns_queue_ = false;
    std::unique_ptr<Programs> programs_;
    std::size_t allocated_bytes_ = 0;
};

/// Size of a caller's memory object.
std::size_t memory_bytes(cl_mem memory);

/// Global and local size in work-items; the global size must be a multiple of the local one. local 0: the driver's choice. second: work-groups along a second
/// dimension; local must be given where it is not 1.
struct LaunchSize {
    std::size_t global = 0, local = 0, second = 1;
};

/// One argument of a kernel: a buffer or a scalar.
void set_argument(cl_kernel kernel, unsigned place, const Buffer& buffer);  // an empty Buffer is InvalidArgument: kernels take no null pointers
void set_argument_bytes(cl_kernel kernel, unsigned place, const void* value, std::size_t bytes);
template <class T>
void set_argument(cl_kernel kernel, unsigned place, const T& value) {
    set_argument_bytes(kernel, place, &value, sizeof value);
}

/// Enqueues on the context's kernel queue; a global size of 0 does nothing.
Event enqueue(Context& context, cl_kernel kernel, LaunchSize size);

/// The same on any queue of the context, after an event that the queue does not wait for by itself.
Event enqueue_on(Context& context, cl_command_queue queue, cl_kernel kernel, LaunchSize size, const Event& after);

/// Sets the arguments in order and checks every result.
template <class... Arguments>
void set_arguments([[maybe_unused]] cl_kernel kernel, const Arguments&... arguments) {
    unsigned place = 0;
    (set_argument(kernel, place++, arguments), ...);
}

/// Sets the arguments and enqueues.
template <class... Arguments>
Event launch(Context& context, cl_kernel kernel, LaunchSize size, const Arguments&... arguments) {
    set_arguments(kernel, arguments...);
    return enqueue(context, kernel, size);
}

/// Launches each of which may begin while the one before it still runs, but not before the one before that has ended: two queues take turns, so that no
/// compute unit waits for the last work-group of every launch.
class Pipeline {
public:
    /// Launches begin after what is on the kernels' queue now.
    explicit Pipeline(Context& context);
    ~Pipeline();  // waits where something has thrown before join()
    Pipeline(const Pipeline&) = delete;
    void enqueue(cl_kernel kernel, LaunchSize size);
    /// What is put on the kernels' queue from now on waits for all launches.
    void join();

private:
    Context& context_;
    std::array<Event, 3> before_;  // of the three newest launches, oldest first
    bool on_second_ = false, is_joined_ = false;
    int count_ = 0;
};

}  // namespace lcl
