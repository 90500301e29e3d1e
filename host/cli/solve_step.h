// SPDX-License-Identifier: BSD-3-Clause
// What the commands that solve share: the progress line, and results that are no success.
#pragma once

#include <vector>

#include "host/cli/failure.h"
#include "host/cli/job.h"

namespace lcl::cli {

/// What the progress line needs between two calls.
struct SolveProgress {
    Progress* progress;
    int sweeps;                  ///< asked for, 0: until the tolerance
    std::int32_t iteration = 0;  ///< of the last call
    double first = 0.0;          ///< residual of the solve's first call
};

/// A lcl_progress_callback whose user is a SolveProgress; Ctrl-C cancels.
std::int32_t on_solve_progress(void* user, std::int32_t iteration, double residual, double target);

/// Singular, indefinite, not converged: there is something to write under --keep-going.
bool is_result(lcl_status status);

/// Failure of such a status, with the sentence and the places of the solve's report.
Failure failure_of_result(lcl_status status, const lcl_solve_report& report);

/// Room for the residuals of a solve. A longer history is cut: 32 MiB, whatever --max-iter says.
std::vector<double> residual_space(int max_iterations);

/// Puts a solve and the residuals of its iterations into the report of the command.
void note_solve(Job& job, const lcl_solve_report& report, std::vector<double> residuals);

}  // namespace lcl::cli
