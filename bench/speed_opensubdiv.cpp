// SPDX-License-Identifier: BSD-3-Clause
// speed_opensubdiv PART: limit points of all vertices by OpenSubdiv, in float, beside limitcl's apply ("apply": its stencil tables on the shape one level
// coarser, which bench/run scales; "normals": with normals, the peer's with the two tangents of which they are made), and what it sets up for them beside
// limitcl's set-up ("refiner": TopologyRefiner; "stencils": limit stencil table); "refine": the shape from one four levels coarser, by TopologyRefiner and
// PrimvarRefiner.
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/ompEvaluator.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "interpolation.h"
#include "measure.h"

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;

namespace bench {
namespace {

constexpr double slow = 5;         // seconds, from which 3 runs are enough
constexpr int cheapest_level = 0;  // of refinement round irregular vertices: patches there are Gregory's, whose corners lie on the limit surface

using Refiner = std::unique_ptr<Far::TopologyRefiner>;
using LimitTable = std::unique_ptr<const Far::LimitStencilTable>;

Refiner make_refiner(const Shape& shape) {
    const std::vector<int> degrees(shape.face_count(), shape.degree);
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = shape.vertex_count();
    descriptor.numFaces = shape.face_count();
    descriptor.numVertsPerFace = degrees.data();
    descriptor.vertIndicesPerFace = shape.faces.data();
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    Refiner refiner(Factory::Create(descriptor, Factory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK)));
    if (!refiner) throw std::runtime_error("OpenSubdiv refuses the mesh");
    return refiner;
}

/// One location a vertex: a corner of one of its quads. level: refinements round the irregular vertices.
LimitTable make_limit_table(const Shape& shape, Far::TopologyRefiner& refiner, int level) {
    const float s[] = {0, 1, 1, 0}, t[] = {0, 0, 1, 1};
    std::vector<std::size_t> corner_of_vertex(shape.vertex_count());
    for (std::size_t corner = 0; corner < shape.faces.size(); ++corner) corner_of_vertex[shape.faces[corner]] = corner;
    Far::LimitStencilTableFactory::LocationArrayVec locations;
    for (const std::size_t corner : corner_of_vertex) {
        Far::LimitStencilTableFactory::LocationArray location;
        location.ptexIdx = static_cast<int>(corner / 4);
        location.numLocations = 1;
        location.s = &s[corner % 4];
        location.t = &t[corner % 4];
        locations.push_back(location);
    }
    Far::LimitStencilTableFactory::Options options;
    options.generate1stDerivatives = false;
    refiner.Unrefine();
    refiner.RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(level));
    LimitTable table(Far::LimitStencilTableFactory::Create(refiner, locations, nullptr, nullptr, options));
    if (!table || table->GetNumStencils() != shape.vertex_count()) throw std::runtime_error("OpenSubdiv gives no limit stencils");
    return table;
}

struct Point {
    float x[3];
    void Clear() { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(const Point& p, float weight) {
        for (int c = 0; c < 3; ++c) x[c] += weight * p.x[c];
    }
};

/// max_i |A M - found|_i over the diagonal: all take the limit points of M itself.
double error_of(const Shape& shape, const std::vector<float>& found) {
    const std::vector<double> limit = limit_points(limit_matrix(shape, Scheme::catmull_clark), shape.points);
    double worst = 0;
    for (std::size_t i = 0; i < limit.size(); i += 3) {
        const double error = std::hypot(limit[i] - found[i], limit[i + 1] - found[i + 1], limit[i + 2] - found[i + 2]);
        if (!(error <= worst)) worst = error;  // also if it is not a number
    }
    return worst / diagonal(shape);
}

/// The limit stencil table of a shape and what applying it by an evaluator gives.
struct Stencils {
    explicit Stencils(const Shape& shape) : points(shape.points.begin(), shape.points.end()), limit(points.size()), refiner(make_refiner(shape)) {
        table = make_limit_table(shape, *refiner, cheapest_level);
    }
    template <class Evaluator>
    void apply() {
        const Osd::BufferDescriptor layout(0, 3, 3);
        Evaluator::EvalStencils(static_cast<const float*>(points.data()), layout, limit.data(), layout, table->GetSizes().data(), table->GetOffsets().data(),
                                table->GetControlIndices().data(), table->GetWeights().data(), 0, table->GetNumStencils());
    }

    std::vector<float> points, limit;
    Refiner refiner;
    LimitTable table;
};

void race_apply(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level), coarse = quad_sphere(arguments.level - 1);
    Stencils stencils(coarse);
    const Refiner refiner = make_refiner(shape);
    const std::vector<float> points(shape.points.begin(), shape.points.end());
    std::vector<float> limit(points.size());
    const auto refiner_limit = [&] {
        const Point* from = reinterpret_cast<const Point*>(points.data());
        Point* to = reinterpret_cast<Point*>(limit.data());
        Far::PrimvarRefiner(*refiner).Limit(from, to);
    };
    Interpolation problem(open_device(arguments.device), shape, Scheme::catmull_clark);
    run_rounds(arguments.runs, [&](Laps& laps) {
        const auto limitcl_apply = [&] {
            check(lcl_operator_apply(problem.A.get(), problem.M.get(), problem.P.get()));
            problem.finish();
        };
        rest();
        laps.time_warm("apply.limitcl", limitcl_apply);
        laps.time_warm("apply.cpu-stencils", [&] { stencils.apply<Osd::CpuEvaluator>(); });
        laps.time_warm("apply.omp-stencils", [&] { stencils.apply<Osd::OmpEvaluator>(); });
        rest();
        laps.time_warm("apply.primvar-refiner", refiner_limit);
    });
    const std::vector<double> ours = problem.control_points();
    print_value("apply.stencil-scale", static_cast<double>(shape.vertex_count()) / coarse.vertex_count());
    print_value("apply.limitcl.error", error_of(shape, {ours.begin(), ours.end()}));
    print_value("apply.primvar-refiner.error", error_of(shape, limit));
    print_value("apply.omp-stencils.error", error_of(coarse, stencils.limit));
    stencils.apply<Osd::CpuEvaluator>();
    print_value("apply.cpu-stencils.error", error_of(coarse, stencils.limit));
}

/// Largest angle between our normals and the cross products of the peer's tangents, radians.
double largest_angle(const std::vector<double>& normals, const std::vector<float>& first, const std::vector<float>& second) {
    double worst = 0;
    for (std::size_t i = 0; i < normals.size(); i += 3) {
        const double* n = &normals[i];
        const float *a = &first[i], *b = &second[i];
        const double c[] = {double(a[1]) * b[2] - double(a[2]) * b[1], double(a[2]) * b[0] - double(a[0]) * b[2], double(a[0]) * b[1] - double(a[1]) * b[0]};
        const double sine = std::hypot(c[1] * n[2] - c[2] * n[1], c[2] * n[0] - c[0] * n[2], c[0] * n[1] - c[1] * n[0]);
        const double angle = std::atan2(sine, c[0] * n[0] + c[1] * n[1] + c[2] * n[2]);
        if (!(angle <= worst)) worst = angle;
    }
    return worst;
}

void race_normals(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const Refiner refiner = make_refiner(shape);
    const std::vector<float> points(shape.points.begin(), shape.points.end());
    std::vector<float> limit(points.size()), first(points.size()), second(points.size());
    Interpolation problem(open_device(arguments.device), shape, Scheme::catmull_clark);
    const FieldHandle normals = make_field(problem.A);
    lcl_tangents handle = nullptr;
    const MeshHandle mesh = make_mesh(shape);
    check(lcl_tangents_create(problem.A.get(), mesh.get(), &handle));
    const limitcl::TangentsHandle tangents(handle);
    run_rounds(arguments.runs, [&](Laps& laps) {
        rest();
        laps.time("normals.create", [&] {
            check(lcl_tangents_create(problem.A.get(), mesh.get(), &handle));
            lcl_tangents_release(handle);
        });
        laps.time_warm("normals.apply", [&] {
            check(lcl_operator_apply(problem.A.get(), problem.M.get(), problem.P.get()));
            problem.finish();
        });
        laps.time_warm("normals.limitcl", [&] {
            check(lcl_tangents_apply(tangents.get(), problem.M.get(), problem.P.get(), normals.get(), nullptr, nullptr));
            problem.finish();
        });
        laps.time_warm("normals.primvar-refiner", [&] {
            Point* to[] = {reinterpret_cast<Point*>(limit.data()), reinterpret_cast<Point*>(first.data()), reinterpret_cast<Point*>(second.data())};
            Far::PrimvarRefiner(*refiner).Limit(reinterpret_cast<const Point*>(points.data()), to[0], to[1], to[2]);
        });
    });
    const std::vector<double> ours = problem.control_points();
    std::vector<double> found(ours.size());
    check(lcl_field_download(normals.get(), found.data(), LCL_TYPE_DOUBLE, 0));
    print_value("normals.limitcl.error", error_of(shape, {ours.begin(), ours.end()}));
    print_value("normals.angle", largest_angle(found, first, second));
}

void limitcl_setup(const ContextHandle& context, const Shape& shape) {
    const OperatorHandle A = make_operator(context, make_mesh(shape), Scheme::catmull_clark);
    const FieldHandle M = make_field(A);
    check(lcl_field_upload(M.get(), shape.points.data(), LCL_TYPE_DOUBLE, 0));
    lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
    check(lcl_operator_diagnose(A.get(), &diagnosis));
}

void race_refiner(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const ContextHandle context = open_device(arguments.device);
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.time("refiner.limitcl", [&] { limitcl_setup(context, shape); });
        Refiner refiner;
        laps.time("refiner", [&] { refiner = make_refiner(shape); });
    });
}

constexpr int refined_levels = 4;

/// Topology of all levels; the last one in full, or with what positions need alone, OpenSubdiv's default.
Refiner refine_by_opensubdiv(const Shape& shape, bool is_full) {
    Refiner refiner = make_refiner(shape);
    Far::TopologyRefiner::UniformOptions options(refined_levels);
    options.fullTopologyInLastLevel = is_full;
    refiner->RefineUniform(options);
    return refiner;
}

/// Positions of all levels, one after the other; the last ones are the result.
void interpolate_by_opensubdiv(const Far::TopologyRefiner& refiner, std::vector<Point>& points) {
    const Far::PrimvarRefiner values(refiner);
    Point* from = points.data();
    for (int level = 1; level <= refined_levels; ++level) {
        Point* const to = from + refiner.GetLevel(level - 1).GetNumVertices();
        values.Interpolate(level, from, to);
        from = to;
    }
}

void race_refine(const Arguments& arguments) {
    const Shape shape = quad_sphere(std::max(0, arguments.level - refined_levels));
    const ContextHandle context = open_device(arguments.device);
    const MeshHandle mesh = make_mesh(shape);
    lcl_scheme_options scheme = LCL_SCHEME_OPTIONS_INIT;
    scheme.scheme = LCL_SCHEME_CATMULL_CLARK;
    lcl_refine_options levels = LCL_REFINE_OPTIONS_INIT;
    levels.levels = refined_levels;
    std::vector<double> ours;
    std::vector<Point> points;
    Refiner peer;
    run_rounds(arguments.runs, [&](Laps& laps) {
        rest();
        limitcl::RefinerHandle refiner;
        const auto apply = [&] { check(lcl_refiner_apply(refiner.get(), shape.points.data(), 0, 3, LCL_PRECISION_SINGLE, ours.data(), 0)); };
        laps.time("refine.limitcl", [&] {
            lcl_refiner made = nullptr;
            check(lcl_refiner_create(context.get(), mesh.get(), &scheme, &levels, &made));
            refiner = limitcl::RefinerHandle(made);
            ours.resize(3 * static_cast<std::size_t>(lcl_refiner_vertex_count(made)));
            apply();
        });
        laps.time("refine.limitcl.again", apply);
        laps.time("refine.limitcl.mesh", [&] {
            lcl_mesh refined = nullptr;
            check(lcl_mesh_refine(mesh.get(), &scheme, &levels, &refined));
            lcl_mesh_release(refined);
        });
        laps.time("refine.full", [&] {
            peer = refine_by_opensubdiv(shape, true);
            points.resize(peer->GetNumVerticesTotal());
            for (std::int32_t v = 0; v < shape.vertex_count(); ++v) std::copy_n(&shape.points[3 * v], 3, points[v].x);
            interpolate_by_opensubdiv(*peer, points);
        });
        laps.time("refine.lean", [&] {
            peer = refine_by_opensubdiv(shape, false);
            interpolate_by_opensubdiv(*peer, points);
        });
        laps.time("refine.again", [&] { interpolate_by_opensubdiv(*peer, points); });
    });
    print_value("refine.vertices", static_cast<double>(ours.size() / 3));
    print_value("refine.from", shape.vertex_count());
}

/// The table alone, from a TopologyRefiner that is there: as cheap as it gives limit points, and with one refinement as for points inside faces.
void time_stencils(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const Refiner refiner = make_refiner(shape);
    const ContextHandle context = open_device(arguments.device);
    limitcl_setup(context, shape);
    Laps laps;
    int runs = arguments.runs;
    for (int i = 0; i < runs; ++i) {
        laps.time("stencils.limitcl", [&] { limitcl_setup(context, shape); });
        const Clock::time_point start = Clock::now();
        laps.time("stencils.level-0", [&] { make_limit_table(shape, *refiner, cheapest_level); });
        laps.time("stencils.level-1", [&] { make_limit_table(shape, *refiner, 1); });
        if (seconds_since(start) > slow) runs = std::min(runs, 3);
    }
    laps.print();
    print_value("stencils.vertices", shape.vertex_count());
}

void run_part(const Arguments& arguments) {
    if (arguments.part == "apply") race_apply(arguments);
    else if (arguments.part == "normals") race_normals(arguments);
    else if (arguments.part == "refiner") race_refiner(arguments);
    else if (arguments.part == "stencils") time_stencils(arguments);
    else if (arguments.part == "refine") race_refine(arguments);
    else throw std::runtime_error("'" + arguments.part + "' is not a part");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::run_part); }
