// SPDX-License-Identifier: BSD-3-Clause
// Interpolation: control points P with A P = M.
#ifndef LIMITCL_SOLVE_HPP
#define LIMITCL_SOLVE_HPP

#include "limit_operator.hpp"

#include <exception>

namespace limitcl {

enum class Solver {
    automatic = LCL_SOLVER_AUTO,  ///< the fastest that is sure to converge
    pia = LCL_SOLVER_PIA,         ///< P += R (mesh expansion paper; Doo-Sabin paper)
    wpia = LCL_SOLVER_WPIA,       ///< P += w R
    jacobi = LCL_SOLVER_JACOBI,   ///< P_i += R_i / A_ii (two-phase paper, eq. 6)
    gs = LCL_SOLVER_GS,           ///< newest neighbours, in the order of the vertices (Loop PIA paper)
    gs_coloured = LCL_SOLVER_GS_COLOURED,
    chebyshev = LCL_SOLVER_CHEBYSHEV,
    cg = LCL_SOLVER_CG
};

struct SolveOptions {
    Solver solver = Solver::automatic;
    Precision precision = Precision::mixed;
    double tolerance = 1e-6;  ///< of max_i |R_i| over x, y, z, relative to the diagonal of the bounding box; other channels: relative to their range
    int max_iterations = 200;
    int exact_sweeps = 0;     ///< > 0: exactly so many iterations, no test
    double weight = 0;        ///< W-PIA: 0: the best, from the estimated spectrum; else above 0 and below 2
    bool warm_start = false;  ///< the output holds the start P_0; else P_0 = M
    bool keep_going = false;  ///< iterate although A is singular or indefinite
    bool certify = false;     ///< also SolveReport::surface_error_bound (without diagonal dominance some ten short solves at an operator's first call)
    double diagonal = 0;      ///< model size that the tolerance refers to; 0: that of the operator's mesh
    /// Return false to cancel (Error LCL_ERROR_CANCELLED). What it throws reaches the caller of interpolate.
    std::function<bool(int iteration, double residual, double target)> progress;
};

/// What a solve did. Lengths in model units.
struct SolveReport {
    lcl_status status = LCL_OK;         ///< LCL_OK, LCL_ERROR_SINGULAR, LCL_ERROR_INDEFINITE or LCL_ERROR_NOT_CONVERGED
    Solver solver = Solver::automatic;  ///< the one that ran
    bool converged = false;             ///< max_error <= tolerance x diagonal
    int iterations = 0;
    std::vector<double> residuals;   ///< E_0 .. E_iterations, E_k = max_i |M - A P_k|_i
    double lambda_min = 0;           ///< estimate; NaN if none
    double max_error = 0;            ///< final residual recomputed in double
    double surface_error_bound = 0;  ///< with certify: bound of the distance to the exact solution's surface; NaN without, and where none is known
    double channel_error = 0;        ///< the residual of further channels, relative to their ranges
    double seconds_upload = 0, seconds_solve = 0, seconds_download = 0;
    std::vector<std::int32_t> vertices;  ///< where it is singular or indefinite
    std::string message;                 ///< one sentence if not converged; "" otherwise
    int changed_rows = 0;                ///< solve_local: rows of P that were changed, all where the full solve took over; 0 from others

    /// Throws Error with status and message unless the status is LCL_OK.
    const SolveReport& require_ok() const;
};

/// Control points with the report on how they were found.
struct Interpolation {
    std::vector<double> points;  ///< vertex_count x channels
    SolveReport report;
};

namespace detail {

// The C structs of one solve with all that they point to. Not copied: the C structs point into it.
class SolveCall {
public:
    explicit SolveCall(const SolveOptions& options);
    SolveCall(const SolveCall&) = delete;
    SolveCall& operator=(const SolveCall&) = delete;

    const lcl_solve_options* options() const { return &options_; }
    lcl_solve_report* report() { return &report_; }
    // Turns the status of the call into a report, or throws.
    SolveReport finish(lcl_status status);

private:
    static std::int32_t forward_progress(void* user, std::int32_t iteration, double residual, double target);

    std::function<bool(int, double, double)> progress_;
    std::exception_ptr thrown_;
    std::vector<double> residuals_;
    lcl_solve_options options_ = LCL_SOLVE_OPTIONS_INIT;
    lcl_solve_report report_ = LCL_SOLVE_REPORT_INIT;
};

}  // namespace detail

/// Control points P with A P = M. M, P: vertex_count x channels, positions first, model units. P belongs to the caller, may be M, and holds the start if
/// options.warm_start.
/// Singular, indefinite and not converged are results: P and the report hold what there is, see SolveReport::status. Other failures throw Error.
/// The number of passes over A is about report.iterations, plus some 20 where the spectrum is estimated.
[[nodiscard]] inline SolveReport interpolate(const LimitOperator& A, ArrayView<double> M, int channels, double* P, const SolveOptions& options = {}) {
    detail::require_values(A, M.size(), channels, "M");
    detail::SolveCall call(options);
    return call.finish(lcl_interpolate(A.get(), M.data(), 0, channels, call.options(), P, 0, call.report()));
}

/// The same with P in a vector of its own (no warm start).
[[nodiscard]] inline Interpolation interpolate(const LimitOperator& A, ArrayView<double> M, int channels = 3, const SolveOptions& options = {}) {
    if (options.warm_start) throw Error(LCL_ERROR_INVALID_ARGUMENT, "a warm start needs an array that holds it; give one for P");
    Interpolation result;
    result.points.resize(M.size());
    result.report = interpolate(A, M, channels, result.points.data(), options);
    return result;
}

/// The same on the points of a mesh, which become P. The mesh must be the one that A was made from, or one with its faces.
[[nodiscard]] inline SolveReport interpolate(const LimitOperator& A, Mesh& mesh, const SolveOptions& options = {}) {
    detail::SolveCall call(options);
    return call.finish(lcl_interpolate_mesh(A.get(), mesh.get(), call.options(), call.report()));
}

/// The same on fields that stay on the device.
[[nodiscard]] inline SolveReport interpolate(const LimitOperator& A, const Field& M, Field& P, const SolveOptions& options = {}) {
    detail::SolveCall call(options);
    return call.finish(lcl_interpolate_field(A.get(), M.get(), call.options(), P.get(), call.report()));
}

/// Moves few vertices of a surface that interpolates: M gets the new rows (vertices.size() x channels, model units; each vertex once) and P, which solved A P =
/// M before, is updated to the tolerance in time that follows the edit. See lcl_solve_local.
///     interpolate(A, M, P).require_ok();
///     const std::int32_t vertex[] = {4711};
///     const double point[] = {0.1, 0.2, 0.3};
///     solve_local(A, M, P, vertex, point).require_ok();
[[nodiscard]] inline SolveReport solve_local(const LimitOperator& A, Field& M, Field& P, ArrayView<std::int32_t> vertices, ArrayView<double> values,
                                             const SolveOptions& options = {}) {
    const std::size_t expected = vertices.size() * static_cast<std::size_t>(M.channels());
    if (values.size() != expected)
        throw Error(LCL_ERROR_INVALID_ARGUMENT,
                    std::to_string(values.size()) + " values were given, " + std::to_string(vertices.size()) + " rows need " + std::to_string(expected));
    detail::SolveCall call(options);
    return call.finish(lcl_solve_local(A.get(), M.get(), P.get(), vertices.data(), vertices.size(), values.data(), call.options(), call.report()));
}

/// A solve on a thread of its own. Holds its options and report; M and P must live until wait() has returned or the object is gone.
/// The context is busy until then.
class SolveTask {
public:
    /// Starts. Arguments as those of interpolate; options.progress is called on the thread of the solve.
    SolveTask(const LimitOperator& A, ArrayView<double> M, int channels, double* P, const SolveOptions& options = {})
        : operator_(A), call_(std::make_unique<detail::SolveCall>(options)) {
        detail::require_values(A, M.size(), channels, "M");
        check(lcl_interpolate_async(A.get(), M.data(), 0, channels, call_->options(), P, 0, call_->report(), &task_));
    }
    SolveTask(SolveTask&& other) noexcept : operator_(std::move(other.operator_)), call_(std::move(other.call_)), task_(std::exchange(other.task_, nullptr)) {}
    SolveTask& operator=(SolveTask&&) = delete;
    /// Waits.
    ~SolveTask() { lcl_task_release(task_); }

    bool is_done() const { return lcl_task_is_done(task_) != 0; }
    /// Waits and gives the report; throws as interpolate does. Call it once.
    [[nodiscard]] SolveReport wait() { return call_->finish(lcl_task_wait(task_)); }

private:
    LimitOperator operator_;
    std::unique_ptr<detail::SolveCall> call_;
    lcl_task task_ = nullptr;
};

inline const SolveReport& SolveReport::require_ok() const {
    if (status != LCL_OK) throw Error(status, message, vertices);
    return *this;
}

inline detail::SolveCall::SolveCall(const SolveOptions& options) : progress_(options.progress) {
    const int sweeps = options.exact_sweeps > 0 ? options.exact_sweeps : options.max_iterations;
    residuals_.resize(static_cast<std::size_t>(sweeps > 0 ? sweeps : 200) + 1);
    options_.solver = static_cast<lcl_solver>(options.solver);
    options_.precision = static_cast<lcl_precision>(options.precision);
    options_.tolerance = options.tolerance;
    options_.max_iterations = options.max_iterations;
    options_.exact_sweeps = options.exact_sweeps;
    options_.weight = options.weight;
    options_.warm_start = options.warm_start;
    options_.keep_going = options.keep_going;
    options_.diagonal = options.diagonal;
    options_.certify = options.certify;
    if (progress_) {
        options_.progress = &SolveCall::forward_progress;
        options_.progress_user = this;
    }
    report_.residuals = residuals_.data();
    report_.residual_capacity = residuals_.size();
}

inline std::int32_t detail::SolveCall::forward_progress(void* user, std::int32_t iteration, double residual, double target) {
    SolveCall& call = *static_cast<SolveCall*>(user);
    try {
        return call.progress_(iteration, residual, target);
    } catch (...) {  // an exception must not pass through C: cancel, and let it go on in finish()
        call.thrown_ = std::current_exception();
        return 0;
    }
}

inline SolveReport detail::SolveCall::finish(lcl_status status) {
    if (thrown_) std::rethrow_exception(thrown_);
    if (status != LCL_OK && status != LCL_ERROR_SINGULAR && status != LCL_ERROR_INDEFINITE && status != LCL_ERROR_NOT_CONVERGED) throw Error::last(status);
    SolveReport report;
    report.status = status;
    report.solver = static_cast<Solver>(report_.solver);
    report.converged = report_.converged != 0;
    report.iterations = report_.iterations;
    residuals_.resize(report_.residual_count < residuals_.size() ? report_.residual_count : residuals_.size());
    report.residuals = residuals_;
    report.lambda_min = report_.lambda_min;
    report.max_error = report_.max_error;
    report.surface_error_bound = report_.surface_error_bound;
    report.channel_error = report_.channel_error;
    report.seconds_upload = report_.seconds_upload;
    report.seconds_solve = report_.seconds_solve;
    report.seconds_download = report_.seconds_download;
    report.vertices.assign(report_.vertices, report_.vertices + report_.vertex_count);
    report.message = report_.message;
    report.changed_rows = report_.changed_rows;
    return report;
}

}  // namespace limitcl

#endif
