// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/surface.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/operator/suitability.h"
#include "host/points/cloud.h"
#include "host/points/fit_mesh.h"
#include "host/points/holes.h"
#include "host/points/insert.h"
#include "host/points/least_squares.h"
#include "host/points/simplify.h"
#include "host/points/stopwatch.h"

namespace lcl {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t small_hole = 10;                                         // edges: what engines leave where points are uneven or noisy
constexpr double worth_a_vertex = 0.1;                                         // of the tolerance
constexpr double usual_turn = 90, turns_of_normals[] = {60, usual_turn, 180};  // degrees: points that the approximation has left off come last
constexpr double room_to_insert = 0.8;  // of the vertices that are allowed: where the simplification stops, so that points can be put where they are needed

/// What one fit works on.
class SurfaceFit {
public:
    SurfaceFit(const std::shared_ptr<Context>& context, const PointCloud& cloud, const lcl_engine& engine, const SurfaceOptions& options)
        : context_(context), engine_(engine), options_(options), scheme_(options.scheme), distinct_(distinct_points(cloud)) {
        report().duplicate_count = distinct_.duplicate_count;
    }

    SurfaceResult run() {
        make_fit_mesh();
        simplify_mesh();
        while (fit_round()) continue;
        if (sharply_inserted_ > 0)
            out_.warnings.push_back("points became vertices where the surface has to turn by more than 90 degrees to meet them: " +
                                    std::to_string(sharply_inserted_) + "; if they are outliers, the engine's options can leave them out");
        give_colours();
        return std::move(out_);
    }

private:
    SurfaceReport& report() { return out_.report; }
    double tolerance() { return options_.tolerance * report().diagonal; }

    void tell(SurfacePhase phase, double fraction) {
        if (options_.progress && !options_.progress(phase, report().rounds, fraction, report().rounds > 0 ? report().distances.max : not_known))
            throw Cancelled("the fit of a surface to the points was cancelled");
    }

    void make_fit_mesh() {
        const Stopwatch watch(report().seconds_approximate);
        tell(SurfacePhase::approximate, 0);
        Approximation found = approximate(engine_, distinct_.cloud, options_.engine_options, [this](double fraction) {
            tell(SurfacePhase::approximate, fraction);
            return true;
        });
        out_.warnings = std::move(found.warnings);
        MendedMesh mended = mend(found.raw, engine_.name);
        if (mended.mesh.face_count() == 0) throw BadInput("engine " + std::string(engine_.name) + " found no surface in these points");
        if (!found.keeps_points) mended.source.assign(mended.source.size(), -1);
        choose_measured(found.is_out, mended.source);
        orient(mended.mesh, values_at_vertices(distinct_.cloud, distinct_.cloud.normals, mended.mesh.positions, mended.source));
        if (options_.fill_holes > 0) report().filled_holes = fill_holes(mended.mesh, options_.fill_holes);
        describe(mended);
        mesh_ = fit_mesh(mended.mesh, mended.source);
    }

    /// All points but the outliers that the engine was told to leave out.
    void choose_measured(const std::vector<std::uint8_t>& is_out, const std::vector<Index>& source) {
        std::vector<std::uint8_t> is_used(is_out.size(), 0);
        for (const Index point : source)
            if (point >= 0) is_used[point] = 1;
        std::vector<Index> measured;
        for (std::size_t i = 0; i < is_out.size(); ++i) {
            if (is_out[i] == 0) measured.push_back(static_cast<Index>(i));
            report().unused_count += is_out[i] == 0 && is_used[i] == 0;
        }
        report().point_count = measured.size();
        report().left_out_count = is_out.size() - measured.size();
        if (measured.empty()) throw BadInput("engine " + std::string(engine_.name) + " left out all points as outliers: ask it to leave out fewer");
        distances_.emplace(distinct_.cloud.points, std::move(measured));
    }

    void describe(const MendedMesh& mended) {
        const Topology topology = build_topology(mended.mesh);
        connected_components(topology, report().components);
        const std::vector<std::vector<Index>> loops = boundary_loops(topology);
        report().boundary_loops = static_cast<Index>(loops.size());
        const auto small = std::count_if(loops.begin(), loops.end(), [](const std::vector<Index>& loop) { return loop.size() <= small_hole; });
        if (small > 0 && options_.fill_holes < static_cast<int>(small_hole))
            out_.warnings.push_back("the approximation has " + std::to_string(small) + " holes of at most " + std::to_string(small_hole) +
                                    " edges, which can be filled on request");
        report().approximation_vertices = mended.mesh.vertex_count;
        report().approximation_faces = mended.mesh.face_count();
        report().dropped_faces = mended.dropped_faces;
        report().split_vertices = mended.split_vertices;
        report().diagonal = bounding_box_diagonal(mended.mesh, topology);
    }

    void simplify_mesh() {
        const Stopwatch watch(report().seconds_simplify);
        tell(SurfacePhase::simplify, 0);
        SimplifyOptions simplify_options;
        simplify_options.tolerance = tolerance();
        simplify_options.is_graded = options_.crease_angle_degrees > 0;  // curves along creases swing where short edges meet long ones
        const bool will_insert = options_.fit == FitKind::interpolate;
        simplify_options.max_vertices = static_cast<std::size_t>(will_insert ? room_to_insert * options_.max_vertices : options_.max_vertices);
        if (options_.max_vertices > 0) simplify_options.max_vertices = std::max<std::size_t>(4, simplify_options.max_vertices);
        const auto vertices = static_cast<double>(mesh_.n_vertices());
        simplify_options.progress = [&](std::size_t collapses) {
            tell(SurfacePhase::simplify, static_cast<double>(collapses) / vertices);
            return true;
        };
        simplify(mesh_, simplify_options);
        report().simplified_vertices = static_cast<Index>(mesh_.n_vertices());
    }

    /// Solves and measures. True where another round should follow.
    bool fit_round() {
        tell(SurfacePhase::solve, -1);
        const PolygonMesh mesh = polygon_mesh(mesh_);
        const Topology topology = build_topology(mesh);
        FeatureOptions asked;
        asked.boundary = options_.boundary;
        asked.crease_angle_degrees = options_.crease_angle_degrees;
        const Features features = find_features(mesh, topology, asked);
        report().creases = features.crease_count;
        std::vector<double> control = solve(mesh, topology, features);
        if (control.empty()) {
            out_.mesh = PolygonMesh();
            report().distances = FitDistances();
            report().converged = false;
            return false;
        }
        const bool goes_on =
            options_.fit == FitKind::least_squares ? fit_by_least_squares(topology, features, control) : measure_round(topology, features, control);
        keep(mesh, topology, features, std::move(control));
        return goes_on;
    }

    DeviceSurface make_surface(const Topology& topology, const Features& features) {
        const bool is_double = options_.solve.precision != Precision::single && context_->device().has_double;
        return DeviceSurface(context_, build_patch_table(topology, features, scheme_), is_double ? Real::full : Real::single);
    }

    /// Empty where the operator has no inverse; the solve's status says why.
    std::vector<double> solve(const PolygonMesh& mesh, const Topology& topology, const Features& features) {
        const Stopwatch watch(report().seconds_solve);
        const auto make = [&] { return make_limit_system(context_, mesh, topology, features, scheme_, {}); };
        const bool chooses_alpha = options_.alpha_auto && report().rounds == 0;
        const std::unique_ptr<LimitSystem> system = chooses_alpha ? make_with_auto_alpha(scheme_, make) : make();
        report().alpha = scheme_.alpha;
        SolveOptions solve_options = options_.solve;
        solve_options.diagonal = report().diagonal;
        std::vector<double> control = mesh.positions;
        out_.solve = solve_host(*system, mesh.positions.data(), 3, 3, solve_options, false, control.data(), 3);
        report().iterations += out_.solve.iterations;
        const bool is_done = out_.solve.status == SolveStatus::converged || options_.solve.keep_going;
        const bool is_finite = std::all_of(control.begin(), control.end(), [](double value) { return std::isfinite(value); });
        return is_done && is_finite ? control : std::vector<double>();
    }

    /// Measures the points whose part of the mesh has changed, and all of them where no other seems to be too far, or where this round is the last.
    bool measure_round(const Topology& topology, const Features& features, const std::vector<double>& control) {
        tell(SurfacePhase::measure, -1);
        std::optional<Stopwatch> watch(report().seconds_measure);
        DeviceSurface surface = make_surface(topology, features);
        surface.set_points(control.data(), 3);
        ClosestSearch search(surface);
        bool is_whole = report().rounds == 0;
        const auto measure_all = [&] {
            distances_->measure_all(search, mesh_, out_.solve.max_error);
            is_whole = true;
            note_distances();
        };
        if (!is_whole) {
            distances_->measure_changed(search, mesh_, out_.solve.max_error);
            note_distances();
        }
        if (is_whole || report().converged) measure_all();
        ++report().rounds;
        watch.reset();
        if (wants_more()) return true;
        if (is_whole) return false;
        watch.emplace(report().seconds_measure);
        measure_all();
        watch.reset();
        return wants_more();
    }

    void note_distances() {
        report().distances = distances_->statistics(tolerance());
        report().converged = report().distances.outside == 0;
    }

    /// Never goes on: it does all its rounds by itself.
    bool fit_by_least_squares(const Topology& topology, const Features& features, std::vector<double>& control) {
        DeviceSurface surface = make_surface(topology, features);
        LeastSquaresOptions least;
        least.fair = options_.fair;
        least.max_corrections = options_.max_rounds;
        least.progress = [this](int corrections, double largest) {
            report().rounds = corrections;
            report().distances.max = largest;
            tell(SurfacePhase::solve, -1);
            return true;
        };
        LeastSquaresFit fit = fit_least_squares(surface, distances_->points(), std::move(control), least);
        control = std::move(fit.control);
        distances_->set(std::move(fit.distances));
        report().rounds = fit.corrections;
        report().iterations += fit.iterations;
        report().seconds_solve += fit.seconds_solve;
        report().seconds_measure += fit.seconds_measure;
        note_distances();
        if (!report().converged)
            report().message = far_points() + ": a least-squares fit keeps its " + std::to_string(mesh_.n_vertices()) +
                               " vertices; raise the tolerance, lower W, or give a larger number of vertices";
        return false;
    }

    void keep(const PolygonMesh& mesh, const Topology& topology, const Features& features, std::vector<double> control) {
        out_.mesh = mesh;
        out_.mesh.positions = std::move(control);
        out_.features = FeatureOptions();
        out_.features.boundary = options_.boundary;
        for (Index e = 0; e < topology.edge_count; ++e)
            if (features.edge_is_sharp[e] && !topology.is_boundary_edge(e))
                out_.features.creases.push_back({topology.origin(topology.edge_half_edge[e]), topology.destination(topology.edge_half_edge[e])});
        if (options_.fit == FitKind::interpolate) report().interpolation_error = out_.solve.max_error;
    }

    std::string far_points() {
        return std::to_string(report().distances.outside) + " of " + std::to_string(distances_->count()) +
               " points are farther from the surface than the tolerance";
    }

    /// Says why there is no further round where the tolerance is not reached.
    bool wants_more() {
        report().message.clear();
        if (report().converged) return false;
        const std::string far = far_points();
        if (options_.max_vertices > 0 && mesh_.n_vertices() >= static_cast<std::size_t>(options_.max_vertices)) {
            const bool is_more = mesh_.n_vertices() > static_cast<std::size_t>(options_.max_vertices);
            report().message = far + ": " + std::to_string(mesh_.n_vertices()) + " vertices, as many as are allowed" +
                               (is_more ? " or as few as the parts and boundary loops of the mesh take" : "") + ", do not reach it";
            return false;
        }
        if (report().rounds >= options_.max_rounds) {
            report().message = far + " after " + std::to_string(report().rounds) + " rounds, as many as are allowed";
            return false;
        }
        if (insert()) return true;
        report().message =
            far +
            ", and lie off it where they cannot become vertices: leave out outliers or smooth noise by the engine's options, raise the tolerance, or "
            "give a number of vertices";
        return false;
    }

    /// Points that are too far become vertices; where none of them can, others of the faces that they are nearest to.
    bool insert() {
        const Stopwatch watch(report().seconds_refine);
        tell(SurfacePhase::refine, -1);
        const std::vector<FarPoint> far = distances_->far_points(tolerance());
        for (const double turn : turns_of_normals) {
            const std::size_t inserted = insert(far, turn);
            if (turn > usual_turn) sharply_inserted_ += inserted;
            if (inserted > 0) return true;
        }
        std::vector<std::uint8_t> is_far(mesh_.n_faces(), 0);
        for (const FarPoint& point : far) is_far[point.face] = 1;
        std::vector<FarPoint> beside = distances_->far_points(worth_a_vertex * tolerance());
        beside.erase(std::remove_if(beside.begin(), beside.end(), [&](const FarPoint& point) { return is_far[point.face] == 0; }), beside.end());
        return insert(beside, usual_turn) > 0;
    }

    std::size_t insert(const std::vector<FarPoint>& far, double most_turn) {
        InsertOptions insert_options;
        insert_options.most_turn_degrees = most_turn;
        insert_options.max_vertices = static_cast<std::size_t>(options_.max_vertices);
        if (options_.crease_angle_degrees > 0) insert_options.feature_degrees = std::min(insert_options.feature_degrees, options_.crease_angle_degrees);
        return insert_points(mesh_, far, distinct_.cloud.points, insert_options);
    }

    void give_colours() {
        if (out_.mesh.vertex_count == 0) return;
        std::vector<Index> source;
        std::vector<double> places;
        for (const OpenMesh::VertexHandle vertex : mesh_.vertices()) {
            source.push_back(mesh_.data(vertex).source);
            const FitMesh::Point& point = mesh_.point(vertex);
            places.insert(places.end(), {point[0], point[1], point[2]});
        }
        out_.colours = values_at_vertices(distinct_.cloud, distinct_.cloud.colours, places, source);
    }

    std::shared_ptr<Context> context_;
    const lcl_engine& engine_;
    const SurfaceOptions& options_;
    SchemeOptions scheme_;
    DistinctPoints distinct_;
    std::optional<CloudDistances> distances_;  // of the distinct points that count
    FitMesh mesh_;                             // its sources are numbers among the distinct points
    std::size_t sharply_inserted_ = 0;         // points that a normal turned by more than 90 degrees for
    SurfaceResult out_;
};

}  // namespace

SurfaceResult surface_from_points(const std::shared_ptr<Context>& context, const PointCloud& cloud, const lcl_engine& engine, const SurfaceOptions& options) {
    return SurfaceFit(context, cloud, engine, options).run();
}

}  // namespace lcl
