// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/closest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>
#include <nanoflann.hpp>

#include "host/parallel.h"

namespace lcl {
namespace {

constexpr double least_seeds = 32768;  // and one a square or triangle at least
constexpr double most_seeds_factor = 4;
constexpr int finest_grid = 64;                                      // of seeds in a square or triangle, a side
constexpr int most_steps = 60;                                       // near an extraordinary vertex Newton's method gains only a factor of about 3 a step
constexpr double longest_step = 1;                                   // in a chart
constexpr double double_tolerance = 1e-12, single_tolerance = 1e-7;  // a step's length, of the surface's size
constexpr std::size_t evaluations_a_point = 4, smallest_piece = 1024;
constexpr int start_count = 12;         // seeds that a search may begin at, one after the other
constexpr double doubtful_part = 0.05;  // of the size of a seed's surroundings: where a point stays farther away, another seed may lead nearer

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
    /// Lengths of the derivatives by the chart's parameters at place i.
    double length_a(std::size_t i) const { return (places[i].ua * Vector(&du[3 * i]) + places[i].va * Vector(&dv[3 * i])).norm(); }
    double length_b(std::size_t i) const { return (places[i].ub * Vector(&du[3 * i]) + places[i].vb * Vector(&dv[3 * i])).norm(); }
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

    ChartPlace trial(const Charts& charts) const { return charts.move(best, step_a, step_b); }
    void halve() { step_a /= 2, step_b /= 2, length /= 2; }
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
    std::vector<float> points;  // normalised; half the memory, and which of two seeds is nearer by a rounding does not matter
    std::vector<float> radii;   // normalised: about how far the part of the surface reaches that a seed stands for

    std::size_t kdtree_get_point_count() const { return places.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[3 * i + axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Seeds>, Seeds, 3, Index>;
    std::unique_ptr<Tree> tree;
};

ClosestSearch::~ClosestSearch() = default;

/// A coordinate in units of the surface's size, from its centre: floats hold it, and squares of it, wherever and however large the surface is.
float ClosestSearch::normalised(double coordinate, std::size_t axis) const {
    return static_cast<float>((coordinate - surface_.centre()[axis]) / surface_.size());
}

/// A unit square of a chart, or its triangle, and its sides in space.
struct ClosestSearch::Cell {
    Index chart = 0;
    int a = 0, b = 0;                   ///< where it begins: 0 or -1
    double length_a = 0, length_b = 0;  ///< normalised

    /// Seeds along the sides, for a distance of `spacing`; triangles have as many along both.
    std::array<int, 2> grid(double spacing, bool is_triangle) const {
        const auto along = [&](double length) { return length > spacing ? static_cast<int>(std::min<double>(finest_grid, std::ceil(length / spacing))) : 1; };
        const int na = along(length_a), nb = along(length_b);
        return is_triangle ? std::array<int, 2>{std::max(na, nb), std::max(na, nb)} : std::array<int, 2>{na, nb};
    }
};

/// body(i, batch, row) for every place: batch holds its point and first derivatives in a row.
template <class PlaceOf, class Body>
void ClosestSearch::evaluate_all(std::size_t count, const PlaceOf& place_of, const Body& body) {
    Batch batch;
    SamplePiece piece;
    for (std::size_t first = 0; first < count; first += DeviceSurface::piece_samples) {
        const std::size_t size = std::min(DeviceSurface::piece_samples, count - first);
        batch.resize(size);
        for (std::size_t i = 0; i < size; ++i) batch.set(i, charts_.surface_place(place_of(first + i)));
        SurfaceValues values;
        values.points = batch.points.data(), values.du = batch.du.data(), values.dv = batch.dv.data();
        batch.evaluate(surface_, piece, size, values);
        for (std::size_t i = 0; i < size; ++i) body(first + i, batch, i);
    }
}

std::vector<ClosestSearch::Cell> ClosestSearch::find_cells() {
    std::vector<Cell> cells;
    const double middle = charts_.are_triangles() ? 1.0 / 3 : 0.5;
    for (Index chart = 0; chart < charts_.count(); ++chart)
        for (int b = charts_.are_triangles() ? 0 : static_cast<int>(charts_.low_b(chart)); b <= 0; ++b)
            for (int a = charts_.are_triangles() ? 0 : static_cast<int>(charts_.low_a(chart)); a <= 0; ++a)
                if (a == 0 || b == 0 || charts_.has_square_beyond_both(chart)) cells.push_back({chart, a, b});
    evaluate_all(
        cells.size(), [&](std::size_t i) { return charts_.place(cells[i].chart, cells[i].a + middle, cells[i].b + middle); },
        [&](std::size_t i, const Batch& batch, std::size_t row) {
            cells[i].length_a = batch.length_a(row) / surface_.size();
            cells[i].length_b = batch.length_b(row) / surface_.size();
        });
    return cells;
}

/// Seeds lie about equally far apart in space, so that the parts of long and large charts have theirs too.
void ClosestSearch::place_seeds() {
    const bool are_triangles = charts_.are_triangles();
    const std::vector<Cell> cells = find_cells();
    double area = 0, longest = 0;
    for (const Cell& cell : cells) {
        area += cell.length_a * cell.length_b / (are_triangles ? 2 : 1);
        longest = std::max({longest, cell.length_a, cell.length_b});
    }
    const double wanted = std::max(least_seeds, static_cast<double>(cells.size())), middle = are_triangles ? 1.0 / 3 : 0.5;
    const auto count = [&](double spacing) {
        double sum = 0;
        for (const Cell& cell : cells) {
            const std::array<int, 2> grid = cell.grid(spacing, are_triangles);
            sum += static_cast<double>(grid[0]) * grid[1];
        }
        return sum;
    };
    double spacing = area > 0 ? std::sqrt(area / wanted) : longest / finest_grid;  // a surface that has shrunk to a line
    while (count(spacing) > most_seeds_factor * wanted) spacing *= 1.5;            // long thin charts have many along them
    for (const Cell& cell : cells) {
        const auto [na, nb] = cell.grid(spacing, are_triangles);
        const double radius = (cell.length_a / na + cell.length_b / nb) / 2;
        for (int j = 0; j < nb; ++j)
            for (int i = 0; i < (are_triangles ? na - j : na); ++i) {
                seeds_->places.push_back(charts_.place(cell.chart, cell.a + (i + middle) / na, cell.b + (j + middle) / nb));
                seeds_->radii.push_back(static_cast<float>(radius));
            }
    }
}

ClosestSearch::ClosestSearch(DeviceSurface& surface) : surface_(surface), charts_(surface.table()), seeds_(std::make_unique<Seeds>()) {
    place_seeds();
    seeds_->points.resize(3 * seeds_->places.size());
    evaluate_all(
        seeds_->places.size(), [&](std::size_t i) { return seeds_->places[i]; },
        [&](std::size_t i, const Batch& batch, std::size_t row) {
            for (std::size_t c = 0; c < 3; ++c) seeds_->points[3 * i + c] = normalised(batch.points[3 * row + c], c);
        });
    seeds_->tree = std::make_unique<Seeds::Tree>(3, *seeds_, nanoflann::KDTreeSingleIndexAdaptorParams(16));
}

/// The searches for a piece of the points, which go on together, step by step.
class ClosestSearch::Piece {
public:
    Piece(ClosestSearch& search, const double* points, std::size_t stride, std::size_t count)
        : search_(search), points_(points), stride_(stride), searches_(count), found_(count), starts_(count) {
        batch_.resize(count);
    }

    void run(std::size_t first, const ClosestPoints& out, const Places* places) {
        if (places != nullptr) {
            begin_at(first, *places);
            descend();
        } else {
            find_starts();
            for (int k = 0; k < start_count && begin(k); ++k) descend();
        }
        give(first, out);
    }

private:
    /// A seed, -1 for none, and about how near the part of the surface that it stands for comes to the point; normalised.
    struct Start {
        Index seed = -1;
        float least = 0;
    };

    Vector target(std::size_t i) const { return Vector(points_ + i * stride_); }

    template <class Body>
    static void for_each(std::size_t count, const Body& body) {
        parallel_for_each(count, body, smallest_piece);
    }

    /// The seeds that are nearest to each point, as many as there are.
    void find_starts() {
        const Seeds& seeds = *search_.seeds_;
        const std::size_t wanted = std::min<std::size_t>(start_count, seeds.places.size());
        for_each(starts_.size(), [&](std::size_t i) {
            float at[3], squares[start_count];
            Index nearest[start_count] = {};
            for (std::size_t c = 0; c < 3; ++c) at[c] = search_.normalised(points_[i * stride_ + c], c);
            const std::size_t found = seeds.tree->knnSearch(at, wanted, nearest, squares);
            starts_[i][0].seed = 0;  // where squares overflow none is found
            for (std::size_t k = 0; k < found; ++k) starts_[i][k] = {nearest[k], std::sqrt(squares[k]) - seeds.radii[nearest[k]]};
        });
    }

    /// Begins a search at the k-th start of every point: at the first of all, at further ones where they promise more than what was found. False if none does.
    bool begin(int k) {
        active_.clear();
        for (std::size_t i = 0; i < starts_.size(); ++i)
            if (k == 0 || promises_more(i, starts_[i][k])) active_.push_back(static_cast<Index>(i));
        begin_active([&](Index i) { return search_.seeds_->places[starts_[i][k].seed]; });
        return !active_.empty();
    }

    void begin_at(std::size_t first, const Places& places) {
        active_.resize(searches_.size());
        std::iota(active_.begin(), active_.end(), 0);
        begin_active([&](Index i) {
            const std::size_t from = first + static_cast<std::size_t>(i);
            return search_.charts_.chart_place(places.faces[from], places.corner(from), places.uv[2 * from], places.uv[2 * from + 1]);
        });
    }

    template <class PlaceOf>
    void begin_active(const PlaceOf& place_of) {
        for_each(active_.size(), [&](std::size_t j) {
            Search& search = searches_[active_[j]];
            search = Search();
            search.best = place_of(active_[j]);
            batch_.set(j, search_.charts_.surface_place(search.best));
        });
        begun_ = active_;
    }

    void descend() {
        for (int step = 0; step < most_steps && !active_.empty(); ++step) {
            evaluate_trials();
            take_trials();
            set_trials();
        }
        keep_nearest();
    }

    bool promises_more(std::size_t i, const Start& start) const {
        if (start.seed < 0) return false;
        const double distance = std::sqrt(found_[i].square) / search_.surface_.size();
        return distance > doubtful_part * search_.seeds_->radii[start.seed] && start.least < distance;
    }

    void keep_nearest() {
        for (const Index i : begun_)
            if (found_[i].square < 0 || searches_[i].square < found_[i].square) found_[i] = searches_[i];
    }

    void evaluate_trials() {
        SurfaceValues values;
        values.points = batch_.points.data(), values.du = batch_.du.data(), values.dv = batch_.dv.data();
        values.duu = batch_.duu.data(), values.duv = batch_.duv.data(), values.dvv = batch_.dvv.data();
        batch_.evaluate(search_.surface_, samples_, active_.size(), values);
    }

    void take_trials() {
        goes_on_.assign(active_.size(), 0);
        const bool is_double = search_.surface_.is_double();
        const double tolerance = (is_double ? double_tolerance : single_tolerance) * search_.surface_.size(), rounding = std::ldexp(8, is_double ? -53 : -24);
        for_each(active_.size(), [&](std::size_t k) {
            Search& search = searches_[active_[k]];
            goes_on_[k] = take_trial(k, rounding, search) && search.length > tolerance;
        });
        std::size_t kept = 0;
        for (std::size_t k = 0; k < active_.size(); ++k)
            if (goes_on_[k]) active_[kept++] = active_[k];
        active_.resize(kept);
    }

    /// A trial that is nearer becomes the best place, from which the next step goes; else the step was too long. Near the end squares of distances differ by
    /// their rounding alone while steps still shrink: there the search goes on as long as they do. False where it is at an end.
    bool take_trial(std::size_t k, double rounding, Search& search) {
        const Eigen::Vector3d way = Vector(&batch_.points[3 * k]) - target(active_[k]);
        const double before = search.square, square = way.squaredNorm(), length = search.length;
        if (before >= 0 && !(square <= before * (1 + rounding))) {
            search.halve();
            return true;
        }
        if (before >= 0) search.best = search.trial(search_.charts_);
        search.square = square;
        set_step(k, way, search);
        return before < 0 || before - square > rounding * before || search.length < length / 2;
    }

    /// Newton's step on |S - p|^2 / 2 in the chart: gradient (S - p) . S_a, .., second derivatives S_a . S_b + (S - p) . S_ab, ..
    void set_step(std::size_t k, const Eigen::Vector3d& way, Search& search) const {
        const SurfacePlace& place = batch_.places[k];
        const Vector u(&batch_.du[3 * k]), v(&batch_.dv[3 * k]), uu(&batch_.duu[3 * k]), uv(&batch_.duv[3 * k]), vv(&batch_.dvv[3 * k]);
        Eigen::Matrix2d turn, metric, bend;
        turn << place.ua, place.va, place.ub, place.vb;
        metric << u.dot(u), u.dot(v), u.dot(v), v.dot(v);
        bend << way.dot(uu), way.dot(uv), way.dot(uv), way.dot(vv);
        metric = (turn * metric * turn.transpose()).eval();
        Eigen::Vector2d step =
            newton_step(metric + turn * bend * turn.transpose(), metric, turn * Eigen::Vector2d(way.dot(u), way.dot(v)), search_.charts_.walls(search.best));
        const double longest = step.cwiseAbs().maxCoeff();
        if (longest > longest_step) step *= longest_step / longest;
        search.step_a = step[0], search.step_b = step[1];
        search.length = std::sqrt(std::max(0.0, step.dot(metric * step)));
    }

    void set_trials() {
        for_each(active_.size(), [&](std::size_t k) { batch_.set(k, search_.charts_.surface_place(searches_[active_[k]].trial(search_.charts_))); });
    }

    void give(std::size_t first, const ClosestPoints& out) {
        const std::size_t count = found_.size();
        for_each(count, [&](std::size_t i) { batch_.set(i, search_.charts_.surface_place(found_[i].best)); });
        SurfaceValues values;
        values.points = batch_.points.data(), values.normals = batch_.normals.data();
        batch_.evaluate(search_.surface_, samples_, count, values);
        for_each(count, [&](std::size_t i) {
            const Vector at(&batch_.points[3 * i]), normal(&batch_.normals[3 * i]);
            const Eigen::Vector3d way = target(i) - at;
            const std::size_t to = first + i;
            if (out.faces != nullptr) out.faces[to] = batch_.faces[i];
            if (out.corners != nullptr) out.corners[to] = batch_.corners[i];
            if (out.uv != nullptr) std::copy_n(&batch_.uv[2 * i], 2, out.uv + 2 * to);
            if (out.points != nullptr) std::copy_n(at.data(), 3, out.points + 3 * to);
            if (out.normals != nullptr) std::copy_n(normal.data(), 3, out.normals + 3 * to);
            if (out.distances != nullptr) out.distances[to] = way.dot(normal) < 0 ? -way.norm() : way.norm();
        });
    }

    ClosestSearch& search_;
    const double* points_;
    std::size_t stride_;
    std::vector<Search> searches_, found_;  // of the start at hand, and the nearest of all
    std::vector<std::array<Start, start_count>> starts_;
    std::vector<Index> begun_, active_;  // the points of this start, and those whose trials stand in batch_, in this order
    std::vector<char> goes_on_;
    Batch batch_;
    SamplePiece samples_;
};

void ClosestSearch::find(const double* points, std::size_t stride, std::size_t count, const ClosestPoints& out, const Places* start) {
    surface_.prepare_for(evaluations_a_point * count);
    for (std::size_t first = 0; first < count; first += DeviceSurface::piece_samples)
        Piece(*this, points + first * stride, stride, std::min(DeviceSurface::piece_samples, count - first)).run(first, out, start);
}

}  // namespace lcl
