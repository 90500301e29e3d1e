// SPDX-License-Identifier: BSD-3-Clause
#include "interpolation.h"

#include <stdexcept>

#include "measure.h"

namespace bench {

void check(lcl_status status) {
    if (status != LCL_OK) throw std::runtime_error(std::string(lcl_status_string(status)) + ": " + lcl_last_error());
}

void check_cl(cl_int status) {
    if (status != CL_SUCCESS) throw std::runtime_error(lcl_status_string(status));
}

ContextHandle open_device(const std::string& device, bool profiling) {
    lcl_context_options options = LCL_CONTEXT_OPTIONS_INIT;
    options.device = device.empty() ? nullptr : device.c_str();
    options.profiling = profiling;
    lcl_context context = nullptr;
    check(lcl_context_create(&options, &context));
    return ContextHandle(context);
}

MeshHandle make_mesh(const Shape& shape) {
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    data.vertex_count = shape.vertex_count();
    data.face_count = shape.face_count();
    data.uniform_degree = shape.degree;
    data.face_vertices = shape.faces.data();
    data.points = shape.points.data();
    lcl_mesh mesh = nullptr;
    check(lcl_mesh_create(&data, &mesh));
    return MeshHandle(mesh);
}

OperatorHandle make_operator(const ContextHandle& context, const MeshHandle& mesh, Scheme scheme) {
    lcl_scheme_options options = LCL_SCHEME_OPTIONS_INIT;
    options.scheme = scheme == Scheme::loop ? LCL_SCHEME_LOOP : scheme == Scheme::doo_sabin ? LCL_SCHEME_DOO_SABIN : LCL_SCHEME_CATMULL_CLARK;
    lcl_operator A = nullptr;
    check(lcl_operator_create(context.get(), mesh.get(), &options, &A));
    return OperatorHandle(A);
}

FieldHandle make_field(const OperatorHandle& A, int channels) {
    lcl_field field = nullptr;
    check(lcl_field_create(A.get(), channels, LCL_PRECISION_SINGLE, &field));
    return FieldHandle(field);
}

DeviceCopy::DeviceCopy(const ContextHandle& context, std::int32_t vertex_count)
    : queue_(lcl_context_get_queue(context.get())), bytes_(16 * static_cast<std::size_t>(vertex_count)) {
    cl_context inner = nullptr;
    check_cl(clGetCommandQueueInfo(queue_, CL_QUEUE_CONTEXT, sizeof inner, &inner, nullptr));
    const float zero = 0;
    for (cl_mem* memory : {&from_, &to_}) {
        cl_int status = CL_SUCCESS;
        *memory = clCreateBuffer(inner, CL_MEM_READ_WRITE, bytes_, nullptr, &status);
        check_cl(status);
        check_cl(clEnqueueFillBuffer(queue_, *memory, &zero, sizeof zero, 0, bytes_, 0, nullptr, nullptr));  // pages there before the first copy
    }
    check_cl(clFinish(queue_));
}

DeviceCopy::~DeviceCopy() {
    clReleaseMemObject(from_);
    clReleaseMemObject(to_);
}

double DeviceCopy::seconds(int copies) {
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < copies; ++i) check_cl(clEnqueueCopyBuffer(queue_, from_, to_, 0, 0, bytes_, 0, nullptr, nullptr));
    check_cl(clFinish(queue_));
    return seconds_since(start) / copies;
}

Interpolation::Interpolation(const ContextHandle& context_, const Shape& shape, Scheme scheme) : context(context_), vertex_count(shape.vertex_count()) {
    A = make_operator(context, make_mesh(shape), scheme);
    M = make_field(A);
    P = make_field(A);
    check(lcl_field_upload(M.get(), shape.points.data(), LCL_TYPE_DOUBLE, 0));
}

lcl_solve_report Interpolation::solve(lcl_precision precision) {
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    options.precision = precision;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    check(lcl_interpolate_field(A.get(), M.get(), &options, P.get(), &report));
    return report;
}

std::vector<double> Interpolation::control_points() const {
    std::vector<double> points(3 * static_cast<std::size_t>(vertex_count));
    check(lcl_field_download(P.get(), points.data(), LCL_TYPE_DOUBLE, 0));
    return points;
}

}  // namespace bench
