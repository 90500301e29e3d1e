// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/steps.h"

#include <string>
#include <utility>

#include "host/mesh/soundness.h"
#include "host/refine/child_topology.h"

namespace lcl {
namespace {

/// Topology of faces that a step has listed, which are sound.
Topology topology_of_faces(const PolygonMesh& mesh, TopologyPart part) {
    Topology topology;
    if (part == TopologyPart::all) {
        connect(mesh, topology);
        return topology;
    }
    topology.vertex_count = mesh.vertex_count;
    topology.face_count = mesh.face_count();
    topology.face_offsets.assign(mesh.face_offsets.begin(), mesh.face_offsets.end());
    topology.face_vertices.assign(mesh.face_vertices.begin(), mesh.face_vertices.end());
    return topology;
}

/// What the corners of a refined mesh need to be found again.
FeatureOptions refined_boundary(const StepInput& input) {
    const Topology& topology = input.topology;
    FeatureOptions refined;
    std::vector<std::uint8_t> sharp_edges(topology.vertex_count, 0);
    for (Index e = 0; e < topology.edge_count; ++e) {
        if (!input.features.edge_is_sharp[e]) continue;
        const Index h = topology.edge_half_edge[e];
        for (const Index v : {topology.origin(h), topology.destination(h)}) sharp_edges[v] += sharp_edges[v] < 3;
    }
    // Under edge_and_corner a vertex with one face would become a corner: if one is none, the rule must be edge_only.
    const auto has_one_face = [&](Index v) { return topology.is_boundary(v) && topology.vertex_face_count[v] == 1; };
    for (Index v = 0; v < topology.vertex_count; ++v)
        if (has_one_face(v) && input.features.kind[v] != VertexKind::corner) refined.boundary = BoundaryRule::edge_only;
    for (Index v = 0; v < topology.vertex_count; ++v) {
        const bool found_again = sharp_edges[v] > 2 || (has_one_face(v) && refined.boundary == BoundaryRule::edge_and_corner);
        if (input.features.kind[v] == VertexKind::corner && !found_again) refined.corners.push_back(v);
    }
    return refined;
}

/// Catmull-Clark, Loop and two-phase: old vertices keep their numbers, a crease follows the points of its edge.
FeatureOptions refined_features(const StepInput& input, int points_per_edge) {
    const Topology& topology = input.topology;
    FeatureOptions refined = refined_boundary(input);
    for (Index e = 0; e < topology.edge_count; ++e) {
        if (!input.features.edge_is_sharp[e] || topology.is_boundary_edge(e)) continue;
        Index before = topology.origin(topology.edge_half_edge[e]);
        for (int i = 0; i < points_per_edge; ++i) {
            const Index point = topology.vertex_count + points_per_edge * e + i;
            refined.creases.push_back({before, point});
            before = point;
        }
        refined.creases.push_back({before, topology.destination(topology.edge_half_edge[e])});
    }
    return refined;
}

/// Doo-Sabin: creases have become boundaries, kept corners are their only vertices with one face; fans keep corners that must be named.
FeatureOptions refined_doo_sabin_features(const DooSabinLayout& layout) {
    FeatureOptions refined;
    for (const auto& sector : layout.sectors)
        if (sector.closed && sector.kept >= 0) refined.corners.push_back(sector.kept);
    return refined;
}

}  // namespace

void check_levels(int levels) {
    if (levels < 0) throw InvalidArgument("the number of refinement levels is " + std::to_string(levels) + ": it must be 0 or more");
}

void check_options(const StepInput& input) {
    const SchemeOptions& options = input.options;
    const std::size_t vertices = input.topology.vertex_count;
    if (options.is_two_phase() && options.scheme != Scheme::catmull_clark)
        throw InvalidArgument("a blend ratio lambda needs the catmull-clark scheme: leave lambda out or choose that scheme");
    if (!options.lambda_per_vertex.empty() && options.lambda_per_vertex.size() != vertices)
        throw InvalidArgument("there are " + std::to_string(options.lambda_per_vertex.size()) + " blend ratios for " + std::to_string(vertices) +
                              " vertices: give one for each vertex");
    if (options.scheme == Scheme::loop) check_triangles(input.topology);
}

std::optional<DooSabinLayout> layout_of(const StepInput& input) {
    if (input.options.scheme != Scheme::doo_sabin) return std::nullopt;
    return lay_out_doo_sabin(input.topology, input.features);
}

Child make_child(const StepInput& input, const DooSabinLayout* layout, TopologyPart part) {
    Child child;
    if (layout == nullptr && !input.options.is_two_phase()) {
        const bool is_loop = input.options.scheme == Scheme::loop;
        child.topology = is_loop ? loop_topology(input.topology, part) : catmull_clark_topology(input.topology, part);
        return child;
    }
    Refinement refined;
    layout ? doo_sabin_faces(input, *layout, refined, nullptr) : two_phase_faces(input, refined);
    child.topology = topology_of_faces(refined.mesh, part);
    child.face_parent = std::move(refined.face_parent);
    return child;
}

std::vector<Index> child_parents(const Topology& parent, Scheme scheme, std::vector<Index> face_parent) {
    if (!face_parent.empty()) return face_parent;
    if (scheme != Scheme::loop) return {parent.half_edge_face.begin(), parent.half_edge_face.end()};
    face_parent.resize(4 * static_cast<std::size_t>(parent.face_count));
    for (Index f = 0; f < 4 * parent.face_count; ++f) face_parent[f] = f / 4;
    return face_parent;
}

void copy_faces(const Topology& faces, PolygonMesh& mesh) {
    mesh.vertex_count = faces.vertex_count;
    mesh.face_vertices.assign(faces.face_vertices.begin(), faces.face_vertices.end());
    mesh.face_offsets.resize(static_cast<std::size_t>(faces.face_count) + 1);
    for (Index f = 0; f <= faces.face_count; ++f) mesh.face_offsets[f] = faces.uniform_degree > 0 ? faces.uniform_degree * f : faces.face_offsets[f];
}

void write_all_rows(const StepInput& input, const DooSabinLayout* layout, StencilRows& rows) {
    if (layout) doo_sabin_rows(input, *layout, rows);
    else if (input.options.scheme == Scheme::loop) loop_rows(input, rows);
    else if (input.options.is_two_phase()) two_phase_rows(input, rows);
    else catmull_clark_rows(input, rows);
}

FeatureOptions step_features(const StepInput& input, const DooSabinLayout* layout) {
    return layout ? refined_doo_sabin_features(*layout) : refined_features(input, input.options.is_two_phase() ? 2 : 1);
}

FaceList::FaceList(PolygonMesh& mesh, std::vector<Index>& parents, std::int64_t faces, std::int64_t corners) : mesh_(mesh), parents_(parents) {
    mesh.face_offsets.reserve(faces + 1);
    mesh.face_vertices.reserve(corners);
    parents.reserve(faces);
}

void FaceList::add(std::initializer_list<Index> vertices, Index parent) {
    for (const Index v : vertices) push(v);
    close(parent);
}

void FaceList::close(Index parent) {
    mesh_.face_offsets.push_back(static_cast<Index>(mesh_.face_vertices.size()));
    parents_.push_back(parent);
}

}  // namespace lcl
