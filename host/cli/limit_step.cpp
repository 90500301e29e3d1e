// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/limit_step.h"

#include "host/cli/channels.h"
#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

/// One pass costs next to nothing beside the transfers, so `mixed` means the better precision here: the result then meets any tolerance that the solve met.
lcl_precision pass_precision(const Job& job) {
    const bool in_double = job.options.precision == LCL_PRECISION_MIXED && job.report.device->has_double;
    return in_double ? LCL_PRECISION_DOUBLE : job.options.precision;
}

Field make_field(lcl_operator A, std::int32_t channels, lcl_precision precision) {
    lcl_field field = nullptr;
    check(lcl_field_create(A, channels, precision, &field));
    return Field(field);
}

}  // namespace

void move_to_limit(Job& job, lcl_context context, lcl_operator A, lcl_mesh mesh, const std::vector<std::string>& channels) {
    std::vector<double> values = gather_values(mesh, channels);
    const auto channel_count = static_cast<std::int32_t>(3 + channels.size());
    Field points, limits;
    {
        const Phase phase(job, &Seconds::upload, "uploading", context);
        points = make_field(A, channel_count, pass_precision(job));
        limits = make_field(A, channel_count, pass_precision(job));
        check(lcl_field_upload(points.get(), values.data(), LCL_TYPE_DOUBLE, 0));
        check(lcl_field_match(limits.get(), points.get()));
    }
    {
        const Phase phase(job, &Seconds::solve, "taking limit points", context);
        check(lcl_operator_apply(A, points.get(), limits.get()));
        check(lcl_context_finish(context));
    }
    {
        const Phase phase(job, &Seconds::download, "downloading", context);
        check(lcl_field_download(limits.get(), values.data(), LCL_TYPE_DOUBLE, 0));
    }
    scatter_values(mesh, channels, values);
}

}  // namespace lcl::cli
