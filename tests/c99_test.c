/* SPDX-License-Identifier: BSD-3-Clause */
/* The C API from C99, as a program of its own: gcc -std=c99 -pedantic. Returns the number of facts that did not hold. */
#include <limitcl/limitcl.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

static void expect(int holds, const char* fact) {
    if (holds) return;
    ++failures;
    fprintf(stderr, "does not hold: %s (last error: %s)\n", fact, lcl_last_error());
}

static const double octahedron_points[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
static const int32_t octahedron_faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
static const double cube_points[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
static const int32_t cube_faces[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};

static lcl_mesh make_mesh(int32_t vertices, const double* points, int32_t degree, int32_t face_count, const int32_t* faces) {
    lcl_mesh mesh = NULL;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    data.vertex_count = vertices;
    data.face_count = face_count;
    data.uniform_degree = degree;
    data.face_vertices = faces;
    data.points = points;
    expect(lcl_mesh_create(&data, &mesh) == LCL_OK, "a mesh can be made from arrays");
    return mesh;
}

static void test_version(void) {
    expect(lcl_version() == LCL_VERSION_MAJOR * 10000 + LCL_VERSION_MINOR * 100 + LCL_VERSION_PATCH, "header and library have one version");
    expect(strcmp(lcl_version_string(), "0.1.0") == 0, "the version reads 0.1.0");
    expect(strcmp(lcl_status_string(LCL_ERROR_SINGULAR), "LCL_ERROR_SINGULAR") == 0, "a status has a name");
    expect(strcmp(lcl_status_string(-5), "CL_OUT_OF_RESOURCES") == 0, "an OpenCL error has OpenCL's name");
    expect(lcl_status_string(-123456) != NULL, "an unknown status has some name");
}

/* Loop at an octahedron: the four neighbours of a vertex add up to zero, so A scales by alpha_4 = 3 / (11 - 8 (3/8 + (3/8 + 0)^2)) = 24/55. */
static void test_octahedron(lcl_context context) {
    double P[18], limit[18], residuals[201];
    lcl_operator A = NULL;
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    lcl_mesh mesh = make_mesh(6, octahedron_points, 3, 8, octahedron_faces);
    expect(lcl_operator_create(context, mesh, NULL, &A) == LCL_OK, "triangles make an operator");
    lcl_mesh_release(mesh); /* the operator does not need it */

    options.precision = LCL_PRECISION_MIXED;
    options.tolerance = 1e-10;
    report.residuals = residuals;
    report.residual_capacity = 201;
    expect(lcl_interpolate(A, octahedron_points, 0, 3, &options, P, 0, &report) == LCL_OK && report.converged, "the octahedron is interpolated");
    expect(report.residual_count == (size_t)report.iterations + 1, "the report has a residual more than iterations");
    const double alpha_4 = 24.0 / 55.0;
    for (int i = 0; i < 18; ++i) /* |A^-1| is 1/0.155 at most (bound of the spectrum for n = 4); the diagonal is 2 sqrt 3 */
        expect(fabs(P[i] - octahedron_points[i] / alpha_4) <= 1e-10 * 3.5 / 0.15, "the control points are the vertices by 55/24");
    expect(lcl_limit_points(A, P, 0, 3, LCL_PRECISION_MIXED, limit, 0) == LCL_OK, "limit points can be computed");
    for (int i = 0; i < 18; ++i) /* floats, rows of 5 entries of size up to 55/24 */
        expect(fabs(limit[i] - octahedron_points[i]) <= 5 * 2.3 * 1.2e-7, "the limit points of the control points are the vertices");
    lcl_operator_retain(A);
    lcl_operator_release(A);
    expect(lcl_operator_vertex_count(A) == 6, "an operator that is retained lives on");
    lcl_operator_release(A);
}

static void test_singular_cube(lcl_context context) {
    double P[24];
    lcl_operator A = NULL, cured = NULL;
    lcl_scheme_options scheme = LCL_SCHEME_OPTIONS_INIT;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    lcl_mesh mesh = make_mesh(8, cube_points, 4, 6, cube_faces);
    expect(lcl_operator_create(context, mesh, NULL, &A) == LCL_OK, "a singular operator can be made");
    expect(lcl_interpolate(A, cube_points, 0, 3, NULL, P, 0, &report) == LCL_ERROR_SINGULAR, "the cube is singular at alpha 0");
    expect(report.message[0] != '\0' && !report.converged, "the report says why");
    scheme.alpha = 0.5;
    expect(lcl_operator_create(context, mesh, &scheme, &cured) == LCL_OK, "alpha can be given");
    expect(lcl_interpolate(cured, cube_points, 0, 3, NULL, P, 0, &report) == LCL_OK && report.max_error <= 1e-6 * 1.7320509, "alpha 0.5 cures the cube");
    lcl_operator_release(cured);
    lcl_operator_release(A);
    lcl_mesh_release(mesh);
}

static void test_errors(lcl_context context) {
    static const int32_t bad_index[3] = {0, 1, 905};
    int32_t vertices[10];
    lcl_mesh mesh = NULL;
    lcl_operator A = NULL;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    expect(lcl_mesh_create(NULL, &mesh) == LCL_ERROR_INVALID_ARGUMENT && mesh == NULL, "no data is refused");
    expect(lcl_mesh_create(&data, NULL) == LCL_ERROR_INVALID_ARGUMENT, "no place for the result is refused");
    expect(lcl_mesh_read("there-is-no-such-file.obj", LCL_FORMAT_BY_ENDING, &mesh) == LCL_ERROR_FILE, "a missing file is told");
    expect(strstr(lcl_last_error(), "there-is-no-such-file.obj") != NULL, "the sentence names the file");

    mesh = make_mesh(6, octahedron_points, 3, 1, bad_index);
    expect(lcl_operator_create(context, mesh, NULL, &A) == LCL_ERROR_BAD_INPUT && A == NULL, "an index out of range is refused");
    expect(strstr(lcl_last_error(), "905") != NULL, "the sentence names the index");
    expect(lcl_last_error_vertices(vertices, 10) <= 10, "at most ten vertices are kept");
    lcl_mesh_release(mesh);

    mesh = make_mesh(8, cube_points, 4, 6, cube_faces);
    lcl_scheme_options scheme = LCL_SCHEME_OPTIONS_INIT;
    scheme.scheme = LCL_SCHEME_LOOP;
    expect(lcl_operator_create(context, mesh, &scheme, &A) == LCL_ERROR_BAD_INPUT, "Loop refuses quads");
    scheme.alpha = 0.5;
    expect(lcl_operator_create(context, mesh, &scheme, &A) == LCL_ERROR_INVALID_ARGUMENT, "Loop has no alpha");
    lcl_mesh_release(mesh);
    lcl_mesh_release(NULL);
    lcl_operator_release(NULL);
    lcl_field_release(NULL);
    lcl_context_release(NULL);
}

static int32_t cancel_at_once(void* user, int32_t iteration, double residual, double target) {
    (void)iteration;
    *(int*)user += residual >= 0.0 && target > 0.0;
    return 0;
}

static void test_cancel(lcl_context context) {
    double P[18];
    int calls = 0;
    lcl_operator A = NULL;
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    lcl_mesh mesh = make_mesh(6, octahedron_points, 3, 8, octahedron_faces);
    expect(lcl_operator_create(context, mesh, NULL, &A) == LCL_OK, "triangles make an operator");
    options.solver = LCL_SOLVER_PIA;
    options.progress = cancel_at_once;
    options.progress_user = &calls;
    expect(lcl_interpolate(A, octahedron_points, 0, 3, &options, P, 0, NULL) == LCL_ERROR_CANCELLED && calls == 1, "a callback can cancel");
    lcl_operator_release(A);
    lcl_mesh_release(mesh);
}

int main(void) {
    lcl_context context = NULL;
    test_version();
    expect(lcl_context_create(NULL, &context) == LCL_OK, "the default device opens");
    if (!context) return failures;
    test_octahedron(context);
    test_singular_cube(context);
    test_errors(context);
    test_cancel(context);
    lcl_context_release(context);
    return failures;
}
