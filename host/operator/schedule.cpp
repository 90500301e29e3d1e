// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/schedule.h"

#include <algorithm>
#include <limits>

namespace lcl {
namespace {

/// The pattern of A and of its transpose together: rows that must not be updated at once. (Curve rows see fewer neighbours than see them.)
struct Graph {
    std::vector<std::size_t> offsets;
    std::vector<Index> neighbours;
};

template <class Body>
void for_each_entry(const Plan& plan, const Body& body) {
    for (const Run& run : plan.runs)
        for (Index row = run.first; row < run.first + run.count; ++row) {
            if (run.shape == RowShape::weighted) {
                const Index k = run.index_offset + (row - run.first);
                for (std::uint32_t e = plan.weighted_offsets[k]; e < plan.weighted_offsets[k + 1]; ++e) body(row, plan.weighted_indices[e]);
                continue;
            }
            const int stride = run.stride();
            const Index* neighbours = plan.indices.data() + run.index_offset + static_cast<std::size_t>(row - run.first) * stride;
            for (int i = 0; i < stride; ++i) body(row, neighbours[i]);
        }
}

Graph symmetric_graph(const Plan& plan) {
    Graph graph;
    graph.offsets.assign(plan.row_count + 1, 0);
    const auto between_rows = [&](Index a, Index b) { return a != b && b < plan.row_count; };
    for_each_entry(plan, [&](Index a, Index b) {
        if (between_rows(a, b)) ++graph.offsets[a + 1], ++graph.offsets[b + 1];
    });
    for (Index row = 0; row < plan.row_count; ++row) graph.offsets[row + 1] += graph.offsets[row];
    graph.neighbours.resize(graph.offsets.back());
    std::vector<std::size_t> place(graph.offsets.begin(), graph.offsets.end() - 1);
    for_each_entry(plan, [&](Index a, Index b) {
        if (between_rows(a, b)) graph.neighbours[place[a]++] = b, graph.neighbours[place[b]++] = a;
    });
    return graph;
}

/// Sorts rows by their step (stable in the order of `order`) and copies their entries.
Schedule from_steps(const Plan& plan, const std::vector<Index>& order, const std::vector<Index>& step_of_row) {
    Schedule schedule;
    const Index steps = order.empty() ? 0 : 1 + *std::max_element(step_of_row.begin(), step_of_row.end());
    schedule.step_offsets.assign(steps + 1, 0);
    for (const Index row : order) ++schedule.step_offsets[step_of_row[row] + 1];
    for (Index s = 0; s < steps; ++s) schedule.step_offsets[s + 1] += schedule.step_offsets[s];
    std::vector<Index> place(schedule.step_offsets.begin(), schedule.step_offsets.end() - 1);
    schedule.rows.resize(order.size());
    for (const Index row : order) schedule.rows[place[step_of_row[row]]++] = row;
    for (const Index row : schedule.rows) {
        const LimitRow entries = plan_row(plan, run_of_row(plan, row), row);
        schedule.columns.insert(schedule.columns.end(), entries.columns.begin(), entries.columns.end());
        schedule.weights.insert(schedule.weights.end(), entries.weights.begin(), entries.weights.end());
        if (schedule.columns.size() > std::numeric_limits<std::uint32_t>::max())
            throw OutOfMemory("the rows of a Gauss-Seidel schedule have more than 4294967295 entries: use another solver, or split the mesh into parts");
        schedule.offsets.push_back(static_cast<std::uint32_t>(schedule.columns.size()));
        schedule.inverse_diagonal.push_back(1 / plan.diagonal[row]);
    }
    return schedule;
}

/// Rows in the caller's vertex order.
std::vector<Index> rows_in_natural_order(const Plan& plan) {
    std::vector<Index> order;
    order.reserve(plan.row_count);
    for (Index v = 0; v < plan.vertex_count; ++v)
        if (plan.row_of_vertex[v] < plan.row_count) order.push_back(plan.row_of_vertex[v]);
    return order;
}

}  // namespace

Schedule natural_schedule(const Plan& plan) {
    const Graph graph = symmetric_graph(plan);
    const std::vector<Index> order = rows_in_natural_order(plan);
    std::vector<Index> level(plan.row_count, 0);
    for (const Index row : order)
        for (std::size_t e = graph.offsets[row]; e < graph.offsets[row + 1]; ++e) {
            const Index neighbour = graph.neighbours[e];
            if (plan.vertex_of_row[neighbour] < plan.vertex_of_row[row]) level[row] = std::max(level[row], level[neighbour] + 1);
        }
    return from_steps(plan, order, level);
}

Schedule coloured_schedule(const Plan& plan) {
    const Graph graph = symmetric_graph(plan);
    std::vector<Index> order(plan.row_count), colour(plan.row_count, -1), taken_by;
    for (Index row = 0; row < plan.row_count; ++row) {
        order[row] = row;
        for (std::size_t e = graph.offsets[row]; e < graph.offsets[row + 1]; ++e) {
            const Index c = colour[graph.neighbours[e]];
            if (c >= 0) taken_by[c] = row;
        }
        Index free = 0;
        while (free < static_cast<Index>(taken_by.size()) && taken_by[free] == row) ++free;
        if (free == static_cast<Index>(taken_by.size())) taken_by.push_back(-1);
        colour[row] = free;
    }
    return from_steps(plan, order, colour);
}

}  // namespace lcl
