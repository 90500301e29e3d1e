// SPDX-License-Identifier: BSD-3-Clause
#include "host/filter/expansion.h"

#include <algorithm>
#include <numeric>

#include "host/field/host_rows.h"

namespace lcl {
namespace {

Field& work(LimitSystem& system, LimitSystem::Purpose purpose, const Field& like) { return system.work_field(purpose, like.channels(), like.real()); }

}  // namespace

Transform transform_after(const Polynomial& p, Transform transform) {
    for (double& centre : transform.centre) centre *= p.at_zero;
    return transform;
}

// Every run of a stage reads what the one before it wrote; the last writes `out`.
void filter_field(LimitSystem& system, const Polynomial& p, const Field& x, Field& out, const PassProgress& progress) {
    std::int64_t runs = 0, passes_done = 0;
    for (const Polynomial::Stage& stage : p.stages) runs += stage.times;
    if (runs == 0) return out.copy_from(x);
    Field& scratch = work(system, LimitSystem::Purpose::scratch, x);
    Field* const other = runs > 1 ? &work(system, LimitSystem::Purpose::correction, x) : nullptr;
    const Field* from = &x;
    for (const Polynomial::Stage& stage : p.stages)
        for (int time = 0; time < stage.times; ++time) {
            Field& to = --runs % 2 == 0 ? out : *other;
            SeriesProgress chain_progress;
            if (progress) chain_progress = [&](std::int64_t done) { return progress(passes_done + done, p.pass_count()); };
            if (!system.A->series(stage.steps, *from, to, scratch, chain_progress)) throw Cancelled("cancelled by the caller");
            passes_done += stage.steps.count();
            from = &to;
        }
}

void filter_host(LimitSystem& system, const Polynomial& p, const double* x, std::size_t stride, int channels, Precision precision, double* out,
                 std::size_t out_stride, const PassProgress& progress) {
    const Plan& plan = system.plan();
    const Transform transform = fit_transform(plan, x, stride, channels);
    Field input = system.A->make_field(channels, real_of(precision)), result = system.A->make_field(channels, real_of(precision));
    upload_rows(plan, transform, {x, stride}, input);
    filter_field(system, p, input, result, progress);
    std::vector<double> kept = kept_rows(plan, x, stride, channels);
    for (double& value : kept) value = p.at_zero == 0 ? 0 : value * p.at_zero;  // isolated vertices may be infinitely far away
    download_rows(plan, transform_after(p, transform), result, {out, out_stride});
    restore_rows(plan, kept, channels, out, out_stride);
}

std::vector<double> term_energies(LimitSystem& system, const Field& x, const Transform& transform, int term_count) {
    const Plan& plan = system.plan();
    require_scaling(plan, "energies");
    const double weight = std::accumulate(plan.scaling.begin(), plan.scaling.end(), 0.0);
    const std::vector<SeriesSums> sums = system.A->series_with_sums(term_steps(term_count), x, work(system, LimitSystem::Purpose::correction, x),
                                                                    work(system, LimitSystem::Purpose::scratch, x));
    std::vector<double> energies;
    for (const SeriesSums& term : sums)
        for (int c = 0; c < x.channels(); ++c) {
            const double mean = weight > 0 ? term.linear[c] / weight : 0, square = weight > 0 ? term.square[c] / weight : 0;
            energies.push_back(std::max(0.0, square - mean * mean) / (transform.scale[c] * transform.scale[c]));
        }
    return energies;
}

}  // namespace lcl
