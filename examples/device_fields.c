/* SPDX-License-Identifier: BSD-3-Clause */
/* C99: an animation. The points stay on the device, PIA runs sweep by sweep (P += M - A P), and every frame starts where the last one ended. */
#include <limitcl/limitcl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { RING = 16, TUBE = 8, VERTICES = RING * TUBE, FRAMES = 6, MOST_SWEEPS = 200 };

#define TARGET 1e-5 /* model units; the torus is 8 wide, and a float holds 8 to 5e-7 */

static float points[3 * VERTICES];
static int32_t faces[4 * VERTICES];

static void check(lcl_status status) {
    if (status == LCL_OK) return;
    fprintf(stderr, "%s: %s\n", lcl_status_string(status), lcl_last_error());
    exit(1);
}

static void make_frame(double time) {
    for (int i = 0; i < RING; ++i)
        for (int j = 0; j < TUBE; ++j) {
            const double u = 6.283185307179586 * i / RING, w = 6.283185307179586 * j / TUBE, r = 1.0 + 0.2 * sin(5.0 * u + time);
            float* p = &points[3 * (i * TUBE + j)];
            p[0] = (float)((3.0 + r * cos(w)) * cos(u));
            p[1] = (float)((3.0 + r * cos(w)) * sin(u));
            p[2] = (float)(r * sin(w));
        }
}

static lcl_operator make_operator(lcl_context context) {
    lcl_mesh mesh = NULL;
    lcl_operator A = NULL;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    for (int v = 0; v < VERTICES; ++v) {
        const int i = v / TUBE, j = v % TUBE, next_i = (i + 1) % RING, next_j = (j + 1) % TUBE;
        faces[4 * v] = v;
        faces[4 * v + 1] = next_i * TUBE + j;
        faces[4 * v + 2] = next_i * TUBE + next_j;
        faces[4 * v + 3] = i * TUBE + next_j;
    }
    data.vertex_count = data.face_count = VERTICES;
    data.uniform_degree = 4;
    data.face_vertices = faces;
    data.points = points;
    data.point_type = LCL_TYPE_FLOAT;
    check(lcl_mesh_create(&data, &mesh));
    check(lcl_operator_create(context, mesh, NULL, &A)); /* one operator serves all frames: it depends on the faces alone */
    lcl_mesh_release(mesh);
    return A;
}

int main(void) {
    lcl_context context = NULL;
    lcl_field M = NULL, P = NULL, next = NULL;
    int first_sweeps = 0, sweeps = 0;
    double residual = 0.0;

    make_frame(0.0);
    check(lcl_context_create(NULL, &context));
    lcl_operator A = make_operator(context);
    check(lcl_field_create(A, 3, LCL_PRECISION_SINGLE, &M));
    check(lcl_field_create(A, 3, LCL_PRECISION_SINGLE, &P));
    check(lcl_field_create(A, 3, LCL_PRECISION_SINGLE, &next));

    for (int frame = 0; frame < FRAMES; ++frame) {
        make_frame(0.02 * frame);
        check(lcl_field_upload(M, points, LCL_TYPE_FLOAT, 0));
        if (frame == 0) { /* P_0 = M, in the units that M's first upload has set */
            check(lcl_field_match(P, M));
            check(lcl_field_match(next, M));
            check(lcl_field_upload(P, points, LCL_TYPE_FLOAT, 0));
        }
        for (sweeps = 0, residual = 1.0; sweeps < MOST_SWEEPS && residual > TARGET; ++sweeps) {
            check(lcl_operator_step(A, 1.0, 1.0, 0.0, M, P, NULL, next, 0, -1, &residual));
            lcl_field swap = P;
            P = next;
            next = swap;
        }
        if (frame == 0) first_sweeps = sweeps;
        printf("frame %d: %d sweeps, residual before the last %.1e\n", frame, sweeps, residual);
    }
    check(lcl_field_download(P, points, LCL_TYPE_FLOAT, 0));

    lcl_field_release(next);
    lcl_field_release(P);
    lcl_field_release(M);
    lcl_operator_release(A);
    lcl_context_release(context);
    return residual <= TARGET && sweeps < first_sweeps ? 0 : 1;
}
