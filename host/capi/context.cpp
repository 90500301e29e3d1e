// SPDX-License-Identifier: BSD-3-Clause
#include "host/capi/handles.h"
#include "host/selftest/selftest.h"

using namespace lcl;

namespace {

lcl_device_info public_info(const DeviceInfo& device) {
    lcl_device_info info = LCL_DEVICE_INFO_INIT;
    info.index = device.index;
    copy_text(info.platform, device.platform);
    copy_text(info.name, device.name);
    copy_text(info.version, device.version);
    copy_text(info.driver, device.driver);
    copy_text(info.vendor, device.vendor);
    info.is_gpu = device.is_gpu;
    info.is_cpu = device.is_cpu;
    info.has_double = device.has_double;
    info.compute_units = device.compute_units;
    info.clock_mhz = device.clock_mhz;
    info.memory_bytes = device.memory_bytes;
    info.max_allocation_bytes = device.max_allocation_bytes;
    return info;
}

}  // namespace

extern "C" {

int32_t lcl_device_count(void) {
    int32_t count = 0;
    guarded([&] {
        count = static_cast<int32_t>(list_devices().size());
        return LCL_OK;
    });
    return count;
}

lcl_status lcl_device_get_info(int32_t index, lcl_device_info* info) {
    return guarded([&] {
        const std::vector<DeviceInfo> devices = list_devices();
        if (index < 0 || index >= static_cast<int32_t>(devices.size()))
            throw InvalidArgument("device index is " + std::to_string(index) + ", there are " + std::to_string(devices.size()) + " devices");
        give(info, public_info(devices[index]), "info");
        return LCL_OK;
    });
}

lcl_status lcl_context_create(const lcl_context_options* options, lcl_context* context) {
    return guarded([&] {
        required(context, "context");
        const lcl_context_options given = options_or(options, LCL_CONTEXT_OPTIONS_INIT, "options");
        ContextOptions inner;
        inner.profiling = given.profiling != 0;
        if (given.cache_directory != nullptr) inner.cache_directory = given.cache_directory;
        auto handle = std::make_unique<lcl_context_s>();
        handle->context = Context::create(choose_device(given.device ? given.device : ""), inner);
        handle->log = given.log;
        handle->log_user = given.log_user;
        handle->log_level = given.log_level;
        handle->write_log(LCL_LOG_INFO, "device " + handle->context->device().name + " (" + handle->context->device().platform + ")");
        *context = handle.release();
        return LCL_OK;
    });
}

void lcl_context_retain(lcl_context context) { retain(context); }
void lcl_context_release(lcl_context context) { release(context); }

lcl_status lcl_context_get_device(lcl_context context, lcl_device_info* info) {
    return guarded([&] {
        give(info, public_info(required(context, "context")->context->device()), "info");
        return LCL_OK;
    });
}

lcl_status lcl_context_finish(lcl_context context) {
    return guarded([&] {
        required(context, "context")->context->finish();
        return LCL_OK;
    });
}

double lcl_context_compile_seconds(lcl_context context) { return context ? context->context->compile_seconds() : 0; }
uint64_t lcl_context_allocated_bytes(lcl_context context) { return context ? context->context->allocated_bytes() : 0; }

lcl_status lcl_context_selftest(lcl_context context, lcl_selftest_callback callback, void* user) {
    return guarded([&] {
        const bool agree = run_selftest(required(context, "context")->context, [&](const SelftestResult& r) {
            if (callback != nullptr) callback(user, r.kernel.c_str(), r.what.c_str(), r.difference, r.tolerance, r.passed());
        });
        if (agree) return LCL_OK;
        last_error() = {"some kernels disagree with the plain host operator on " + context->context->device().name +
                            ": do not trust results of this device, and report its driver's version",
                        {}};
        return LCL_ERROR_INTERNAL;
    });
}

}  // extern "C"
