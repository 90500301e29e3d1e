// SPDX-License-Identifier: BSD-3-Clause
// Half-edge topology as flat integer arrays, built in linear time, and the checks of input that it stands on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/array.h"
#include "host/mesh/polygon_mesh.h"

namespace lcl {

/// Half-edge h is corner h of the mesh: it runs from face_vertices[h] to the next corner of its face. No half-edge: -1.
/// Edges are numbered by first appearance walking the faces, as refined edge points are.
struct Topology {
    Index vertex_count = 0;
    Index face_count = 0;
    Index edge_count = 0;
    Index boundary_edge_count = 0;
    Index uniform_degree = 0;        ///< of all faces; 0 where they differ
    Array<Index> face_offsets;       ///< face_count + 1
    Array<Index> face_vertices;      ///< origin of each half-edge
    Array<Index> half_edge_face;     ///< face of each half-edge
    Array<Index> twin;               ///< opposite half-edge, -1 at a boundary
    Array<Index> half_edge_edge;     ///< edge of each half-edge
    Array<Index> edge_half_edge;     ///< edge_count: the half-edge in which the edge appeared first
    Array<Index> vertex_half_edge;   ///< vertex_count: an outgoing half-edge, -1 if isolated; at a boundary the one without twin
    Array<Index> vertex_face_count;  ///< vertex_count: number of faces round the vertex (n of the formulas)
    Array<Index> fan_offsets;        ///< vertex_count + 1
    Array<Index> fan_half_edges;     ///< the outgoing half-edges of each vertex in face order, from vertex_half_edge on: what rotate() gives, without the walk

    Index half_edge_count() const { return static_cast<Index>(face_vertices.size()); }
    Index degree(Index face) const { return face_offsets[face + 1] - face_offsets[face]; }
    Index next(Index h) const {
        const Index f = half_edge_face[h];
        return h + 1 < face_offsets[f + 1] ? h + 1 : face_offsets[f];
    }
    Index previous(Index h) const {
        const Index f = half_edge_face[h];
        return h > face_offsets[f] ? h - 1 : face_offsets[f + 1] - 1;
    }
    Index origin(Index h) const { return face_vertices[h]; }
    Index destination(Index h) const { return face_vertices[next(h)]; }
    /// The next outgoing half-edge round the origin of h in face order (counter-clockwise), -1 past the last face of a boundary vertex.
    Index rotate(Index h) const { return twin[previous(h)]; }
    bool is_isolated(Index v) const { return vertex_half_edge[v] < 0; }
    bool is_boundary(Index v) const { return vertex_half_edge[v] >= 0 && twin[vertex_half_edge[v]] < 0; }
    bool is_closed() const { return boundary_edge_count == 0; }
    bool is_boundary_edge(Index e) const { return twin[edge_half_edge[e]] < 0; }
    /// Number of edges at v: vertex_face_count[v], one more at a boundary.
    Index valence(Index v) const { return vertex_face_count[v] + (is_boundary(v) ? 1 : 0); }
};

enum class DefectKind {
    index_range,
    repeated_vertex,
    short_face,
    edge_with_three_faces,
    non_manifold_vertex,
    orientation,
    not_finite,
    zero_area  ///< listed only, no ground for refusal
};

/// "index-range", "repeated-vertex", ...: the names that reports use.
const char* defect_name(DefectKind kind);

/// One kind of defect with the first ten places and the number of all.
struct Defect {
    DefectKind kind;
    Index count;
    Where where;
    std::string message;  ///< one sentence: what, where, what to do ("face 12 uses vertex 905, the mesh has 900 ...")
};

/// All defects of a mesh, the refused kinds first. Linear time; never throws on bad data.
std::vector<Defect> find_defects(const PolygonMesh& mesh);

/// The same where build_topology went well: faces without area.
std::vector<Defect> find_defects_of_sound_mesh(const PolygonMesh& mesh);

/// Builds the topology. Throws BadInput with the first refused defect (find_defects' order), or OutOfMemory above 2^31 - 1 of anything.
/// A mesh without faces is BadInput. Isolated vertices are allowed.
Topology build_topology(const PolygonMesh& mesh);

/// The topology of a mesh that build_topology takes, or none.
std::optional<Topology> topology_if_sound(const PolygonMesh& mesh);

/// Every coordinate is finite.
bool positions_are_finite(const PolygonMesh& mesh);

/// The boundary loops, each as its outgoing boundary half-edges in order.
std::vector<std::vector<Index>> boundary_loops(const Topology& topology);

/// Connected component of each vertex by shared faces, numbered by their smallest vertex; isolated vertices have -1. `count` receives their number.
std::vector<Index> connected_components(const Topology& topology, Index& count);

/// Diagonal of the bounding box of the vertices that a face uses, corners without a vertex left out; 0 for a mesh without faces.
double bounding_box_diagonal(const PolygonMesh& mesh);
/// The same for a mesh whose topology is known, in a fraction of the time.
double bounding_box_diagonal(const PolygonMesh& mesh, const Topology& topology);

}  // namespace lcl
