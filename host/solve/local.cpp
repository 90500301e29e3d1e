// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/local.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace lcl {
namespace {

constexpr std::size_t least_region = 4096;    // rows: below, a region is never too large
constexpr Index region_share = 16;            // beyond this part of the rows the full solve is faster
constexpr std::size_t least_work = 1u << 20;  // relaxations, some 60 ms: below, there are never too many
constexpr int most_sweeps = 100;              // of solver auto; well-conditioned operators take 10 to 40
constexpr double ring_share = 0.4;            // of the rings in which an error of the edit's size would decay by the general bound: with fewer, rows are read
                                              // in more turns; with more, many are read that stay as they are
constexpr double least_eigenvalue = 0.01, largest_eigenvalue = 0.9;  // for that bound

double seconds_since(std::chrono::steady_clock::time_point start) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }

/// Squared length of a position; rows of fewer channels have zeros.
double position_square(const double* r) { return r[0] * r[0] + r[1] * r[1] + r[2] * r[2]; }

/// Measured: half the relaxations of weight 1 where lambda_min is 0.1 (quads), a few percent fewer where it is 0.25 (triangles); larger weights cost again.
double over_relaxation(double lambda_min) { return std::clamp(1.3 - lambda_min, 1.0, 1.2); }

}  // namespace

SolveReport LocalSolver::solve(const LocalEdit& edit, const Transform& transform, const SolveOptions& options, Field& M, Field& P) {
    const auto begin = std::chrono::steady_clock::now();
    const Plan& plan = system_.plan();
    require_symmetric_form(system_, options.solver);
    const auto solve_fully = [&] { return solve_fields(system_, M, transform, options, true, P); };
    if (plan.row_count < plan.vertex_count) return solve_fully();  // which refuses ghosts
    const double unit = 1 / transform.scale[0], diagonal = model_size(system_, options, unit);
    target_ = {options.tolerance * diagonal / unit, options.tolerance};
    std::function<bool(int, double, double)> progress;
    if (options.progress) progress = [&](int iteration, double residual, double target) { return options.progress(iteration, residual * unit, target * unit); };
    Monitor monitor(options.max_iterations, target_, progress);
    const Spectrum& spectrum = spectrum_of(system_);
    const bool may_be_local = plan.has_scaling && !spectrum.singular && !spectrum.indefinite;
    const bool is_local = may_be_local && start(edit, M, P) && relax(monitor, options.solver == Solver::automatic);
    SolveReport report;
    if (is_local) report = conclude(monitor, unit);
    const auto before_write = std::chrono::steady_clock::now();
    write_back(edit, is_local, M, P);
    if (!is_local) {
        report = solve_fully();
        report.changed_rows = plan.vertex_count;
        return report;
    }
    report.seconds_download = seconds_read_;
    report.seconds_upload = seconds_since(before_write);
    report.seconds_solve = seconds_since(begin) - report.seconds_download - report.seconds_upload;
    return report;
}

/// Everything but the seconds.
SolveReport LocalSolver::conclude(const Monitor& monitor, double unit) {
    const Spectrum& spectrum = spectrum_of(system_);
    if (monitor.outcome() != Outcome::converged) measure();
    const ResidualNorms norms = largest(region_.reached());
    SolveReport report;
    report.status = target_.met_by(norms) ? SolveStatus::converged : SolveStatus::not_converged;
    report.solver = Solver::gauss_seidel;
    report.iterations = monitor.iteration();
    report.residuals = monitor.history();
    report.residuals.back() = norms.position;
    for (double& residual : report.residuals) residual *= unit;
    report.lambda_min = spectrum.estimate;
    report.max_error = norms.position * unit;
    report.channel_error = norms.others;
    report.surface_error_bound = std::numeric_limits<double>::quiet_NaN();
    report.changed_rows = static_cast<Index>(std::count(is_changed_.begin(), is_changed_.end(), 1));
    if (report.status == SolveStatus::converged) return report;
    report.message = reason(monitor.iteration()) + (spectrum.warning.empty() ? "" : "; " + spectrum.warning);
    report.vertices = system_.weakest;
    return report;
}

std::string LocalSolver::reason(int iterations) const {
    const std::string after = " after " + std::to_string(iterations) + " iterations";
    if (!is_stuck_) return "the tolerance was not reached" + after + ": allow more iterations";
    if (is_single_) return "the values are kept in float, which cannot hold them to this tolerance: use fields of double precision";
    return "the tolerance lies below what the arithmetic reaches" + after + ": use a larger one";
}

/// Reads what is needed and queues the rows above the tolerance. False where the region is too large.
bool LocalSolver::start(const LocalEdit& edit, Field& M, Field& P) {
    M_ = &M, P_ = &P, channels_ = M.channels(), is_single_ = M.real() == Real::single;
    weight_ = over_relaxation(spectrum_of(system_).smooth);
    queue_.clear(), is_changed_.clear(), is_queued_.clear();
    fetched_rows_ = fetched_reached_ = work_ = 0;
    is_stuck_ = false;
    seconds_read_ = 0;
    stride_ = (channels_ + width - 1) / width * width;
    for (std::vector<double>* values : {&m_, &p_, &r_}) values->clear();
    change_.assign(stride_, 0.0);
    region_.start(edit.rows);
    fetch();
    for (std::size_t i = 0; i < edit.rows.size(); ++i) {
        const Index local = region_.reached()[i];
        for (int c = 0; c < channels_; ++c) m_[at(local) + c] = held(edit.values[i * channels_ + c]);
        compute_residual(local);
        queue_if_large(local);
    }
    if (!open_rings(first_rings())) return false;
    settle_fixed_rows();
    return true;
}

/// Rings until a residual has decayed to the tolerance; 0 where none is above it.
int LocalSolver::first_rings() const {
    const std::vector<Index>& edited = region_.reached();
    const ResidualNorms norms = largest(edited);
    const double size = std::max(norms.position / target_.position, norms.others / target_.others);
    if (!(size > 1)) return std::any_of(edited.begin(), edited.end(), [this](Index local) { return is_fixed(local); }) ? 1 : 0;
    const double root = std::sqrt(1 / std::clamp(spectrum_of(system_).smooth, least_eigenvalue, largest_eigenvalue));
    return 1 + static_cast<int>(std::min(std::log(size) / -std::log((root - 1) / (root + 1)) * ring_share, 1e6));
}

bool LocalSolver::open_rings(int rings) {
    for (; rings > 0; --rings) {
        const std::size_t before = region_.rows().size();
        region_.open_all();
        const std::size_t rows = region_.rows().size();
        if (is_too_large(rows + (rings - 1) * (rows - before))) return false;  // rings are seldom smaller than the one before
    }
    look_at_reached();
    return true;
}

bool LocalSolver::open_rows(const std::vector<Index>& locals) {
    for (const Index local : locals) region_.open_round(local);
    if (is_too_large(region_.rows().size())) return false;
    look_at_reached();
    return true;
}

bool LocalSolver::is_too_large(std::size_t rows) const { return rows > std::max<std::size_t>(least_region, system_.plan().row_count / region_share); }

/// Residuals of the rows reached since the last time.
void LocalSolver::look_at_reached() {
    std::size_t i = fetched_reached_;
    fetch();
    for (; i < region_.reached().size(); ++i) {
        compute_residual(region_.reached()[i]);
        queue_if_large(region_.reached()[i]);
    }
}

/// Reads the rows of M and P that the region has got since the last time.
void LocalSolver::fetch() {
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<Index>&rows = region_.rows(), &reached = region_.reached();
    list_p_.assign(rows.begin() + fetched_rows_, rows.end());
    list_m_.clear();
    for (std::size_t i = fetched_reached_; i < reached.size(); ++i) list_m_.push_back(rows[reached[i]]);
    transfer_.read({{P_, &list_p_}, {M_, &list_m_}}, transferred_);
    for (std::vector<double>* values : {&m_, &p_, &r_}) values->resize(rows.size() * stride_, 0.0);
    is_changed_.resize(rows.size(), 0);
    is_queued_.resize(rows.size(), 0);
    const double* from = transferred_.data();
    for (; fetched_rows_ < rows.size(); ++fetched_rows_, from += channels_) std::copy_n(from, channels_, &p_[at(fetched_rows_)]);
    for (; fetched_reached_ < reached.size(); ++fetched_reached_, from += channels_) std::copy_n(from, channels_, &m_[at(reached[fetched_reached_])]);
    seconds_read_ += seconds_since(begin);
}

/// They hold M's values whatever the tolerance.
void LocalSolver::settle_fixed_rows() {
    const std::size_t count = region_.reached().size();
    for (std::size_t i = 0; i < count; ++i)
        if (is_fixed(region_.reached()[i]) && region_.is_open(region_.reached()[i])) relax_row(region_.reached()[i]);
}

/// d r = d (m - A p)
void LocalSolver::compute_residual(Index local) {
    double* r = &r_[at(local)];
    std::copy_n(&m_[at(local)], stride_, r);
    for (const LocalRegion::Entry& entry : region_.row(local)) subtract(entry.weight, &p_[at(entry.other)], r);
    const double scaling = region_.scaling(local);
    for (int c = 0; c < stride_; ++c) r[c] *= scaling;
}

/// r -= weight x, in fours for the compiler.
void LocalSolver::subtract(double weight, const double* x, double* r) const {
    for (const double* const end = x + stride_; x < end; x += width, r += width)
        for (int c = 0; c < width; ++c) r[c] -= weight * x[c];
}

bool LocalSolver::is_large(Index local) const {
    const double* r = &r_[at(local)];
    const double scaling = region_.scaling(local), limit = scaling * target_.position;
    bool is_small = position_square(r) <= limit * limit;
    for (int c = 3; c < channels_; ++c) is_small = is_small && std::fabs(r[c]) <= scaling * target_.others;
    return !is_small;
}

void LocalSolver::queue_if_large(Index local) {
    if (is_queued_[local] || !is_large(local)) return;
    is_queued_[local] = 1;
    queue_.push_back(local);
}

ResidualNorms LocalSolver::largest(const std::vector<Index>& locals) const {
    double square = 0, others = 0;
    for (const Index local : locals) {
        const double* r = &r_[at(local)];
        const double inverse = 1 / region_.scaling(local), here = position_square(r) * inverse * inverse;
        if (!(here <= square)) square = here;  // keeps a not-a-number
        for (int c = 3; c < channels_; ++c)
            if (!(std::fabs(r[c]) * inverse <= others)) others = std::fabs(r[c]) * inverse;
    }
    return {std::sqrt(square), others};
}

/// Until no row is above the tolerance. False where the full solve is to take over.
bool LocalSolver::relax(Monitor& monitor, bool is_automatic) {
    const std::size_t most_work = std::max<std::size_t>(least_work, 2 * static_cast<std::size_t>(system_.plan().row_count));
    for (monitor.begin_stage(target_);; monitor.advance()) {
        if (queue_.empty()) measure();
        if (monitor.stop(largest(queue_.empty() ? region_.reached() : queue_))) break;
        sweep();
        if (is_stuck_) return true;
        const bool only_closed_ones_are_left = !closed_.empty() && closed_.size() == queue_.size();  // reading rows takes as long as many sweeps
        const bool is_slow = work_ > most_work || (is_automatic && monitor.iteration() >= most_sweeps);
        if (is_slow || (only_closed_ones_are_left && !open_rows(closed_))) return false;
    }
    return monitor.outcome() == Outcome::converged || monitor.outcome() == Outcome::exhausted;
}

/// All residuals anew, without the rounding of the updates.
void LocalSolver::measure() {
    for (const Index local : region_.reached()) {
        compute_residual(local);
        queue_if_large(local);
    }
}

/// p_i += w r_i / A_ii for the queued rows that are open, one after the other; the others are noted.
void LocalSolver::sweep() {
    current_.swap(queue_);
    queue_.clear(), closed_.clear();
    bool has_tried = false, has_moved = false;
    for (const Index local : current_) {
        is_queued_[local] = 0;
        if (!is_large(local)) continue;
        if (region_.is_open(local)) {
            has_tried = true;
            has_moved = relax_row(local) || has_moved;
        } else {
            closed_.push_back(local);
            queue_if_large(local);
        }
    }
    is_stuck_ = has_tried && !has_moved && closed_.empty();
}

/// False where the change is too small for the field's number type.
bool LocalSolver::relax_row(Index local) {
    const double factor = weight_ / (region_.diagonal(local) * region_.scaling(local));
    const bool takes_m = is_fixed(local);
    bool has_moved = false;
    for (int c = 0; c < channels_; ++c) {
        double& p = p_[at(local) + c];
        const double next = takes_m ? m_[at(local) + c] : held(p + factor * r_[at(local) + c]);
        change_[c] = next - p;
        p = next;
        has_moved = has_moved || change_[c] != 0;
    }
    if (!has_moved) return false;
    ++work_;
    is_changed_[local] = 1;
    for (const LocalRegion::Entry& reader : region_.irregular_readers(local)) {
        subtract(reader.weight, change_.data(), &r_[at(reader.other)]);
        queue_if_large(reader.other);
    }
    for (double& change : change_) change *= region_.scaling(local);  // d_j a_ji = d_i a_ij
    for (const LocalRegion::Entry& reader : region_.mirrored(local)) {
        subtract(reader.weight, change_.data(), &r_[at(reader.other)]);
        queue_if_large(reader.other);
    }
    return true;
}

void LocalSolver::write_back(const LocalEdit& edit, bool with_points, Field& M, Field& P) {
    list_p_.clear();
    transferred_ = edit.values;
    for (std::size_t local = 0; with_points && local < is_changed_.size(); ++local) {
        if (!is_changed_[local]) continue;
        list_p_.push_back(region_.rows()[local]);
        transferred_.insert(transferred_.end(), &p_[at(local)], &p_[at(local)] + channels_);
    }
    transfer_.write({{&M, &edit.rows}, {&P, &list_p_}}, transferred_);
    system_.A->context().finish();
}

}  // namespace lcl
