// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "host/capi/handles.h"

using namespace lcl;

namespace {

lcl_operator adopt(lcl_context context, std::unique_ptr<LimitSystem> system) {
    auto handle = std::make_unique<lcl_operator_s>();
    handle->context = share(context);
    handle->system = std::move(system);
    return handle.release();
}

constexpr int most_smoothing = 1000;

FeatureOperatorOptions inner_options(const lcl_feature_options& given, Index vertex_count) {
    FeatureOperatorOptions options;
    if (given.angle_degrees != 0) options.angle_degrees = given.angle_degrees;
    if (given.diagonal_factor != 0) options.diagonal_factor = given.diagonal_factor;
    if (given.smoothing != 0) options.smoothing = std::max(0, given.smoothing);
    if (!(options.angle_degrees > 0 && options.angle_degrees <= 180))
        throw InvalidArgument("options.angle_degrees is " + std::to_string(options.angle_degrees) + ", it is above 0 and at most 180");
    if (!(options.diagonal_factor > 2) || !std::isfinite(options.diagonal_factor))
        throw InvalidArgument("options.diagonal_factor is " + std::to_string(options.diagonal_factor) + ", it is above 2");
    if (options.smoothing > most_smoothing)
        throw InvalidArgument("options.smoothing is " + std::to_string(options.smoothing) + ", it is at most " + std::to_string(most_smoothing));
    options.subset = vertex_marks(given.subset, given.subset_count, vertex_count, "subset");
    return options;
}

}  // namespace

extern "C" {

lcl_status lcl_operator_create_rows(lcl_context context, const lcl_rows* rows, lcl_operator* A) {
    return guarded([&] {
        required(A, "A");
        required(context, "context");
        const lcl_rows given = options_or(required(rows, "rows"), LCL_ROWS_INIT, "rows");
        if (given.row_count < 1) throw InvalidArgument("rows.row_count is " + std::to_string(given.row_count) + ", it is at least 1");
        const RowMatrix matrix{given.row_count, required(given.offsets, "rows.offsets"), required(given.columns, "rows.columns"),
                               required(given.weights, "rows.weights"), given.scaling};
        *A = adopt(context, make_rows_system(context->context, matrix));
        return LCL_OK;
    });
}

lcl_status lcl_operator_create_features(lcl_context context, lcl_mesh mesh, const lcl_feature_options* options, lcl_operator* A) {
    return guarded([&] {
        required(A, "A");
        required(context, "context");
        const FeatureOperatorOptions inner =
            inner_options(options_or(options, LCL_FEATURE_OPTIONS_INIT, "options"), required(mesh, "mesh")->file.mesh.vertex_count);
        *A = adopt(context, make_feature_system(context->context, mesh->file.mesh, mesh->topology(), mesh->features(), inner));
        return LCL_OK;
    });
}

}  // extern "C"
