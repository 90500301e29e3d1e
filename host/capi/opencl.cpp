// SPDX-License-Identifier: BSD-3-Clause
#include "limitcl/limitcl_opencl.h"

#include "host/apply/transfer.h"
#include "host/capi/handles.h"

using namespace lcl;

namespace {

/// A caller's rows in a cl_mem, checked against the field and the memory's size. `buffer` refers to the memory and must outlive what is returned.
CallerRows checked(lcl_field field, const Buffer& buffer, std::size_t offset, lcl_type type, std::size_t stride) {
    const Field& inner = field->field;
    if (type != LCL_TYPE_DOUBLE && type != LCL_TYPE_FLOAT) throw InvalidArgument("type is " + std::to_string(type) + ", it is 0 (double) or 1 (float)");
    if (type == LCL_TYPE_DOUBLE && !inner.context().device().has_double)
        throw Unsupported("the buffer holds doubles, and " + inner.context().device().name + " has no double precision: use floats");
    const std::size_t value_bytes = type == LCL_TYPE_FLOAT ? sizeof(float) : sizeof(double), channels = inner.channels();
    const CallerRows rows{&buffer, offset / value_bytes, stride == 0 ? channels : stride, type == LCL_TYPE_DOUBLE};
    if (rows.stride < channels) throw InvalidArgument("stride is " + std::to_string(stride) + ", less than the " + std::to_string(channels) + " channels");
    if (offset % value_bytes != 0)
        throw InvalidArgument("offset is " + std::to_string(offset) + " bytes, not a multiple of a value's " + std::to_string(value_bytes));
    const std::size_t room = offset > buffer.bytes() ? 0 : (buffer.bytes() - offset) / value_bytes, last_row = inner.rows() > 0 ? inner.rows() - 1 : 0;
    if (inner.rows() > 0 && (room < channels || (last_row > 0 && rows.stride > (room - channels) / last_row)))
        throw InvalidArgument(std::to_string(inner.rows()) + " rows of stride " + std::to_string(rows.stride) + " from byte " + std::to_string(offset) +
                              " do not fit into the buffer's " + std::to_string(buffer.bytes()) + " bytes");
    return rows;
}

Buffer borrowed(lcl_field field, cl_mem memory) {
    required(field, "field");
    required(memory, "memory");
    return Buffer(field->A->context->context, memory, 0, memory_bytes(memory));
}

Transform fitted(const lcl_field_s& field, const CallerRows& rows) {
    const Plan& plan = field.A->system->plan();
    const int channels = field.field.channels();
    const std::size_t count = plan.vertex_count == 0 ? 0 : (plan.vertex_count - 1) * rows.stride + channels;
    const std::size_t value_bytes = rows.is_double ? sizeof(double) : sizeof(float);
    std::vector<unsigned char> raw(count * value_bytes);
    field.field.context().read(*rows.buffer, rows.offset * value_bytes, raw.size(), raw.data(), "reading a caller's buffer");
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (rows.is_double) values[i] = reinterpret_cast<const double*>(raw.data())[i];
        else values[i] = reinterpret_cast<const float*>(raw.data())[i];
    }
    return fit_transform(plan, values.data(), rows.stride, channels);
}

void wait_for_events(Context& context, cl_uint count, const cl_event* events) {
    if (count > 0) context.wait_for(std::vector<cl_event>(required(events, "events"), events + count));
}

void give_marker(Context& context, cl_event* done) {
    if (done == nullptr) return;
    *done = context.marker().release();
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
        const Buffer buffer = borrowed(field, memory);
        const CallerRows rows = checked(field, buffer, offset, type, stride);
        wait_for_events(field->field.context(), event_count, events);
        if (!field->transform) field->transform = fitted(*field, rows);
        import_rows(*field->A->system->A, *field->transform, rows, field->field);
        give_marker(field->field.context(), done);
        return LCL_OK;
    });
}

lcl_status lcl_field_export_cl(lcl_field field, cl_mem memory, size_t offset, lcl_type type, size_t stride, cl_uint event_count, const cl_event* events,
                               cl_event* done) {
    return guarded([&] {
        const Buffer buffer = borrowed(field, memory);
        const CallerRows rows = checked(field, buffer, offset, type, stride);
        if (!field->transform) throw InvalidArgument("the field holds no values yet");
        wait_for_events(field->field.context(), event_count, events);
        export_rows(*field->A->system->A, *field->transform, field->field, rows);
        give_marker(field->field.context(), done);
        return LCL_OK;
    });
}

}  // extern "C"
