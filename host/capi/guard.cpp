// SPDX-License-Identifier: BSD-3-Clause
#include "host/capi/guard.h"

#include <new>

#include "host/device/device.h"

namespace lcl {
namespace {

lcl_status fail(lcl_status status, const char* message, const Where& where = {}) {
    try {
        last_error() = {message, where};
    } catch (const std::bad_alloc&) {  // no room for the sentence: the status says it
        last_error().message.clear();
    }
    return status;
}

bool is_opencl_code(int code) { return code < 0 && code > -100; }

}  // namespace

LastError& last_error() {
    thread_local LastError error;
    return error;
}

lcl_status current_failure() noexcept {
    try {
        throw;
    } catch (const InvalidArgument& e) {
        return fail(LCL_ERROR_INVALID_ARGUMENT, e.what(), e.where);
    } catch (const BadInput& e) {
        return fail(LCL_ERROR_BAD_INPUT, e.what(), e.where);
    } catch (const Unsupported& e) {
        return fail(LCL_ERROR_UNSUPPORTED, e.what(), e.where);
    } catch (const FileError& e) {
        return fail(LCL_ERROR_FILE, e.what(), e.where);
    } catch (const WriteError& e) {
        return fail(LCL_ERROR_WRITE, e.what(), e.where);
    } catch (const NoDevice& e) {
        return fail(LCL_ERROR_NO_DEVICE, e.what(), e.where);
    } catch (const OutOfMemory& e) {
        return fail(LCL_ERROR_MEMORY, e.what(), e.where);
    } catch (const Cancelled& e) {
        return fail(LCL_ERROR_CANCELLED, e.what(), e.where);
    } catch (const DeviceError& e) {
        return fail(is_opencl_code(e.code) ? e.code : LCL_ERROR_INTERNAL, e.what(), e.where);
    } catch (const std::bad_alloc&) {
        return fail(LCL_ERROR_MEMORY, "the host has not enough memory for this mesh: split it, or use a machine with more");
    } catch (const std::exception& e) {
        return fail(LCL_ERROR_INTERNAL, e.what());
    } catch (...) {
        return fail(LCL_ERROR_INTERNAL, "an unknown exception was thrown");
    }
}

}  // namespace lcl

extern "C" {

const char* lcl_last_error(void) { return lcl::last_error().message.c_str(); }

size_t lcl_last_error_vertices(int32_t* vertices, size_t capacity) {
    const auto& kept = lcl::last_error().where.vertices;
    if (vertices != nullptr) std::copy_n(kept.begin(), std::min(capacity, kept.size()), vertices);
    return kept.size();
}

size_t lcl_last_error_faces(int32_t* faces, size_t capacity) {
    const auto& kept = lcl::last_error().where.faces;
    if (faces != nullptr) std::copy_n(kept.begin(), std::min(capacity, kept.size()), faces);
    return kept.size();
}

const char* lcl_status_string(lcl_status status) {
#define LCL_NAME(name) \
    case name: return #name;
    switch (status) {
        LCL_NAME(LCL_OK)
        LCL_NAME(LCL_ERROR_INVALID_ARGUMENT)
        LCL_NAME(LCL_ERROR_BAD_INPUT)
        LCL_NAME(LCL_ERROR_UNSUPPORTED)
        LCL_NAME(LCL_ERROR_FILE)
        LCL_NAME(LCL_ERROR_WRITE)
        LCL_NAME(LCL_ERROR_NO_DEVICE)
        LCL_NAME(LCL_ERROR_MEMORY)
        LCL_NAME(LCL_ERROR_CANCELLED)
        LCL_NAME(LCL_ERROR_INTERNAL)
        LCL_NAME(LCL_ERROR_SINGULAR)
        LCL_NAME(LCL_ERROR_INDEFINITE)
        LCL_NAME(LCL_ERROR_NOT_CONVERGED)
        default: return lcl::opencl_error_name(status);
    }
#undef LCL_NAME
}

int32_t lcl_version(void) { return LCL_VERSION_MAJOR * 10000 + LCL_VERSION_MINOR * 100 + LCL_VERSION_PATCH; }

#define LCL_TEXT_(x) #x
#define LCL_TEXT(x) LCL_TEXT_(x)
const char* lcl_version_string(void) { return LCL_TEXT(LCL_VERSION_MAJOR) "." LCL_TEXT(LCL_VERSION_MINOR) "." LCL_TEXT(LCL_VERSION_PATCH); }

#ifndef LIMITCL_BUILD_TYPE
#define LIMITCL_BUILD_TYPE "custom"
#endif
#ifndef LIMITCL_REVISION
#define LIMITCL_REVISION "unknown"
#endif
const char* lcl_build_string(void) { return LIMITCL_BUILD_TYPE " build, compiler " __VERSION__ ", revision " LIMITCL_REVISION; }

}  // extern "C"
