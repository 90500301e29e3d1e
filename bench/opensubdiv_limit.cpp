// SPDX-License-Identifier: BSD-3-Clause
#include "opensubdiv_limit.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

namespace bench {
namespace {

constexpr int ring_refinements = 60;       // a dart's error shrinks by 0.5 to 0.7 a refinement: below 1e-9 of the ring
constexpr float infinitely_sharp = 10.0f;  // Sdc::Crease::SHARPNESS_INFINITE

struct Point {
    std::array<double, 3> x{};
    void Clear() { x = {}; }
    void AddWithWeight(const Point& p, double weight) {
        for (int c = 0; c < 3; ++c) x[c] += weight * p.x[c];
    }
};

struct Patch {
    std::vector<Point> points;
    std::vector<int> face_degrees, face_vertices, crease_vertices, corners;
    bool edge_only = true;
};

using Refiner = std::unique_ptr<Far::TopologyRefiner>;
using PrimvarRefiner = Far::PrimvarRefinerReal<double>;

Refiner make_refiner(const Patch& patch, bool loop) {
    const std::vector<float> edge_sharpness(patch.crease_vertices.size() / 2, infinitely_sharp), corner_sharpness(patch.corners.size(), infinitely_sharp);
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(patch.points.size());
    descriptor.numFaces = static_cast<int>(patch.face_degrees.size());
    descriptor.numVertsPerFace = patch.face_degrees.data();
    descriptor.vertIndicesPerFace = patch.face_vertices.data();
    descriptor.numCreases = static_cast<int>(edge_sharpness.size());
    descriptor.creaseVertexIndexPairs = patch.crease_vertices.data();
    descriptor.creaseWeights = edge_sharpness.data();
    descriptor.numCorners = static_cast<int>(patch.corners.size());
    descriptor.cornerVertexIndices = patch.corners.data();
    descriptor.cornerWeights = corner_sharpness.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(patch.edge_only ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    Refiner refiner(Factory::Create(descriptor, Factory::Options(loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, options)));
    if (!refiner) throw std::runtime_error("OpenSubdiv refuses the mesh");
    return refiner;
}

void refine_uniformly(Far::TopologyRefiner& refiner, int levels) {
    Far::TopologyRefiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;
    refiner.RefineUniform(options);
}

bool is_corner(const Far::TopologyLevel& level, int vertex) { return level.GetVertexSharpness(vertex) >= infinitely_sharp; }

bool is_dart(const Far::TopologyLevel& level, int vertex) {
    const Far::ConstIndexArray edges = level.GetVertexEdges(vertex);
    int sharp_edges = 0;
    for (int i = 0; i < edges.size(); ++i) sharp_edges += level.GetEdgeSharpness(edges[i]) >= infinitely_sharp;
    return sharp_edges == 1 && !is_corner(level, vertex);
}

// The faces round a vertex, which becomes vertex 0. Only its own sharpness matters: no other edge has a part in its next one-ring.
Patch one_ring(const Far::TopologyLevel& level, const std::vector<Point>& points, int vertex) {
    Patch ring;
    std::map<int, int> number{{vertex, 0}};
    ring.points.push_back(points[vertex]);
    const Far::ConstIndexArray faces = level.GetVertexFaces(vertex);
    for (int i = 0; i < faces.size(); ++i) {
        const Far::ConstIndexArray corners = level.GetFaceVertices(faces[i]);
        ring.face_degrees.push_back(corners.size());
        for (int k = 0; k < corners.size(); ++k) {
            const auto [place, is_new] = number.try_emplace(corners[k], static_cast<int>(ring.points.size()));
            if (is_new) ring.points.push_back(points[corners[k]]);
            ring.face_vertices.push_back(place->second);
        }
    }
    const Far::ConstIndexArray edges = level.GetVertexEdges(vertex);
    for (int i = 0; i < edges.size(); ++i)
        if (!level.IsEdgeBoundary(edges[i]) && level.GetEdgeSharpness(edges[i]) >= infinitely_sharp)
            for (int k = 0; k < 2; ++k) ring.crease_vertices.push_back(number.at(level.GetEdgeVertices(edges[i])[k]));
    if (is_corner(level, vertex)) ring.corners.push_back(0);
    return ring;
}

// Refines the one-ring again and again. Each refinement needs the one-ring of the last alone.
Point refine_to_the_limit(Patch ring, bool loop) {
    for (int step = 0; step < ring_refinements; ++step) {
        const Refiner refiner = make_refiner(ring, loop);
        refine_uniformly(*refiner, 1);
        std::vector<Point> refined(static_cast<std::size_t>(refiner->GetLevel(1).GetNumVertices()));
        PrimvarRefiner(*refiner).Interpolate(1, ring.points, refined);
        ring = one_ring(refiner->GetLevel(1), refined, refiner->GetLevel(0).GetVertexChildVertex(0));
    }
    return ring.points[0];
}

// Limit points by OpenSubdiv's masks. Its masks at polygons are those of quads, so Catmull-Clark is refined once first.
std::vector<Point> limit_by_masks(Far::TopologyRefiner& refiner, const std::vector<Point>& points, bool loop) {
    std::vector<Point> limit(points.size());
    if (loop) {
        PrimvarRefiner(refiner).Limit(points, limit);
        return limit;
    }
    refine_uniformly(refiner, 1);
    std::vector<Point> refined(static_cast<std::size_t>(refiner.GetLevel(1).GetNumVertices())), refined_limit(refined.size());
    PrimvarRefiner(refiner).Interpolate(1, points, refined);
    PrimvarRefiner(refiner).Limit(refined, refined_limit);
    for (std::size_t v = 0; v < points.size(); ++v)
        limit[v] = refined_limit[static_cast<std::size_t>(refiner.GetLevel(0).GetVertexChildVertex(static_cast<int>(v)))];
    return limit;
}

std::vector<char> near_darts(const Far::TopologyLevel& level) {
    std::vector<char> near(static_cast<std::size_t>(level.GetNumVertices()), 0);
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        if (!is_dart(level, v)) continue;
        const Far::ConstIndexArray faces = level.GetVertexFaces(v);
        for (int i = 0; i < faces.size(); ++i)
            for (int k = 0; k < level.GetFaceVertices(faces[i]).size(); ++k) near[static_cast<std::size_t>(level.GetFaceVertices(faces[i])[k])] = 1;
    }
    return near;
}

// The mesh without isolated vertices, which OpenSubdiv does not know; `number` receives the new number of each vertex, -1 without.
Patch used_part(const SharpMesh& mesh, std::vector<int>& number) {
    Patch patch;
    number.assign(mesh.points.size() / 3, -1);
    for (const int v : mesh.face_vertices) number[static_cast<std::size_t>(v)] = 0;
    for (std::size_t v = 0; v < number.size(); ++v)
        if (number[v] == 0) {
            number[v] = static_cast<int>(patch.points.size());
            patch.points.push_back({{mesh.points[3 * v], mesh.points[3 * v + 1], mesh.points[3 * v + 2]}});
        }
    patch.face_degrees = mesh.face_degrees;
    for (const int v : mesh.face_vertices) patch.face_vertices.push_back(number[static_cast<std::size_t>(v)]);
    for (const std::array<int, 2>& edge : mesh.creases)
        for (const int v : edge) patch.crease_vertices.push_back(number[static_cast<std::size_t>(v)]);
    for (const int v : mesh.corners)
        if (number[static_cast<std::size_t>(v)] >= 0) patch.corners.push_back(number[static_cast<std::size_t>(v)]);
    patch.edge_only = mesh.boundary_edge_only;
    return patch;
}

}  // namespace

LimitPoints opensubdiv_limit(const SharpMesh& mesh, bool loop) {
    std::vector<int> number;
    const Patch patch = used_part(mesh, number);
    const Refiner refiner = make_refiner(patch, loop);
    const std::vector<Point> limit = limit_by_masks(*refiner, patch.points, loop);
    const Far::TopologyLevel& level = refiner->GetLevel(0);
    const std::vector<char> near = near_darts(level);

    LimitPoints result{mesh.points, std::vector<Found>(number.size(), Found::left_out)};
    for (std::size_t v = 0; v < number.size(); ++v) {
        const int u = number[v];
        if (u < 0 || (!level.IsVertexBoundary(u) && level.GetVertexEdges(u).size() == 2)) continue;
        const bool by_refinement = near[static_cast<std::size_t>(u)];
        const Point point = by_refinement ? refine_to_the_limit(one_ring(level, patch.points, u), loop) : limit[static_cast<std::size_t>(u)];
        std::copy(point.x.begin(), point.x.end(), result.points.begin() + static_cast<std::ptrdiff_t>(3 * v));
        result.found[v] = by_refinement ? Found::by_refinement : Found::by_mask;
    }
    return result;
}

}  // namespace bench
