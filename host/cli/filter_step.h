// SPDX-License-Identifier: BSD-3-Clause
// The steps that the commands of the mesh expansion share: an operator and the values that it acts on, passes with progress, the way back.
#pragma once

#include <string>
#include <vector>

#include "host/cli/failure.h"
#include "host/cli/job.h"

namespace lcl::cli {

/// A mesh with its operator on a device.
struct Filter {
    Mesh mesh;
    Context context;
    Operator A;
    std::vector<std::int32_t> pinned;   ///< vertices of --pin: they keep their values
    std::vector<std::string> channels;  ///< names of the channels behind x, y, z
    std::vector<double> colour_limits;  ///< one a channel, see channels.h
    std::vector<double> values;         ///< vertex_count x width(): points and channels
    std::int32_t width() const { return static_cast<std::int32_t>(3 + channels.size()); }
};

/// The operator that the options ask for, on a device that is being opened. Parameters, scheme and device get into the report.
Filter open_filter(Job& job, DeviceOpening& device, Mesh mesh);

/// A lcl_pass_callback whose user is the terminal's Progress; Ctrl-C cancels.
std::int32_t on_pass(void* user, std::int64_t done, std::int64_t all);

/// One library call, timed as the solve. `call` returns its status.
template <typename Call>
void run_passes(Job& job, const Filter& filter, const std::string& what, Call call) {
    const Phase phase(job, &Seconds::solve, what, filter.context.get());
    check(call());
}

}  // namespace lcl::cli
