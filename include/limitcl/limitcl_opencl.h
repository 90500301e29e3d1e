/* SPDX-License-Identifier: BSD-3-Clause */
/**
 * limitcl beside a caller's own OpenCL: contexts on the caller's cl_context and queue, fields from and to cl_mem without a way through the host, events both
 * ways. Conventions as in limitcl.h.
 */
#ifndef LIMITCL_LIMITCL_OPENCL_H
#define LIMITCL_LIMITCL_OPENCL_H

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
#include <CL/cl.h>

#include "limitcl.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A context on the caller's: both objects are retained, the device is the queue's. The queue must be in order (LCL_ERROR_INVALID_ARGUMENT); limitcl puts its
 * kernels on it, and makes a second one of its own for transfers and for every other launch of a solve's sweeps, in the right order. options->device is not
 * looked at. */
LCL_API lcl_status lcl_context_create_from_cl(cl_context context, cl_command_queue queue, const lcl_context_options* options, lcl_context* out);
/** The queue that kernels go to; it belongs to the context. */
LCL_API cl_command_queue lcl_context_get_queue(lcl_context context);
/** Kernels put on the queue from now on start after these events. */
LCL_API lcl_status lcl_context_wait_for(lcl_context context, cl_uint event_count, const cl_event* events);
/** An event that is done when all that was put on the queue before is; the caller releases it. */
LCL_API lcl_status lcl_context_marker(lcl_context context, cl_event* event);

/** Copies n rows in the caller's vertex order from a buffer of the same cl_context into a field, on the device: row v begins offset bytes + v * stride values
 * into it (stride 0: the field's channels). Starts after the events; `done`, unless NULL, is the caller's to release. A field without centre and scale gets
 * them from the values, which are read to the host once for it: lcl_field_match before avoids that. LCL_TYPE_DOUBLE needs a device with double precision. */
LCL_API lcl_status lcl_field_import_cl(lcl_field field, cl_mem memory, size_t offset, lcl_type type, size_t stride, cl_uint event_count, const cl_event* events,
                                       cl_event* done);
/** The way back. Rows of isolated vertices are written too, with what was imported. */
LCL_API lcl_status lcl_field_export_cl(lcl_field field, cl_mem memory, size_t offset, lcl_type type, size_t stride, cl_uint event_count, const cl_event* events,
                                       cl_event* done);

#ifdef __cplusplus
}
#endif

#endif
