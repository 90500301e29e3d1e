// SPDX-License-Identifier: BSD-3-Clause
// One patch for each triangle after one explicit refinement: 4f + k begins at corner k of face f, 4f + 3 is the middle one. Only the old vertex where a patch
// begins can be irregular; the points of edges have six triangles round them, or three on each side of a sharp edge.
#include <cmath>
#include <map>
#include <string>

#include "host/evaluate/loop_walk.h"
#include "host/evaluate/patch_table.h"
#include "host/parallel.h"
#include "host/refine/steps.h"

namespace lcl {
namespace {

constexpr double tolerance = 1e-12;  // of barycentric weights, which need not sum up to 1 exactly

/// Of the child at each corner, then of the middle one: (s, t) = (2u, 2v), (2v, 2w), (2w, 2u) with w = 1 - u - v, and (2u + 2v - 1, 1 - 2u).
constexpr ParameterTurn child_turns[4] = {{2, 0, 0, 2}, {0, -2, 2, -2}, {-2, 2, -2, 0}, {2, -2, 2, 0}};

class PatchBuilder {
public:
    PatchBuilder(const Topology& topology, const Features& features, PatchTable& table)
        : walk_(topology, features), table_(table), places_(4 * static_cast<std::size_t>(topology.face_count)) {}

    void build() {
        table_.ghosts = walk_.ghosts();
        for_each_patch([&](Index patch) { places_[patch] = walk_.place(3 * patch); });
        number();
        for_each_patch([&](Index patch) { walk_.points(3 * patch, places_[patch], table_.control.data() + table_.patch_begin[patch]); });
    }

private:
    template <class Body>
    void for_each_patch(const Body& body) const {
        parallel_for_each(static_cast<Index>(places_.size()), body, smallest_parallel_piece / 8);
    }

    void number() {
        std::int64_t next = 0;
        table_.kind.assign(places_.size(), -1);
        table_.patch_begin.assign(1, 0);
        table_.patch_begin.reserve(places_.size() + 1);
        for (std::size_t patch = 0; patch < places_.size(); ++patch) {
            if (places_[patch].round != LoopRound::regular) table_.kind[patch] = kind_of(places_[patch]);
            next += places_[patch].point_count();
            check_control_count(next);
            table_.patch_begin.push_back(static_cast<Index>(next));
        }
        table_.control.resize(next);
    }

    std::int32_t kind_of(const LoopPlace& place) {
        const auto [found, is_new] = kinds_.try_emplace(place, static_cast<std::int32_t>(table_.kinds.size()));
        if (is_new) table_.kinds.push_back(loop_kind(place));
        return found->second;
    }

    LoopWalk walk_;
    PatchTable& table_;
    std::vector<LoopPlace> places_;
    std::map<LoopPlace, std::int32_t> kinds_;
};

bool exists(const PatchTable& table, const Places& places, std::size_t i) {
    const double u = places.uv[2 * i], v = places.uv[2 * i + 1];
    return places.faces[i] >= 0 && places.faces[i] < table.face_count() && places.corner(i) == 0 && u >= -tolerance && v >= -tolerance &&
           u + v <= 1 + tolerance;
}

[[noreturn]] void refuse(const PatchTable& table, const Places& places, std::size_t i) {
    check_face(table, places, i);
    const Where where{{}, {places.faces[i]}};
    if (places.corner(i) != 0)
        throw BadInput(place_name(i) + corner_name(places, i) + " does not exist: on a triangle the corner is 0 and (u, v) runs over the whole face", where);
    throw BadInput(place_name(i) + "(u, v) = (" + std::to_string(places.uv[2 * i]) + ", " + std::to_string(places.uv[2 * i + 1]) +
                       ") is not on the face: u, v and 1 - u - v must not be below 0",
                   where);
}

/// Child and (s, t) in it, within its triangle whatever rounding does.
PatchPlace place_in(Index face, double u, double v) {
    u = std::max(u, 0.0), v = std::max(v, 0.0);
    const double w = std::max(1 - std::max(u, v) - std::min(u, v), 0.0);
    if (u + v < 0.5) return {2 * u, 2 * v, 4 * face, 0};
    if (u > 0.5) return {2 * v, 2 * w, 4 * face + 1, 1};
    if (v > 0.5) return {2 * w, 2 * u, 4 * face + 2, 2};
    return {2 * (u + v) - 1, 1 - 2 * u, 4 * face + 3, 3};
}

}  // namespace

void add_loop_patches(const Topology& topology, const Features& features, const SchemeOptions& options, PatchTable& table) {
    check_control_count(24 * static_cast<std::int64_t>(topology.face_count));  // no patch has fewer than 6
    table.refiner = std::make_shared<Refiner>(topology, features, options, 1);
    table.face_begin.assign(topology.face_offsets.begin(), topology.face_offsets.end());
    table.turns.assign(std::begin(child_turns), std::end(child_turns));
    PatchBuilder(topology, features, table).build();
}

void locate_loop(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out) {
    for (std::size_t i = begin; i < end; ++i) {
        if (!exists(table, places, i)) refuse(table, places, i);
        *out++ = place_in(places.faces[i], places.uv[2 * i], places.uv[2 * i + 1]);
    }
}

}  // namespace lcl
