// SPDX-License-Identifier: BSD-3-Clause
// Typed forms of the clGet*Info calls, for the files of this folder.
#pragma once

#include "host/device/device.h"

namespace lcl {

/// Everything of a DeviceInfo but its index. DeviceError if the device does not answer.
DeviceInfo describe_device(cl_device_id id);

/// A text from clGet*Info without the padding that some drivers put round it.
template <class Handle, class Name>
std::string query_text(cl_int(CL_API_CALL* get)(Handle, Name, std::size_t, void*, std::size_t*), Handle handle, Name what, const char* call) {
    std::size_t size = 0;
    check(get(handle, what, 0, nullptr, &size), call, "asking the OpenCL driver what it offers");
    std::string text(size, '\0');
    if (size > 0) check(get(handle, what, size, text.data(), nullptr), call, "asking the OpenCL driver what it offers");
    text.resize(text.find('\0') == std::string::npos ? text.size() : text.find('\0'));
    const std::size_t first = text.find_first_not_of(' ');
    return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

inline std::string device_text(cl_device_id device, cl_device_info what) { return query_text(clGetDeviceInfo, device, what, "clGetDeviceInfo"); }
inline std::string platform_text(cl_platform_id platform, cl_platform_info what) { return query_text(clGetPlatformInfo, platform, what, "clGetPlatformInfo"); }

template <class Value>
Value device_value(cl_device_id device, cl_device_info what) {
    Value value{};
    check(clGetDeviceInfo(device, what, sizeof value, &value, nullptr), "clGetDeviceInfo", "asking an OpenCL device what it offers");
    return value;
}

template <class Value>
Value queue_value(cl_command_queue queue, cl_command_queue_info what) {
    Value value{};
    check(clGetCommandQueueInfo(queue, what, sizeof value, &value, nullptr), "clGetCommandQueueInfo", "taking over a command queue");
    return value;
}

template <class Value>
Value memory_value(cl_mem memory, cl_mem_info what) {
    Value value{};
    check(clGetMemObjectInfo(memory, what, sizeof value, &value, nullptr), "clGetMemObjectInfo", "taking over a memory object");
    return value;
}

}  // namespace lcl
