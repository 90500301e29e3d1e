// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/host_operator.h"

#include <algorithm>
#include <cmath>

#include "host/parallel.h"

namespace lcl {
namespace {

/// Adds weight * x[column] to out for every entry of a row of a run.
void gather(const Plan& plan, const Run& run, Index row, const double* x, int channels, double* out) {
    for_each_entry(plan, run, row, [&](Index column, double weight) {
        for (int c = 0; c < channels; ++c) out[c] += weight * x[static_cast<std::size_t>(column) * channels + c];
    });
}

/// body(row, A x of that row) for every row, in parallel over blocks.
template <class Body>
void for_each_row(const Plan& plan, const std::vector<double>& x, int channels, const Body& body) {
    parallel_for(
        plan.blocks.size(),
        [&](std::size_t begin, std::size_t end) {
            std::vector<double> ax(channels);
            for (std::size_t b = begin; b < end; ++b)
                for (Index r = plan.blocks[b].first_run; r < plan.blocks[b].first_run + plan.blocks[b].run_count; ++r)
                    for (Index row = plan.runs[r].first; row < plan.runs[r].first + plan.runs[r].count; ++row) {
                        std::fill(ax.begin(), ax.end(), 0.0);
                        gather(plan, plan.runs[r], row, x.data(), channels, ax.data());
                        body(row, ax.data());
                    }
        },
        4);
}

}  // namespace

std::vector<double> host_apply(const Plan& plan, const std::vector<double>& x, int channels) {
    std::vector<double> y = x;
    for_each_row(plan, x, channels, [&](Index row, const double* ax) { std::copy_n(ax, channels, y.data() + static_cast<std::size_t>(row) * channels); });
    return y;
}

ResidualNorms host_residual(const Plan& plan, const std::vector<double>& m, const std::vector<double>& x, int channels) {
    std::vector<ResidualNorms> rows(plan.row_count);
    for_each_row(plan, x, channels, [&](Index row, const double* ax) {
        double square = 0;
        for (int c = 0; c < channels; ++c) {
            const double r = m[static_cast<std::size_t>(row) * channels + c] - ax[c];
            if (c < 3) square += r * r;
            else rows[row].others = std::fmax(rows[row].others, std::fabs(r));
        }
        rows[row].position = std::sqrt(square);
    });
    ResidualNorms worst;
    for (const ResidualNorms& r : rows) {
        if (!(r.position <= worst.position)) worst.position = r.position;  // keeps a not-a-number
        if (!(r.others <= worst.others)) worst.others = r.others;
    }
    return worst;
}

}  // namespace lcl
