// SPDX-License-Identifier: BSD-3-Clause
// The plan: the operator's rows in their fast order, as plain arrays.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "host/apply/host_operator.h"
#include "host/operator/ordering.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

constexpr double tolerance = 3e-14;  // as in operator_test

std::vector<Part> parts_of(const Plan& plan) { return {plan.fixed, plan.curves, plan.darts, plan.smooth}; }

void check_permutation(const Plan& plan) {
    REQUIRE(static_cast<Index>(plan.vertex_of_row.size()) == plan.vertex_count);
    REQUIRE(static_cast<Index>(plan.row_of_vertex.size()) == plan.vertex_count);
    bool inverse = true;
    for (Index row = 0; row < plan.vertex_count; ++row) inverse = inverse && plan.row_of_vertex.at(plan.vertex_of_row[row]) == row;
    CHECK(inverse);
}

/// Parts one after the other over all rows, blocks over each part, runs over each block.
void check_cover(const Plan& plan, Index block_rows) {
    Index row = 0, block = 0, run = 0;
    for (const Part& part : parts_of(plan)) {
        REQUIRE(part.first_row == row);
        REQUIRE(part.first_block == block);
        for (; block < part.end_block(); ++block) {
            const Block& b = plan.blocks.at(block);
            REQUIRE(b.first_row == row);
            REQUIRE(b.row_count > 0);
            REQUIRE(b.row_count <= block_rows);
            REQUIRE(b.first_run == run);
            for (; run < b.first_run + b.run_count; ++run) {
                REQUIRE(plan.runs.at(run).first == row);
                REQUIRE(plan.runs[run].count > 0);
                row += plan.runs[run].count;
            }
            REQUIRE(row == b.first_row + b.row_count);
        }
        REQUIRE(row == part.end_row());
    }
    CHECK(row == plan.row_count);
    CHECK(block == static_cast<Index>(plan.blocks.size()));
    CHECK(run == static_cast<Index>(plan.runs.size()));
    CHECK(plan.all_rows().row_count == plan.row_count);
    CHECK(plan.all_rows().block_count == block);
}

/// Inside a block every shape stands in one run; ring runs are of one valence, and their indices lie one after the other.
void check_runs(const Plan& plan) {
    std::size_t ring_entries = 0, weighted = 0;
    for (const Block& block : plan.blocks) {
        std::set<std::pair<RowShape, int>> shapes;
        for (Index r = block.first_run; r < block.first_run + block.run_count; ++r) {
            const Run& run = plan.runs[r];
            CHECK(shapes.insert({run.shape, run.edges}).second);
            CHECK(run.index_offset == (run.shape == RowShape::weighted ? weighted : ring_entries));
            ring_entries += static_cast<std::size_t>(run.count) * run.stride();
            if (run.shape == RowShape::weighted) weighted += run.count;
            else CHECK(run.weights.vertex + run.edges * (run.weights.edge + run.weights.diagonal) == Approx(1).margin(1e-14));
        }
    }
    CHECK(ring_entries == plan.indices.size());
    CHECK(weighted + 1 == plan.weighted_offsets.size());
    CHECK(plan.weighted_offsets.back() == plan.weighted_indices.size());
    CHECK(plan.weighted_weights.size() == plan.weighted_indices.size());
}

Index part_of(const Prepared& mesh, const SchemeOptions& scheme, Index v) {
    switch (mesh.features.kind[v]) {
        case VertexKind::smooth: return 3;
        case VertexKind::dart: return scheme.scheme == Scheme::doo_sabin ? 1 : 2;  // a Doo-Sabin crease is a cut: its curve turns back
        case VertexKind::curve: return 1;
        default: return 0;
    }
}

}  // namespace

TEST_CASE("a plan's rows equal brute-force subdivision on every shape, with every scheme", "[plan]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            INFO(shape.name << ", " << scheme.name);
            PlanOptions options;
            options.block_rows = 16;
            const Plan plan = mesh.plan(scheme.options, options);
            const Eigen::MatrixXd a = matrix_of(plan);
            CHECK(largest(a - oracle::limit_rows(shape.mesh, shape.features, scheme.options)) < tolerance);
            for (Index row = 0; row < plan.row_count; ++row)
                CHECK(plan.diagonal[row] == Approx(a(plan.vertex_of_row[row], plan.vertex_of_row[row])).margin(1e-15));
        }
    }
}

TEST_CASE("a plan is a permutation in contiguous parts, blocks and runs", "[plan]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : {catmull_clark(), catmull_clark(0, 0.4), loop(), doo_sabin()})
            for (const Index block_rows : {1, 3, 16, 8192}) {
                if (!suits(shape, scheme)) continue;
                INFO(shape.name << ", " << scheme_name(scheme.scheme) << ", blocks of " << block_rows);
                PlanOptions options;
                options.block_rows = block_rows;
                const Plan plan = mesh.plan(scheme, options);
                check_permutation(plan);
                check_cover(plan, block_rows);
                check_runs(plan);
                const auto parts = parts_of(plan);
                for (Index v = 0; v < plan.vertex_count; ++v) {
                    const Part& part = parts[part_of(mesh, scheme, v)];
                    CHECK((plan.row_of_vertex[v] >= part.first_row && plan.row_of_vertex[v] < part.end_row()));
                }
            }
    }
}

TEST_CASE("isolated vertices are the first rows", "[plan]") {
    const Prepared mesh(shapes::with_isolated_vertex(shapes::with_isolated_vertex(shapes::grid_quads(4, 4), 11), 2));
    const Plan plan = mesh.plan(catmull_clark());
    CHECK(plan.isolated_count == 2);
    CHECK(std::set<Index>(plan.vertex_of_row.begin(), plan.vertex_of_row.begin() + 2) == std::set<Index>{2, 12});
    CHECK(plan.fixed.row_count == 2 + 4);
}

TEST_CASE("the scaling makes the smooth part symmetric and is zero elsewhere", "[plan][spectrum]") {
    for (const auto& shape : {shapes::polygons_mixed(70, 3), shapes::grid_with_creases(), shapes::icosphere_with_crease_loop(), shapes::disk_pole_quads(5)})
        for (auto& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            INFO(shape.name << ", " << scheme.name);
            const Prepared mesh(shape);
            const Plan plan = mesh.plan(scheme.options);
            const Eigen::MatrixXd a = matrix_of(plan);
            Eigen::MatrixXd s = Eigen::MatrixXd::Zero(plan.smooth.row_count, plan.smooth.row_count);
            for (Index i = 0; i < plan.smooth.row_count; ++i)
                for (Index j = 0; j < plan.smooth.row_count; ++j)
                    s(i, j) = plan.scaling[plan.smooth.first_row + i] *
                              a(plan.vertex_of_row[plan.smooth.first_row + i], plan.vertex_of_row[plan.smooth.first_row + j]);
            CHECK(largest(s - s.transpose()) < 1e-14 * (1 + largest(s)));
            for (Index row = 0; row < plan.row_count; ++row) CHECK((plan.scaling[row] > 0) == (row >= plan.smooth.first_row));
        }
}

TEST_CASE("the plan's bound is below the smooth part's spectrum, and unknown with valence 2", "[plan][spectrum]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            INFO(shape.name << ", " << scheme.name);
            const Plan plan = mesh.plan(scheme.options);
            const bool has_valence_2 = shape.name == "cube_split_edges" || shape.name == "valence_2_pole";
            CHECK(plan.has_valence_2 == has_valence_2);
            if (has_valence_2 && scheme.options.scheme != Scheme::doo_sabin) {
                CHECK(std::isnan(plan.lambda_min_bound));
                continue;
            }
            CHECK(plan.lambda_min_bound >= 0);
            const Index first = plan.smooth.first_row, count = plan.smooth.row_count;
            if (count == 0) continue;
            const Eigen::MatrixXd a = matrix_of(plan);
            Eigen::MatrixXd block(count, count);
            for (Index i = 0; i < count; ++i)
                for (Index j = 0; j < count; ++j) block(i, j) = a(plan.vertex_of_row[first + i], plan.vertex_of_row[first + j]);
            const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(plan.scaling.data() + first, count);
            CHECK(oracle::scaled_spectrum(block, d)[0] >= plan.lambda_min_bound - 1e-12);
        }
    }
}

TEST_CASE("ghosts come last, without rows, and the owned rows are those of the whole mesh", "[plan][ghosts]") {
    for (const auto& shape : {shapes::grid_with_creases(), shapes::polygons_mixed(60, 5)}) {
        const Prepared mesh(shape);
        PlanOptions options;
        options.owned.assign(shape.mesh.vertex_count, 1);
        for (Index v = 0; v < shape.mesh.vertex_count; v += 3) options.owned[v] = 0;
        const Index ghosts = (shape.mesh.vertex_count + 2) / 3;
        INFO(shape.name);
        const Plan part = mesh.plan(catmull_clark(0.5), options), whole = mesh.plan(catmull_clark(0.5));
        CHECK(part.row_count == shape.mesh.vertex_count - ghosts);
        check_permutation(part);
        check_cover(part, options.block_rows);
        check_runs(part);
        for (Index row = part.row_count; row < part.vertex_count; ++row) CHECK(part.vertex_of_row[row] % 3 == 0);
        const Eigen::MatrixXd a = matrix_of(part), b = matrix_of(whole);
        for (Index v = 0; v < shape.mesh.vertex_count; ++v) {
            if (options.owned[v]) CHECK(largest(a.row(v) - b.row(v)) == 0);
            else CHECK(largest(a.row(v)) == 0);
        }
    }
}

TEST_CASE("the Morton order is a permutation that keeps neighbours together, and equal positions in order", "[plan][ordering]") {
    const auto mesh = shapes::shuffled(shapes::grid_quads(40, 40), 2).mesh;
    const Array<Index> order = morton_order(mesh.positions, mesh.vertex_count);
    CHECK(std::set<Index>(order.begin(), order.end()).size() == static_cast<std::size_t>(mesh.vertex_count));
    double along = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        double square = 0;
        for (int c = 0; c < 3; ++c) square += std::pow(mesh.positions[3 * order[i] + c] - mesh.positions[3 * order[i - 1] + c], 2);
        along += std::sqrt(square);
    }
    CHECK(along / static_cast<double>(order.size()) < 3 * 0.05);  // the edges are 0.05 long; in the shuffled order steps are of length 1
    CHECK(morton_order(std::vector<double>(30, 7.5), 10) == Array<Index>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    CHECK(morton_order({}, 0).empty());
}

TEST_CASE("the Morton order is the plain sort by the bits of three coordinates", "[plan][ordering][large]") {
    const Index count = 70000;
    for (const double stretch : {1.0, 1e-3, 1e6}) {
        CAPTURE(stretch);
        const Eigen::MatrixXd random = rough_values(count, 3, 5);
        std::vector<double> positions;
        for (Index v = 0; v < count; ++v)
            for (int c = 0; c < 3; ++c) positions.push_back(random(v, c) * (c == 0 ? stretch : 1) + 10);
        positions[3 * 77] += 100 * stretch;  // one far away
        double low[3], extent = 0;
        for (int c = 0; c < 3; ++c) {
            double high = low[c] = positions[c];
            for (Index v = 0; v < count; ++v) low[c] = std::min(low[c], positions[3 * v + c]), high = std::max(high, positions[3 * v + c]);
            extent = std::max(extent, high - low[c]);
        }
        std::vector<std::pair<std::uint32_t, Index>> keyed;
        for (Index v = 0; v < count; ++v) {
            std::uint32_t key = 0;
            for (int c = 0; c < 3; ++c) {
                const auto cell = static_cast<std::uint32_t>((positions[3 * v + c] - low[c]) * (1023 / extent));
                for (int bit = 0; bit < 10; ++bit) key |= (cell >> bit & 1) << (3 * bit + c);
            }
            keyed.emplace_back(key, v);
        }
        std::stable_sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        const Array<Index> order = morton_order(positions, count);
        bool same = true;
        for (Index i = 0; i < count; ++i) same = same && order[i] == keyed[i].second;
        CHECK(same);
    }
}

TEST_CASE("coordinates too far apart for their distance to be a number are ordered too", "[plan][ordering]") {
    const Array<Index> order = morton_order({-1.7e308, 0, 0, 1.7e308, 0, 0}, 2);
    CHECK(order == Array<Index>{0, 1});
}

TEST_CASE("a large plan equals a plain one: parts and shapes by stable sorts, rows one by one", "[plan][large]") {
    auto creased = shapes::shuffled(shapes::grid_quads(220, 200), 7);
    creased.features.corners = {5, 40000};
    const shapes::Shape large[] = {shapes::shuffled(shapes::torus_quads(230, 200), 6), creased, shapes::shuffled(shapes::polygons_mixed(36000, 8), 9),
                                   shapes::combined(shapes::torus_triangles(200, 180), shapes::disk_pole_triangles(500))};
    for (const auto& shape : large)
        for (const auto& scheme : {catmull_clark(), catmull_clark(0.2, 0.3), doo_sabin()}) {
            INFO(shape.name << ", " << scheme_name(scheme.scheme));
            const Prepared mesh(shape);
            const Plan plan = mesh.plan(scheme);
            check_permutation(plan);
            check_cover(plan, 8192);
            check_runs(plan);
            const std::vector<std::uint8_t> all;
            LimitRows rows(mesh.topology, mesh.features, scheme, all, all);
            std::vector<RowClass> classes;
            for (Index v = 0; v < plan.vertex_count; ++v) classes.push_back(rows.classify(v));
            const Array<Index> morton = morton_order(shape.mesh.positions, plan.vertex_count);
            std::vector<Index> order(morton.begin(), morton.end());
            std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return classes[a].kind < classes[b].kind; });
            for (const Block& block : plan.blocks)
                std::stable_sort(order.begin() + block.first_row, order.begin() + block.first_row + block.row_count, [&](Index a, Index b) {
                    return std::pair(classes[a].shape, classes[a].edges) < std::pair(classes[b].shape, classes[b].edges);
                });
            CHECK(std::equal(order.begin(), order.end(), plan.vertex_of_row.begin()));
            double worst = 0;
            for (const Run& run : plan.runs)
                for (Index row = run.first; row < run.first + run.count; ++row) {
                    std::map<Index, double> difference;
                    const LimitRow stored = plan_row(plan, run, row), plain = rows.row(order[row]);
                    for (std::size_t i = 0; i < stored.columns.size(); ++i) difference[plan.vertex_of_row[stored.columns[i]]] += stored.weights[i];
                    for (std::size_t i = 0; i < plain.columns.size(); ++i) difference[plain.columns[i]] -= plain.weights[i];
                    for (const auto& [column, value] : difference) worst = std::max(worst, std::abs(value));
                    for (std::size_t i = 0; i < plain.columns.size(); ++i)
                        if (plain.columns[i] == order[row]) worst = std::max(worst, std::abs(plain.weights[i] - plan.diagonal[row]));
                }
            CHECK(worst < tolerance);
        }
}

TEST_CASE("poles of any valence stand in runs of their own", "[plan]") {
    auto shape = shapes::disk_pole_triangles(64);
    for (const int n : {100, 63, 62, 100, 64, 65, 200}) shape = shapes::combined(shape, shapes::disk_pole_triangles(n));
    const Prepared mesh(shape);
    const Plan plan = mesh.plan(loop());
    check_permutation(plan);
    check_cover(plan, 8192);
    check_runs(plan);
    std::vector<int> valences;
    for (const Run& run : plan.runs)
        if (run.first >= plan.smooth.first_row) valences.insert(valences.end(), run.count, run.edges);
    CHECK(valences == std::vector<int>{62, 63, 64, 64, 65, 100, 100, 200});
}

TEST_CASE("the host operator applies the plan's rows, whatever the channels and blocks", "[plan][apply]") {
    for (const auto& shape : {shapes::polygons_mixed(90, 6), shapes::grid_with_creases(), shapes::torus_quads(6, 4)})
        for (const int channels : {1, 3, 8}) {
            const Prepared mesh(shape);
            PlanOptions options;
            options.block_rows = 7;
            options.owned.assign(shape.mesh.vertex_count, 1);
            options.owned[2] = 0;
            const Plan plan = mesh.plan(catmull_clark(0.3), options);
            const Eigen::MatrixXd x = rough_values(plan.vertex_count, channels, 1), m = rough_values(plan.vertex_count, channels, 2), ax = matrix_of(plan) * x;
            std::vector<double> in(x.size()), right(x.size());
            for (Index row = 0; row < plan.vertex_count; ++row)
                for (int c = 0; c < channels; ++c)
                    in[row * channels + c] = x(plan.vertex_of_row[row], c), right[row * channels + c] = m(plan.vertex_of_row[row], c);
            const std::vector<double> out = host_apply(plan, in, channels);
            double worst = 0, position = 0, others = 0;
            for (Index row = 0; row < plan.vertex_count; ++row) {
                const Index v = plan.vertex_of_row[row];
                const bool ghost = v == 2;
                for (int c = 0; c < channels; ++c) worst = std::max(worst, std::abs(out[row * channels + c] - (ghost ? x(v, c) : ax(v, c))));
                if (ghost) continue;
                const int first = std::min(3, channels);
                position = std::max(position, (m.row(v) - ax.row(v)).head(first).norm());
                if (channels > first) others = std::max(others, largest((m.row(v) - ax.row(v)).tail(channels - first)));
            }
            INFO(shape.name << ", " << channels << " channels");
            CHECK(worst < 1e-14);
            const ResidualNorms norms = host_residual(plan, right, in, channels);
            CHECK(norms.position == Approx(position).epsilon(1e-13));
            CHECK(norms.others == Approx(others).epsilon(1e-13).margin(1e-300));
        }
}
