// SPDX-License-Identifier: BSD-3-Clause
#include "tests/oracle/patch.h"

#include <algorithm>

namespace oracle {

Patch patch_of(const Surface& surface, const std::vector<std::vector<int>>& faces, int first_vertex) {
    Patch patch;
    std::map<int, int> number;
    const auto number_of = [&](int v) {
        const auto [found, is_new] = number.emplace(v, static_cast<int>(patch.origin.size()));
        if (is_new) patch.origin.push_back(v);
        return found->second;
    };
    number_of(first_vertex);
    for (const auto& face : faces) {
        patch.surface.faces.emplace_back();
        for (const int v : face) patch.surface.faces.back().push_back(number_of(v));
        for (std::size_t i = 0; i < face.size(); ++i) {
            const int a = face[i], b = face[(i + 1) % face.size()];
            if (surface.sharp.count(edge_of(a, b))) patch.surface.sharp.insert(edge_of(number_of(a), number_of(b)));
        }
    }
    patch.surface.vertex_count = static_cast<int>(patch.origin.size());
    for (const int v : patch.origin)
        if (surface.corners.count(v)) patch.surface.corners.insert(number_of(v));
    return patch;
}

Patch umbrella_of(const Surface& surface, int v) {
    std::vector<std::vector<int>> faces;
    for (const auto& face : surface.faces)
        if (std::find(face.begin(), face.end(), v) != face.end()) faces.push_back(face);
    return patch_of(surface, faces, v);
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& weights, const std::vector<int>& rows) {
    Eigen::MatrixXd result(rows.size(), weights.cols());
    for (std::size_t i = 0; i < rows.size(); ++i) result.row(i) = weights.row(rows[i]);
    return result;
}

bool is_same(const Surface& a, const Surface& b) { return a.faces == b.faces && a.sharp == b.sharp && a.corners == b.corners; }

lcl::SchemeOptions options_for(const lcl::SchemeOptions& options, const std::vector<int>& origin) {
    lcl::SchemeOptions result = options;
    if (options.lambda_per_vertex.empty()) return result;
    result.lambda_per_vertex.clear();
    for (const int v : origin) result.lambda_per_vertex.push_back(options.lambda_per_vertex[v]);
    return result;
}

Patch next_doo_sabin_patch(const Step& step, const Patch& patch, bool follows_curve) {
    const auto& face = patch.surface.faces[0];
    const int new_face = follows_curve ? step.edge_faces.at({face.back(), face.front()}) : 0;
    return patch_of(step.surface, {step.surface.faces[new_face]}, step.surface.faces[new_face].front());
}

}  // namespace oracle
