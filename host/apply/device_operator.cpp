// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/device_operator.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/apply/real_values.h"
#include "host/parallel.h"
#include "kernels/types.cl.h"

namespace lcl {
namespace {

constexpr int cpu_schedule_chunk = 256;  // rows of a Gauss-Seidel step that one work-item of a CPU takes
constexpr Index phase_blocks_per_unit = 6;
constexpr Index blocks_per_unit = 8;  // of a small mesh

/// A scalar, a row of them, or the coefficients of a chain, in a kernel's own type, by value.
struct RealValue {
    std::array<unsigned char, 4 * LCL_CHAIN * sizeof(double)> bytes;
    std::size_t size = 0;
    void append(bool as_double, std::initializer_list<double> values) {
        for (const double value : values) {
            const float narrow = static_cast<float>(value);
            const std::size_t count = as_double ? sizeof value : sizeof narrow;
            std::memcpy(bytes.data() + size, as_double ? static_cast<const void*>(&value) : &narrow, count);
            size += count;
        }
    }
};

RealValue real_value(bool as_double, std::initializer_list<double> values) {
    RealValue out;
    out.append(as_double, values);
    return out;
}

/// The channels of one block as a vector of its width, the rest zero.
RealValue row_value(bool as_double, const ChannelBlock& block, const ChannelValues& values) {
    const auto at = [&](int i) { return i < block.count ? values[block.first + i] : 0.0; };
    if (block.width == 1) return real_value(as_double, {at(0)});
    if (block.width == 2) return real_value(as_double, {at(0), at(1)});
    RealValue row = real_value(as_double, {at(0), at(1), at(2), at(3)});
    if (block.width == 8) row.append(as_double, {at(4), at(5), at(6), at(7)});
    return row;
}

void set_argument(cl_kernel kernel, unsigned place, const RealValue& value) { set_argument_bytes(kernel, place, value.bytes.data(), value.size); }

/// Squared norms that kernels leave for a block of rows.
std::size_t norm_count(const ChannelBlock& block) { return is_mixed(block) ? 2 : 1; }

std::vector<lcl_run> device_runs(const Plan& plan) {
    static_assert(LCL_SHAPE_IDENTITY == static_cast<int>(RowShape::identity) && LCL_SHAPE_RING == static_cast<int>(RowShape::ring) &&
                  LCL_SHAPE_FULL_RING == static_cast<int>(RowShape::full_ring) && LCL_SHAPE_WEIGHTED == static_cast<int>(RowShape::weighted));
    std::vector<lcl_run> runs;
    runs.reserve(plan.runs.size());
    for (const Run& run : plan.runs) runs.push_back({run.first, run.count, static_cast<int>(run.shape), run.edges, run.index_offset, 0, 0, 0});
    return runs;
}

}  // namespace

LaunchShape launch_shape(const DeviceInfo& device, Index vertex_count) {
    if (!device.is_gpu) {
        const Index units = static_cast<Index>(std::max(1u, device.compute_units));
        return {1, std::clamp<Index>(vertex_count / (blocks_per_unit * units), 256, 4096), device.cache_bytes / 4 * 3, phase_blocks_per_unit * units};
    }
    int group = 128;
    while (group > 1 && static_cast<std::size_t>(group) > device.max_work_group_size) group /= 2;
    return {group, 1024, 0, 1};
}

DeviceOperator::DeviceOperator(std::shared_ptr<Context> context, std::shared_ptr<const Plan> plan, const LaunchShape& shape)
    : context_(std::move(context)), plan_(std::move(plan)), shape_(shape) {
    static_assert(sizeof(lcl_block) == sizeof(Block));
    const std::vector<lcl_run> runs = device_runs(*plan_);
    const auto upload_all = [&](const auto& values, const char* what) { return upload(values.data(), values.size() * sizeof values[0], what); };
    blocks_ = upload_all(plan_->blocks, "the blocks of a limit operator");
    runs_ = upload_all(runs, "the runs of a limit operator");
    indices_ = upload_doubled(plan_->indices, "the limit stencils' neighbours");
    weighted_offsets_ = upload_all(plan_->weighted_offsets, "the offsets of weighted limit stencils");
    weighted_indices_ = upload_all(plan_->weighted_indices, "the columns of weighted limit stencils");
}

Buffer DeviceOperator::upload(const void* data, std::size_t bytes, const char* what) {
    Buffer buffer(context_, std::max<std::size_t>(bytes, 16), what);
    // Not on the kernels' queue, where it would wait for what a caller has put there; nothing uses a new buffer yet.
    if (bytes > 0) context_->write_async(buffer, 0, bytes, data, {}, std::string("uploading ") + what).wait();
    return buffer;
}

/// Kernels take row numbers doubled (rows.cl.h).
Buffer DeviceOperator::upload_doubled(const Array<Index>& rows, const char* what) {
    Array<std::uint32_t> doubled(rows.size());
    parallel_for(rows.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) doubled[i] = 2 * static_cast<std::uint32_t>(rows[i]);
    });
    return upload(doubled.data(), doubled.size() * sizeof doubled[0], what);
}

Buffer DeviceOperator::upload_reals(const std::vector<double>& values, Real real, const char* what) {
    const std::vector<unsigned char> bytes = real_bytes(*context_, real, values);
    return upload(bytes.data(), bytes.size(), what);
}

const Buffer& DeviceOperator::weights(Real real, bool weighted_rows) {
    Buffer& buffer = weights_[{real, weighted_rows}];
    if (buffer) return buffer;
    if (weighted_rows) return buffer = upload_reals(plan_->weighted_weights, real, "the weights of weighted limit stencils");
    std::vector<double> values;
    for (const Run& run : plan_->runs) values.insert(values.end(), {run.weights.vertex, run.weights.edge, run.weights.diagonal});
    return buffer = upload_reals(values, real, "the weights of limit stencils");
}

const Buffer& DeviceOperator::vertex_order() {
    if (!vertex_order_) vertex_order_ = upload(plan_->vertex_of_row.data(), plan_->vertex_of_row.size() * sizeof(Index), "the vertex order");
    return vertex_order_;
}

const Buffer& DeviceOperator::scaling(Real real) {
    Buffer& buffer = scaling_[real];
    if (!buffer) buffer = upload_reals(plan_->scaling, real, "the scaling of a limit operator");
    return buffer;
}

DeviceOperator::Partials& DeviceOperator::partials(const Field& field) {
    Partials& partials = partials_[{field.real(), field.channels()}];
    const std::size_t count = std::max<std::size_t>(1, plan_->blocks.size());
    for (std::size_t b = partials.norms.size(); b < field.blocks().size(); ++b) {
        partials.norms.emplace_back(context_, LCL_CHAIN * count * norm_count(field.blocks()[b]) * sizeof(double), "norms of blocks");
        partials.sums.emplace_back(context_, count * field.blocks()[b].width * sizeof(double), "sums of blocks");
    }
    return partials;
}

cl_kernel DeviceOperator::kernel(const char* file, const char* name, const Field& field, std::size_t block) {
    return context_->kernel(file, name, kernel_options(*context_, field.real(), field.blocks()[block].width, shape_.group));
}

cl_kernel DeviceOperator::norm_kernel(const char* file, const char* name, const Field& field, std::size_t block, const std::string& options) {
    const char* const mixed = is_mixed(field.blocks()[block]) ? " -D LCL_MIXED" : "";
    return context_->kernel(file, name, options + mixed);
}

cl_kernel DeviceOperator::norm_kernel(const char* file, const char* name, const Field& field, std::size_t block) {
    return norm_kernel(file, name, field, block, kernel_options(*context_, field.real(), field.blocks()[block].width, shape_.group));
}

LaunchSize DeviceOperator::size(const Part& part) const {
    return {static_cast<std::size_t>(part.block_count) * shape_.group, static_cast<std::size_t>(shape_.group)};
}

void DeviceOperator::limit_points(const Field& x, Field& y, const Part& part) {
    for (std::size_t b = 0; b < x.blocks().size(); ++b)
        launch(*context_, kernel("limit", "lcl_limit_points", x, b), size(part), part.first_block, blocks_, runs_, weights(x.real(), false), indices_,
               weighted_offsets_, weighted_indices_, weights(x.real(), true), x.buffer(b), y.buffer(b));
}

// y = a x + (b + b_jacobi / A_ii) (m - A x) + c d
void DeviceOperator::sweep(const Sweep& s, const Field& m, const Field& x, const Field* d, Field& y, const Part& part) {
    const bool as_double = is_double(*context_, x.real());
    const RealValue a = real_value(as_double, {s.a}), b = real_value(as_double, {s.b}), b_jacobi = real_value(as_double, {s.b_jacobi}),
                    c = real_value(as_double, {s.c});
    for (std::size_t k = 0; k < x.blocks().size(); ++k) {
        const Buffer& norms = partials(x).norms[k];
        if (d == nullptr)
            launch(*context_, norm_kernel("relax", "lcl_relax", x, k), size(part), part.first_block, blocks_, runs_, weights(x.real(), false), indices_,
                   weighted_offsets_, weighted_indices_, weights(x.real(), true), a, b, b_jacobi, m.buffer(k), x.buffer(k), y.buffer(k), norms);
        else
            launch(*context_, norm_kernel("relax", "lcl_relax_three_term", x, k), size(part), part.first_block, blocks_, runs_, weights(x.real(), false),
                   indices_, weighted_offsets_, weighted_indices_, weights(x.real(), true), a, b, b_jacobi, c, m.buffer(k), x.buffer(k), d->buffer(k),
                   y.buffer(k), norms);
    }
}

// The rows of all sweeps of a phase have to stay in cache: each sweep's own blocks and those up to the next one's.
DeviceOperator::Phases DeviceOperator::phases(std::size_t sweeps, const Field& field, const Part& part, int fields) const {
    const Index all = std::max(1, part.block_count);
    const Phases one_by_one{all, all, std::min<Index>(static_cast<Index>(sweeps), LCL_CHAIN)};
    const bool is_smooth = part.first_block == plan_->smooth.first_block && part.block_count == plan_->smooth.block_count;
    if (!is_smooth || part.row_count == 0) return one_by_one;
    std::size_t widest = 0;
    for (std::size_t b = 0; b < field.blocks().size(); ++b) widest = std::max(widest, field.row_bytes(b));
    const std::size_t stencil_bytes = sizeof(Index) * plan_->indices.size() + (sizeof(Index) + sizeof(float)) * plan_->weighted_indices.size();
    const std::size_t row_bytes = fields * widest + stencil_bytes / part.row_count;
    if (row_bytes * part.row_count <= shape_.cache_bytes) return one_by_one;  // all of it stays in cache
    for (Index depth = one_by_one.sweeps; depth > 1; --depth) {
        const Index width = (shape_.phase_blocks + depth - 1) / depth, lag = plan_->reach + 2 * width;
        const std::size_t rows = static_cast<std::size_t>(depth) * lag * shape_.block_rows;
        if (rows * row_bytes <= shape_.cache_bytes && rows < static_cast<std::size_t>(part.row_count)) return {width, lag, depth};
    }
    return one_by_one;
}

std::vector<ResidualNorms> DeviceOperator::chain(const std::vector<Sweep>& sweeps, const Field& m, Field& x, Field& y, const Part& part) {
    std::vector<ResidualNorms> norms;
    while (norms.size() < sweeps.size()) {
        Phases some = phases(sweeps.size() - norms.size(), x, part);
        run_phases(some, sweeps.data() + norms.size(), m, x, y, part);
        const std::vector<ResidualNorms> theirs = norms_of_sweeps(x, part, some.sweeps);
        norms.insert(norms.end(), theirs.begin(), theirs.end());
        if (some.sweeps % 2 == 1) std::swap(x, y);
    }
    return norms;
}

void DeviceOperator::run_phases(const Phases& phases, const Sweep* sweeps, const Field& m, Field& x, Field& y, const Part& part) {
    const bool as_double = is_double(*context_, x.real());
    RealValue values;
    for (Index k = 0; k < phases.sweeps; ++k) values.append(as_double, {sweeps[k].a, sweeps[k].b, sweeps[k].b_jacobi, sweeps[k].c});
    if (!chain_) chain_ = Buffer(context_, sizeof values.bytes, "the coefficients of a chain of sweeps");
    // Beside the kernels' queue; the chain before has ended, since its norms were read.
    context_->write_async(chain_, 0, values.size, values.bytes.data(), {}, "uploading the coefficients of a chain of sweeps").wait();
    const auto stride = static_cast<Index>(plan_->blocks.size());
    for (std::size_t k = 0; k < x.blocks().size(); ++k) {
        const cl_kernel relax = norm_kernel("relax", "lcl_relax_phase", x, k);
        set_arguments(relax, 0, 0, phases.width, phases.lag, part.first_block, part.block_count, stride, blocks_, runs_, weights(x.real(), false), indices_,
                      weighted_offsets_, weighted_indices_, weights(x.real(), true), chain_, m.buffer(k), x.buffer(k), y.buffer(k), partials(x).norms[k]);
        enqueue_phases(phases, part, relax);
    }
}

void DeviceOperator::enqueue_phases(const Phases& phases, const Part& part, cl_kernel relax) {
    std::optional<Pipeline> pipeline;
    if (phases.lag > phases.width) pipeline.emplace(*context_);
    const Index last_phase = (part.block_count - 1 + (phases.sweeps - 1) * phases.lag) / phases.width;
    for (Index phase = 0; phase <= last_phase; ++phase) {
        // sweeps with a block in [phase * width - s * lag, + width)
        const Index over = phase * phases.width - (part.block_count - 1);
        const Index first = over > 0 ? (over + phases.lag - 1) / phases.lag : 0;
        const Index last = std::min(phases.sweeps - 1, (phase * phases.width + phases.width - 1) / phases.lag);
        const auto group = static_cast<std::size_t>(shape_.group);
        const LaunchSize size{phases.width * group, group, static_cast<std::size_t>(std::max(0, last - first + 1))};
        set_argument(relax, 0, phase);
        set_argument(relax, 1, first);
        if (pipeline) pipeline->enqueue(relax, size);
        else enqueue(*context_, relax, size);
    }
    if (pipeline) pipeline->join();
}

void DeviceOperator::wide_residual(const Field& m, const Field& x, Field& r, const Part& part) {
    const char* const fields = x.real() == Real::single ? " -D LCL_FLOAT_FIELDS" : "";
    for (std::size_t b = 0; b < x.blocks().size(); ++b) {
        const std::string options = kernel_options(*context_, Real::wide, x.blocks()[b].width, shape_.group) + fields;
        launch(*context_, norm_kernel("residual", "lcl_residual", x, b, options), size(part), part.first_block, blocks_, runs_, weights(Real::wide, false),
               indices_, weighted_offsets_, weighted_indices_, weights(Real::wide, true), m.buffer(b), x.buffer(b), r.buffer(b), partials(r).norms[b]);
    }
}

void DeviceOperator::correct(const Field& d, Field& x, const Part& part) {
    for (std::size_t b = 0; b < x.blocks().size(); ++b)
        launch(*context_, kernel("residual", "lcl_correct", x, b), {static_cast<std::size_t>(part.row_count), 0}, part.first_row, part.row_count, d.buffer(b),
               x.buffer(b));
}

DeviceOperator::ScheduleArrays& DeviceOperator::schedule_arrays(const Schedule& schedule, Real real) {
    ScheduleArrays& arrays = schedules_[{&schedule, real}];
    if (arrays.rows) return arrays;
    arrays.rows = upload(schedule.rows.data(), schedule.rows.size() * sizeof(Index), "the rows of a Gauss-Seidel schedule");
    arrays.offsets = upload(schedule.offsets.data(), schedule.offsets.size() * sizeof(std::uint32_t), "the offsets of a Gauss-Seidel schedule");
    arrays.columns = upload(schedule.columns.data(), schedule.columns.size() * sizeof(Index), "the columns of a Gauss-Seidel schedule");
    arrays.weights = upload_reals(schedule.weights, real, "the weights of a Gauss-Seidel schedule");
    arrays.inverse_diagonal = upload_reals(schedule.inverse_diagonal, real, "the diagonal of a Gauss-Seidel schedule");
    return arrays;
}

void DeviceOperator::relax_rows(const Schedule& schedule, const Field& m, Field& x) {
    const ScheduleArrays& arrays = schedule_arrays(schedule, x.real());
    const int chunk = shape_.group == 1 ? cpu_schedule_chunk : 1;
    for (std::size_t step = 0; step + 1 < schedule.step_offsets.size(); ++step) {
        const Index first = schedule.step_offsets[step], count = schedule.step_offsets[step + 1] - first;
        const std::size_t items = (count + chunk - 1) / chunk, local = static_cast<std::size_t>(shape_.group);
        for (std::size_t b = 0; b < x.blocks().size(); ++b)
            launch(*context_, kernel("gauss_seidel", "lcl_relax_rows", x, b), {(items + local - 1) / local * local, local}, first, count, chunk, arrays.rows,
                   arrays.offsets, arrays.columns, arrays.weights, arrays.inverse_diagonal, m.buffer(b), x.buffer(b));
    }
}

ResidualNorms DeviceOperator::norms(const Field& like, const Part& part) { return norms_of_sweeps(like, part, 1).front(); }

std::vector<ResidualNorms> DeviceOperator::norms_of_sweeps(const Field& like, const Part& part, std::size_t sweeps) {
    std::vector<ResidualNorms> worst(sweeps);
    const bool as_double = is_double(*context_, like.real());
    const std::size_t bytes = as_double ? sizeof(double) : sizeof(float), stride = plan_->blocks.size();
    for (std::size_t b = 0; b < like.blocks().size() && part.block_count > 0; ++b) {
        const std::size_t count = norm_count(like.blocks()[b]);
        std::vector<unsigned char> raw(((sweeps - 1) * stride + part.block_count) * count * bytes);
        context_->read(partials(like).norms[b], part.first_block * count * bytes, raw.size(), raw.data(), "reading residual norms");
        for (std::size_t s = 0; s < sweeps; ++s)
            for (std::size_t i = 0; i < part.block_count * count; ++i) {
                const double size = std::sqrt(real_at(raw.data() + (s * stride * count + i) * bytes, as_double));
                double& norm = b == 0 && i % count == 0 ? worst[s].position : worst[s].others;
                if (!(size <= norm)) norm = size;  // keeps a not-a-number
            }
    }
    return worst;
}

ChannelValues DeviceOperator::sums(const Field& field, const Part& part) {
    ChannelValues total(field.channels(), 0.0);
    const bool as_double = context_->device().has_double;
    const std::size_t bytes = as_double ? sizeof(double) : sizeof(float);
    for (std::size_t b = 0; b < field.blocks().size(); ++b) {
        const ChannelBlock& block = field.blocks()[b];
        std::vector<unsigned char> raw(static_cast<std::size_t>(part.block_count) * block.width * bytes);
        if (!raw.empty())
            context_->read(partials(field).sums[b], static_cast<std::size_t>(part.first_block) * block.width * bytes, raw.size(), raw.data(), "reading sums");
        for (Index i = 0; i < part.block_count; ++i)
            for (int c = 0; c < block.count; ++c) {
                total[block.first + c] += real_at(raw.data() + (static_cast<std::size_t>(i) * block.width + c) * bytes, as_double);
            }
    }
    return total;
}

ChannelValues DeviceOperator::cg_apply(const Field& p, Field& q, const Part& part) {
    for (std::size_t b = 0; b < p.blocks().size(); ++b)
        launch(*context_, kernel("conjugate_gradients", "lcl_cg_apply", p, b), size(part), part.first_block, blocks_, runs_, weights(p.real(), false), indices_,
               weighted_offsets_, weighted_indices_, weights(p.real(), true), scaling(p.real()), p.buffer(b), q.buffer(b), partials(p).sums[b]);
    return sums(p, part);
}

// x += alpha p, r -= alpha q
ChannelValues DeviceOperator::cg_update(const ChannelValues& alpha, const Field& p, const Field& q, Field& x, Field& r, const Part& part) {
    for (std::size_t b = 0; b < p.blocks().size(); ++b)
        launch(*context_, norm_kernel("conjugate_gradients", "lcl_cg_update", p, b), size(part), part.first_block, blocks_, scaling(p.real()),
               row_value(is_double(*context_, p.real()), p.blocks()[b], alpha), p.buffer(b), q.buffer(b), x.buffer(b), r.buffer(b), partials(p).sums[b],
               partials(p).norms[b]);
    return sums(p, part);
}

// p = r + beta p
void DeviceOperator::cg_direction(const ChannelValues& beta, const Field& r, Field& p, const Part& part) {
    for (std::size_t b = 0; b < p.blocks().size(); ++b)
        launch(*context_, kernel("conjugate_gradients", "lcl_cg_direction", p, b), size(part), part.first_block, blocks_,
               row_value(is_double(*context_, p.real()), p.blocks()[b], beta), r.buffer(b), p.buffer(b));
}

}  // namespace lcl
