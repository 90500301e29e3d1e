// SPDX-License-Identifier: BSD-3-Clause
// C++17: a smooth surface through a cloud of points, with an engine of one's own. The cloud is a scan of a torus, line by line, so that neighbours are known
// and the engine only has to join them; without such knowledge an engine of limitcl_engine.h does that. Tells how many vertices carry the surface and how far
// the points are from it. usage: point_cloud [CONTROL_MESH]
#include <limitcl/limitcl.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace {

constexpr double pi = 3.141592653589793, ring = 3, tube = 1;
constexpr int lines = 72, points_a_line = 36;

std::vector<double> scan_torus() {
    std::vector<double> points;
    for (int i = 0; i < lines; ++i)
        for (int j = 0; j < points_a_line; ++j) {
            const double u = 2 * pi * i / lines, v = 2 * pi * j / points_a_line;
            points.insert(points.end(), {(ring + tube * std::cos(v)) * std::cos(u), (ring + tube * std::cos(v)) * std::sin(u), tube * std::sin(v)});
        }
    return points;
}

/// Two triangles between each four neighbours of the scan. An exception would end the fit and reach its caller.
limitcl::Approximation join_neighbours(const limitcl::EngineInput& input) {
    if (input.points.size() != 3 * lines * points_a_line) throw std::runtime_error("the cloud is not the scan that this engine knows");
    limitcl::Approximation mesh;  // its points stay empty: those that came in are the vertices
    for (int i = 0; i < lines && input.progress(static_cast<double>(i) / lines); ++i)
        for (int j = 0; j < points_a_line; ++j) {
            const int next_i = (i + 1) % lines, next_j = (j + 1) % points_a_line;
            const int a = i * points_a_line + j, b = next_i * points_a_line + j, c = next_i * points_a_line + next_j, d = i * points_a_line + next_j;
            mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
        }
    return mesh;
}

/// Largest distance from the torus itself, at the limit points of a control mesh that is refined once more.
double farthest_from_torus(const limitcl::Context& context, const limitcl::Mesh& control) {
    const limitcl::SchemeOptions scheme(limitcl::Scheme::doo_sabin);
    const limitcl::Mesh fine = limitcl::refine(control, 1, scheme);
    const std::vector<double> points = limitcl::LimitOperator(context, fine, scheme).limit_points(fine.points());
    double farthest = 0;
    for (std::size_t i = 0; i < points.size(); i += 3)
        farthest = std::max(farthest, std::abs(std::hypot(std::hypot(points[i], points[i + 1]) - ring, points[i + 2]) - tube));
    return farthest;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const limitcl::Context context;
        const limitcl::Cloud cloud(scan_torus());
        const limitcl::Engine engine("join neighbours", join_neighbours);
        limitcl::FitOptions options;
        options.tolerance = 2e-3;
        const limitcl::Fit fit = fit_surface(context, cloud, engine, options);
        const limitcl::FitReport& report = fit.report.require_ok();
        const double farthest = farthest_from_torus(context, fit.mesh);
        std::printf("%d vertices carry a Doo-Sabin surface through %lld points, after %d rounds\n", report.vertices, static_cast<long long>(report.points),
                    report.rounds);
        std::printf("distances of the points: %.1e rms, %.1e at most; of the surface from the torus: %.1e at most; tolerance %.1e\n", report.rms, report.max,
                    farthest, options.tolerance * report.diagonal);
        if (argc == 2) limitcl::write_mesh(fit.mesh, argv[1]);
        const limitcl::MeshInfo info = fit.mesh.info();
        const bool is_torus = info.vertices - info.edges + info.faces == 0 && info.boundary_loops == 0 && info.components == 1;
        return report.converged && is_torus && farthest < 3 * options.tolerance * report.diagonal ? 0 : 1;
    } catch (const limitcl::Error& error) {
        std::fprintf(stderr, "%s: %s\n", error.status_name(), error.what());
        return 1;
    }
}
