// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lcl::cli {

/// The whole program: options, command, report. Returns the exit code.
int run_program(int argc, char** argv);

}  // namespace lcl::cli
