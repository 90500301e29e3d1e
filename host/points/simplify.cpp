// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/simplify.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "host/points/geometry.h"

namespace lcl {
namespace {

using Decimater = OpenMesh::Decimater::DecimaterT<FitMesh>;
constexpr float largest_aspect = 4.0F;         // longest side over the height on it
constexpr double square_of_grading = 4.0 * 4;  // of the lengths of edges that meet
constexpr std::size_t least_vertices = 4;
constexpr double shape_weight = 1e-8;

/// Keeps the boundary where it is: a vertex of it may only go along it, as long as all that went before stays within the tolerance of the edge that is left.
class BoundaryModule : public OpenMesh::Decimater::ModBaseT<FitMesh> {
public:
    using Base = OpenMesh::Decimater::ModBaseT<FitMesh>;
    using CollapseInfo = OpenMesh::Decimater::CollapseInfoT<FitMesh>;
    using Handle = OpenMesh::Decimater::ModHandleT<BoundaryModule>;

    explicit BoundaryModule(FitMesh& mesh) : Base(mesh, true) { mesh.add_property(strayed_); }
    ~BoundaryModule() override { mesh().remove_property(strayed_); }
    const std::string& name() const override {
        static const std::string name = "Boundary";
        return name;
    }
    void set_tolerance(double tolerance) { tolerance_ = tolerance; }

    void initialize() override {
        for (const OpenMesh::EdgeHandle edge : mesh().edges()) mesh().property(strayed_, edge) = 0;
    }

    float collapse_priority(const CollapseInfo& collapse) override {
        if (!mesh().is_boundary(collapse.v0)) return Base::LEGAL_COLLAPSE;
        return strayed_by(collapse) <= tolerance_ ? Base::LEGAL_COLLAPSE : Base::ILLEGAL_COLLAPSE;
    }

    void preprocess_collapse(const CollapseInfo& collapse) override {
        if (mesh().is_boundary(collapse.v0)) mesh().property(strayed_, mesh().edge_handle(other_side(collapse))) = strayed_by(collapse);
    }

private:
    /// The boundary half-edge at v0 that the collapse does not remove.
    OpenMesh::HalfedgeHandle other_side(const CollapseInfo& collapse) {
        const OpenMesh::HalfedgeHandle out = mesh().halfedge_handle(collapse.v0);  // the boundary one
        return mesh().to_vertex_handle(out) == collapse.v1 ? mesh().prev_halfedge_handle(out) : out;
    }

    double strayed_by(const CollapseInfo& collapse) {
        const OpenMesh::HalfedgeHandle side = other_side(collapse);
        const OpenMesh::VertexHandle far = mesh().to_vertex_handle(side) == collapse.v0 ? mesh().from_vertex_handle(side) : mesh().to_vertex_handle(side);
        const double before = std::max(mesh().property(strayed_, mesh().edge_handle(side)), mesh().property(strayed_, mesh().edge_handle(collapse.v0v1)));
        return before + std::sqrt(squared_distance_to_segment(collapse.p0, collapse.p1, mesh().point(far)));
    }

    OpenMesh::EPropHandleT<double> strayed_;
    double tolerance_ = 0;
};

/// Quadrics of planes give zeros that are a little below 0, which the decimater takes for a refusal; and in a plane short edges go first, for the sake of the
/// triangles' shape. Edges are of length 1 or so.
class PriorityModule : public OpenMesh::Decimater::ModQuadricT<FitMesh> {
public:
    using Quadric = OpenMesh::Decimater::ModQuadricT<FitMesh>;
    using Handle = OpenMesh::Decimater::ModHandleT<PriorityModule>;

    explicit PriorityModule(FitMesh& mesh) : Quadric(mesh) { set_max_err(DBL_MAX, false); }
    float collapse_priority(const OpenMesh::Decimater::CollapseInfoT<FitMesh>& collapse) override {
        return std::max(0.0F, Quadric::collapse_priority(collapse)) + static_cast<float>(shape_weight * (collapse.p1 - collapse.p0).sqrnorm());
    }
};

/// No edge becomes much longer than its neighbours: curves along creases and surfaces swing beyond a short edge before a long one.
class GradingModule : public OpenMesh::Decimater::ModBaseT<FitMesh> {
public:
    using Base = OpenMesh::Decimater::ModBaseT<FitMesh>;
    using CollapseInfo = OpenMesh::Decimater::CollapseInfoT<FitMesh>;
    using Handle = OpenMesh::Decimater::ModHandleT<GradingModule>;

    explicit GradingModule(FitMesh& mesh) : Base(mesh, true) {}
    const std::string& name() const override {
        static const std::string name = "Grading";
        return name;
    }

    float collapse_priority(const CollapseInfo& collapse) override {
        double longest = 0;
        for (const OpenMesh::VertexHandle v : mesh().vv_range(collapse.v0)) {
            if (v == collapse.v1) continue;
            const double length = (mesh().point(v) - collapse.p1).sqrnorm();
            longest = std::max(longest, length);
            if (length > square_of_grading * shortest_edge(v, collapse.v0)) return Base::ILLEGAL_COLLAPSE;
        }
        return longest > square_of_grading * shortest_edge(collapse.v1, collapse.v0) ? Base::ILLEGAL_COLLAPSE : Base::LEGAL_COLLAPSE;
    }

private:
    /// Square of its length, the one to `left_out` not counted.
    double shortest_edge(OpenMesh::VertexHandle vertex, OpenMesh::VertexHandle left_out) {
        double shortest = DBL_MAX;
        for (const OpenMesh::VertexHandle v : mesh().vv_range(vertex))
            if (v != left_out) shortest = std::min(shortest, (mesh().point(v) - mesh().point(vertex)).sqrnorm());
        return shortest;
    }
};

class StopOnRequest : public OpenMesh::Decimater::Observer {
public:
    explicit StopOnRequest(const std::function<bool(std::size_t)>& progress) : Observer(4096), progress_(progress) {}
    void notify(std::size_t collapses) override { stopped_ = progress_ && !progress_(collapses); }
    bool abort() const override { return stopped_; }

private:
    const std::function<bool(std::size_t)>& progress_;
    bool stopped_ = false;
};

/// What a collapse must keep to.
struct Limits {
    double tolerance;   ///< of removed vertices and boundaries; DBL_MAX: none
    float turn;         ///< of a triangle's normal, degrees
    bool keeps_shapes;  ///< no slivers
    bool is_graded;     ///< no edge much longer than its neighbours
};

void collapse(FitMesh& mesh, const Limits& limits, std::size_t least, const std::function<bool(std::size_t)>& progress) {
    Decimater decimater(mesh);
    PriorityModule::Handle priority;
    OpenMesh::Decimater::ModNormalFlippingT<FitMesh>::Handle flipping;
    OpenMesh::Decimater::ModAspectRatioT<FitMesh>::Handle aspect;
    OpenMesh::Decimater::ModHausdorffT<FitMesh>::Handle hausdorff;
    GradingModule::Handle grading;
    BoundaryModule::Handle boundary;
    decimater.add(priority);
    decimater.add(flipping);
    decimater.module(flipping).set_max_normal_deviation(limits.turn);
    if (limits.keeps_shapes) {
        decimater.add(aspect);
        decimater.module(aspect).set_aspect_ratio(largest_aspect);
    }
    if (limits.is_graded) decimater.add(grading);
    decimater.add(boundary);
    decimater.module(boundary).set_tolerance(limits.tolerance);
    if (limits.tolerance < DBL_MAX) {
        decimater.add(hausdorff);
        decimater.module(hausdorff).set_tolerance(limits.tolerance);
    }
    StopOnRequest observer(progress);
    decimater.set_observer(&observer);
    decimater.initialize();
    mesh.update_face_normals();
    decimater.decimate_to(least);
    mesh.garbage_collection();
    if (observer.abort()) throw Cancelled("the simplification was cancelled");
}

}  // namespace

void simplify(FitMesh& mesh, const SimplifyOptions& options) {
    if (mesh.n_edges() == 0) return;
    double length = 0;
    for (const OpenMesh::EdgeHandle edge : mesh.edges()) length += mesh.calc_edge_length(edge);
    // Edges of about 1, since the decimater's priorities are floats and hold lengths to the fourth power; afterwards the points as they were.
    const double scale = static_cast<double>(mesh.n_edges()) / length;
    OpenMesh::VPropHandleT<FitMesh::Point> given;
    mesh.add_property(given);
    for (const OpenMesh::VertexHandle vertex : mesh.vertices()) {
        mesh.property(given, vertex) = mesh.point(vertex);
        mesh.point(vertex) *= scale;
    }
    collapse(mesh, {options.tolerance * scale, 45, true, options.is_graded}, least_vertices, options.progress);
    // Beyond the tolerance the mesh keeps its shapes for as long as it can.
    for (const Limits& limits : {Limits{DBL_MAX, 45, true, options.is_graded}, Limits{DBL_MAX, 90, false, false}, Limits{DBL_MAX, 180, false, false}})
        if (options.max_vertices > 0 && mesh.n_vertices() > options.max_vertices) collapse(mesh, limits, options.max_vertices, options.progress);
    for (const OpenMesh::VertexHandle vertex : mesh.vertices()) mesh.point(vertex) = mesh.property(given, vertex);
    mesh.remove_property(given);
}

}  // namespace lcl
