// SPDX-License-Identifier: BSD-3-Clause
// Series, filters and morphs: chains of steps y = a x + b A x + c d without a residual.
#include <algorithm>

#include "host/apply/device_operator.h"
#include "host/apply/real_values.h"
#include "kernels/types.cl.h"

namespace lcl {
namespace {

constexpr int chains_in_flight = 64;  // enqueued before the host waits: drivers hold every launch in memory

}  // namespace

/// Rows that read each other and no others: apart, the smooth ones can be swept in phases.
std::vector<Part> DeviceOperator::series_parts() const {
    const Plan& plan = *plan_;
    const bool are_apart = plan.curves.row_count == 0 && plan.darts.row_count == 0 && plan.fixed.row_count == plan.isolated_count;
    if (!are_apart || plan.smooth.row_count == 0) return {plan.all_rows()};
    if (plan.fixed.row_count == 0) return {plan.smooth};
    return {plan.fixed, plan.smooth};
}

/// Steps [first, first + phases.sweeps) on a part. fields: input, even, odd. prepare(block, set) calls set(kernel, its last arguments..) for a channel block.
template <class Prepare>
void DeviceOperator::run_series_chain(const SeriesSteps& steps, std::int64_t first, const Phases& phases, const Part& part,
                                      const std::array<const Field*, 3>& fields, const Prepare& prepare) {
    const Field *const input = fields[0], *const even = fields[1], *const odd = fields[2];
    std::vector<double> values;
    for (std::int64_t k = first; k < first + phases.sweeps; ++k) values.insert(values.end(), {steps[k].a, steps[k].b, steps[k].c});
    // By no queue: an upload would wait for launches that the caller may hold back.
    const std::vector<unsigned char> bytes = real_bytes(*context_, input->real(), values);
    const Buffer coefficients(context_, bytes.size(), "the coefficients of a series", bytes.data());
    const cl_int first_step = first == 0 ? 0 : 1;  // only whether it is the first matters
    for (std::size_t b = 0; b < input->blocks().size(); ++b)
        prepare(b, [&](cl_kernel kernel, const auto&... rest) {
            set_arguments(kernel, 0, 0, phases.width, phases.lag, part.first_block, part.block_count, blocks_, runs_, weights(input->real(), false), indices_,
                          weighted_offsets_, weighted_indices_, weights(input->real(), true), first_step, coefficients, input->buffer(b), even->buffer(b),
                          odd->buffer(b), rest...);
            enqueue_phases(phases, part, kernel);
        });
}

template <class Prepare>
bool DeviceOperator::run_series(const SeriesSteps& steps, const Field& input, Field& out, Field& scratch, const SeriesProgress& progress,
                                const Prepare& prepare) {
    const std::int64_t count = steps.count();
    const int touched = steps.third == SeriesThird::input ? 3 : 2;
    const std::vector<Part> parts = series_parts();
    for (const Part& part : parts) {
        const bool tells = progress && &part == &parts.back();  // the parts before hold isolated vertices alone
        int chains = 0;
        for (std::int64_t k = 0; k < count;) {
            const Phases some = phases(static_cast<std::size_t>(std::min<std::int64_t>(count - k, LCL_CHAIN)), input, part, touched);
            // Step j writes `out` where an even number of steps follow.
            const bool begins_in_out = (count - 1 - k) % 2 == 0;
            run_series_chain(steps, k, some, part, {&input, begins_in_out ? &scratch : &out, begins_in_out ? &out : &scratch},
                             [&](std::size_t block, const auto& set) { prepare(part, some, k, block, set); });
            k += some.sweeps;
            if (tells || ++chains % chains_in_flight == 0) context_->finish();
            if (tells && !progress(k)) return false;
        }
    }
    return true;
}

bool DeviceOperator::series(const SeriesSteps& steps, const Field& input, Field& out, Field& scratch, const SeriesProgress& progress) {
    if (steps.count() == 0) out.copy_from(input);
    const bool is_horner = steps.third == SeriesThird::input;
    return run_series(steps, input, out, scratch, progress, [&](const Part&, const Phases&, std::int64_t, std::size_t b, const auto& set) {
        set(is_horner ? kernel("series", "lcl_series", input, b) : kernel("filter", "lcl_filter", input, b));
    });
}

DeviceOperator::Partials& DeviceOperator::series_partials(const Field& field) {
    Partials& partials = partials_[{field.real(), field.channels()}];
    const std::size_t count = std::max<std::size_t>(1, plan_->blocks.size());
    for (std::size_t b = partials.series_sums.size(); b < field.blocks().size(); ++b)
        partials.series_sums.emplace_back(context_, 2 * LCL_CHAIN * count * field.blocks()[b].width * sizeof(double), "sums of a series");
    return partials;
}

std::vector<SeriesSums> DeviceOperator::series_with_sums(const SeriesSteps& steps, const Field& input, Field& out, Field& scratch) {
    std::vector<SeriesSums> sums(static_cast<std::size_t>(steps.count()), {ChannelValues(input.channels(), 0.0), ChannelValues(input.channels(), 0.0)});
    const auto stride = static_cast<cl_int>(plan_->blocks.size());
    run_series(steps, input, out, scratch, {}, [&](const Part& part, const Phases& phases, std::int64_t first, std::size_t b, const auto& set) {
        set(kernel("series", "lcl_series_sums", input, b), stride, scaling(input.real()), series_partials(input).series_sums[b]);
        if (b + 1 == input.blocks().size()) read_series_sums(input, part, phases.sweeps, sums.data() + first);
    });
    return sums;
}

void DeviceOperator::read_series_sums(const Field& like, const Part& part, Index sweeps, SeriesSums* sums) {
    const std::size_t bytes = context_->device().has_double ? sizeof(double) : sizeof(float), stride = plan_->blocks.size();
    for (std::size_t b = 0; b < like.blocks().size(); ++b) {
        const ChannelBlock& block = like.blocks()[b];
        const std::size_t row = 2 * block.width * bytes;
        std::vector<unsigned char> raw(((sweeps - 1) * stride + part.block_count) * row);
        context_->read(series_partials(like).series_sums[b], part.first_block * row, raw.size(), raw.data(), "reading the sums of a series");
        for (Index s = 0; s < sweeps; ++s)
            for (Index i = 0; i < part.block_count; ++i)
                for (int c = 0; c < block.count; ++c) {
                    const unsigned char* place = raw.data() + (s * stride + i) * row + c * bytes;
                    sums[s].linear[block.first + c] += real_at(place, bytes == sizeof(double));
                    sums[s].square[block.first + c] += real_at(place + block.width * bytes, bytes == sizeof(double));
                }
    }
}

// difference = .. (steps); frame = target + difference
void DeviceOperator::morph(const SeriesSteps& steps, const Field& target, Field& difference, Field& scratch, Field& frame) {
    const std::int64_t count = steps.count();
    const bool ends_in_scratch = count % 2 == 1;
    run_series(steps, difference, ends_in_scratch ? scratch : difference, ends_in_scratch ? difference : scratch, {},
               [&](const Part&, const Phases& phases, std::int64_t first, std::size_t b, const auto& set) {
                   const bool ends = first + phases.sweeps == count;
                   const auto last = static_cast<cl_int>(ends ? (first == 0 ? 0 : 1) + phases.sweeps - 1 : -1);
                   set(kernel("morph", "lcl_morph", difference, b), last, target.buffer(b), frame.buffer(b));
               });
    if (ends_in_scratch) std::swap(difference, scratch);
}

void DeviceOperator::launch_rows(const char* name, const Field& like, const std::function<void(cl_kernel, std::size_t)>& set) {
    for (std::size_t b = 0; b < like.blocks().size(); ++b) {
        const cl_kernel rows = kernel("morph", name, like, b);
        set(rows, b);
        enqueue(*context_, rows, {static_cast<std::size_t>(plan_->vertex_count), 0});
    }
}

void DeviceOperator::morph_blend(double rho, const Field& target, Field& difference, Field& frame) {
    const std::vector<unsigned char> bytes = real_bytes(*context_, difference.real(), {rho});
    const Buffer factor(context_, bytes.size(), "the factor of a morph", bytes.data());
    launch_rows("lcl_morph_blend", difference, [&](cl_kernel kernel, std::size_t b) {
        set_arguments(kernel, plan_->vertex_count, factor, target.buffer(b), difference.buffer(b), frame.buffer(b));
    });
}

void DeviceOperator::subtract(const Field& a, const Field& b, Field& difference) {
    launch_rows("lcl_morph_difference", a, [&](cl_kernel kernel, std::size_t block) {
        set_arguments(kernel, plan_->vertex_count, a.buffer(block), b.buffer(block), difference.buffer(block));
    });
}

}  // namespace lcl
