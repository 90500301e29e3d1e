// SPDX-License-Identifier: BSD-3-Clause
// C++17: three smooth surfaces through the same five vertices, after Figure 1 of the mesh expansion paper: the butterfly scheme, the modified butterfly scheme
// (Zorin, Schroeder, Sweldens 1996) as OpenMesh has it, and limitcl. The first two place new vertices by a local rule and never move them again.
// usage: compare_butterfly [BUTTERFLY MODIFIED_BUTTERFLY LIMITCL]    names of the meshes that are written, into the current folder by default
#include "butterfly.hpp"

#include <limitcl/openmesh.hpp>

#include <OpenMesh/Tools/Subdivider/Uniform/ModifiedButterFlyT.hh>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace {

constexpr int levels = 5;
constexpr double pi = 3.141592653589793;

using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

PolyMesh to_openmesh(const limitcl::Mesh& mesh) {
    std::vector<std::int32_t> offsets;
    for (std::int32_t f = 0; f <= mesh.face_count(); ++f) offsets.push_back(3 * f);
    return limitcl::to_openmesh<OpenMesh::DefaultTraitsDouble>(offsets, mesh.face_vertices(), mesh.points());
}

// A triangular bipyramid. Only one closed mesh of triangles has five vertices: a square pyramid whose base is cut in two is the same with other points.
limitcl::Mesh make_bipyramid() {
    const double s = std::sqrt(0.75);
    const std::vector<double> points = {1, 0, 0, -0.5, s, 0, -0.5, -s, 0, 0, 0, 1.2, 0, 0, -1.2};
    return limitcl::Mesh::from_uniform_faces(points, 3, std::vector<std::int32_t>{0, 1, 3, 1, 2, 3, 2, 0, 3, 1, 0, 4, 2, 1, 4, 0, 2, 4});
}

limitcl::Mesh butterfly(limitcl::Mesh mesh) {
    for (int level = 0; level < levels; ++level) mesh = butterfly_step(mesh);
    return mesh;
}

limitcl::Mesh modified_butterfly(const limitcl::Mesh& mesh) {
    PolyMesh fine = to_openmesh(mesh);
    OpenMesh::Subdivider::Uniform::ModifiedButterflyT<PolyMesh> subdivider;
    subdivider.attach(fine);
    subdivider(levels);
    subdivider.detach();
    const limitcl::OpenMeshArrays arrays = limitcl::from_openmesh(fine);
    return limitcl::Mesh::from_uniform_faces(arrays.positions, 3, arrays.face_vertices);
}

// The control mesh of the Loop surface through the vertices, refined as often, with each vertex at its limit point.
limitcl::Mesh interpolate(const limitcl::Context& context, const limitcl::Mesh& mesh) {
    limitcl::Mesh control = mesh.copy();
    limitcl::interpolate(limitcl::LimitOperator(context, mesh), control).require_ok();
    limitcl::Mesh fine = limitcl::refine(control, levels);
    fine.set_points(limitcl::LimitOperator(context, fine).limit_points(fine.points()));
    return fine;
}

// The largest distance of a vertex of `mesh` to the nearest one of `fine`.
double distance(const limitcl::Mesh& mesh, const limitcl::Mesh& fine) {
    const std::vector<double> from = mesh.points(), to = fine.points();
    double largest = 0;
    for (std::size_t i = 0; i < from.size(); i += 3) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < to.size(); j += 3)
            nearest = std::min(nearest, std::hypot(from[i] - to[j], from[i + 1] - to[j + 1], from[i + 2] - to[j + 2]));
        largest = std::max(largest, nearest);
    }
    return largest;
}

struct Shape {
    double kink = 0;    // largest angle between the normals of two neighbouring triangles, degrees; tends to 0 where there are tangent planes
    double saddle = 0;  // integral of the negative Gaussian curvature / 4 pi, by angle defects; 0 for a convex shape, as the five vertices are
};

Shape measure(const limitcl::Mesh& mesh) {
    const PolyMesh open_mesh = to_openmesh(mesh);
    Shape shape;
    for (const auto edge : open_mesh.edges()) shape.kink = std::max(shape.kink, std::abs(open_mesh.calc_dihedral_angle(edge)) * 180 / pi);
    for (const auto vertex : open_mesh.vertices()) {
        double defect = 2 * pi;
        for (const auto halfedge : open_mesh.vih_range(vertex)) defect -= open_mesh.calc_sector_angle(halfedge);
        shape.saddle += std::max(0.0, -defect) / (4 * pi);
    }
    return shape;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const limitcl::Mesh mesh = make_bipyramid();
        const limitcl::Mesh fine[] = {butterfly(mesh), modified_butterfly(mesh), interpolate(limitcl::Context(), mesh)};
        const char* const names[] = {"butterfly", "modified butterfly", "limitcl, Loop"};
        const char* const files[] = {"butterfly.obj", "modified_butterfly.obj", "limitcl.obj"};
        Shape shapes[3];
        bool through = true;
        for (int i = 0; i < 3; ++i) {
            const double missed = distance(mesh, fine[i]);
            through = through && missed <= 5e-6 * mesh.info().diagonal;
            shapes[i] = measure(fine[i]);
            std::printf("%-18s  %d triangles, passes the vertices at %.1e, largest kink %4.1f degrees, saddle curvature %.4f of a sphere's\n", names[i],
                        fine[i].face_count(), missed, shapes[i].kink, shapes[i].saddle);
            limitcl::write_mesh(fine[i], argc == 4 ? argv[i + 1] : files[i]);
        }
        const bool better =
            shapes[2].kink < shapes[1].kink && shapes[1].kink < shapes[0].kink && shapes[2].saddle < shapes[1].saddle && shapes[1].saddle < shapes[0].saddle;
        return through && better ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
