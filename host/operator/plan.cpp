// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "host/operator/ordering.h"
#include "host/parallel.h"

namespace lcl {
namespace {

constexpr int part_count = 5;  // fixed, curve, dart, smooth, ghost: RowKind's order

/// Rows with equal codes stand together inside a block.
std::int64_t shape_code(const RowClass& row) { return (static_cast<std::int64_t>(row.shape) << 32) + row.edges; }

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
        order_rows();
        make_runs();
        fill_rings();
        fill_weighted();
        fill_scaling();
        measure_reach();
        return std::move(plan_);
    }

private:
    void classify() {
        const Index n = topology_.vertex_count;
        plan_.vertex_count = n;
        classes_.resize(n);
        parallel_for(n, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) classes_[v] = rows_.classify(static_cast<Index>(v));
        });
        std::array<Index, part_count> counts{};
        for (const RowClass& row : classes_) ++counts[static_cast<int>(row.kind)];
        Index first = 0;
        for (int kind = 0; kind < part_count - 1; ++kind) {
            part(kind) = {first, counts[kind], 0, 0};
            first += counts[kind];
        }
        plan_.row_count = first;
    }

    Part& part(int kind) {
        Part* const parts[] = {&plan_.fixed, &plan_.curves, &plan_.darts, &plan_.smooth};
        return *parts[kind];
    }

    /// Breadth-first order inside each part, then equal shapes together inside each block of rows.
    void order_rows() {
        std::array<Index, part_count> place{plan_.fixed.first_row, plan_.curves.first_row, plan_.darts.first_row, plan_.smooth.first_row, plan_.row_count};
        plan_.vertex_of_row.resize(plan_.vertex_count);
        for (const Index v : breadth_first_order(topology_, mesh_.positions)) plan_.vertex_of_row[place[static_cast<int>(classes_[v].kind)]++] = v;
        const auto first = plan_.vertex_of_row.begin();
        const auto used = std::stable_partition(first, first + plan_.fixed.end_row(), [&](Index v) { return topology_.is_isolated(v); });
        plan_.isolated_count = static_cast<Index>(used - first);
        for (int kind = 0; kind < part_count - 1; ++kind) cut_into_blocks(part(kind));
        parallel_for(
            plan_.blocks.size(),
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t b = begin; b < end; ++b) {
                    const auto first = plan_.vertex_of_row.begin() + plan_.blocks[b].first_row;
                    std::stable_sort(first, first + plan_.blocks[b].row_count,
                                     [&](Index a, Index c) { return shape_code(classes_[a]) < shape_code(classes_[c]); });
                }
            },
            4);
        plan_.row_of_vertex.resize(plan_.vertex_count);
        for (Index row = 0; row < plan_.vertex_count; ++row) plan_.row_of_vertex[plan_.vertex_of_row[row]] = row;
    }

    void cut_into_blocks(Part& part) {
        part.first_block = static_cast<Index>(plan_.blocks.size());
        for (Index row = part.first_row; row < part.end_row(); row += plan_options_.block_rows)
            plan_.blocks.push_back({0, 0, row, std::min(plan_options_.block_rows, part.end_row() - row)});
        part.block_count = static_cast<Index>(plan_.blocks.size()) - part.first_block;
    }

    void make_runs() {
        std::uint64_t ring_entries = 0;
        std::uint32_t weighted = 0;
        for (Block& block : plan_.blocks) {
            block.first_run = static_cast<Index>(plan_.runs.size());
            for (Index row = block.first_row; row < block.first_row + block.row_count; ++row) {
                const RowClass& kind = classes_[plan_.vertex_of_row[row]];
                if (row == block.first_row || shape_code(kind) != shape_code(classes_[plan_.vertex_of_row[row - 1]]))
                    start_run(row, kind, ring_entries, weighted);
                Run& run = plan_.runs.back();
                ++run.count;
                ring_entries += run.stride();
                weighted += run.shape == RowShape::weighted;
            }
            block.run_count = static_cast<Index>(plan_.runs.size()) - block.first_run;
        }
        if (ring_entries > std::numeric_limits<std::uint32_t>::max())
            throw OutOfMemory("the limit stencils of this mesh have " + std::to_string(ring_entries) +
                              " neighbours, 4294967295 are the most: split the mesh into parts");
        plan_.indices.resize(ring_entries);
    }

    void start_run(Index row, const RowClass& kind, std::uint64_t ring_entries, std::uint32_t weighted) {
        Run run;
        run.first = row;
        run.shape = kind.shape;
        run.edges = kind.edges;
        run.index_offset = kind.shape == RowShape::weighted ? weighted : static_cast<std::uint32_t>(ring_entries);
        if (kind.shape != RowShape::weighted) run.weights = rows_.ring_weights(kind);
        plan_.runs.push_back(run);
    }

    void fill_rings() {
        parallel_for(
            plan_.blocks.size(),
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t b = begin; b < end; ++b)
                    for (Index r = plan_.blocks[b].first_run; r < plan_.blocks[b].first_run + plan_.blocks[b].run_count; ++r) fill_run(plan_.runs[r]);
            },
            4);
    }

    void fill_run(const Run& run) {
        const int stride = run.stride();
        if (stride == 0) return;
        Index* out = plan_.indices.data() + run.index_offset;
        for (Index row = run.first; row < run.first + run.count; ++row, out += stride) {
            const Index v = plan_.vertex_of_row[row];
            rows_.ring_neighbours(v, classes_[v], out);
            for (int i = 0; i < stride; ++i) out[i] = plan_.row_of_vertex[out[i]];
        }
    }

    void fill_weighted() {
        plan_.diagonal.resize(plan_.row_count);
        for (const Run& run : plan_.runs) {
            if (run.shape != RowShape::weighted) {
                std::fill_n(plan_.diagonal.begin() + run.first, run.count, run.weights.vertex);
                continue;
            }
            for (Index row = run.first; row < run.first + run.count; ++row) add_weighted(row);
        }
    }

    void add_weighted(Index row) {
        const Index v = plan_.vertex_of_row[row];
        const LimitRow entries = rows_.row(v);
        for (std::size_t i = 0; i < entries.columns.size(); ++i) {
            plan_.weighted_indices.push_back(plan_.row_of_vertex[entries.columns[i]]);
            plan_.weighted_weights.push_back(entries.weights[i]);
            if (entries.columns[i] == v) plan_.diagonal[row] = entries.weights[i];
        }
        if (plan_.weighted_indices.size() > std::numeric_limits<std::uint32_t>::max())
            throw OutOfMemory("the weighted limit stencils of this mesh have more than 4294967295 entries: split the mesh into parts");
        plan_.weighted_offsets.push_back(static_cast<std::uint32_t>(plan_.weighted_indices.size()));
    }

    void fill_scaling() {
        plan_.scaling.assign(plan_.row_count, 0.0);
        double bound = 1;
        for (Index row = plan_.smooth.first_row; row < plan_.smooth.end_row(); ++row) {
            const Index v = plan_.vertex_of_row[row];
            const int n = topology_.vertex_face_count[v];
            const double lambda = options_.lambda_at(v);
            plan_.scaling[row] = symmetric_scaling(options_.scheme, n, lambda);
            plan_.has_valence_2 = plan_.has_valence_2 || n < 3;
            bound = std::min(bound, lambda_min_bound(options_, n, lambda));
        }
        plan_.lambda_min_bound = plan_.has_valence_2 && options_.scheme != Scheme::doo_sabin ? std::numeric_limits<double>::quiet_NaN() : std::max(0.0, bound);
    }

    /// How far each block's rows reach, in blocks: rows of a part's blocks are equally many but for the last.
    void measure_reach() {
        const Part& smooth = plan_.smooth;
        std::vector<Index> reaches(smooth.block_count, 0);
        parallel_for(
            smooth.block_count,
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t b = begin; b < end; ++b) reaches[b] = reach_of(plan_.blocks[smooth.first_block + b]);
            },
            4);
        for (const Index reach : reaches) plan_.reach = std::max(plan_.reach, reach);
    }

    Index reach_of(const Block& block) const {
        Index lowest = block.first_row, highest = block.first_row;
        const auto take = [&](const Index* columns, std::size_t count) {
            for (std::size_t i = 0; i < count; ++i) {
                if (columns[i] < plan_.smooth.first_row || columns[i] >= plan_.smooth.end_row()) continue;
                lowest = std::min(lowest, columns[i]);
                highest = std::max(highest, columns[i]);
            }
        };
        for (Index r = block.first_run; r < block.first_run + block.run_count; ++r) {
            const Run& run = plan_.runs[r];
            if (run.shape != RowShape::weighted) {
                take(plan_.indices.data() + run.index_offset, static_cast<std::size_t>(run.count) * run.stride());
                continue;
            }
            const std::uint32_t begin = plan_.weighted_offsets[run.index_offset];
            take(plan_.weighted_indices.data() + begin, plan_.weighted_offsets[run.index_offset + run.count] - begin);
        }
        const auto block_of = [&](Index row) { return (row - plan_.smooth.first_row) / plan_options_.block_rows; };
        return std::max(block_of(highest) - block_of(block.first_row), block_of(block.first_row) - block_of(lowest));
    }

    const PolygonMesh& mesh_;
    const Topology& topology_;
    const SchemeOptions& options_;
    const PlanOptions& plan_options_;
    LimitRows rows_;
    std::vector<RowClass> classes_;
    Plan plan_;
};

}  // namespace

Plan build_plan(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options, const PlanOptions& plan_options) {
    return PlanBuilder(mesh, topology, features, options, plan_options).build();
}

LimitRow plan_row(const Plan& plan, const Run& run, Index row) {
    LimitRow out;
    if (run.shape == RowShape::weighted) {
        const Index k = run.index_offset + (row - run.first);
        const std::uint32_t begin = plan.weighted_offsets[k], end = plan.weighted_offsets[k + 1];
        out.columns.assign(plan.weighted_indices.begin() + begin, plan.weighted_indices.begin() + end);
        out.weights.assign(plan.weighted_weights.begin() + begin, plan.weighted_weights.begin() + end);
        return out;
    }
    out.columns.push_back(row);
    out.weights.push_back(run.weights.vertex);
    const Index* neighbours = plan.indices.data() + run.index_offset + static_cast<std::size_t>(row - run.first) * run.stride();
    for (int i = 0; i < run.stride(); ++i) {
        out.columns.push_back(neighbours[i]);
        out.weights.push_back(i < run.edges ? run.weights.edge : run.weights.diagonal);
    }
    return out;
}

const Run& run_of_row(const Plan& plan, Index row) {
    const auto after = std::upper_bound(plan.runs.begin(), plan.runs.end(), row, [](Index r, const Run& run) { return r < run.first; });
    return *(after - 1);
}

}  // namespace lcl
