// SPDX-License-Identifier: BSD-3-Clause
// When an iteration stops: tolerance, limit, stall, divergence, cancel. Keeps the history of residuals.
#pragma once

#include <functional>
#include <vector>

#include "host/apply/host_operator.h"

namespace lcl {

enum class Outcome {
    converged,
    exhausted,   ///< as many iterations as were allowed
    stalled,     ///< the residual no longer falls: the precision's end, or a slow operator
    diverged,    ///< the residual grows
    indefinite,  ///< a direction of negative curvature was met: proof of a negative eigenvalue
};

/// Largest row norms that are small enough, in the fields' normalised units. Below 0: none is.
struct Target {
    double position = -1, others = -1;
    bool met_by(const ResidualNorms& e) const { return e.position <= position && e.others <= others; }
};

class Monitor {
public:
    /// progress(iteration, residual, target) returns false to cancel (throws Cancelled); may be empty. is_exact: max_iterations are made whatever the residual
    /// does, unless it is no number.
    Monitor(int max_iterations, Target target, std::function<bool(int, double, double)> progress, bool is_exact = false)
        : max_iterations_(max_iterations), target_(target), progress_(std::move(progress)), is_exact_(is_exact) {}

    /// Conjugate gradients lower the error, not the residual: it may grow on the way, and growth is no sign of divergence.
    void allow_growth() { growth_is_allowed_ = true; }
    /// Starts a stage that ends when `target` is met or after `limit` iterations in all (below 0: the monitor's own).
    void begin_stage(Target target, int limit = -1);
    /// Takes the residual of the iterate after iteration() iterations; true if the stage is over, and outcome() says why.
    bool stop(const ResidualNorms& residual);
    /// The same for the residuals of consecutive iterates that were made in one go, the last of which led to the iterate that there is now.
    bool stop_after(const std::vector<ResidualNorms>& residuals);
    /// The residual of P_0, where a direct solve of corners and curves comes before the iterations: it counts as the first of them, unless their number is
    /// exact.
    void begin_with(const ResidualNorms& residual);
    /// One more iteration was made.
    void advance() { ++iteration_; }

    /// The stage's residual fell to a thousandth: what stalls then is the precision, not the iteration.
    bool stage_has_gained() const { return best_ >= 0 && best_ < 1e-3 * first_; }
    int iteration() const { return iteration_; }
    int max_iterations() const { return max_iterations_; }
    bool is_exact() const { return is_exact_; }
    Outcome outcome() const { return outcome_; }
    void set_outcome(Outcome outcome) { outcome_ = outcome; }
    const Target& target() const { return target_; }
    /// E_0 .. E_iteration, normalised.
    const std::vector<double>& history() const { return history_; }
    /// Sets the last entry to a residual that is known better.
    void replace_last(const ResidualNorms& residual);
    /// Iterations that the stage may still make, and what it is to reach.
    int remaining() const { return limit_ - iteration_; }
    const Target& stage_target() const { return stage_; }

private:
    void report(const ResidualNorms& residual) const;
    bool has_stalled(double size);

    int max_iterations_, limit_ = 0, iteration_ = 0;
    Target target_, stage_;
    std::function<bool(int, double, double)> progress_;
    bool is_exact_ = false, growth_is_allowed_ = false;
    Outcome outcome_ = Outcome::exhausted;
    std::vector<double> history_;
    double first_ = -1, best_ = -1;
    int best_iteration_ = 0;
    double exact_start_ = -1;  // E_0 before the direct solve, kept as the first of an exact number
};

}  // namespace lcl
