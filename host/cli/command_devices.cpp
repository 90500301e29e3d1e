// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/commands.h"
#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

std::vector<lcl_device_info> all_devices() {
    std::vector<lcl_device_info> devices;
    for (int index = 0; index < lcl_device_count(); ++index) {
        lcl_device_info info = LCL_DEVICE_INFO_INIT;
        check(lcl_device_get_info(index, &info));
        devices.push_back(info);
    }
    return devices;
}

/// The device that the library takes for --device (or, without it, for nothing in particular).
lcl_device_info chosen_device(const Options& options) {
    lcl_context_options context_options = LCL_CONTEXT_OPTIONS_INIT;
    context_options.device = options.device.empty() ? nullptr : options.device.c_str();
    lcl_context handle = nullptr;
    check(lcl_context_create(&context_options, &handle));
    const Context context(handle);
    lcl_device_info info = LCL_DEVICE_INFO_INIT;
    check(lcl_context_get_device(handle, &info));
    return info;
}

std::string device_table(const std::vector<lcl_device_info>& devices) {
    std::vector<std::vector<std::string>> rows = {{"index", "type", "double", "memory", "units", "MHz", "platform", "version", "name"}};
    for (const lcl_device_info& device : devices) {
        rows.push_back({std::to_string(device.index),
                        device.is_gpu   ? "gpu"
                        : device.is_cpu ? "cpu"
                                        : "other",
                        device.has_double ? "yes" : "no", byte_text(device.memory_bytes), std::to_string(device.compute_units),
                        std::to_string(device.clock_mhz), device.platform, device.version, device.name});
    }
    return table_text(rows);
}

}  // namespace

void run_devices(Job& job) {
    job.report.devices.emplace();
    if (lcl_device_count() > 0 && job.options.device.empty()) job.report.devices = all_devices();
    else job.report.devices->push_back(chosen_device(job.options));  // with no device at all this fails, with the ways to install one
    if (job.options.report != "-") job.terminal.result(device_table(*job.report.devices));
}

}  // namespace lcl::cli
