// SPDX-License-Identifier: BSD-3-Clause
// Handles that tests share are closed when all have run. Not by static destructors: where the program ends, OpenCL implementations take their static objects
// and threads apart, oclgrind before ours go, and PoCL aborts over a kernel that it is still compiling.
#pragma once

#include <functional>
#include <vector>

/// Called in reverse order by test_main.cpp.
inline std::vector<std::function<void()>>& at_end() {
    static std::vector<std::function<void()>> list;
    return list;
}
