// SPDX-License-Identifier: BSD-3-Clause
#include "host/two_phase/two_phase.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "host/parallel.h"
#include "host/two_phase/umbrella_steps.h"

namespace lcl {
namespace {

constexpr double fair_tolerance = 1e-8;  // of the residual, relative to its start: of the energy some 1e-16
constexpr int most_fair_iterations = 1000;
constexpr double runaway_growth = 10;       // of the residual, where the solvers give up too
constexpr double unit_length_slack = 1e-5;  // what six decimals of a text leave

/// 1 where the limit point is Q: everywhere but at vertices outside the subset, whose rows are identity rows although they are neither corners nor isolated.
std::vector<std::uint8_t> constrained_vertices(const Plan& plan, const Features& features) {
    std::vector<std::uint8_t> constrained(plan.vertex_count, 1);
    for (Index row = plan.fixed.first_row; row < plan.fixed.end_row(); ++row) {
        const VertexKind kind = features.kind[plan.vertex_of_row[row]];
        constrained[plan.vertex_of_row[row]] = kind == VertexKind::corner || kind == VertexKind::isolated;
    }
    return constrained;
}

void check_ratios(const SchemeOptions& scheme, const Topology& topology) {
    if (scheme.scheme != Scheme::catmull_clark)
        throw InvalidArgument(std::string("the refined mesh M^1 belongs to the two-phase scheme, and the scheme is ") + scheme_name(scheme.scheme) +
                              ": take catmull-clark with a blend ratio lambda");
    for (Index v = 0; v < topology.vertex_count; ++v) {
        const double lambda = scheme.lambda_at(v);
        if ((lambda > 0 && lambda < 1) || topology.is_isolated(v)) continue;
        const std::string where = scheme.lambda_per_vertex.empty() ? "lambda" : "lambda of vertex " + std::to_string(v);
        throw InvalidArgument(
            where + " is " + std::to_string(lambda) + ", and the refined mesh M^1 needs blend ratios above 0 and below 1: 0.2 to 0.5 look good", {{v}, {}});
    }
}

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

void check_handle(double handle, const std::string& what, const Where& where) {
    if (handle > 0 && std::isfinite(handle)) return;
    throw InvalidArgument(what + " is " + number_text(handle) + ": shape handles are numbers above 0", where);
}

std::vector<double> handles_of(const Topology& topology, const std::vector<double>& points, const TwoPhaseOptions& options, TwoPhaseReport& report) {
    std::vector<double> handles(topology.vertex_count, options.convex_handle);
    if (!options.handles.empty()) {
        for (Index v = 0; v < topology.vertex_count; ++v) check_handle(options.handles[v], "the shape handle of vertex " + std::to_string(v), {{v}, {}});
        return options.handles;
    }
    check_handle(options.convex_handle, "the shape handle of convex vertices", {});
    check_handle(options.other_handle, "the shape handle of non-convex vertices", {});
    if (options.convex_handle == options.other_handle) return handles;
    const std::vector<std::uint8_t> convex = convex_vertices(topology, points);
    for (Index v = 0; v < topology.vertex_count; ++v) {
        report.convex_count += convex[v];
        if (!convex[v]) handles[v] = options.other_handle;
    }
    return handles;
}

/// Unit normals where they can be asked for.
class Normals {
public:
    Normals(const Topology& topology, const Features& features, const std::vector<std::uint8_t>& constrained, const TwoPhaseOptions& options,
            TwoPhaseReport& report)
        : topology_(topology), features_(features), constrained_(constrained), options_(options), report_(report) {}

    std::vector<double> all() {
        std::vector<double> normals(3 * static_cast<std::size_t>(topology_.vertex_count), 0.0);
        if (options_.normals.empty()) return normals;
        for (Index v = 0; v < topology_.vertex_count; ++v)
            take(v, &options_.normals[3 * static_cast<std::size_t>(v)], &normals[3 * static_cast<std::size_t>(v)]);
        return normals;
    }

private:
    void take(Index v, const double* given, double* normal) {
        if (!std::isfinite(given[0]) || !std::isfinite(given[1]) || !std::isfinite(given[2]))
            throw BadInput("the normal of vertex " + std::to_string(v) + " is not finite: correct it", {{v}, {}});
        const double largest = std::max({std::fabs(given[0]), std::fabs(given[1]), std::fabs(given[2])});
        if (largest == 0) return;
        const std::string objection = constrained_[v] ? tangent_objection(topology_, features_, v) : "it is not in the subset that is interpolated";
        if (!objection.empty() && !options_.skip_normals)
            throw BadInput("vertex " + std::to_string(v) + " can have no prescribed normal, because " + objection + ": leave its normal out", {{v}, {}});
        if (!objection.empty()) {
            ++report_.skipped_normals;
            return;
        }
        const double x = given[0] / largest, y = given[1] / largest, z = given[2] / largest, length = std::sqrt(x * x + y * y + z * z);
        normal[0] = x / length, normal[1] = y / length, normal[2] = z / length;
        ++report_.normal_count;
        report_.scaled_normals += std::fabs(length * largest - 1) > unit_length_slack;
    }

    const Topology& topology_;
    const Features& features_;
    const std::vector<std::uint8_t>& constrained_;
    const TwoPhaseOptions& options_;
    TwoPhaseReport& report_;
};

/// Projected conjugate gradients: every direction keeps the constraints, so no step leaves them.
void make_fair(UmbrellaSteps& steps, const FairRows& rows, const TwoPhaseOptions& options, TwoPhaseReport& report) {
    steps.set_fairness(rows, options.fair);
    report.energy[0] = steps.energy();
    double square = steps.begin();
    const double start = std::sqrt(square), target = fair_tolerance * start;
    while (std::sqrt(square) > target && report.fair_iterations < most_fair_iterations) {
        const double curvature = steps.apply(), before = square;
        square = steps.update(before / curvature);
        steps.turn(square / before);
        ++report.fair_iterations;
        if (options.solve.progress && !options.solve.progress(report.fair_iterations, std::sqrt(square), target))
            throw Cancelled("fairness was cancelled after " + std::to_string(report.fair_iterations) + " iterations");
    }
    report.fair_converged = std::sqrt(square) <= target;
    steps.repair();  // what rounding has left
    report.energy[1] = steps.energy();
}

void note_repair(const RepairFindings& found, TwoPhaseReport& report) {
    for (std::size_t u = 0; u < found.distances.size(); ++u) {
        if (!(found.distances[u] <= report.largest_repair)) report.largest_repair = found.distances[u];
        if (found.sides[u] > 0) continue;
        ++report.wrong_side_count;
        if (report.wrong_side.size() < 10) report.wrong_side.push_back(static_cast<Index>(u));
    }
}

/// Largest |Q - V_inf| on the mesh as it is now.
double largest_error(const Umbrellas& umbrellas, const UmbrellaTargets& targets, const std::vector<double>& points) {
    double worst = 0;
    for (Index u = 0; u < umbrellas.count; ++u) {
        if (!targets.constrained[u]) continue;
        const double* const centre = &points[3 * static_cast<std::size_t>(u)];
        const UmbrellaMask& mask = umbrellas.masks[umbrellas.mask_of[u]];
        double error[3];
        for (std::size_t c = 0; c < 3; ++c) error[c] = centre[c] - targets.points[3 * static_cast<std::size_t>(u) + c];
        for (std::size_t k = 1; k < mask.weights.size(); ++k) {
            const double* const point = &points[3 * static_cast<std::size_t>(umbrellas.order[umbrellas.offsets[u] + k])];
            for (std::size_t c = 0; c < 3; ++c) error[c] += mask.weights[k][0] * (point[c] - centre[c]);
        }
        const double distance = std::sqrt(error[0] * error[0] + error[1] * error[1] + error[2] * error[2]);
        if (!(distance <= worst)) worst = distance;
    }
    return worst;
}

/// Channels have no tangent planes: the least-norm step of the position, each channel by itself.
void repair_channels(const Umbrellas& umbrellas, const UmbrellaTargets& targets, const FurtherChannels& wanted,
                     const std::vector<std::uint8_t>& is_interpolated, FurtherChannels& further) {
    const auto count = static_cast<std::size_t>(further.count);
    parallel_for(umbrellas.count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t u = begin; u < end; ++u) {
            if (!targets.constrained[u]) continue;
            const UmbrellaMask& mask = umbrellas.masks[umbrellas.mask_of[u]];
            const Index* const order = &umbrellas.order[umbrellas.offsets[u]];
            for (std::size_t c = 0; c < count; ++c) {
                if (!is_interpolated[c]) continue;
                double residual = wanted.values[u * count + c];
                for (std::size_t k = 0; k < mask.weights.size(); ++k) residual -= mask.weights[k][0] * further.values[order[k] * count + c];
                for (std::size_t k = 0; k < mask.weights.size(); ++k)
                    further.values[order[k] * count + c] += mask.inverse_square * residual * mask.weights[k][0];
            }
        }
    });
}

/// P, and what `further` becomes under it, in one solve.
SolveReport solve(LimitSystem& system, const std::vector<std::uint8_t>& is_interpolated, const SolveOptions& options, std::vector<double>& positions,
                  FurtherChannels& further) {
    std::vector<std::size_t> solved;
    for (std::size_t c = 0; c < is_interpolated.size(); ++c)
        if (is_interpolated[c]) solved.push_back(c);
    const std::size_t vertices = positions.size() / 3, width = 3 + solved.size();
    if (solved.empty()) return solve_host(system, positions.data(), 3, 3, options, false, positions.data(), 3);
    std::vector<double> values(vertices * width);
    for (std::size_t v = 0; v < vertices; ++v) {
        std::copy_n(&positions[3 * v], 3, &values[v * width]);
        for (std::size_t k = 0; k < solved.size(); ++k) values[v * width + 3 + k] = further.values[v * further.count + solved[k]];
    }
    SolveReport report = solve_host(system, values.data(), width, static_cast<int>(width), options, false, values.data(), width);
    for (std::size_t v = 0; v < vertices; ++v) {
        std::copy_n(&values[v * width], 3, &positions[3 * v]);
        for (std::size_t k = 0; k < solved.size(); ++k) further.values[v * further.count + solved[k]] = values[v * width + 3 + k];
    }
    return report;
}

/// M^1 of the control mesh, with its channels.
Refinement make_refined(const PolygonMesh& control, const Topology& topology, const Features& features, const FeatureOptions& named,
                        const SchemeOptions& scheme, FurtherChannels& further) {
    if (further.count == 0) return refine(control, named, scheme, 1);
    Refinement refined = refine_once(control, topology, features, scheme);
    further.values = apply_stencils(refined.stencils, further.values, further.count);
    refined.stencils = {};
    return refined;
}

FairRows fair_rows_of(const Umbrellas& umbrellas, const Refinement& refined) {
    const Topology topology = build_topology(refined.mesh);
    return build_fair_rows(umbrellas, topology, find_features(refined.mesh, topology, refined.features));
}

}  // namespace

bool can_be_repaired(const SolveReport& report) {
    if (report.status == SolveStatus::converged) return true;
    return report.status == SolveStatus::not_converged && !report.residuals.empty() && report.max_error <= runaway_growth * report.residuals.front();
}

TwoPhase interpolate_two_phase(LimitSystem& system, const PolygonMesh& mesh, const Topology& topology, const Features& features, const FeatureOptions& named,
                               const FurtherChannels& further, const std::vector<std::uint8_t>& is_interpolated, const TwoPhaseOptions& options) {
    check_ratios(system.scheme, topology);
    if (!(options.fair >= 0) || !std::isfinite(options.fair))
        throw InvalidArgument("the weight of fairness is " + number_text(options.fair) + ": it is a number above 0, or 0 for none");
    TwoPhase result;
    result.findings.energy = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    UmbrellaTargets targets;
    targets.points = mesh.positions;
    targets.constrained = constrained_vertices(system.plan(), features);
    targets.normals = Normals(topology, features, targets.constrained, options, result.findings).all();
    targets.handles = handles_of(topology, mesh.positions, options, result.findings);

    PolygonMesh control = mesh;
    result.further = further;
    result.report = solve(system, is_interpolated, options.solve, control.positions, result.further);
    const bool is_exact_count = options.solve.exact_sweeps > 0 && result.report.status == SolveStatus::not_converged;
    if (!can_be_repaired(result.report) && !is_exact_count && !options.solve.keep_going) return result;

    const auto start = std::chrono::steady_clock::now();
    result.refined = make_refined(control, topology, features, named, system.scheme, result.further);
    const Umbrellas umbrellas = build_umbrellas(topology, features);
    const std::shared_ptr<Context>& context = system.A->shared_context();
    const auto steps = context->device().has_double ? make_device_steps(context, umbrellas, targets) : make_host_steps(umbrellas, targets);
    steps->upload(result.refined.mesh.positions);
    note_repair(steps->repair(), result.findings);
    if (options.fair > 0) make_fair(*steps, fair_rows_of(umbrellas, result.refined), options, result.findings);
    steps->scale();
    steps->download(result.refined.mesh.positions);
    repair_channels(umbrellas, targets, further, is_interpolated, result.further);
    result.findings.max_error = largest_error(umbrellas, targets, result.refined.mesh.positions);
    result.findings.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.is_given = true;
    return result;
}

}  // namespace lcl
