// SPDX-License-Identifier: BSD-3-Clause
// C++17: a surface through a few points of a torus, first by the points alone, then with the torus's normals, then fair too, and with other shape handles.
// Tells how far each surface is from the torus between the points. With a mesh file that holds normals, writes the refined control mesh that has them. usage:
// two_phase [MESH REFINED_MESH]
#include <limitcl/limitcl.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

constexpr double pi = 3.141592653589793, ring = 3, tube = 1;

struct Torus {
    std::vector<double> points, normals;
    std::vector<std::int32_t> quads;

    Torus(int m, int n) {
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < n; ++j) {
                const double u = 2 * pi * i / m, v = 2 * pi * j / n;
                const double normal[3] = {std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)};
                for (int c = 0; c < 3; ++c) {
                    normals.push_back(normal[c]);
                    points.push_back(tube * normal[c] + (c == 0 ? ring * std::cos(u) : c == 1 ? ring * std::sin(u) : 0));
                }
                const int next_i = (i + 1) % m, next_j = (j + 1) % n;
                quads.insert(quads.end(), {i * n + j, next_i * n + j, next_i * n + next_j, i * n + next_j});
            }
    }
};

limitcl::SchemeOptions catmull_clark(double lambda) {
    limitcl::SchemeOptions scheme;
    scheme.scheme = limitcl::Scheme::catmull_clark;
    scheme.lambda = lambda;
    return scheme;
}

/// Limit points of a control mesh that is refined once more.
std::vector<double> surface_points(const limitcl::Context& context, const limitcl::Mesh& control) {
    const limitcl::Mesh fine = limitcl::refine(control, 1, catmull_clark(0));
    return limitcl::LimitOperator(context, fine, catmull_clark(0)).limit_points(fine.points());
}

double farthest_from_torus(const std::vector<double>& points) {
    double farthest = 0;
    for (std::size_t i = 0; i < points.size(); i += 3)
        farthest = std::max(farthest, std::abs(std::hypot(std::hypot(points[i], points[i + 1]) - ring, points[i + 2]) - tube));
    return farthest;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const limitcl::Context context;
        if (argc == 3) {
            const limitcl::Mesh mesh = limitcl::read_mesh_with_normals(argv[1]);
            limitcl::TwoPhaseOptions options;
            options.normals = mesh.file_normals();
            std::replace_if(
                options.normals.begin(), options.normals.end(), [](double value) { return std::isnan(value); }, 0.0);
            options.skip_normals = true;
            limitcl::write_mesh(interpolate_two_phase(limitcl::LimitOperator(context, mesh, catmull_clark(1.0 / 3)), mesh, options).mesh, argv[2]);
            return 0;
        }
        const Torus torus(10, 6);
        const limitcl::Mesh mesh = limitcl::Mesh::from_uniform_faces(torus.points, 4, torus.quads);
        const limitcl::LimitOperator A(context, mesh, catmull_clark(1.0 / 3));
        double errors[4], worst_vertex = 0;
        limitcl::TwoPhaseOptions options;
        for (int step = 0; step < 4; ++step) {
            if (step == 1) options.normals = torus.normals;
            if (step == 2) options.fair = 10;
            if (step == 3) options.convex_handle = options.other_handle = 0.5;
            const limitcl::TwoPhaseMesh refined = interpolate_two_phase(A, mesh, options);
            errors[step] = farthest_from_torus(surface_points(context, refined.mesh));
            worst_vertex = std::max(worst_vertex, refined.report.max_error);
            const char* const names[] = {"points alone", "with normals", "and fair", "and small handles"};
            std::printf("%-18s %5d vertices, %2d normals: at most %.3f from the torus\n", names[step], refined.mesh.vertex_count(), refined.report.normal_count,
                        errors[step]);
        }
        std::printf("every vertex is met within %.1e\n", worst_vertex);
        return worst_vertex <= 1e-14 && errors[2] < errors[0] ? 0 : 1;
    } catch (const limitcl::Error& error) {
        std::fprintf(stderr, "%s: %s\n", error.status_name(), error.what());
        return 1;
    }
}
