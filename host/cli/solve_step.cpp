// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/solve_step.h"

#include <algorithm>
#include <cmath>

#include "host/cli/interrupt.h"

namespace lcl::cli {

namespace {

constexpr int most_residuals = 1 << 22;

double fraction_done(SolveProgress& state, std::int32_t iteration, double residual, double target) {
    if (state.sweeps > 0) return static_cast<double>(iteration) / state.sweeps;
    const bool is_new_solve = iteration < state.iteration;
    state.iteration = iteration;
    if (state.first <= 0.0 || is_new_solve) state.first = residual;
    if (!(residual > 0.0) || !(target > 0.0) || state.first <= target) return -1.0;
    return std::clamp(std::log(state.first / residual) / std::log(state.first / target), 0.0, 1.0);
}

}  // namespace

std::int32_t on_solve_progress(void* user, std::int32_t iteration, double residual, double target) {
    SolveProgress& state = *static_cast<SolveProgress*>(user);
    const double fraction = fraction_done(state, iteration, residual, target);
    state.progress->update(fraction, "sweep " + std::to_string(iteration) + ", residual " + short_number(residual) + " of " + short_number(target));
    return interrupted() ? 0 : 1;
}

bool is_result(lcl_status status) { return status == LCL_ERROR_SINGULAR || status == LCL_ERROR_INDEFINITE || status == LCL_ERROR_NOT_CONVERGED; }

/// The last error has the sentence and the places where the report's are empty.
Failure failure_of_result(lcl_status status, const lcl_solve_report& report) {
    Failure failure = failure_of(status);
    if (report.message[0] != '\0') failure.message = one_line(report.message);
    if (report.vertex_count > 0) failure.vertices.assign(report.vertices, report.vertices + report.vertex_count);
    return failure;
}

std::vector<double> residual_space(int max_iterations) { return std::vector<double>(static_cast<std::size_t>(std::min(max_iterations, most_residuals)) + 1); }

void note_solve(Job& job, const lcl_solve_report& report, std::vector<double> residuals) {
    residuals.resize(std::min(residuals.size(), report.residual_count));
    job.report.solve.emplace();
    job.report.solve->report = report;
    job.report.solve->report.residuals = nullptr;
    job.report.solve->residuals = std::move(residuals);
}

}  // namespace lcl::cli
