// SPDX-License-Identifier: BSD-3-Clause
#include "tests/oracle/normals.h"

#include <algorithm>
#include <stdexcept>

#include "tests/oracle/patch.h"

namespace oracle {

namespace {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<long double, 3, 1>;

/// Three points a corner: of the normal (b - a) x (c - b).
struct Corner {
    int face;
    int a, b, c;
};

/// A piece of surface that the same matrix refines at every level, and whose corners have the normals that are looked for.
struct Sequence {
    Matrix points, step;
    std::vector<Corner> corners;
};

Vector normal_of(const Matrix& points, const Corner& corner) {
    const Vector a = points.row(corner.a), b = points.row(corner.b), c = points.row(corner.c);
    return (b - a).normalized().cross((c - b).normalized()).normalized();
}

/// Sides and angle of a corner are well above rounding (1e-19): the slower tangent outgrows the other with every level. Points are of size 1.
bool is_sound(const Matrix& points, const Corner& corner) {
    constexpr long double least = 1e-10L;
    const Vector a = points.row(corner.a), b = points.row(corner.b), c = points.row(corner.c);
    return std::min((b - a).norm(), (c - b).norm()) > least && (b - a).normalized().cross((c - b).normalized()).norm() > least;
}

std::vector<FaceNormal> settle(Sequence sequence, int levels) {
    constexpr int most_levels = 600, apart = 8;
    std::vector<std::vector<Vector>> history(sequence.corners.size());
    std::vector<FaceNormal> best;
    for (const Corner& corner : sequence.corners) best.push_back({corner.face, Eigen::Vector3d::Zero(), 1e9});
    for (int level = 0; level <= (levels > 0 ? levels : most_levels); ++level) {
        for (std::size_t i = 0; i < best.size(); ++i) {
            if (levels == 0 && static_cast<int>(history[i].size()) < level) continue;  // it was lost to rounding
            if (levels == 0 && !is_sound(sequence.points, sequence.corners[i])) continue;
            history[i].push_back(normal_of(sequence.points, sequence.corners[i]));
            if (level < apart || (levels > 0 && level < levels)) continue;
            const double change = static_cast<double>((history[i][level] - history[i][level - apart]).norm());
            if (levels == 0 && !(change < best[i].error)) continue;
            best[i].normal = history[i][level].cast<double>();
            best[i].error = change;
        }
        sequence.points = sequence.step * sequence.points;
        const Eigen::Matrix<long double, 1, Eigen::Dynamic> first = sequence.points.row(0);  // a copy: the first point stays at the origin, which loses nothing
        sequence.points.rowwise() -= first;
        sequence.points /= sequence.points.cwiseAbs().maxCoeff();
    }
    return best;
}

std::vector<int> faces_at(const Surface& surface, int v) {
    std::vector<int> faces;
    for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f)
        if (std::count(surface.faces[f].begin(), surface.faces[f].end(), v) > 0) faces.push_back(f);
    return faces;
}

/// The children of the faces at a vertex follow each other as those do.
Sequence primal_sequence(const Surface& surface, const lcl::SchemeOptions& options, const Eigen::MatrixXd& points, int vertex) {
    const Patch start = umbrella_of(surface, vertex);
    const Step first = subdivide(start.surface, options_for(options, start.origin));
    const Patch once = umbrella_of(first.surface, 0);
    const Step second = subdivide(once.surface, after_first_step(options));
    const Patch twice = umbrella_of(second.surface, 0);
    if (!is_same(once.surface, twice.surface)) throw std::logic_error("the faces round a vertex change from step to step");
    Sequence sequence;
    sequence.points = (rows_of(first.weights, once.origin) * rows_of(points, start.origin)).cast<long double>();
    sequence.step = rows_of(second.weights, twice.origin).cast<long double>();
    const std::vector<int> faces = faces_at(surface, vertex);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto& face = once.surface.faces[i];
        const int d = static_cast<int>(face.size()), at = static_cast<int>(std::find(face.begin(), face.end(), 0) - face.begin());
        sequence.corners.push_back({faces[i], face[at], face[(at + 1) % d], face[(at + 2) % d]});  // also where the edges at the vertex form a straight line
    }
    return sequence;
}

Patch first_doo_sabin_patch(const Step& step, int new_face) {
    const auto& face = step.surface.faces[new_face];
    return patch_of(step.surface, {face}, face.front());
}

/// A corner's own face; else as for limit points.
Patch following_patch(const Step& step, const Patch& patch, bool is_corner, bool follows_curve) {
    if (!is_corner) return next_doo_sabin_patch(step, patch, follows_curve);
    return first_doo_sabin_patch(step, step.vertex_faces[*patch.surface.corners.begin()].at(0));
}

/// One sector: the face that the first refinement puts at the vertex, and what it becomes.
std::vector<FaceNormal> doo_sabin_sector(const Surface& surface, const lcl::SchemeOptions& options, const Eigen::MatrixXd& points, const Step& first,
                                         int new_face, int levels) {
    const Patch once = first_doo_sabin_patch(first, new_face);
    const bool is_corner = !once.surface.corners.empty(), follows_curve = !once.surface.sharp.empty();
    const Step second = subdivide(once.surface, options);
    const Patch twice = following_patch(second, once, is_corner, follows_curve);
    const Step third = subdivide(twice.surface, options);
    const Patch thrice = following_patch(third, twice, is_corner, follows_curve);
    if (!is_same(twice.surface, thrice.surface)) throw std::logic_error("the face of a vertex changes from step to step");
    Sequence sequence;
    sequence.points = (rows_of(second.weights, twice.origin) * rows_of(first.weights, once.origin) * points).cast<long double>();
    sequence.step = rows_of(third.weights, thrice.origin).cast<long double>();
    const auto& face = twice.surface.faces[0];
    const int d = static_cast<int>(face.size());
    for (int i = 0; i < d; ++i) sequence.corners.push_back({0, face[i], face[(i + 1) % d], face[(i + 2) % d]});
    const std::vector<FaceNormal> corners = settle(sequence, levels);
    // The corners have one limit. Those in the middle of a straight line, and at tiny sides, have no normal.
    const FaceNormal normal = *std::min_element(corners.begin(), corners.end(), [](const FaceNormal& a, const FaceNormal& b) { return a.error < b.error; });
    std::vector<FaceNormal> out;
    int next = 0;
    for (int f = 0; f < static_cast<int>(surface.faces.size()); next += static_cast<int>(surface.faces[f].size()), ++f)
        for (const int point : first.surface.faces[new_face])
            if (point >= next && point < next + static_cast<int>(surface.faces[f].size())) out.push_back({f, normal.normal, normal.error});
    return out;
}

}  // namespace

std::vector<FaceNormal> limit_normals(const Surface& surface, const lcl::SchemeOptions& options, const Eigen::MatrixXd& points, int vertex, int levels) {
    if (options.scheme != lcl::Scheme::doo_sabin) return settle(primal_sequence(surface, options, points, vertex), levels);
    const Step first = subdivide(surface, options);
    std::vector<FaceNormal> out;
    for (const int new_face : first.vertex_faces[vertex]) {
        const std::vector<FaceNormal> sector = doo_sabin_sector(surface, options, points, first, new_face, levels);
        out.insert(out.end(), sector.begin(), sector.end());
    }
    return out;
}

}  // namespace oracle
