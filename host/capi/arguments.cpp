// SPDX-License-Identifier: BSD-3-Clause
#include "host/capi/arguments.h"

namespace lcl {

Precision inner_precision(lcl_precision precision) {
    if (precision < LCL_PRECISION_MIXED || precision > LCL_PRECISION_DOUBLE)
        throw InvalidArgument("precision is " + std::to_string(precision) + ", it goes from 0 to 2");
    return static_cast<Precision>(precision);
}

FileFormat inner_format(lcl_format format) {
    if (format < LCL_FORMAT_BY_ENDING || format > LCL_FORMAT_PTS) throw InvalidArgument("format is " + std::to_string(format) + ", it goes from 0 to 8");
    return static_cast<FileFormat>(format);
}

void check_channels(int32_t channels, std::size_t stride, const char* name) {
    if (channels < 1) throw InvalidArgument("channels is " + std::to_string(channels) + ", it is at least 1");
    if (stride < static_cast<std::size_t>(channels))
        throw InvalidArgument(std::string(name) + " is " + std::to_string(stride) + ", less than the " + std::to_string(channels) + " channels");
}

const Transform& transform_of(lcl_field field, const char* name) {
    if (!field->transform)
        throw InvalidArgument(std::string("the field ") + name + " holds no values yet: upload them, or give it a centre and scale by lcl_field_match");
    return *field->transform;
}

void check_same_operator(lcl_operator A, std::initializer_list<lcl_field> fields) {
    const lcl_field first = *fields.begin();
    for (const lcl_field field : fields) {
        if (field == nullptr) continue;
        if (field->A.get() != A) throw InvalidArgument("a field of another operator was given");
        if (field->field.channels() != first->field.channels() || field->field.real() != first->field.real())
            throw InvalidArgument("the fields differ in channels or precision");
    }
}

void set_transform(lcl_field y, const Transform& transform, bool all_rows_are_written) {
    if (y->transform && !all_rows_are_written && !same(*y->transform, transform))
        throw InvalidArgument("only some rows of y are written, and the others are kept in another centre and scale: use lcl_field_match before");
    y->transform = transform;
}

}  // namespace lcl
