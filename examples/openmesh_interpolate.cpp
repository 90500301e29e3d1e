// SPDX-License-Identifier: BSD-3-Clause
// C++17: the points of an OpenMesh are replaced by control points, so that OpenMesh's own subdividers and decimators can go on from there.
#include <limitcl/limitcl.hpp>
#include <limitcl/openmesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

// A prism over a pentagon: two pentagons and five quads.
PolyMesh make_prism() {
    PolyMesh mesh;
    std::vector<OpenMesh::VertexHandle> low, high;
    const double x[] = {1.0, 0.31, -0.81, -0.81, 0.31}, y[] = {0.0, 0.95, 0.59, -0.59, -0.95};
    for (int i = 0; i < 5; ++i) {
        low.push_back(mesh.add_vertex({x[i], y[i], 0.0}));
        high.push_back(mesh.add_vertex({x[i], y[i], 1.5}));
    }
    for (std::size_t i = 0, next = 1; i < 5; ++i, next = (i + 1) % 5)
        mesh.add_face(std::vector<OpenMesh::VertexHandle>{low[i], low[next], high[next], high[i]});
    mesh.add_face(high);
    std::reverse(low.begin(), low.end());
    mesh.add_face(low);
    return mesh;
}

limitcl::Mesh to_limitcl(const PolyMesh& open_mesh) {
    const limitcl::OpenMeshArrays arrays = limitcl::from_openmesh(open_mesh);
    std::vector<std::int32_t> degrees;
    for (std::size_t f = 0; f + 1 < arrays.face_offsets.size(); ++f) degrees.push_back(arrays.face_offsets[f + 1] - arrays.face_offsets[f]);
    return limitcl::Mesh::from_faces(arrays.positions, degrees, arrays.face_vertices);
}

}  // namespace

int main() {
    try {
        PolyMesh open_mesh = make_prism();
        const limitcl::Mesh mesh = to_limitcl(open_mesh);
        const limitcl::Context context;
        limitcl::SchemeOptions scheme;  // every vertex has three edges: at alpha 0 this is nearly singular, and alpha_auto takes 0.5
        scheme.alpha_auto = true;
        const limitcl::LimitOperator A(context, mesh, scheme);
        const limitcl::Interpolation result = limitcl::interpolate(A, mesh.points());
        result.report.require_ok();
        std::printf("alpha %.1f, %d iterations, max_error %.1e\n", A.scheme().alpha, result.report.iterations, result.report.max_error);

        for (const OpenMesh::VertexHandle v : open_mesh.vertices()) {
            const double* p = &result.points[3 * static_cast<std::size_t>(v.idx())];
            open_mesh.set_point(v, {p[0], p[1], p[2]});
        }
        const std::vector<double> limit = A.limit_points(to_limitcl(open_mesh).points()), M = mesh.points();
        double largest = 0;
        for (std::size_t i = 0; i < M.size(); ++i) largest = std::max(largest, std::abs(limit[i] - M[i]));
        std::printf("limit points of the OpenMesh: %.1e from the vertices\n", largest);
        return largest <= 5e-6 * mesh.info().diagonal ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
