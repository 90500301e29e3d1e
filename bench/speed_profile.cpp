// SPDX-License-Identifier: BSD-3-Clause
// speed_profile PART: what limitcl asks of OpenCL during a set-up and a solve: "memory", the most bytes that buffers hold at one time, and "kernels", the time
// of every kind of command.
//
// The functions of OpenCL that are defined here stand before the driver loader's, for the library too: so both are measured from outside, whatever the library
// does inside, and without a word about it in the library.
#include <dlfcn.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "interpolation.h"
#include "measure.h"

namespace bench {
namespace {

/// One kind of command: a kernel by its name, or "read", "write", "copy", "fill".
struct Kind {
    int calls = 0;
    double seconds = 0, bytes = 0;
};

struct Buffer {
    double bytes = 0;
    int references = 1;  // of the library: drivers add their own while a command runs
};

struct Watch {
    double bytes = 0, most_bytes = 0;  // of all buffers
    double most_groups = 1;            // of any launch so far in groups of a given size: one over all blocks
    bool records = false;
    std::map<cl_mem, Buffer> buffers;
    std::map<cl_kernel, std::map<cl_uint, cl_mem>> arguments;  // those that are buffers, by place
    std::map<std::string, Kind> kinds;
} watch;

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Sizes of the buffers of a launch: what it moves at least if it needs all of each, as a pass over the whole mesh does; a buffer given twice is read and
/// written.
double bytes_of_arguments(cl_kernel kernel) {
    double bytes = 0;
    for (const auto& [place, memory] : watch.arguments[kernel]) bytes += watch.buffers[memory].bytes;
    return bytes;
}

/// The part of all blocks that a launch takes, counted by its work-groups; 1 where the driver chooses them.
double share_of_blocks(cl_uint dimensions, const size_t* global, const size_t* local) {
    if (local == nullptr) return 1;
    double groups = 1;
    for (cl_uint d = 0; d < dimensions; ++d) groups *= static_cast<double>(global[d] / local[d]);
    watch.most_groups = std::max(watch.most_groups, groups);
    return groups / watch.most_groups;
}

std::string name_of(cl_kernel kernel) {
    char name[128] = "";
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof name, name, nullptr);
    return name;
}

void add(const std::string& name, double bytes, cl_event event) {
    cl_ulong start = 0, end = 0;
    clWaitForEvents(1, &event);
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr);
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr);
    Kind& kind = watch.kinds[name];
    ++kind.calls;
    kind.seconds += 1e-9 * static_cast<double>(end - start);
    kind.bytes += bytes;
}

/// Puts a command on a queue by enqueue(event). While commands are recorded it waits for it, so that its time is its own.
template <class Enqueue>
cl_int record(const std::string& name, double bytes, cl_event* event, const Enqueue& enqueue) {
    if (!watch.records) return enqueue(event);
    cl_event own = nullptr;
    const cl_int status = enqueue(&own);
    if (status != CL_SUCCESS) return status;
    add(name, bytes, own);
    if (event != nullptr) *event = own;
    else clReleaseEvent(own);
    return status;
}

void print_kinds(const std::string& phase, double seconds) {
    watch.records = false;
    for (const auto& [name, kind] : watch.kinds) std::printf("kernel %s %s %d %.9g %.9g\n", phase.c_str(), name.c_str(), kind.calls, kind.seconds, kind.bytes);
    std::printf("kernel %s all 1 %.9g 0\n", phase.c_str(), seconds);
    watch.kinds.clear();
    std::fflush(stdout);
}

template <class Body>
void profile(const std::string& phase, const Body& body) {
    watch.records = true;
    const Clock::time_point start = Clock::now();
    body();
    print_kinds(phase, seconds_since(start));
}

void profile_kernels(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const ContextHandle context = open_device(arguments.device, true);
    DeviceCopy copy(context, shape.vertex_count());
    copy.seconds();
    print_value("profile.copy.seconds", copy.seconds());
    print_value("profile.copy.bytes", 32.0 * shape.vertex_count());
    {
        Interpolation warm_up(context, shape, Scheme::catmull_clark);
        warm_up.solve(LCL_PRECISION_SINGLE);
        warm_up.solve(LCL_PRECISION_MIXED);
    }
    std::unique_ptr<Interpolation> problem;
    profile("setup", [&] {
        problem = std::make_unique<Interpolation>(context, shape, Scheme::catmull_clark);
        lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
        check(lcl_operator_diagnose(problem->A.get(), &diagnosis));
    });
    profile("single", [&] { problem->solve(LCL_PRECISION_SINGLE); });
    profile("mixed", [&] { problem->solve(LCL_PRECISION_MIXED); });
}

/// Operator, M, P and all that a solve makes for itself.
void measure_memory(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const ContextHandle context = open_device(arguments.device);
    Interpolation problem(context, shape, Scheme::catmull_clark);
    print_value("memory.vertices", shape.vertex_count());
    print_value("memory.held", watch.bytes);
    print_value("memory.setup", watch.most_bytes);
    for (const lcl_precision precision : {LCL_PRECISION_SINGLE, LCL_PRECISION_MIXED}) {
        watch.most_bytes = watch.bytes;
        problem.solve(precision);
        print_value(precision == LCL_PRECISION_SINGLE ? "memory.single" : "memory.mixed", watch.most_bytes);
    }
}

void run_part(const Arguments& arguments) {
    if (arguments.part == "kernels") profile_kernels(arguments);
    else if (arguments.part == "memory") measure_memory(arguments);
    else throw std::runtime_error("'" + arguments.part + "' is not a part");
}

}  // namespace
}  // namespace bench

using bench::record;
using bench::watch;

extern "C" {
#define WATCHED __attribute__((visibility("default")))

WATCHED cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* status) {
    const cl_mem memory = bench::next<decltype(clCreateBuffer)>("clCreateBuffer")(context, flags, size, host, status);
    if (memory == nullptr) return nullptr;
    watch.buffers[memory] = {static_cast<double>(size)};
    watch.most_bytes = std::max(watch.most_bytes, watch.bytes += static_cast<double>(size));
    return memory;
}

WATCHED cl_int clRetainMemObject(cl_mem memory) {
    ++watch.buffers[memory].references;
    return bench::next<decltype(clRetainMemObject)>("clRetainMemObject")(memory);
}

WATCHED cl_int clReleaseMemObject(cl_mem memory) {
    const auto place = watch.buffers.find(memory);
    if (place != watch.buffers.end() && --place->second.references == 0) {
        watch.bytes -= place->second.bytes;
        watch.buffers.erase(place);
    }
    return bench::next<decltype(clReleaseMemObject)>("clReleaseMemObject")(memory);
}

WATCHED cl_int clSetKernelArg(cl_kernel kernel, cl_uint place, size_t size, const void* value) {
    watch.arguments[kernel].erase(place);
    cl_mem memory = nullptr;
    if (value != nullptr && size == sizeof memory) std::memcpy(&memory, value, size);
    if (watch.buffers.count(memory) > 0) watch.arguments[kernel][place] = memory;
    return bench::next<decltype(clSetKernelArg)>("clSetKernelArg")(kernel, place, size, value);
}

WATCHED cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset, const size_t* global,
                                      const size_t* local, cl_uint count, const cl_event* events, cl_event* event) {
    const double share = bench::share_of_blocks(dimensions, global, local);
    return record(bench::name_of(kernel), share * bench::bytes_of_arguments(kernel), event, [&](cl_event* out) {
        return bench::next<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel")(queue, kernel, dimensions, offset, global, local, count, events, out);
    });
}

WATCHED cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem memory, cl_bool blocking, size_t offset, size_t size, void* values, cl_uint count,
                                   const cl_event* events, cl_event* event) {
    return record("read", size, event, [&](cl_event* out) {
        return bench::next<decltype(clEnqueueReadBuffer)>("clEnqueueReadBuffer")(queue, memory, blocking, offset, size, values, count, events, out);
    });
}

WATCHED cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem memory, cl_bool blocking, size_t offset, size_t size, const void* values, cl_uint count,
                                    const cl_event* events, cl_event* event) {
    return record("write", size, event, [&](cl_event* out) {
        return bench::next<decltype(clEnqueueWriteBuffer)>("clEnqueueWriteBuffer")(queue, memory, blocking, offset, size, values, count, events, out);
    });
}

WATCHED cl_int clEnqueueCopyBuffer(cl_command_queue queue, cl_mem from, cl_mem to, size_t from_offset, size_t to_offset, size_t size, cl_uint count,
                                   const cl_event* events, cl_event* event) {
    return record("copy", 2 * size, event, [&](cl_event* out) {
        return bench::next<decltype(clEnqueueCopyBuffer)>("clEnqueueCopyBuffer")(queue, from, to, from_offset, to_offset, size, count, events, out);
    });
}

WATCHED cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem memory, const void* pattern, size_t pattern_size, size_t offset, size_t size, cl_uint count,
                                   const cl_event* events, cl_event* event) {
    return record("fill", size, event, [&](cl_event* out) {
        return bench::next<decltype(clEnqueueFillBuffer)>("clEnqueueFillBuffer")(queue, memory, pattern, pattern_size, offset, size, count, events, out);
    });
}
}

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::run_part); }
