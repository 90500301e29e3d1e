// SPDX-License-Identifier: BSD-3-Clause
#include "host/refine/refiner.h"

#include <algorithm>
#include <utility>

#include "host/parallel.h"
#include "host/refine/locations.h"
#include "host/refine/size.h"
#include "host/refine/steps.h"

namespace lcl {
namespace {

StepInput input_of(const RefinerStep& step) { return {step.topology, step.features, step.options}; }

/// The features of the mesh that a step made, all of whose topology is there.
Features features_of_child(const RefinerStep& step, const DooSabinLayout* layout, const Topology& child) {
    if (step.bulk != BulkRule::none) return child_features(step.topology, step.features, child);
    return find_features({}, child, step_features(input_of(step), layout));  // nothing is found by angle, so positions are not looked at
}

void set_rows(RefinerStep& step, const DooSabinLayout* layout) {
    const StepInput input = input_of(step);
    SummedRows rows(step.topology);
    if (layout) {
        doo_sabin_rows(input, *layout, rows);
    } else if (step.options.is_two_phase()) {
        two_phase_rows(input, rows);
    } else if (step.options.scheme == Scheme::loop) {
        step.bulk = BulkRule::loop;
        loop_odd_rows(input, rows);
    } else {
        step.bulk = BulkRule::catmull_clark;
        catmull_clark_odd_rows(input, rows);
    }
    step.rows = rows.take();
}

}  // namespace

Refiner::Refiner(Topology topology, Features features, const SchemeOptions& options, int levels) : options_(options) {
    check_levels(levels);
    SchemeOptions level_options = options;
    steps_.reserve(levels);
    for (int level = 1; level <= levels; ++level) {
        RefinerStep& step = steps_.emplace_back();
        step.topology = std::move(topology);
        step.features = std::move(features);
        step.options = std::exchange(level_options, SchemeOptions{options.scheme, options.mask, 0, 0, {}});
        const StepInput input = input_of(step);
        check_options(input);
        const std::optional<DooSabinLayout> layout = layout_of(input);
        if (level == 1) check_levels_fit(count(input, pointer_to(layout)), options, levels);
        set_rows(step, pointer_to(layout));
        Child child = make_child(input, pointer_to(layout), level < levels ? TopologyPart::all : TopologyPart::faces);
        step.vertex_count = child.topology.vertex_count;
        step.face_parent = std::move(child.face_parent);
        topology = std::move(child.topology);
        if (level < levels) features = features_of_child(step, pointer_to(layout), topology);
    }
    finest_ = std::move(topology);
    if (levels == 0) features_ = std::move(features);
}

Topology Refiner::finest_topology() const {
    if (steps_.empty()) return finest_;
    const StepInput input = input_of(steps_.back());
    return make_child(input, pointer_to(layout_of(input)), TopologyPart::all).topology;
}

Features Refiner::finest_features(const Topology& finest) const {
    if (steps_.empty()) return features_;
    const StepInput input = input_of(steps_.back());
    return features_of_child(steps_.back(), pointer_to(layout_of(input)), finest);
}

FeatureOptions Refiner::feature_options() const {
    const StepInput input = input_of(steps_.back());
    return step_features(input, pointer_to(layout_of(input)));
}

std::vector<Index> Refiner::face_parents() const {
    std::vector<Index> older;
    for (const RefinerStep& step : steps_) {
        std::vector<Index> parents = child_parents(step.topology, options_.scheme, step.face_parent);
        if (!older.empty())
            parallel_for_each(parents.size(), [&](std::size_t f) {
                if (parents[f] >= 0) parents[f] = older[parents[f]];
            });
        older = std::move(parents);
    }
    return older;
}

std::vector<SurfaceLocation> Refiner::locations() const {
    const Topology& original = steps_.empty() ? finest_ : steps_.front().topology;
    LocationTracker tracker(original, steps_.empty() ? features_ : steps_.front().features, options_.scheme);
    for (const RefinerStep& step : steps_) tracker.step(input_of(step));
    return tracker.locations(finest_);
}

void Refiner::apply(const double* values, std::size_t stride, int channels, double* out, std::size_t out_stride) const {
    Array<double> finer, coarser;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const RefinerStep& step = steps_[i];
        if (i + 1 == steps_.size()) return apply_step(step, values, stride, channels, out, out_stride);
        finer.resize(static_cast<std::size_t>(step.vertex_count) * channels);
        apply_step(step, values, stride, channels, finer.data(), channels);
        std::swap(finer, coarser);
        values = coarser.data();
        stride = static_cast<std::size_t>(channels);
    }
    for (Index v = 0; v < finest_.vertex_count; ++v) std::copy_n(values + v * stride, channels, out + v * out_stride);
}

Refinement refined_mesh(const Refiner& refiner, const double* points, std::size_t stride) {
    Refinement refined;
    copy_faces(refiner.finest_faces(), refined.mesh);
    refined.features = refiner.feature_options();
    refined.face_parent = refiner.face_parents();
    refined.mesh.positions.resize(3 * static_cast<std::size_t>(refiner.vertex_count()));
    refiner.apply(points, stride, 3, refined.mesh.positions.data(), 3);
    return refined;
}

}  // namespace lcl
