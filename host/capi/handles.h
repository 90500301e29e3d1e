// SPDX-License-Identifier: BSD-3-Clause
// What the opaque handles of the C API point at.
#pragma once

#include <atomic>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "host/apply/device_tangents.h"
#include "host/capi/guard.h"
#include "host/field/field.h"
#include "host/io/mesh_file.h"
#include "host/mesh/point_cloud.h"
#include "host/refine/device_refiner.h"
#include "host/refine/refiner.h"
#include "host/solve/local.h"

namespace lcl {

/// Base of the handles: one reference at first.
struct Counted {
    std::atomic<int> references{1};
};
template <class Handle>
Handle* retain(Handle* handle) {
    if (handle != nullptr) handle->references.fetch_add(1, std::memory_order_relaxed);
    return handle;
}
template <class Handle>
void release(Handle* handle) {
    if (handle != nullptr && handle->references.fetch_sub(1, std::memory_order_acq_rel) == 1) delete handle;
}

/// A reference that drops itself.
template <class Handle>
struct Releaser {
    void operator()(Handle* handle) const { release(handle); }
};
template <class Handle>
using Reference = std::unique_ptr<Handle, Releaser<Handle>>;
template <class Handle>
Reference<Handle> share(Handle* handle) {
    return Reference<Handle>(retain(handle));
}

/// Where the vertices of a refined mesh lie: found when they are asked for.
class RefinedLocations {
public:
    explicit RefinedLocations(std::shared_ptr<const Refiner> refiner) : refiner_(std::move(refiner)) {}
    const std::vector<SurfaceLocation>& get() {
        const std::lock_guard lock(mutex_);  // several threads may read one mesh
        if (refiner_) locations_ = refiner_->locations();
        refiner_.reset();
        return locations_;
    }

private:
    std::mutex mutex_;
    std::shared_ptr<const Refiner> refiner_;
    std::vector<SurfaceLocation> locations_;
};

}  // namespace lcl

struct lcl_context_s : lcl::Counted {
    std::shared_ptr<lcl::Context> context;
    lcl_log_callback log = nullptr;
    void* log_user = nullptr;
    int32_t log_level = LCL_LOG_ERROR;

    void write_log(int32_t level, const std::string& message) const {
        if (log != nullptr && level <= log_level) log(log_user, level, message.c_str());
    }
};

struct lcl_mesh_s : lcl::Counted {
    lcl::MeshFile file;
    lcl::FeatureOptions feature_options;  // the file's tags and what callers added; boundary resolved by boundary_rule()
    lcl_boundary boundary = LCL_BOUNDARY_DEFAULT;
    std::shared_ptr<lcl::RefinedLocations> locations;  // of a refined mesh
    lcl::Index two_phase_vertices = -1;                // of a two-phase mesh: how many vertices the mesh had that it was made from
    bool was_read_with_normals = false;
    std::map<lcl_note, std::vector<std::string>> notes;

    /// Topology and features of a sound mesh, built once; BadInput with the reason if it is not sound, or if the file had a tag that is refused.
    const lcl::Topology& topology();
    const lcl::Features& features();
    /// The same whatever the tags: for counts.
    const lcl::Topology& sound_topology();
    const lcl::Features& sound_features();
    const std::vector<lcl::Defect>& defects();
    lcl::BoundaryRule boundary_rule() const;
    /// What the mesh has to be read with, creases by angle among the named ones.
    lcl::FeatureOptions named_features();
    void forget_features();
    /// Before new points: finds the creases by angle, which stay those of the old ones.
    void keep_features_of_positions();
    /// After new points: what was found out about the old ones, and their normals.
    void forget_positions();

private:
    void refuse_tags(const lcl::Topology& topology) const;
    std::mutex mutex_;  // several threads may read one mesh
    std::optional<lcl::Topology> topology_;
    std::optional<lcl::Features> features_;
    std::optional<std::vector<lcl::Defect>> defects_;
};

struct lcl_cloud_s : lcl::Counted {
    lcl::PointCloud cloud;
};

struct lcl_operator_s : lcl::Counted {
    lcl::Reference<lcl_context_s> context;
    std::unique_ptr<lcl::LimitSystem> system;
    std::unique_ptr<lcl::LocalSolver> local;  // made by the first local solve
};

struct lcl_field_s : lcl::Counted {
    lcl::Reference<lcl_operator_s> A;
    lcl::Field field;
    std::optional<lcl::Transform> transform;  // set by the first upload

    lcl_field_s(lcl_operator_s* owner, lcl::Field values) : A(lcl::share(owner)), field(std::move(values)) {}
};

struct lcl_tangents_s : lcl::Counted {
    lcl::Reference<lcl_operator_s> A;
    lcl::DeviceTangents tangents;
    bool is_applied = false;

    lcl_tangents_s(lcl_operator_s* owner, lcl::TangentPlan&& plan) : A(lcl::share(owner)), tangents(*owner->system->A, std::move(plan)) {}
};

struct lcl_task_s : lcl::Counted {
    struct Result {
        lcl_status status;
        lcl::LastError error;
    };
    lcl::Reference<lcl_operator_s> A;
    std::shared_future<Result> result;

    ~lcl_task_s() {
        if (result.valid()) result.wait();
    }
};

struct lcl_refiner_s : lcl::Counted {
    lcl::Reference<lcl_mesh_s> mesh;
    std::shared_ptr<const lcl::Refiner> refiner;
    lcl::Reference<lcl_context_s> context;
    std::unique_ptr<lcl::DeviceRefiner> on_device;  // null without a context
};

namespace lcl {

/// Scheme of the options, resolved for a mesh, with ranges checked.
SchemeOptions scheme_options(lcl_mesh_s& mesh, const lcl_scheme_options& options);

/// The system of lcl_operator_create: scheme resolved, alpha_auto, subset and owned looked at.
std::unique_ptr<LimitSystem> make_system(lcl_context_s& context, lcl_mesh_s& mesh, const lcl_scheme_options& options);

/// A handle on what `mesh` has become after `levels` refinements: faces, points, features, with notes on what was dropped; without a refinement texture
/// coordinates, groups and materials are kept. Properties are the caller's task.
std::unique_ptr<lcl_mesh_s> make_refined_mesh(const lcl_mesh_s& mesh, Refinement&& refined, int levels);
/// Values of integer types, of which refinement makes fractions, are rounded.
void round_integers(std::vector<VertexProperty>& properties);
/// lcl_mesh_set_colours.
void set_colours(lcl_mesh_s& mesh, const double* colours);

/// Checked options of a solve, but for warm_start.
SolveOptions solve_options(const lcl_solve_options& options);

/// Fills the report (which may be null), but neither asks whether the solve went well nor keeps a sentence.
void give_report(lcl_solve_report* report, const SolveReport& inner);

/// Fills the report (which may be null) and gives the status of a solve, whose sentence becomes the thread's last error where it failed.
lcl_status conclude(const SolveReport& inner, const lcl_solve_options& options, lcl_solve_report* report);

/// Fails for a value, or for the first of many, that is no finite number: "M of vertex 5 is nan in channel 1". Real: float or double.
void require_finite(double value, Index v, int channel, const char* name);
template <class Real>
void require_finite(const Real* values, std::size_t stride, int channels, std::size_t rows, const char* name);

/// Marks of a list of vertices; empty for a null list. InvalidArgument for a vertex that is not there.
std::vector<std::uint8_t> vertex_marks(const int32_t* vertices, std::size_t count, Index vertex_count, const char* name);

}  // namespace lcl
