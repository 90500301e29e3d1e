// SPDX-License-Identifier: BSD-3-Clause
// C++17: a sphere with the faces of a given mesh (closed, of genus 0), and the morph from the mesh to it, as Figure 5 of the mesh expansion paper shows.
// usage: spherical_relaxation [MESH SPHERE]    without arguments for a star that comes with the project, and nothing is written
#include "sphere_relaxation.hpp"

#include <limitcl/limitcl.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

using Eigen::Matrix3Xd;

constexpr int tries = 10, sweeps = 100, frames = 10;

PolyMesh to_openmesh(const limitcl::Mesh& mesh) {
    std::vector<std::int32_t> offsets = {0};
    for (const std::int32_t degree : mesh.face_degrees()) offsets.push_back(offsets.back() + degree);
    return limitcl::to_openmesh<OpenMesh::DefaultTraitsDouble>(offsets, mesh.face_vertices(), mesh.points());
}

// Points on the unit sphere without a flipped face, relaxed.
Matrix3Xd make_sphere(const PolyMesh& mesh, const Matrix3Xd& shape) {
    const Eigen::VectorXd weights = area_weights(mesh, shape);
    OpenMesh::FaceHandle rim(0);
    for (int i = 1; i <= tries; ++i) {
        Matrix3Xd at = sphere_embedding(mesh, rim, weights);
        rim = largest_face(mesh, at);
        if (count_flipped(mesh, at) > 0) continue;
        const double largest = face_mean(mesh, at, rim).area;
        relax(mesh, at, sweeps);
        std::printf("no face is flipped at try %d, and %d after relaxation; area of the largest face %.1e before, %.1e after\n", i, count_flipped(mesh, at),
                    largest, face_mean(mesh, at, largest_face(mesh, at)).area);
        return at;
    }
    throw limitcl::Error(LCL_ERROR_UNSUPPORTED, "faces stay flipped: the mesh is not 3-connected, or its faces crowd too much for doubles");
}

// Turns the sphere to the shape (least squares), gives it the shape's volume and the side that its faces look to, and puts it where the shape is.
void place_sphere(const limitcl::Mesh& mesh, const Matrix3Xd& shape, Matrix3Xd& at) {
    const double volume = limitcl::volume(mesh);
    if (volume < 0) at = -at;
    const Eigen::Matrix3d rotation = Eigen::umeyama(at, shape, false).topLeftCorner<3, 3>();
    at = std::cbrt(3 * std::abs(volume) / (4 * EIGEN_PI)) * rotation * at;
    at.colwise() += shape.rowwise().mean();
}

// Morphs in even steps and tells whether all frames came, finite, each nearer to the sphere than the last, and the sphere itself at the end.
bool morph(const limitcl::Mesh& mesh, const Matrix3Xd& sphere) {
    const limitcl::Context context;
    const limitcl::LimitOperator A(context, mesh);
    limitcl::MorphOptions options;
    options.path = limitcl::MorphPath::even;
    options.frames = frames;
    std::vector<double> distances;  // to the sphere, root mean square
    limitcl::morph(A, mesh.points(), {sphere.data(), static_cast<std::size_t>(sphere.size())}, 3, options, [&](int, double* points) {
        distances.push_back((Eigen::Map<Matrix3Xd>(points, 3, sphere.cols()) - sphere).norm() / std::sqrt(static_cast<double>(sphere.cols())));
        return true;
    });
    std::printf("distance to the sphere, frame by frame:");
    for (const double distance : distances) std::printf(" %.3g", distance);
    std::printf("\n");
    const auto not_nearer = [](double distance, double next) { return !(next < distance); };  // also what is not a number
    return distances.size() == frames + 1 && std::adjacent_find(distances.begin(), distances.end(), not_nearer) == distances.end() &&
           distances.back() <= 1e-9 * distances.front();
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const limitcl::Mesh mesh = limitcl::read_mesh(argc == 3 ? argv[1] : LIMITCL_STAR);
        mesh.validate();
        const limitcl::MeshInfo info = mesh.info();
        if (info.components != 1 || info.isolated_vertices > 0 || info.boundary_edges > 0 || info.vertices - info.edges + info.faces != 2)
            throw limitcl::Error(LCL_ERROR_UNSUPPORTED, "only a closed mesh of genus 0 in one piece has the faces of a sphere");
        const PolyMesh open_mesh = to_openmesh(mesh);
        const std::vector<double> points = mesh.points();
        const Matrix3Xd shape = Eigen::Map<const Matrix3Xd>(points.data(), 3, mesh.vertex_count());
        Matrix3Xd sphere = make_sphere(open_mesh, shape);
        const bool round = count_flipped(open_mesh, sphere) == 0 && (sphere.colwise().norm().array() - 1).abs().maxCoeff() <= 1e-12;
        place_sphere(mesh, shape, sphere);
        if (argc == 3) {
            limitcl::Mesh result = mesh.copy();
            result.set_points(std::vector<double>(sphere.data(), sphere.data() + sphere.size()));
            limitcl::write_mesh(result, argv[2]);
        }
        return morph(mesh, sphere) && round ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
