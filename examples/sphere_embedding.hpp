// SPDX-License-Identifier: BSD-3-Clause
// A place on the unit sphere for every vertex of a closed mesh of genus 0, so that no face is flipped.
// Flat first (Tutte 1963): one face is the rim and every other vertex lies at the mean of its neighbours, so that all faces are convex. Heights then make it a
// convex polyhedron (Maxwell, Cremona), near to a paraboloid. A projective map takes the paraboloid to the sphere and keeps polyhedra convex, and seen from
// inside none of their faces is flipped. This is exact for 3-connected meshes, as all of triangles are, with a triangle for a rim (one of more sides may bend);
// rounding, where many vertices crowd, and bent rims are mended by another rim, best the largest face of the first sphere.
#ifndef LIMITCL_EXAMPLES_SPHERE_EMBEDDING_HPP
#define LIMITCL_EXAMPLES_SPHERE_EMBEDDING_HPP

#include <limitcl/openmesh.hpp>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <queue>

using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// The flat mesh: x, y of every vertex, the rim on the unit circle, its corners clockwise.
inline Eigen::Matrix2Xd tutte_embedding(const PolyMesh& mesh, OpenMesh::FaceHandle rim) {
    Eigen::Matrix2Xd at = Eigen::Matrix2Xd::Zero(2, static_cast<int>(mesh.n_vertices()));
    std::vector<int> unknown(mesh.n_vertices(), 0);  // its number, -1 at the rim
    int corner = 0, count = 0;
    for (const auto vertex : mesh.fv_range(rim)) {
        const double angle = -2 * EIGEN_PI * corner++ / mesh.valence(rim);
        at.col(vertex.idx()) << std::cos(angle), std::sin(angle);
        unknown[static_cast<std::size_t>(vertex.idx())] = -1;
    }
    for (int& number : unknown)
        if (number == 0) number = count++;

    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(count, 2);
    for (const auto vertex : mesh.vertices()) {
        const int i = unknown[static_cast<std::size_t>(vertex.idx())];
        if (i < 0) continue;
        entries.emplace_back(i, i, mesh.valence(vertex));
        for (const auto neighbour : mesh.vv_range(vertex)) {
            const int j = unknown[static_cast<std::size_t>(neighbour.idx())];
            if (j >= 0) entries.emplace_back(i, j, -1.0);
            right.row(i) += at.col(neighbour.idx()).transpose();  // 0 where it is unknown
        }
    }
    Eigen::SparseMatrix<double> laplacian(count, count);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    const Eigen::MatrixX2d solution = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(laplacian).solve(right);
    for (std::size_t v = 0; v < unknown.size(); ++v)
        if (unknown[v] >= 0) at.col(static_cast<int>(v)) = solution.row(unknown[v]).transpose();
    return at;
}

/// Heights that make the flat mesh a convex polyhedron, 0 on the face nearest to the origin: from a face to the next one the slope changes by their edge,
/// turned by a right angle, which closes around a vertex because it is at the mean of its neighbours.
inline Eigen::RowVectorXd maxwell_heights(const PolyMesh& mesh, OpenMesh::FaceHandle rim, const Eigen::Matrix2Xd& at) {
    OpenMesh::FaceHandle first;
    double nearest = 0;
    for (const auto face : mesh.faces()) {
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        for (const auto vertex : mesh.fv_range(face)) sum += at.col(vertex.idx());
        const double distance = sum.norm() / mesh.valence(face);
        if (face != rim && (!first.is_valid() || distance < nearest)) nearest = distance, first = face;
    }
    Eigen::RowVectorXd height = Eigen::RowVectorXd::Constant(at.cols(), -1.0);  // not known yet
    for (const auto vertex : mesh.fv_range(first)) height(vertex.idx()) = 0.0;
    std::vector<Eigen::Vector2d> slope(mesh.n_faces(), Eigen::Vector2d::Zero());
    std::vector<bool> seen(mesh.n_faces(), false);
    seen[static_cast<std::size_t>(first.idx())] = seen[static_cast<std::size_t>(rim.idx())] = true;
    std::queue<OpenMesh::FaceHandle> queue({first});
    for (; !queue.empty(); queue.pop())
        for (const auto halfedge : mesh.fh_range(queue.front())) {
            const auto next = mesh.opposite_face_handle(halfedge);
            const std::size_t f = static_cast<std::size_t>(next.idx());
            if (seen[f]) continue;
            const int from = mesh.from_vertex_handle(halfedge).idx();
            const Eigen::Vector2d edge = at.col(mesh.to_vertex_handle(halfedge).idx()) - at.col(from);
            slope[f] = slope[static_cast<std::size_t>(queue.front().idx())] + Eigen::Vector2d(edge.y(), -edge.x());
            for (const auto vertex : mesh.fv_range(next))
                if (height(vertex.idx()) < 0) height(vertex.idx()) = std::max(0.0, height(from) + slope[f].dot(at.col(vertex.idx()) - at.col(from)));
            seen[f] = true;
            queue.push(next);
        }
    return height;
}

/// Points on the unit sphere, one column a vertex. weights: one a vertex, sum 1; about half of it comes to either side of the equator.
inline Eigen::Matrix3Xd sphere_embedding(const PolyMesh& mesh, OpenMesh::FaceHandle rim, const Eigen::VectorXd& weights) {
    Eigen::Matrix2Xd flat = tutte_embedding(mesh, rim);
    flat.colwise() -= (flat * weights).eval();
    Eigen::RowVectorXd height = maxwell_heights(mesh, rim, flat);
    flat /= flat.colwise().norm() * weights;
    height /= std::pow(height.cwiseSqrt() * weights, 2);
    Eigen::Matrix3Xd points(3, flat.cols());
    for (int v = 0; v < points.cols(); ++v) points.col(v) = Eigen::Vector3d(2 * flat(0, v), 2 * flat(1, v), 1 - height(v)) / (1 + height(v));
    points.colwise() -= (points * weights).eval();  // a mean of a polyhedron's vertices is inside
    points.colwise().normalize();
    return points;
}

#endif
