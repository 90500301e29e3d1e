// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C: the first asks the running command to stop with nothing written, the second ends the program at once.
#pragma once

namespace lcl::cli {

/// Installs the handler of SIGINT, and ignores SIGPIPE so that a closed standard output is a write error.
void watch_signals();

bool interrupted();

/// Throws the Failure of exit code 130 if Ctrl-C was pressed.
void check_interrupt();

}  // namespace lcl::cli
