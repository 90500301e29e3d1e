// SPDX-License-Identifier: BSD-3-Clause
// Orders of Gauss-Seidel: steps of rows that do not see each other.
#include <catch2/catch.hpp>

#include "host/operator/schedule.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

/// Every row once, with its entries, and no row of a step in another's entries.
void check_schedule(const Plan& plan, const Schedule& schedule) {
    REQUIRE(static_cast<Index>(schedule.rows.size()) == plan.row_count);
    REQUIRE(schedule.step_offsets.front() == 0);
    REQUIRE(schedule.step_offsets.back() == plan.row_count);
    std::vector<Index> step_of_row(plan.vertex_count, -1);
    for (std::size_t step = 0; step + 1 < schedule.step_offsets.size(); ++step) {
        REQUIRE(schedule.step_offsets[step] < schedule.step_offsets[step + 1]);
        for (Index k = schedule.step_offsets[step]; k < schedule.step_offsets[step + 1]; ++k) {
            REQUIRE(step_of_row.at(schedule.rows[k]) == -1);
            step_of_row[schedule.rows[k]] = static_cast<Index>(step);
        }
    }
    for (std::size_t k = 0; k < schedule.rows.size(); ++k) {
        const Index row = schedule.rows[k];
        const LimitRow expected = plan_row(plan, run_of_row(plan, row), row);
        const auto begin = schedule.offsets[k], end = schedule.offsets[k + 1];
        REQUIRE(std::vector<Index>(schedule.columns.begin() + begin, schedule.columns.begin() + end) == expected.columns);
        REQUIRE(std::vector<double>(schedule.weights.begin() + begin, schedule.weights.begin() + end) == expected.weights);
        REQUIRE(schedule.inverse_diagonal[k] * plan.diagonal[row] == Approx(1));
        for (auto e = begin; e < end; ++e) REQUIRE((schedule.columns[e] == row || step_of_row[schedule.columns[e]] != step_of_row[row]));
    }
}

/// A sweep over the schedule, in place.
Eigen::MatrixXd swept(const Plan& plan, const Schedule& schedule, const Eigen::MatrixXd& m) {
    Eigen::MatrixXd x = m;
    for (std::size_t k = 0; k < schedule.rows.size(); ++k) {
        const Index v = plan.vertex_of_row[schedule.rows[k]];
        Eigen::RowVectorXd residual = m.row(v);
        for (auto e = schedule.offsets[k]; e < schedule.offsets[k + 1]; ++e) residual -= schedule.weights[e] * x.row(plan.vertex_of_row[schedule.columns[e]]);
        x.row(v) += residual * schedule.inverse_diagonal[k];
    }
    return x;
}

}  // namespace

TEST_CASE("schedules hold every row once, and no two neighbours in a step", "[schedule]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : {catmull_clark(), loop(), doo_sabin()}) {
            if (!suits(shape, scheme)) continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme));
            const Plan plan = mesh.plan(scheme);
            check_schedule(plan, natural_schedule(plan));
            check_schedule(plan, coloured_schedule(plan));
        }
    }
}

TEST_CASE("a sweep over the natural levels is the plain loop's", "[schedule][gauss-seidel]") {
    for (const auto& shape : shapes::all_shapes()) {
        const Prepared mesh(shape);
        for (const auto& scheme : {catmull_clark(0.5), loop(), doo_sabin(DooSabinMask::classic)}) {
            if (!suits(shape, scheme)) continue;
            INFO(shape.name << ", " << scheme_name(scheme.scheme));
            const Plan plan = mesh.plan(scheme);
            const Eigen::MatrixXd m = rough_values(plan.vertex_count, 2, 4);
            CHECK(largest(swept(plan, natural_schedule(plan), m) - oracle::gauss_seidel(matrix_of(plan), m, 1).points) < 1e-13);
        }
    }
}

TEST_CASE("levels follow the numbering: a strip in order is one chain, and shuffling makes them few", "[schedule]") {
    const shapes::Shape strip = shapes::cylinder_open(3, 40);  // ring after ring: every ring waits for the one before
    const Plan in_order = Prepared(strip).plan(catmull_clark()), mixed = Prepared(shapes::shuffled(strip, 1)).plan(catmull_clark());
    const std::size_t levels = natural_schedule(in_order).step_offsets.size() - 1, mixed_levels = natural_schedule(mixed).step_offsets.size() - 1;
    CHECK(levels >= 3 * 39);
    CHECK(mixed_levels < levels / 2);
}

TEST_CASE("colours are few: at most one more than the most neighbours, face diagonals included", "[schedule][gauss-seidel]") {
    for (const auto& shape : {shapes::torus_quads(16, 12), shapes::random_triangle_mesh(400, 3), shapes::polygons_mixed(200, 4)}) {
        INFO(shape.name);
        const Plan plan = Prepared(shape).plan(catmull_clark());
        const Schedule schedule = coloured_schedule(plan);
        std::size_t neighbours = 0;
        for (std::size_t k = 0; k < schedule.rows.size(); ++k)
            neighbours = std::max<std::size_t>(neighbours, schedule.offsets[k + 1] - schedule.offsets[k] - 1);
        CHECK(schedule.step_offsets.size() - 1 <= neighbours + 1);
        CHECK(schedule.step_offsets.size() - 1 >= 4);  // a quad's corners see each other; so do a vertex of valence 3 and its neighbours
    }
}

TEST_CASE("ghosts are in no schedule", "[schedule][ghosts]") {
    const Prepared mesh(shapes::torus_quads(6, 4));
    PlanOptions options;
    options.owned.assign(24, 1);
    for (const Index v : {0, 5, 17}) options.owned[v] = 0;
    const Plan plan = mesh.plan(catmull_clark(), options);
    check_schedule(plan, natural_schedule(plan));
    check_schedule(plan, coloured_schedule(plan));
}
