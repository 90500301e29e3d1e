// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/device_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "host/apply/real_values.h"
#include "host/evaluate/kind_table.h"
#include "host/parallel.h"
#include "kernels/evaluate.cl.h"

namespace lcl {
namespace {

constexpr int rings_expanded = 3;            // of four samples in an irregular patch 63 of 64 lie in one of these
constexpr std::size_t samples_per_cell = 4;  // making a cell costs about as much as evaluating so many samples by the modes
constexpr std::size_t largest_group = 64;
constexpr double device_share = 0.25;  // of the device's memory, for expanded cells

/// A block of values: what of LCL_WANT it belongs to, its components, the caller's array, and how often a length is a factor of it.
struct ValueBlock {
    unsigned want;
    int components;
    void* SurfaceValues::*to;
    int lengths;
};
constexpr ValueBlock value_blocks[] = {
    {LCL_WANT_POINTS, 3, &SurfaceValues::points, 1},   {LCL_WANT_FIRST, 3, &SurfaceValues::du, 1},          {LCL_WANT_FIRST, 3, &SurfaceValues::dv, 1},
    {LCL_WANT_NORMALS, 3, &SurfaceValues::normals, 0}, {LCL_WANT_SECOND, 3, &SurfaceValues::duu, 1},        {LCL_WANT_SECOND, 3, &SurfaceValues::duv, 1},
    {LCL_WANT_SECOND, 3, &SurfaceValues::dvv, 1},      {LCL_WANT_CURVATURES, 1, &SurfaceValues::gauss, -2}, {LCL_WANT_CURVATURES, 1, &SurfaceValues::mean, -1}};

unsigned wanted(const SurfaceValues& values) {
    unsigned want = 0;
    for (const ValueBlock& block : value_blocks)
        if (values.*block.to != nullptr) want |= block.want;
    return want;
}

std::size_t values_a_sample(unsigned want) {
    std::size_t count = 0;
    for (const ValueBlock& block : value_blocks)
        if (want & block.want) count += static_cast<std::size_t>(block.components);
    return count;
}

}  // namespace

DeviceSurface::DeviceSurface(std::shared_ptr<Context> context, PatchTable table, Real real, double dense_operations)
    : context_(std::move(context)), table_(std::move(table)), real_(real), dense_operations_(dense_operations) {
    if (real == Real::full && !context_->device().has_double)
        throw Unsupported("double precision was asked for, and " + context_->device().name + " has none: use single precision");
    upload_kinds(number_patches());
    upload_turns();
}

/// Control points of the patches of every kind, patch after patch.
std::vector<std::vector<Index>> DeviceSurface::number_patches() {
    kinds_.resize(table_.kinds.size());
    place_of_patch_.resize(static_cast<std::size_t>(table_.patch_count()));
    std::vector<std::vector<Index>> controls(kinds_.size());
    for (Index p = 0; p < table_.patch_count(); ++p) {
        const std::int32_t q = table_.kind[p];
        place_of_patch_[p] = static_cast<cl_uint>(q < 0 ? table_.patch_begin[p] : kinds_[q].patch_count++);
        if (q >= 0) controls[q].insert(controls[q].end(), table_.control.begin() + table_.patch_begin[p], table_.control.begin() + table_.patch_begin[p + 1]);
    }
    return controls;
}

Buffer DeviceSurface::reals(const std::vector<double>& values, const char* what) const {
    const std::vector<unsigned char> bytes = real_bytes(*context_, real_, values);
    return Buffer(context_, bytes.size(), what, bytes.data());
}

void DeviceSurface::upload_kinds(const std::vector<std::vector<Index>>& controls) {
    std::vector<lcl_kind> numbers;
    for (std::size_t q = 0; q < kinds_.size(); ++q) {
        Kind& kind = kinds_[q];
        const KindTable table = make_kind_table(table_.kinds[q]);
        kind.mode_count = static_cast<std::size_t>(table.mode_count);
        kind.point_count = static_cast<std::size_t>(table.point_count);
        kind.which = static_cast<cl_int>(q);
        kind.first_coefficient = coefficient_count_;
        numbers.push_back({table.mode_count, table.depths, table.cell_stride, table.weight_stride, static_cast<cl_uint>(coefficient_count_),
                           static_cast<cl_uint>(kind.patch_count)});
        coefficient_count_ += kind.mode_count * static_cast<std::size_t>(kind.patch_count);
        if (coefficient_count_ > std::numeric_limits<cl_uint>::max())
            throw OutOfMemory("the surface has more coefficients than can be numbered: use a smaller mesh");
        kind.control = Buffer(context_, controls[q].size() * sizeof(Index), "control points of irregular patches", controls[q].data());
        kind.projection = reals(table.projection, "projections");
        kind.weights = reals(table.weights, "weights of modes");
        kind.cells = reals(table.cells, "cells of modes");
    }
    kind_numbers_ = Buffer(context_, numbers.size() * sizeof(lcl_kind), "kinds of patches", numbers.data());
    const std::size_t row_bytes = 4 * (real_ == Real::full ? sizeof(double) : sizeof(float));
    coefficients_ = Buffer(context_, coefficient_count_ * row_bytes, "coefficients of irregular patches");
    control_ = Buffer(context_, table_.control.size() * sizeof(Index), "numbers of control points", table_.control.data());
    points_ = Buffer(context_, static_cast<std::size_t>(table_.control_count()) * row_bytes, "control points of patches");
}

/// The table's turns, then each of them for cells of depth 0, 1, .., whose parameters run 2, 4, .. times as fast, then those whose parameters run backwards.
void DeviceSurface::upload_turns() {
    std::vector<double> turns;
    const auto add = [&](double factor) {
        for (const ParameterTurn& turn : table_.turns)
            for (const double value : {turn.su, turn.tu, turn.sv, turn.tv}) turns.push_back(factor * value);
    };
    add(1);
    for (const int sign : {1, -1})
        for (int m = 0; m < rings_expanded; ++m) add(std::ldexp(sign, m + 1));
    turns_ = reals(turns, "turns of patches");
}

void DeviceSurface::set_points(const double* points, std::size_t stride) {
    std::vector<double> packed(3 * static_cast<std::size_t>(table_.point_count));
    for (std::size_t v = 0; v < static_cast<std::size_t>(table_.point_count); ++v) {
        for (std::size_t c = 0; c < 3; ++c) {
            packed[3 * v + c] = points[v * stride + c];
            if (!std::isfinite(packed[3 * v + c])) throw BadInput("point " + std::to_string(v) + " is not finite: correct it", {{static_cast<Index>(v)}, {}});
        }
    }
    control_points_ = control_points(table_, packed, 3);
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (const Index number : table_.control)  // isolated vertices may be anywhere
        for (std::size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], control_points_[3 * static_cast<std::size_t>(number) + c]);
            high[c] = std::max(high[c], control_points_[3 * static_cast<std::size_t>(number) + c]);
        }
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        centre_[c] = low[c] / 2 + high[c] / 2;
        square += (high[c] - low[c]) * (high[c] - low[c]);
    }
    scale_ = square > 0 && std::isfinite(square) ? std::sqrt(square) : 1;
    parallel_for(control_points_.size() / 3, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = 3 * begin; i < 3 * end; ++i) control_points_[i] = (control_points_[i] - centre_[i % 3]) / scale_;
    });
    upload_points();
    project();
    if (has_expanded_) expand();
}

void DeviceSurface::upload_points() {
    const std::size_t count = control_points_.size() / 3;
    const bool as_double = real_ == Real::full;
    Mapping mapping = context_->map(points_, 0, count * 4 * (as_double ? sizeof(double) : sizeof(float)), true, context_->marker(), "uploading control points");
    const auto put = [&](auto* rows) {
        using Number = std::remove_reference_t<decltype(*rows)>;
        parallel_for_each(count, [&](std::size_t i) {
            for (std::size_t c = 0; c < 3; ++c) rows[4 * i + c] = static_cast<Number>(control_points_[3 * i + c]);
            rows[4 * i + 3] = 0;
        });
    };
    if (as_double) put(static_cast<double*>(mapping.data()));
    else put(static_cast<float*>(mapping.data()));
    mapping.unmap("uploading control points");
}

cl_kernel DeviceSurface::kernel(const char* name, unsigned want) const {
    return context_->kernel("evaluate", name,
                            kernel_options(*context_, real_, 4, 1) + " -D LCL_POINTS=" + std::to_string(regular_point_count(table_.scheme)) +
                                " -D LCL_WANT=" + std::to_string(want == 0 ? LCL_WANT_POINTS : want));
}

LaunchSize DeviceSurface::lanes(std::size_t count, std::size_t second) const {
    const std::size_t local = std::min(largest_group, context_->device().max_work_group_size);
    return {(count + local - 1) / local * local, local, second};
}

/// c = projection C for all patches of every kind.
void DeviceSurface::project() {
    const std::size_t number_bytes = real_ == Real::full ? sizeof(double) : sizeof(float);
    for (Kind& kind : kinds_) {
        const std::size_t M = kind.mode_count, K = kind.point_count, count = static_cast<std::size_t>(kind.patch_count);
        const cl_int points = static_cast<cl_int>(K);
        if (has_dense_product(M, K, 4 * count, dense_operations_) && K * count * 4 * number_bytes <= context_->device().max_allocation_bytes) {
            const Buffer gathered(context_, K * count * 4 * number_bytes, "control points of irregular patches");
            launch(*context_, kernel("lcl_gather"), lanes(count, K), kind.patch_count, points, kind.control, points_, gathered);
            dense_product(*context_, real_ == Real::full, M, K, 4 * count, kind.projection, gathered, coefficients_, 4 * kind.first_coefficient);
            context_->finish();  // `gathered` is in use
        } else {
            launch(*context_, kernel("lcl_project"), lanes(count, (M + 3) / 4), kind.patch_count, points, kind_numbers_, kind.which, kind.projection,
                   kind.control, points_, coefficients_);
        }
    }
}

std::size_t DeviceSurface::expanded_cells() const {
    std::size_t cells = 0;
    for (const Kind& kind : kinds_) cells += static_cast<std::size_t>(3 * rings_expanded) * static_cast<std::size_t>(kind.patch_count);
    return cells;
}

void DeviceSurface::prepare_for(std::size_t sample_count) {
    const std::size_t cells = expanded_cells(), points = static_cast<std::size_t>(regular_point_count(table_.scheme));
    if (has_expanded_ || cells == 0 || sample_count < samples_per_cell * cells) return;
    const std::size_t row_bytes = 4 * (real_ == Real::full ? sizeof(double) : sizeof(float));
    const std::size_t bytes = (static_cast<std::size_t>(table_.control_count()) + cells * points) * row_bytes;
    if (static_cast<double>(bytes) > device_share * static_cast<double>(context_->device().memory_bytes) || bytes > context_->device().max_allocation_bytes ||
        bytes / row_bytes > std::numeric_limits<cl_uint>::max())
        return;
    std::size_t next = static_cast<std::size_t>(table_.control_count());
    for (Kind& kind : kinds_) {
        kind.expanded_point = next;
        next += static_cast<std::size_t>(3 * rings_expanded) * static_cast<std::size_t>(kind.patch_count) * points;
    }
    Buffer larger;
    try {
        larger = Buffer(context_, bytes, "control points of patches");
    } catch (const OutOfMemory&) {  // it goes without
        return;
    }
    context_->finish();  // the buffer that is replaced is no longer in use
    points_ = std::move(larger);
    if (!control_points_.empty()) {
        upload_points();
        expand();
    }
    has_expanded_ = true;
}

void DeviceSurface::expand() {
    for (Kind& kind : kinds_)
        launch(*context_, kernel("lcl_expand_cells"), lanes(static_cast<std::size_t>(3 * rings_expanded) * static_cast<std::size_t>(kind.patch_count)),
               kind.patch_count, static_cast<cl_int>(rings_expanded), static_cast<cl_uint>(kind.expanded_point), kind_numbers_, kind.which, kind.weights,
               kind.cells, coefficients_, points_);
}

/// Sorts places that are found into groups, by counting, in the memory of the device's buffers.
template <class Number>
struct DeviceSurface::Sorter {
    DeviceSurface& surface;
    const std::size_t points = static_cast<std::size_t>(regular_point_count(surface.table_.scheme));
    const bool is_triangle = surface.table_.scheme == Scheme::loop;
    const cl_uint turn_count = static_cast<cl_uint>(surface.table_.turns.size());

    struct Entry {
        std::size_t group;
        cl_uint place, turn;
        double s, t;
    };

    /// A place in the first rings of an irregular patch lies in a cell that is a regular patch now.
    Entry entry(const PatchPlace& found) const {
        const std::int32_t q = surface.table_.kind[found.patch];
        Entry entry{static_cast<std::size_t>(q - cells_group), surface.place_of_patch_[found.patch], static_cast<cl_uint>(found.turn), found.s, found.t};
        if (q < 0 || !surface.has_expanded_) return entry;
        const double size = is_triangle ? found.s + found.t : std::max(found.s, found.t);
        int m = 0;
        double scale = 2;
        for (; m < rings_expanded && scale * size < 1; ++m) scale *= 2;
        if (m == rings_expanded) return entry;
        double s = scale * found.s, t = scale * found.t;
        std::size_t k = 0;
        cl_uint turn = static_cast<cl_uint>(m) + 1;
        if (s >= 1) {
            k = !is_triangle && t >= 1 ? 1 : 0;
            s -= 1;
            t -= static_cast<double>(k);
        } else if (t >= 1) {
            k = 2;
            t -= 1;
        } else {
            k = 1;
            s = 1 - s, t = 1 - t;
            turn += static_cast<cl_uint>(rings_expanded);
        }
        const std::size_t cell = 3 * (static_cast<std::size_t>(entry.place) * static_cast<std::size_t>(rings_expanded) + static_cast<std::size_t>(m)) + k;
        return {0, static_cast<cl_uint>(surface.kinds_[q].expanded_point + cell * points), entry.turn + turn * turn_count, s, t};
    }
};

template <class Number>
void DeviceSurface::fill(const Places& places, SamplePiece& piece) {
    constexpr std::size_t smallest = 4096;
    const Sorter<Number> sorter{*this};
    const std::size_t pieces = piece_count(piece.count, smallest), groups = kinds_.size() + 2;
    std::vector<std::size_t> next(pieces * groups, 0);  // first how many, then where the next one goes
    found_.resize(piece.count);
    for_each_piece(piece.count, pieces, [&](std::size_t part, std::size_t begin, std::size_t end) {
        locate(table_, places, piece.first + begin, piece.first + end, &found_[begin]);
        for (std::size_t i = begin; i < end; ++i) ++next[part * groups + sorter.entry(found_[i]).group];
    });
    std::size_t sum = 0;
    piece.groups.clear();
    for (std::size_t group = 0; group < groups; ++group) {
        const std::size_t begin = sum;
        for (std::size_t part = 0; part < pieces; ++part) sum += std::exchange(next[part * groups + group], sum);
        if (sum > begin) piece.groups.push_back({static_cast<std::int32_t>(group) + cells_group, static_cast<cl_int>(begin), static_cast<cl_int>(sum - begin)});
    }
    const char* const doing = "uploading samples";
    Mapping parameters = context_->map(piece.parameters, 0, 2 * piece.count * sizeof(Number), true, context_->marker(), doing),
            numbers = context_->map(piece.places, 0, piece.count * sizeof(cl_uint), true, {}, doing),
            packed = context_->map(piece.packed, 0, piece.count * sizeof(cl_uint), true, {}, doing);
    for_each_piece(piece.count, pieces, [&](std::size_t part, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto entry = sorter.entry(found_[i]);
            const std::size_t to = next[part * groups + entry.group]++;
            static_cast<Number*>(parameters.data())[2 * to] = static_cast<Number>(entry.s);
            static_cast<Number*>(parameters.data())[2 * to + 1] = static_cast<Number>(entry.t);
            static_cast<cl_uint*>(numbers.data())[to] = entry.place;
            static_cast<cl_uint*>(packed.data())[to] = static_cast<cl_uint>(i) | entry.turn << 24;
        }
    });
    parameters.unmap(doing);
    numbers.unmap(doing);
    packed.unmap(doing);
}

void DeviceSurface::make_samples(const Places& places, std::size_t first, std::size_t count, SamplePiece& piece) {
    const std::size_t parameter_bytes = 2 * count * (real_ == Real::full ? sizeof(double) : sizeof(float));
    if (!piece.parameters || piece.parameters.bytes() < parameter_bytes) {
        piece.parameters = Buffer(context_, parameter_bytes, "samples");
        piece.places = Buffer(context_, count * sizeof(cl_uint), "samples");
        piece.packed = Buffer(context_, count * sizeof(cl_uint), "samples");
    }
    piece.first = first;
    piece.count = count;
    if (real_ == Real::full) fill<double>(places, piece);
    else fill<float>(places, piece);
}

SamplePiece DeviceSurface::make_samples(const Places& places, std::size_t first, std::size_t count) {
    SamplePiece piece;
    make_samples(places, first, count, piece);
    return piece;
}

void DeviceSurface::launch_groups(const SamplePiece& piece, unsigned want) {
    const cl_int capacity = static_cast<cl_int>(piece.count);
    for (const SampleGroup& group : piece.groups) {
        const LaunchSize size = lanes(static_cast<std::size_t>(group.count));
        if (group.kind == cells_group) {
            launch(*context_, kernel("lcl_evaluate_cells", want), size, group.begin, group.count, capacity, piece.parameters, piece.places, piece.packed,
                   turns_, points_, out_);
        } else if (group.kind == regular_group) {
            launch(*context_, kernel("lcl_evaluate_regular", want), size, group.begin, group.count, capacity, piece.parameters, piece.places, piece.packed,
                   turns_, control_, points_, out_);
        } else {
            const Kind& kind = kinds_[group.kind];
            const auto launch_with = [&](auto unit) {  // what read() makes a length of 1
                launch(*context_, kernel("lcl_evaluate_irregular", want), size, group.begin, group.count, capacity, unit, kind_numbers_, kind.which,
                       piece.parameters, piece.places, piece.packed, turns_, kind.weights, kind.cells, coefficients_, out_);
            };
            if (real_ == Real::full) launch_with(cl_double{1 / scale_});
            else launch_with(static_cast<cl_float>(1 / scale_));
        }
    }
}

void DeviceSurface::evaluate(const SamplePiece& piece, const SurfaceValues& values) {
    const unsigned want = wanted(values);
    if (want == 0 || piece.count == 0) return;
    const std::size_t bytes = piece.count * values_a_sample(want) * (real_ == Real::full ? sizeof(double) : sizeof(float));
    if (!out_ || out_.bytes() < bytes) out_ = Buffer(context_, bytes, "values at samples");
    launch_groups(piece, want);
    if (real_ == Real::full) read<double>(piece, want, values);
    else read<float>(piece, want, values);
}

template <class Number>
void DeviceSurface::read(const SamplePiece& piece, unsigned want, const SurfaceValues& values) {
    Mapping mapping = context_->map(out_, 0, piece.count * values_a_sample(want) * sizeof(Number), false, context_->marker(), "reading values at samples");
    const auto* from = static_cast<const Number*>(mapping.data());
    for (const ValueBlock& block : value_blocks) {
        if (!(want & block.want)) continue;
        const std::size_t components = static_cast<std::size_t>(block.components);
        const double factor = std::pow(scale_, block.lengths);
        const bool is_point = block.to == &SurfaceValues::points;
        const auto take = [&](auto* to) {
            using To = std::remove_reference_t<decltype(*to)>;
            to += piece.first * components;
            parallel_for(piece.count, [&](std::size_t begin, std::size_t end) {
                if (is_point) {
                    for (std::size_t i = begin; i < end; ++i)
                        for (std::size_t c = 0; c < 3; ++c) to[3 * i + c] = static_cast<To>(centre_[c] + factor * static_cast<double>(from[3 * i + c]));
                } else {
                    for (std::size_t i = components * begin; i < components * end; ++i) to[i] = static_cast<To>(factor * static_cast<double>(from[i]));
                }
            });
        };
        if (values.*block.to != nullptr) {
            if (values.is_float) take(static_cast<float*>(values.*block.to));
            else take(static_cast<double*>(values.*block.to));
        }
        from += components * piece.count;
    }
    mapping.unmap("reading values at samples");
}

}  // namespace lcl
