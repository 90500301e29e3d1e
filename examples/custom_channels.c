/* SPDX-License-Identifier: BSD-3-Clause */
/* C99: seven channels a vertex: x, y, z, a temperature and a colour. All are interpolated together: the limit surface meets the positions, and the values that
   the scheme spreads over it meet temperature and colour at every vertex. */
#include <limitcl/limitcl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { VERTICES = 6, FACES = 8, CHANNELS = 7, STRIDE = 8 }; /* rows may be longer than the channels: here one value is unused */

static const int32_t faces[3 * FACES] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

/* An octahedron.                                x     y     z   kelvin  red green blue unused */
static const double M[STRIDE * VERTICES] = {1.0, 0.0, 0.0, 290.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0,  0.0,  310.0, 0.0, 1.0, 0.0, 0.0,
                                            0.0, 1.0, 0.0, 300.0, 0.0, 0.0, 1.0, 0.0, 0.0,  -1.0, 0.0,  295.0, 1.0, 1.0, 0.0, 0.0,
                                            0.0, 0.0, 1.0, 350.0, 0.0, 1.0, 1.0, 0.0, 0.0,  0.0,  -1.0, 280.0, 1.0, 0.0, 1.0, 0.0};

static void check(lcl_status status) {
    if (status == LCL_OK) return;
    fprintf(stderr, "%s: %s\n", lcl_status_string(status), lcl_last_error());
    exit(1);
}

int main(void) {
    static double P[STRIDE * VERTICES], limit[STRIDE * VERTICES];
    lcl_context context = NULL;
    lcl_mesh mesh = NULL;
    lcl_operator A = NULL;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    data.vertex_count = VERTICES;
    data.face_count = FACES;
    data.uniform_degree = 3;
    data.face_vertices = faces;
    data.points = M; /* the positions are the first three of each row */
    data.point_stride = STRIDE;

    check(lcl_context_create(NULL, &context));
    check(lcl_mesh_create(&data, &mesh));
    check(lcl_operator_create(context, mesh, NULL, &A)); /* triangles: Loop */
    check(lcl_interpolate(A, M, STRIDE, CHANNELS, NULL, P, STRIDE, &report));
    printf("%d iterations; positions to %.1e, the other channels to %.1e of their ranges\n", report.iterations, report.max_error, report.channel_error);

    check(lcl_limit_points(A, P, STRIDE, CHANNELS, LCL_PRECISION_MIXED, limit, STRIDE));
    int wrong = 0;
    for (int v = 0; v < VERTICES; ++v) {
        const double* at = &limit[STRIDE * v];
        printf("vertex %d: (%6.3f %6.3f %6.3f)  %.2f K  control value %.2f K\n", v, at[0], at[1], at[2], at[3], P[STRIDE * v + 3]);
        for (int c = 0; c < CHANNELS; ++c) {
            const double range = c < 3 ? 3.5 : c == 3 ? 70.0 : 1.0; /* the diagonal, the span of the temperature, that of a colour */
            wrong += !(fabs(at[c] - M[STRIDE * v + c]) <= 5e-6 * range);
        }
    }

    lcl_operator_release(A);
    lcl_mesh_release(mesh);
    lcl_context_release(context);
    return wrong == 0 ? 0 : 1;
}
