// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "host/apply/host_arrays.h"
#include "host/solve/curves.h"
#include "host/solve/recurrences.h"
#include "host/solve/words.h"

namespace lcl {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double stage_gain = 1e-4;       // what one stage of float sweeps on a correction gains at most: well above float's floor
constexpr double float_reach = 5e-7;      // residuals, normalised, that float sweeps on the values themselves are sure to reach
constexpr Index sampled_share = 16;       // of the blocks: what the first residual is taken from
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
        const double diagonal = model_size(system, options, unit);
        const bool exact = options.exact_sweeps > 0;
        const Target target = exact ? Target{} : Target{options.tolerance * diagonal / unit, options.tolerance};
        std::function<bool(int, double, double)> progress;
        if (options.progress)
            progress = [call = options.progress, unit](int iteration, double residual, double goal) { return call(iteration, residual * unit, goal * unit); };
        monitor_ = std::make_unique<Monitor>(exact ? options.exact_sweeps : options.max_iterations, target, progress, exact);
        choose();
        const bool may_grow_first = !system.plan().has_scaling;  // E - A may be far from normal
        if (solver_ == Solver::conjugate_gradients || may_grow_first) monitor_->allow_growth();
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

    /// The residual of what x then holds, in double or pairs of floats, over all rows.
    ResidualNorms run(const Field& m, Field& x) {
        fields_are_float_ = x.real() == Real::single;
        const ResidualNorms start = first_residual(m, x);
        if (is_refused()) return measure(start);
        if (is_done_at_once(start)) return start;
        if (part_.row_count == 0) return count_idle_sweeps(start);
        return x.real() == Real::full ? iterate_double(start, m, x) : iterate_corrections(start, m, x);
    }

    /// Leaves m - A x in the field `right`.
    ResidualNorms residual(const Field& m, const Field& x) {
        const Part all = system_.plan().all_rows();
        const bool is_full = x.real() == Real::full;
        Field& r = work(LimitSystem::Purpose::right, x, is_full ? Real::full : Real::single);
        if (is_full) A_.sweep({0, 1, 0, 0}, m, x, nullptr, r, all);
        else A_.wide_residual(m, x, r, all);
        return A_.norms(r, all);
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
        const double diagonal = model_size(system_, options_, unit_);
        const Spectrum& spectrum = spectrum_of(system_);
        report_.max_error = final_norms.position * unit_;
        report_.channel_error = final_norms.others;
        const bool converged = report_.max_error <= options_.tolerance * diagonal && report_.channel_error <= options_.tolerance;
        const Plan& plan = system_.plan();
        const bool nothing_proven = plan.has_scaling && (plan.has_darts() || std::isnan(plan.lambda_min_bound));  // other rows may be far from normal
        const bool failed =
            monitor_->outcome() == Outcome::indefinite || (monitor_->outcome() == Outcome::diverged && nothing_proven && options_.solver == Solver::automatic);
        report_.status = spectrum.indefinite ? SolveStatus::indefinite
                         : spectrum.singular ? SolveStatus::singular  // also where rounding made iterations meet a negative eigenvalue
                         : converged         ? SolveStatus::converged
                         : failed            ? SolveStatus::indefinite
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
        require_symmetric_form(system_, solver_);
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
    ResidualNorms measure(const ResidualNorms& norms) {
        monitor_->begin_stage({}, 0);
        monitor_->stop(norms);
        monitor_->set_outcome(Outcome::exhausted);
        return norms;
    }

    /// Corners and curves are all there is, and they are solved.
    ResidualNorms count_idle_sweeps(const ResidualNorms& norms) {
        for (monitor_->begin_stage({}); !monitor_->stop(norms);) monitor_->advance();
        return norms;
    }

    bool is_done_at_once(const ResidualNorms& start) {
        if (options_.exact_sweeps > 0 || !monitor_->target().met_by(start)) return false;
        monitor_->begin_stage(monitor_->target(), 0);
        return monitor_->stop(start);
    }

    Field& work(LimitSystem::Purpose purpose, const Field& like, Real real) { return system_.work_field(purpose, like.channels(), real); }

    /// Only of some blocks where nothing but the number of sweeps depends on it.
    ResidualNorms first_residual(const Field& m, const Field& x) {
        const Index count = part_.block_count / sampled_share;
        if (count == 0 || is_refused() || !is_direct(x, monitor_->target(), 0)) return residual(m, x);
        Part sample = part_;
        sample.first_block += (part_.block_count - count) / 2;
        sample.block_count = count;
        Field& r = work(LimitSystem::Purpose::right, x, Real::single);
        A_.wide_residual(m, x, r, sample);
        const ResidualNorms some = A_.norms(r, sample);
        return monitor_->target().met_by(some) ? residual(m, x) : some;
    }

    ResidualNorms iterate_double(ResidualNorms norms, const Field& m, Field& x) {
        for (;;) {
            iterate(norms, monitor_->target(), m, x);
            const ResidualNorms now = residual(m, x);
            const bool helps = now.position + now.others < 0.5 * (norms.position + norms.others);
            monitor_->replace_last(now);
            if (monitor_->target().met_by(now)) monitor_->set_outcome(Outcome::converged);
            else if (monitor_->outcome() == Outcome::converged && helps && monitor_->remaining() > 0) {
                norms = now;
                continue;
            } else if (monitor_->outcome() == Outcome::converged) monitor_->set_outcome(helps ? Outcome::exhausted : Outcome::stalled);
            return now;
        }
    }

    /// Iterative refinement: r = m - A x wide, A d = r in float, x += d. The iterates are those of the plain recurrence on x, in correction form.
    ResidualNorms iterate_corrections(ResidualNorms norms, const Field& m, Field& x) {
        for (;;) {
            const int before = monitor_->iteration();
            const Target& target = monitor_->target();
            Target stage{std::max(target.position, stage_gain * norms.position), std::max(target.others, stage_gain * norms.others)};
            if (norms.position + norms.others < wide_floor) stage = {};  // nothing left to refine: the last stage of an exact number of sweeps
            if (is_direct(x, stage, before)) {
                iterate(norms, stage, m, x);
                norms.position = std::max(norms.position, monitor_->history()[before]);  // of all blocks: the first one may be of a sample
            } else {
                add_correction(norms, stage, x);
            }
            const ResidualNorms now = residual(m, x);
            monitor_->replace_last(now);
            const bool helps = now.position + now.others < 0.5 * (norms.position + norms.others);
            norms = now;
            if (target.met_by(now)) {
                monitor_->set_outcome(Outcome::converged);
                return now;
            }
            if (monitor_->is_exact() && monitor_->outcome() == Outcome::converged) continue;
            if (monitor_->outcome() != Outcome::converged || monitor_->remaining() <= 0) return now;
            if (!helps || monitor_->iteration() == before) {
                monitor_->set_outcome(Outcome::stalled);
                return now;
            }
        }
    }

    /// Float sweeps on float fields reach what is asked for, so that corrections of what they leave are not needed: Chebyshev's first stage, whose end is
    /// measured in any case.
    bool is_direct(const Field& x, const Target& stage, int iteration) const {
        const bool is_chebyshev = solver_ == Solver::automatic || solver_ == Solver::chebyshev;
        return x.real() == Real::single && is_chebyshev && iteration <= 1 && !monitor_->is_exact() && !system_.plan().has_darts() &&
               stage.position >= float_reach && stage.others >= float_reach;
    }

    /// d with A d = r, the residual in the field `right`, and x += d.
    void add_correction(const ResidualNorms& norms, const Target& stage, Field& x) {
        Field& d = work(LimitSystem::Purpose::correction, x, Real::single);
        d.fill_zero();
        iterate(norms, stage, work(LimitSystem::Purpose::right, x, Real::single), d);
        A_.correct(d, x, part_);
    }

    /// One stage from the residual `start` of x.
    void iterate(const ResidualNorms& start, Target target, const Field& m, Field& x) {
        monitor_->begin_stage(target);
        switch (solver_) {
            case Solver::pia: return iterate_stationary(A_, part_, 1, false, m, x, *monitor_);
            case Solver::wpia: return iterate_stationary(A_, part_, weight(), false, m, x, *monitor_);
            case Solver::jacobi: return iterate_stationary(A_, part_, 1, true, m, x, *monitor_);
            case Solver::gauss_seidel: return iterate_gauss_seidel(A_, natural(), m, x, *monitor_);
            case Solver::gauss_seidel_coloured: return iterate_gauss_seidel(A_, coloured(), m, x, *monitor_);
            case Solver::conjugate_gradients: return iterate_conjugate_gradients(A_, part_, m, x, *monitor_);
            case Solver::automatic:
            case Solver::chebyshev: return iterate_guarded_chebyshev(start, target, m, x);
        }
    }

    /// Chebyshev, and where nothing is proven (darts) PIA from there if it grows or stalls.
    void iterate_guarded_chebyshev(const ResidualNorms& norms, Target target, const Field& m, Field& x) {
        const bool has_fallback = options_.solver == Solver::automatic && system_.plan().has_darts();
        std::unique_ptr<Field> start;
        if (has_fallback) {
            start = std::make_unique<Field>(A_.make_field(x.channels(), x.real()));
            start->copy_from(x);
        }
        iterate_chebyshev(A_, part_, chebyshev_low(), norms, m, x, work(LimitSystem::Purpose::scratch, x, x.real()), *monitor_);
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
        constexpr const char* not_in_float = "the values are kept in float, which cannot hold them to this tolerance: use fields of double precision";
        const std::string after = " after " + std::to_string(monitor_->iteration()) + " iterations";
        const bool is_auto = options_.solver == Solver::automatic;
        const char* other = !is_auto                           ? ": use solver auto"
                            : system_.origin == Origin::scheme ? ": allow more iterations, or use a larger alpha"
                                                               : ": allow more iterations";
        const std::string dominance_hint = system_.origin == Origin::scheme ? " (lambda of 1/3 or more)" : "";
        switch (monitor_->outcome()) {
            case Outcome::diverged:
                return "the residual grows, this iteration does not converge on this operator" + after +
                       (solver_ != Solver::jacobi ? other : ": Jacobi is sure to converge only under diagonal dominance" + dominance_hint + ", use auto");
            case Outcome::stalled:
                if (monitor_->history().back() < wide_floor) return "the tolerance lies below what the arithmetic reaches" + after + ": use a larger one";
                if (options_.precision == Precision::mixed && fields_are_float_) return not_in_float;
                return "the residual no longer falls" + after + (options_.precision == Precision::single ? ": single precision ends here, use mixed" : other);
            case Outcome::indefinite: return "a negative eigenvalue was met, " + std::string(operator_name(system_)) + " is indefinite: " + cure(system_);
            case Outcome::converged: return not_in_float;
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
    bool fields_are_float_ = false;
    std::unique_ptr<Monitor> monitor_;
    SolveReport report_;
};

/// Bound of the distance to the exact solution, part by part: fixed rows are off by their residual, curves by at most 1/(2 a_ii - 1) times it, the smooth block
/// by |A^-1|_inf times its residual and what the error of the other rows adds to it. A caller's fixed rows hold M to the bit. NaN with darts, and where nothing
/// is known of rows without a scaling.
double error_bound(LimitSystem& system, double max_error) {
    const Plan& plan = system.plan();
    if (!has_inverse_norm(system)) return nan;
    if (system.origin == Origin::rows) return inverse_norm_of(system).value * max_error;
    double outer_error = plan.fixed.row_count > plan.isolated_count ? max_error : 0;
    for (Index row = plan.curves.first_row; row < plan.curves.end_row(); ++row) outer_error = std::max(outer_error, max_error / (2 * plan.diagonal[row] - 1));
    if (plan.smooth.row_count == 0) return outer_error;
    return std::max(outer_error, inverse_norm_of(system).value * (max_error + outer_error));
}

void certify(LimitSystem& system, const SolveOptions& options, SolveReport& report) {
    const bool has_inverse = report.status == SolveStatus::converged || report.status == SolveStatus::not_converged;
    if (options.certify && has_inverse) report.surface_error_bound = error_bound(system, report.max_error);
}

}  // namespace

double model_size(const LimitSystem& system, const SolveOptions& options, double unit) {
    return options.diagonal > 0 ? options.diagonal : system.diagonal > 0 ? system.diagonal : unit;
}

void require_symmetric_form(const LimitSystem& system, Solver solver) {
    const Plan& plan = system.plan();
    const bool is_gauss_seidel = solver == Solver::gauss_seidel || solver == Solver::gauss_seidel_coloured;
    if (solver == Solver::conjugate_gradients && (plan.has_darts() || !plan.has_scaling))
        throw InvalidArgument("conjugate gradients need a self-adjoint operator, " + why_not_symmetric(system) + ": use auto, chebyshev, wpia" +
                              (plan.has_scaling ? " or gs" : " or pia"));
    if (is_gauss_seidel && !plan.has_scaling)
        throw InvalidArgument("Gauss-Seidel needs a self-adjoint operator, " + why_not_symmetric(system) + ": use auto, chebyshev, wpia or pia");
}

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
        solve.monitor().begin_with(solve.residual(M, P));
        std::vector<double> m(static_cast<std::size_t>(solve.first_iterated_row()) * M.channels());
        M.download(m.data(), 0, solve.first_iterated_row());
        std::vector<double> p = m;
        solve.solve_directly(m, p, M.channels());
        P.upload(p.data(), 0, solve.first_iterated_row());
    }
    const ResidualNorms final_norms = solve.run(M, P);
    SolveReport& report = solve.conclude();
    report.seconds_solve = seconds_since(start);
    solve.judge(final_norms);
    certify(system, options, report);
    return report;
}

}  // namespace lcl
