// SPDX-License-Identifier: BSD-3-Clause
// The table of the Loop PIA paper in kind: E_10/E_0 and the spectral radius of the iteration matrix for PIA, W-PIA with the best weight, and GS-PIA in natural
// order, on triangle meshes of about 0.5k, 1.6k and 8.6k vertices, and the same for the schemes that the paper leaves to the future. The device's figures have
// to be the plain loops'.
#include <cmath>
#include <cstdio>
#include <map>

#include <catch2/catch.hpp>

#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

constexpr int sweeps = 10;

struct Figures {
    double pia = 0, wpia = 0, gauss_seidel = 0;
};

/// Factor by which x <- G x grows in the long run: the mean over the last `span` of many steps, in the norm of D.
template <class Step>
double growth(const Eigen::VectorXd& d, const Step& step, int steps = 5000, int span = 500) {
    Eigen::VectorXd x = rough_values(d.size(), 1, 17);
    double logarithm = 0;
    for (int k = 0; k < steps; ++k) {
        x = step(x);
        const double norm = std::sqrt(x.cwiseAbs2().dot(d));
        if (k >= steps - span) logarithm += std::log(norm);
        x /= norm;
    }
    return std::exp(logarithm / span);
}

/// The error of one sweep of Gauss-Seidel for A x = 0.
Eigen::VectorXd gauss_seidel_step(const oracle::SparseMatrix& a, Eigen::VectorXd x) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        double ax = 0, own = 1;
        for (oracle::SparseMatrix::InnerIterator entry(a, i); entry; ++entry) {
            ax += entry.value() * x[entry.col()];
            if (entry.col() == i) own = entry.value();
        }
        x[i] -= ax / own;
    }
    return x;
}

class Table {
public:
    explicit Table(const char* title) {
        std::printf("\n%s\n%-34s %6s | %-28s | %-26s\n", title, "mesh", "V", "radius: PIA, W-PIA, GS", "E_10/E_0: PIA, W-PIA, GS");
    }

    /// Measures one mesh, checks device against plain loops, and prints the line.
    Figures add(const shapes::Shape& shape, const SchemeOptions& scheme) {
        INFO(shape.name << ", " << scheme_name(scheme.scheme) << ", alpha " << scheme.alpha << ", lambda " << scheme.lambda);
        const Prepared mesh(shape);
        const auto system = mesh.system(device_context(), scheme);
        const oracle::SparseMatrix a = matrix_of(system->plan());
        Eigen::VectorXd d(mesh.vertex_count());
        for (Index row = 0; row < system->plan().row_count; ++row) d[system->plan().vertex_of_row[row]] = system->plan().scaling[row];
        const Figures radius = radii(a, d);
        const double weight = 2 / (2 - radius.pia);
        check_radii(radius);
        const Eigen::MatrixXd m = oracle::positions(shape.mesh);
        const Figures gain{ratio(*system, m, Solver::pia, 0, oracle::pia(a, m, sweeps)),
                           ratio(*system, m, Solver::wpia, weight, oracle::pia(a, m, sweeps, weight)),
                           ratio(*system, m, Solver::gauss_seidel, 0, oracle::gauss_seidel(a, m, sweeps))};
        CHECK(gain.gauss_seidel < gain.wpia);
        CHECK(gain.wpia < gain.pia);
        CHECK(2 / (1 + spectrum_of(*system).estimate) == Approx(weight).epsilon(0.02));  // the weight that wpia takes by itself
        std::printf("%-34s %6d | %8.4f %8.4f %8.4f   | %8.2e %8.2e %8.2e\n", shape.name.c_str(), static_cast<int>(mesh.vertex_count()), radius.pia, radius.wpia,
                    radius.gauss_seidel, gain.pia, gain.wpia, gain.gauss_seidel);
        return radius;
    }

private:
    /// E - A is similar to a symmetric matrix with eigenvalues >= 0, so growth finds its largest; E - w A has +-(w - 1) at both ends.
    static Figures radii(const oracle::SparseMatrix& a, const Eigen::VectorXd& d) {
        if (a.rows() <= 600) {
            const Eigen::MatrixXd dense = a;
            const Eigen::VectorXd values = oracle::scaled_spectrum(dense, d);
            const double weight = 2 / (1 + values[0]), rest = std::max(std::abs(1 - weight * values[0]), std::abs(1 - weight * values[values.size() - 1]));
            return {1 - values[0], rest, oracle::spectral_radius(oracle::gauss_seidel_iteration(dense))};
        }
        const double pia = growth(d, [&](const Eigen::VectorXd& x) { return Eigen::VectorXd(x - a * x); }), weight = 2 / (2 - pia);
        return {pia, growth(d, [&](const Eigen::VectorXd& x) { return Eigen::VectorXd(x - weight * (a * x)); }),
                growth(
                    d, [&](const Eigen::VectorXd& x) { return gauss_seidel_step(a, x); }, 400, 100)};
    }

    static void check_radii(const Figures& radius) {
        CHECK(radius.gauss_seidel < radius.wpia);
        CHECK(radius.wpia < radius.pia);
        CHECK(radius.pia < 1);
        CHECK(radius.wpia == Approx(radius.pia / (2 - radius.pia)).epsilon(2e-3));  // growth is still a little below its limit
    }

    static double ratio(LimitSystem& system, const Eigen::MatrixXd& m, Solver solver, double weight, const oracle::History& plain) {
        const double expected = plain.residuals[sweeps] / plain.residuals[0];
        double found = 0;
        for (const Precision precision : {Precision::mixed, Precision::full}) {
            if (precision == Precision::full && !device_context()->device().has_double) continue;
            SolveOptions options = solve_options(solver, 1e-6, precision);
            options.exact_sweeps = sweeps;
            options.weight = weight;
            const SolveReport report = solve(system, m, options).report;
            REQUIRE(report.residuals.size() == sweeps + 1);
            found = report.residuals[sweeps] / report.residuals[0];
            CHECK(found == (precision == Precision::full ? Approx(expected).epsilon(1e-8).margin(1e-14)
                                                         : Approx(expected).epsilon(1e-4).margin(1e-7)));  // float stages begin at 1e-4 of E_0
        }
        return found;
    }
};

/// Every triangle cut into three quads.
shapes::Shape quads_of(const shapes::Shape& triangles) {
    auto points = shapes::points_of(triangles.mesh);
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
        const auto [found, is_new] = middles.emplace(std::minmax(a, b), static_cast<int>(points.size()));
        if (is_new) points.push_back({(points[a][0] + points[b][0]) / 2, (points[a][1] + points[b][1]) / 2, (points[a][2] + points[b][2]) / 2});
        return found->second;
    };
    std::vector<shapes::Face> faces;
    for (const auto& f : shapes::faces_of(triangles.mesh)) {
        const int a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]), centre = static_cast<int>(points.size());
        shapes::Point mean{0, 0, 0};
        for (int k = 0; k < 3; ++k) mean[k] = (points[f[0]][k] + points[f[1]][k] + points[f[2]][k]) / 3;
        points.push_back(mean);
        faces.insert(faces.end(), {{f[0], a, centre, c}, {f[1], b, centre, a}, {f[2], c, centre, b}});
    }
    return shapes::make("quads_of_" + triangles.name, points, faces);
}

/// Rough, so that every eigenvector has its part: smooth data would flatter the first sweeps.
shapes::Shape noisy(const shapes::Shape& shape, std::uint64_t seed) {
    shapes::Shape out = shapes::rough(shape, 0.05, seed);
    out.name = shape.name;
    return out;
}

}  // namespace

TEST_CASE("Loop: the device's table is the plain loops', and of the paper's kind", "[table][loop]") {
    Table table("Loop PIA, natural order (Loop PIA paper: radius 0.77-0.82, 0.62-0.69, 0.27-0.34; E_10/E_0 0.017-0.028, 0.001-0.002, 2e-6 to 1.1e-5)");
    for (const int vertices : {500, 1600, 8600}) {
        const Figures radius = table.add(noisy(shapes::random_triangle_mesh(vertices, 11), 4), loop());
        CHECK(radius.pia > 0.74);
        CHECK(radius.pia < 0.9);  // 1 - lambda_min, lambda_min >= 0.1 at valence 3
        CHECK(radius.gauss_seidel < 0.4);
    }
}

TEST_CASE("Catmull-Clark and two-phase: the same table", "[table][catmull-clark]") {
    for (const auto& scheme :
         {NamedScheme{"Catmull-Clark, alpha 0, on quads", catmull_clark()}, NamedScheme{"Catmull-Clark, alpha 0.5, on quads", catmull_clark(0.5)},
          NamedScheme{"two-phase, lambda 1/3, on quads", catmull_clark(0, 1.0 / 3)}}) {
        Table table(scheme.name.c_str());
        for (const int vertices : {84, 270, 1440}) table.add(noisy(quads_of(shapes::random_triangle_mesh(vertices, 12)), 5), scheme.options);
    }
}

TEST_CASE("Doo-Sabin with both masks: the same table, on duals of triangle meshes and on quads", "[table][doo-sabin]") {
    for (const auto& scheme : {NamedScheme{"Doo-Sabin, catmull mask", doo_sabin()}, NamedScheme{"Doo-Sabin, classic mask", doo_sabin(DooSabinMask::classic)}}) {
        Table table(scheme.name.c_str());
        for (const int vertices : {250, 800, 4300}) {
            const Figures radius = table.add(noisy(shapes::dual_of(shapes::random_triangle_mesh(vertices, 13)), 6), scheme.options);
            CHECK(radius.pia <= 0.75 + 1e-9);  // lambda_min >= 1/4 on every mesh
        }
        table.add(noisy(quads_of(shapes::random_triangle_mesh(84, 12)), 5), scheme.options);
    }
}
