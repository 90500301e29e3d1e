// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/refine.h"

#include <unistd.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "host/refine/locations.h"
#include "host/refine/steps.h"

namespace lcl {
namespace {

constexpr std::int64_t index_limit = std::numeric_limits<Index>::max();

/// Numbers of a mesh, in 64 bits: refined ones are foretold before anything is built.
struct MeshCounts {
    std::int64_t vertices = 0, edges = 0, faces = 0, corners = 0, isolated = 0;
    // Doo-Sabin only: half-edges of sharp edges, corners that are kept (one a sector), vertex-faces, and faces round corners without sharp edges.
    std::int64_t sharp = 0, kept = 0, sectors = 0, fan_faces = 0, fans = 0;
};

MeshCounts count(const Topology& topology) {
    MeshCounts counts;
    counts.vertices = topology.vertex_count;
    counts.edges = topology.edge_count;
    counts.faces = topology.face_count;
    counts.corners = topology.half_edge_count();
    return counts;
}

MeshCounts count_doo_sabin(const Topology& topology, const DooSabinLayout& layout) {
    MeshCounts counts = count(topology);
    for (Index e = 0; e < topology.edge_count; ++e)
        if (layout.first_point[e] >= 0) counts.sharp += topology.is_boundary_edge(e) ? 1 : 2;
    counts.isolated = static_cast<std::int64_t>(layout.isolated.size());
    counts.sectors = static_cast<std::int64_t>(layout.sectors.size());
    for (const auto& sector : layout.sectors) {
        if (sector.kept < 0) continue;
        ++counts.kept;
        if (!sector.closed) continue;
        ++counts.fans;
        counts.fan_faces += topology.vertex_face_count[sector.vertex];
    }
    return counts;
}

MeshCounts refined_doo_sabin(const MeshCounts& old) {
    MeshCounts refined = old;
    const std::int64_t smooth_edges = (old.corners - old.sharp) / 2;
    refined.vertices = old.corners + 2 * old.sharp + old.kept + old.isolated;
    refined.faces = old.faces + smooth_edges + old.sharp + old.sectors - old.fans + old.fan_faces;
    const std::int64_t vertex_face_corners = old.corners + 2 * old.sharp + old.kept - old.fans + 2 * old.fan_faces;
    refined.corners = old.corners + 4 * (smooth_edges + old.sharp) + vertex_face_corners;
    refined.sharp = 2 * old.sharp + (old.kept - old.fans);
    refined.edges = (refined.corners + refined.sharp) / 2;
    refined.sectors = refined.vertices - old.isolated;
    return refined;
}

MeshCounts refined_counts(const MeshCounts& old, Scheme scheme, bool two_phase) {
    if (scheme == Scheme::doo_sabin) return refined_doo_sabin(old);
    MeshCounts refined;
    if (scheme == Scheme::loop) {
        refined = {old.vertices + old.edges, 2 * old.edges + 3 * old.faces, 4 * old.faces, 4 * old.corners};
    } else if (two_phase) {
        refined = {old.vertices + 2 * old.edges + old.corners, 3 * (old.edges + old.corners), old.faces + 2 * old.corners, 9 * old.corners};
    } else {
        refined = {old.vertices + old.edges + old.faces, 2 * old.edges + old.corners, old.corners, 4 * old.corners};
    }
    return refined;
}

/// What a refined mesh holds: positions, faces, parents.
std::int64_t bytes_of(const MeshCounts& counts) { return 24 * counts.vertices + 4 * counts.corners + 8 * counts.faces; }

void check_fits(const MeshCounts& counts, int level) {
    const std::string at = "refinement level " + std::to_string(level) + " would ";
    const std::pair<std::int64_t, const char*> numbers[] = {
        {counts.vertices, " vertices"}, {counts.edges, " edges"}, {counts.faces, " faces"}, {counts.corners, " face corners"}};
    for (const auto& [number, what] : numbers)
        if (number > index_limit)
            throw OutOfMemory(at + "have " + std::to_string(number) + what + ", more than the " + std::to_string(index_limit) +
                              " that can be numbered: use fewer levels");
    if (bytes_of(counts) > physical_memory())
        throw OutOfMemory(at + "take " + std::to_string(bytes_of(counts)) + " bytes, this machine has " + std::to_string(physical_memory()) +
                          ": use fewer levels");
}

/// Stencils repeat the corners of a face for each of its points: the square of the face degrees counts.
void check_stencils_fit(const Topology& topology) {
    std::int64_t entries = 0;
    for (Index f = 0; f < topology.face_count; ++f) entries += 3 * (static_cast<std::int64_t>(topology.degree(f)) * topology.degree(f) + topology.degree(f));
    const std::int64_t bytes = entries * static_cast<std::int64_t>(sizeof(Index) + sizeof(double));
    if (bytes > physical_memory())
        throw OutOfMemory("the stencils of the refinement would take up to " + std::to_string(bytes) + " bytes, this machine has " +
                          std::to_string(physical_memory()) + ": refine a smaller mesh or cut its largest faces");
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

/// Level 0: the features as the original mesh has them, with the creases of the angle named.
FeatureOptions named_features(const Topology& topology, const Features& features, const FeatureOptions& options) {
    FeatureOptions named{options.boundary, {}, options.corners, -1};
    for (Index e = 0; e < topology.edge_count; ++e) {
        const Index h = topology.edge_half_edge[e];
        if (features.edge_is_sharp[e] && topology.twin[h] >= 0) named.creases.push_back({topology.origin(h), topology.destination(h)});
    }
    return named;
}

void check_options(const SchemeOptions& options, const Topology& topology) {
    if (options.is_two_phase() && options.scheme != Scheme::catmull_clark)
        throw InvalidArgument("a blend ratio lambda needs the catmull-clark scheme: leave lambda out or choose that scheme");
    if (!options.lambda_per_vertex.empty() && options.lambda_per_vertex.size() != static_cast<std::size_t>(topology.vertex_count))
        throw InvalidArgument("there are " + std::to_string(options.lambda_per_vertex.size()) + " blend ratios for " + std::to_string(topology.vertex_count) +
                              " vertices: give one for each vertex");
    if (options.scheme == Scheme::loop) check_triangles(topology);
}

/// One step of any scheme with the connectivity and features of its result; rows come separately.
class Step {
public:
    explicit Step(const StepInput& input) : input_(input), two_phase_(input.options.is_two_phase()) {
        check_options(input.options, input.topology);
        if (input.options.scheme == Scheme::doo_sabin) layout_ = lay_out_doo_sabin(input.topology, input.features);
    }

    MeshCounts counts() const { return layout_ ? count_doo_sabin(input_.topology, *layout_) : count(input_.topology); }
    const DooSabinLayout* layout() const { return layout_ ? &*layout_ : nullptr; }

    void make_faces(Refinement& refined, std::vector<std::uint8_t>* quadrants) const {
        if (layout_) {
            doo_sabin_faces(input_, *layout_, refined, quadrants);
            refined.features = refined_doo_sabin_features(*layout_);
            return;
        }
        if (input_.options.scheme == Scheme::loop) loop_faces(input_, refined);
        else if (two_phase_) two_phase_faces(input_, refined);
        else catmull_clark_faces(input_, refined);
        refined.features = refined_features(input_, two_phase_ ? 2 : 1);
    }

    template <class Rows>
    void write_rows(Rows& rows) const {
        if (layout_) doo_sabin_rows(input_, *layout_, rows);
        else if (input_.options.scheme == Scheme::loop) loop_rows(input_, rows);
        else if (two_phase_) two_phase_rows(input_, rows);
        else catmull_clark_rows(input_, rows);
    }

    std::vector<double> points(std::size_t row_count) const {
        PointRows rows(input_.mesh, input_.topology, row_count, input_.options.scheme != Scheme::loop);
        write_rows(rows);
        return rows.take();
    }

private:
    const StepInput& input_;
    bool two_phase_;
    std::optional<DooSabinLayout> layout_;
};

/// Counts of the last level.
MeshCounts check_levels_fit(MeshCounts counts, const SchemeOptions& options, int levels) {
    for (int level = 1; level <= levels; ++level) {
        counts = refined_counts(counts, options.scheme, level == 1 && options.is_two_phase());
        check_fits(counts, level);
    }
    return counts;
}

/// Parents of parents.
void compose_parents(const std::vector<Index>& older, std::vector<Index>& parents) {
    for (Index& parent : parents)
        if (parent >= 0) parent = older[parent];
}

Refinement unrefined(const PolygonMesh& mesh, const Topology& topology, const Features& features, const FeatureOptions& options) {
    Refinement copy;
    copy.mesh = mesh;
    copy.features = named_features(topology, features, options);
    copy.face_parent.resize(mesh.face_count());
    for (Index f = 0; f < mesh.face_count(); ++f) copy.face_parent[f] = f;
    return copy;
}

}  // namespace

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

Refinement refine_once(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options) {
    const StepInput input{mesh, topology, features, options};
    const Step step(input);
    check_levels_fit(step.counts(), options, 1);
    check_stencils_fit(topology);
    Refinement refined;
    step.make_faces(refined, nullptr);
    StencilRows rows(topology, refined.mesh.vertex_count);
    step.write_rows(rows);
    refined.stencils = rows.take();
    refined.mesh.positions = apply_stencils(refined.stencils, mesh.positions, 3);
    return refined;
}

Refinement refine(const PolygonMesh& mesh, const FeatureOptions& feature_options, const SchemeOptions& options, int levels,
                  std::vector<SurfaceLocation>* locations) {
    if (levels < 0) throw InvalidArgument("the number of refinement levels is " + std::to_string(levels) + ": it must be 0 or more");
    Topology topology = build_topology(mesh);
    Features features = find_features(mesh, topology, feature_options);
    SchemeOptions level_options = options;
    std::optional<LocationTracker> tracker;
    if (locations) tracker.emplace(mesh, topology, features, options.scheme);
    Refinement current;
    for (int level = 1; level <= levels; ++level) {
        const StepInput input{level == 1 ? mesh : current.mesh, topology, features, level_options};
        const Step step(input);
        if (level == 1) check_levels_fit(step.counts(), options, levels);
        Refinement refined;
        std::vector<std::uint8_t> quadrants;
        step.make_faces(refined, tracker ? &quadrants : nullptr);
        refined.mesh.positions = step.points(refined.mesh.vertex_count);
        if (tracker) tracker->step(input, step.layout(), std::move(quadrants));
        if (level > 1) compose_parents(current.face_parent, refined.face_parent);
        current = std::move(refined);
        level_options = SchemeOptions{options.scheme, options.mask, 0, 0, {}};
        if (level == levels) break;
        topology = build_topology(current.mesh);
        features = find_features(current.mesh, topology, current.features);
    }
    if (levels == 0) current = unrefined(mesh, topology, features, feature_options);
    if (tracker) *locations = tracker->locations(current.mesh);
    return current;
}

RefinedSize refined_size(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options, int levels) {
    const StepInput input{mesh, topology, features, options};
    const MeshCounts counts = check_levels_fit(Step(input).counts(), options, levels);
    return {counts.vertices, counts.edges, counts.faces, counts.corners};
}

std::int64_t physical_memory() { return static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE); }

std::vector<double> apply_stencils(const Stencils& stencils, const std::vector<double>& points, int channels) {
    const std::size_t rows = stencils.offsets.size() - 1, c = static_cast<std::size_t>(channels);
    std::vector<double> out(rows * c, 0.0);
    for (std::size_t i = 0; i < rows; ++i) {
        double* result = &out[i * c];
        for (std::size_t j = stencils.offsets[i]; j < stencils.offsets[i + 1]; ++j) {
            const double weight = stencils.weights[j];
            const double* point = &points[static_cast<std::size_t>(stencils.indices[j]) * c];
            for (std::size_t k = 0; k < c; ++k) result[k] += weight * point[k];
        }
    }
    return out;
}

}  // namespace lcl
