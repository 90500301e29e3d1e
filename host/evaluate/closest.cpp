// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/closest.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <nanoflann.hpp>

#include "host/parallel.h"

namespace lcl {
namespace {

constexpr double wanted_seeds = 131072;
constexpr int finest_grid = 16;     // of seeds in a chart, a side
constexpr int most_steps = 60;      // near an extraordinary vertex Newton's method gains only a factor of about 3 a step
constexpr double longest_step = 1;  // in a chart
constexpr std::size_t smallest_piece = 1024;

using Vector = Eigen::Map<const Eigen::Vector3d>;

/// Places of charts as arrays of places, with what evaluating them gives.
struct Batch {
    std::vector<Index> faces, corners;
    std::vector<double> uv, points, du, dv, duu, duv, dvv, normals;
    std::vector<SurfacePlace> places;

    void resize(std::size_t count) {
        places.resize(count);
        faces.resize(count);
        corners.resize(count);
        for (std::vector<double>* array : {&points, &du, &dv, &duu, &duv, &dvv, &normals}) array->resize(3 * count);
        uv.resize(2 * count);
    }
    void set(std::size_t i, const SurfacePlace& place) {
        places[i] = place;
        faces[i] = place.face;
        corners[i] = place.corner;
        uv[2 * i] = place.u;
        uv[2 * i + 1] = place.v;
    }
    void evaluate(DeviceSurface& surface, SamplePiece& piece, std::size_t count, const SurfaceValues& values) {
        surface.make_samples({count, faces.data(), corners.data(), uv.data()}, 0, count, piece);
        surface.evaluate(piece, values);
    }
};

/// A search under way.
struct Search {
    ChartPlace best;                            ///< nearest so far
    double square = -1;                         ///< of its distance; below 0: not known yet
    double step_a = 0, step_b = 0, length = 0;  ///< from `best` to the trial, and how far that is in space
};

/// Solves H step = -gradient with what walls leave free. H: second derivatives of half the square of the distance where they are positive definite, else the
/// first fundamental form.
Eigen::Vector2d newton_step(const Eigen::Matrix2d& hessian, const Eigen::Matrix2d& metric, Eigen::Vector2d gradient, const std::array<bool, 3>& walls) {
    const bool is_convex = hessian.allFinite() && hessian.determinant() > 1e-3 * metric.determinant() && hessian.trace() > 0;
    const Eigen::Matrix2d& by = is_convex ? hessian : metric;
    Eigen::Vector2d step = -by.inverse() * gradient;
    if (!step.allFinite()) step = -gradient / std::max(metric.trace(), 1e-300);
    for (int k = 0; k < 3; ++k) {
        if (!walls[k]) continue;
        const Eigen::Vector2d outward = k == 0 ? Eigen::Vector2d(-1, 0) : k == 1 ? Eigen::Vector2d(0, -1) : Eigen::Vector2d(1, 1);
        if (step.dot(outward) <= 0) continue;
        const Eigen::Vector2d along(-outward[1], outward[0]);
        const double curvature = along.dot(by * along);
        step = curvature > 0 ? Eigen::Vector2d(-along.dot(gradient) / curvature * along) : Eigen::Vector2d(0, 0);
    }
    return step;
}

}  // namespace

struct ClosestSearch::Seeds {
    std::vector<ChartPlace> places;
    std::vector<double> points;

    std::size_t kdtree_get_point_count() const { return places.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[3 * i + axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Seeds>, Seeds, 3, Index>;
    std::unique_ptr<Tree> tree;
};

ClosestSearch::~ClosestSearch() = default;

ClosestSearch::ClosestSearch(DeviceSurface& surface, const Topology& topology)
    : surface_(surface), charts_(surface.table(), topology), seeds_(std::make_unique<Seeds>()) {
    const int grid = std::clamp(static_cast<int>(std::ceil(std::sqrt(wanted_seeds / std::max(1, charts_.count())))), 1, finest_grid);
    for (Index chart = 0; chart < charts_.count(); ++chart)
        for (int j = 0; j < grid; ++j)
            for (int i = 0; i < (charts_.are_triangles() ? grid - j : grid); ++i) {
                const double middle = charts_.are_triangles() ? 1.0 / 3 : 0.5;
                seeds_->places.push_back(charts_.place(chart, (i + middle) / grid, (j + middle) / grid));
            }
    seeds_->points.resize(3 * seeds_->places.size());
    Batch batch;
    SamplePiece piece;
    for (std::size_t first = 0; first < seeds_->places.size(); first += DeviceSurface::piece_samples) {
        const std::size_t count = std::min(DeviceSurface::piece_samples, seeds_->places.size() - first);
        batch.resize(count);
        for (std::size_t i = 0; i < count; ++i) batch.set(i, charts_.surface_place(seeds_->places[first + i]));
        SurfaceValues values;
        values.points = &seeds_->points[3 * first];
        batch.evaluate(surface_, piece, count, values);
    }
    seeds_->tree = std::make_unique<Seeds::Tree>(3, *seeds_, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    seeds_->tree->buildIndex();
}

void ClosestSearch::find(const double* points, std::size_t stride, std::size_t count, const ClosestPoints& out) {
    surface_.prepare_for(4 * count);  // about so many evaluations
    for (std::size_t first = 0; first < count; first += DeviceSurface::piece_samples)
        find_piece(points, stride, first, std::min(DeviceSurface::piece_samples, count - first), out);
}

void ClosestSearch::find_piece(const double* points, std::size_t stride, std::size_t first, std::size_t count, const ClosestPoints& out) {
    std::vector<Search> searches(count);
    std::vector<Index> active(count);
    Batch batch;
    batch.resize(count);
    SamplePiece piece;
    const double tolerance = 1e-12 * surface_.size();
    const auto target = [&](std::size_t i) { return Vector(points + (first + i) * stride); };
    parallel_for(
        count,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                Index nearest = 0;
                double square = 0;
                seeds_->tree->knnSearch(points + (first + i) * stride, 1, &nearest, &square);
                searches[i].best = seeds_->places[nearest];
                active[i] = static_cast<Index>(i);
                batch.set(i, charts_.surface_place(searches[i].best));
            }
        },
        smallest_piece);

    SurfaceValues values;
    values.points = batch.points.data(), values.du = batch.du.data(), values.dv = batch.dv.data();
    values.duu = batch.duu.data(), values.duv = batch.duv.data(), values.dvv = batch.dvv.data();
    for (int step = 0; step < most_steps && !active.empty(); ++step) {
        batch.evaluate(surface_, piece, active.size(), values);
        std::vector<char> goes_on(active.size());
        parallel_for(
            active.size(),
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t k = begin; k < end; ++k) {
                    Search& search = searches[active[k]];
                    const Eigen::Vector3d way = Vector(&batch.points[3 * k]) - target(active[k]);
                    const double square = way.squaredNorm();
                    if (search.square >= 0 && !(square < search.square)) {  // too far: half of it
                        search.step_a /= 2, search.step_b /= 2, search.length /= 2;
                    } else {
                        search.best = search.square < 0 ? search.best : charts_.move(search.best, search.step_a, search.step_b);
                        search.square = square;
                        const SurfacePlace& p = batch.places[k];
                        const Vector u(&batch.du[3 * k]), v(&batch.dv[3 * k]), uu(&batch.duu[3 * k]), uv(&batch.duv[3 * k]), vv(&batch.dvv[3 * k]);
                        Eigen::Matrix2d turn, metric, second;
                        turn << p.ua, p.va, p.ub, p.vb;
                        metric << u.dot(u), u.dot(v), u.dot(v), v.dot(v);
                        second << way.dot(uu), way.dot(uv), way.dot(uv), way.dot(vv);
                        metric = (turn * metric * turn.transpose()).eval();
                        const Eigen::Matrix2d hessian = metric + turn * second * turn.transpose();
                        const Eigen::Vector2d gradient = turn * Eigen::Vector2d(way.dot(u), way.dot(v));
                        Eigen::Vector2d by = newton_step(hessian, metric, gradient, charts_.walls(search.best));
                        const double longest = by.cwiseAbs().maxCoeff();
                        if (longest > longest_step) by *= longest_step / longest;
                        search.step_a = by[0], search.step_b = by[1];
                        search.length = std::sqrt(std::max(0.0, by.dot(metric * by)));
                    }
                    goes_on[k] = search.length > tolerance;
                }
            },
            smallest_piece);
        std::size_t kept = 0;
        for (std::size_t k = 0; k < active.size(); ++k)
            if (goes_on[k]) active[kept++] = active[k];
        active.resize(kept);
        parallel_for(
            kept,
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t k = begin; k < end; ++k) {
                    const Search& search = searches[active[k]];
                    batch.set(k, charts_.surface_place(charts_.move(search.best, search.step_a, search.step_b)));
                }
            },
            smallest_piece);
    }

    for (std::size_t i = 0; i < count; ++i) batch.set(i, charts_.surface_place(searches[i].best));
    SurfaceValues last;
    last.points = batch.points.data(), last.normals = batch.normals.data();
    batch.evaluate(surface_, piece, count, last);
    for (std::size_t i = 0; i < count; ++i) {
        const Vector at(&batch.points[3 * i]), normal(&batch.normals[3 * i]);
        const Eigen::Vector3d way = target(i) - at;
        const std::size_t to = first + i;
        if (out.faces != nullptr) out.faces[to] = batch.faces[i];
        if (out.corners != nullptr) out.corners[to] = batch.corners[i];
        if (out.uv != nullptr) std::copy_n(&batch.uv[2 * i], 2, out.uv + 2 * to);
        if (out.points != nullptr) std::copy_n(at.data(), 3, out.points + 3 * to);
        if (out.normals != nullptr) std::copy_n(normal.data(), 3, out.normals + 3 * to);
        if (out.distances != nullptr) out.distances[to] = way.dot(normal) < 0 ? -way.norm() : way.norm();
    }
}

}  // namespace lcl
