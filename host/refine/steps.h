// SPDX-License-Identifier: BSD-3-Clause
// One refinement step per scheme: connectivity, rows and, for Doo-Sabin, where things went. Internal to host/refine and host/evaluate.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "host/refine/child_topology.h"
#include "host/refine/refine.h"
#include "host/refine/rows.h"

namespace lcl {

/// What a step refines.
struct StepInput {
    const Topology& topology;
    const Features& features;
    const SchemeOptions& options;
};

/// InvalidArgument or BadInput where options and mesh do not fit.
void check_options(const StepInput& input);
/// InvalidArgument for less than 0.
void check_levels(int levels);

/// The faces of a refined mesh while they are made.
class FaceList {
public:
    FaceList(PolygonMesh& mesh, std::vector<Index>& parents, std::int64_t faces, std::int64_t corners);
    void add(std::initializer_list<Index> vertices, Index parent);
    void push(Index vertex) { mesh_.face_vertices.push_back(vertex); }
    void close(Index parent);

private:
    PolygonMesh& mesh_;
    std::vector<Index>& parents_;
};

/// Whether the vertex rule of smooth vertices is that of a vertex of this kind.
inline bool has_smooth_rule(VertexKind kind) { return kind == VertexKind::smooth || kind == VertexKind::dart; }

void catmull_clark_rows(const StepInput& input, StencilRows& rows);
/// The rows that sharp edges and corners rule, and isolated vertices: all but those of smooth vertices (darts too), smooth edges and faces.
void catmull_clark_odd_rows(const StepInput& input, SummedRows& rows);

/// BadInput names the first face that is no triangle.
void check_triangles(const Topology& topology);
void loop_rows(const StepInput& input, StencilRows& rows);
void loop_odd_rows(const StepInput& input, SummedRows& rows);

void two_phase_faces(const StepInput& input, Refinement& refined);
void two_phase_rows(const StepInput& input, SummedRows& rows);
void two_phase_rows(const StepInput& input, StencilRows& rows);

/// Numbers of the refined vertices of a Doo-Sabin step.
struct DooSabinLayout {
    /// A sector of a vertex: its faces between two sharp edges, or all of them.
    struct Sector {
        Index vertex;
        Index first;  ///< outgoing half-edge of its first face
        Index kept;   ///< refined number of the corner that it keeps, or -1
        bool closed;  ///< no sharp edge at the vertex
    };
    std::vector<Index> first_point;  ///< edge_count: the first of the two points of the edge's own half-edge; those of its twin follow; -1 where smooth
    std::vector<Sector> sectors;     ///< by vertex, then in face order
    std::vector<Index> isolated;     ///< old numbers
    Index kept_begin = 0, isolated_begin = 0, vertex_count = 0;

    /// The point of half-edge h next to its origin; the one next to its destination follows. Only of sharp edges.
    Index point(const Topology& topology, Index h) const {
        const Index e = topology.half_edge_edge[h];
        return first_point[e] + (topology.edge_half_edge[e] == h ? 0 : 2);
    }
};

/// BadInput where a vertex would get a face of two sides.
DooSabinLayout lay_out_doo_sabin(const Topology& topology, const Features& features);
/// quadrants, if asked for: for each corner of the refined mesh, towards which quarter of its vertex's patch the face lies: 0 (1,1), 1 (1,0), 2 (0,0), 3 (0,1).
void doo_sabin_faces(const StepInput& input, const DooSabinLayout& layout, Refinement& refined, std::vector<std::uint8_t>* quadrants);
void doo_sabin_rows(const StepInput& input, const DooSabinLayout& layout, SummedRows& rows);
void doo_sabin_rows(const StepInput& input, const DooSabinLayout& layout, StencilRows& rows);

/// The layout of a Doo-Sabin step, none of other schemes.
std::optional<DooSabinLayout> layout_of(const StepInput& input);
inline const DooSabinLayout* pointer_to(const std::optional<DooSabinLayout>& layout) { return layout ? &*layout : nullptr; }

/// What a step makes of a topology.
struct Child {
    Topology topology;
    std::vector<Index> face_parent;  ///< refined face -> face, -1 for none; empty where it follows from the number: Catmull-Clark, Loop
};
Child make_child(const StepInput& input, const DooSabinLayout* layout, TopologyPart part);
/// The same with all of it.
std::vector<Index> child_parents(const Topology& parent, Scheme scheme, std::vector<Index> face_parent);
void copy_faces(const Topology& faces, PolygonMesh& mesh);

/// What the refined mesh has to be read with.
FeatureOptions step_features(const StepInput& input, const DooSabinLayout* layout);

/// The rows of all refined vertices.
void write_all_rows(const StepInput& input, const DooSabinLayout* layout, StencilRows& rows);

}  // namespace lcl
