// SPDX-License-Identifier: BSD-3-Clause
#include "host/filter/morph.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "host/field/host_rows.h"
#include "host/filter/expansion.h"

namespace lcl {
namespace {

constexpr int most_frames = 1000000;

void check(const MorphOptions& options) {
    if (options.frames < 1 || options.frames > most_frames)
        throw InvalidArgument("frames is " + std::to_string(options.frames) + ", it goes from 1 to " + std::to_string(most_frames));
    for (const int m : options.m) check_morph(m, 1);
    for (const double rho : options.rho) check_morph(0, rho);
}

template <class T>
T entry(const std::vector<T>& list, int step) {
    return list[std::min<std::size_t>(step, list.size() - 1)];
}

/// One morph: the difference Q_k - to on the device, frames through host memory.
class Morph {
public:
    Morph(LimitSystem& system, const double* from, const double* to, std::size_t stride, int channels, const MorphOptions& options)
        : system_(system),
          A_(*system.A),
          plan_(system.plan()),
          options_(options),
          from_(from),
          to_(to),
          stride_(stride),
          channels_(channels),
          transform_(fit_transform(plan_, to, stride, channels)),
          points_(static_cast<std::size_t>(plan_.vertex_count) * channels) {}

    void run(const FrameSink& frame) {
        give(frame, 0, from_);
        if (options_.path != MorphPath::linear) begin();
        for (int step = 0; step < options_.frames; ++step) {
            const bool is_last = step + 1 == options_.frames;
            if (is_last && options_.path != MorphPath::recursion) {
                give(frame, step + 1, to_);
            } else {
                make_frame(step);
                if (!frame(step + 1, points_.data())) throw Cancelled("cancelled by the caller");
            }
        }
    }

private:
    void give(const FrameSink& frame, int number, const double* values) {
        for (std::size_t v = 0; v < static_cast<std::size_t>(plan_.vertex_count); ++v) std::copy_n(values + v * stride_, channels_, &points_[v * channels_]);
        if (!frame(number, points_.data())) throw Cancelled("cancelled by the caller");
    }

    /// Q_0 - to on the device, and its norm.
    void begin() {
        const Real real = real_of(options_.precision);
        target_.emplace(A_.make_field(channels_, real));
        difference_.emplace(A_.make_field(channels_, real));
        frame_.emplace(A_.make_field(channels_, real));
        upload_rows(plan_, transform_, {to_, stride_}, *target_);
        for (std::size_t v = 0; v < static_cast<std::size_t>(plan_.vertex_count); ++v)
            for (int c = 0; c < channels_; ++c) points_[v * channels_ + c] = from_[v * stride_ + c] - to_[v * stride_ + c];
        Transform difference = transform_;
        std::fill(difference.centre.begin(), difference.centre.end(), 0.0);
        upload_rows(plan_, difference, {points_.data(), static_cast<std::size_t>(channels_)}, *difference_);
        if (options_.path == MorphPath::even) first_norm_ = difference_norm();
    }

    /// |Q_0 - to|_D over x, y, z, in the fields' units.
    double difference_norm() const {
        double square = 0;
        for (Index row = 0; row < plan_.row_count; ++row)
            for (int c = 0; c < std::min(channels_, 3); ++c) {
                const double value = points_[static_cast<std::size_t>(plan_.vertex_of_row[row]) * channels_ + c] * transform_.scale[c];
                square += plan_.scaling[row] > 0 ? plan_.scaling[row] * value * value : 0.0;
            }
        return std::sqrt(square);
    }

    void make_frame(int step) {
        if (options_.path == MorphPath::linear) return mix((step + 1.0) / options_.frames);
        const int m = entry(options_.m, step);
        if (options_.path == MorphPath::even) fixed_share_ *= even_step(m, 1 - (step + 1.0) / options_.frames);
        else {
            morph_field(system_, m, entry(options_.rho, step), *target_, *difference_, *frame_);
            fixed_share_ *= entry(options_.rho, step);
        }
        download_rows(plan_, transform_, *frame_, {points_.data(), static_cast<std::size_t>(channels_)});
        for (Index row = 0; row < plan_.fixed.end_row(); ++row) mix(plan_.vertex_of_row[row], fixed_share_);
    }

    // rho_k = min(1, (1 - (k+1)/N) |Q_0 - to|_D / |Y_k|_D), Y_k = D (Q_k - to); 0 where Y_k = 0
    double even_step(int m, double share) {
        if (m > most_factored) filter_field(system_, denoiser(m, 1, true), *difference_, *frame_), std::swap(*difference_, *frame_);
        const SeriesSteps steps = m > most_factored ? SeriesSteps{SeriesThird::older, {{1, 0, 0}}, {}, 0} : morph_steps(m, 1);
        const std::vector<SeriesSums> sums = A_.series_with_sums(steps, *difference_, *frame_, scratch());
        std::swap(*difference_, *frame_);
        double square = 0;
        for (int c = 0; c < std::min(channels_, 3); ++c) square += sums.back().square[c];
        const double norm = std::sqrt(square), rho = norm > 0 ? std::min(1.0, share * first_norm_ / norm) : 0.0;
        A_.morph_blend(rho, *target_, *difference_, *frame_);
        return rho;
    }

    void mix(double share) {
        for (Index v = 0; v < plan_.vertex_count; ++v) mix(v, 1 - share);
    }
    /// to + share (from - to)
    void mix(Index v, double share) {
        for (int c = 0; c < channels_; ++c) {
            const double end = to_[v * stride_ + c];
            points_[static_cast<std::size_t>(v) * channels_ + c] = end + share * (from_[v * stride_ + c] - end);
        }
    }

    Field& scratch() { return system_.work_field(LimitSystem::Purpose::scratch, channels_, difference_->real()); }

    LimitSystem& system_;
    DeviceOperator& A_;
    const Plan& plan_;
    const MorphOptions& options_;
    const double *from_, *to_;
    const std::size_t stride_;
    const int channels_;
    const Transform transform_;
    std::vector<double> points_;
    std::optional<Field> target_, difference_, frame_;
    double first_norm_ = 0;
    double fixed_share_ = 1;  // of Q_0 - to in rows with A x = x, which are made here: to the bit where both meshes have the same point, isolated ones anywhere
};

}  // namespace

void morph_field(LimitSystem& system, int m, double rho, const Field& target, Field& difference, Field& frame) {
    check_morph(m, rho);
    if (m > most_factored) {
        filter_field(system, denoiser(m, 1, true), difference, frame);
        std::swap(difference, frame);
        return system.A->morph_blend(rho, target, difference, frame);
    }
    Field& scratch = system.work_field(LimitSystem::Purpose::scratch, difference.channels(), difference.real());
    system.A->morph(morph_steps(m, rho), target, difference, scratch, frame);
}

void morph_host(LimitSystem& system, const double* from, const double* to, std::size_t stride, int channels, const MorphOptions& options,
                const FrameSink& frame) {
    check(options);
    if (options.path == MorphPath::even) require_scaling(system.plan(), "even morphs");
    Morph(system, from, to, stride, channels, options).run(frame);
}

}  // namespace lcl
