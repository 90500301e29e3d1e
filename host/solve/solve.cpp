// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "host/apply/host_arrays.h"
#include "host/solve/curves.h"
#include "host/solve/recurrences.h"

namespace lcl {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double stage_gain = 1e-4;       // what one stage of float sweeps on a correction gains at most: well above float's floor
constexpr double wide_floor = 1e-13;      // residuals of wide fields, normalised, are rounding below
constexpr double chebyshev_least = 0.02;  // below, conjugate gradients adapt better than an interval does
constexpr double estimate_margin = 0.95;  // Ritz values lie above lambda_min

double seconds_since(std::chrono::steady_clock::time_point start) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }

/// Rows from `first` to the last one.
Part from_part(const Plan& plan, const Part& first) {
    return {first.first_row, plan.row_count - first.first_row, first.first_block, static_cast<Index>(plan.blocks.size()) - first.first_block};
}

/// One solve on the device: m and x are wide (mixed), single or full.
class Solve {
public:
    Solve(LimitSystem& system, const SolveOptions& options, double unit) : system_(system), A_(*system.A), options_(options), unit_(unit) {
        const double diagonal = options.diagonal > 0 ? options.diagonal : system.diagonal;
        const bool exact = options.exact_sweeps > 0;
        const Target target = exact ? Target{} : Target{options.tolerance * diagonal / unit, options.tolerance};
        std::function<bool(int, double, double)> progress;
        if (options.progress)
            progress = [call = options.progress, unit](int iteration, double residual, double goal) { return call(iteration, residual * unit, goal * unit); };
        monitor_ = std::make_unique<Monitor>(exact ? options.exact_sweeps : options.max_iterations, target, progress, exact);
        choose();
        if (solver_ == Solver::conjugate_gradients) monitor_->allow_growth();
    }

    /// Rows before these are solved directly, and the device iterates on what is left.
    Index first_iterated_row() const { return is_refused() ? 0 : part_.first_row; }
    Monitor& monitor() { return *monitor_; }

    /// Corners and curves, in double: rows [0, first_iterated_row()) of p from those of m. p holds at least these rows.
    void solve_directly(const std::vector<double>& m, std::vector<double>& p, int channels) const {
        const Plan& plan = system_.plan();
        std::copy_n(m.begin(), static_cast<std::size_t>(plan.fixed.row_count) * channels, p.begin());
        if (first_iterated_row() > plan.curves.first_row) solve_curves(plan, m, p, channels);
    }

    void run(const Field& m, Field& x) {
        if (is_refused()) return measure(m, x);
        if (is_done_at_once(m, x)) return;
        if (part_.row_count == 0) return count_idle_sweeps(m, x);
        if (x.real() == Real::wide) iterate_mixed(m, x);
        else iterate(m, x);
        A_.context().finish();
    }

    /// Fills what the monitor knows.
    SolveReport& conclude() {
        const Spectrum& spectrum = spectrum_of(system_);
        report_.solver = solver_;
        report_.iterations = monitor_->iteration();
        report_.residuals = monitor_->history();
        for (double& residual : report_.residuals) residual *= unit_;
        report_.lambda_min = spectrum.estimate;
        report_.surface_error_bound = nan;
        return report_;
    }

    /// Compares the final residual with the tolerance and words what is wrong.
    void judge(const ResidualNorms& final_norms) {
        const double diagonal = options_.diagonal > 0 ? options_.diagonal : system_.diagonal;
        const Spectrum& spectrum = spectrum_of(system_);
        report_.max_error = final_norms.position * unit_;
        report_.channel_error = final_norms.others;
        const bool converged = report_.max_error <= options_.tolerance * diagonal && report_.channel_error <= options_.tolerance;
        const Plan& plan = system_.plan();
        const bool nothing_proven = plan.has_darts() || std::isnan(plan.lambda_min_bound);
        const bool failed =
            monitor_->outcome() == Outcome::indefinite || (monitor_->outcome() == Outcome::diverged && nothing_proven && options_.solver == Solver::automatic);
        report_.status = spectrum.indefinite || (failed && !converged) ? SolveStatus::indefinite
                         : spectrum.singular                           ? SolveStatus::singular
                         : converged                                   ? SolveStatus::converged
                                                                       : SolveStatus::not_converged;
        if (report_.status == SolveStatus::converged) return;
        report_.message = !spectrum.message.empty() ? spectrum.message : spectrum.warning.empty() ? reason() : reason() + "; " + spectrum.warning;
        report_.vertices = spectrum.message.empty() ? system_.weakest : spectrum.vertices;
    }

private:
    void choose() {
        const Plan& plan = system_.plan();
        solver_ = options_.solver;
        part_ = plan.all_rows();
        if (solver_ == Solver::conjugate_gradients && plan.has_darts())
            throw InvalidArgument("conjugate gradients need a self-adjoint operator, and with darts (creases that end inside the surface, such as at vertex " +
                                  std::to_string(plan.vertex_of_row[plan.darts.first_row]) + ") there is none: use auto, chebyshev, wpia or gs");
        if (solver_ == Solver::automatic) {
            const bool unproven = !plan.has_darts() && std::isnan(plan.lambda_min_bound);
            const bool slow = !plan.has_darts() && spectrum_of(system_).smooth < chebyshev_least;
            solver_ = unproven || slow ? Solver::conjugate_gradients : Solver::chebyshev;
        }
        if (solver_ == Solver::chebyshev || solver_ == Solver::conjugate_gradients) part_ = from_part(plan, plan.has_darts() ? plan.curves : plan.smooth);
    }

    bool is_refused() const {
        const Spectrum& spectrum = spectrum_of(system_);
        return (spectrum.singular || spectrum.indefinite) && !options_.keep_going && options_.exact_sweeps == 0;
    }

    /// Only the residual of what there is.
    void measure(const Field& m, const Field& x) {
        monitor_->begin_stage({}, 0);
        monitor_->stop(residual(m, x));
        monitor_->set_outcome(Outcome::exhausted);
    }

    /// Corners and curves are all there is, and they are solved.
    void count_idle_sweeps(const Field& m, const Field& x) {
        const ResidualNorms norms = residual(m, x);
        for (monitor_->begin_stage({}); !monitor_->stop(norms);) monitor_->advance();
    }

    bool is_done_at_once(const Field& m, const Field& x) {
        if (options_.exact_sweeps > 0) return false;
        monitor_->begin_stage(monitor_->target(), 0);
        monitor_->stop(residual(m, x));
        return monitor_->outcome() == Outcome::converged;
    }

    ResidualNorms residual(const Field& m, const Field& x) {
        const Part all = system_.plan().all_rows();
        if (x.real() == Real::wide) {
            if (!correction_right_) correction_right_ = std::make_unique<Field>(A_.make_field(x.channels(), Real::single));
            A_.wide_residual(m, x, *correction_right_, all);
            return A_.norms(*correction_right_, all);
        }
        Field r = A_.make_field(x.channels(), x.real());
        A_.sweep({0, 1, 0, 0}, m, x, nullptr, r, all);
        return A_.norms(x, all);
    }

    /// Iterative refinement: r = m - A x wide, A d = r in float, x += d. The iterates are those of the plain recurrence on x, in correction form.
    void iterate_mixed(const Field& m, Field& x) {
        ResidualNorms norms = residual(m, x);
        Field d = A_.make_field(x.channels(), Real::single);
        is_correction_ = true;
        for (;;) {
            const int before = monitor_->iteration();
            const Target& target = monitor_->target();
            stage_ = {std::max(target.position, stage_gain * norms.position), std::max(target.others, stage_gain * norms.others)};
            if (norms.position + norms.others < wide_floor) stage_ = {};  // nothing left to refine: the last stage of an exact number of sweeps
            d.fill_zero();
            iterate(*correction_right_, d);
            A_.correct(d, x, part_);
            const ResidualNorms now = residual(m, x);
            monitor_->replace_last(now);
            if (target.met_by(now)) return monitor_->set_outcome(Outcome::converged);
            if (monitor_->is_exact() && monitor_->outcome() == Outcome::converged) {
                norms = now;
                continue;
            }
            const bool helps = now.position + now.others < 0.5 * (norms.position + norms.others);
            if (monitor_->outcome() != Outcome::converged || monitor_->iteration() >= monitor_->max_iterations()) return;
            if (!helps || monitor_->iteration() == before) return monitor_->set_outcome(Outcome::stalled);
            norms = now;
        }
    }

    void iterate(const Field& m, Field& x) {
        const Target target = is_correction_ ? stage_ : monitor_->target();
        monitor_->begin_stage(target);
        switch (solver_) {
            case Solver::pia: return iterate_stationary(A_, part_, 1, false, m, x, *monitor_);
            case Solver::wpia: return iterate_stationary(A_, part_, weight(), false, m, x, *monitor_);
            case Solver::jacobi: return iterate_stationary(A_, part_, 1, true, m, x, *monitor_);
            case Solver::gauss_seidel: return iterate_gauss_seidel(A_, natural(), m, x, *monitor_);
            case Solver::gauss_seidel_coloured: return iterate_gauss_seidel(A_, coloured(), m, x, *monitor_);
            case Solver::conjugate_gradients: return iterate_conjugate_gradients(A_, part_, m, x, *monitor_);
            case Solver::automatic:
            case Solver::chebyshev: return iterate_guarded_chebyshev(m, x, target);
        }
    }

    /// Chebyshev, and where nothing is proven (darts) PIA from there if it grows or stalls.
    void iterate_guarded_chebyshev(const Field& m, Field& x, Target target) {
        const bool has_fallback = options_.solver == Solver::automatic && system_.plan().has_darts();
        std::unique_ptr<Field> start;
        if (has_fallback) {
            start = std::make_unique<Field>(A_.make_field(x.channels(), x.real()));
            start->copy_from(x);
        }
        iterate_chebyshev(A_, part_, chebyshev_low(), m, x, *monitor_);
        const bool failed = monitor_->outcome() == Outcome::diverged || (monitor_->outcome() == Outcome::stalled && !monitor_->stage_has_gained());
        if (!has_fallback || !failed) return;
        solver_ = Solver::pia;
        x.copy_from(*start);
        monitor_->begin_stage(target);
        iterate_stationary(A_, part_, 1, false, m, x, *monitor_);
    }

    double chebyshev_low() {
        const Spectrum& spectrum = spectrum_of(system_);
        const double margin = system_.plan().has_darts() ? 0.5 : estimate_margin;
        const double low = std::max(std::isnan(spectrum.bound) ? 0.0 : spectrum.bound, margin * spectrum.smooth);
        const bool with_curves = system_.plan().has_darts() && system_.plan().curves.row_count > 0;
        return std::clamp(with_curves ? std::min(low, 1.0 / 3) : low, 1e-4, 0.999);
    }

    // best w = 2 / (lambda_min + lambda_max), lambda_max = 1 (Loop PIA paper)
    double weight() {
        if (options_.weight > 0) return options_.weight;
        const Spectrum& spectrum = spectrum_of(system_);
        return 2 / (1 + std::max(0.0, std::isnan(spectrum.estimate) ? std::min(0.5 * spectrum.smooth, 1.0 / 3) : spectrum.estimate));
    }

    const Schedule& natural() {
        if (!system_.natural) system_.natural = natural_schedule(system_.plan());
        return *system_.natural;
    }
    const Schedule& coloured() {
        if (!system_.coloured) system_.coloured = coloured_schedule(system_.plan());
        return *system_.coloured;
    }

    std::string reason() const {
        const std::string after = " after " + std::to_string(monitor_->iteration()) + " iterations";
        const char* other = options_.solver == Solver::automatic ? ": allow more iterations, or use a larger alpha" : ": use solver auto";
        switch (monitor_->outcome()) {
            case Outcome::diverged:
                return "the residual grows, this iteration does not converge on this operator" + after +
                       (solver_ == Solver::jacobi ? ": Jacobi is sure to converge only under diagonal dominance (lambda of 1/3 or more), use auto" : other);
            case Outcome::stalled:
                if (monitor_->history().back() < wide_floor) return "the tolerance lies below what the arithmetic reaches" + after + ": use a larger one";
                return "the residual no longer falls" + after + (options_.precision == Precision::single ? ": single precision ends here, use mixed" : other);
            case Outcome::indefinite:
                return "a negative eigenvalue was met, the limit operator is indefinite: use a larger alpha (0.5; alpha auto does so) or a lambda above 0";
            case Outcome::converged: return "the values are kept in float, which cannot hold them to this tolerance: use fields of double precision";
            case Outcome::exhausted: break;
        }
        return "the tolerance was not reached" + after + other;
    }

    LimitSystem& system_;
    DeviceOperator& A_;
    const SolveOptions& options_;
    const double unit_;  // model units of 1 in the fields
    Solver solver_ = Solver::automatic;
    Part part_;
    Target stage_;
    bool is_correction_ = false;
    std::unique_ptr<Monitor> monitor_;
    std::unique_ptr<Field> correction_right_;
    SolveReport report_;
};

/// Bound of the distance to the exact solution, part by part: fixed rows are off by their residual, curves by at most 1/(2 a_ii - 1) times it, the smooth block
/// by |A^-1|_inf times its residual and what the error of the other rows adds to it. NaN with darts.
double error_bound(LimitSystem& system, double max_error) {
    const Plan& plan = system.plan();
    if (plan.has_darts()) return nan;
    double outer_error = plan.fixed.row_count > plan.isolated_count ? max_error : 0;
    for (Index row = plan.curves.first_row; row < plan.curves.end_row(); ++row) outer_error = std::max(outer_error, max_error / (2 * plan.diagonal[row] - 1));
    if (plan.smooth.row_count == 0) return outer_error;
    return std::max(outer_error, inverse_norm_of(system).value * (max_error + outer_error));
}

void certify(LimitSystem& system, const SolveOptions& options, SolveReport& report) {
    const bool has_inverse = report.status == SolveStatus::converged || report.status == SolveStatus::not_converged;
    if (options.certify && has_inverse) report.surface_error_bound = error_bound(system, report.max_error);
}

Field widened(DeviceOperator& A, const Field& field) {
    Field wide = A.make_field(field.channels(), Real::wide);
    wide.fill_zero();
    A.correct(field, wide, {0, field.rows(), 0, 0});
    return wide;
}

/// Residual of what the fields hold, in double or pairs whatever their precision.
ResidualNorms device_residual(DeviceOperator& A, const Field& m, const Field& x) {
    const Part all = A.plan().all_rows();
    Field r = A.make_field(x.channels(), x.real());
    if (x.real() == Real::single) {
        A.wide_residual(widened(A, m), widened(A, x), r, all);
        return A.norms(r, all);
    }
    A.sweep({0, 1, 0, 0}, m, x, nullptr, r, all);
    return A.norms(x, all);
}

void refuse_ghosts(const Plan& plan) {
    if (plan.row_count < plan.vertex_count)
        throw Unsupported("this operator has rows for " + std::to_string(plan.row_count) + " of its " + std::to_string(plan.vertex_count) +
                          " vertices: drive its parts by single sweeps (lcl_operator_step) and exchange the ghosts between them");
}

}  // namespace

SolveReport solve_host(LimitSystem& system, const double* M, std::size_t stride, int channels, const SolveOptions& options, bool warm_start, double* P,
                       std::size_t P_stride) {
    const Plan& plan = system.plan();
    refuse_ghosts(plan);
    const auto start = std::chrono::steady_clock::now();
    const Transform transform = fit_transform(plan, M, stride, channels);
    Solve solve(system, options, 1 / transform.scale[0]);
    const std::vector<double> m = to_plan_order(plan, transform, M, stride, channels);
    std::vector<double> p = warm_start ? to_plan_order(plan, transform, P, P_stride, channels) : m;
    if (solve.first_iterated_row() > plan.isolated_count) {
        solve.monitor().begin_with(host_residual(plan, m, p, channels));
        solve.solve_directly(m, p, channels);
    }
    const Real real = real_of(options.precision);
    Field device_m = system.A->make_field(channels, real), device_p = system.A->make_field(channels, real);
    device_m.upload(m.data(), 0, plan.vertex_count);
    device_p.upload(p.data(), 0, plan.vertex_count);
    const double seconds_upload = seconds_since(start);

    const auto solve_start = std::chrono::steady_clock::now();
    solve.run(device_m, device_p);
    SolveReport& report = solve.conclude();
    report.seconds_upload = seconds_upload;
    report.seconds_solve = seconds_since(solve_start);

    const auto download_start = std::chrono::steady_clock::now();
    device_p.download(p.data(), 0, plan.vertex_count);
    solve.judge(host_residual(plan, m, p, channels));
    const std::vector<double> kept = kept_rows(plan, M, stride, channels);  // P may be M
    from_plan_order(plan, transform, p, channels, P, P_stride);
    restore_rows(plan, kept, channels, P, P_stride);
    report.seconds_download = seconds_since(download_start);
    certify(system, options, report);
    return report;
}

SolveReport solve_fields(LimitSystem& system, const Field& M, const Transform& transform, const SolveOptions& options, bool warm_start, Field& P) {
    const Plan& plan = system.plan();
    refuse_ghosts(plan);
    const auto start = std::chrono::steady_clock::now();
    Solve solve(system, options, 1 / transform.scale[0]);
    if (!warm_start) P.copy_from(M);
    if (solve.first_iterated_row() > plan.isolated_count) {
        solve.monitor().begin_with(device_residual(*system.A, M, P));
        std::vector<double> m(static_cast<std::size_t>(solve.first_iterated_row()) * M.channels());
        M.download(m.data(), 0, solve.first_iterated_row());
        std::vector<double> p = m;
        solve.solve_directly(m, p, M.channels());
        P.upload(p.data(), 0, solve.first_iterated_row());
    }
    if (options.precision == Precision::mixed && M.real() == Real::single) {
        const Field m = widened(*system.A, M);
        Field p = widened(*system.A, P);
        solve.run(m, p);
        system.A->narrow(p, P);
    } else {
        solve.run(M, P);
    }
    SolveReport& report = solve.conclude();
    report.seconds_solve = seconds_since(start);
    solve.judge(device_residual(*system.A, M, P));
    certify(system, options, report);
    return report;
}

}  // namespace lcl
