// SPDX-License-Identifier: BSD-3-Clause
// Point clouds, and smooth surfaces through them.
//
//     const limitcl::Cloud cloud = limitcl::read_cloud("scan.ply");
//     const limitcl::Fit fit = limitcl::fit_surface(context, cloud, engine);   // engine: what makes a first mesh of the points
//     fit.report.require_ok();
//     limitcl::write_mesh(fit.mesh, "control.obj");                            // Doo-Sabin
#ifndef LIMITCL_POINTS_HPP
#define LIMITCL_POINTS_HPP

#include "device.hpp"
#include "io.hpp"
#include "limit_operator.hpp"
#include "scheme.hpp"

#include <exception>
#include <functional>
#include <utility>

namespace limitcl {

/// Points, and what may stand beside them. Never changed, so copies share it.
class Cloud {
public:
    /// points: count x 3, finite. normals: empty, or as many, of any length above 0, outwards. Errors: LCL_ERROR_INVALID_ARGUMENT, LCL_ERROR_BAD_INPUT.
    explicit Cloud(ArrayView<double> points, ArrayView<double> normals = {});
    /// Takes over a reference of the C API.
    explicit Cloud(CloudHandle handle) : handle_(std::move(handle)) {}

    lcl_cloud get() const { return handle_.get(); }
    std::size_t count() const { return lcl_cloud_count(get()); }
    bool has_normals() const { return lcl_cloud_has_normals(get()) != 0; }
    bool has_colours() const { return lcl_cloud_has_colours(get()) != 0; }
    /// count x 3, model units.
    std::vector<double> points() const;
    /// count x 3, as they came; colours from 0 to 1. Error LCL_ERROR_INVALID_ARGUMENT where there are none.
    std::vector<double> normals() const;
    std::vector<double> colours() const;
    /// Sentences on what reading left out or found doubtful.
    std::vector<std::string> warnings() const;

private:
    CloudHandle handle_;
};

/// Reads points: .ply .off .obj (their vertices), .xyz .pts .csv, each also with .gz; path "-" is standard input and needs a format. See lcl_cloud_read.
/// Errors: LCL_ERROR_FILE, LCL_ERROR_BAD_INPUT (the sentence has the line or point).
inline Cloud read_cloud(const std::string& path, Format format = Format::by_ending) {
    lcl_cloud cloud = nullptr;
    check(lcl_cloud_read(path.c_str(), static_cast<lcl_format>(format), &cloud));
    return Cloud(CloudHandle(cloud));
}

/// The same from a file's bytes in memory; `name` stands in messages.
inline Cloud read_cloud(const void* bytes, std::size_t size, Format format, const std::string& name = "memory") {
    lcl_cloud cloud = nullptr;
    check(lcl_cloud_read_memory(bytes, size, static_cast<lcl_format>(format), name.c_str(), &cloud));
    return Cloud(CloudHandle(cloud));
}

/// Options of an engine: keys and values.
using EngineSettings = std::vector<std::pair<std::string, std::string>>;

/// What an engine is called with: at least four points, all different, not all in a plane. The views end with the call.
struct EngineInput {
    ArrayView<double> points;   ///< count x 3
    ArrayView<double> normals;  ///< count x 3, unit, outwards; empty: none
    EngineSettings settings;
    /// fraction: 0 to 1, negative where it is not known. False: the caller wants to stop; what is returned then does not matter.
    std::function<bool(double fraction)> progress;
};

/// What an engine gives: a mesh near the points, which need be neither manifold nor oriented.
struct Approximation {
    std::vector<double> points;           ///< vertex_count x 3; empty: the points that came in
    std::vector<std::int32_t> triangles;  ///< triangle_count x 3, counter-clockwise seen from outside
    std::vector<std::int32_t> left_out;   ///< points that are outliers: they are not measured
    std::vector<std::string> warnings;    ///< they stand among the mesh's
};

/// What makes a polyhedral approximation of points: one of a library of engines (limitcl_engine.h), or a function.
class Engine {
public:
    using Function = std::function<Approximation(const EngineInput&)>;

    /// The library that it is from must stay loaded as long as the engine is used.
    explicit Engine(const lcl_engine& engine) : name_(engine.name ? engine.name : ""), engine_(engine) {}
    /// What the function throws reaches the caller of fit_surface.
    Engine(std::string name, Function function) : name_(std::move(name)), function_(std::move(function)) {}

    const std::string& name() const { return name_; }
    /// Empty for one of a library.
    const Function& function() const { return function_; }
    /// For one of a library.
    const lcl_engine& c_engine() const { return engine_; }

private:
    std::string name_;
    Function function_;
    lcl_engine engine_{};
};

enum class FitKind {
    interpolate = LCL_FIT_INTERPOLATE,     ///< the limit surface passes through the vertices of the approximation
    least_squares = LCL_FIT_LEAST_SQUARES  ///< squared distances of all points, and a bending energy, are smallest
};

enum class FitPhase {
    approximate = LCL_SURFACE_APPROXIMATE,
    simplify = LCL_SURFACE_SIMPLIFY,
    solve = LCL_SURFACE_SOLVE,
    measure = LCL_SURFACE_MEASURE,
    refine = LCL_SURFACE_REFINE
};

struct FitOptions {
    FitKind kind = FitKind::interpolate;
    double tolerance = 1e-3;  ///< of the distance of every point, relative to the diagonal
    int max_vertices = 0;     ///< at most so many, 4 or more; 0: as many as the tolerance takes
    int max_rounds = 30;      ///< solves of the whole fit
    int fill_holes = 0;       ///< boundary loops of at most so many edges are filled, 3 to 1000; 0: none
    double fair = 1e-3;       ///< least squares: weight of the bending energy, 0 or above
    Boundary boundary = Boundary::by_file;
    double crease_angle_degrees = 0;  ///< > 0: edges of the approximation whose face normals differ by more are creases, and stay
    EngineSettings engine;            ///< options of the engine
    Precision precision = Precision::mixed;
    double solve_tolerance = 1e-6;  ///< of each solve, relative to the diagonal
    int max_iterations = 200;       ///< of each solve
    bool keep_going = false;        ///< go on although A is singular or indefinite, or a solve does not converge
    /// round: from 0; fraction: of the phase, negative where it is not known; max_distance: of the last round, NaN before. Return false to cancel (Error
    /// LCL_ERROR_CANCELLED). What it throws reaches the caller of fit_surface.
    std::function<bool(FitPhase phase, int round, double fraction, double max_distance)> progress;
};

/// What a fit did. Lengths in model units.
struct FitReport {
    lcl_status status = LCL_OK;        ///< LCL_OK, LCL_ERROR_NOT_CONVERGED, LCL_ERROR_SINGULAR or LCL_ERROR_INDEFINITE
    bool converged = false;            ///< max <= tolerance x diagonal; false with LCL_OK where max_vertices came first
    std::string message;               ///< one sentence where the tolerance is not reached or a solve failed; "" otherwise
    double rms = 0, p95 = 0, max = 0;  ///< distances of the points to the limit surface
    double diagonal = 0;               ///< of the vertices of the approximation
    std::int64_t points = 0;           ///< points that were measured
    std::int64_t outside = 0;          ///< those farther away than the tolerance
    std::int64_t duplicates = 0;       ///< points at the place of an earlier one, dropped before all else
    std::int64_t left_out = 0;         ///< outliers by the engine
    std::int64_t unused = 0;           ///< measured points that are no vertex of the approximation
    int vertices = 0, faces = 0;       ///< of the control mesh
    int creases = 0;                   ///< of the control mesh
    double alpha = 0;                  ///< Catmull-Clark: the one in use
    int rounds = 0, iterations = 0;    ///< solves, and iterations of all of them
    double interpolation_error = 0;    ///< largest |limit point - vertex|; NaN for least squares
    int approximation_vertices = 0;    ///< what the engine gave, mended
    int approximation_faces = 0;       ///< of that
    int components = 0;                ///< of that
    int boundary_loops = 0;            ///< of that
    int filled_holes = 0;              ///< on request
    int dropped_faces = 0;             ///< beyond two at an edge
    int split_vertices = 0;            ///< where surfaces touched
    int simplified_vertices = 0;       ///< before the first solve
    double seconds_approximate = 0, seconds_simplify = 0, seconds_solve = 0, seconds_measure = 0, seconds_refine = 0, seconds_total = 0;

    /// Throws Error with status and message unless the status is LCL_OK.
    const FitReport& require_ok() const {
        if (status != LCL_OK) throw Error(status, message);
        return *this;
    }
};

struct Fit {
    Mesh mesh;  ///< control points, with the creases and corners that it is to be read with; its warnings tell what was mended
    FitReport report;
};

namespace detail {

// The C structs of one fit with all that they point to. Not copied: the C structs point into it.
class FitCall {
public:
    FitCall(const Engine& engine, const FitOptions& options);
    FitCall(const FitCall&) = delete;
    FitCall& operator=(const FitCall&) = delete;

    const lcl_engine* engine() const { return &engine_; }
    const lcl_surface_options* options() const { return &options_; }
    lcl_surface_report* report() { return &report_; }
    // Turns the status of the call into a report, or throws.
    FitReport finish(lcl_status status) const;

private:
    static std::int32_t forward_progress(void* user, lcl_surface_phase phase, std::int32_t round, double fraction, double max_distance);
    static std::int32_t run_engine(void* user, const lcl_engine_points* points, const lcl_engine_option* options, std::size_t option_count,
                                   const lcl_engine_sink* sink);
    std::int32_t run(const lcl_engine_points& points, const lcl_engine_option* options, std::size_t option_count, const lcl_engine_sink& sink) const;

    const Engine& wrapped_;
    std::function<bool(FitPhase, int, double, double)> progress_;
    EngineSettings settings_;
    std::vector<lcl_engine_option> c_settings_;
    std::exception_ptr thrown_;
    lcl_engine engine_;
    lcl_surface_options options_ = LCL_SURFACE_OPTIONS_INIT;
    lcl_surface_report report_ = LCL_SURFACE_REPORT_INIT;
};

}  // namespace detail

/// Control mesh of a limit surface through a cloud (Doo-Sabin paper): the engine's approximation is mended, oriented, simplified and interpolated, and gets
/// more vertices where points are farther away than the tolerance. See lcl_surface. A scheme by_faces is Doo-Sabin.
/// Not reaching the tolerance, singular and indefinite are results: see FitReport::status. Errors: LCL_ERROR_BAD_INPUT (fewer than four different points, all
/// of them in a plane, an engine that finds no surface), LCL_ERROR_INVALID_ARGUMENT (options, also the engine's), LCL_ERROR_MEMORY, LCL_ERROR_CANCELLED.
[[nodiscard]] inline Fit fit_surface(const Context& context, const Cloud& cloud, const Engine& engine, const FitOptions& options = {},
                                     const SchemeOptions& scheme = {}) {
    detail::FitCall call(engine, options);
    const lcl_scheme_options rules = scheme.to_c();
    lcl_mesh mesh = nullptr;
    const lcl_status status = lcl_surface(context.get(), cloud.get(), call.engine(), &rules, call.options(), &mesh, call.report());
    MeshHandle handle(mesh);
    FitReport report = call.finish(status);
    if (!handle) report.require_ok();
    return {Mesh(std::move(handle)), std::move(report)};
}

inline Cloud::Cloud(ArrayView<double> points, ArrayView<double> normals) {
    if (points.size() % 3 != 0 || (!normals.empty() && normals.size() != points.size()))
        throw Error(LCL_ERROR_INVALID_ARGUMENT, std::to_string(points.size()) + " coordinates and " + std::to_string(normals.size()) +
                                                    " of normals were given: three a point, and as many or none of normals");
    lcl_cloud cloud = nullptr;
    check(lcl_cloud_create(points.size() / 3, points.data(), 0, normals.empty() ? nullptr : normals.data(), 0, &cloud));
    handle_ = CloudHandle(cloud);
}

inline std::vector<double> Cloud::points() const {
    std::vector<double> points(3 * count());
    check(lcl_cloud_get(get(), points.data(), nullptr, nullptr));
    return points;
}

inline std::vector<double> Cloud::normals() const {
    std::vector<double> normals(3 * count());
    check(lcl_cloud_get(get(), nullptr, normals.data(), nullptr));
    return normals;
}

inline std::vector<double> Cloud::colours() const {
    std::vector<double> colours(3 * count());
    check(lcl_cloud_get(get(), nullptr, nullptr, colours.data()));
    return colours;
}

inline std::vector<std::string> Cloud::warnings() const {
    std::vector<std::string> notes;
    for (std::int32_t i = 0; i < lcl_cloud_note_count(get()); ++i) notes.emplace_back(lcl_cloud_note(get(), i));
    return notes;
}

inline detail::FitCall::FitCall(const Engine& engine, const FitOptions& options)
    : wrapped_(engine), progress_(options.progress), settings_(options.engine), engine_(engine.c_engine()) {
    for (const auto& setting : settings_) c_settings_.push_back({setting.first.c_str(), setting.second.c_str()});
    options_.fit = static_cast<lcl_fit>(options.kind);
    options_.tolerance = options.tolerance;
    options_.max_vertices = options.max_vertices;
    options_.max_rounds = options.max_rounds;
    options_.fill_holes = options.fill_holes;
    options_.fair = options.fair;
    options_.boundary = static_cast<lcl_boundary>(options.boundary);
    options_.crease_angle_degrees = options.crease_angle_degrees;
    options_.engine_options = c_settings_.data();
    options_.engine_option_count = c_settings_.size();
    options_.precision = static_cast<lcl_precision>(options.precision);
    options_.solve_tolerance = options.solve_tolerance;
    options_.max_iterations = options.max_iterations;
    options_.keep_going = options.keep_going;
    if (progress_) {
        options_.progress = &FitCall::forward_progress;
        options_.progress_user = this;
    }
    if (!engine.function()) return;
    engine_.struct_size = static_cast<std::uint32_t>(sizeof(lcl_engine));
    engine_.name = engine.name().c_str();
    engine_.description = engine_.licence = engine_.options = "";
    engine_.run = &FitCall::run_engine;
    engine_.user = this;
}

// An exception must not pass through C: both callbacks stop the call, and finish() lets it go on.

inline std::int32_t detail::FitCall::forward_progress(void* user, lcl_surface_phase phase, std::int32_t round, double fraction, double max_distance) {
    FitCall& call = *static_cast<FitCall*>(user);
    try {
        return call.progress_(static_cast<FitPhase>(phase), round, fraction, max_distance);
    } catch (...) {
        call.thrown_ = std::current_exception();
        return 0;
    }
}

inline std::int32_t detail::FitCall::run_engine(void* user, const lcl_engine_points* points, const lcl_engine_option* options, std::size_t option_count,
                                                const lcl_engine_sink* sink) {
    FitCall& call = *static_cast<FitCall*>(user);
    try {
        return call.run(*points, options, option_count, *sink);
    } catch (...) {
        call.thrown_ = std::current_exception();
        return LCL_ENGINE_CANCELLED;
    }
}

inline std::int32_t detail::FitCall::run(const lcl_engine_points& points, const lcl_engine_option* options, std::size_t option_count,
                                         const lcl_engine_sink& sink) const {
    const std::size_t size = 3 * static_cast<std::size_t>(points.count);
    bool is_cancelled = false;
    EngineInput input;
    input.points = ArrayView<double>(points.points, size);
    if (points.normals) input.normals = ArrayView<double>(points.normals, size);
    for (std::size_t i = 0; i < option_count; ++i) input.settings.emplace_back(options[i].key, options[i].value);
    input.progress = [&](double fraction) {
        if (!sink.progress(sink.self, fraction)) is_cancelled = true;
        return !is_cancelled;
    };
    const Approximation found = wrapped_.function()(input);
    if (is_cancelled) return LCL_ENGINE_CANCELLED;
    if (found.points.size() % 3 != 0 || found.triangles.size() % 3 != 0 || found.triangles.size() / 3 > INT32_MAX || found.points.size() / 3 > INT32_MAX)
        throw Error(LCL_ERROR_INVALID_ARGUMENT, "the engine '" + wrapped_.name() + "' gave " + std::to_string(found.points.size()) + " coordinates and " +
                                                    std::to_string(found.triangles.size()) + " corners: three a vertex and a triangle");
    const bool keeps_points = found.points.empty();
    const std::int32_t vertex_count = keeps_points ? points.count : static_cast<std::int32_t>(found.points.size() / 3);
    sink.give(sink.self, vertex_count, keeps_points ? nullptr : found.points.data(), static_cast<std::int32_t>(found.triangles.size() / 3),
              found.triangles.data());
    if (!found.left_out.empty()) sink.leave_out(sink.self, static_cast<std::int32_t>(found.left_out.size()), found.left_out.data());
    for (const std::string& warning : found.warnings) sink.warn(sink.self, warning.c_str());
    return LCL_ENGINE_OK;
}

inline FitReport detail::FitCall::finish(lcl_status status) const {
    if (thrown_) std::rethrow_exception(thrown_);
    if (status != LCL_OK && status != LCL_ERROR_SINGULAR && status != LCL_ERROR_INDEFINITE && status != LCL_ERROR_NOT_CONVERGED) throw Error::last(status);
    FitReport report;
    report.status = status;
    report.converged = report_.converged != 0;
    report.message = status == LCL_OK ? report_.message : lcl_last_error();
    report.rms = report_.rms;
    report.p95 = report_.p95;
    report.max = report_.max;
    report.diagonal = report_.diagonal;
    report.points = report_.point_count;
    report.outside = report_.outside_count;
    report.duplicates = report_.duplicate_count;
    report.left_out = report_.left_out_count;
    report.unused = report_.unused_count;
    report.vertices = report_.vertices;
    report.faces = report_.faces;
    report.creases = report_.creases;
    report.alpha = report_.alpha;
    report.rounds = report_.rounds;
    report.iterations = report_.iterations;
    report.interpolation_error = report_.interpolation_error;
    report.approximation_vertices = report_.approximation_vertices;
    report.approximation_faces = report_.approximation_faces;
    report.components = report_.components;
    report.boundary_loops = report_.boundary_loops;
    report.filled_holes = report_.filled_holes;
    report.dropped_faces = report_.dropped_faces;
    report.split_vertices = report_.split_vertices;
    report.simplified_vertices = report_.simplified_vertices;
    report.seconds_approximate = report_.seconds_approximate;
    report.seconds_simplify = report_.seconds_simplify;
    report.seconds_solve = report_.seconds_solve;
    report.seconds_measure = report_.seconds_measure;
    report.seconds_refine = report_.seconds_refine;
    report.seconds_total = report_.seconds_total;
    return report;
}

}  // namespace limitcl

#endif
