// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/patch_table.h"

#include <algorithm>
#include <limits>

#include "host/parallel.h"

namespace lcl {

PatchTable build_patch_table(const Topology& topology, const Features& features, const SchemeOptions& options) {
    PatchTable table;
    table.scheme = options.scheme;
    table.point_count = topology.vertex_count;
    switch (options.scheme) {
        case Scheme::catmull_clark: add_catmull_clark_patches(topology, features, options, table); break;
        case Scheme::loop: add_loop_patches(topology, features, options, table); break;
        case Scheme::doo_sabin: add_doo_sabin_patches(topology, features, options, table); break;
    }
    return table;
}

void check_control_count(std::int64_t count) {
    if (count > std::numeric_limits<Index>::max())
        throw OutOfMemory("the patches of the limit surface have more than 2147483647 control points together: take a smaller mesh");
}

void locate(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out) {
    switch (table.scheme) {
        case Scheme::catmull_clark: return locate_catmull_clark(table, places, begin, end, out);
        case Scheme::loop: return locate_loop(table, places, begin, end, out);
        case Scheme::doo_sabin: return locate_doo_sabin(table, places, begin, end, out);
    }
}

std::vector<double> control_points(const PatchTable& table, const std::vector<double>& points, int channels) {
    const std::size_t row = static_cast<std::size_t>(channels);
    std::vector<double> refined(static_cast<std::size_t>(table.refined_count()) * row);
    table.refiner->apply(points.data(), row, channels, refined.data(), row);
    const std::vector<double> ghosts = apply_stencils(table.ghosts, refined, channels);
    refined.insert(refined.end(), ghosts.begin(), ghosts.end());
    return refined;
}

}  // namespace lcl
