// SPDX-License-Identifier: BSD-3-Clause
// limitcl beside a caller's own OpenCL: contexts on the caller's queue, fields from and to cl_mem, events both ways.
#include "limitcl/limitcl_opencl.h"

#include <limits>

#include "tests/capi_support.h"

using namespace capi_test;

namespace {

constexpr double eps = 2.2e-16;
constexpr double float_eps = 6e-8;

void ok(cl_int code) { REQUIRE(code == CL_SUCCESS); }

/// A caller's device, context and queues, as they were before limitcl came.
struct Caller {
    cl_device_id device = nullptr;
    cl_context context = nullptr;
    cl_command_queue queue = nullptr, second_queue = nullptr;

    Caller() {
        ok(clGetCommandQueueInfo(lcl_context_get_queue(default_context()), CL_QUEUE_DEVICE, sizeof device, &device, nullptr));
        cl_int code = CL_SUCCESS;
        context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, &code);
        ok(code);
        queue = make_queue(0);
        second_queue = make_queue(0);
    }
    ~Caller() {
        clReleaseCommandQueue(second_queue);
        clReleaseCommandQueue(queue);
        clReleaseContext(context);
    }
    Caller(const Caller&) = delete;

    cl_command_queue make_queue(cl_command_queue_properties properties) const {
        cl_int code = CL_SUCCESS;
        cl_command_queue made = clCreateCommandQueue(context, device, properties, &code);
        return code == CL_SUCCESS ? made : nullptr;
    }

    Context open() const {
        lcl_context out = nullptr;
        succeed(lcl_context_create_from_cl(context, queue, nullptr, &out));
        return Context(out);
    }
};

/// A cl_mem that the caller owns.
template <class Number>
struct Memory {
    cl_mem memory = nullptr;
    cl_command_queue queue;
    std::size_t count;

    Memory(const Caller& caller, const std::vector<Number>& values) : queue(caller.second_queue), count(values.size()) {
        cl_int code = CL_SUCCESS;
        memory = clCreateBuffer(caller.context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, count * sizeof(Number), const_cast<Number*>(values.data()), &code);
        ok(code);
    }
    ~Memory() { clReleaseMemObject(memory); }
    Memory(const Memory&) = delete;

    std::vector<Number> read(cl_event after = nullptr) const {
        std::vector<Number> values(count);
        ok(clEnqueueReadBuffer(queue, memory, CL_TRUE, 0, count * sizeof(Number), values.data(), after ? 1 : 0, after ? &after : nullptr, nullptr));
        return values;
    }
};

/// An event that is released at the end; `set` completes a user event.
struct OwnedEvent {
    cl_event event = nullptr;
    OwnedEvent() = default;
    explicit OwnedEvent(const Caller& caller) {
        cl_int code = CL_SUCCESS;
        event = clCreateUserEvent(caller.context, &code);
        ok(code);
    }
    ~OwnedEvent() {
        if (event) clReleaseEvent(event);
    }
    OwnedEvent(const OwnedEvent&) = delete;
    void set() const { ok(clSetUserEventStatus(event, CL_COMPLETE)); }
    void wait() const { ok(clWaitForEvents(1, &event)); }
    bool is_complete() const {
        cl_int status = CL_QUEUED;
        ok(clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr));
        return status == CL_COMPLETE;
    }
};

shapes::Shape torus() { return shapes::rough(shapes::torus_quads(9, 7), 0.05, 2); }

/// n x channels values as rows of `stride` numbers behind `offset` ones, with `gap` between.
template <class Number>
std::vector<Number> spread(const std::vector<double>& values, int channels, std::size_t offset, std::size_t stride, Number gap) {
    std::vector<Number> out(offset + values.size() / channels * stride + 3, gap);
    for (std::size_t i = 0; i < values.size(); ++i) out[offset + i / channels * stride + i % channels] = static_cast<Number>(values[i]);
    return out;
}

bool has_double() {
    lcl_device_info info = LCL_DEVICE_INFO_INIT;
    succeed(lcl_context_get_device(default_context(), &info));
    return info.has_double != 0;
}

template <class Number>
constexpr lcl_type type_of = std::is_same<Number, float>::value ? LCL_TYPE_FLOAT : LCL_TYPE_DOUBLE;

/// Imports spread rows, exports them to another place, and compares both ways with the values.
template <class Number>
void check_round_trip(const Caller& caller, lcl_operator A, const std::vector<double>& values, int channels, lcl_precision precision) {
    CAPTURE(channels, precision, sizeof(Number));
    const std::size_t stride = channels + 2, offset = 5, out_stride = channels + 1, out_offset = 2;
    const Memory<Number> from(caller, spread<Number>(values, channels, offset, stride, Number(99))),
        to(caller, spread<Number>(values, channels, out_offset, out_stride, Number(-1)));
    const std::vector<Number> zeros(to.count, Number(-1));
    ok(clEnqueueWriteBuffer(caller.second_queue, to.memory, CL_TRUE, 0, zeros.size() * sizeof(Number), zeros.data(), 0, nullptr, nullptr));
    const FieldHandle field = make_field(A, channels, precision);
    succeed(lcl_field_import_cl(field.get(), from.memory, offset * sizeof(Number), type_of<Number>, stride, 0, nullptr, nullptr));
    const bool is_exact = precision == LCL_PRECISION_DOUBLE && sizeof(Number) == sizeof(double);
    const double bound = (is_exact ? 8 * eps : 6 * float_eps) * 1000;  // values up to 1000
    CHECK(largest_difference(download(field.get(), values.size() / channels), values) <= bound);
    OwnedEvent done;
    succeed(lcl_field_export_cl(field.get(), to.memory, out_offset * sizeof(Number), type_of<Number>, out_stride, 0, nullptr, &done.event));
    const std::vector<Number> found = to.read(done.event);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::size_t place = i - out_offset, v = place / out_stride, c = place % out_stride;
        const bool is_row = i >= out_offset && c < static_cast<std::size_t>(channels) && v < values.size() / channels;
        const double difference = std::abs(found[i] - (is_row ? values[v * channels + c] : -1));
        if (!(difference <= (is_row ? bound : 0))) FAIL_CHECK("element " << i << " is off by " << difference);
    }
}

}  // namespace

TEST_CASE("a context works on the caller's context and queue, and keeps them", "[interop][capi][device]") {
    auto caller = std::make_unique<Caller>();
    const cl_command_queue queue = caller->queue;
    const Context context = caller->open();
    CHECK(lcl_context_get_queue(context.get()) == queue);
    CHECK(lcl_context_get_queue(nullptr) == nullptr);
    lcl_device_info own = LCL_DEVICE_INFO_INIT, listed = LCL_DEVICE_INFO_INIT;
    succeed(lcl_context_get_device(context.get(), &own));
    succeed(lcl_context_get_device(default_context(), &listed));
    CHECK(own.index == -1);
    CHECK(std::string(own.name) == listed.name);
    caller.reset();  // the caller's references; those of the context remain
    const shapes::Shape shape = torus();
    const Operator A = make_operator(context.get(), make_mesh(shape).get()), other = make_operator(shape);
    std::vector<double> P(shape.mesh.positions.size()), Q(P.size());
    succeed(lcl_interpolate(A.get(), shape.mesh.positions.data(), 0, 3, nullptr, P.data(), 0, nullptr));
    succeed(lcl_interpolate(other.get(), shape.mesh.positions.data(), 0, 3, nullptr, Q.data(), 0, nullptr));
    CHECK(P == Q);
}

TEST_CASE("queues that do not serve are refused", "[interop][capi][device]") {
    const Caller caller, stranger;
    lcl_context out = nullptr;
    refuse(lcl_context_create_from_cl(nullptr, caller.queue, nullptr, &out), LCL_ERROR_INVALID_ARGUMENT, "context is NULL");
    refuse(lcl_context_create_from_cl(caller.context, nullptr, nullptr, &out), LCL_ERROR_INVALID_ARGUMENT, "queue is NULL");
    refuse(lcl_context_create_from_cl(caller.context, caller.queue, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "out is NULL");
    refuse(lcl_context_create_from_cl(caller.context, stranger.queue, nullptr, &out), LCL_ERROR_INVALID_ARGUMENT, "another OpenCL context");
    lcl_context_options no_size{};
    refuse(lcl_context_create_from_cl(caller.context, caller.queue, &no_size, &out), LCL_ERROR_INVALID_ARGUMENT, "struct_size is not set");
    const cl_command_queue out_of_order = caller.make_queue(CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    if (out_of_order) {  // an optional feature of OpenCL 1.2
        refuse(lcl_context_create_from_cl(caller.context, out_of_order, nullptr, &out), LCL_ERROR_INVALID_ARGUMENT, "out of order");
        clReleaseCommandQueue(out_of_order);
    }
    CHECK(out == nullptr);
}

TEST_CASE("rows go from and to a caller's buffer as floats and doubles, with offset and stride", "[interop][capi][device]") {
    const Caller caller;
    const Context context = caller.open();
    const shapes::Shape shape = torus();
    const Operator A = make_operator(context.get(), make_mesh(shape).get());
    for (int channels = 1; channels <= 9; ++channels) {
        const std::vector<double> values = with_channels(shape.mesh.positions, channels);
        check_round_trip<float>(caller, A.get(), values, channels, LCL_PRECISION_MIXED);
        if (!has_double()) continue;
        check_round_trip<double>(caller, A.get(), values, channels, LCL_PRECISION_MIXED);
        check_round_trip<float>(caller, A.get(), values, channels, LCL_PRECISION_DOUBLE);
        check_round_trip<double>(caller, A.get(), values, channels, LCL_PRECISION_DOUBLE);
    }
}

TEST_CASE("isolated vertices pass through import and export", "[interop][capi][device]") {
    const Caller caller;
    const Context context = caller.open();
    const shapes::Shape shape = shapes::with_isolated_vertex(torus(), 4);
    const Operator A = make_operator(context.get(), make_mesh(shape).get());
    const std::vector<float> points(shape.mesh.positions.begin(), shape.mesh.positions.end());
    const Memory<float> from(caller, points), to(caller, std::vector<float>(points.size(), 0.0f));
    const FieldHandle field = make_field(A.get(), 3, LCL_PRECISION_SINGLE);
    succeed(lcl_field_import_cl(field.get(), from.memory, 0, LCL_TYPE_FLOAT, 0, 0, nullptr, nullptr));
    succeed(lcl_field_export_cl(field.get(), to.memory, 0, LCL_TYPE_FLOAT, 0, 0, nullptr, nullptr));
    succeed(lcl_context_finish(context.get()));
    const std::vector<float> found = to.read();
    for (std::size_t i = 0; i < points.size(); ++i) CHECK(found[i] == Approx(points[i]).margin(1e-6));
}

TEST_CASE("a solve between a caller's buffers gives what arrays give", "[interop][capi][device]") {
    const Caller caller;
    const Context context = caller.open();
    const shapes::Shape shape = torus();
    const Operator A = make_operator(context.get(), make_mesh(shape).get());
    const std::vector<float> points(shape.mesh.positions.begin(), shape.mesh.positions.end());
    const Memory<float> memory(caller, points);
    const FieldHandle M = make_field(A.get(), 3, LCL_PRECISION_MIXED), P = make_field(A.get(), 3, LCL_PRECISION_MIXED);
    OwnedEvent imported, exported;
    succeed(lcl_field_import_cl(M.get(), memory.memory, 0, LCL_TYPE_FLOAT, 0, 0, nullptr, &imported.event));
    succeed(lcl_interpolate_field(A.get(), M.get(), nullptr, P.get(), nullptr));
    succeed(lcl_field_export_cl(P.get(), memory.memory, 0, LCL_TYPE_FLOAT, 0, 1, &imported.event, &exported.event));
    const std::vector<float> found = memory.read(exported.event);
    std::vector<double> expected(points.size()), as_double(points.begin(), points.end());
    succeed(lcl_interpolate(A.get(), as_double.data(), 0, 3, nullptr, expected.data(), 0, nullptr));
    CHECK(largest_difference({found.begin(), found.end()}, expected) <= 2 * 9 * 1e-6 * diagonal_of(shape) * 2);  // |A^-1| is about 9 on regular quads
}

TEST_CASE("an import starts after the caller's events, and the call does not wait for them", "[interop][capi][device]") {
    const Caller caller;
    const Context context = caller.open();
    const shapes::Shape shape = torus();
    const Operator A = make_operator(context.get(), make_mesh(shape).get());
    const std::vector<float> points(shape.mesh.positions.begin(), shape.mesh.positions.end());
    const Memory<float> memory(caller, std::vector<float>(points.size(), 0.0f));
    const FieldHandle like = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_SINGLE), field = make_field(A.get(), 3, LCL_PRECISION_SINGLE);
    succeed(lcl_field_match(field.get(), like.get()));  // so that the values need not be read to the host
    const OwnedEvent gate(caller);
    OwnedEvent written, done;
    ok(clEnqueueWriteBuffer(caller.second_queue, memory.memory, CL_FALSE, 0, points.size() * sizeof(float), points.data(), 1, &gate.event, &written.event));
    ok(clFlush(caller.second_queue));
    succeed(lcl_field_import_cl(field.get(), memory.memory, 0, LCL_TYPE_FLOAT, 0, 1, &written.event, &done.event));
    CHECK_FALSE(done.is_complete());
    gate.set();
    done.wait();
    CHECK(largest_difference(download(field.get(), shape.mesh.vertex_count), shape.mesh.positions) <= 4 * float_eps * diagonal_of(shape));
}

TEST_CASE("an export starts after the caller's events", "[interop][capi][device]") {
    const Caller caller;
    const Context context = caller.open();
    const shapes::Shape shape = torus();
    const Operator A = make_operator(context.get(), make_mesh(shape).get());
    const FieldHandle field = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_SINGLE);
    const Memory<float> memory(caller, std::vector<float>(shape.mesh.positions.size(), 0.0f));
    const std::vector<float> nines(memory.count, 9.0f);
    const OwnedEvent gate(caller);
    OwnedEvent written, done;
    ok(clEnqueueWriteBuffer(caller.second_queue, memory.memory, CL_FALSE, 0, nines.size() * sizeof(float), nines.data(), 1, &gate.event, &written.event));
    ok(clFlush(caller.second_queue));
    succeed(lcl_field_export_cl(field.get(), memory.memory, 0, LCL_TYPE_FLOAT, 0, 1, &written.event, &done.event));
    CHECK_FALSE(done.is_complete());
    gate.set();
    const std::vector<float> found = memory.read(done.event);  // not nine: the export came later
    CHECK(largest_difference({found.begin(), found.end()}, shape.mesh.positions) <= 4 * float_eps * diagonal_of(shape));
}

TEST_CASE("kernels wait for events, also at their first use, and a marker tells when they are done", "[interop][capi][device]") {
    const Caller caller;
    const Context context = caller.open();
    const shapes::Shape shape = torus();
    const Operator A = make_operator(context.get(), make_mesh(shape).get());
    const FieldHandle x = make_field(A.get(), shape.mesh.positions), y = make_field(A.get());
    succeed(lcl_context_finish(context.get()));
    const OwnedEvent gate(caller);
    OwnedEvent marker;
    succeed(lcl_context_wait_for(context.get(), 1, &gate.event));
    succeed(lcl_operator_apply(A.get(), x.get(), y.get()));  // returns at once
    succeed(lcl_operator_step(A.get(), 1, 1, 0, x.get(), x.get(), nullptr, y.get(), 0, -1, nullptr));
    succeed(lcl_operator_apply(A.get(), x.get(), y.get()));
    succeed(lcl_context_marker(context.get(), &marker.event));
    CHECK_FALSE(marker.is_complete());
    gate.set();
    marker.wait();
    CHECK(marker.is_complete());
    std::vector<double> expected(shape.mesh.positions.size());
    succeed(lcl_limit_points(A.get(), shape.mesh.positions.data(), 0, 3, LCL_PRECISION_DOUBLE, expected.data(), 0));
    CHECK(download(y.get(), shape.mesh.vertex_count) == expected);
    succeed(lcl_context_wait_for(context.get(), 0, nullptr));
    refuse(lcl_context_wait_for(nullptr, 1, &gate.event), LCL_ERROR_INVALID_ARGUMENT, "context is NULL");
    refuse(lcl_context_wait_for(context.get(), 1, nullptr), LCL_ERROR_INVALID_ARGUMENT, "events is NULL");
    refuse(lcl_context_marker(nullptr, &marker.event), LCL_ERROR_INVALID_ARGUMENT, "context is NULL");
    refuse(lcl_context_marker(context.get(), nullptr), LCL_ERROR_INVALID_ARGUMENT, "event is NULL");
}

TEST_CASE("buffers that do not fit are refused before anything is put on the queue", "[interop][capi][device]") {
    const Caller caller, stranger;
    const Context context = caller.open();
    const shapes::Shape shape = torus();
    const Operator A = make_operator(context.get(), make_mesh(shape).get());
    const FieldHandle field = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_SINGLE), empty = make_field(A.get(), 3, LCL_PRECISION_SINGLE);
    const std::vector<float> zeros(shape.mesh.positions.size(), 0.0f);
    const Memory<float> memory(caller, zeros), foreign(stranger, zeros);
    const auto both = [&](lcl_field f, cl_mem m, std::size_t offset, lcl_type type, std::size_t stride, const char* part) {
        refuse(lcl_field_import_cl(f, m, offset, type, stride, 0, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, part);
        refuse(lcl_field_export_cl(f, m, offset, type, stride, 0, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, part);
    };
    both(nullptr, memory.memory, 0, LCL_TYPE_FLOAT, 0, "field is NULL");
    both(field.get(), nullptr, 0, LCL_TYPE_FLOAT, 0, "memory is NULL");
    both(field.get(), memory.memory, 4, LCL_TYPE_FLOAT, 0, "do not fit into the buffer's");
    both(field.get(), memory.memory, 0, LCL_TYPE_FLOAT, 4, "do not fit into the buffer's");
    both(field.get(), memory.memory, 2, LCL_TYPE_FLOAT, 0, "not a multiple of a value's 4");
    both(field.get(), memory.memory, 0, LCL_TYPE_FLOAT, 2, "stride is 2");
    both(field.get(), memory.memory, 0, static_cast<lcl_type>(2), 0, "type is 2");
    both(field.get(), foreign.memory, 0, LCL_TYPE_FLOAT, 0, "context");
    refuse(lcl_field_export_cl(empty.get(), memory.memory, 0, LCL_TYPE_FLOAT, 0, 0, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    refuse(lcl_field_import_cl(field.get(), memory.memory, 0, LCL_TYPE_FLOAT, 0, 1, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "events is NULL");
    const lcl_status too_large =
        lcl_field_import_cl(field.get(), memory.memory, std::numeric_limits<std::size_t>::max() - 3, LCL_TYPE_FLOAT, 0, 0, nullptr, nullptr);
    refuse(too_large, LCL_ERROR_INVALID_ARGUMENT, "do not fit into the buffer's");
    refuse(lcl_field_import_cl(field.get(), memory.memory, 0, LCL_TYPE_FLOAT, std::numeric_limits<std::size_t>::max() / 8, 0, nullptr, nullptr),
           LCL_ERROR_INVALID_ARGUMENT, "do not fit into the buffer's");
    if (has_double()) both(field.get(), memory.memory, 0, LCL_TYPE_DOUBLE, 0, "do not fit into the buffer's");
    else CHECK(lcl_field_import_cl(field.get(), memory.memory, 0, LCL_TYPE_DOUBLE, 0, 0, nullptr, nullptr) == LCL_ERROR_UNSUPPORTED);
    CHECK(memory.read() == zeros);
}

TEST_CASE("queues have profiling if it was asked for", "[interop][capi][device]") {
    const bool profiling = GENERATE(false, true);
    const Context context = open_context(nullptr, profiling);
    cl_command_queue_properties properties = 0;
    ok(clGetCommandQueueInfo(lcl_context_get_queue(context.get()), CL_QUEUE_PROPERTIES, sizeof properties, &properties, nullptr));
    CHECK(((properties & CL_QUEUE_PROFILING_ENABLE) != 0) == profiling);
    OwnedEvent marker;
    succeed(lcl_context_marker(context.get(), &marker.event));
    marker.wait();
    cl_ulong start = 0;
    CHECK((clGetEventProfilingInfo(marker.event, CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr) == CL_SUCCESS) == profiling);
}

TEST_CASE("a context of the library's own waits for its work when it goes", "[interop][capi][device]") {
    Context context = open_context();
    const shapes::Shape shape = shapes::torus_quads(90, 80);
    Operator A = make_operator(context.get(), make_mesh(shape).get());
    FieldHandle x = make_field(A.get(), shape.mesh.positions, LCL_PRECISION_SINGLE), y = make_field(A.get(), 3, LCL_PRECISION_SINGLE);
    lcl_denoise_options options = LCL_DENOISE_OPTIONS_INIT;
    options.k = 330;  // less than a thousand passes, which are all put on the queue at once
    succeed(lcl_denoise_field(A.get(), x.get(), &options, y.get()));
    OwnedEvent done;
    succeed(lcl_context_marker(context.get(), &done.event));
    x.reset(), y.reset(), A.reset(), context.reset();
    CHECK(done.is_complete());
}
