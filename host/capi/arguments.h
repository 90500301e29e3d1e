// SPDX-License-Identifier: BSD-3-Clause
// Checks of arguments that several parts of the C API make.
#pragma once

#include <initializer_list>
#include <string>

#include "host/apply/host_arrays.h"
#include "host/capi/handles.h"

namespace lcl {

Precision inner_precision(lcl_precision precision);
FileFormat inner_format(lcl_format format);

/// At least one channel, and rows that hold them.
void check_channels(int32_t channels, std::size_t stride, const char* name);

inline bool same(const Transform& a, const Transform& b) { return a.centre == b.centre && a.scale == b.scale; }

/// Centre and scale of a field; InvalidArgument where it holds nothing yet.
const Transform& transform_of(lcl_field field, const char* name);

/// Fields of A, of one shape and type; null ones are left out.
void check_same_operator(lcl_operator A, std::initializer_list<lcl_field> fields);

/// y gets values in this centre and scale; where only some of its rows are written, the others must be in it already (or hold nothing yet).
void set_transform(lcl_field y, const Transform& transform, bool all_rows_are_written);

}  // namespace lcl
