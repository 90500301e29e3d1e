// SPDX-License-Identifier: BSD-3-Clause
// One patch for each vertex of the twice refined mesh, the square between the centres of the four faces round it. A vertex of the once refined mesh has four
// patches, the quarters of its own square, which is what (u, v) run over: a vertex at a corner of the old mesh's faces, [0, 1]^2 of that corner; a point on an
// edge, the square next to it beyond that edge; a kept corner, [-1, 0]^2 of its first face's corner.
//
// Regular are the patches of boundary points and kept corners, and those at faces of four sides. The others have the centre of their extraordinary face, which
// boundaries do not touch any more, at (s, t) = (0, 0), and so have the regular ones at corners of faces.
#include <cmath>
#include <map>
#include <string>

#include "host/evaluate/doo_sabin_walk.h"
#include "host/evaluate/patch_table.h"
#include "host/parallel.h"

namespace lcl {
namespace {

/// By the turn of a patch in its quarter (x, y), each from 0 to 1: (s, t) = (x, y), (y, 1 - x), (1 - x, 1 - y), (1 - y, x). x and y are twice u and v.
constexpr ParameterTurn turns[4] = {{2, 0, 0, 2}, {0, -2, 2, 0}, {-2, 0, 0, -2}, {0, 2, -2, 0}};

enum class Square : std::uint8_t { corner, beyond_next, beyond_previous, kept };

/// Quarters of a square are numbered as in DooSabinLayout: towards (1, 1), (1, 0), (0, 0), (0, 1). Their patches' turns: those at corners of faces begin in the
/// square's own corner, those on boundaries at the boundary, with it on their right.
constexpr std::int32_t quarter_turns[4][4] = {{2, 1, 0, 3}, {2, 0, 0, 3}, {2, 1, 3, 3}, {2, 0, 0, 3}};

/// A corner without sharp edges is surrounded by triangles again after every refinement: no patches.
void check_corners(const DooSabinLayout& layout) {
    for (const auto& sector : layout.sectors)
        if (sector.closed && sector.kept >= 0)
            throw Unsupported(
                "vertex " + std::to_string(sector.vertex) +
                    " is a corner without sharp edges, round which the Doo-Sabin surface has no patches: make it no corner, mark two of its edges "
                    "as creases, or choose another scheme",
                Where{{sector.vertex}, {}});
}

/// Patches of the once refined mesh, by the layout of its refinement.
class PatchBuilder {
public:
    PatchBuilder(const Topology& topology, const DooSabinLayout& layout, Index first_kept, DooSabinMask mask, PatchTable& table)
        : topology_(topology), layout_(layout), walk_(topology, layout, first_kept), mask_(mask), table_(table) {}

    void build() {
        number();
        write_corners();
        write_boundary();
    }

private:
    void number() {
        const Index corners = topology_.half_edge_count(), patches = layout_.isolated_begin;
        table_.kind.assign(patches, -1);
        table_.patch_begin.assign(1, 0);
        table_.patch_begin.reserve(static_cast<std::size_t>(patches) + 1);
        std::int64_t next = 0;
        for (Index patch = 0; patch < patches; ++patch) {
            const Index sides = patch < corners ? topology_.degree(topology_.half_edge_face[patch]) : 4;
            if (sides != 4) table_.kind[patch] = kind_of(sides);
            next += sides == 4 ? 9 : sides + 5;
            check_control_count(next);
            table_.patch_begin.push_back(static_cast<Index>(next));
        }
        table_.control.resize(next);
    }

    std::int32_t kind_of(Index sides) {
        const auto [found, is_new] = kinds_.try_emplace(sides, static_cast<std::int32_t>(table_.kinds.size()));
        if (is_new) table_.kinds.push_back(doo_sabin_kind(sides, mask_));
        return found->second;
    }

    void write_corners() {
        const auto write = [&](std::size_t begin, std::size_t end) {
            for (auto h = static_cast<Index>(begin); h < static_cast<Index>(end); ++h) {
                if (table_.kind[h] < 0) put(h, walk_.of_corner(h, 2));
                else walk_.of_irregular_corner(h, topology_.degree(topology_.half_edge_face[h]), table_.control.data() + table_.patch_begin[h]);
            }
        };
        parallel_for(topology_.half_edge_count(), write, smallest_parallel_piece / 4);
    }

    void write_boundary() {
        for (Index e = 0; e < topology_.edge_count; ++e) {
            if (layout_.first_point[e] < 0) continue;
            const Index h = topology_.edge_half_edge[e];
            put(walk_.near_point(h), walk_.of_near_point(h));
            put(walk_.far_point(h), walk_.of_far_point(h));
        }
        for (const auto& sector : layout_.sectors)
            if (sector.kept >= 0) put(sector.kept, walk_.of_kept(sector.first));
    }

    void put(Index patch, const DooSabinWalk::Nine& points) { std::copy(points.begin(), points.end(), table_.control.begin() + table_.patch_begin[patch]); }

    const Topology& topology_;
    const DooSabinLayout& layout_;
    DooSabinWalk walk_;
    DooSabinMask mask_;
    PatchTable& table_;
    std::map<Index, std::int32_t> kinds_;
};

/// The patches of the quarters of every square. Half-edges of the once refined mesh: those of old corners have the old numbers.
void add_quarters(const Topology& once, const DooSabinWalk& walk, Index corners, Index first_kept, std::vector<Index>& quarters) {
    const auto put = [&](Index vertex, Index q0, Index q1, Index q2, Index q3) {
        Index* const out = &quarters[4 * static_cast<std::size_t>(vertex)];
        out[0] = q0, out[1] = q1, out[2] = q2, out[3] = q3;
    };
    const auto put_vertex = [&](Index v) {
        const Index start = v < corners ? v : once.vertex_half_edge[v];
        if (start < 0) return;  // isolated
        const Index following = once.rotate(start);
        if (v < corners) put(v, start, once.rotate(once.rotate(following)), once.rotate(following), following);
        else if (v >= first_kept) put(v, start, walk.near_point(start), walk.kept(v), walk.far_point(once.previous(start)));
        // The face of the edge comes first at the point next to the edge's origin, second at the other.
        else if ((v - corners) % 2 == 0) put(v, start, walk.near_point(start), walk.far_point(once.previous(following)), following);
        else put(v, following, start, walk.near_point(start), walk.far_point(once.previous(following)));
    };
    quarters.assign(4 * static_cast<std::size_t>(once.vertex_count), -1);
    parallel_for_each(once.vertex_count, put_vertex);
}

/// The squares beyond the sharp edges at each corner of the mesh.
void add_squares_beyond(const Topology& topology, const DooSabinLayout& layout, std::vector<Index>& squares) {
    if (layout.kept_begin == topology.half_edge_count()) return;  // no sharp edges
    squares.assign(3 * static_cast<std::size_t>(topology.half_edge_count()), -1);
    for (Index h = 0; h < topology.half_edge_count(); ++h) {
        if (layout.first_point[topology.half_edge_edge[h]] < 0) continue;
        squares[3 * static_cast<std::size_t>(h)] = layout.point(topology, h);
        squares[3 * static_cast<std::size_t>(topology.next(h)) + 1] = layout.point(topology, h) + 1;
    }
    for (const auto& sector : layout.sectors)
        if (sector.kept >= 0) squares[3 * static_cast<std::size_t>(sector.first) + 2] = sector.kept;
}

/// The vertex of the once refined mesh whose square lies beyond edges at an old corner, or the corner's own; -1 where there is none.
Index square_at(const PatchTable& table, Index corner, Square square) {
    if (square == Square::corner) return corner;
    return table.square_beyond(corner, static_cast<int>(square) - 1);
}

Square square_of(double u, double v) { return u < 0 ? v < 0 ? Square::kept : Square::beyond_previous : v < 0 ? Square::beyond_next : Square::corner; }

bool corner_exists(const PatchTable& table, const Places& places, std::size_t i) {
    const Index face = places.faces[i], corner = places.corner(i);
    return face >= 0 && face < table.face_count() && corner >= 0 && corner < table.degree(face);
}

[[noreturn]] void refuse(const PatchTable& table, const Places& places, std::size_t i) {
    check_face(table, places, i);
    check_corner(table, places, i);
    const Index at = table.face_begin[places.faces[i]] + places.corner(i);
    const auto range = [&](Square square) { return square_at(table, at, square) < 0 ? "from 0 to 1" : "from -1 to 1"; };
    throw BadInput(place_name(i) + "(u, v) = (" + std::to_string(places.uv[2 * i]) + ", " + std::to_string(places.uv[2 * i + 1]) + ") is not at " +
                       corner_name(places, i) + ": u runs " + range(Square::beyond_previous) + ", v " + range(Square::beyond_next) + ", both together " +
                       (square_at(table, at, Square::kept) < 0 ? "do not go below 0" : "from -1 to 0 too"),
                   Where{{}, {places.faces[i]}});
}

}  // namespace

void add_doo_sabin_patches(const Topology& topology, const Features& features, const SchemeOptions& options, PatchTable& table) {
    const DooSabinLayout first_layout = lay_out_doo_sabin(topology, features);
    check_corners(first_layout);
    table.refiner = std::make_shared<Refiner>(topology, features, options, 2);
    const Topology& once = table.refiner->steps().back().topology;
    check_control_count(8 * static_cast<std::int64_t>(once.half_edge_count()));  // no patch has fewer
    const DooSabinLayout second_layout = lay_out_doo_sabin(once, table.refiner->steps().back().features);
    table.face_begin.assign(topology.face_offsets.begin(), topology.face_offsets.end());
    table.turns.assign(std::begin(turns), std::end(turns));
    PatchBuilder(once, second_layout, first_layout.kept_begin, options.mask, table).build();
    add_quarters(once, DooSabinWalk(once, second_layout, first_layout.kept_begin), topology.half_edge_count(), first_layout.kept_begin, table.patch_of_quarter);
    add_squares_beyond(topology, first_layout, table.squares_beyond);
}

void locate_doo_sabin(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out) {
    for (std::size_t i = begin; i < end; ++i) {
        const double u = places.uv[2 * i], v = places.uv[2 * i + 1];
        if (!corner_exists(table, places, i) || !(u >= -1 && u <= 1 && v >= -1 && v <= 1)) refuse(table, places, i);
        const Square square = square_of(u, v);
        const Index vertex = square_at(table, table.face_begin[places.faces[i]] + places.corner(i), square);
        if (vertex < 0) refuse(table, places, i);
        // In its quarter: from the side towards (0, 0) and, what is exact next to an extraordinary face, from the other one.
        const double x = 2 * (u < 0 ? u + 1 : u), y = 2 * (v < 0 ? v + 1 : v);
        const bool right = x >= 1, upper = y >= 1;
        const int quarter = right ? (upper ? 0 : 1) : (upper ? 3 : 2);
        const double from_left = right ? x - 1 : x, from_below = upper ? y - 1 : y, from_right = right ? 2 - x : 1 - x, from_above = upper ? 2 - y : 1 - y;
        const std::int32_t turn = quarter_turns[static_cast<std::size_t>(square)][quarter];
        const double s[4] = {from_left, from_below, from_right, from_above}, t[4] = {from_below, from_right, from_above, from_left};
        *out++ = {s[turn], t[turn], table.patch_of_quarter[4 * static_cast<std::size_t>(vertex) + quarter], turn};
    }
}

}  // namespace lcl
