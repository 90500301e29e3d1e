/* SPDX-License-Identifier: BSD-3-Clause */
/* limitcl beside a caller's own OpenCL from C99, as a program of its own: gcc -std=c99 -pedantic. Returns the number of facts that did not hold. */
#include <limitcl/limitcl_opencl.h>

#include <math.h>
#include <stdio.h>

static int failures = 0;

static void expect(int holds, const char* fact) {
    if (holds) return;
    ++failures;
    fprintf(stderr, "does not hold: %s (last error: %s)\n", fact, lcl_last_error());
}

static const float octahedron_points[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
static const int32_t octahedron_faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

/* The first device of the first platform, as most programs take it. */
static cl_device_id first_device(void) {
    cl_platform_id platform = NULL;
    cl_device_id device = NULL;
    if (clGetPlatformIDs(1, &platform, NULL) == CL_SUCCESS) clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL);
    return device;
}

static lcl_operator make_operator(lcl_context context) {
    lcl_operator A = NULL;
    lcl_mesh mesh = NULL;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    data.vertex_count = 6;
    data.face_count = 8;
    data.uniform_degree = 3;
    data.face_vertices = octahedron_faces;
    data.points = octahedron_points;
    data.point_type = LCL_TYPE_FLOAT;
    expect(lcl_mesh_create(&data, &mesh) == LCL_OK, "a mesh can be made from floats");
    expect(lcl_operator_create(context, mesh, NULL, &A) == LCL_OK, "the caller's context makes operators");
    lcl_mesh_release(mesh);
    return A;
}

/* M comes from a buffer of the caller, P goes back to it; nothing but the events orders the caller's reading. */
static void test_interpolation(lcl_operator A, cl_context opencl, cl_command_queue other_queue) {
    const double alpha_4 = 24.0 / 55.0; /* A of an octahedron is this times the identity */
    float P[18] = {0};
    lcl_field M_field = NULL, P_field = NULL;
    cl_event done = NULL;
    cl_int code = CL_SUCCESS;
    cl_mem memory = clCreateBuffer(opencl, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, sizeof octahedron_points, (void*)octahedron_points, &code);
    expect(code == CL_SUCCESS, "the caller has a buffer");
    expect(lcl_field_create(A, 3, LCL_PRECISION_MIXED, &M_field) == LCL_OK && lcl_field_create(A, 3, LCL_PRECISION_MIXED, &P_field) == LCL_OK,
           "fields can be made");
    expect(lcl_field_import_cl(M_field, memory, 0, LCL_TYPE_FLOAT, 0, 0, NULL, NULL) == LCL_OK, "a buffer can be imported");
    expect(lcl_interpolate_field(A, M_field, NULL, P_field, NULL) == LCL_OK, "fields can be solved on");
    expect(lcl_field_export_cl(P_field, memory, 0, LCL_TYPE_FLOAT, 0, 0, NULL, &done) == LCL_OK && done != NULL, "a field can be exported, with an event");
    expect(clEnqueueReadBuffer(other_queue, memory, CL_TRUE, 0, sizeof P, P, 1, &done, NULL) == CL_SUCCESS, "another queue can wait for the export");
    for (int i = 0; i < 18; ++i) /* the tolerance 1e-6 of the diagonal 2 sqrt 3, divided by the smallest eigenvalue, and floats */
        expect(fabs(P[i] - octahedron_points[i] / alpha_4) <= 1e-6 * 3.5 / 0.15 + 1e-6, "the control points are the vertices by 55/24");
    clReleaseEvent(done);
    clReleaseMemObject(memory);
    lcl_field_release(P_field);
    lcl_field_release(M_field);
}

int main(void) {
    cl_int code = CL_SUCCESS;
    lcl_context context = NULL;
    lcl_operator A;
    cl_event marker = NULL;
    cl_device_id device = first_device();
    cl_context opencl = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    cl_command_queue queue = clCreateCommandQueue(opencl, device, 0, &code), other_queue = clCreateCommandQueue(opencl, device, 0, &code);
    expect(code == CL_SUCCESS, "the caller has a queue");
    expect(lcl_context_create_from_cl(opencl, NULL, NULL, &context) == LCL_ERROR_INVALID_ARGUMENT && context == NULL, "no queue is refused");
    expect(lcl_context_create_from_cl(opencl, queue, NULL, &context) == LCL_OK, "a context works on the caller's queue");
    if (!context) return failures;
    expect(lcl_context_get_queue(context) == queue, "the queue is the caller's");
    A = make_operator(context);
    if (A) test_interpolation(A, opencl, other_queue);
    expect(lcl_context_wait_for(context, 0, NULL) == LCL_OK, "waiting for no event is nothing");
    expect(lcl_context_marker(context, &marker) == LCL_OK && clWaitForEvents(1, &marker) == CL_SUCCESS, "a marker is done some time");
    clReleaseEvent(marker);
    lcl_operator_release(A);
    lcl_context_release(context);
    clReleaseCommandQueue(other_queue);
    clReleaseCommandQueue(queue);
    clReleaseContext(opencl);
    return failures;
}
