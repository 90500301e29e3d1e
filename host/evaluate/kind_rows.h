// SPDX-License-Identifier: BSD-3-Clause
// The matrices of a kind out of one refinement of a small mesh whose vertices are the kind's control points. Internal to host/evaluate.
#pragma once

#include <vector>

#include <Eigen/Dense>

#include "host/mesh/polygon_mesh.h"
#include "host/refine/refine.h"

namespace lcl {

/// A mesh by its faces alone: all its points lie at the origin, since rows of stencils are all that is wanted of it.
class LocalMesh {
public:
    explicit LocalMesh(int vertex_count) {
        mesh_.vertex_count = vertex_count;
        mesh_.positions.assign(3 * static_cast<std::size_t>(vertex_count), 0.0);
    }
    void add(const std::vector<Index>& face) {
        mesh_.face_vertices.insert(mesh_.face_vertices.end(), face.begin(), face.end());
        mesh_.face_offsets.push_back(mesh_.corner_count());
    }
    const PolygonMesh& mesh() const { return mesh_; }

private:
    PolygonMesh mesh_;
};

/// The named rows of stencils over column_count points.
inline Eigen::MatrixXd dense_rows(const Stencils& stencils, const std::vector<Index>& rows, int column_count) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), column_count);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = stencils.offsets[rows[i]]; j < stencils.offsets[rows[i] + 1]; ++j)
            dense(static_cast<Eigen::Index>(i), stencils.indices[j]) += stencils.weights[j];
    return dense;
}

/// The same where numbers from the stencils' rows on are those of ghosts: combinations of such rows.
inline Eigen::MatrixXd rows_with_ghosts(const Stencils& stencils, const Stencils& ghosts, const std::vector<Index>& rows, int column_count) {
    const Index point_count = static_cast<Index>(stencils.offsets.size()) - 1;
    Eigen::MatrixXd dense(static_cast<Eigen::Index>(rows.size()), column_count);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        if (rows[i] < point_count) {
            dense.row(row) = dense_rows(stencils, {rows[i]}, column_count);
            continue;
        }
        dense.row(row).setZero();
        const Index ghost = rows[i] - point_count;
        for (std::size_t j = ghosts.offsets[ghost]; j < ghosts.offsets[ghost + 1]; ++j)
            dense.row(row) += ghosts.weights[j] * dense_rows(stencils, {ghosts.indices[j]}, column_count);
    }
    return dense;
}

}  // namespace lcl
