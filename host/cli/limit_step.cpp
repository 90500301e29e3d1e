// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/limit_step.h"

#include "host/cli/channels.h"
#include "host/cli/failure.h"

namespace lcl::cli {

void move_to_limit(Job& job, lcl_context context, lcl_operator A, lcl_mesh mesh, const std::vector<std::string>& channels) {
    std::vector<double> values = gather_values(mesh, channels);
    {
        const Phase phase(job, &Seconds::solve, "taking limit points", context);
        check(lcl_limit_points(A, values.data(), 0, static_cast<std::int32_t>(3 + channels.size()), job.options.precision, values.data(), 0));
    }
    scatter_values(mesh, channels, values.data());
}

}  // namespace lcl::cli
