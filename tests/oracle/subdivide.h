// SPDX-License-Identifier: BSD-3-Clause
// Brute-force subdivision of small meshes, the independent proof of masks, topology and refinement: plain loops over std::map, dense weights,
// nothing from the library but its plain data types. Cost grows with the square of the mesh: made for up to a few thousand vertices.
#pragma once

#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "host/mesh/features.h"
#include "host/mesh/polygon_mesh.h"
#include "host/scheme/scheme.h"

namespace oracle {

using Edge = std::pair<int, int>;  // the smaller vertex first
Edge edge_of(int a, int b);

/// Faces with all their sharp features spelt out, so that subdividing needs no options of features.
struct Surface {
    int vertex_count = 0;
    std::vector<std::vector<int>> faces;
    std::set<Edge> sharp;            ///< boundary edges and creases; an edge with one face that is not in here is the rim of a patch cut out of a surface
    std::set<int> corners;           ///< vertices that stay
    bool boundary_is_fixed = false;  ///< points that Doo-Sabin puts on the boundary become corners too
};

/// One refinement. The vertices come in the order of `limitcl refine`: Catmull-Clark and Loop old vertices, edges by first appearance, faces; two-phase old
/// vertices, two points an edge, face corners; Doo-Sabin face corners, two points a sharp half-edge, kept corners, isolated vertices.
struct Step {
    Surface surface;
    Eigen::MatrixXd weights;                         ///< new vertices x old vertices
    std::vector<std::vector<int>> vertex_faces;      ///< Doo-Sabin: the new face (type V) of every sector of an old vertex
    std::map<std::pair<int, int>, int> edge_faces;   ///< Doo-Sabin: the new face (type E) of a sharp half-edge (from, to)
};

/// Spells out boundary, creases, crease angle, corners. std::invalid_argument if a crease is no edge.
Surface make_surface(const lcl::PolygonMesh& mesh, const lcl::FeatureOptions& features = {});

/// Refines once by the rule of the first refinement (alpha, lambda) of `options`. A Doo-Sabin crease is cut open: each side gets boundary points of its own.
Step subdivide(const Surface& surface, const lcl::SchemeOptions& options);

/// What the second and later refinements are made with: alpha 0 and lambda 0.
lcl::SchemeOptions after_first_step(const lcl::SchemeOptions& options);

/// `levels` refinements in one: the last surface, and weights over the first one's vertices.
Step subdivide(const Surface& surface, const lcl::SchemeOptions& options, int levels);

/// Positions as vertex_count x 3, and back to a mesh.
Eigen::MatrixXd positions(const lcl::PolygonMesh& mesh);
lcl::PolygonMesh to_mesh(const Surface& surface, const Eigen::MatrixXd& points);

/// Every face turned so that it begins with its smallest vertex, then sorted: equal for two meshes with the same faces in any order.
std::vector<std::vector<int>> sorted_faces(const lcl::PolygonMesh& mesh);

}  // namespace oracle
