/* SPDX-License-Identifier: BSD-3-Clause */
/* C99: a torus of quads straight from memory, its control points, and a check that the limit surface passes through every vertex. No file is used. */
#include <limitcl/limitcl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { RING = 24, TUBE = 12, VERTICES = RING * TUBE };

static double M[3 * VERTICES], P[3 * VERTICES], limit[3 * VERTICES];
static int32_t faces[4 * VERTICES];

static void check(lcl_status status) {
    if (status == LCL_OK) return;
    fprintf(stderr, "%s: %s\n", lcl_status_string(status), lcl_last_error());
    exit(1);
}

static void make_torus(void) {
    for (int i = 0; i < RING; ++i)
        for (int j = 0; j < TUBE; ++j) {
            const int v = i * TUBE + j, next_i = (i + 1) % RING, next_j = (j + 1) % TUBE;
            const double u = 6.283185307179586 * i / RING, w = 6.283185307179586 * j / TUBE;
            M[3 * v] = (3.0 + cos(w)) * cos(u);
            M[3 * v + 1] = (3.0 + cos(w)) * sin(u);
            M[3 * v + 2] = sin(w);
            faces[4 * v] = v;
            faces[4 * v + 1] = next_i * TUBE + j;
            faces[4 * v + 2] = next_i * TUBE + next_j;
            faces[4 * v + 3] = i * TUBE + next_j;
        }
}

int main(void) {
    lcl_context context = NULL;
    lcl_mesh mesh = NULL;
    lcl_operator A = NULL;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;

    make_torus();
    data.vertex_count = VERTICES;
    data.face_count = VERTICES;
    data.uniform_degree = 4;
    data.face_vertices = faces;
    data.points = M;

    check(lcl_context_create(NULL, &context));
    check(lcl_mesh_create(&data, &mesh));
    check(lcl_operator_create(context, mesh, NULL, &A)); /* quads: Catmull-Clark */
    check(lcl_interpolate(A, M, 0, 3, NULL, P, 0, &report));
    printf("%d vertices, %d iterations, max_error %.2e\n", VERTICES, report.iterations, report.max_error);

    /* The limit points of P are M again. 1e-6 of the diagonal is the default tolerance; the torus measures 8 x 8 x 2. */
    double largest = 0.0;
    check(lcl_limit_points(A, P, 0, 3, LCL_PRECISION_MIXED, limit, 0));
    for (int i = 0; i < 3 * VERTICES; ++i) largest = fmax(largest, fabs(limit[i] - M[i]));
    printf("the limit surface of P passes within %.2e of every vertex of M\n", largest);

    lcl_operator_release(A);
    lcl_mesh_release(mesh);
    lcl_context_release(context);
    return largest <= 4e-5 ? 0 : 1; /* the tolerance, and what one pass in floats adds */
}
