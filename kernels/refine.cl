// SPDX-License-Identifier: BSD-3-Clause
// Values of a refined mesh from those of the mesh before, y = R x, gathered row by row from its half-edges. Rows of smooth vertices and edges follow from the topology:
//     Catmull-Clark (mesh expansion paper, appendix A), face points f first:    F = mean of the corners,    E = (V_a + V_b + f_left + f_right)/4,
//                                                                              V = (n - 2 + alpha)/n V + (1 - alpha)/n^2 sum E_j + 1/n^2 sum f_j;
//     Loop (Loop PIA paper):    E = 3/8 (V_a + V_b) + 1/8 (across),    V = (1 - n beta_n) V + beta_n sum E_j;
// all others have stored weights (lcl_refine_rows) and are put in afterwards: sharp edges, curve vertices, corners; all rows of Doo-Sabin and of the two-phase step.
// One work-item owns `chunk` consecutive rows of y, which nobody else writes in that launch; results do not depend on scheduling. Float sums lose about 1e-7 of the field's size a level.
//
// LCL_DEGREE    corners of every face: 4 (default) or 3; 0 where they differ
#include "types.cl.h"

#ifndef LCL_DEGREE
#define LCL_DEGREE 4
#endif

/// The mesh before: half-edge h runs from face_vertices[h] to the next corner of its face. face_offsets (faces + 1) and half_edge_face are read where LCL_DEGREE is 0 alone. twin: -1 at a boundary.
#define LCL_HALF_EDGES const __global int *restrict face_offsets, const __global int *restrict half_edge_face, const __global int *restrict face_vertices

#if LCL_DEGREE == 4
#define LCL_FACE(h) ((h) >> 2)
#define LCL_NEXT(h) (((h) & ~3) | (((h) + 1) & 3))
#define LCL_PREVIOUS(h) (((h) & ~3) | (((h) + 3) & 3))
#elif LCL_DEGREE == 3
#define LCL_FACE(h) ((h) / 3)
#define LCL_NEXT(h) ((h) % 3 == 2 ? (h) - 2 : (h) + 1)
#define LCL_PREVIOUS(h) ((h) % 3 == 0 ? (h) + 2 : (h) - 1)
#else
#define LCL_FACE(h) half_edge_face[h]
#define LCL_NEXT(h) ((h) + 1 < face_offsets[half_edge_face[h] + 1] ? (h) + 1 : face_offsets[half_edge_face[h]])
#endif

#define LCL_FOR_EACH_OWN(i, count)                                                                                  \
    const int own_begin = (int)min((ulong)(count), (ulong)get_global_id(0) * (ulong)chunk);                         \
    const int own_end = (int)min((ulong)(count), ((ulong)get_global_id(0) + 1) * (ulong)chunk);                     \
    for (int i = own_begin; i < own_end; ++i)

/// count: faces. first: row of y of the first face point. degree_weights: [d]: 1/d. x, read: old vertices x LCL_WIDTH. y: face points written.
__kernel void lcl_refine_faces(const int count, const int chunk, const int first, LCL_HALF_EDGES, const __global weight *restrict degree_weights, const __global realn *restrict x,
                               __global realn *restrict y) {
    LCL_FOR_EACH_OWN(f, count) {
#if LCL_DEGREE == 4
        const int4 corners = vload4(f, face_vertices);
        const realn sum = lcl_add(lcl_add(x[corners.x], x[corners.y]), lcl_add(x[corners.z], x[corners.w]));
        const int degree = 4;
#else
#if LCL_DEGREE == 0
        const int begin = face_offsets[f], degree = face_offsets[f + 1] - begin;
#else
        const int begin = LCL_DEGREE * f, degree = LCL_DEGREE;
#endif
        realn sum = x[face_vertices[begin]];
        for (int k = 1; k < degree; ++k) sum = lcl_add(sum, x[face_vertices[begin + k]]);
#endif
        y[first + f] = lcl_scale(degree_weights[degree], sum);
    }
}

/// count: edges. first, first_face: rows of y of the first edge point and the first face point. twin, edge_half_edge: of the mesh before. edge_weights: 1/4. x, read. y: face points read, edge
/// points written but those of boundary edges.
__kernel void lcl_refine_edges(const int count, const int chunk, const int first, const int first_face, LCL_HALF_EDGES, const __global int *restrict twin,
                               const __global int *restrict edge_half_edge, const __global weight *restrict edge_weights, const __global realn *restrict x, __global realn *y) {
    const weight quarter = edge_weights[0];
    const __global realn *face_points = y + first_face;
    LCL_FOR_EACH_OWN(e, count) {
        const int h = edge_half_edge[e], t = twin[h];
        if (t < 0) continue;
        const realn ends = lcl_add(x[face_vertices[h]], x[face_vertices[t]]);
        y[first + e] = lcl_scale(quarter, lcl_add(ends, lcl_add(face_points[LCL_FACE(h)], face_points[LCL_FACE(t)])));
    }
}

/// count: old vertices. first_face: row of y of the first face point. fan_offsets (count + 1), fan_half_edges: the half-edges that leave each vertex. valence_weights: 3 a valence n, of V, the
/// E_j and the f_j. x, read. y: face points read, vertex points written but those of isolated vertices.
__kernel void lcl_refine_vertices(const int count, const int chunk, const int first_face, LCL_HALF_EDGES, const __global int *restrict fan_offsets, const __global int *restrict fan_half_edges,
                                  const __global weight *restrict valence_weights, const __global realn *restrict x, __global realn *y) {
    const __global realn *face_points = y + first_face;
    LCL_FOR_EACH_OWN(v, count) {
        const int begin = fan_offsets[v], end = fan_offsets[v + 1];
        if (begin == end) continue;
        realn ends = lcl_zero(), faces = lcl_zero();
        for (int i = begin; i < end; ++i) {
            const int h = fan_half_edges[i];
            ends = lcl_add(ends, x[face_vertices[LCL_NEXT(h)]]);
            faces = lcl_add(faces, face_points[LCL_FACE(h)]);
        }
        const __global weight *weights = valence_weights + 3 * (end - begin);
        y[v] = lcl_add(lcl_scale(weights[0], x[v]), lcl_add(lcl_scale(weights[1], ends), lcl_scale(weights[2], faces)));
    }
}

#if LCL_DEGREE == 3

/// As lcl_refine_edges. edge_weights: 3/8, 1/8.
__kernel void lcl_refine_loop_edges(const int count, const int chunk, const int first, LCL_HALF_EDGES, const __global int *restrict twin, const __global int *restrict edge_half_edge,
                                    const __global weight *restrict edge_weights, const __global realn *restrict x, __global realn *restrict y) {
    const weight end_weight = edge_weights[0], across_weight = edge_weights[1];
    LCL_FOR_EACH_OWN(e, count) {
        const int h = edge_half_edge[e], t = twin[h];
        if (t < 0) continue;
        const realn ends = lcl_add(x[face_vertices[h]], x[face_vertices[t]]);
        const realn across = lcl_add(x[face_vertices[LCL_PREVIOUS(h)]], x[face_vertices[LCL_PREVIOUS(t)]]);
        y[first + e] = lcl_add(lcl_scale(end_weight, ends), lcl_scale(across_weight, across));
    }
}

/// As lcl_refine_vertices. valence_weights: 3 a valence, of V, the E_j and 0.
__kernel void lcl_refine_loop_vertices(const int count, const int chunk, LCL_HALF_EDGES, const __global int *restrict fan_offsets, const __global int *restrict fan_half_edges,
                                       const __global weight *restrict valence_weights, const __global realn *restrict x, __global realn *restrict y) {
    LCL_FOR_EACH_OWN(v, count) {
        const int begin = fan_offsets[v], end = fan_offsets[v + 1];
        if (begin == end) continue;
        realn ends = lcl_zero();
        for (int i = begin; i < end; ++i) ends = lcl_add(ends, x[face_vertices[LCL_NEXT(fan_half_edges[i])]]);
        const __global weight *weights = valence_weights + 3 * (end - begin);
        y[v] = lcl_add(lcl_scale(weights[0], x[v]), lcl_scale(weights[1], ends));
    }
}

#endif

/// count: rows with stored weights. old_count: old vertices. targets: count: the row of y. offsets (count + 1), indices, weights: the entries; indices from old_count on are rows of `sums`, read, the
/// others of x. y: the targets written.
__kernel void lcl_refine_rows(const int count, const int chunk, const int old_count, const __global int *restrict targets, const __global uint *restrict offsets, const __global int *restrict indices,
                              const __global weight *restrict weights, const __global realn *restrict x, const __global realn *restrict sums, __global realn *restrict y) {
    LCL_FOR_EACH_OWN(i, count) {
        realn sum = lcl_zero();
        const uint end = offsets[i + 1];
        for (uint k = offsets[i]; k < end; ++k) {
            const int column = indices[k];
            sum = lcl_add(sum, lcl_scale(weights[k], column < old_count ? x[column] : sums[column - old_count]));
        }
        y[targets[i]] = sum;
    }
}
