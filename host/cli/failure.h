// SPDX-License-Identifier: BSD-3-Clause
// How the program ends: exit codes, and the exception that carries one with its sentence.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <limitcl/limitcl.h>

namespace lcl::cli {

enum ExitCode { exit_ok = 0, exit_error = 1, exit_usage = 2, exit_bad_input = 3, exit_no_result = 4, exit_device = 5, exit_interrupted = 130 };

/// The end of a command that did not do its job: what the report and the line on standard error say.
struct Failure {
    int exit_code = exit_error;
    std::string status = "error";  ///< name in the report
    std::string message;           ///< one sentence: what, where, what to do
    std::vector<std::int32_t> vertices, faces;
};

/// Failure with the status name that belongs to the exit code (codes 4 and 5 have several: see failure_of).
Failure make_failure(int exit_code, const std::string& message);

/// Failure of a library call that just returned `status`: exit code, status name, sentence and places.
Failure failure_of(lcl_status status);

/// Throws failure_of(status) unless it is LCL_OK.
void check(lcl_status status);

/// Throws make_failure(exit_code, message).
[[noreturn]] void fail(int exit_code, const std::string& message);

/// The same text without line breaks: every failure and warning is one line.
std::string one_line(std::string text);

}  // namespace lcl::cli
