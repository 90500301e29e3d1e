// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/features.h"

#include <algorithm>
#include <array>

#include "host/cli/csv.h"
#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

using Edge = std::array<std::int32_t, 2>;

Edge sorted(Edge edge) {
    if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
    return edge;
}

/// Which of `wanted` (ascending) are sides of a face.
std::vector<char> edges_found(lcl_mesh mesh, const std::vector<Edge>& wanted) {
    std::vector<std::int32_t> degrees(static_cast<std::size_t>(lcl_mesh_face_count(mesh))), corners(static_cast<std::size_t>(lcl_mesh_corner_count(mesh)));
    check(lcl_mesh_get_faces(mesh, degrees.data(), corners.data()));
    std::vector<char> found(wanted.size(), 0);
    std::size_t first = 0;
    for (const std::int32_t degree : degrees) {
        const auto sides = static_cast<std::size_t>(degree);
        for (std::size_t side = 0; side < sides; ++side) {
            const Edge edge = sorted({corners[first + side], corners[first + (side + 1) % sides]});
            const auto place = std::lower_bound(wanted.begin(), wanted.end(), edge);
            if (place != wanted.end() && *place == edge) found[static_cast<std::size_t>(place - wanted.begin())] = 1;
        }
        first += sides;
    }
    return found;
}

/// The library would refuse such a pair too, but only this side knows the line that it stands on.
void require_edges(const std::string& path, lcl_mesh mesh, const PairList& list) {
    std::vector<Edge> wanted;
    for (const Edge& pair : list.pairs) wanted.push_back(sorted(pair));
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    const std::vector<char> found = edges_found(mesh, wanted);
    for (std::size_t index = 0; index < list.pairs.size(); ++index) {
        const auto place = std::lower_bound(wanted.begin(), wanted.end(), sorted(list.pairs[index])) - wanted.begin();
        if (found[static_cast<std::size_t>(place)]) continue;
        const auto [v0, v1] = list.pairs[index];
        fail_at(path, list.lines[index], "vertices " + std::to_string(v0) + " and " + std::to_string(v1) + " are not the ends of an edge of the mesh");
    }
}

/// The options' values were checked when they were parsed: what the library still refuses lies in the files or the mesh.
void check_features(Job& job, lcl_status status) {
    if (status == LCL_OK) return;
    Failure failure = failure_of(status);
    const bool about_input = status == LCL_ERROR_INVALID_ARGUMENT || status == LCL_ERROR_BAD_INPUT;
    if (about_input && job.options.command == "info") return warn(job, failure.message);
    if (about_input) {
        failure.exit_code = exit_bad_input;
        failure.status = "bad-input";
    }
    throw failure;
}

}  // namespace

void add_features(Job& job, lcl_mesh mesh) {
    const Options& options = job.options;
    const std::int32_t vertex_count = lcl_mesh_vertex_count(mesh);
    PairList creases;
    std::vector<std::int32_t> corners;
    if (!options.creases_file.empty()) {
        creases = read_pair_list(options.creases_file, vertex_count);
        require_edges(options.creases_file, mesh, creases);
        job.report.set_parameter("creases", options.creases_file);
    }
    if (!options.corners_file.empty()) {
        corners = read_vertex_list(options.corners_file, vertex_count);
        job.report.set_parameter("corners", options.corners_file);
    }
    if (options.crease_angle > 0.0) job.report.set_parameter("crease_angle", options.crease_angle);
    lcl_features features = LCL_FEATURES_INIT;
    features.boundary = options.boundary;
    features.creases = creases.pairs.empty() ? nullptr : creases.pairs.front().data();
    features.crease_count = creases.pairs.size();
    features.corners = corners.empty() ? nullptr : corners.data();
    features.corner_count = corners.size();
    features.crease_angle_degrees = options.crease_angle;
    const bool any = features.boundary != LCL_BOUNDARY_DEFAULT || features.crease_count > 0 || features.corner_count > 0 || features.crease_angle_degrees > 0.0;
    if (any) check_features(job, lcl_mesh_add_features(mesh, &features));
}

}  // namespace lcl::cli
