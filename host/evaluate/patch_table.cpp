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

namespace {

/// "6 corners (0 to 5)", "1 face (0)".
std::string counted(Index count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? std::string(one) + " (0)" : many + (" (0 to " + std::to_string(count - 1)) + ")");
}

}  // namespace

std::string place_name(std::size_t i) { return "place " + std::to_string(i) + ": "; }

std::string corner_name(const Places& places, std::size_t i) {
    return "corner " + std::to_string(places.corner(i)) + " of face " + std::to_string(places.faces[i]);
}

void check_face(const PatchTable& table, const Places& places, std::size_t i) {
    const Index face = places.faces[i];
    if (face < 0 || face >= table.face_count())
        throw BadInput(place_name(i) + "face " + std::to_string(face) + " does not exist, the mesh has " + counted(table.face_count(), "face", "faces"));
}

void check_corner(const PatchTable& table, const Places& places, std::size_t i) {
    const Index face = places.faces[i], corner = places.corner(i), degree = table.degree(face);
    if (corner < 0 || corner >= degree)
        throw BadInput(place_name(i) + corner_name(places, i) + " does not exist, it has " + counted(degree, "corner", "corners"), Where{{}, {face}});
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
