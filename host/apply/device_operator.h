// SPDX-License-Identifier: BSD-3-Clause
// A on a device: the fused sweep, limit points, residuals and the sums of conjugate gradients, each on a range of blocks.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "host/apply/host_operator.h"
#include "host/apply/series_steps.h"
#include "host/field/field.h"
#include "host/operator/schedule.h"

namespace lcl {

/// How blocks are swept: CPUs take one work-item a block of many rows, GPUs a work-group a block of fewer.
struct LaunchShape {
    int group = 1;                ///< work-items a block, a power of two
    Index block_rows = 4096;      ///< for PlanOptions
    std::size_t cache_bytes = 0;  ///< what the sweeps of a chain that follow each other may fill with rows; 0: they do not
    Index phase_blocks = 1;       ///< blocks that a phase of a chain has at least, so that all compute units are busy to its end
};
/// For a mesh of so many vertices: small ones are cut finer, so that all compute units have blocks.
LaunchShape launch_shape(const DeviceInfo& device, Index vertex_count);

/// y = a x + (b + b_jacobi / A_ii) (m - A x) + c d.
struct Sweep {
    double a = 1, b = 1, b_jacobi = 0, c = 0;
};

/// One number a channel.
using ChannelValues = std::vector<double>;

/// Of one step of a series, over all rows.
struct SeriesSums {
    ChannelValues linear, square;  ///< sum D_ii y_i, sum D_ii y_i^2
};

/// Called with the steps that are done; waits for them. false stops the series.
using SeriesProgress = std::function<bool(std::int64_t)>;

/// The plan's arrays on a device. All fields have the plan's vertex_count rows; all calls but norms() and sums return at once.
class DeviceOperator {
public:
    DeviceOperator(std::shared_ptr<Context> context, std::shared_ptr<const Plan> plan, const LaunchShape& shape);

    const Plan& plan() const { return *plan_; }
    const LaunchShape& launch_shape() const { return shape_; }
    Context& context() const { return *context_; }
    const std::shared_ptr<Context>& shared_context() const { return context_; }
    Field make_field(int channels, Real real) const { return Field(context_, plan_->vertex_count, channels, real); }

    /// Row -> caller's vertex, vertex_count integers: for transfers from and to a caller's buffers.
    const Buffer& vertex_order();

    /// y = A x. x and y differ.
    void limit_points(const Field& x, Field& y, const Part& part);
    /// One sweep; the norms of m - A x are had by norms(). x and y differ; d may be y, or null where c is 0.
    void sweep(const Sweep& sweep, const Field& m, const Field& x, const Field* d, Field& y, const Part& part);
    /// Sweeps one after the other, three-term: each takes the newest field as x, and overwrites the one before, which is its d; `x` is the newest before and
    /// after. Waits; the norms of m - A x before each sweep. On a CPU the sweeps follow each other through the smooth part while its rows are in cache.
    std::vector<ResidualNorms> chain(const std::vector<Sweep>& sweeps, const Field& m, Field& x, Field& y, const Part& part);
    /// How a chain runs: blocks that a sweep takes in a phase, blocks that each sweep lags behind the one before it, sweeps at a time.
    struct Phases {
        Index width, lag, sweeps;
    };
    /// fields: how many a sweep touches.
    Phases phases(std::size_t sweeps, const Field& field, const Part& part, int fields = 3) const;
    /// r = m - A x in double or pairs of floats, m and x wide or single, r single; norms as above.
    void wide_residual(const Field& m, const Field& x, Field& r, const Part& part);
    /// x += d on the part's rows; x wide or single, d single.
    void correct(const Field& d, Field& x, const Part& part);
    /// Steps of a series from y_0 = input to y_count in `out`, over all rows, in turns with `scratch`; no steps: a copy. All three differ; what out and scratch
    /// held is lost, also where progress stops it (the result is then false). One pass a step; chains of steps follow each other through the rows as those of
    /// chain().
    bool series(const SeriesSteps& steps, const Field& input, Field& out, Field& scratch, const SeriesProgress& progress = {});
    /// The same (SeriesThird::older) with the sums over every step's y, weighted with the plan's scaling. Waits.
    std::vector<SeriesSums> series_with_sums(const SeriesSteps& steps, const Field& input, Field& out, Field& scratch);
    /// The same (SeriesThird::older) in place on `difference`, whose last step also writes frame = target + difference. At least one step.
    void morph(const SeriesSteps& steps, const Field& target, Field& difference, Field& scratch, Field& frame);
    /// difference *= rho, frame = target + difference.
    void morph_blend(double rho, const Field& target, Field& difference, Field& frame);
    /// difference = a - b.
    void subtract(const Field& a, const Field& b, Field& difference);
    /// GS-PIA over the rows of the schedule, in place; no norms.
    void relax_rows(const Schedule& schedule, const Field& m, Field& x);
    /// Waits; largest row norms that the last sweep, wide_residual or cg_update of a field like `like` left for the part. Normalised units;
    /// `others` is the Euclidean norm over up to eight channels here, never less than their largest value.
    ResidualNorms norms(const Field& like, const Part& part);

    /// q = A p; waits for <p, q>_D of each channel.
    ChannelValues cg_apply(const Field& p, Field& q, const Part& part);
    /// x += alpha p, r -= alpha q; waits for <r, r>_D; norms of r are had by norms().
    ChannelValues cg_update(const ChannelValues& alpha, const Field& p, const Field& q, Field& x, Field& r, const Part& part);
    /// p = r + beta p.
    void cg_direction(const ChannelValues& beta, const Field& r, Field& p, const Part& part);

    /// Sweeps all rows by a kernel of kernels/`file`.cl that takes first_block and LCL_STENCILS before `arguments`, for fields of one channel block like
    /// `like`.
    template <class... Arguments>
    void launch_over_rows(const char* file, const char* name, const Field& like, const Arguments&... arguments) {
        const Part all = plan_->all_rows();
        launch(*context_, kernel(file, name, like, 0), size(all), all.first_block, blocks_, runs_, weights(like.real(), false), indices_, weighted_offsets_,
               weighted_indices_, weights(like.real(), true), arguments...);
    }

private:
    struct ScheduleArrays {
        Buffer rows, offsets, columns, weights, inverse_diagonal;
    };
    struct Partials {
        std::vector<Buffer> norms, sums, series_sums;
    };  // a channel block each
    const Buffer& weights(Real real, bool weighted_rows);
    const Buffer& scaling(Real real);
    Partials& partials(const Field& field);
    Partials& series_partials(const Field& field);
    void enqueue_phases(const Phases& phases, const Part& part, cl_kernel relax);
    void run_phases(const Phases& phases, const Sweep* sweeps, const Field& m, Field& x, Field& y, const Part& part);
    std::vector<Part> series_parts() const;
    template <class Prepare>
    bool run_series(const SeriesSteps& steps, const Field& input, Field& out, Field& scratch, const SeriesProgress& progress, const Prepare& prepare);
    template <class Prepare>
    void run_series_chain(const SeriesSteps& steps, std::int64_t first, const Phases& phases, const Part& part, const std::array<const Field*, 3>& fields,
                          const Prepare& prepare);
    void read_series_sums(const Field& like, const Part& part, Index sweeps, SeriesSums* sums);
    void launch_rows(const char* name, const Field& like, const std::function<void(cl_kernel, std::size_t)>& set);
    std::vector<ResidualNorms> norms_of_sweeps(const Field& like, const Part& part, std::size_t sweeps);
    ScheduleArrays& schedule_arrays(const Schedule& schedule, Real real);
    ChannelValues sums(const Field& field, const Part& part);
    cl_kernel kernel(const char* file, const char* name, const Field& field, std::size_t block);
    cl_kernel norm_kernel(const char* file, const char* name, const Field& field, std::size_t block);
    cl_kernel norm_kernel(const char* file, const char* name, const Field& field, std::size_t block, const std::string& options);
    LaunchSize size(const Part& part) const;
    Buffer upload(const void* data, std::size_t bytes, const char* what);
    Buffer upload_doubled(const Array<Index>& rows, const char* what);
    Buffer upload_reals(const std::vector<double>& values, Real real, const char* what);

    std::shared_ptr<Context> context_;
    std::shared_ptr<const Plan> plan_;
    LaunchShape shape_;
    Buffer blocks_, runs_, indices_, weighted_offsets_, weighted_indices_, vertex_order_, chain_;
    std::map<std::pair<Real, bool>, Buffer> weights_;
    std::map<Real, Buffer> scaling_;
    std::map<std::pair<Real, int>, Partials> partials_;  // by type and channel count
    std::map<std::pair<const Schedule*, Real>, ScheduleArrays> schedules_;
};

}  // namespace lcl
