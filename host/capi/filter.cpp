// SPDX-License-Identifier: BSD-3-Clause
#include "host/filter/expansion.h"

#include <algorithm>

#include "host/capi/arguments.h"
#include "host/field/host_rows.h"

using namespace lcl;

namespace {

Series inner_series(lcl_series series) {
    if (series != LCL_SERIES_REPRESENTATION && series != LCL_SERIES_INTERPOLATION)
        throw InvalidArgument("options.series is " + std::to_string(series) + ", it is 0 or 1");
    return static_cast<Series>(series);
}

PassProgress inner_progress(lcl_pass_callback progress, void* user) {
    if (progress == nullptr) return {};
    return [=](std::int64_t done, std::int64_t all) { return progress(user, done, all) != 0; };
}

Polynomial polynomial(const lcl_expand_options& options) {
    const Series series = inner_series(options.series);
    if (options.weight_count > 0) required(options.weights, "options.weights");
    if (options.weights == nullptr) return sum_of_terms(series, options.first, options.last);
    return equaliser(series, {options.weights, options.weights + std::min<std::size_t>(options.weight_count, most_terms + 1)}, options.remainder);
}
Polynomial polynomial(const lcl_denoise_options& options) { return denoiser(options.m, options.k, options.plain != 0); }
Polynomial polynomial(const lcl_sharpen_options& options) { return sharpener(options.first, options.last, options.k); }

template <class Options>
lcl_status filter(lcl_operator A, const double* values, std::size_t stride, int32_t channels, const Options& options, double* out, std::size_t out_stride) {
    LimitSystem& system = *required(A, "A")->system;
    if (stride == 0) stride = channels;
    if (out_stride == 0) out_stride = channels;
    check_channels(channels, stride, "stride");
    check_channels(channels, out_stride, "out_stride");
    refuse_ghosts(system.plan());
    filter_host(system, polynomial(options), required(values, "M"), stride, channels, inner_precision(options.precision), required(out, "out"), out_stride,
                inner_progress(options.progress, options.progress_user));
    return LCL_OK;
}

template <class Options>
lcl_status filter(lcl_operator A, lcl_field M, const Options& options, lcl_field out) {
    check_same_operator(required(A, "A"), {required(M, "M"), required(out, "out")});
    if (M == out) throw InvalidArgument("M and out are the same field");
    refuse_ghosts(A->system->plan());
    const Polynomial p = polynomial(options);
    const Transform transform = transform_after(p, transform_of(M, "M"));
    if (options.progress == nullptr) {
        filter_field(*A->system, p, M->field, out->field);
    } else {  // a filter that is cancelled leaves `out` as it was
        Field& result = A->system->work_field(LimitSystem::Purpose::right, M->field.channels(), M->field.real());
        filter_field(*A->system, p, M->field, result, inner_progress(options.progress, options.progress_user));
        std::swap(out->field, result);
    }
    out->transform = transform;
    return LCL_OK;
}

}  // namespace

extern "C" {

lcl_status lcl_expand(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_expand_options* options, double* out, size_t out_stride) {
    return guarded([&] { return filter(A, M, stride, channels, options_or(options, LCL_EXPAND_OPTIONS_INIT, "options"), out, out_stride); });
}

lcl_status lcl_expand_field(lcl_operator A, lcl_field M, const lcl_expand_options* options, lcl_field out) {
    return guarded([&] { return filter(A, M, options_or(options, LCL_EXPAND_OPTIONS_INIT, "options"), out); });
}

lcl_status lcl_denoise(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_denoise_options* options, double* out, size_t out_stride) {
    return guarded([&] { return filter(A, M, stride, channels, options_or(options, LCL_DENOISE_OPTIONS_INIT, "options"), out, out_stride); });
}

lcl_status lcl_denoise_field(lcl_operator A, lcl_field M, const lcl_denoise_options* options, lcl_field out) {
    return guarded([&] { return filter(A, M, options_or(options, LCL_DENOISE_OPTIONS_INIT, "options"), out); });
}

lcl_status lcl_sharpen(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_sharpen_options* options, double* out, size_t out_stride) {
    return guarded([&] { return filter(A, M, stride, channels, options_or(options, LCL_SHARPEN_OPTIONS_INIT, "options"), out, out_stride); });
}

lcl_status lcl_sharpen_field(lcl_operator A, lcl_field M, const lcl_sharpen_options* options, lcl_field out) {
    return guarded([&] { return filter(A, M, options_or(options, LCL_SHARPEN_OPTIONS_INIT, "options"), out); });
}

lcl_status lcl_denoise_settings(double strength, int32_t* m, int32_t* k) {
    return guarded([&] {
        const DenoiseSettings settings = denoise_settings(strength);
        *required(m, "m") = settings.m;
        *required(k, "k") = settings.k;
        return LCL_OK;
    });
}

lcl_status lcl_spectrum(lcl_operator A, const double* M, size_t stride, int32_t channels, lcl_precision precision, int32_t term_count, double* energies) {
    return guarded([&] {
        LimitSystem& system = *required(A, "A")->system;
        if (stride == 0) stride = channels;
        check_channels(channels, stride, "stride");
        refuse_ghosts(system.plan());
        const Transform transform = fit_transform(system.plan(), required(M, "M"), stride, channels);
        Field values = system.A->make_field(channels, real_of(inner_precision(precision)));
        upload_rows(system.plan(), transform, {M, stride}, values);
        const std::vector<double> found = term_energies(system, values, transform, term_count);
        std::copy(found.begin(), found.end(), required(energies, "energies"));
        return LCL_OK;
    });
}

lcl_status lcl_spectrum_field(lcl_operator A, lcl_field M, int32_t term_count, double* energies) {
    return guarded([&] {
        check_same_operator(required(A, "A"), {required(M, "M")});
        refuse_ghosts(A->system->plan());
        const std::vector<double> found = term_energies(*A->system, M->field, transform_of(M, "M"), term_count);
        std::copy(found.begin(), found.end(), required(energies, "energies"));
        return LCL_OK;
    });
}

}  // extern "C"
