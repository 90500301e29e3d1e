// SPDX-License-Identifier: BSD-3-Clause
// What the tests of operators, kernels and solvers share: schemes by name, systems on the default device, matrices of plans in the caller's numbering.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "host/mesh/features.h"
#include "host/solve/solve.h"
#include "tests/at_end.h"
#include "tests/oracle/dense.h"
#include "tests/oracle/limit.h"
#include "tests/shapes/shapes.h"

namespace solver_test {

struct NamedScheme {
    std::string name;
    lcl::SchemeOptions options;
};

inline lcl::SchemeOptions catmull_clark(double alpha = 0, double lambda = 0) {
    lcl::SchemeOptions options;
    options.alpha = alpha;
    options.lambda = lambda;
    return options;
}

inline lcl::SchemeOptions loop() {
    lcl::SchemeOptions options;
    options.scheme = lcl::Scheme::loop;
    return options;
}

inline lcl::SchemeOptions doo_sabin(lcl::DooSabinMask mask = lcl::DooSabinMask::catmull) {
    lcl::SchemeOptions options;
    options.scheme = lcl::Scheme::doo_sabin;
    options.mask = mask;
    return options;
}

/// Every scheme; Catmull-Clark with several alphas and blend ratios.
inline std::vector<NamedScheme> all_schemes() {
    return {{"Catmull-Clark", catmull_clark()},
            {"Catmull-Clark, alpha 0.3", catmull_clark(0.3)},
            {"Catmull-Clark, alpha 0.5", catmull_clark(0.5)},
            {"Catmull-Clark, alpha 1", catmull_clark(1)},
            {"two-phase 1/3", catmull_clark(0, 1.0 / 3)},
            {"two-phase 0.2, alpha 0.3", catmull_clark(0.3, 0.2)},
            {"Loop", loop()},
            {"Doo-Sabin", doo_sabin()},
            {"classic Doo-Sabin", doo_sabin(lcl::DooSabinMask::classic)}};
}

inline bool suits(const shapes::Shape& shape, const lcl::SchemeOptions& options) {
    return options.scheme != lcl::Scheme::loop || shapes::is_triangle_mesh(shape.mesh);
}

inline double largest(const Eigen::MatrixXd& a) { return a.size() == 0 ? 0 : a.cwiseAbs().maxCoeff(); }

/// Numbers in [-1, 1), with a part of every eigenvector in every column.
inline Eigen::MatrixXd rough_values(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
    shapes::Random random(seed);
    Eigen::MatrixXd values(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i)
        for (Eigen::Index c = 0; c < columns; ++c) values(i, c) = random.symmetric();
    return values;
}

/// A mesh with its topology and sharp features.
struct Prepared {
    explicit Prepared(shapes::Shape shape_)
        : shape(std::move(shape_)), topology(lcl::build_topology(shape.mesh)), features(find_features(shape.mesh, topology, shape.features)) {}
    shapes::Shape shape;
    lcl::Topology topology;
    lcl::Features features;

    lcl::Plan plan(const lcl::SchemeOptions& scheme, const lcl::PlanOptions& options = {}) const {
        return build_plan(shape.mesh, topology, features, scheme, options);
    }
    std::unique_ptr<lcl::LimitSystem> system(const std::shared_ptr<lcl::Context>& context, const lcl::SchemeOptions& scheme,
                                             const std::vector<std::uint8_t>& subset = {}) const {
        lcl::PlanOptions options;
        options.subset = subset;
        return make_limit_system(context, shape.mesh, topology, features, scheme, options);
    }
    Eigen::Index vertex_count() const { return shape.mesh.vertex_count; }
};

/// The plan's rows in the caller's numbering, vertex_count x vertex_count; rows of ghosts are empty.
inline oracle::SparseMatrix matrix_of(const lcl::Plan& plan) {
    std::vector<Eigen::Triplet<double>> entries;
    for (lcl::Index row = 0; row < plan.row_count; ++row) {
        const lcl::LimitRow entry = plan_row(plan, run_of_row(plan, row), row);
        for (std::size_t k = 0; k < entry.columns.size(); ++k)
            entries.emplace_back(plan.vertex_of_row[row], plan.vertex_of_row[entry.columns[k]], entry.weights[k]);
    }
    oracle::SparseMatrix a(plan.vertex_count, plan.vertex_count);
    a.setFromTriplets(entries.begin(), entries.end());
    return a;
}

/// `context`, opened for all tests when it is first asked for.
inline const std::shared_ptr<lcl::Context>& opened_once(std::shared_ptr<lcl::Context>& context, const lcl::DeviceInfo& device) {
    if (!context) {
        context = lcl::Context::create(device);
        at_end().push_back([&] { context.reset(); });
    }
    return context;
}

inline const std::shared_ptr<lcl::Context>& device_context() {
    static std::shared_ptr<lcl::Context> context;
    return context ? context : opened_once(context, lcl::choose_device());
}

/// The same device taken for one without double precision, so that pairs of floats run anywhere.
inline const std::shared_ptr<lcl::Context>& context_without_double() {
    static std::shared_ptr<lcl::Context> context;
    if (context) return context;
    lcl::DeviceInfo device = lcl::choose_device();
    device.has_double = false;
    return opened_once(context, device);
}

struct Solved {
    lcl::SolveReport report;
    Eigen::MatrixXd points;
};

/// solve_host; start: P_0, or null.
inline Solved solve(lcl::LimitSystem& system, const Eigen::MatrixXd& m, const lcl::SolveOptions& options, const Eigen::MatrixXd* start = nullptr) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Rows given = m;
    Rows points = start ? Rows(*start) : Rows(Rows::Zero(m.rows(), m.cols()));
    const std::size_t channels = static_cast<std::size_t>(m.cols());
    lcl::SolveReport report = solve_host(system, given.data(), channels, static_cast<int>(channels), options, start != nullptr, points.data(), channels);
    return {std::move(report), points};
}

inline lcl::SolveOptions solve_options(lcl::Solver solver, double tolerance = 1e-6, lcl::Precision precision = lcl::Precision::mixed,
                                       int max_iterations = 1000) {
    lcl::SolveOptions options;
    options.solver = solver;
    options.precision = precision;
    options.tolerance = tolerance;
    options.max_iterations = max_iterations;
    return options;
}

}  // namespace solver_test
