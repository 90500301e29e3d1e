// SPDX-License-Identifier: BSD-3-Clause
// What options mean together: which exclude each other, which need each other, which choose the scheme.
#pragma once

#include "host/cli/options.h"

namespace lcl::cli {

/// Completes options that were parsed one by one. Throws Failure with exit code 2 where they do not fit together.
void apply_rules(Options& options);

}  // namespace lcl::cli
