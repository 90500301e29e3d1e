// SPDX-License-Identifier: BSD-3-Clause
// The plan: the operator's rows in their fast order, as plain arrays.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "host/apply/host_operator.h"
#include "host/operator/excerpt.h"
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

/// Inside a block every shape stands in one run; ring runs are of one valence, and their indices lie one after the other, each run's from an even place on.
void check_runs(const Plan& plan) {
    std::size_t ring_entries = 0, weighted = 0;
    for (const Block& block : plan.blocks) {
        std::set<std::pair<RowShape, int>> shapes;
        for (Index r = block.first_run; r < block.first_run + block.run_count; ++r) {
            const Run& run = plan.runs[r];
            CHECK(shapes.insert({run.shape, run.edges}).second);
            CHECK(run.index_offset == (run.shape == RowShape::weighted ? weighted : ring_entries));
            ring_entries += static_cast<std::size_t>(run.count) * run.stride();
            ring_entries += ring_entries % 2;
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

TEST_CASE("the scaling makes the smooth part symmetric", "[plan][spectrum]") {
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
        }
}

TEST_CASE("the scaling follows from the number of faces at every vertex that has some", "[plan][spectrum]") {
    const auto factor = [](const SchemeOptions& scheme, int n) {  // D of the masks: n (n + 5), n / (1 - alpha_n), n
        const double root = 3.0 / 8 + std::cos(2 * std::acos(-1.0) / n) / 4, alpha_n = 3 / (11 - 8 * (3.0 / 8 + root * root));
        return scheme.scheme == Scheme::catmull_clark ? n * (n + 5) : scheme.scheme == Scheme::loop ? n / (1 - alpha_n) : double(n);
    };
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        std::vector<NamedScheme> schemes = all_schemes();
        schemes.push_back({"own ratios", catmull_clark(0.3)});
        for (Index v = 0; v < shape.mesh.vertex_count; ++v) schemes.back().options.lambda_per_vertex.push_back(v % 4 / 3.0);  // 0, 1/3, 2/3, 1
        PlanOptions options;
        options.subset.assign(shape.mesh.vertex_count, 1);
        for (Index v = 0; v < shape.mesh.vertex_count; v += 5) options.subset[v] = 0;
        for (const auto& scheme : schemes) {
            if (!suits(shape, scheme.options)) continue;
            INFO(shape.name << ", " << scheme.name);
            const Plan plan = mesh.plan(scheme.options, options);
            REQUIRE(static_cast<Index>(plan.scaling.size()) == plan.row_count);
            for (Index row = 0; row < plan.row_count; ++row) {
                const Index v = plan.vertex_of_row[row];
                const double lambda = scheme.options.lambda_at(v);
                const bool has_none = mesh.topology.is_isolated(v) || lambda == 1;
                CHECK(plan.scaling[row] == Approx(has_none ? 0 : factor(scheme.options, mesh.topology.vertex_face_count[v]) / (1 - lambda)));
            }
        }
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

TEST_CASE("the breadth-first order is a permutation in which faces span two levels at most, isolated vertices last", "[plan][ordering]") {
    const auto shape = shapes::with_isolated_vertex(shapes::shuffled(shapes::grid_quads(40, 30), 2), 5);
    const Topology topology = build_topology(shape.mesh);
    const Array<Index> order = breadth_first_order(topology, shape.mesh.positions);
    REQUIRE(std::set<Index>(order.begin(), order.end()).size() == static_cast<std::size_t>(shape.mesh.vertex_count));
    CHECK(order.back() == 5);
    std::vector<Index> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<Index>(i);
    Index span = 0;
    for (Index f = 0; f < topology.face_count; ++f)
        for (Index c = topology.face_offsets[f]; c < topology.face_offsets[f + 1]; ++c)
            span = std::max(span, std::abs(place[topology.face_vertices[c]] - place[topology.face_vertices[topology.face_offsets[f]]]));
    CHECK(span <= 2 * (40 + 1 + 30 + 1));  // levels from a side of the grid hold at most one row and one column
    CHECK(breadth_first_order(Topology{}, {}).empty());
}

TEST_CASE("neighbours are close in the order of large meshes too, component by component", "[plan][ordering][large]") {
    const auto far_apart = shapes::combined(shapes::torus_quads(120, 100), shapes::combined(shapes::polygons_mixed(4000, 2), shapes::disk_pole_triangles(40)));
    for (const auto& shape : {shapes::shuffled(shapes::torus_quads(230, 200), 3), shapes::shuffled(shapes::icosphere(5), 4), shapes::grid_triangles(200, 190),
                              shapes::with_isolated_vertex(far_apart, 17)}) {
        INFO(shape.name);
        const Topology topology = build_topology(shape.mesh);
        const Array<Index> order = breadth_first_order(topology, shape.mesh.positions);
        std::vector<Index> place(order.size(), -1);
        for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<Index>(i);
        REQUIRE(std::count(place.begin(), place.end(), -1) == 0);
        Index span = 0;
        for (Index f = 0; f < topology.face_count; ++f) {
            const auto [low, high] =
                std::minmax_element(&topology.face_vertices[topology.face_offsets[f]], &topology.face_vertices[topology.face_offsets[f + 1]],
                                    [&](Index a, Index b) { return place[a] < place[b]; });
            span = std::max(span, place[*high] - place[*low]);
        }
        CHECK(span < 12 * std::sqrt(shape.mesh.vertex_count));  // a random order spans the whole mesh
    }
}

TEST_CASE("meshes whose vertices all lie in one place are ordered too", "[plan][ordering]") {
    auto shape = shapes::torus_quads(9, 7);
    std::fill(shape.mesh.positions.begin(), shape.mesh.positions.end(), 4.0);
    const Array<Index> order = breadth_first_order(build_topology(shape.mesh), shape.mesh.positions);
    CHECK(std::set<Index>(order.begin(), order.end()).size() == 63);
}

TEST_CASE("a plan's reach bounds how many blocks the smooth rows of a block look away", "[plan][ordering]") {
    for (const auto& shape : {shapes::torus_quads(40, 30), shapes::polygons_mixed(900, 5), shapes::grid_with_creases()}) {
        const Prepared mesh(shape);
        PlanOptions options;
        options.block_rows = 16;
        const Plan plan = mesh.plan(catmull_clark(), options);
        const auto block_of = [&](Index row) { return (row - plan.smooth.first_row) / options.block_rows; };
        Index reach = 0;
        for (Index row = plan.smooth.first_row; row < plan.smooth.end_row(); ++row)
            for (const Index column : plan_row(plan, run_of_row(plan, row), row).columns)
                if (column >= plan.smooth.first_row && column < plan.smooth.end_row()) reach = std::max(reach, std::abs(block_of(row) - block_of(column)));
        CHECK(plan.reach == reach);
    }
}

TEST_CASE("an excerpt is a principal submatrix, round the weakest rows", "[plan]") {
    const Prepared mesh(shapes::polygons_mixed(900, 5));
    PlanOptions options;
    options.block_rows = 16;
    const Plan plan = mesh.plan(catmull_clark(), options);
    const Part part = weakest_blocks(plan, 100);
    REQUIRE(part.row_count >= 100);
    REQUIRE(part.row_count < plan.smooth.row_count);
    const Plan some = excerpt(plan, part.first_block, part.block_count);
    REQUIRE(some.row_count == part.row_count);
    for (Index row = 0; row < some.row_count; ++row) {
        std::map<Index, double> expected, found;
        const LimitRow whole = plan_row(plan, run_of_row(plan, row + part.first_row), row + part.first_row), cut = plan_row(some, run_of_row(some, row), row);
        for (std::size_t i = 0; i < whole.columns.size(); ++i)
            if (whole.columns[i] >= part.first_row && whole.columns[i] < part.end_row()) expected[whole.columns[i] - part.first_row] += whole.weights[i];
        for (std::size_t i = 0; i < cut.columns.size(); ++i)
            if (cut.columns[i] < some.row_count) found[cut.columns[i]] += cut.weights[i];
        CHECK(found == expected);
    }
    CHECK(weakest_blocks(plan, plan.smooth.row_count).row_count == plan.smooth.row_count);
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
            check_cover(plan, PlanOptions{}.block_rows);
            check_runs(plan);
            const std::vector<std::uint8_t> all;
            LimitRows rows(mesh.topology, mesh.features, scheme, all, all);
            std::vector<RowClass> classes;
            for (Index v = 0; v < plan.vertex_count; ++v) classes.push_back(rows.classify(v));
            const Array<Index> breadth_first = breadth_first_order(mesh.topology, shape.mesh.positions);
            std::vector<Index> order(breadth_first.begin(), breadth_first.end());
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
