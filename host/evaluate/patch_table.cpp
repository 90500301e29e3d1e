// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/patch_table.h"

#include <algorithm>

#include "host/parallel.h"

namespace lcl {

PatchTable build_patch_table(const PolygonMesh& mesh, const Topology& topology, const Features& features, const SchemeOptions& options) {
    PatchTable table;
    table.scheme = options.scheme;
    table.point_count = mesh.vertex_count;
    switch (options.scheme) {
        case Scheme::catmull_clark: add_catmull_clark_patches(mesh, topology, features, options, table); break;
        case Scheme::loop: add_loop_patches(mesh, topology, features, options, table); break;
        case Scheme::doo_sabin: add_doo_sabin_patches(mesh, topology, features, options, table); break;
    }
    return table;
}

void locate(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out) {
    switch (table.scheme) {
        case Scheme::catmull_clark: return locate_catmull_clark(table, places, begin, end, out);
        case Scheme::loop: return locate_loop(table, places, begin, end, out);
        case Scheme::doo_sabin: return locate_doo_sabin(table, places, begin, end, out);
    }
}

std::vector<double> control_points(const PatchTable& table, const std::vector<double>& points, int channels) {
    std::vector<double> refined = points;
    for (const Stencils& step : table.steps) refined = apply_stencils(step, refined, channels);
    const std::vector<double> ghosts = apply_stencils(table.ghosts, refined, channels);
    refined.insert(refined.end(), ghosts.begin(), ghosts.end());
    return refined;
}

}  // namespace lcl
