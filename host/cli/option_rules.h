// SPDX-License-Identifier: BSD-3-Clause
// What options mean together: which exclude each other, which need each other, which choose the scheme.
#pragma once

#include <string>

#include "host/cli/options.h"

namespace lcl::cli {

/// Completes options that were parsed one by one. Throws Failure with exit code 2 where they do not fit together.
void apply_rules(Options& options);

/// Why a command takes no such option although commands that read something share it; null: it takes it.
const char* reason_against(const std::string& command, const std::string& flag);

/// The option of `interpolate` that makes its output M^1 of the two-phase scheme instead of a control mesh with IN's faces; null: none.
const char* two_phase_option(const Options& options);

}  // namespace lcl::cli
