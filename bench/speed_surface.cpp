// SPDX-License-Identifier: BSD-3-Clause
// speed_surface PART: limitcl's limit surfaces beside OpenSubdiv's patches, in single precision: "points" (positions and first derivatives at random places,
// finding the patches included), "tables" (from index arrays to what can be evaluated), "closest" (closest points; limitcl alone).
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>
#include <opensubdiv/osd/ompEvaluator.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "interpolation.h"
#include "measure.h"
#include "opensubdiv_surface.h"

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;

namespace bench {
namespace {

constexpr std::size_t point_count = 10'000'000, fewer_points = 200'000;  // the latter on small meshes, for a quick look
constexpr std::int32_t full_size = 3842;                                 // vertices, from which on all points are taken
constexpr std::size_t piece = 1 << 16;                                   // of OpenSubdiv's points: its coordinates and patches stay in the caches
constexpr int isolation = 6;                                             // refinements round irregular vertices; evaluation takes as long with fewer

using SurfaceHandle = limitcl::Handle<lcl_limit_surface, lcl_limit_surface_retain, lcl_limit_surface_release>;
using SamplesHandle = limitcl::Handle<lcl_samples, lcl_samples_retain, lcl_samples_release>;

SurfaceHandle make_surface(const ContextHandle& context, const MeshHandle& mesh, lcl_precision precision) {
    lcl_scheme_options options = LCL_SCHEME_OPTIONS_INIT;
    options.scheme = LCL_SCHEME_CATMULL_CLARK;
    lcl_limit_surface surface = nullptr;
    check(lcl_limit_surface_create(context.get(), mesh.get(), &options, precision, &surface));
    return SurfaceHandle(surface);
}

SharpMesh sharp_mesh(const Shape& shape) {
    SharpMesh mesh;
    mesh.points = shape.points;
    mesh.face_degrees.assign(static_cast<std::size_t>(shape.face_count()), shape.degree);
    mesh.face_vertices.assign(shape.faces.begin(), shape.faces.end());
    return mesh;
}

/// Random places on a shape of quads.
struct RandomPlaces {
    RandomPlaces(const Shape& shape, std::size_t count) : faces(count), uv(2 * count) {
        std::mt19937 random(2);
        std::uniform_int_distribution<std::int32_t> face(0, shape.face_count() - 1);
        std::uniform_real_distribution<double> place(0, 1);
        for (std::int32_t& f : faces) f = face(random);
        for (double& x : uv) x = place(random);
    }
    std::vector<std::int32_t> faces;
    std::vector<double> uv;
};

struct Values {
    explicit Values(std::size_t count) : points(3 * count), du(3 * count), dv(3 * count) {}
    lcl_surface_values arrays() {
        lcl_surface_values values = LCL_SURFACE_VALUES_INIT;
        values.type = LCL_TYPE_FLOAT;
        values.points = points.data();
        values.du = du.data();
        values.dv = dv.data();
        return values;
    }
    std::vector<float> points, du, dv;
};

/// OpenSubdiv's patches in float with control points, as its evaluators take them.
class Peer {
public:
    explicit Peer(const Shape& shape)
        : patches_(sharp_mesh(shape), {false, EndCap::ENDCAP_GREGORY_BASIS, isolation}),
          control_(patches_.control_points(shape.points)),
          table_(&patches_.table()),
          coordinates_(piece) {}

    /// Finds the patches and evaluates them, piece by piece; in both, all cores under OmpEvaluator.
    template <class Evaluator>
    void evaluate(const RandomPlaces& places, Values& values) {
        constexpr bool is_parallel = std::is_same_v<Evaluator, Osd::OmpEvaluator>;
        const Osd::BufferDescriptor layout(0, 3, 3);
        for (std::size_t first = 0; first < places.faces.size(); first += piece) {
            const int count = static_cast<int>(std::min(piece, places.faces.size() - first));
#pragma omp parallel for if (is_parallel)
            for (int i = 0; i < count; ++i) {
                const double u = places.uv[2 * (first + i)], v = places.uv[2 * (first + i) + 1];
                coordinates_[i] = Osd::PatchCoord(*patches_.find(places.faces[first + i], u, v), static_cast<float>(u), static_cast<float>(v));
            }
            Evaluator::EvalPatches(control_.data(), layout, &values.points[3 * first], layout, &values.du[3 * first], layout, &values.dv[3 * first], layout, count,
                                   coordinates_.data(), table_.GetPatchArrayBuffer(), table_.GetPatchIndexBuffer(), table_.GetPatchParamBuffer());
        }
    }

private:
    OpenSubdivPatches<float> patches_;
    std::vector<float> control_;
    Osd::CpuPatchTable table_;
    std::vector<Osd::PatchCoord> coordinates_;
};

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::abs(a[i] - b[i]) <= worst)) worst = std::abs(a[i] - b[i]);  // also if it is not a number
    return worst;
}

void race_points(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const RandomPlaces places(shape, shape.vertex_count() < full_size ? fewer_points : point_count);
    const std::size_t count = places.faces.size();
    const SurfaceHandle surface = make_surface(open_device(arguments.device), make_mesh(shape), LCL_PRECISION_SINGLE);
    Values ours(count), theirs(count);
    const lcl_surface_values to = ours.arrays();
    Peer peer(shape);
    SamplesHandle samples;
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.time("surface.points", [&] { check(lcl_limit_surface_evaluate(surface.get(), count, places.faces.data(), nullptr, places.uv.data(), &to)); });
        laps.time("surface.samples", [&] {
            lcl_samples made = nullptr;
            check(lcl_samples_create(surface.get(), count, places.faces.data(), nullptr, places.uv.data(), &made));
            samples = SamplesHandle(made);
        });
        laps.time("surface.again", [&] { check(lcl_samples_evaluate(samples.get(), &to)); });
        samples = SamplesHandle();
        laps.time("surface.points.cpu", [&] { peer.evaluate<Osd::CpuEvaluator>(places, theirs); });
        laps.time("surface.points.omp", [&] { peer.evaluate<Osd::OmpEvaluator>(places, theirs); });
        rest();
    });
    print_value("surface.points.count", static_cast<double>(count));
    print_value("surface.points.vertices", shape.vertex_count());
    print_value("surface.points.difference", largest_difference(ours.points, theirs.points) / diagonal(shape));  // OpenSubdiv's end caps
}

/// What a user of OpenSubdiv makes: refiner, patches, map, and a table of stencils that gives points of all levels and of end caps.
void make_peer_tables(const SharpMesh& mesh, Laps& laps, const std::string& name) {
    const Clock::time_point start = Clock::now();
    const OpenSubdivPatches<float> patches(mesh, {false, EndCap::ENDCAP_GREGORY_BASIS, isolation});
    laps.add(name + ".patches", seconds_since(start));
    using Stencils = std::unique_ptr<const Far::StencilTable>;
    Far::StencilTableFactory::Options options;
    options.generateIntermediateLevels = true;
    const Stencils refined(Far::StencilTableFactory::Create(patches.refiner(), options));
    const Stencils all(Far::StencilTableFactory::AppendLocalPointStencilTable(patches.refiner(), refined.get(), patches.table().GetLocalPointStencilTable()));
    if (!all) throw std::runtime_error("OpenSubdiv gives no stencils");
    laps.add(name + ".all", seconds_since(start));
}

void race_tables(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const SharpMesh mesh = sharp_mesh(shape);
    const ContextHandle context = open_device(arguments.device);
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.time("surface.tables", [&] {
            make_surface(context, make_mesh(shape), LCL_PRECISION_SINGLE);
            check(lcl_context_finish(context.get()));
        });
        make_peer_tables(mesh, laps, "surface.tables.peer");
    });
    print_value("surface.tables.vertices", shape.vertex_count());
}

/// Points on both sides of the surface, up to a hundredth of the diagonal from it.
std::vector<double> near_points(const SurfaceHandle& surface, const Shape& shape, std::size_t count) {
    const RandomPlaces places(shape, count);
    std::vector<double> points(3 * count), normals(3 * count);
    lcl_surface_values to = LCL_SURFACE_VALUES_INIT;
    to.points = points.data();
    to.normals = normals.data();
    check(lcl_limit_surface_evaluate(surface.get(), count, places.faces.data(), nullptr, places.uv.data(), &to));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> distance(-0.01 * diagonal(shape), 0.01 * diagonal(shape));
    for (std::size_t i = 0; i < count; ++i) {
        const double d = distance(random);
        for (std::size_t c = 0; c < 3; ++c) points[3 * i + c] += d * normals[3 * i + c];
    }
    return points;
}

void time_closest(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const std::size_t count = shape.vertex_count() < full_size ? fewer_points / 10 : point_count / 10;
    const SurfaceHandle surface = make_surface(open_device(arguments.device), make_mesh(shape), LCL_PRECISION_MIXED);
    const std::vector<double> points = near_points(surface, shape, count);
    std::vector<double> found(3 * count), uv(2 * count), distances(count);
    std::vector<std::int32_t> faces(count), corners(count);
    lcl_closest_points to = LCL_CLOSEST_POINTS_INIT;
    to.points = found.data();
    to.uv = uv.data();
    to.distances = distances.data();
    to.faces = faces.data();
    to.corners = corners.data();
    run_rounds(std::min(arguments.runs, 3),
               [&](Laps& laps) { laps.time("surface.closest", [&] { check(lcl_limit_surface_closest(surface.get(), count, points.data(), 0, &to)); }); });
    print_value("surface.closest.count", static_cast<double>(count));
}

void run_part(const Arguments& arguments) {
    if (arguments.part == "points") race_points(arguments);
    else if (arguments.part == "tables") race_tables(arguments);
    else if (arguments.part == "closest") time_closest(arguments);
    else throw std::runtime_error("'" + arguments.part + "' is not a part");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::run_part); }
