// SPDX-License-Identifier: BSD-3-Clause
// Doo-Sabin patches, both masks: kinds, places, control points.
#include <cmath>

#include <catch2/catch.hpp>

#include "host/evaluate/doo_sabin_walk.h"
#include "tests/modes_support.h"
#include "tests/patch_checks.h"

using namespace lcl;
using patches::At;
using patches::Jet;
using patches::Surface;

namespace {

const double turn = 2 * std::acos(-1.0);

SchemeOptions doo_sabin(DooSabinMask mask) {
    SchemeOptions options;
    options.scheme = Scheme::doo_sabin;
    options.mask = mask;
    return options;
}

/// Quads alone: vertices 0 and 1 have n faces, the others three.
shapes::Shape trapezohedron(int n) {
    std::vector<shapes::Point> points{{0, 0, 0.9}, {0, 0, -0.9}};
    std::vector<shapes::Face> faces;
    for (int i = 0; i < 2 * n; ++i) points.push_back({std::cos(turn * i / (2 * n)), std::sin(turn * i / (2 * n)), i % 2 == 0 ? 0.2 : -0.2});
    const auto ring = [&](int i) { return 2 + (i + 2 * n) % (2 * n); };
    for (int i = 0; i < 2 * n; i += 2) {
        faces.push_back({0, ring(i), ring(i + 1), ring(i + 2)});
        faces.push_back({1, ring(i + 1), ring(i), ring(i - 1)});
    }
    return shapes::rough(shapes::make("trapezohedron_" + std::to_string(n), points, faces), 0.1, n);
}

/// A prism: two faces of n sides, quads between them.
shapes::Shape prism(int n) {
    std::vector<shapes::Point> points;
    std::vector<shapes::Face> faces(2);
    for (const double z : {-0.5, 0.5})
        for (int i = 0; i < n; ++i) points.push_back({std::cos(turn * i / n), std::sin(turn * i / n), z});
    for (int i = 0; i < n; ++i) {
        faces[0].insert(faces[0].begin(), i);
        faces[1].push_back(n + i);
        faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    return shapes::rough(shapes::make("prism_" + std::to_string(n), points, faces), 0.1, n);
}

/// Vertex 0 on the boundary with k quads.
shapes::Shape fan(int k) {
    std::vector<shapes::Point> points{{0, 0, 0.2}};
    std::vector<shapes::Face> faces;
    for (int i = 0; i <= 2 * k; ++i) points.push_back({std::cos(turn * i / (2 * k + 4)), std::sin(turn * i / (2 * k + 4)), 0.1 * i});
    for (int i = 0; i < k; ++i) faces.push_back({0, 1 + 2 * i, 2 + 2 * i, 3 + 2 * i});
    return shapes::rough(shapes::make("fan_" + std::to_string(k), points, faces), 0.1, k);
}

/// Squares of neighbouring corners agree in position and first derivatives. Where a square reaches beyond a sharp edge at (u = 0 or v = 0, negative other one)
/// its neighbour is that of the next corner's if the vertex has two faces there.
void check_continuity(const Surface& surface) {
    const Topology& topology = surface.topology;
    const auto jet_at = [&](Index h, double a, double b) {
        const Index face = topology.half_edge_face[h];
        return surface.jet({face, h - topology.face_offsets[face], a, b});
    };
    const auto agree = [&](const Jet& here, const Jet& there, Index h, double x) {
        if ((here.row(0) - there.row(0)).norm() < 1e-14 && (here - there).middleRows(1, 2).norm() < 1e-12) return;
        CAPTURE(surface.shape.name, topology.half_edge_face[h], h, x);
        REQUIRE(here == there);
    };
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
        const bool next_is_sharp = surface.table.square_beyond(h, 0) >= 0, previous_is_sharp = surface.table.square_beyond(h, 1) >= 0;
        for (const double x : {-0.7, 0.03, 0.25, 0.5, 0.8, 0.97}) {
            // Side a = 1 is side b = 1 of the next corner's square, with its a = b: there it begins at the sharp edge too.
            if (x > 0 || next_is_sharp) agree(jet_at(h, 1, x), patches::turned(jet_at(topology.next(h), x, 1), 0, 1, -1, 0), h, x);
            // Side b = 0 is side a = 0 of the corner before in the fan.
            if (x > 0 && !next_is_sharp) agree(jet_at(h, x, 0), patches::turned(jet_at(topology.next(topology.twin[h]), 0, x), 0, -1, 1, 0), h, x);
            // From beyond the edge into the square itself.
            if (x > 0 && next_is_sharp) agree(jet_at(h, x, 0), jet_at(h, x, -1e-300), h, x);
            if (x > 0 && previous_is_sharp) agree(jet_at(h, 0, x), jet_at(h, -1e-300, x), h, x);
        }
    }
}

/// A corner without sharp edges, which has no patches.
bool has_smooth_corner(const shapes::Shape& shape) {
    const Topology topology = build_topology(shape.mesh);
    for (const auto& sector : lay_out_doo_sabin(topology, find_features(shape.mesh, topology, shape.features)).sectors)
        if (sector.closed && sector.kept >= 0) return true;
    return false;
}

void check_all(const shapes::Shape& shape, DooSabinMask mask, int levels) {
    const Surface surface(shape, doo_sabin(mask));
    patches::check_table(surface.table);
    patches::check_limits(surface, levels);
    check_continuity(surface);
}

}  // namespace

TEST_CASE("Doo-Sabin patches go through the limits of refined vertices and fit together, at all valences and degrees", "[evaluate][doo-sabin]") {
    for (const DooSabinMask mask : {DooSabinMask::catmull, DooSabinMask::classic}) {
        for (int n = 3; n <= 12; ++n) {
            check_all(prism(n), mask, n < 8 ? 2 : 1);
            check_all(trapezohedron(n), mask, n < 6 ? 2 : 1);
        }
        check_all(shapes::rough(shapes::dodecahedron(), 0.1, 1), mask, 1);
        check_all(prism(5), mask, 3);
    }
}

TEST_CASE("Doo-Sabin patches are right at boundaries with any number of faces", "[evaluate][doo-sabin]") {
    for (const DooSabinMask mask : {DooSabinMask::catmull, DooSabinMask::classic}) {
        for (int k = 1; k <= 6; ++k) {
            shapes::Shape shape = fan(k);
            check_all(shape, mask, 2);
            shape.features.corners = {0};
            check_all(shape, mask, 2);
            shape.features = {};
            shape.features.boundary = BoundaryRule::edge_only;
            check_all(shape, mask, 2);
        }
    }
    shapes::Shape fixed = fan(3);
    fixed.features.boundary = BoundaryRule::fixed;
    check_all(fixed, DooSabinMask::catmull, 2);
    for (const auto& shape : shapes::boundary_shapes()) check_all(shape, DooSabinMask::catmull, 1);
}

TEST_CASE("Doo-Sabin patches are right at creases, darts and corners", "[evaluate][doo-sabin]") {
    for (const auto& shape : shapes::feature_shapes()) {
        if (has_smooth_corner(shape)) continue;
        check_all(shape, DooSabinMask::catmull, shape.mesh.face_count() < 30 ? 2 : 1);
    }
}

TEST_CASE("Doo-Sabin derivatives are those of the positions, by the corner's own parameters", "[evaluate][doo-sabin]") {
    shapes::Shape corner = fan(3);
    corner.features.corners = {0};
    for (const auto& shape : {prism(5), trapezohedron(3), corner, shapes::single_quad()}) {
        const Surface surface(shape, doo_sabin(DooSabinMask::classic));
        for (Index h = 0; h < surface.topology.half_edge_count(); ++h) {
            const Index face = surface.topology.half_edge_face[h], k = h - surface.topology.face_offsets[face];
            std::vector<At> places{{face, k, 0.06, 0.17}, {face, k, 0.8, 0.13}, {face, k, 0.16, 0.71}, {face, k, 0.9, 0.83}, {face, k, 0.02, 0.007}};
            if (surface.table.square_beyond(h, 0) >= 0) places.insert(places.end(), {{face, k, 0.3, -0.8}, {face, k, 0.8, -0.3}});
            if (surface.table.square_beyond(h, 1) >= 0) places.insert(places.end(), {{face, k, -0.3, 0.8}, {face, k, -0.8, 0.3}});
            if (surface.table.square_beyond(h, 2) >= 0) places.insert(places.end(), {{face, k, -0.3, -0.8}, {face, k, -0.8, -0.3}, {face, k, -0.6, -0.7}});
            for (const At& at : places) patches::check_derivatives(surface, at, 0.002);
        }
    }
}

TEST_CASE("Doo-Sabin patches deep at their tip are those of the refined mesh", "[evaluate][doo-sabin]") {
    // (u, v) next to the centre of a vertex's face is (1 - 2u, 1 - 2v) at the corner of that face which the refined vertex is, next to (1, 1).
    shapes::Shape corner = fan(5);
    corner.features.corners = {0};
    for (const DooSabinMask mask : {DooSabinMask::catmull, DooSabinMask::classic}) {
        std::vector<shapes::Shape> all{fan(4), corner};
        for (int n = 3; n <= 12; ++n) all.push_back(trapezohedron(n));
        for (const auto& shape : all) {
            const Refinement refined = refine(shape.mesh, shape.features, doo_sabin(mask), 1);
            const Surface surface(shape, doo_sabin(mask)), fine({shape.name, refined.mesh, refined.features}, doo_sabin(mask));
            for (Index h = 0; h < surface.topology.half_edge_count(); ++h) {
                const Index face = surface.topology.half_edge_face[h], k = h - surface.topology.face_offsets[face];
                const Index across = fine.topology.rotate(fine.topology.rotate(h)), fine_face = fine.topology.half_edge_face[across];
                const Index fine_k = across - fine.topology.face_offsets[fine_face];
                for (const double scale : {0.25, 0x1p-10, 0x1p-20}) {
                    for (const auto& [u, v] : {std::array<double, 2>{0.8125, 0.1875}, {0.625, 0.75}, {0.1875, 0.8125}, {0, 0.6875}}) {
                        const Jet whole = surface.jet({face, k, scale * u, scale * v});
                        const Jet child = patches::turned(fine.jet({fine_face, fine_k, 1 - 2 * scale * u, 1 - 2 * scale * v}), -2, 0, 0, -2);
                        if (patches::is_same(whole, child, scale)) continue;
                        CAPTURE(shape.name, face, k, scale, u, v);
                        REQUIRE(whole == child);
                    }
                }
            }
        }
    }
}

TEST_CASE("the eigenstructure of every Doo-Sabin kind is found, the classic mask's with its chains", "[evaluate][doo-sabin][modes]") {
    for (const DooSabinMask mask : {DooSabinMask::catmull, DooSabinMask::classic}) {
        for (int n = 3; n <= 50; ++n) {
            if (n == 4) continue;
            const PatchKind kind = doo_sabin_kind(n, mask);
            const std::optional<Modes> modes = find_modes(kind);
            CAPTURE(n, mask == DooSabinMask::classic);
            REQUIRE(modes);
            modes_support::check_kind(kind);
            modes_support::check_modes(kind, *modes);
            bool has_chain = false;
            for (const std::uint8_t power : modes->powers) has_chain |= power == 1;
            CHECK(has_chain == (mask == DooSabinMask::classic && n >= 5));
        }
    }
}

TEST_CASE("regular Doo-Sabin patches need no kinds, on boundaries neither", "[evaluate][doo-sabin]") {
    const Surface surface(shapes::grid_quads(3, 2), doo_sabin(DooSabinMask::catmull));
    CHECK(surface.table.kinds.empty());
    CHECK(surface.table.ghosts.indices.empty());
    CHECK(Surface(prism(5), doo_sabin(DooSabinMask::catmull)).table.kinds.size() == 2);  // faces of 5 sides; vertices of 3 faces
}

TEST_CASE("Doo-Sabin places that do not exist are refused by number", "[evaluate][doo-sabin]") {
    const auto refuses = [&](const Surface& surface, const At& at, const char* message) {
        const Index faces[] = {0, at.face}, corners[] = {0, at.corner};
        const double uv[] = {0.25, 0.5, at.u, at.v};
        PatchPlace places[2];
        REQUIRE_THROWS_WITH(locate(surface.table, {2, faces, corners, uv}, 0, 2, places), Catch::Contains(message));
    };
    const Surface cube(shapes::cube(), doo_sabin(DooSabinMask::catmull));
    refuses(cube, {6, 0, 0, 0}, "place 1: face 6 does not exist, the mesh has 6 faces (0 to 5)");
    refuses(cube, {-1, 0, 0, 0}, "place 1: face -1 does not exist");
    refuses(cube, {2, 4, 0, 0}, "place 1: corner 4 of face 2 does not exist, it has 4 corners (0 to 3)");
    refuses(cube, {2, -1, 0, 0}, "place 1: corner -1 of face 2 does not exist");
    refuses(cube, {2, 1, 0.5, -0.1}, "place 1: (u, v) = (0.500000, -0.100000) is not at corner 1 of face 2: u runs from 0 to 1, v from 0 to 1");
    refuses(cube, {2, 1, 1.1, 0}, "is not at corner 1 of face 2");
    refuses(cube, {2, 1, std::nan(""), 0}, "is not at corner 1 of face 2");
    const Surface quad(shapes::grid_quads(2, 1), doo_sabin(DooSabinMask::catmull));
    CHECK_NOTHROW(quad.locate({0, 0, -1, -1}));
    refuses(quad, {0, 1, 0.5, -0.5}, "u runs from -1 to 1, v from 0 to 1");
    shapes::Shape round = shapes::single_quad();
    round.features.boundary = BoundaryRule::edge_only;
    refuses(Surface(round, doo_sabin(DooSabinMask::catmull)), {0, 0, -0.5, -0.5}, "both together do not go below 0");
}

TEST_CASE("Doo-Sabin corners without sharp edges have no patches", "[evaluate][doo-sabin]") {
    shapes::Shape shape = shapes::cube();
    shape.features.corners = {3};
    REQUIRE_THROWS_WITH(Surface(shape, doo_sabin(DooSabinMask::catmull)), Catch::Contains("vertex 3 is a corner without sharp edges"));
}
