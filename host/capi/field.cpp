// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/capi/arguments.h"
#include "host/field/host_rows.h"

using namespace lcl;

namespace {

/// a + c is 1, as for PIA and its relatives, but for the rounding of three-term recurrences such as Chebyshev's (1 + p) x - p d.
bool is_affine(double a, double c) { return std::abs(a + c - 1) <= 4 * std::numeric_limits<double>::epsilon() * (std::abs(a) + std::abs(c)); }

void check_type(lcl_type type, std::size_t stride, int channels) {
    if (type != LCL_TYPE_DOUBLE && type != LCL_TYPE_FLOAT) throw InvalidArgument("type is " + std::to_string(type) + ", it is 0 (double) or 1 (float)");
    if (stride < static_cast<std::size_t>(channels))
        throw InvalidArgument("stride is " + std::to_string(stride) + ", less than the " + std::to_string(channels) + " channels");
}

/// Rows of the plan for a list of vertices, and the places of the list in ascending order of rows: neighbours in memory travel together.
struct RowList {
    std::vector<Index> rows;
    std::vector<std::size_t> order;
};

RowList row_list(const Plan& plan, const int32_t* vertices, std::size_t count) {
    RowList list;
    for (std::size_t i = 0; i < count; ++i) {
        if (vertices[i] < 0 || vertices[i] >= plan.vertex_count)
            throw InvalidArgument("vertex " + std::to_string(vertices[i]) + " was asked for, the field has " + std::to_string(plan.vertex_count),
                                  {{vertices[i]}, {}});
        list.rows.push_back(plan.row_of_vertex[vertices[i]]);
    }
    list.order.resize(count);
    std::iota(list.order.begin(), list.order.end(), std::size_t{0});
    std::stable_sort(list.order.begin(), list.order.end(), [&](std::size_t a, std::size_t b) { return list.rows[a] < list.rows[b]; });
    return list;
}

/// body(begin, end) for each stretch of order whose rows follow each other.
template <class Body>
void for_each_stretch(const RowList& list, const Body& body) {
    for (std::size_t begin = 0, end; begin < list.order.size(); begin = end) {
        end = begin + 1;
        while (end < list.order.size() && list.rows[list.order[end]] == list.rows[list.order[end - 1]] + 1) ++end;
        body(begin, end);
    }
}

}  // namespace

extern "C" {

lcl_status lcl_field_create(lcl_operator A, int32_t channels, lcl_precision precision, lcl_field* field) {
    return guarded([&] {
        required(field, "field");
        if (channels < 1) throw InvalidArgument("channels is " + std::to_string(channels) + ", it is at least 1");
        inner_precision(precision);  // refuses what is none
        Field values = required(A, "A")->system->A->make_field(channels, precision == LCL_PRECISION_DOUBLE ? Real::full : Real::single);
        values.fill_zero();
        *field = new lcl_field_s(A, std::move(values));
        return LCL_OK;
    });
}

void lcl_field_retain(lcl_field field) { retain(field); }
void lcl_field_release(lcl_field field) { release(field); }
int32_t lcl_field_channels(lcl_field field) { return field ? field->field.channels() : 0; }

lcl_status lcl_field_upload(lcl_field field, const void* values, lcl_type type, size_t stride) {
    return guarded([&] {
        Field& inner = required(field, "field")->field;
        if (stride == 0) stride = inner.channels();
        check_type(type, stride, inner.channels());
        const Plan& plan = field->A->system->plan();
        const HostRows rows{required(values, "values"), stride, type == LCL_TYPE_FLOAT};
        const ValueRanges ranges = value_ranges(plan, rows, inner.channels());
        if (!ranges.are_finite) with_type(rows, [&](const auto* typed) { require_finite(typed, stride, inner.channels(), plan.vertex_count, "values"); });
        if (!field->transform) field->transform = transform_of_ranges(plan, ranges);
        upload_rows(plan, *field->transform, rows, inner);
        return LCL_OK;
    });
}

lcl_status lcl_field_download(lcl_field field, void* values, lcl_type type, size_t stride) {
    return guarded([&] {
        const Field& inner = required(field, "field")->field;
        if (stride == 0) stride = inner.channels();
        check_type(type, stride, inner.channels());
        const Plan& plan = field->A->system->plan();
        const Transform& transform = transform_of(field, "to download");
        download_rows(plan, transform, inner, {required(values, "values"), stride, type == LCL_TYPE_FLOAT});
        return LCL_OK;
    });
}

lcl_status lcl_field_match(lcl_field field, lcl_field of) {
    return guarded([&] {
        if (required(field, "field")->field.channels() != required(of, "of")->field.channels()) throw InvalidArgument("the fields differ in channels");
        const Transform& transform = transform_of(of, "to match");
        if (field->transform && !same(*field->transform, transform))
            throw InvalidArgument("the field holds values in another centre and scale already: match it before its first upload");
        const bool is_centred = std::any_of(transform.centre.begin(), transform.centre.end(), [](double centre) { return centre != 0; });
        if (is_centred && !field->A->system->plan().rows_sum_to_one)
            throw InvalidArgument("the rows of the field's operator do not sum to 1, and fields of it are kept round 0: upload the values instead");
        field->transform = transform;
        return LCL_OK;
    });
}

lcl_status lcl_field_read_vertices(lcl_field field, const int32_t* vertices, size_t count, double* values) {
    return guarded([&] {
        const Field& inner = required(field, "field")->field;
        const int channels = inner.channels();
        const Transform& transform = transform_of(field, "to read");
        const RowList list = row_list(field->A->system->plan(), count ? required(vertices, "vertices") : vertices, count);
        for_each_stretch(list, [&](std::size_t begin, std::size_t end) {
            std::vector<double> rows((end - begin) * channels);
            inner.download(rows.data(), list.rows[list.order[begin]], static_cast<Index>(end - begin));
            for (std::size_t i = 0; i < rows.size(); ++i)
                required(values, "values")[list.order[begin + i / channels] * channels + i % channels] =
                    rows[i] / transform.scale[i % channels] + transform.centre[i % channels];
        });
        return LCL_OK;
    });
}

lcl_status lcl_field_write_vertices(lcl_field field, const int32_t* vertices, size_t count, const double* values) {
    return guarded([&] {
        Field& inner = required(field, "field")->field;
        const int channels = inner.channels();
        const Transform& transform = transform_of(field, "to write");
        const RowList list = row_list(field->A->system->plan(), count ? required(vertices, "vertices") : vertices, count);
        for_each_stretch(list, [&](std::size_t begin, std::size_t end) {
            std::vector<double> rows((end - begin) * channels);
            for (std::size_t i = 0; i < rows.size(); ++i)
                rows[i] = (required(values, "values")[list.order[begin + i / channels] * channels + i % channels] - transform.centre[i % channels]) *
                          transform.scale[i % channels];
            inner.upload(rows.data(), list.rows[list.order[begin]], static_cast<Index>(end - begin));
        });
        return LCL_OK;
    });
}

lcl_status lcl_operator_apply(lcl_operator A, lcl_field x, lcl_field y) {
    return guarded([&] {
        check_same_operator(required(A, "A"), {required(x, "x"), required(y, "y")});
        if (x == y) throw InvalidArgument("x and y are the same field");
        set_transform(y, transform_of(x, "x"), A->system->plan().row_count == A->system->plan().vertex_count);
        A->system->A->limit_points(x->field, y->field, A->system->plan().all_rows());
        return LCL_OK;
    });
}

lcl_status lcl_operator_step(lcl_operator A, double a, double b, double c, lcl_field M, lcl_field x, lcl_field d, lcl_field y, int32_t first_block,
                             int32_t block_count, double* residual) {
    return guarded([&] {
        check_same_operator(required(A, "A"), {required(x, "x"), required(M, "M"), required(y, "y"), d});
        if (x == y || M == y) throw InvalidArgument("y is the same field as x or M");
        if (c != 0) required(d, "d");
        const Transform& transform = transform_of(x, "x");
        for (const lcl_field field : {M, c != 0 ? d : M})
            if (!same(transform_of(field, field == M ? "M" : "d"), transform))
                throw InvalidArgument("M, x and d differ in centre and scale: use lcl_field_match before uploading");
        const Plan& plan = A->system->plan();
        const Index blocks = static_cast<Index>(plan.blocks.size());
        const std::int64_t end = block_count < 0 ? blocks : std::int64_t{first_block} + block_count;
        if (first_block < 0 || first_block > blocks || end > blocks)
            throw InvalidArgument("blocks " + std::to_string(first_block) + " to " + std::to_string(end) + " were asked for, the operator has " +
                                  std::to_string(blocks));
        block_count = static_cast<int32_t>(end) - first_block;
        const Part part{0, 0, first_block, block_count};
        Transform result = transform;
        if (!is_affine(a, c))
            for (double& centre : result.centre) centre *= a + c;  // 0 for a residual
        set_transform(y, result, block_count == blocks && plan.row_count == plan.vertex_count);
        A->system->A->sweep({a, b, 0, c}, M->field, x->field, c != 0 ? &d->field : nullptr, y->field, part);
        if (residual != nullptr) *residual = A->system->A->norms(x->field, part).position / transform.scale[0];
        return LCL_OK;
    });
}

}  // extern "C"
