// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/size.h"

#include <unistd.h>

#include <limits>
#include <string>
#include <utility>

namespace lcl {
namespace {

constexpr std::int64_t index_limit = std::numeric_limits<Index>::max();

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

}  // namespace

MeshCounts count(const StepInput& input, const DooSabinLayout* layout) { return layout ? count_doo_sabin(input.topology, *layout) : count(input.topology); }

MeshCounts check_levels_fit(MeshCounts counts, const SchemeOptions& options, int levels) {
    for (int level = 1; level <= levels; ++level) {
        counts = refined_counts(counts, options.scheme, level == 1 && options.is_two_phase());
        check_fits(counts, level);
    }
    return counts;
}

void check_stencils_fit(const Topology& topology) {
    std::int64_t entries = 0;
    for (Index f = 0; f < topology.face_count; ++f) entries += 3 * (static_cast<std::int64_t>(topology.degree(f)) * topology.degree(f) + topology.degree(f));
    const std::int64_t bytes = entries * static_cast<std::int64_t>(sizeof(Index) + sizeof(double));
    if (bytes > physical_memory())
        throw OutOfMemory("the stencils of the refinement would take up to " + std::to_string(bytes) + " bytes, this machine has " +
                          std::to_string(physical_memory()) + ": refine a smaller mesh or cut its largest faces");
}

std::int64_t physical_memory() { return static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE); }

}  // namespace lcl
