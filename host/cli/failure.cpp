// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

const char* status_of_exit_code(int exit_code) {
    switch (exit_code) {
        case exit_ok: return "ok";
        case exit_bad_input: return "bad-input";
        case exit_interrupted: return "cancelled";
        default: return "error";
    }
}

int exit_code_of(lcl_status status) {
    switch (status) {
        case LCL_OK: return exit_ok;
        case LCL_ERROR_INVALID_ARGUMENT: return exit_usage;
        case LCL_ERROR_BAD_INPUT:
        case LCL_ERROR_FILE:
        case LCL_ERROR_UNSUPPORTED: return exit_bad_input;  // a device without doubles is caught when the device is opened, so this is about the mesh
        case LCL_ERROR_SINGULAR:
        case LCL_ERROR_INDEFINITE:
        case LCL_ERROR_NOT_CONVERGED: return exit_no_result;
        case LCL_ERROR_NO_DEVICE:
        case LCL_ERROR_MEMORY: return exit_device;
        case LCL_ERROR_CANCELLED: return exit_interrupted;
        default: return status < 0 && status > -1000 ? exit_device : exit_error;  // OpenCL's own codes are above -1000
    }
}

std::string status_name(lcl_status status) {
    switch (status) {
        case LCL_ERROR_SINGULAR: return "singular";
        case LCL_ERROR_INDEFINITE: return "indefinite";
        case LCL_ERROR_NOT_CONVERGED: return "not-converged";
        case LCL_ERROR_NO_DEVICE: return "no-device";
        default: return status_of_exit_code(exit_code_of(status));
    }
}

std::vector<std::int32_t> last_places(size_t (*get)(std::int32_t*, size_t)) {
    std::vector<std::int32_t> places(10);
    places.resize(get(places.data(), places.size()));
    return places;
}

}  // namespace

Failure make_failure(int exit_code, const std::string& message) { return {exit_code, status_of_exit_code(exit_code), one_line(message), {}, {}}; }

Failure failure_of(lcl_status status) {
    Failure failure = make_failure(exit_code_of(status), lcl_last_error());
    failure.status = status_name(status);
    if (failure.message.empty()) failure.message = lcl_status_string(status);
    if (status == LCL_ERROR_CANCELLED) failure.message = "interrupted: nothing was written";
    failure.vertices = last_places(lcl_last_error_vertices);
    failure.faces = last_places(lcl_last_error_faces);
    return failure;
}

void check(lcl_status status) {
    if (status != LCL_OK) throw failure_of(status);
}

void fail(int exit_code, const std::string& message) { throw make_failure(exit_code, message); }

std::string one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    for (char& character : text) {
        if (character == '\n' || character == '\r') character = ' ';
    }
    return text;
}

}  // namespace lcl::cli
