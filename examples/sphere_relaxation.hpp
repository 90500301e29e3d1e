// SPDX-License-Identifier: BSD-3-Clause
// Faces on the unit sphere, and relaxation: each vertex goes to the mean of the faces around it, weighted by area, as far as that flips none of them.
// Large faces pull harder, so areas become more even.
#ifndef LIMITCL_EXAMPLES_SPHERE_RELAXATION_HPP
#define LIMITCL_EXAMPLES_SPHERE_RELAXATION_HPP

#include "sphere_embedding.hpp"

#include <algorithm>

/// Whether a face, seen from the centre of the sphere, is turned over or not convex.
inline bool is_flipped(const PolyMesh& mesh, const Eigen::Matrix3Xd& at, OpenMesh::FaceHandle face) {
    for (const auto halfedge : mesh.fh_range(face)) {
        const Eigen::Vector3d b = at.col(mesh.to_vertex_handle(halfedge).idx());
        const Eigen::Vector3d ab = b - at.col(mesh.from_vertex_handle(halfedge).idx());
        const Eigen::Vector3d bc = at.col(mesh.to_vertex_handle(mesh.next_halfedge_handle(halfedge)).idx()) - b;
        if (!(ab.cross(bc).dot(b) > 0)) return true;
    }
    return false;
}

inline int count_flipped(const PolyMesh& mesh, const Eigen::Matrix3Xd& at) {
    int count = 0;
    for (const auto face : mesh.faces()) count += is_flipped(mesh, at, face);
    return count;
}

struct FaceMean {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of the corners
    double area = 0;
};

inline FaceMean face_mean(const PolyMesh& mesh, const Eigen::Matrix3Xd& at, OpenMesh::FaceHandle face) {
    FaceMean mean;
    for (const auto vertex : mesh.fv_range(face)) mean.centre += at.col(vertex.idx()) / mesh.valence(face);
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (const auto halfedge : mesh.fh_range(face))
        area += (at.col(mesh.from_vertex_handle(halfedge).idx()) - mean.centre).cross(at.col(mesh.to_vertex_handle(halfedge).idx()) - mean.centre) / 2;
    mean.area = area.norm();
    return mean;
}

inline OpenMesh::FaceHandle largest_face(const PolyMesh& mesh, const Eigen::Matrix3Xd& at) {
    OpenMesh::FaceHandle largest(0);
    for (const auto face : mesh.faces())
        if (face_mean(mesh, at, face).area > face_mean(mesh, at, largest).area) largest = face;
    return largest;
}

/// Area around each vertex, divided by the sum of all.
inline Eigen::VectorXd area_weights(const PolyMesh& mesh, const Eigen::Matrix3Xd& at) {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(at.cols());
    for (const auto face : mesh.faces())
        for (const auto vertex : mesh.fv_range(face)) weights(vertex.idx()) += face_mean(mesh, at, face).area;
    return weights / weights.sum();
}

inline void relax_vertex(const PolyMesh& mesh, Eigen::Matrix3Xd& at, OpenMesh::VertexHandle vertex) {
    const Eigen::Vector3d start = at.col(vertex.idx());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto face : mesh.vf_range(vertex)) {
        const FaceMean mean = face_mean(mesh, at, face);
        sum += mean.area * mean.centre;
    }
    for (double step = 1.0; step > 0.01; step /= 4) {
        at.col(vertex.idx()) = (start + step * (sum.normalized() - start)).normalized();
        const auto faces = mesh.vf_range(vertex);
        if (std::none_of(faces.begin(), faces.end(), [&](OpenMesh::FaceHandle face) { return is_flipped(mesh, at, face); })) return;
    }
    at.col(vertex.idx()) = start;
}

inline void relax(const PolyMesh& mesh, Eigen::Matrix3Xd& at, int sweeps) {
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (const auto vertex : mesh.vertices()) relax_vertex(mesh, at, vertex);
}

#endif
