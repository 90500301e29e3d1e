// SPDX-License-Identifier: BSD-3-Clause
#include "host/device/device.h"

#include <CL/cl_ext.h>

namespace lcl {

const char* opencl_error_name(int code) {
#define LCL_NAME(code_name) \
    case code_name:         \
        return #code_name
    switch (code) {
        LCL_NAME(CL_SUCCESS);
        LCL_NAME(CL_DEVICE_NOT_FOUND);
        LCL_NAME(CL_DEVICE_NOT_AVAILABLE);
        LCL_NAME(CL_COMPILER_NOT_AVAILABLE);
        LCL_NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE);
        LCL_NAME(CL_OUT_OF_RESOURCES);
        LCL_NAME(CL_OUT_OF_HOST_MEMORY);
        LCL_NAME(CL_PROFILING_INFO_NOT_AVAILABLE);
        LCL_NAME(CL_MEM_COPY_OVERLAP);
        LCL_NAME(CL_IMAGE_FORMAT_MISMATCH);
        LCL_NAME(CL_IMAGE_FORMAT_NOT_SUPPORTED);
        LCL_NAME(CL_BUILD_PROGRAM_FAILURE);
        LCL_NAME(CL_MAP_FAILURE);
        LCL_NAME(CL_MISALIGNED_SUB_BUFFER_OFFSET);
        LCL_NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
        LCL_NAME(CL_COMPILE_PROGRAM_FAILURE);
        LCL_NAME(CL_LINKER_NOT_AVAILABLE);
        LCL_NAME(CL_LINK_PROGRAM_FAILURE);
        LCL_NAME(CL_DEVICE_PARTITION_FAILED);
        LCL_NAME(CL_KERNEL_ARG_INFO_NOT_AVAILABLE);
        LCL_NAME(CL_INVALID_VALUE);
        LCL_NAME(CL_INVALID_DEVICE_TYPE);
        LCL_NAME(CL_INVALID_PLATFORM);
        LCL_NAME(CL_INVALID_DEVICE);
        LCL_NAME(CL_INVALID_CONTEXT);
        LCL_NAME(CL_INVALID_QUEUE_PROPERTIES);
        LCL_NAME(CL_INVALID_COMMAND_QUEUE);
        LCL_NAME(CL_INVALID_HOST_PTR);
        LCL_NAME(CL_INVALID_MEM_OBJECT);
        LCL_NAME(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR);
        LCL_NAME(CL_INVALID_IMAGE_SIZE);
        LCL_NAME(CL_INVALID_SAMPLER);
        LCL_NAME(CL_INVALID_BINARY);
        LCL_NAME(CL_INVALID_BUILD_OPTIONS);
        LCL_NAME(CL_INVALID_PROGRAM);
        LCL_NAME(CL_INVALID_PROGRAM_EXECUTABLE);
        LCL_NAME(CL_INVALID_KERNEL_NAME);
        LCL_NAME(CL_INVALID_KERNEL_DEFINITION);
        LCL_NAME(CL_INVALID_KERNEL);
        LCL_NAME(CL_INVALID_ARG_INDEX);
        LCL_NAME(CL_INVALID_ARG_VALUE);
        LCL_NAME(CL_INVALID_ARG_SIZE);
        LCL_NAME(CL_INVALID_KERNEL_ARGS);
        LCL_NAME(CL_INVALID_WORK_DIMENSION);
        LCL_NAME(CL_INVALID_WORK_GROUP_SIZE);
        LCL_NAME(CL_INVALID_WORK_ITEM_SIZE);
        LCL_NAME(CL_INVALID_GLOBAL_OFFSET);
        LCL_NAME(CL_INVALID_EVENT_WAIT_LIST);
        LCL_NAME(CL_INVALID_EVENT);
        LCL_NAME(CL_INVALID_OPERATION);
        LCL_NAME(CL_INVALID_GL_OBJECT);
        LCL_NAME(CL_INVALID_BUFFER_SIZE);
        LCL_NAME(CL_INVALID_MIP_LEVEL);
        LCL_NAME(CL_INVALID_GLOBAL_WORK_SIZE);
        LCL_NAME(CL_INVALID_PROPERTY);
        LCL_NAME(CL_INVALID_IMAGE_DESCRIPTOR);
        LCL_NAME(CL_INVALID_COMPILER_OPTIONS);
        LCL_NAME(CL_INVALID_LINKER_OPTIONS);
        LCL_NAME(CL_INVALID_DEVICE_PARTITION_COUNT);
        LCL_NAME(CL_PLATFORM_NOT_FOUND_KHR);
        default:
            return "an OpenCL error without a name";
    }
#undef LCL_NAME
}

void check(int code, const char* call, const std::string& doing) {
    if (code == CL_SUCCESS) return;
    const std::string message = std::string(call) + " failed with " + opencl_error_name(code) + " (" + std::to_string(code) + ") while " + doing;
    if (code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_HOST_MEMORY || code == CL_INVALID_BUFFER_SIZE) {
        throw OutOfMemory(message + ": use a device with more memory, or split the mesh");
    }
    throw DeviceError(code, message);
}

}  // namespace lcl
