// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "host/mesh/face_walk.h"
#include "host/operator/ordering.h"
#include "host/operator/plan_parts.h"
#include "host/parallel.h"
#include "host/prefetch.h"

namespace lcl {
namespace {

/// Rows with equal codes stand together inside a block.
std::uint32_t shape_code(const RowClass& row) { return static_cast<std::uint32_t>(row.shape) << 30 | static_cast<std::uint32_t>(row.edges); }
RowShape shape_of(std::uint32_t code) { return static_cast<RowShape>(code >> 30); }
int edges_of(std::uint32_t code) { return static_cast<int>(code & ((1u << 30) - 1)); }

/// Sorts the rows of one block by their codes, stably. Codes of few edges are counted; the others, of poles, are rare.
class BlockSort {
public:
    struct Group {
        std::uint32_t code;
        Index count;
    };

    /// vertices: the block's rows, reordered. Returns the codes that occur, ascending.
    std::vector<Group> sort(Index* vertices, Index count, const Array<std::uint32_t>& codes) {
        std::array<Index, 4 * counted_edges> place{};
        for (Index i = 0; i < count; ++i) ++place[bucket(codes[vertices[i]])];
        std::vector<Group> groups;
        Index first = 0;
        for (std::size_t b = 0; b < place.size(); ++b) {
            if (place[b] > 0) groups.push_back({code_of(b), place[b]});
            first += std::exchange(place[b], first);
        }
        sorted_.assign(vertices, vertices + count);
        for (const Index v : sorted_) vertices[place[bucket(codes[v])]++] = v;
        return split_poles(groups, vertices, codes);
    }

private:
    static constexpr std::uint32_t counted_edges = 64;  // so many and more share a bucket

    static std::size_t bucket(std::uint32_t code) { return (code >> 30) * counted_edges + std::min(code & ((1u << 30) - 1), counted_edges - 1); }
    static std::uint32_t code_of(std::size_t bucket) { return static_cast<std::uint32_t>(bucket / counted_edges << 30 | bucket % counted_edges); }

    static std::vector<Group> split_poles(const std::vector<Group>& groups, Index* vertices, const Array<std::uint32_t>& codes) {
        std::vector<Group> split;
        for (const Group& group : groups) {
            if (edges_of(group.code) + 1 < static_cast<int>(counted_edges)) {
                split.push_back(group);
            } else {
                std::stable_sort(vertices, vertices + group.count, [&](Index a, Index b) { return codes[a] < codes[b]; });
                for (Index i = 0; i < group.count; ++i) {
                    if (i == 0 || codes[vertices[i]] != codes[vertices[i - 1]]) split.push_back({codes[vertices[i]], 0});
                    ++split.back().count;
                }
            }
            vertices += group.count;
        }
        return split;
    }

    std::vector<Index> sorted_;
};

class PlanBuilder {
public:
    PlanBuilder(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options, const PlanOptions& plan_options)
        : mesh_(mesh),
          topology_(topology),
          options_(options),
          plan_options_(plan_options),
          rows_(topology, features, options, plan_options.subset, plan_options.owned) {}

    Plan build() {
        classify();
        order_rows(plan_, breadth_first_order(topology_, mesh_.positions), groups_, plan_options_.block_rows);
        sort_blocks();
        make_runs();
        with_face_walk(topology_, [&](const auto& walk) { fill_rings(walk); });
        fill_weighted();
        fill_run_values();
        measure_reach(plan_, plan_options_.block_rows);
        return std::move(plan_);
    }

private:
    void classify() {
        const std::size_t n = topology_.vertex_count;
        plan_.vertex_count = topology_.vertex_count;
        codes_.resize(n);
        groups_.resize(n);
        parallel_for(n, [&](std::size_t begin, std::size_t end) {
            for (Index v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
                const RowClass row = rows_.classify(v);
                codes_[v] = shape_code(row);
                groups_[v] = row_group(row.kind, topology_.is_isolated(v));
            }
        });
    }

    template <class Body>
    void for_each_block(const Body& body) {
        parallel_for(
            plan_.blocks.size(),
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t b = begin; b < end; ++b) body(b);
            },
            4);
    }

    /// Equal shapes together inside each block, and the inverse of the order.
    void sort_blocks() {
        block_groups_.resize(plan_.blocks.size());
        plan_.row_of_vertex.resize(plan_.vertex_count);
        parallel_for(
            plan_.blocks.size(),
            [&](std::size_t begin, std::size_t end) {
                BlockSort block_sort;
                for (std::size_t b = begin; b < end; ++b) {
                    const Block& block = plan_.blocks[b];
                    block_groups_[b] = block_sort.sort(plan_.vertex_of_row.data() + block.first_row, block.row_count, codes_);
                    for (Index row = block.first_row; row < block.first_row + block.row_count; ++row) plan_.row_of_vertex[plan_.vertex_of_row[row]] = row;
                }
            },
            4);
        for (Index row = plan_.row_count; row < plan_.vertex_count; ++row) plan_.row_of_vertex[plan_.vertex_of_row[row]] = row;
    }

    void make_runs() {
        std::uint64_t ring_entries = 0;
        std::uint32_t weighted = 0;
        for (std::size_t b = 0; b < plan_.blocks.size(); ++b) {
            Index row = plan_.blocks[b].first_row;
            plan_.blocks[b].first_run = static_cast<Index>(plan_.runs.size());
            plan_.blocks[b].run_count = static_cast<Index>(block_groups_[b].size());
            for (const BlockSort::Group& group : block_groups_[b]) {
                const Run& run = plan_.runs.emplace_back(make_run(row, group, ring_entries, weighted));
                row += run.count;
                ring_entries += static_cast<std::uint64_t>(run.count) * run.stride();
                ring_entries += ring_entries % 2;  // kernels load pairs
                if (run.shape == RowShape::weighted) weighted += run.count;
            }
        }
        if (ring_entries > std::numeric_limits<std::uint32_t>::max())
            throw OutOfMemory("the limit stencils of this mesh have " + std::to_string(ring_entries) +
                              " neighbours, 4294967295 are the most: split the mesh into parts");
        plan_.indices.resize(ring_entries);
    }

    RowKind kind_of_row(Index row) const {
        return row < plan_.fixed.end_row()    ? RowKind::fixed
               : row < plan_.curves.end_row() ? RowKind::curve
               : row < plan_.darts.end_row()  ? RowKind::dart
                                              : RowKind::smooth;
    }

    Run make_run(Index row, const BlockSort::Group& group, std::uint64_t ring_entries, std::uint32_t weighted) const {
        Run run;
        run.first = row;
        run.count = group.count;
        run.shape = shape_of(group.code);
        run.edges = edges_of(group.code);
        run.index_offset = run.shape == RowShape::weighted ? weighted : static_cast<std::uint32_t>(ring_entries);
        if (run.shape != RowShape::weighted) run.weights = rows_.ring_weights({kind_of_row(row), run.shape, run.edges});
        return run;
    }

    template <class Walk>
    void fill_rings(const Walk& walk) {
        for_each_block([&](std::size_t b) {
            for (Index r = plan_.blocks[b].first_run; r < plan_.blocks[b].first_run + plan_.blocks[b].run_count; ++r) fill_ring_run(walk, plan_.runs[r]);
        });
    }

    /// Starts to load what the rings of rows further on need: each array's place is known from the one before it.
    void prefetch_ring(const Run& run, Index row) const {
        const Index last = run.first + run.count - 1;
        const auto vertex_ahead = [&](Index rows) { return plan_.vertex_of_row[std::min(row + rows, last)]; };
        prefetch(&topology_.fan_offsets[vertex_ahead(24)]);
        prefetch(topology_.fan_half_edges.data() + topology_.fan_offsets[vertex_ahead(16)]);
        const Index v = vertex_ahead(8);
        for (Index i = topology_.fan_offsets[v]; i < topology_.fan_offsets[v + 1]; ++i) prefetch(&topology_.face_vertices[topology_.fan_half_edges[i]]);
    }

    template <class Walk>
    void fill_ring_run(const Walk& walk, const Run& run) {
        const int stride = run.stride();
        if (stride == 0) return;
        const RowClass kind{kind_of_row(run.first), run.shape, run.edges};
        Index* out = plan_.indices.data() + run.index_offset;
        for (Index row = run.first; row < run.first + run.count; ++row, out += stride) {
            prefetch_ring(run, row);
            rows_.ring_neighbours(walk, plan_.vertex_of_row[row], kind, out);
            for (int i = 0; i < stride; ++i) out[i] = plan_.row_of_vertex[out[i]];
        }
        if (stride % 2 != 0 && run.count % 2 != 0) *out = 0;  // the place that nobody reads
    }

    /// Entries of consecutive weighted rows.
    struct WeightedRows {
        std::vector<std::uint32_t> sizes;
        std::vector<Index> columns;
        std::vector<double> weights;
    };

    void fill_weighted() {
        plan_.diagonal.resize(plan_.row_count);
        const std::size_t blocks = plan_.blocks.size(), pieces = piece_count(blocks, 4);
        std::vector<WeightedRows> parts(pieces);
        for_each_piece(blocks, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
            LimitRows rows = rows_;
            LimitRow row;
            for (std::size_t b = begin; b < end; ++b)
                for (Index r = plan_.blocks[b].first_run; r < plan_.blocks[b].first_run + plan_.blocks[b].run_count; ++r)
                    if (plan_.runs[r].shape == RowShape::weighted) add_weighted_run(plan_.runs[r], rows, row, parts[piece]);
        });
        std::vector<std::size_t> first_row(pieces + 1, 0), first_entry(pieces + 1, 0);
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            first_row[piece + 1] = first_row[piece] + parts[piece].sizes.size();
            first_entry[piece + 1] = first_entry[piece] + parts[piece].columns.size();
        }
        if (first_entry[pieces] > std::numeric_limits<std::uint32_t>::max())
            throw OutOfMemory("the weighted limit stencils of this mesh have more than 4294967295 entries: split the mesh into parts");
        plan_.weighted_offsets.resize(first_row[pieces] + 1);
        plan_.weighted_indices.resize(first_entry[pieces]);
        plan_.weighted_weights.resize(first_entry[pieces]);
        for_each_piece(pieces, pieces, [&](std::size_t piece, std::size_t, std::size_t) {
            const WeightedRows& part = parts[piece];
            auto offset = static_cast<std::uint32_t>(first_entry[piece]);
            for (std::size_t i = 0; i < part.sizes.size(); ++i) plan_.weighted_offsets[first_row[piece] + i + 1] = offset += part.sizes[i];
            std::copy(part.columns.begin(), part.columns.end(), plan_.weighted_indices.begin() + first_entry[piece]);
            std::copy(part.weights.begin(), part.weights.end(), plan_.weighted_weights.begin() + first_entry[piece]);
        });
    }

    void add_weighted_run(const Run& run, LimitRows& rows, LimitRow& entries, WeightedRows& out) {
        for (Index row = run.first; row < run.first + run.count; ++row) {
            const Index v = plan_.vertex_of_row[row];
            rows.row(v, entries);
            out.sizes.push_back(static_cast<std::uint32_t>(entries.columns.size()));
            out.weights.insert(out.weights.end(), entries.weights.begin(), entries.weights.end());
            for (std::size_t i = 0; i < entries.columns.size(); ++i) {
                out.columns.push_back(plan_.row_of_vertex[entries.columns[i]]);
                if (entries.columns[i] == v) plan_.diagonal[row] = entries.weights[i];
            }
        }
    }

    /// Diagonal, scaling and the bound of the spectrum, which rows of a run share unless each has its own blend ratio.
    void fill_run_values() {
        plan_.scaling.resize(plan_.row_count);
        std::vector<double> bounds(plan_.blocks.size(), 1.0);
        for_each_block([&](std::size_t b) {
            for (Index r = plan_.blocks[b].first_run; r < plan_.blocks[b].first_run + plan_.blocks[b].run_count; ++r) {
                const Run& run = plan_.runs[r];
                if (run.shape != RowShape::weighted) std::fill_n(plan_.diagonal.begin() + run.first, run.count, run.weights.vertex);
                if (run.first >= plan_.smooth.first_row) bounds[b] = std::min(bounds[b], fill_scaling(run));
                else fill_scaling_by_faces(run);
            }
        });
        const bool is_smooth_run_of_two =
            std::any_of(plan_.runs.begin(), plan_.runs.end(), [&](const Run& run) { return run.first >= plan_.smooth.first_row && run.edges < 3; });
        plan_.has_valence_2 = is_smooth_run_of_two;
        const double bound = bounds.empty() ? 1 : *std::min_element(bounds.begin(), bounds.end());
        plan_.lambda_min_bound = plan_.has_valence_2 && options_.scheme != Scheme::doo_sabin ? std::numeric_limits<double>::quiet_NaN() : std::max(0.0, bound);
    }

    /// Of a smooth run; returns its bound of the spectrum.
    double fill_scaling(const Run& run) {
        const int n = run.edges;
        if (options_.lambda_per_vertex.empty()) {
            std::fill_n(plan_.scaling.begin() + run.first, run.count, symmetric_scaling(options_.scheme, n, options_.lambda));
            return lambda_min_bound(options_, n, options_.lambda);
        }
        double bound = 1;
        for (Index row = run.first; row < run.first + run.count; ++row) {
            const double lambda = options_.lambda_at(plan_.vertex_of_row[row]);
            plan_.scaling[row] = symmetric_scaling(options_.scheme, n, lambda);
            bound = std::min(bound, lambda_min_bound(options_, n, lambda));
        }
        return bound;
    }

    /// Of a run off the smooth part: the same formula with the number of faces at each vertex; 0 without faces, and where a blend ratio of 1 leaves no formula.
    void fill_scaling_by_faces(const Run& run) {
        Index last = 0;
        double scaling = 0;  // of `last` faces, without a blend
        for (Index row = run.first; row < run.first + run.count; ++row) {
            const Index v = plan_.vertex_of_row[row], faces = topology_.vertex_face_count[v];
            const double lambda = options_.lambda_at(v);
            if (faces == 0 || lambda == 1) continue;
            if (faces != last) scaling = symmetric_scaling(options_.scheme, faces, 0);
            last = faces;
            plan_.scaling[row] = scaling / (1 - lambda);
        }
    }

    const PolygonMesh& mesh_;
    const Topology& topology_;
    const SchemeOptions& options_;
    const PlanOptions& plan_options_;
    LimitRows rows_;
    Array<std::uint32_t> codes_;  // of each vertex
    Array<std::uint8_t> groups_;  // of each vertex
    std::vector<std::vector<BlockSort::Group>> block_groups_;
    Plan plan_;
};

}  // namespace

Plan build_plan(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options, const PlanOptions& plan_options) {
    return PlanBuilder(mesh, topology, features, options, plan_options).build();
}

LimitRow plan_row(const Plan& plan, const Run& run, Index row) {
    LimitRow out;
    for_each_entry(plan, run, row, [&](Index column, double weight) {
        out.columns.push_back(column);
        out.weights.push_back(weight);
    });
    return out;
}

const Run& run_of_row(const Plan& plan, Index row) {
    const auto after = std::upper_bound(plan.runs.begin(), plan.runs.end(), row, [](Index r, const Run& run) { return r < run.first; });
    return *(after - 1);
}

}  // namespace lcl
