// SPDX-License-Identifier: BSD-3-Clause
// The butterfly scheme (Dyn, Levin, Gregory 1990) with its usual tension w = 1/16, for comparison: old vertices stay, and the new vertex of an edge ab is
//
//     w2     c     w1        (a + b)/2 + 2w (c + d) - w (w1 + w2 + w3 + w4)
//          /   \             c, d: the third vertices of the two triangles at the edge,
//        a ----- b           w1 .. w4: those of the triangles beyond their other sides.
//          \   /
//     w3     d     w4
//
// The rule is meant for vertices with six edges; others get it as it is, and there the surface has no tangent plane in general.
#ifndef LIMITCL_EXAMPLES_BUTTERFLY_HPP
#define LIMITCL_EXAMPLES_BUTTERFLY_HPP

#include <limitcl/limitcl.hpp>

#include <map>

/// One step on a closed mesh of triangles: every triangle becomes four, and the old vertices keep their numbers and places.
inline limitcl::Mesh butterfly_step(const limitcl::Mesh& mesh) {
    using Edge = std::pair<std::int32_t, std::int32_t>;
    const std::vector<std::int32_t> faces = mesh.face_vertices();
    std::vector<double> points = mesh.points();

    std::map<Edge, std::int32_t> third;  // third vertex of the triangle to the left of an edge with a direction
    for (std::size_t f = 0; f < faces.size(); f += 3)
        for (std::size_t i = 0; i < 3; ++i) third[{faces[f + i], faces[f + (i + 1) % 3]}] = faces[f + (i + 2) % 3];

    std::map<Edge, std::int32_t> middle;  // the new vertex, in both directions
    for (const auto& [edge, c] : third) {
        const auto [a, b] = edge;
        if (a > b) continue;
        const std::int32_t d = third.at({b, a});
        const std::int32_t wings[] = {third.at({c, b}), third.at({a, c}), third.at({d, a}), third.at({b, d})};
        middle[{a, b}] = middle[{b, a}] = static_cast<std::int32_t>(points.size() / 3);
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = [&](std::int32_t vertex) { return points[3 * static_cast<std::size_t>(vertex) + k]; };
            double sum = (at(a) + at(b)) / 2 + (at(c) + at(d)) / 8;
            for (const std::int32_t wing : wings) sum -= at(wing) / 16;
            points.push_back(sum);
        }
    }

    std::vector<std::int32_t> new_faces;
    for (std::size_t f = 0; f < faces.size(); f += 3) {
        const std::int32_t a = faces[f], b = faces[f + 1], c = faces[f + 2];
        const std::int32_t ab = middle.at({a, b}), bc = middle.at({b, c}), ca = middle.at({c, a});
        new_faces.insert(new_faces.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    return limitcl::Mesh::from_uniform_faces(points, 3, new_faces);
}

#endif
