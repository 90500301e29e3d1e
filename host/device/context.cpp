// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "host/device/programs.h"
#include "host/device/query.h"

namespace lcl {

namespace {

cl_command_queue create_queue(cl_context context, const DeviceInfo& device, bool profiling) {
    cl_int code = CL_SUCCESS;
    const cl_command_queue queue = clCreateCommandQueue(context, device.id, profiling ? CL_QUEUE_PROFILING_ENABLE : 0, &code);
    check(code, "clCreateCommandQueue", "making a command queue on " + device.name);
    return queue;
}

/// The empty list is null, as OpenCL wants it.
const cl_event* list_of(const std::vector<cl_event>& events) { return events.empty() ? nullptr : events.data(); }

std::vector<cl_event> list_of(const Event& event) { return event.get() ? std::vector<cl_event>{event.get()} : std::vector<cl_event>{}; }

/// OpenCL checks the memory object's end, but a caller's memory may reach further than the part that a Buffer stands for.
void check_range(const Buffer& buffer, std::size_t offset, std::size_t bytes, const std::string& doing) {
    if (offset <= buffer.bytes() && bytes <= buffer.bytes() - offset) return;
    throw InvalidArgument("copy of " + std::to_string(bytes) + " bytes at byte " + std::to_string(offset) + " of a buffer of " +
                          std::to_string(buffer.bytes()) + " bytes while " + doing);
}

std::string kernel_name(cl_kernel kernel) {
    return query_text(clGetKernelInfo, kernel, static_cast<cl_kernel_info>(CL_KERNEL_FUNCTION_NAME), "clGetKernelInfo");
}

void check_argument(int code, cl_kernel kernel, unsigned place) {
    if (code != CL_SUCCESS) check(code, "clSetKernelArg", "setting argument " + std::to_string(place) + " of " + kernel_name(kernel));
}

}  // namespace

Event::Event(const Event& other) : event_(other.event_) {
    if (event_) check(clRetainEvent(event_), "clRetainEvent", "keeping an event");
}

Event::~Event() {
    if (event_) clReleaseEvent(event_);
}

void Event::wait() const {
    if (!event_) return;
    int code = clWaitForEvents(1, &event_);
    cl_int status = CL_COMPLETE;  // below zero: the error that ended the command, which says more than the wait's
    if (code != CL_SUCCESS && clGetEventInfo(event_, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr) == CL_SUCCESS && status < 0)
        code = status;
    check(code, "clWaitForEvents", "waiting for the device");
}

double Event::seconds() const {
    if (!event_) return 0;
    wait();
    cl_ulong start = 0, end = 0;
    check(clGetEventProfilingInfo(event_, CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr), "clGetEventProfilingInfo", "timing a command");
    check(clGetEventProfilingInfo(event_, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr), "clGetEventProfilingInfo", "timing a command");
    return 1e-9 * static_cast<double>(end - start);
}

std::shared_ptr<Context> Context::create(const DeviceInfo& device, const ContextOptions& options) {
    std::shared_ptr<Context> made(new Context);
    made->device_ = device;
    const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM, reinterpret_cast<cl_context_properties>(device.platform_id), 0};
    cl_int code = CL_SUCCESS;
    made->context_ = clCreateContext(properties, 1, &device.id, nullptr, nullptr, &code);
    check(code, "clCreateContext", "opening " + device.name);
    made->queue_ = create_queue(made->context_, device, options.profiling);
    made->owns_queue_ = true;
    made->transfer_queue_ = create_queue(made->context_, device, options.profiling);
    made->programs_ = std::make_unique<Programs>(made->context_, made->device_, options.cache_directory);
    return made;
}

std::shared_ptr<Context> Context::adopt(cl_context context, cl_command_queue queue, const ContextOptions& options) {
    if (!context || !queue) throw InvalidArgument("the OpenCL context or command queue to work on is null");
    if (queue_value<cl_context>(queue, CL_QUEUE_CONTEXT) != context)
        throw InvalidArgument("the command queue belongs to another OpenCL context than the one given with it");
    if (queue_value<cl_command_queue_properties>(queue, CL_QUEUE_PROPERTIES) & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) {
        throw InvalidArgument(
            "the command queue is out of order, which would mix up the steps of a solver: give one made without CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE");
    }
    std::shared_ptr<Context> made(new Context);
    made->device_ = describe_device(queue_value<cl_device_id>(queue, CL_QUEUE_DEVICE));
    check(clRetainContext(context), "clRetainContext", "taking over an OpenCL context");
    made->context_ = context;
    check(clRetainCommandQueue(queue), "clRetainCommandQueue", "taking over a command queue");
    made->queue_ = queue;
    made->transfer_queue_ = create_queue(context, made->device_, options.profiling);
    made->programs_ = std::make_unique<Programs>(context, made->device_, options.cache_directory);
    return made;
}

// What is left on the queues is waited for: a driver that still compiles a kernel for it (PoCL) would abort where the program ends. A caller's own queue may
// wait for what the caller has yet to do, and is the caller's to finish.
Context::~Context() {
    if (owns_queue_ && queue_) clFinish(queue_);
    if (owns_queue_ && transfer_queue_) clFinish(transfer_queue_);
    programs_.reset();
    if (transfer_queue_) clReleaseCommandQueue(transfer_queue_);
    if (queue_) clReleaseCommandQueue(queue_);
    if (context_) clReleaseContext(context_);
}

cl_kernel Context::kernel(const std::string& file, const std::string& name, const std::string& options) { return programs_->kernel(file, name, options); }

double Context::compile_seconds() const { return programs_->compile_seconds; }

void Context::write(const Buffer& buffer, std::size_t offset, std::size_t bytes, const void* from, const std::string& doing) {
    check_range(buffer, offset, bytes, doing);
    if (bytes == 0) return;
    check(clEnqueueWriteBuffer(queue_, buffer.get(), CL_TRUE, buffer.offset() + offset, bytes, from, 0, nullptr, nullptr), "clEnqueueWriteBuffer", doing);
}

void Context::read(const Buffer& buffer, std::size_t offset, std::size_t bytes, void* to, const std::string& doing) {
    check_range(buffer, offset, bytes, doing);
    if (bytes == 0) return;
    check(clEnqueueReadBuffer(queue_, buffer.get(), CL_TRUE, buffer.offset() + offset, bytes, to, 0, nullptr, nullptr), "clEnqueueReadBuffer", doing);
}

// A queue may wait for another one's event only after that queue was flushed, or it may wait for ever; the transfer itself is flushed to start at once.

Event Context::write_async(const Buffer& buffer, std::size_t offset, std::size_t bytes, const void* from, const Event& after, const std::string& doing) {
    check_range(buffer, offset, bytes, doing);
    if (bytes == 0) return after;
    const std::vector<cl_event> waits = list_of(after);
    if (!waits.empty()) check(clFlush(queue_), "clFlush", doing);
    cl_event event = nullptr;
    check(clEnqueueWriteBuffer(transfer_queue_, buffer.get(), CL_FALSE, buffer.offset() + offset, bytes, from, static_cast<cl_uint>(waits.size()),
                               list_of(waits), &event),
          "clEnqueueWriteBuffer", doing);
    Event done(event);
    check(clFlush(transfer_queue_), "clFlush", doing);
    return done;
}

Event Context::read_async(const Buffer& buffer, std::size_t offset, std::size_t bytes, void* to, const Event& after, const std::string& doing) {
    check_range(buffer, offset, bytes, doing);
    if (bytes == 0) return after;
    const std::vector<cl_event> waits = list_of(after);
    if (!waits.empty()) check(clFlush(queue_), "clFlush", doing);
    cl_event event = nullptr;
    check(clEnqueueReadBuffer(transfer_queue_, buffer.get(), CL_FALSE, buffer.offset() + offset, bytes, to, static_cast<cl_uint>(waits.size()), list_of(waits),
                              &event),
          "clEnqueueReadBuffer", doing);
    Event done(event);
    check(clFlush(transfer_queue_), "clFlush", doing);
    return done;
}

Mapping Context::map(const Buffer& buffer, std::size_t offset, std::size_t bytes, bool for_writing, const Event& after, const std::string& doing) {
    check_range(buffer, offset, bytes, doing);
    const std::vector<cl_event> waits = list_of(after);
    if (!waits.empty()) check(clFlush(queue_), "clFlush", doing);
    cl_int code = CL_SUCCESS;
    void* const data = clEnqueueMapBuffer(transfer_queue_, buffer.get(), CL_TRUE, for_writing ? CL_MAP_WRITE_INVALIDATE_REGION : CL_MAP_READ,
                                          buffer.offset() + offset, bytes, static_cast<cl_uint>(waits.size()), list_of(waits), nullptr, &code);
    check(code, "clEnqueueMapBuffer", doing);
    return {transfer_queue_, buffer.get(), data};
}

void Mapping::unmap(const std::string& doing) {
    cl_event event = nullptr;
    check(clEnqueueUnmapMemObject(queue_, memory_, std::exchange(data_, nullptr), 0, nullptr, &event), "clEnqueueUnmapMemObject", doing);
    Event(event).wait();
}

Mapping::~Mapping() {
    if (data_ != nullptr && clEnqueueUnmapMemObject(queue_, memory_, data_, 0, nullptr, nullptr) == CL_SUCCESS) clFinish(queue_);
}

void Context::copy(const Buffer& from, std::size_t from_offset, const Buffer& to, std::size_t to_offset, std::size_t bytes, const std::string& doing) {
    check_range(from, from_offset, bytes, doing);
    check_range(to, to_offset, bytes, doing);
    if (bytes == 0) return;
    check(clEnqueueCopyBuffer(queue_, from.get(), to.get(), from.offset() + from_offset, to.offset() + to_offset, bytes, 0, nullptr, nullptr),
          "clEnqueueCopyBuffer", doing);
}

void Context::fill_zero(const Buffer& buffer, const std::string& doing) {
    if (buffer.bytes() == 0) return;
    // Offset and size must be multiples of the pattern's size.
    const cl_uint zero = 0;
    const std::size_t pattern = (buffer.bytes() | buffer.offset()) % sizeof zero == 0 ? sizeof zero : 1;
    check(clEnqueueFillBuffer(queue_, buffer.get(), &zero, pattern, buffer.offset(), buffer.bytes(), 0, nullptr, nullptr), "clEnqueueFillBuffer", doing);
}

Event Context::marker() {
    cl_event event = nullptr;
    check(clEnqueueMarkerWithWaitList(queue_, 0, nullptr, &event), "clEnqueueMarkerWithWaitList", "marking a point in the kernels' queue");
    return Event(event);
}

void Context::wait_for(const std::vector<cl_event>& events) {
    if (events.empty()) return;  // an empty list would mean everything before, which the order of the queue gives already
    check(clEnqueueBarrierWithWaitList(queue_, static_cast<cl_uint>(events.size()), events.data(), nullptr), "clEnqueueBarrierWithWaitList",
          "waiting for events");
}

void Context::finish() {
    check(clFinish(queue_), "clFinish", "waiting for " + device_.name);
    check(clFinish(transfer_queue_), "clFinish", "waiting for transfers of " + device_.name);
}

void set_argument(cl_kernel kernel, unsigned place, const Buffer& buffer) {
    if (!buffer) throw InvalidArgument("argument " + std::to_string(place) + " of " + kernel_name(kernel) + " is an empty buffer");
    const cl_mem memory = buffer.get();
    check_argument(clSetKernelArg(kernel, place, sizeof memory, &memory), kernel, place);
}

void set_argument_bytes(cl_kernel kernel, unsigned place, const void* value, std::size_t bytes) {
    check_argument(clSetKernelArg(kernel, place, bytes, value), kernel, place);
}

Event enqueue(Context& context, cl_kernel kernel, LaunchSize size) { return enqueue_on(context, context.queue(), kernel, size, {}); }

Event enqueue_on(Context& context, cl_command_queue queue, cl_kernel kernel, LaunchSize size, const Event& after) {
    if (size.global == 0 || size.second == 0) return {};
    const std::vector<cl_event> waits = list_of(after);
    const std::size_t global[] = {size.global, size.second}, local[] = {size.local, 1};
    cl_event event = nullptr;
    const int code = clEnqueueNDRangeKernel(queue, kernel, size.second > 1 ? 2 : 1, nullptr, global, size.local ? local : nullptr,
                                            static_cast<cl_uint>(waits.size()), list_of(waits), &event);
    if (code != CL_SUCCESS) {
        check(code, "clEnqueueNDRangeKernel",
              "starting " + kernel_name(kernel) + " with " + std::to_string(size.global) + " work-items in groups of " + std::to_string(size.local) + " on " +
                  context.device().name);
    }
    return Event(event);
}

Pipeline::Pipeline(Context& context) : context_(context), before_{Event(), Event(), context.marker()} {
    check(clFlush(context.queue()), "clFlush", "starting a pipeline of kernels");
}

// Its own queue makes a launch wait for the one two before it, and an event for the one three before it, which is on the other queue.
void Pipeline::enqueue(cl_kernel kernel, LaunchSize size) {
    const cl_command_queue queue = on_second_ ? context_.transfer_queue_ : context_.queue_;
    const Event& other = count_ == 1 ? before_[1] : before_[0];  // the second launch: what was on the kernels' queue before the first
    Event event = enqueue_on(context_, queue, kernel, size, other);
    before_ = {before_[1], before_[2], std::move(event)};
    on_second_ = !on_second_;
    ++count_;
    check(clFlush(queue), "clFlush", "starting a kernel of a pipeline");
}

Pipeline::~Pipeline() {
    if (is_joined_) return;
    clFinish(context_.transfer_queue_);
    clFinish(context_.queue_);
}

void Pipeline::join() {
    const Event& newest_of_second = on_second_ ? before_[1] : before_[2];
    if (count_ > 1 && newest_of_second.get()) context_.wait_for({newest_of_second.get()});
    is_joined_ = true;
}

}  // namespace lcl
