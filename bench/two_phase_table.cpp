// SPDX-License-Identifier: BSD-3-Clause
// two_phase_table MESH..: table 1 of the two-phase paper, in kind. For each mesh, and for the quads that one Catmull-Clark refinement makes of it, all taken to
// their limit points (the paper's recipe for its quad models): sweeps of Jacobi and Gauss-Seidel from P_0 = Q until no vertex moves by more than 0.05 % of the
// model size in a sweep, for several blend ratios; the update of that sweep; milliseconds of the solve with so many sweeps, and of all of M^1. Milliseconds are
// the median of 15 calls from host memory to host memory, in single precision, which is enough for an update of 0.05 %.
#include <limitcl/limitcl.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "measure.h"

namespace bench {
namespace {

constexpr int most_sweeps = 20, calls = 15;
constexpr double wanted_update = 5e-4;

limitcl::SchemeOptions catmull_clark(double lambda) {
    limitcl::SchemeOptions scheme;
    scheme.scheme = limitcl::Scheme::catmull_clark;
    scheme.lambda = lambda;
    return scheme;
}

/// One refinement, every vertex at its limit point.
limitcl::Mesh quads_of(const limitcl::Context& context, const limitcl::Mesh& mesh) {
    limitcl::Mesh quads = limitcl::refine(mesh, 1, catmull_clark(0));
    quads.set_points(limitcl::LimitOperator(context, quads, catmull_clark(0)).limit_points(quads.points()));
    return quads;
}

double largest_move(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); i += 3) largest = std::max(largest, std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
    return largest;
}

limitcl::SolveOptions sweeps_of(limitcl::Solver solver, int sweeps, limitcl::Precision precision) {
    limitcl::SolveOptions options;
    options.solver = solver;
    options.precision = precision;
    options.exact_sweeps = sweeps;
    options.keep_going = true;
    return options;
}

template <class Body>
double median_milliseconds(const Body& body) {
    std::vector<double> seconds;
    body();
    for (int i = 0; i < calls; ++i) {
        const Clock::time_point start = Clock::now();
        body();
        seconds.push_back(seconds_since(start));
    }
    std::nth_element(seconds.begin(), seconds.begin() + calls / 2, seconds.end());
    return 1e3 * seconds[calls / 2];
}

struct Sweeps {
    int count = 0;
    double update = 0;  ///< of the last sweep, of the model size
};

Sweeps count_sweeps(const limitcl::LimitOperator& A, const std::vector<double>& Q, double size, limitcl::Solver solver) {
    Sweeps sweeps;
    std::vector<double> before = Q;
    do {
        const std::vector<double> P = limitcl::interpolate(A, Q, 3, sweeps_of(solver, ++sweeps.count, limitcl::Precision::mixed)).points;
        sweeps.update = largest_move(P, before) / size;
        before = P;
    } while (sweeps.update > wanted_update && sweeps.count < most_sweeps);
    return sweeps;
}

void print_row(const limitcl::Context& context, const limitcl::Mesh& mesh, const std::string& name, double lambda, limitcl::Solver solver) {
    const limitcl::LimitOperator A(context, mesh, catmull_clark(lambda));
    const std::vector<double> Q = mesh.points();
    const Sweeps sweeps = count_sweeps(A, Q, mesh.info().diagonal, solver);
    std::vector<double> P(Q.size());
    const limitcl::SolveOptions solve = sweeps_of(solver, sweeps.count, limitcl::Precision::single);
    const double solve_time = median_milliseconds([&] { static_cast<void>(limitcl::interpolate(A, Q, 3, P.data(), solve)); });
    limitcl::TwoPhaseOptions options;
    options.solve = solve;
    double error = 0;
    const double whole_time = median_milliseconds([&] { error = limitcl::interpolate_two_phase(A, mesh, options).report.max_error; });
    const auto valences = mesh.valence_counts();
    std::printf("%-28s %6d  %d..%-3d %6.3f  %-6s %4d %9.3f %% %9.2f %9.2f  %.0e\n", name.c_str(), mesh.vertex_count(), valences.begin()->first,
                valences.rbegin()->first, lambda, solver == limitcl::Solver::jacobi ? "jacobi" : "gs", sweeps.count, 100 * sweeps.update, solve_time,
                whole_time, error / mesh.info().diagonal);
}

void print_table(const std::vector<std::string>& files) {
    const limitcl::Context context;
    std::printf("%s\n%-28s %6s  %-7s %5s  %-6s %5s %11s %9s %9s  %s\n", context.device().name.c_str(), "mesh", "n", "valence", "lambda", "solver", "sweeps",
                "last update", "solve ms", "M^1 ms", "miss");
    for (const std::string& file : files) {
        const limitcl::Mesh mesh = limitcl::read_mesh(file);
        const std::string name = file.substr(file.find_last_of('/') + 1);
        for (const limitcl::Mesh& model : {mesh, quads_of(context, mesh)})
            for (const double lambda : {0.2, 1.0 / 3, 0.5})
                for (const limitcl::Solver solver : {limitcl::Solver::jacobi, limitcl::Solver::gs})
                    print_row(context, model, model.get() == mesh.get() ? name : name + ", quads", lambda, solver);
    }
    std::printf(
        "two-phase paper, lambda 1/3, one sweep after the other on a 1.6 GHz Pentium 4: 453 vertices 4 sweeps 0.02 %% 6.2 ms; 567: 4, 0.04 %%, 8.7 ms;\n"
        "quads: 1388: 3, 0.05 %%, 16 ms; 2084: 3, 0.03 %%, 24 ms; 5726: 3, 0.02 %%, 69 ms\n");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
    try {
        if (argc < 2) throw std::runtime_error("usage: two_phase_table MESH..");
        bench::print_table({argv + 1, argv + argc});
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
