// SPDX-License-Identifier: BSD-3-Clause
// Devices and contexts.
#ifndef LIMITCL_DEVICE_HPP
#define LIMITCL_DEVICE_HPP

#include "error.hpp"
#include "handle.hpp"

#include <functional>
#include <memory>

namespace limitcl {

/// What is known of an OpenCL device.
struct DeviceInfo {
    int index = -1;  ///< place in devices(); -1: made from a cl_context of the caller
    std::string platform, name, version, driver, vendor;
    bool is_gpu = false, is_cpu = false;
    bool has_double = false;  ///< double-precision arithmetic
    std::uint32_t compute_units = 0, clock_mhz = 0;
    std::uint64_t memory_bytes = 0, max_allocation_bytes = 0;
};

enum class LogLevel { error = LCL_LOG_ERROR, warning = LCL_LOG_WARNING, info = LCL_LOG_INFO, debug = LCL_LOG_DEBUG };

/// Options of a context; the default opens the default device.
struct ContextOptions {
    std::string device;           ///< index, part of a name, "cpu" or "gpu"; "": environment LIMITCL_DEVICE, else the fastest GPU, else the CPU
    std::string cache_directory;  ///< built programs; "": LIMITCL_CACHE_DIR, else the user's cache folder
    bool profiling = false;
    std::function<void(LogLevel, const std::string&)> log;  ///< empty: none. Called on the thread of the call; what it throws is dropped
    LogLevel log_level = LogLevel::warning;                 ///< messages up to this level
};

/// Result of one kernel's self-test.
struct SelftestResult {
    std::string kernel, what;
    double difference = 0;  ///< largest difference to the plain double-precision host operator
    double tolerance = 0;   ///< what is allowed
    bool passed = false;
};

namespace detail {

inline DeviceInfo from_c(const lcl_device_info& c) {
    DeviceInfo info;
    info.index = c.index;
    info.platform = c.platform, info.name = c.name, info.version = c.version, info.driver = c.driver, info.vendor = c.vendor;
    info.is_gpu = c.is_gpu != 0, info.is_cpu = c.is_cpu != 0, info.has_double = c.has_double != 0;
    info.compute_units = c.compute_units, info.clock_mhz = c.clock_mhz;
    info.memory_bytes = c.memory_bytes, info.max_allocation_bytes = c.max_allocation_bytes;
    return info;
}

}  // namespace detail

/// All OpenCL devices of all platforms, in the order of their indices.
inline std::vector<DeviceInfo> devices() {
    std::vector<DeviceInfo> list;
    for (std::int32_t i = 0; i < lcl_device_count(); ++i) {
        lcl_device_info info = LCL_DEVICE_INFO_INIT;
        check(lcl_device_get_info(i, &info));
        list.push_back(detail::from_c(info));
    }
    return list;
}

/// One OpenCL device with its queues and programs. Copies share it. One thread at a time; different contexts are independent, also on one device.
class Context {
public:
    /// Opens a device. Error LCL_ERROR_NO_DEVICE names what was asked for, what there is and how to install one.
    explicit Context(const ContextOptions& options = {});
    /// Takes over a reference of the C API, for example of a context made from a cl_context.
    explicit Context(ContextHandle handle) : handle_(std::move(handle)) {}

    lcl_context get() const { return handle_.get(); }
    DeviceInfo device() const;
    /// Waits until everything that was put on the queues is done.
    void finish() const { check(lcl_context_finish(get())); }
    /// Seconds spent building programs so far.
    double compile_seconds() const { return lcl_context_compile_seconds(get()); }
    /// Bytes that fields and operators hold on the device now.
    std::uint64_t allocated_bytes() const { return lcl_context_allocated_bytes(get()); }
    /// Runs every kernel on built-in meshes against the plain host operator: one result each. A disagreement is a result, not an exception.
    std::vector<SelftestResult> selftest() const;

private:
    using Log = std::function<void(LogLevel, const std::string&)>;
    static void forward_log(void* user, std::int32_t level, const char* message);

    // Shared by all copies, also those inside operators and fields: the C context may call it as long as any of them lives. Declared first, so it goes last.
    std::shared_ptr<Log> log_;
    ContextHandle handle_;
};

inline Context::Context(const ContextOptions& options) {
    lcl_context_options c = LCL_CONTEXT_OPTIONS_INIT;
    c.profiling = options.profiling;
    c.device = options.device.empty() ? nullptr : options.device.c_str();
    c.cache_directory = options.cache_directory.empty() ? nullptr : options.cache_directory.c_str();
    c.log_level = static_cast<std::int32_t>(options.log_level);
    if (options.log) {
        log_ = std::make_shared<Log>(options.log);
        c.log = &Context::forward_log;
        c.log_user = log_.get();
    }
    lcl_context context = nullptr;
    check(lcl_context_create(&c, &context));
    handle_ = ContextHandle(context);
}

inline DeviceInfo Context::device() const {
    lcl_device_info info = LCL_DEVICE_INFO_INIT;
    check(lcl_context_get_device(get(), &info));
    return detail::from_c(info);
}

inline std::vector<SelftestResult> Context::selftest() const {
    std::vector<SelftestResult> results;
    const lcl_selftest_callback collect = [](void* user, const char* kernel, const char* what, double difference, double tolerance, std::int32_t passed) {
        static_cast<std::vector<SelftestResult>*>(user)->push_back({kernel, what, difference, tolerance, passed != 0});
    };
    const lcl_status status = lcl_context_selftest(get(), collect, &results);
    bool disagreement = false;
    for (const SelftestResult& result : results) disagreement = disagreement || !result.passed;
    if (!disagreement) check(status);
    return results;
}

inline void Context::forward_log(void* user, std::int32_t level, const char* message) {
    try {
        (*static_cast<Log*>(user))(static_cast<LogLevel>(level), message);
    } catch (...) {  // an exception must not pass through C
    }
}

}  // namespace limitcl

#endif
