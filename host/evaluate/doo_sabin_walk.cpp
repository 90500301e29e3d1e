// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/doo_sabin_walk.h"

#include <utility>

#include "host/evaluate/kind_rows.h"

namespace lcl {
namespace {

Index& at(DooSabinWalk::Nine& nine, int i, int j) { return nine[3 * (j + 1) + i + 1]; }

/// Two rows, from the left, with the lower one once more below them.
DooSabinWalk::Nine doubled(const std::array<Index, 3>& curve, const std::array<Index, 3>& inner) {
    return {curve[0], curve[1], curve[2], curve[0], curve[1], curve[2], inner[0], inner[1], inner[2]};
}

}  // namespace

/// The point (-1, -1): beyond the old vertex.
Index DooSabinWalk::diagonal(Index h) const {
    const Index below = topology_.twin[h], left = topology_.rotate(h);
    if (below >= 0 && left >= 0) return topology_.rotate(left);
    if (left >= 0) return far_point(topology_.previous(left));
    if (below >= 0) return near_point(topology_.next(below));
    return kept(topology_.origin(h));
}

DooSabinWalk::Nine DooSabinWalk::of_corner(Index h, int quarters) const {
    const Index next = topology_.next(h), previous = topology_.previous(h), below = topology_.twin[h], left = topology_.twin[previous];
    Nine natural, turned;
    at(natural, 0, 0) = h;
    at(natural, 1, 0) = next;
    at(natural, 1, 1) = topology_.next(next);
    at(natural, 0, 1) = previous;
    at(natural, 0, -1) = below < 0 ? near_point(h) : topology_.next(below);
    at(natural, 1, -1) = below < 0 ? far_point(h) : below;
    at(natural, -1, 0) = left < 0 ? far_point(previous) : left;
    at(natural, -1, 1) = left < 0 ? near_point(previous) : topology_.next(left);
    at(natural, -1, -1) = diagonal(h);
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            int x = i, y = j;
            for (int turn = 0; turn < quarters; ++turn) x = -std::exchange(y, x);
            at(turned, x, y) = at(natural, i, j);
        }
    }
    return turned;
}

void DooSabinWalk::of_irregular_corner(Index h, Index n, Index* out) const {
    for (Index i = 0, corner = h; i < n; ++i, corner = topology_.next(corner)) *out++ = corner;
    Nine nine = of_corner(h, 2);
    for (const auto& [i, j] : {std::pair{1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}}) *out++ = at(nine, i, j);
}

DooSabinWalk::Nine DooSabinWalk::of_near_point(Index h) const {
    const Index left = topology_.rotate(h), next = topology_.next(h);
    if (left < 0) return doubled({kept(topology_.origin(h)), near_point(h), far_point(h)}, {far_point(topology_.previous(h)), h, next});
    return doubled({far_point(topology_.previous(left)), near_point(h), far_point(h)}, {left, h, next});
}

DooSabinWalk::Nine DooSabinWalk::of_far_point(Index h) const {
    const Index next = topology_.next(h), twin = topology_.twin[next];
    if (twin < 0) return doubled({near_point(h), far_point(h), kept(topology_.origin(next))}, {h, next, near_point(next)});
    const Index right = topology_.next(twin);
    return doubled({near_point(h), far_point(h), near_point(right)}, {h, next, right});
}

DooSabinWalk::Nine DooSabinWalk::of_kept(Index h) const {
    const Index corner = kept(topology_.origin(h)), beside = far_point(topology_.previous(h));
    return doubled({corner, corner, near_point(h)}, {beside, beside, h});
}

PatchKind doo_sabin_kind(int n, DooSabinMask mask) {
    // f_0 .. f_(n-1), then the outer points; the face, and the three quads round the patch's own f_0: below its s-side, across, and at its t-side.
    LocalMesh local(n + 5);
    std::vector<Index> face(n);
    for (Index i = 0; i < n; ++i) face[i] = i;
    local.add(face);
    local.add({n - 1, n, n + 1, 0});
    local.add({0, n + 1, n + 2, n + 3});
    local.add({1, 0, n + 3, n + 4});
    const Topology topology = build_topology(local.mesh());
    const Features features = find_features(local.mesh(), topology, {});
    SchemeOptions options;
    options.scheme = Scheme::doo_sabin;
    options.mask = mask;
    const Stencils stencils = refine_once(local.mesh(), topology, features, options).stencils;
    const DooSabinLayout layout = lay_out_doo_sabin(topology, features);
    const DooSabinWalk walk(topology, layout, 0);
    PatchKind kind;
    kind.point_count = n + 5;
    std::vector<Index> child(n + 5);
    walk.of_irregular_corner(0, n, child.data());
    kind.step = dense_rows(stencils, child, n + 5);
    const std::array<std::pair<Index, int>, 3> corners{
        {{n + 3, 3}, {n + 4, 0}, {n + 9, 1}}};  // f_0's in the three quads, which are turned this way to lie upright
    for (std::size_t k = 0; k < 3; ++k) {
        const DooSabinWalk::Nine nine = walk.of_corner(corners[k].first, corners[k].second);
        kind.cells[k] = dense_rows(stencils, {nine.begin(), nine.end()}, n + 5);
    }
    kind.orbits = {{0, n, 0.5}};
    return kind;
}

}  // namespace lcl
