// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/monitor.h"

#include <algorithm>
#include <cmath>

namespace lcl {
namespace {

constexpr double growth_limit = 10;  // times the stage's first residual: stationary and Chebyshev iterations that converge on these operators were never seen
                                     // to grow so far, darts included
constexpr int patience = 30;         // iterations without ...
constexpr double least_progress = 0.99;  // ... this factor on the best residual are a stall

}  // namespace

void Monitor::begin_stage(Target target, int limit) {
    stage_ = target;
    limit_ = limit < 0 ? max_iterations_ : std::min(limit, max_iterations_);
    first_ = best_ = -1;
    best_iteration_ = iteration_;
}

void Monitor::begin_with(const ResidualNorms& residual) {
    if (is_exact_) {
        exact_start_ = residual.position;
        return;
    }
    history_ = {residual.position};
    iteration_ = 1;
}

void Monitor::replace_last(const ResidualNorms& residual) {
    const bool is_new = history_.size() <= static_cast<std::size_t>(iteration_);
    history_.resize(iteration_ + 1);
    if (iteration_ > 0 || exact_start_ < 0) history_.back() = residual.position;
    if (is_new) report(residual);
}

bool Monitor::stop_after(const std::vector<ResidualNorms>& residuals) {
    bool is_over = false;
    for (const ResidualNorms& residual : residuals) {
        is_over = is_over || stop(residual);
        history_.resize(iteration_ + 1);
        history_.back() = iteration_ == 0 && exact_start_ >= 0 ? exact_start_ : residual.position;
        advance();
    }
    return is_over;
}

void Monitor::report(const ResidualNorms& residual) const {
    if (progress_ && !progress_(iteration_, residual.position, target_.position))
        throw Cancelled("the solve was cancelled after " + std::to_string(iteration_) + " iterations");
}

bool Monitor::has_stalled(double size) {
    if (best_ < 0 || size < least_progress * best_) {
        best_ = size;
        best_iteration_ = iteration_;
    }
    return iteration_ - best_iteration_ >= patience;
}

bool Monitor::stop(const ResidualNorms& residual) {
    history_.resize(iteration_ + 1);
    history_.back() = iteration_ == 0 && exact_start_ >= 0 ? exact_start_ : residual.position;
    const double size = residual.position + residual.others;
    if (first_ < 0) first_ = size;
    report(residual);
    const auto end = [&](Outcome outcome) {
        outcome_ = outcome;
        return true;
    };
    if (stage_.met_by(residual)) return end(Outcome::converged);
    if (!std::isfinite(size) || (!is_exact_ && !growth_is_allowed_ && size > growth_limit * first_)) return end(Outcome::diverged);
    if (iteration_ >= limit_) return end(Outcome::exhausted);
    return !is_exact_ && has_stalled(size) && end(Outcome::stalled);
}

}  // namespace lcl
