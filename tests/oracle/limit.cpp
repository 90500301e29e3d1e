// SPDX-License-Identifier: BSD-3-Clause
#include "tests/oracle/limit.h"

#include <stdexcept>

#include "tests/oracle/patch.h"

namespace oracle {

namespace {

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

// From the first refinement on, the faces round the vertex look the same after every step, so one matrix stands for all later steps.
Eigen::RowVectorXd primal_limit(const Patch& start, const lcl::SchemeOptions& options) {
    const Step first = subdivide(start.surface, options_for(options, start.origin));
    const Patch once = umbrella_of(first.surface, 0);
    const Step second = subdivide(once.surface, after_first_step(options));
    const Patch twice = umbrella_of(second.surface, 0);
    if (!is_same(once.surface, twice.surface)) throw std::logic_error("the faces round a vertex change from step to step");
    return settled_first_row(rows_of(second.weights, twice.origin)) * rows_of(first.weights, once.origin);
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
