// SPDX-License-Identifier: BSD-3-Clause
#include "tests/oracle/limit.h"

#include <algorithm>
#include <stdexcept>

namespace oracle {

namespace {

/// Some faces of a surface on their own; vertex i of the patch is vertex origin[i] of the surface.
struct Patch {
    Surface surface;
    std::vector<int> origin;
};

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

// All faces that contain v: everything that the new faces round v depend on.
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

// The first point's weights after so many steps by the same matrix that they no longer move but for rounding. In double, 400 sums over a ring of valence 60
// would lose 5e-13.
Eigen::RowVectorXd settled_first_row(const Eigen::MatrixXd& step) {
    using Row = Eigen::Matrix<long double, 1, Eigen::Dynamic>;
    const Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> fine_step = step.cast<long double>();
    Row row = Row::Unit(step.rows(), 0);
    long double change = 1;
    for (int i = 0; i < 400 && change > 2e-16L; ++i) {
        const Row next = row * fine_step;
        change = (next - row).cwiseAbs().maxCoeff();
        row = next;
    }
    if (change > 1e-14L) throw std::runtime_error("400 refinements do not settle a limit point");
    return row.cast<double>();
}

lcl::SchemeOptions options_for(const lcl::SchemeOptions& options, const std::vector<int>& origin) {
    lcl::SchemeOptions result = options;
    if (options.lambda_per_vertex.empty()) return result;
    result.lambda_per_vertex.clear();
    for (const int v : origin) result.lambda_per_vertex.push_back(options.lambda_per_vertex[v]);
    return result;
}

// From the first refinement on, the faces round the vertex look the same after every step, so one matrix stands for all later steps.
Eigen::RowVectorXd primal_limit(const Patch& start, const lcl::SchemeOptions& options) {
    const Step first = subdivide(start.surface, options_for(options, start.origin));
    const Patch once = umbrella_of(first.surface, 0);
    const Step second = subdivide(once.surface, after_first_step(options));
    const Patch twice = umbrella_of(second.surface, 0);
    if (!is_same(once.surface, twice.surface)) throw std::logic_error("the faces round a vertex change from step to step");
    return settled_first_row(rows_of(second.weights, twice.origin)) * rows_of(first.weights, once.origin);
}

// Follows the face that a vertex becomes; on a curve the new face on the edge from its last to its first point, which is the vertex's piece of the curve.
Patch next_doo_sabin_patch(const Step& step, const Patch& patch, bool follows_curve) {
    const auto& face = patch.surface.faces[0];
    const int new_face = follows_curve ? step.edge_faces.at({face.back(), face.front()}) : 0;
    return patch_of(step.surface, {step.surface.faces[new_face]}, step.surface.faces[new_face].front());
}

Eigen::RowVectorXd doo_sabin_limit(const Patch& start, const lcl::SchemeOptions& options) {
    const bool follows_curve = [&] {
        for (const Edge& edge : start.surface.sharp)
            if (edge.first == 0) return true;
        return false;
    }();
    const Step first = subdivide(start.surface, options);
    const auto& vertex_face = first.surface.faces[first.vertex_faces[0].at(0)];
    const Patch once = patch_of(first.surface, {vertex_face}, vertex_face.front());
    const Step second = subdivide(once.surface, options);
    const Patch twice = next_doo_sabin_patch(second, once, follows_curve);
    const Step third = subdivide(twice.surface, options);
    const Patch thrice = next_doo_sabin_patch(third, twice, follows_curve);
    if (!is_same(twice.surface, thrice.surface)) throw std::logic_error("the face of a vertex changes from step to step");
    return settled_first_row(rows_of(third.weights, thrice.origin)) * rows_of(second.weights, twice.origin) * rows_of(first.weights, once.origin);
}

}  // namespace

Eigen::RowVectorXd limit_row(const Surface& surface, const lcl::SchemeOptions& options, int vertex) {
    const Patch patch = umbrella_of(surface, vertex);
    if (patch.surface.faces.empty() || surface.corners.count(vertex)) return Eigen::RowVectorXd::Unit(surface.vertex_count, vertex);
    const Eigen::RowVectorXd local = options.scheme == lcl::Scheme::doo_sabin ? doo_sabin_limit(patch, options) : primal_limit(patch, options);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(surface.vertex_count);
    for (std::size_t i = 0; i < patch.origin.size(); ++i) row[patch.origin[i]] += local[i];
    return row;
}

Eigen::MatrixXd limit_rows(const lcl::PolygonMesh& mesh, const lcl::FeatureOptions& features, const lcl::SchemeOptions& options) {
    const Surface surface = make_surface(mesh, features);
    Eigen::MatrixXd rows(mesh.vertex_count, mesh.vertex_count);
    for (int v = 0; v < mesh.vertex_count; ++v) rows.row(v) = limit_row(surface, options, v);
    return rows;
}

}  // namespace oracle
