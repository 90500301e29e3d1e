// SPDX-License-Identifier: BSD-3-Clause
#include "host/selftest/surface_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host/evaluate/device_surface.h"
#include "host/evaluate/reference.h"

namespace lcl {
namespace {

/// Places of a mesh: some in the middle of the first patch of every face, and some that come ever nearer to its first vertex.
struct PlaceList {
    std::vector<Index> faces, corners;
    std::vector<double> uv;

    void add(Index face, double u, double v) {
        faces.push_back(face);
        corners.push_back(0);
        uv.push_back(u);
        uv.push_back(v);
    }
    Places places() const { return {faces.size(), faces.data(), corners.data(), uv.data()}; }
};

PlaceList places_of(const PolygonMesh& mesh) {
    PlaceList list;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        list.add(f, 0.3, 0.6);
        list.add(f, 0.45, 0.1);
        list.add(f, std::ldexp(0.3, -(f % 20)), std::ldexp(0.2, -(f % 20)));
    }
    return list;
}

struct Values {
    std::vector<double> of[9];
    SurfaceValues arrays(std::size_t count) {
        for (int q = 0; q < 9; ++q) of[q].resize(count * (q < 7 ? 3 : 1));
        return {false, of[0].data(), of[1].data(), of[2].data(), of[3].data(), of[4].data(), of[5].data(), of[6].data(), of[7].data(), of[8].data()};
    }
};

double largest_of(const SurfaceJet& jet, int q) { return std::max({std::fabs(jet[q][0]), std::fabs(jet[q][1]), std::fabs(jet[q][2])}); }

/// Largest difference of a derivative in units of its size there: second derivatives are differences of first ones across the cell, whose width is that of its
/// distance to the vertex, and may cancel.
double difference(const std::vector<double>& values, const std::vector<SurfaceJet>& expected, const PlaceList& list, int q, double size) {
    double worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const double width = std::max(list.uv[2 * i], list.uv[2 * i + 1]);
        double largest = std::max(size, largest_of(expected[i], q));
        if (q > 2) largest = std::max(largest, std::max(largest_of(expected[i], 1), largest_of(expected[i], 2)) / width);
        for (std::size_t c = 0; c < 3; ++c) {
            const double by = std::fabs(values[3 * i + c] - expected[i][q][c]) / largest;
            if (!(by <= worst)) worst = by;
        }
    }
    return worst;
}

}  // namespace

bool check_surface(const std::shared_ptr<Context>& context, const std::string& name, const PolygonMesh& mesh, const FeatureOptions& feature_options,
                   const SchemeOptions& scheme, Real real, const std::function<void(const SelftestResult&)>& report) {
    const Topology topology = build_topology(mesh);
    DeviceSurface surface(context, build_patch_table(topology, find_features(mesh, topology, feature_options), scheme), real);
    surface.set_points(mesh.positions.data(), 3);
    const PlaceList list = places_of(mesh);
    const std::size_t count = list.faces.size();
    std::vector<PatchPlace> found(count);
    locate(surface.table(), list.places(), 0, count, found.data());
    const std::vector<double> control = control_points(surface.table(), mesh.positions, 3);
    std::vector<SurfaceJet> expected;
    for (const PatchPlace& place : found) expected.push_back(reference_jet(surface.table(), control, place));

    // A value sums some 60 products; weights of second derivatives add up to 16 times the points they differ by, and control points are of the model's size.
    const double tolerance = 256 * (real == Real::single ? std::ldexp(1, -24) : std::ldexp(1, -52));
    bool passed = true;
    for (const bool expanded : {false, true}) {
        if (expanded) surface.prepare_for(std::size_t{1} << 24);
        SamplePiece piece = surface.make_samples(list.places(), 0, count);
        Values values;
        surface.evaluate(piece, values.arrays(count));
        double worst = 0;
        for (const auto& [block, q] : std::vector<std::array<int, 2>>{{0, 0}, {1, 1}, {2, 2}, {4, 3}, {5, 4}, {6, 5}})
            worst = std::max(worst, difference(values.of[block], expected, list, q, surface.size()));
        const SelftestResult result{expanded ? "lcl_expand_cells" : "lcl_evaluate", name + (real == Real::single ? ", surface, single" : ", surface, double"),
                                    worst, tolerance};
        report(result);
        passed = result.passed() && passed;
    }
    return passed;
}

}  // namespace lcl
