// SPDX-License-Identifier: BSD-3-Clause
// What somebody runs first on a new device: every kernel against plain double loops on the host, on built-in meshes.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "host/device/device.h"

namespace lcl {

struct SelftestResult {
    std::string kernel, what;
    double difference = 0, tolerance = 0;
    bool passed() const { return difference <= tolerance; }
};

/// Runs all; true if every one agrees.
bool run_selftest(const std::shared_ptr<Context>& context, const std::function<void(const SelftestResult&)>& report);

}  // namespace lcl
