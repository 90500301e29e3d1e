// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>

#include "host/device/embedded_kernels.h"
#include "host/device/programs.h"
#include "host/device/query.h"

namespace lcl {

namespace {

/// All that a binary depends on, one item a line.
std::string cache_key(const DeviceInfo& device, const std::string& options, const std::string& source) {
    return device.name + "\n" + device.vendor + "\n" + device.version + "\n" + device.driver + "\n" + device.platform_version + "\n" + options + "\n" + source;
}

/// The binary for the program's one device; empty if the driver gives none.
std::string program_binary(cl_program program) {
    std::size_t size = 0;
    if (clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, nullptr) != CL_SUCCESS || size == 0) return {};
    std::string binary(size, '\0');
    unsigned char* const place = reinterpret_cast<unsigned char*>(binary.data());
    if (clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof place, const_cast<unsigned char**>(&place), nullptr) != CL_SUCCESS) return {};
    return binary;
}

std::string without_trailing_space(std::string text) {
    text.erase(text.find_last_not_of(" \n\t") + 1);
    return text;
}

}  // namespace

std::string Context::Programs::build_log(cl_program program) const {
    std::size_t size = 0;
    if (clGetProgramBuildInfo(program, device.id, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "no build log";
    std::string log(size, '\0');
    if (clGetProgramBuildInfo(program, device.id, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr) != CL_SUCCESS) return "no build log";
    return without_trailing_space(log.c_str());
}

/// Null where there is no binary or the driver does not take it: then the source is compiled, and the new binary replaces the old.
ProgramHandle Context::Programs::load_binary(const std::string& key, const std::string& options) {
    const std::optional<std::string> binary = cache.load(key);
    if (!binary) return nullptr;
    const unsigned char* const bytes = reinterpret_cast<const unsigned char*>(binary->data());
    const std::size_t size = binary->size();
    cl_int status = CL_SUCCESS, code = CL_SUCCESS;
    ProgramHandle program(clCreateProgramWithBinary(context, 1, &device.id, &size, const_cast<const unsigned char**>(&bytes), &status, &code));
    if (code != CL_SUCCESS || status != CL_SUCCESS) return nullptr;
    if (clBuildProgram(program.get(), 1, &device.id, options.c_str(), nullptr, nullptr) != CL_SUCCESS) return nullptr;
    return program;
}

ProgramHandle Context::Programs::compile(const std::string& file, const std::string& source, const std::string& options) {
    const std::string doing = "building kernels/" + file + ".cl for " + device.name;
    const char* const text = source.data();
    const std::size_t size = source.size();
    cl_int code = CL_SUCCESS;
    ProgramHandle program(clCreateProgramWithSource(context, 1, const_cast<const char**>(&text), &size, &code));
    check(code, "clCreateProgramWithSource", doing);
    code = clBuildProgram(program.get(), 1, &device.id, options.c_str(), nullptr, nullptr);
    if (code != CL_SUCCESS) check(code, "clBuildProgram", doing + " with '" + options + "': " + build_log(program.get()));
    return program;
}

ProgramHandle Context::Programs::build(const std::string& file, const std::string& options) {
    const std::string source = kernel_source(file);
    const std::string key = cache_key(device, options, source);
    if (ProgramHandle program = load_binary(key, options)) return program;
    ProgramHandle program = compile(file, source, options);
    // At once, and not when the context ends: drivers that compile at the first launch keep that part in a cache of their own.
    cache.store(key, program_binary(program.get()));
    return program;
}

cl_kernel Context::Programs::kernel(const std::string& file, const std::string& name, const std::string& options) {
    Program& program = built[{file, options}];
    KernelHandle& kernel = program.kernels[name];
    if (kernel) return kernel.get();
    const auto start = std::chrono::steady_clock::now();
    if (!program.handle) program.handle = build(file, "-cl-std=CL1.2 " + options);
    cl_int code = CL_SUCCESS;
    kernel.reset(clCreateKernel(program.handle.get(), name.c_str(), &code));
    check(code, "clCreateKernel", "looking for the kernel " + name + " in kernels/" + file + ".cl");
    compile_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return kernel.get();
}

}  // namespace lcl
