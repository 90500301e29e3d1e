// SPDX-License-Identifier: BSD-3-Clause
#include "limitcl/limitcl_opencl.h"

#include "host/capi/handles.h"

using namespace lcl;

namespace {

/// Where a caller's rows lie in a cl_mem.
struct CallerRows {
    cl_mem memory;
    std::size_t offset;  // bytes
    lcl_type type;
    std::size_t stride;  // values
    std::size_t value_bytes() const { return type == LCL_TYPE_FLOAT ? sizeof(float) : sizeof(double); }
};

CallerRows checked(lcl_field field, cl_mem memory, std::size_t offset, lcl_type type, std::size_t stride) {
    const Field& inner = required(field, "field")->field;
    required(memory, "memory");
    if (type != LCL_TYPE_DOUBLE && type != LCL_TYPE_FLOAT) throw InvalidArgument("type is " + std::to_string(type) + ", it is 0 (double) or 1 (float)");
    if (type == LCL_TYPE_DOUBLE && !inner.context().device().has_double)
        throw Unsupported("the buffer holds doubles, and " + inner.context().device().name + " has no double precision: use floats");
    CallerRows rows{memory, offset, type, stride == 0 ? inner.channels() : stride};
    if (rows.stride < static_cast<std::size_t>(inner.channels()))
        throw InvalidArgument("stride is " + std::to_string(stride) + ", less than the " + std::to_string(inner.channels()) + " channels");
    if (offset % rows.value_bytes() != 0)
        throw InvalidArgument("offset is " + std::to_string(offset) + " bytes, not a multiple of a value's " + std::to_string(rows.value_bytes()));
    std::size_t size = 0;
    check(clGetMemObjectInfo(memory, CL_MEM_SIZE, sizeof size, &size, nullptr), "clGetMemObjectInfo", "looking at a caller's buffer");
    const std::size_t room = offset > size ? 0 : (size - offset) / rows.value_bytes(), last_row = inner.rows() > 0 ? inner.rows() - 1 : 0,
                      channels = inner.channels();
    if (inner.rows() > 0 && (room < channels || (last_row > 0 && rows.stride > (room - channels) / last_row)))
        throw InvalidArgument(std::to_string(inner.rows()) + " rows of stride " + std::to_string(rows.stride) + " from byte " + std::to_string(offset) +
                              " do not fit into the buffer's " + std::to_string(size) + " bytes");
    return rows;
}

Transform fitted(const lcl_field_s& field, const CallerRows& rows) {
    const Plan& plan = field.A->system->plan();
    const int channels = field.field.channels();
    const std::size_t count = plan.vertex_count == 0 ? 0 : (plan.vertex_count - 1) * rows.stride + channels;
    const Buffer buffer(field.A->context->context, rows.memory, 0, rows.offset + count * rows.value_bytes());
    std::vector<unsigned char> raw(count * rows.value_bytes());
    if (!raw.empty()) field.field.context().read(buffer, rows.offset, raw.size(), raw.data(), "reading a caller's buffer");
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (rows.type == LCL_TYPE_FLOAT) values[i] = reinterpret_cast<const float*>(raw.data())[i];
        else values[i] = reinterpret_cast<const double*>(raw.data())[i];
    }
    return fit_transform(plan, values.data(), rows.stride, channels);
}

/// Centre, scale and inverse scale of a block's components, as lcl_import_points takes them.
Buffer frame(const lcl_field_s& field, const ChannelBlock& block, bool as_double) {
    std::vector<double> values(3 * block.width, 0.0);
    for (int c = 0; c < block.count; ++c) {
        values[c] = field.transform->centre[block.first + c];
        values[block.width + c] = field.transform->scale[block.first + c];
        values[2 * block.width + c] = 1 / field.transform->scale[block.first + c];
    }
    const std::vector<float> narrow(values.begin(), values.end());
    Buffer buffer(field.A->context->context, values.size() * sizeof(double), "centre and scale of a field");
    const void* const from = as_double ? static_cast<const void*>(values.data()) : narrow.data();
    // Beside the kernels' queue: that one may stand still until an event that the caller sets after this call.
    field.field.context()
        .write_async(buffer, 0, values.size() * (as_double ? sizeof(double) : sizeof(float)), from, {}, "uploading the centre and scale of a field")
        .wait();
    return buffer;
}

enum class Direction { into_field, out_of_field };

void transfer(lcl_field_s& field, const CallerRows& rows, Direction direction) {
    const bool imports = direction == Direction::into_field;
    Field& inner = field.field;
    Context& context = inner.context();
    const bool as_double = inner.real() == Real::full || rows.type == LCL_TYPE_DOUBLE;
    const std::size_t stride = rows.stride, offset = rows.offset / rows.value_bytes();
    for (std::size_t b = 0; b < inner.blocks().size(); ++b) {
        const ChannelBlock& block = inner.blocks()[b];
        const Buffer caller(field.A->context->context, rows.memory, 0, 0);
        const std::string options =
            kernel_options(context, inner.real(), block.width, 1) + " -D LCL_SOURCE=" + (rows.type == LCL_TYPE_FLOAT ? "float" : "double");
        launch(context, context.kernel("transfer", imports ? "lcl_import_points" : "lcl_export_points", options), {static_cast<std::size_t>(inner.rows()), 0},
               static_cast<cl_uint>(inner.rows()), static_cast<cl_ulong>(stride), static_cast<cl_ulong>(offset), static_cast<cl_uint>(block.first),
               static_cast<cl_uint>(block.count), field.A->system->A->vertex_order(), frame(field, block, as_double), imports ? caller : inner.buffer(b),
               imports ? inner.buffer(b) : caller);
    }
}

void wait_for_events(Context& context, cl_uint count, const cl_event* events) {
    if (count > 0) context.wait_for(std::vector<cl_event>(required(events, "events"), events + count));
}

void give_marker(Context& context, cl_event* done) {
    if (done == nullptr) return;
    const Event marker = context.marker();
    check(clRetainEvent(marker.get()), "clRetainEvent", "giving out an event");
    *done = marker.get();
}

}  // namespace

extern "C" {

lcl_status lcl_context_create_from_cl(cl_context context, cl_command_queue queue, const lcl_context_options* options, lcl_context* out) {
    return guarded([&] {
        required(out, "out");
        const lcl_context_options given = options_or(options, LCL_CONTEXT_OPTIONS_INIT, "options");
        ContextOptions inner;
        if (given.cache_directory != nullptr) inner.cache_directory = given.cache_directory;
        auto handle = std::make_unique<lcl_context_s>();
        handle->context = Context::adopt(required(context, "context"), required(queue, "queue"), inner);
        handle->log = given.log;
        handle->log_user = given.log_user;
        handle->log_level = given.log_level;
        *out = handle.release();
        return LCL_OK;
    });
}

cl_command_queue lcl_context_get_queue(lcl_context context) { return context ? context->context->queue() : nullptr; }

lcl_status lcl_context_wait_for(lcl_context context, cl_uint event_count, const cl_event* events) {
    return guarded([&] {
        wait_for_events(*required(context, "context")->context, event_count, events);
        return LCL_OK;
    });
}

lcl_status lcl_context_marker(lcl_context context, cl_event* event) {
    return guarded([&] {
        give_marker(*required(context, "context")->context, required(event, "event"));
        return LCL_OK;
    });
}

lcl_status lcl_field_import_cl(lcl_field field, cl_mem memory, size_t offset, lcl_type type, size_t stride, cl_uint event_count, const cl_event* events,
                               cl_event* done) {
    return guarded([&] {
        const CallerRows rows = checked(field, memory, offset, type, stride);
        wait_for_events(field->field.context(), event_count, events);
        if (!field->transform) field->transform = fitted(*field, rows);
        transfer(*field, rows, Direction::into_field);
        give_marker(field->field.context(), done);
        return LCL_OK;
    });
}

lcl_status lcl_field_export_cl(lcl_field field, cl_mem memory, size_t offset, lcl_type type, size_t stride, cl_uint event_count, const cl_event* events,
                               cl_event* done) {
    return guarded([&] {
        const CallerRows rows = checked(field, memory, offset, type, stride);
        if (!field->transform) throw InvalidArgument("the field holds no values yet");
        wait_for_events(field->field.context(), event_count, events);
        transfer(*field, rows, Direction::out_of_field);
        give_marker(field->field.context(), done);
        return LCL_OK;
    });
}

}  // extern "C"
