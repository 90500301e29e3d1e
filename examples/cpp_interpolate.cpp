// SPDX-License-Identifier: BSD-3-Clause
// C++17: interpolates a mesh file, or without one an open roof with a crease and a kept corner, and tells how it went.
// usage: cpp_interpolate [MESH CONTROL_MESH]
#include <limitcl/limitcl.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

// 5 x 5 vertices over a square: two vaults that meet in a ridge along the middle line x = 2.
limitcl::Mesh make_roof() {
    const int n = 5;
    std::vector<double> points;
    std::vector<std::int32_t> quads;
    limitcl::Features features;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const int v = y * n + x;
            points.insert(points.end(), {double(x), double(y), 2.0 - 0.5 * (x % 2 == 1) - 1.5 * (x % 4 == 0) - 0.2 * (y - 2) * (y - 2)});
            if (x + 1 < n && y + 1 < n) quads.insert(quads.end(), {v, v + 1, v + n + 1, v + n});
            if (x == 2 && y + 1 < n) features.creases.insert(features.creases.end(), {v, v + n});
        }
    features.corners = {2, 22};  // the ends of the ridge
    limitcl::Mesh mesh = limitcl::Mesh::from_uniform_faces(points, 4, quads);
    mesh.add_features(features);
    return mesh;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const limitcl::Context context;
        limitcl::Mesh mesh = argc == 3 ? limitcl::read_mesh(argv[1]) : make_roof();
        const std::vector<double> M = mesh.points();
        limitcl::SchemeOptions scheme;
        scheme.alpha_auto = mesh.face_degree_counts().rbegin()->first > 3;  // Catmull-Clark: where alpha 0 is singular, take 0.5
        const limitcl::LimitOperator A(context, mesh, scheme);

        limitcl::SolveOptions options;
        options.certify = true;
        const limitcl::SolveReport report = limitcl::interpolate(A, mesh, options).require_ok();
        std::printf("%s: %d vertices, %d iterations, max_error %.1e, surface within %.1e of the exact one\n", context.device().name.c_str(),
                    mesh.vertex_count(), report.iterations, report.max_error, report.surface_error_bound);
        if (argc == 3) limitcl::write_mesh(mesh, argv[2]);

        const double difference = largest_difference(A.limit_points(mesh.points()), M);
        std::printf("limit points of the control mesh: %.1e from the vertices\n", difference);
        return difference <= 5e-6 * mesh.info().diagonal ? 0 : 1;
    } catch (const limitcl::Error& error) {
        std::fprintf(stderr, "%s: %s\n", error.status_name(), error.what());
        return 1;
    }
}
