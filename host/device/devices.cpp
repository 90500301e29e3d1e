// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>

#include "host/device/device.h"
#include "host/device/query.h"

namespace lcl {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool is_number(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// "OpenCL 1.2 ..." and later: what every call and kernel of the library needs.
bool is_recent_enough(const std::string& version) {
    int major = 0, minor = 0;
    return std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor) == 2 && (major > 1 || minor >= 2);
}

bool is_usable(const DeviceInfo& device) {
    return is_recent_enough(device.version) && device_value<cl_bool>(device.id, CL_DEVICE_AVAILABLE) &&
           device_value<cl_bool>(device.id, CL_DEVICE_COMPILER_AVAILABLE);
}

std::vector<cl_platform_id> platforms() {
    cl_uint count = 0;
    // The loader answers CL_PLATFORM_NOT_FOUND_KHR where no driver is installed.
    if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) return {};
    std::vector<cl_platform_id> found(count);
    if (clGetPlatformIDs(count, found.data(), nullptr) != CL_SUCCESS) return {};
    return found;
}

std::vector<cl_device_id> devices_of(cl_platform_id platform) {
    cl_uint count = 0;
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS || count == 0) return {};
    std::vector<cl_device_id> found(count);
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, found.data(), nullptr) != CL_SUCCESS) return {};
    return found;
}

template <class Condition>
const DeviceInfo* first_that(const std::vector<DeviceInfo>& devices, Condition condition) {
    const auto found = std::find_if(devices.begin(), devices.end(), condition);
    return found == devices.end() ? nullptr : &*found;
}

const DeviceInfo* first_cpu(const std::vector<DeviceInfo>& devices) {
    return first_that(devices, [](const DeviceInfo& device) { return device.is_cpu; });
}

const DeviceInfo* fastest_gpu(const std::vector<DeviceInfo>& devices) {
    const auto speed = [](const DeviceInfo& device) { return static_cast<double>(device.compute_units) * std::max(1u, device.clock_mhz); };
    const DeviceInfo* best = nullptr;
    for (const DeviceInfo& device : devices) {
        if (device.is_gpu && (!best || speed(device) > speed(*best))) best = &device;
    }
    return best;
}

const DeviceInfo* default_device(const std::vector<DeviceInfo>& devices) {
    if (const DeviceInfo* gpu = fastest_gpu(devices)) return gpu;
    if (const DeviceInfo* cpu = first_cpu(devices)) return cpu;
    return devices.empty() ? nullptr : &devices.front();
}

const DeviceInfo* find_device(const std::vector<DeviceInfo>& devices, const std::string& wanted) {
    const std::string spec = lower(wanted);
    if (spec.empty()) return default_device(devices);
    if (spec == "gpu") return fastest_gpu(devices);
    if (spec == "cpu") return first_cpu(devices);
    if (is_number(spec)) {
        const unsigned long index = std::strtoul(spec.c_str(), nullptr, 10);  // too many digits: ULONG_MAX, which no list reaches
        return index < devices.size() ? &devices[index] : nullptr;
    }
    return first_that(devices, [&](const DeviceInfo& device) {
        return lower(device.name).find(spec) != std::string::npos || lower(device.platform).find(spec) != std::string::npos;
    });
}

std::string no_device_message(const std::vector<DeviceInfo>& devices, const std::string& spec, bool from_environment) {
    const std::string install = "install one with `apt install pocl-opencl-icd` (for the processor) or the GPU driver of its vendor";
    if (devices.empty() && spec.empty()) return "no OpenCL device was found: " + install;
    const std::string asked = "no OpenCL device answers to '" + spec + "'" + (from_environment ? " (LIMITCL_DEVICE)" : "");
    if (devices.empty()) return asked + ", there is none at all: " + install;
    std::string list;
    for (const DeviceInfo& device : devices) {
        list += (list.empty() ? "" : ", ") + std::to_string(device.index) + " = " + device.name + " (" + device.platform + ")";
    }
    return asked + ", there is " + list + ": give an index, a part of a name, cpu or gpu, or " + install;
}

}  // namespace

DeviceInfo describe_device(cl_device_id id) {
    DeviceInfo device;
    device.id = id;
    device.platform_id = device_value<cl_platform_id>(id, CL_DEVICE_PLATFORM);
    device.platform = platform_text(device.platform_id, CL_PLATFORM_NAME);
    device.platform_version = platform_text(device.platform_id, CL_PLATFORM_VERSION);
    device.name = device_text(id, CL_DEVICE_NAME);
    device.vendor = device_text(id, CL_DEVICE_VENDOR);
    device.version = device_text(id, CL_DEVICE_VERSION);
    device.driver = device_text(id, CL_DRIVER_VERSION);
    const auto type = device_value<cl_device_type>(id, CL_DEVICE_TYPE);
    device.is_gpu = (type & CL_DEVICE_TYPE_GPU) != 0;
    device.is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    device.has_double = (" " + device_text(id, CL_DEVICE_EXTENSIONS) + " ").find(" cl_khr_fp64 ") != std::string::npos;
    device.memory_bytes = static_cast<std::size_t>(device_value<cl_ulong>(id, CL_DEVICE_GLOBAL_MEM_SIZE));
    device.max_allocation_bytes = static_cast<std::size_t>(device_value<cl_ulong>(id, CL_DEVICE_MAX_MEM_ALLOC_SIZE));
    device.max_work_group_size = device_value<std::size_t>(id, CL_DEVICE_MAX_WORK_GROUP_SIZE);
    device.cache_bytes = device_value<cl_ulong>(id, CL_DEVICE_GLOBAL_MEM_CACHE_SIZE);
    device.compute_units = device_value<cl_uint>(id, CL_DEVICE_MAX_COMPUTE_UNITS);
    device.clock_mhz = device_value<cl_uint>(id, CL_DEVICE_MAX_CLOCK_FREQUENCY);
    return device;
}

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> devices;
    for (cl_platform_id platform : platforms()) {
        for (cl_device_id id : devices_of(platform)) {
            try {
                DeviceInfo device = describe_device(id);
                if (!is_usable(device)) continue;
                device.index = static_cast<int>(devices.size());
                devices.push_back(std::move(device));
            } catch (const DeviceError&) {
                // A device that cannot say what it is cannot be used either; the others can.
            }
        }
    }
    return devices;
}

DeviceInfo choose_device(const std::string& spec) {
    const char* const environment = std::getenv("LIMITCL_DEVICE");
    const bool from_environment = spec.empty() && environment && *environment;
    const std::string wanted = from_environment ? environment : spec;
    const std::vector<DeviceInfo> devices = list_devices();
    if (const DeviceInfo* device = find_device(devices, wanted)) return *device;
    throw NoDevice(no_device_message(devices, wanted, from_environment));
}

}  // namespace lcl
