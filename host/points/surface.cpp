// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/surface.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "host/evaluate/closest.h"
#include "host/operator/suitability.h"
#include "host/points/cloud.h"
#include "host/points/fit_mesh.h"
#include "host/points/holes.h"
#include "host/points/insert.h"
#include "host/points/least_squares.h"
#include "host/points/simplify.h"

namespace lcl {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr int changed_rings = 3;
constexpr double worth_a_vertex = 0.1;                                         // of the tolerance
constexpr double usual_turn = 90, turns_of_normals[] = {60, usual_turn, 175};  // degrees: points that the approximation has left off come last
constexpr double room_to_insert = 0.8;  // of the vertices that are allowed: where the simplification stops, so that points can be put where they are needed

class Stopwatch {
public:
    explicit Stopwatch(double& seconds) : seconds_(seconds), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& seconds_;
    std::chrono::steady_clock::time_point start_;
};

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
        orient(mended.mesh, normals_at(mended));
        if (options_.fill_holes > 0) report().filled_holes = fill_holes(mended.mesh, options_.fill_holes);
        describe(mended);
        mesh_ = fit_mesh(mended.mesh, mended.source);
    }

    /// All points but the outliers that the engine was told to leave out.
    void choose_measured(const std::vector<std::uint8_t>& is_out, const std::vector<Index>& source) {
        std::vector<std::uint8_t> is_used(is_out.size(), 0);
        for (const Index point : source)
            if (point >= 0) is_used[point] = 1;
        for (std::size_t i = 0; i < is_out.size(); ++i) {
            if (is_out[i]) {
                ++report().left_out_count;
                continue;
            }
            report().unused_count += !is_used[i];
            measured_.push_back(static_cast<Index>(i));
            points_.insert(points_.end(), &distinct_.cloud.points[3 * i], &distinct_.cloud.points[3 * i] + 3);
        }
        report().point_count = measured_.size();
        if (measured_.empty()) throw BadInput("engine " + std::string(engine_.name) + " left out all points as outliers: ask it to leave out fewer");
    }

    /// Normals of the points at the vertices, or nearest to them; empty without.
    std::vector<double> normals_at(const MendedMesh& mended) const { return values_at(distinct_.cloud.normals, mended.mesh.positions, mended.source); }

    std::vector<double> values_at(const std::vector<double>& values, const std::vector<double>& places, const std::vector<Index>& source) const {
        if (values.empty()) return {};
        std::vector<Index> of = source;
        std::vector<double> unknown;
        for (std::size_t v = 0; v < of.size(); ++v)
            if (of[v] < 0) unknown.insert(unknown.end(), &places[3 * v], &places[3 * v] + 3);
        const std::vector<Index> nearest = unknown.empty() ? std::vector<Index>() : nearest_points(distinct_.cloud.points, unknown);
        std::size_t next = 0;
        std::vector<double> out;
        for (Index& point : of) {
            if (point < 0) point = nearest[next++];
            out.insert(out.end(), &values[3 * static_cast<std::size_t>(point)], &values[3 * static_cast<std::size_t>(point)] + 3);
        }
        return out;
    }

    void describe(const MendedMesh& mended) {
        const Topology topology = build_topology(mended.mesh);
        connected_components(topology, report().components);
        report().boundary_loops = static_cast<Index>(boundary_loops(topology).size());
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
        if (control.empty()) return false;
        DeviceSurface surface(context_, build_patch_table(topology, features, scheme_),
                              options_.solve.precision == Precision::single || !context_->device().has_double ? Real::single : Real::full);
        if (options_.fit == FitKind::least_squares) {
            fit_by_least_squares(surface, control);
            keep(mesh, topology, features, std::move(control));
            return false;
        }
        surface.set_points(control.data(), 3);
        ClosestSearch search(surface);
        measure(search);
        keep(mesh, topology, features, std::move(control));
        ++report().rounds;
        if (wants_more()) return true;
        if (is_whole_) return false;
        measure_all(search);  // what is reported holds of all points
        return wants_more();
    }

    /// Empty where the operator has no inverse; the solve's status says why.
    std::vector<double> solve(const PolygonMesh& mesh, const Topology& topology, const Features& features) {
        const Stopwatch watch(report().seconds_solve);
        std::unique_ptr<LimitSystem> system = make_limit_system(context_, mesh, topology, features, scheme_, {});
        if (options_.alpha_auto && report().rounds == 0 && scheme_.scheme == Scheme::catmull_clark && wants_other_alpha(*system)) {
            scheme_.alpha = auto_alpha;
            system = make_limit_system(context_, mesh, topology, features, scheme_, {});
        }
        report().alpha = scheme_.alpha;
        SolveOptions solve_options = options_.solve;
        solve_options.diagonal = report().diagonal;
        std::vector<double> control = mesh.positions;
        out_.solve = solve_host(*system, mesh.positions.data(), 3, 3, solve_options, false, control.data(), 3);
        report().iterations += out_.solve.iterations;
        const bool is_done = out_.solve.status == SolveStatus::converged || options_.solve.keep_going;
        return is_done ? control : std::vector<double>();
    }

    /// Distances of the points whose part of the mesh has changed; of all where that was all, or where no point seems to be too far.
    void measure(ClosestSearch& search) {
        const Stopwatch watch(report().seconds_measure);
        tell(SurfacePhase::measure, -1);
        is_whole_ = false;
        if (measured_vertices_ > 0) measure(search, points_of_changed_faces());
        if (measured_vertices_ == 0 || report().distances.outside == 0) measure_all(search);
        measured_vertices_ = mesh_.n_vertices();
    }

    void measure_all(ClosestSearch& search) {
        std::vector<Index> all(measured_.size());
        std::iota(all.begin(), all.end(), 0);
        faces_.resize(all.size());
        distances_.resize(all.size());
        measure(search, all);
        is_whole_ = true;
    }

    /// A new vertex moves the surface some rings of faces away, and farther off by less than rounding would show.
    std::vector<Index> points_of_changed_faces() const {
        std::vector<std::uint8_t> is_near(mesh_.n_vertices(), 0);
        std::fill(is_near.begin() + static_cast<std::ptrdiff_t>(measured_vertices_), is_near.end(), 1);
        for (int ring = 1; ring <= changed_rings; ++ring)
            for (const OpenMesh::FaceHandle face : mesh_.faces()) {
                const auto corners = mesh_.fv_range(face);
                if (std::none_of(corners.begin(), corners.end(), [&](OpenMesh::VertexHandle v) { return is_near[v.idx()] != 0 && is_near[v.idx()] <= ring; }))
                    continue;
                for (const OpenMesh::VertexHandle v : corners)
                    if (is_near[v.idx()] == 0) is_near[v.idx()] = static_cast<std::uint8_t>(ring + 1);
            }
        std::vector<Index> places;
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            const auto corners = mesh_.fv_range(mesh_.face_handle(faces_[i]));
            if (std::any_of(corners.begin(), corners.end(), [&](OpenMesh::VertexHandle v) { return is_near[v.idx()] != 0; }))
                places.push_back(static_cast<Index>(i));
        }
        return places;
    }

    /// places: in points_.
    void measure(ClosestSearch& search, const std::vector<Index>& places) {
        std::vector<double> points(3 * places.size()), distances(places.size());
        std::vector<Index> faces(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) std::copy_n(&points_[3 * static_cast<std::size_t>(places[i])], 3, &points[3 * i]);
        ClosestPoints found;
        found.faces = faces.data();
        found.distances = distances.data();
        search.find(points.data(), 3, places.size(), found);
        for (std::size_t i = 0; i < places.size(); ++i) {
            faces_[places[i]] = faces[i];
            distances_[places[i]] = std::fabs(distances[i]);
        }
        limit_distances_of_vertices();
        report().distances = statistics();
    }

    /// A vertex is no farther from the surface than from its limit point, whatever the search says.
    void limit_distances_of_vertices() {
        std::vector<Index> place(distinct_.cloud.count(), -1);
        for (std::size_t i = 0; i < measured_.size(); ++i) place[measured_[i]] = static_cast<Index>(i);
        for (const OpenMesh::VertexHandle vertex : mesh_.vertices()) {
            const Index source = mesh_.data(vertex).source;
            if (source >= 0 && place[source] >= 0) distances_[place[source]] = std::min(distances_[place[source]], out_.solve.max_error);
        }
    }

    FitDistances statistics() {
        FitDistances out;
        std::vector<double> sorted = distances_;
        for (const double distance : sorted) {
            out.rms += distance * distance;
            out.outside += distance > tolerance();
        }
        out.rms = std::sqrt(out.rms / static_cast<double>(sorted.size()));
        const auto at_95 = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() * 95 + 99) / 100 - 1);
        std::nth_element(sorted.begin(), at_95, sorted.end());
        out.p95 = *at_95;
        out.max = *std::max_element(at_95, sorted.end());
        return out;
    }

    void fit_by_least_squares(DeviceSurface& surface, std::vector<double>& control) {
        LeastSquaresOptions least;
        least.fair = options_.fair;
        least.max_corrections = options_.max_rounds;
        least.progress = [this](int corrections, double largest) {
            report().rounds = corrections;
            report().distances.max = largest;
            tell(SurfacePhase::solve, -1);
            return true;
        };
        LeastSquaresFit fit = fit_least_squares(surface, points_, std::move(control), least);
        control = std::move(fit.control);
        distances_ = std::move(fit.distances);
        report().rounds = fit.corrections;
        report().iterations += fit.iterations;
        report().seconds_solve += fit.seconds_solve;
        report().seconds_measure += fit.seconds_measure;
        report().distances = statistics();
        report().converged = report().distances.outside == 0;
        if (!report().converged)
            report().message = far_points() + ": a least-squares fit keeps its " + std::to_string(mesh_.n_vertices()) +
                               " vertices; raise the tolerance, lower W, or give a larger number of vertices";
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
        return std::to_string(report().distances.outside) + " of " + std::to_string(measured_.size()) +
               " points are farther from the surface than the tolerance";
    }

    /// Says why there is no further round where the tolerance is not reached.
    bool wants_more() {
        report().message.clear();
        report().converged = report().distances.outside == 0;
        if (report().converged) return false;
        const std::string far = far_points();
        if (options_.max_vertices > 0 && mesh_.n_vertices() >= static_cast<std::size_t>(options_.max_vertices)) {
            report().message = far + ": " + std::to_string(mesh_.n_vertices()) + " vertices, as many as are allowed, do not reach it";
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
        std::vector<std::uint8_t> is_far(mesh_.n_faces(), 0);
        std::vector<FarPoint> far, beside;
        for (std::size_t i = 0; i < measured_.size(); ++i)
            if (distances_[i] > tolerance()) {
                far.push_back({measured_[i], faces_[i], distances_[i]});
                is_far[faces_[i]] = 1;
            }
        for (const double turn : turns_of_normals) {
            const std::size_t inserted = insert(far, turn);
            if (turn > usual_turn) sharply_inserted_ += inserted;
            if (inserted > 0) return true;
        }
        for (std::size_t i = 0; i < measured_.size(); ++i)
            if (is_far[faces_[i]] && distances_[i] > worth_a_vertex * tolerance()) beside.push_back({measured_[i], faces_[i], distances_[i]});
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
        std::vector<Index> source;
        std::vector<double> places;
        for (const OpenMesh::VertexHandle vertex : mesh_.vertices()) {
            source.push_back(mesh_.data(vertex).source);
            const FitMesh::Point& point = mesh_.point(vertex);
            places.insert(places.end(), {point[0], point[1], point[2]});
        }
        out_.colours = values_at(distinct_.cloud.colours, places, source);
    }

    std::shared_ptr<Context> context_;
    const lcl_engine& engine_;
    const SurfaceOptions& options_;
    SchemeOptions scheme_;
    DistinctPoints distinct_;
    std::vector<Index> measured_;  // numbers among the distinct points
    std::vector<double> points_;   // the places of these
    FitMesh mesh_;                 // its sources are numbers among the distinct points
    std::vector<Index> faces_;     // of the closest places, as far as measured
    std::vector<double> distances_;
    std::size_t measured_vertices_ = 0;  // of the mesh when they were measured last
    std::size_t sharply_inserted_ = 0;   // points that a normal turned by more than 90 degrees for
    bool is_whole_ = false;              // the last round measured all points
    SurfaceResult out_;
};

}  // namespace

SurfaceResult surface_from_points(const std::shared_ptr<Context>& context, const PointCloud& cloud, const lcl_engine& engine, const SurfaceOptions& options) {
    return SurfaceFit(context, cloud, engine, options).run();
}

}  // namespace lcl
