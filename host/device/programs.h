// SPDX-License-Identifier: BSD-3-Clause
// The built programs of one context.
#pragma once

#include <map>
#include <type_traits>

#include "host/device/binary_cache.h"
#include "host/device/device.h"

namespace lcl {

struct ReleaseProgram {
    void operator()(cl_program program) const { clReleaseProgram(program); }
};
struct ReleaseKernel {
    void operator()(cl_kernel kernel) const { clReleaseKernel(kernel); }
};
using ProgramHandle = std::unique_ptr<std::remove_pointer_t<cl_program>, ReleaseProgram>;
using KernelHandle = std::unique_ptr<std::remove_pointer_t<cl_kernel>, ReleaseKernel>;

struct Context::Programs {
    struct Program {
        ProgramHandle handle;
        std::map<std::string, KernelHandle> kernels;  // by name
    };

    Programs(cl_context context_, const DeviceInfo& device_, const std::string& cache_directory_)
        : context(context_), device(device_), cache(cache_directory(cache_directory_)) {}
    cl_kernel kernel(const std::string& file, const std::string& name, const std::string& options);

    cl_context context;  // of the owner, which outlives this
    const DeviceInfo& device;
    BinaryCache cache;
    std::map<std::pair<std::string, std::string>, Program> built;  // by file and options
    double compile_seconds = 0;

private:
    ProgramHandle build(const std::string& file, const std::string& options);
    ProgramHandle load_binary(const std::string& key, const std::string& options);
    ProgramHandle compile(const std::string& file, const std::string& source, const std::string& options);
    std::string build_log(cl_program program) const;
};

}  // namespace lcl
