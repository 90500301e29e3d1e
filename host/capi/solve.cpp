// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/solve.h"

#include <cmath>
#include <limits>

#include "host/capi/arguments.h"

using namespace lcl;

void lcl::give_report(lcl_solve_report* report, const SolveReport& inner) {
    if (report == nullptr) return;
    lcl_solve_report out = options_or(report, LCL_SOLVE_REPORT_INIT, "report");
    out.solver = static_cast<lcl_solver>(inner.solver);
    out.converged = inner.status == SolveStatus::converged;
    out.iterations = inner.iterations;
    out.residual_count = inner.residuals.size();
    if (out.residuals != nullptr) std::copy_n(inner.residuals.begin(), std::min(out.residual_capacity, inner.residuals.size()), out.residuals);
    out.lambda_min = inner.lambda_min;
    out.max_error = inner.max_error;
    out.surface_error_bound = inner.surface_error_bound;
    out.channel_error = inner.channel_error;
    out.seconds_upload = inner.seconds_upload;
    out.seconds_solve = inner.seconds_solve;
    out.seconds_download = inner.seconds_download;
    out.vertex_count = copy_first(out.vertices, inner.vertices);
    copy_text(out.message, inner.message);
    out.changed_rows = inner.changed_rows;
    give(report, out, "report");
}

lcl_status lcl::conclude(const SolveReport& inner, const lcl_solve_options& options, lcl_solve_report* report) {
    give_report(report, inner);
    if (inner.status == SolveStatus::converged || (inner.status == SolveStatus::not_converged && options.exact_sweeps > 0)) return LCL_OK;
    last_error() = {inner.message, {inner.vertices, {}}};
    switch (inner.status) {
        case SolveStatus::singular: return LCL_ERROR_SINGULAR;
        case SolveStatus::indefinite: return LCL_ERROR_INDEFINITE;
        default: return LCL_ERROR_NOT_CONVERGED;
    }
}

SolveOptions lcl::solve_options(const lcl_solve_options& given) {
    if (given.solver < LCL_SOLVER_AUTO || given.solver > LCL_SOLVER_CG)
        throw InvalidArgument("options.solver is " + std::to_string(given.solver) + ", it goes from 0 to 7");
    if (!(given.tolerance >= 0)) throw InvalidArgument("options.tolerance is " + std::to_string(given.tolerance) + ", it is above 0");
    if (given.max_iterations < 0 || given.exact_sweeps < 0) throw InvalidArgument("options has a negative number of iterations");
    if (!(given.weight >= 0 && given.weight < 2))
        throw InvalidArgument("options.weight is " + std::to_string(given.weight) + ", W-PIA takes weights above 0 and below 2");
    if (!(given.diagonal >= 0)) throw InvalidArgument("options.diagonal is below 0");
    SolveOptions options;
    options.solver = static_cast<Solver>(given.solver);
    options.precision = inner_precision(given.precision);
    if (given.tolerance > 0) options.tolerance = given.tolerance;
    if (given.max_iterations > 0) options.max_iterations = given.max_iterations;
    options.exact_sweeps = given.exact_sweeps;
    options.weight = given.weight;
    options.keep_going = given.keep_going != 0;
    options.certify = given.certify != 0;
    options.diagonal = given.diagonal;
    if (given.progress != nullptr)
        options.progress = [given](int iteration, double residual, double target) {
            return given.progress(given.progress_user, iteration, residual, target) != 0;
        };
    return options;
}

namespace {

constexpr double isolated_range = 1e37;  // as in to_plan_order: isolated vertices may be anywhere

lcl_status interpolate(lcl_operator A, const double* M, std::size_t stride, int32_t channels, const lcl_solve_options& given, double* P, std::size_t P_stride,
                       lcl_solve_report* report) {
    LimitSystem& system = *required(A, "A")->system;
    if (stride == 0) stride = channels;
    if (P_stride == 0) P_stride = channels;
    check_channels(channels, stride, "stride");
    check_channels(channels, P_stride, "P_stride");
    options_or(report, LCL_SOLVE_REPORT_INIT, "report");  // refuses one without a size before any work
    required(M, "M");
    required(P, "P");
    if (given.warm_start != 0) require_finite(P, P_stride, channels, system.plan().vertex_count, "P");
    return conclude(solve_host(system, M, stride, channels, solve_options(given), given.warm_start != 0, P, P_stride), given, report);
}

/// M and P of one operator, M with values, alike.
void check_fields(lcl_operator A, lcl_field M, lcl_field P) {
    required(A, "A");
    if (required(M, "M")->A.get() != A || required(P, "P")->A.get() != A) throw InvalidArgument("M and P are fields of another operator");
    if (M == P) throw InvalidArgument("M and P are the same field");
    if (!M->transform) throw InvalidArgument("the field M holds no values yet: upload them first");
    if (P->field.channels() != M->field.channels() || P->field.real() != M->field.real()) throw InvalidArgument("M and P differ in channels or precision");
}

void check_start(const lcl_field_s& M, const lcl_field_s& P) {
    if (!P.transform || P.transform->centre != M.transform->centre || P.transform->scale != M.transform->scale)
        throw InvalidArgument("P, the start, is kept in another centre and scale than M: use lcl_field_match before uploading it");
}

SolveOptions field_options(const lcl_field_s& M, const lcl_solve_options& given) {
    SolveOptions options = solve_options(given);
    if (M.field.real() == Real::full) options.precision = Precision::full;
    else if (options.precision == Precision::full)
        throw InvalidArgument("the fields hold floats, and double precision was asked for: create them with LCL_PRECISION_DOUBLE");
    return options;
}

/// Normalised, within what the field can hold.
double stored_value(const lcl_field_s& M, Index row, int channel, double value) {
    const Plan& plan = M.A->system->plan();
    const Index v = plan.vertex_of_row[row];
    require_finite(value, v, channel, "values");
    const double stored = (value - M.transform->centre[channel]) * M.transform->scale[channel];
    const double largest = M.field.real() == Real::single ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
    if (row < plan.isolated_count) return std::clamp(stored, -isolated_range, isolated_range);
    if (std::fabs(stored) <= largest) return stored;
    throw BadInput("the value of vertex " + std::to_string(v) + " in channel " + std::to_string(channel) + ", " + std::to_string(value) +
                       ", is too far from the others for the number type of the field",
                   {{v}, {}});
}

/// Rows and normalised values of a list of vertices, each once.
LocalEdit local_edit(const lcl_field_s& M, const int32_t* vertices, std::size_t count, const double* values) {
    const Plan& plan = M.A->system->plan();
    const int channels = M.field.channels();
    LocalEdit edit;
    if (count > 0) required(vertices, "vertices"), required(values, "values");
    for (std::size_t i = 0; i < count; ++i) {
        if (vertices[i] < 0 || vertices[i] >= plan.vertex_count)
            throw InvalidArgument("vertex " + std::to_string(vertices[i]) + " was given, the field has " + std::to_string(plan.vertex_count),
                                  {{vertices[i]}, {}});
        edit.rows.push_back(plan.row_of_vertex[vertices[i]]);
        for (int c = 0; c < channels; ++c) edit.values.push_back(stored_value(M, edit.rows.back(), c, values[i * channels + c]));
    }
    std::vector<Index> sorted = edit.rows;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) {
        const Index v = plan.vertex_of_row[*twice];
        throw InvalidArgument("vertex " + std::to_string(v) + " was given twice", {{v}, {}});
    }
    return edit;
}

}  // namespace

extern "C" {

lcl_status lcl_limit_points(lcl_operator A, const double* points, size_t stride, int32_t channels, lcl_precision precision, double* out, size_t out_stride) {
    return guarded([&] {
        LimitSystem& system = *required(A, "A")->system;
        if (stride == 0) stride = channels;
        if (out_stride == 0) out_stride = channels;
        check_channels(channels, stride, "stride");
        check_channels(channels, out_stride, "out_stride");
        limit_points(*system.A, required(points, "points"), stride, channels, inner_precision(precision), required(out, "out"), out_stride);
        return LCL_OK;
    });
}

lcl_status lcl_interpolate(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_solve_options* options, double* P, size_t P_stride,
                           lcl_solve_report* report) {
    return guarded([&] { return interpolate(A, M, stride, channels, options_or(options, LCL_SOLVE_OPTIONS_INIT, "options"), P, P_stride, report); });
}

lcl_status lcl_interpolate_mesh(lcl_operator A, lcl_mesh mesh, const lcl_solve_options* options, lcl_solve_report* report) {
    return guarded([&] {
        const Index expected = required(A, "A")->system->plan().vertex_count, found = required(mesh, "mesh")->file.mesh.vertex_count;
        if (expected != found) throw InvalidArgument("the operator has " + std::to_string(expected) + " vertices, the mesh " + std::to_string(found));
        lcl_solve_options given = options_or(options, LCL_SOLVE_OPTIONS_INIT, "options");
        given.warm_start = 0;
        mesh->keep_features_of_positions();
        const struct Forget {
            lcl_mesh mesh;
            ~Forget() { mesh->forget_positions(); }
        } forget{mesh};  // also where the solve is cancelled after it has put its points there
        double* const points = mesh->file.mesh.positions.data();
        return interpolate(A, points, 3, 3, given, points, 3, report);
    });
}

lcl_status lcl_interpolate_async(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_solve_options* options, double* P, size_t P_stride,
                                 lcl_solve_report* report, lcl_task* task) {
    return guarded([&] {
        required(task, "task");
        const lcl_solve_options given = options_or(options, LCL_SOLVE_OPTIONS_INIT, "options");
        auto handle = std::make_unique<lcl_task_s>();
        handle->A = share(required(A, "A"));
        handle->result = std::async(std::launch::async, [=] {
                             last_error() = {};
                             const lcl_status status = guarded([&] { return interpolate(A, M, stride, channels, given, P, P_stride, report); });
                             return lcl_task_s::Result{status, last_error()};
                         }).share();
        *task = handle.release();
        return LCL_OK;
    });
}

lcl_status lcl_task_wait(lcl_task task) {
    return guarded([&] {
        const lcl_task_s::Result& result = required(task, "task")->result.get();
        if (result.status != LCL_OK) last_error() = result.error;
        return result.status;
    });
}

int32_t lcl_task_is_done(lcl_task task) { return task == nullptr || task->result.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
void lcl_task_release(lcl_task task) { release(task); }

lcl_status lcl_solve_local(lcl_operator A, lcl_field M, lcl_field P, const int32_t* vertices, size_t count, const double* values,
                           const lcl_solve_options* options, lcl_solve_report* report) {
    return guarded([&] {
        check_fields(A, M, P);
        const lcl_solve_options given = options_or(options, LCL_SOLVE_OPTIONS_INIT, "options");
        options_or(report, LCL_SOLVE_REPORT_INIT, "report");  // refuses one without a size before any work
        const SolveOptions inner = field_options(*M, given);
        check_start(*M, *P);
        if (given.solver != LCL_SOLVER_AUTO && given.solver != LCL_SOLVER_GS)
            throw InvalidArgument("options.solver is " + std::to_string(given.solver) + ", a local solve takes 0 (auto) or 4 (GS)");
        if (given.exact_sweeps > 0) throw InvalidArgument("options.exact_sweeps is set, a local solve goes on to the tolerance");
        const LocalEdit edit = local_edit(*M, vertices, count, values);
        if (!A->local) A->local = std::make_unique<LocalSolver>(*A->system);
        return conclude(A->local->solve(edit, *M->transform, inner, M->field, P->field), given, report);
    });
}

lcl_status lcl_interpolate_field(lcl_operator A, lcl_field M, const lcl_solve_options* options, lcl_field P, lcl_solve_report* report) {
    return guarded([&] {
        check_fields(A, M, P);
        const lcl_solve_options given = options_or(options, LCL_SOLVE_OPTIONS_INIT, "options");
        options_or(report, LCL_SOLVE_REPORT_INIT, "report");  // refuses one without a size before any work
        const SolveOptions inner = field_options(*M, given);
        if (given.warm_start == 0) P->transform = M->transform;
        else check_start(*M, *P);
        return conclude(solve_fields(*A->system, M->field, *M->transform, inner, given.warm_start != 0, P->field), given, report);
    });
}

}  // extern "C"
