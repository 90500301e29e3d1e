// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/charts.h"

#include <algorithm>

namespace lcl {
namespace {

constexpr int most_borders = 64;  // crossed in one move: round an extraordinary vertex of high valence a step may go round and round

/// The quarter of a quad at its corner: (u, v) of its (a, b).
SurfacePlace quarter(Index face, Index corner, double a, double b) {
    switch (corner) {
        case 0: return {face, 0, a / 2, b / 2, 0.5, 0, 0, 0.5};
        case 1: return {face, 0, 1 - b / 2, a / 2, 0, -0.5, 0.5, 0};
        case 2: return {face, 0, 1 - a / 2, 1 - b / 2, -0.5, 0, 0, -0.5};
        default: return {face, 0, b / 2, 1 - a / 2, 0, 0.5, -0.5, 0};
    }
}

}  // namespace

SurfacePlace Charts::surface_place(const ChartPlace& place) const {
    const Index face = topology_.half_edge_face[place.corner], corner = place.corner - topology_.face_offsets[face];
    if (table_.scheme == Scheme::catmull_clark && topology_.degree(face) == 4) return quarter(face, corner, place.a, place.b);
    return {face, corner, place.a, place.b};
}

ChartPlace Charts::chart_place(Index face, Index corner, double u, double v) const {
    const Index first = topology_.face_offsets[face];
    if (table_.scheme != Scheme::catmull_clark || topology_.degree(face) != 4) return {first + corner, u, v};
    if (v <= 0.5) return u <= 0.5 ? ChartPlace{first, 2 * u, 2 * v} : ChartPlace{first + 1, 2 * v, 2 - 2 * u};
    return u > 0.5 ? ChartPlace{first + 2, 2 - 2 * u, 2 - 2 * v} : ChartPlace{first + 3, 2 - 2 * v, 2 * u};
}

double Charts::low_a(Index corner) const { return table_.square_beyond(corner, 1) >= 0 ? -1 : 0; }
double Charts::low_b(Index corner) const { return table_.square_beyond(corner, 0) >= 0 ? -1 : 0; }

/// The corner at the same vertex whose edge to the next vertex is sharp (side 0), or the one to the previous (1), with no sharp edge on the way; there must be
/// one.
Index Charts::end_of_sector(Index corner, int side) const {
    while (table_.square_beyond(corner, side) < 0) corner = across(corner, side);
    return corner;
}

/// The corner that has the square of a kept vertex beyond its two edges, among those between the same sharp edges; -1 where the vertex is not kept.
Index Charts::kept_square(Index corner) const {
    if (table_.squares_beyond.empty()) return -1;
    for (const int side : {0, 1}) {
        Index at = corner;
        do {
            if (table_.square_beyond(at, 2) >= 0) return at;
            if (table_.square_beyond(at, side) >= 0) break;
            at = across(at, side);
        } while (at != corner);
    }
    return -1;
}

/// In the square of a kept vertex that has several faces between its sharp edges: its sides are borders to the squares beyond these edges, which are two
/// charts.
bool Charts::is_in_wide_corner(const ChartPlace& place) const {
    const Index h = place.corner;
    return place.a < 0 && place.b < 0 && table_.square_beyond(h, 2) >= 0 && (low_a(h) == 0 || low_b(h) == 0);
}

void Charts::leave_kept_square(ChartPlace& place) const {
    if (place.a < 0 || place.b < 0) place.corner = end_of_sector(place.corner, place.a < 0 ? 1 : 0);
}

/// From a place with a, b < 0. The squares beyond the two sharp edges at a vertex meet there, however many faces are between these, or that of a kept vertex is
/// between them. False where none of this is so.
bool Charts::step_beyond_edges(ChartPlace& place) const {
    const Index h = place.corner, kept = kept_square(h);
    if (kept >= 0 && kept != h) place.corner = kept;
    else if (kept >= 0 || low_a(h) == low_b(h)) return false;
    else if (low_a(h) == 0) place = {end_of_sector(h, 1), place.b, -place.a};
    else place = {end_of_sector(h, 0), -place.b, place.a};
    return true;
}

/// Across one border; false where the place is inside, or at a wall.
bool Charts::step_square(ChartPlace& place) const {
    const Index h = place.corner;
    const double a = place.a, b = place.b;
    if (is_in_wide_corner(place)) {
        place.a = std::max(a, -1.0);
        place.b = std::max(b, -1.0);
        return false;
    }
    if (a < 0 && b < 0 && step_beyond_edges(place)) return true;
    if (a < low_a(h)) {
        const Index neighbour = topology_.twin[topology_.previous(h)];
        if (neighbour >= 0) place = {neighbour, b, low_b(neighbour) + low_a(h) - a};
        else place.a = low_a(h);
    } else if (b < low_b(h)) {
        if (topology_.twin[h] >= 0) {
            const Index neighbour = topology_.next(topology_.twin[h]);
            place = {neighbour, low_a(neighbour) + low_b(h) - b, a};
        } else {
            place.b = low_b(h);
        }
    } else if (a > 1) {
        place = {topology_.next(h), b, 2 - a};
    } else if (b > 1) {
        place = {topology_.previous(h), 2 - b, a};
    } else {
        if (a >= 0 || b >= 0 || table_.square_beyond(h, 2) >= 0) return false;
        (a > b ? place.a : place.b) = 0;  // round a corner of the domain
    }
    return true;
}

/// Across the side at which a barycentric coordinate is most negative, as if the two triangles were a parallelogram.
bool Charts::step_triangle(ChartPlace& place) const {
    const double weights[3] = {1 - place.a - place.b, place.a, place.b};
    const int k = static_cast<int>(std::min_element(weights, weights + 3) - weights);
    if (weights[k] >= 0) return false;
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Index neighbour = topology_.twin[place.corner + i];
    double to[3];
    if (neighbour < 0) {
        const double sum = std::max(weights[i], 0.0) + std::max(weights[j], 0.0);
        to[k] = 0;
        to[i] = std::max(weights[i], 0.0) / sum;
        to[j] = 1 - to[i];
    } else {
        // The half-edge runs from i to j, its twin from j to i: weights (i + k) and (j + k) on these, -k on the vertex across.
        const Index face = topology_.half_edge_face[neighbour], first = topology_.face_offsets[face];
        const int at = static_cast<int>(neighbour - first);
        to[at] = weights[j] + weights[k];
        to[(at + 1) % 3] = weights[i] + weights[k];
        to[(at + 2) % 3] = -weights[k];
        place.corner = first;
    }
    place.a = to[1];
    place.b = to[2];
    return true;
}

ChartPlace Charts::move(ChartPlace place, double da, double db) const {
    const bool was_in_wide_corner = !are_triangles() && is_in_wide_corner(place);
    place.a += da;
    place.b += db;
    if (was_in_wide_corner) leave_kept_square(place);
    for (int border = 0; border < most_borders; ++border)
        if (!(are_triangles() ? step_triangle(place) : step_square(place))) return place;
    place.a = std::clamp(place.a, 0.0, 1.0);
    place.b = std::clamp(place.b, 0.0, are_triangles() ? 1 - place.a : 1.0);
    return place;
}

std::array<bool, 3> Charts::walls(const ChartPlace& place) const {
    const Index h = place.corner;
    if (are_triangles())
        return {place.a <= 0 && topology_.twin[h + 2] < 0, place.b <= 0 && topology_.twin[h] < 0, place.a + place.b >= 1 && topology_.twin[h + 1] < 0};
    if (is_in_wide_corner(place)) return {place.a <= -1, place.b <= -1, false};
    return {place.a <= low_a(h) && topology_.twin[topology_.previous(h)] < 0, place.b <= low_b(h) && topology_.twin[h] < 0, false};
}

}  // namespace lcl
