/* SPDX-License-Identifier: BSD-3-Clause */
/* Uses the installed library from C99. */
#include <limitcl/limitcl.h>
#include <math.h>
#include <stdio.h>

#include "octahedron.h"

static int failed(const char* doing)
{
    fprintf(stderr, "%s: %s\n", doing, lcl_last_error());
    return 1;
}

int main(void)
{
    lcl_context context = NULL;
    lcl_mesh mesh = NULL;
    lcl_operator A = NULL;
    double P[18];
    double largest = 0;
    int i;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    data.vertex_count = 6;
    data.face_count = 8;
    data.uniform_degree = 3;
    data.face_vertices = octahedron_faces;
    data.points = octahedron_points;
    if (lcl_context_create(NULL, &context) != LCL_OK) return failed("lcl_context_create");
    if (lcl_mesh_create(&data, &mesh) != LCL_OK) return failed("lcl_mesh_create");
    if (lcl_operator_create(context, mesh, NULL, &A) != LCL_OK) return failed("lcl_operator_create");
    if (lcl_interpolate(A, octahedron_points, 0, 3, NULL, P, 0, NULL) != LCL_OK) return failed("lcl_interpolate");
    for (i = 0; i < 18; i++) largest = fmax(largest, fabs(P[i] - octahedron_control_scale * octahedron_points[i]));
    lcl_operator_release(A);
    lcl_mesh_release(mesh);
    lcl_context_release(context);
    printf("limitcl %s from C: control points right to %g\n", lcl_version_string(), largest);
    return largest <= octahedron_tolerance ? 0 : 1;
}
