// SPDX-License-Identifier: BSD-3-Clause
#include "host/filter/texture.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "host/apply/host_arrays.h"
#include "host/apply/host_operator.h"

namespace lcl {
namespace {

constexpr double equal_values = 1e-13;  // values that differ by less of their size differ by rounding
// Of the finest mesh. Host, as measured: mesh, topology, stencils, plan and values at once, and on a CPU what the device holds. Device: the fields of four wide
// channels, what the last octave's solve keeps, and neighbours.
constexpr std::int64_t host_bytes_a_vertex = 500, device_bytes_a_vertex = 104, device_bytes_a_corner = 8, bytes_a_row = 32;

void check_fits(const RefinedSize& size, int levels, int further_channels, const Context& context) {
    const DeviceInfo& device = context.device();
    const std::string mesh =
        "the texture has " + std::to_string(size.vertices) + " vertices on the mesh refined " + std::to_string(levels) + " times and would take about ";
    const std::int64_t host_bytes = size.vertices * (host_bytes_a_vertex + 24 * further_channels);
    if (host_bytes > physical_memory())
        throw OutOfMemory(mesh + std::to_string(host_bytes) + " bytes, this machine has " + std::to_string(physical_memory()) + ": use fewer levels");
    const std::int64_t device_bytes = size.vertices * device_bytes_a_vertex + size.corners * device_bytes_a_corner;
    const auto has_bytes = static_cast<std::int64_t>(device.memory_bytes - std::min(device.memory_bytes, context.allocated_bytes()));
    if (device_bytes > has_bytes)
        throw OutOfMemory(mesh + std::to_string(device_bytes) + " bytes on " + device.name + ", which has " + std::to_string(has_bytes) +
                          " left: use fewer levels");
    const std::int64_t largest = std::max(size.vertices * bytes_a_row, size.corners * device_bytes_a_corner);
    if (largest > static_cast<std::int64_t>(device.max_allocation_bytes))
        throw OutOfMemory(mesh + std::to_string(largest) + " bytes in one piece on " + device.name + ", which gives at most " +
                          std::to_string(device.max_allocation_bytes) + ": use fewer levels");
}

/// Of A's solve and values, one channel: (value - low) / (high - low) in [0, 1].
std::vector<double> normalised(const Plan& plan, const double* values, std::size_t stride) {
    const ValueRanges ranges = value_ranges(plan, {values, stride}, 1);
    const double low = ranges.low[0], high = ranges.high[0], size = std::max(std::fabs(low), std::fabs(high));
    std::vector<double> t(plan.vertex_count, 0.5);
    if (high - low <= equal_values * size) return t;
    for (std::size_t v = 0; v < t.size(); ++v) t[v] = std::clamp((values[v * stride] - low) / (high - low), 0.0, 1.0);
    return t;
}

/// A x in double on the host, for values in the caller's order that may be anything.
std::vector<double> host_limit(const Plan& plan, const FurtherChannels& further) {
    const auto channels = static_cast<std::size_t>(further.count);
    std::vector<double> x(further.values.size()), out(further.values.size());
    for (std::size_t row = 0; row < plan.vertex_of_row.size(); ++row)
        std::copy_n(&further.values[plan.vertex_of_row[row] * channels], channels, &x[row * channels]);
    const std::vector<double> y = host_apply(plan, x, further.count);
    for (std::size_t row = 0; row < plan.vertex_of_row.size(); ++row) std::copy_n(&y[row * channels], channels, &out[plan.vertex_of_row[row] * channels]);
    return out;
}

/// Goes from G_0 to G_K with what has been added up so far.
class TextureBuild {
public:
    TextureBuild(LimitSystem& coarsest, const PolygonMesh& mesh, const FeatureOptions& features, FurtherChannels further, const TextureOptions& options)
        : coarsest_(coarsest), context_(coarsest.A->shared_context()), options_(options), scheme_(coarsest.scheme), further_(std::move(further)) {
        current_.mesh = mesh;
        current_.features = features;
        find_topology();
        check_fits(refined_size(topology_, features_, scheme_, options.levels), options.levels, further_.count, *context_);
        const Transform box = fit_transform(coarsest.plan(), mesh.positions.data(), 3, 3);
        std::copy_n(box.centre.begin(), 3, frame_.centre.begin());
        frame_.scale = options.frequency * box.scale[0];  // without extent all points are at the centre
        frame_.offset = noise_offset(options.seed);
        sum_.resize(mesh.vertex_count);
    }

    Texture run() {
        for (int level = 0; level <= options_.levels; ++level) {
            if (level > 0) refine_all();
            if (level < options_.octaves && !add_octave(level)) return std::move(result_);
        }
        finish();
        return std::move(result_);
    }

private:
    void find_topology() {
        topology_ = build_topology(current_.mesh);
        features_ = find_features(current_.mesh, topology_, current_.features);
    }

    // C_(i+1) = R C_i
    void refine_all() {
        system_.reset();
        Refinement finer = refine_once(current_.mesh, topology_, features_, scheme_);
        sum_ = apply_stencils(finer.stencils, sum_, 1);
        if (further_.count > 0) further_.values = apply_stencils(finer.stencils, further_.values, further_.count);
        finer.stencils = {};
        current_ = std::move(finer);
        scheme_ = {scheme_.scheme, scheme_.mask, 0, 0, {}};
        find_topology();
    }

    // C_i += P_i, A_i P_i = N_i; false where the solve failed and that is the end.
    bool add_octave(int level) {
        if (level > 0) system_ = make_limit_system(context_, current_.mesh, topology_, features_, scheme_, {});
        LimitSystem& system = level > 0 ? *system_ : coarsest_;
        std::vector<double> values = noise_octave(context_, frame_, current_.mesh.positions, level, real_of(options_.solve.precision));
        const ValueRanges ranges = value_ranges(system.plan(), {values.data(), 1}, 1);
        SolveOptions solve = options_.solve;
        solve.diagonal = ranges.high[0] - ranges.low[0];
        const SolveReport report = solve_host(system, values.data(), 1, 1, solve, false, values.data(), 1);
        note(report, level, solve.diagonal);
        if (report.status != SolveStatus::converged && !solve.keep_going) return false;
        for (std::size_t v = 0; v < values.size(); ++v) sum_[v] += values[v];
        return true;
    }

    /// Keeps the worst report.
    void note(const SolveReport& report, int level, double range) {
        const bool failed = report.status != SolveStatus::converged, has_failed = level > 0 && result_.report.status != SolveStatus::converged;
        const double error = range > 0 ? report.max_error / range : report.max_error;
        const bool is_worse = failed != has_failed ? failed : !(error <= worst_error_);  // also where it is not a number
        if (level > 0 && !is_worse) return;
        worst_error_ = error;
        result_.report = report;
        if (!failed) return;
        const std::string where = level > 0 ? ", on the mesh refined " + std::to_string(level) + (level > 1 ? " times" : " time") : "";
        result_.report.message = "octave " + std::to_string(level) + where + ": " + report.message;
    }

    // N = A_K C_K, and the positions likewise.
    void finish() {
        // That of G_0 may stand for a subset.
        if (!system_) system_ = make_limit_system(context_, current_.mesh, topology_, features_, scheme_, {});
        std::vector<double>& points = current_.mesh.positions;
        std::vector<double> values(4 * sum_.size());
        for (std::size_t v = 0; v < sum_.size(); ++v) {
            std::copy_n(&points[3 * v], 3, &values[4 * v]);
            values[4 * v + 3] = sum_[v];
        }
        limit_points(*system_->A, values.data(), 4, 4, Precision::mixed, values.data(), 4);
        for (std::size_t v = 0; v < sum_.size(); ++v) std::copy_n(&values[4 * v], 3, &points[3 * v]);
        result_.noise = normalised(system_->plan(), values.data() + 3, 4);
        if (further_.count > 0) further_.values = host_limit(system_->plan(), further_);
        result_.further = std::move(further_);
        result_.refined = std::move(current_);
        result_.is_given = true;
    }

    LimitSystem& coarsest_;
    const std::shared_ptr<Context> context_;
    const TextureOptions& options_;
    SchemeOptions scheme_;  // of current_
    FurtherChannels further_;
    Refinement current_;  // G_i
    Topology topology_;
    Features features_;
    NoiseFrame frame_;
    std::vector<double> sum_;              // C_i
    std::unique_ptr<LimitSystem> system_;  // of G_i, i > 0, where it was needed
    Texture result_;
    double worst_error_ = 0;
};

}  // namespace

Texture make_texture(LimitSystem& coarsest, const PolygonMesh& mesh, const FeatureOptions& features, FurtherChannels further, const TextureOptions& options) {
    return TextureBuild(coarsest, mesh, features, std::move(further), options).run();
}

}  // namespace lcl
