// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/device_refiner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "host/apply/real_values.h"
#include "host/field/row_format.h"
#include "host/scheme/masks.h"

namespace lcl {
namespace {

constexpr std::size_t cpu_chunk = 1024, gpu_group = 64;

/// Work-items for so many rows, and the rows that each owns.
struct Split {
    LaunchSize size;
    cl_int chunk;
};

Split split(const Context& context, Index count) {
    const std::size_t rows = static_cast<std::size_t>(count);
    if (!context.device().is_gpu) return {{(rows + cpu_chunk - 1) / cpu_chunk, 1}, static_cast<cl_int>(cpu_chunk)};
    return {{(rows + gpu_group - 1) / gpu_group * gpu_group, gpu_group}, 1};
}

template <class Array>
Index largest_step(const Array& offsets) {
    Index largest = 0;
    for (std::size_t i = 1; i < offsets.size(); ++i) largest = std::max(largest, offsets[i] - offsets[i - 1]);
    return largest;
}

/// 3 a valence: of the vertex, its edge ends, its face points.
std::vector<double> valence_weights(const RefinerStep& step) {
    std::vector<double> weights;
    const Index most = largest_step(step.topology.fan_offsets);
    const double alpha = step.options.alpha;
    for (Index n = 0; n <= most; ++n) {
        if (n == 0) weights.insert(weights.end(), {1, 0, 0});
        else if (step.bulk == BulkRule::loop) weights.insert(weights.end(), {1 - n * loop_refined_edge_weight(n), loop_refined_edge_weight(n), 0});
        else weights.insert(weights.end(), {(n - 2 + alpha) / n, (1 - alpha) / n / n, 1.0 / n / n});
    }
    return weights;
}

std::vector<double> degree_weights(const Topology& topology) {
    const Index most = topology.uniform_degree > 0 ? topology.uniform_degree : largest_step(topology.face_offsets);
    std::vector<double> weights(static_cast<std::size_t>(most) + 1, 1);
    for (Index d = 1; d <= most; ++d) weights[d] = 1.0 / d;
    return weights;
}

/// Centre and size of the values of vertices that faces use.
Transform fit_values(const Topology& topology, const double* values, std::size_t stride, int channels) {
    const std::size_t count = static_cast<std::size_t>(channels);
    std::vector<double> low(count, std::numeric_limits<double>::infinity()), high(count, -std::numeric_limits<double>::infinity());
    for (Index v = 0; v < topology.vertex_count; ++v)
        for (int c = 0; c < channels; ++c) {
            const double value = values[v * stride + c];
            if (!std::isfinite(value))
                throw BadInput("channel " + std::to_string(c) + " of vertex " + std::to_string(v) + " is not finite: correct or leave out the value",
                               {{v}, {}});
            if (topology.is_isolated(v)) continue;
            low[c] = std::min(low[c], value);
            high[c] = std::max(high[c], value);
        }
    Transform transform{std::vector<double>(count, 0.0), std::vector<double>(count, 1.0)};
    double diagonal = 0;
    for (int c = 0; c < std::min(channels, 3); ++c) diagonal = std::hypot(diagonal, high[c] - low[c]);
    for (int c = 0; c < channels; ++c) {
        const double size = c < 3 ? diagonal : high[c] - low[c];
        if (!std::isfinite(size) || (size > 0 && !std::isfinite(1 / size)))
            throw BadInput("the values of channel " + std::to_string(c) + " go from " + std::to_string(low[c]) + " to " + std::to_string(high[c]) +
                           ", a size that double precision cannot scale: use other units");
        transform.centre[c] = low[c] + (high[c] - low[c]) / 2;
        if (size > 0) transform.scale[c] = 1 / size;
    }
    return transform;
}

}  // namespace

DeviceRefiner::DeviceRefiner(std::shared_ptr<Context> context, std::shared_ptr<const Refiner> refiner)
    : context_(std::move(context)), refiner_(std::move(refiner)) {
    for (const RefinerStep& step : refiner_->steps()) upload_step(step, steps_.emplace_back());
}

Buffer DeviceRefiner::upload(const void* data, std::size_t bytes, const char* what) {
    return Buffer(context_, std::max<std::size_t>(bytes, 1), what, bytes > 0 ? data : nullptr);
}

void DeviceRefiner::upload_step(const RefinerStep& from, Step& to) {
    const Topology& topology = from.topology;
    const auto upload_all = [&](const auto& values, const char* what) { return upload(values.data(), values.size() * sizeof values[0], what); };
    upload_rows(from.rows.sums, {}, to.sums);
    upload_rows(from.rows.rows, from.rows.targets, to.rows);
    if (from.bulk == BulkRule::none) return;
    const bool is_mixed = topology.uniform_degree != 3 && topology.uniform_degree != 4;
    const Array<Index> none;
    to.face_offsets = upload_all(is_mixed ? topology.face_offsets : none, "the faces of a mesh to refine");
    to.half_edge_face = upload_all(is_mixed ? topology.half_edge_face : none, "the faces of a mesh to refine");
    to.face_vertices = upload_all(topology.face_vertices, "the faces of a mesh to refine");
    to.twin = upload_all(topology.twin, "the half-edges of a mesh to refine");
    to.edge_half_edge = upload_all(topology.edge_half_edge, "the edges of a mesh to refine");
    to.fan_offsets = upload_all(topology.fan_offsets, "the vertices of a mesh to refine");
    to.fan_half_edges = upload_all(topology.fan_half_edges, "the vertices of a mesh to refine");
}

void DeviceRefiner::upload_rows(const Stencils& stencils, const std::vector<Index>& targets, Rows& to) {
    to.count = static_cast<Index>(stencils.offsets.size()) - 1;
    if (to.count == 0) return;
    if (stencils.offsets.back() > std::numeric_limits<cl_uint>::max())
        throw OutOfMemory("the rows of the refinement have " + std::to_string(stencils.offsets.back()) +
                          " entries, more than 2^32 - 1 that a device can number: refine a smaller mesh");
    const std::vector<cl_uint> offsets(stencils.offsets.begin(), stencils.offsets.end());
    std::vector<Index> rows = targets;
    if (rows.empty()) {
        rows.resize(to.count);
        std::iota(rows.begin(), rows.end(), 0);
    }
    to.targets = upload(rows.data(), rows.size() * sizeof rows[0], "rows of a refinement");
    to.offsets = upload(offsets.data(), offsets.size() * sizeof offsets[0], "rows of a refinement");
    to.indices = upload(stencils.indices.data(), stencils.indices.size() * sizeof stencils.indices[0], "rows of a refinement");
}

DeviceRefiner::Scratch& DeviceRefiner::scratch(int channels, Real real) {
    const auto [place, is_new] = scratch_.try_emplace({real, channels});
    Scratch& fields = place->second;
    if (!is_new) return fields;
    try {
        for (const RefinerStep& step : refiner_->steps()) {
            if (&step != &refiner_->steps().back()) fields.levels.emplace_back(context_, step.vertex_count, channels, real);
            fields.sums.emplace_back(context_, std::max<Index>(1, step.rows.sum_count()), channels, real);
        }
    } catch (...) {
        scratch_.erase(place);
        throw;
    }
    return fields;
}

const Buffer& DeviceRefiner::weights(std::map<Real, Buffer>& of, Real real, const std::function<std::vector<double>()>& values) {
    Buffer& buffer = of[real];
    if (!buffer) {
        const std::vector<unsigned char> bytes = real_bytes(*context_, real, values());
        buffer = upload(bytes.data(), bytes.size(), "weights of a refinement");
    }
    return buffer;
}

cl_kernel DeviceRefiner::kernel(const char* name, const Field& field, std::size_t block, Index degree) {
    return context_->kernel("refine", name,
                            kernel_options(*context_, field.real(), field.blocks()[block].width, 1) + " -D LCL_DEGREE=" + std::to_string(degree));
}

void DeviceRefiner::apply(const Field& values, Field& out) {
    if (steps_.empty()) return out.copy_from(values);
    Scratch& fields = scratch(values.channels(), values.real());
    for (std::size_t i = 0; i < steps_.size(); ++i)
        run_step(i, i == 0 ? values : fields.levels[i - 1], fields.sums[i], i + 1 == steps_.size() ? out : fields.levels[i]);
}

void DeviceRefiner::run_step(std::size_t index, const Field& in, Field& sums, Field& out) {
    const RefinerStep& from = refiner_->steps()[index];
    Step& step = steps_[index];
    for (std::size_t block = 0; block < in.blocks().size(); ++block) {
        if (from.bulk != BulkRule::none) run_bulk(from, step, in, out, block);
        run_rows(step.sums, from.rows.sums, from.topology.vertex_count, in, in, sums, block);
        run_rows(step.rows, from.rows.rows, from.topology.vertex_count, in, sums, out, block);
    }
}

void DeviceRefiner::run_bulk(const RefinerStep& from, Step& step, const Field& in, Field& out, std::size_t block) {
    const Topology& topology = from.topology;
    const Index degree = topology.uniform_degree == 3 || topology.uniform_degree == 4 ? topology.uniform_degree : 0;
    const cl_int first_edge = topology.vertex_count, first_face = topology.vertex_count + topology.edge_count;
    const Split faces = split(*context_, topology.face_count), edges = split(*context_, topology.edge_count),
                vertices = split(*context_, topology.vertex_count);
    const Buffer &x = in.buffer(block), &y = out.buffer(block);
    const bool is_loop = from.bulk == BulkRule::loop;
    const Buffer& of_valence = weights(step.valence_weights, in.real(), [&] { return valence_weights(from); });
    const Buffer& of_edge = weights(step.edge_weights, in.real(), [&] {
        return is_loop ? std::vector<double>{3.0 / 8, 1.0 / 8} : std::vector<double>{1.0 / 4};
    });
    if (is_loop) {
        launch(*context_, kernel("lcl_refine_loop_edges", in, block, 3), edges.size, topology.edge_count, edges.chunk, first_edge, step.face_offsets,
               step.half_edge_face, step.face_vertices, step.twin, step.edge_half_edge, of_edge, x, y);
        launch(*context_, kernel("lcl_refine_loop_vertices", in, block, 3), vertices.size, topology.vertex_count, vertices.chunk, step.face_offsets,
               step.half_edge_face, step.face_vertices, step.fan_offsets, step.fan_half_edges, of_valence, x, y);
        return;
    }
    const Buffer& of_degree = weights(step.degree_weights, in.real(), [&] { return degree_weights(topology); });
    launch(*context_, kernel("lcl_refine_faces", in, block, degree), faces.size, topology.face_count, faces.chunk, first_face, step.face_offsets,
           step.half_edge_face, step.face_vertices, of_degree, x, y);
    launch(*context_, kernel("lcl_refine_edges", in, block, degree), edges.size, topology.edge_count, edges.chunk, first_edge, first_face, step.face_offsets,
           step.half_edge_face, step.face_vertices, step.twin, step.edge_half_edge, of_edge, x, y);
    launch(*context_, kernel("lcl_refine_vertices", in, block, degree), vertices.size, topology.vertex_count, vertices.chunk, first_face, step.face_offsets,
           step.half_edge_face, step.face_vertices, step.fan_offsets, step.fan_half_edges, of_valence, x, y);
}

void DeviceRefiner::run_rows(Rows& rows, const Stencils& stencils, Index old_count, const Field& in, const Field& sums, Field& out, std::size_t block) {
    if (rows.count == 0) return;
    const Split own = split(*context_, rows.count);
    launch(*context_, kernel("lcl_refine_rows", in, block, 4), own.size, rows.count, own.chunk, old_count, rows.targets, rows.offsets, rows.indices,
           weights(rows.weights, in.real(), [&] { return stencils.weights; }), in.buffer(block), sums.buffer(block), out.buffer(block));
}

void DeviceRefiner::apply(const double* values, std::size_t stride, int channels, Real real, double* out, std::size_t out_stride) {
    const Index count = refiner_->control_count();
    const Topology& original = steps_.empty() ? refiner_->finest_faces() : refiner_->steps().front().topology;
    const Transform transform = fit_values(original, values, stride, channels);
    Field in(context_, count, channels, real), refined(context_, refiner_->vertex_count(), channels, real);
    in.write(0, count, [&](std::size_t b, std::size_t first, std::size_t rows, void* to) {
        const ChannelBlock& block = in.blocks()[b];
        pack_rows(in.format(), block, rows, to, [&](std::size_t i, int c) {
            const int channel = block.first + c;
            const double stored = (values[(first + i) * stride + channel] - transform.centre[channel]) * transform.scale[channel];
            return std::clamp(stored, -float_range, float_range);  // isolated vertices may be anywhere
        });
    });
    apply(in, refined);
    refined.read(0, refiner_->vertex_count(), [&](std::size_t b, std::size_t first, std::size_t rows, const void* from) {
        const ChannelBlock& block = refined.blocks()[b];
        unpack_rows(refined.format(), block, rows, from, [&](std::size_t i, int c, double value) {
            const int channel = block.first + c;
            out[(first + i) * out_stride + channel] = value / transform.scale[channel] + transform.centre[channel];
        });
    });
}

}  // namespace lcl
