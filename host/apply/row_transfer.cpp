// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/row_transfer.h"

#include <algorithm>

namespace lcl {
namespace {

constexpr std::size_t least_capacity = 4096;  // rows
constexpr std::size_t largest_group = 64;

/// Components of one channel block between a field's own number type and doubles.
template <class Number>
void pack(const std::vector<double>& values, std::size_t count, int channels, const ChannelBlock& block, unsigned char* raw) {
    Number* out = reinterpret_cast<Number*>(raw);
    for (std::size_t i = 0; i < count; ++i)
        for (int c = 0; c < block.width; ++c) *out++ = c < block.count ? static_cast<Number>(values[i * channels + block.first + c]) : Number(0);
}
template <class Number>
void unpack(const unsigned char* raw, std::size_t count, int channels, const ChannelBlock& block, std::vector<double>& values) {
    const Number* in = reinterpret_cast<const Number*>(raw);
    for (std::size_t i = 0; i < count; ++i, in += block.width)
        for (int c = 0; c < block.count; ++c) values[i * channels + block.first + c] = in[c];
}

}  // namespace

/// Uploads the lists, one after the other; returns their length.
std::size_t RowTransfer::prepare(const std::vector<FieldRows>& lists) {
    all_rows_.clear();
    for (const FieldRows& list : lists) all_rows_.insert(all_rows_.end(), list.rows->begin(), list.rows->end());
    const std::size_t count = all_rows_.size();
    std::size_t row_bytes = 0;
    for (std::size_t b = 0; b < lists.front().field->blocks().size(); ++b) row_bytes = std::max(row_bytes, lists.front().field->row_bytes(b));
    const std::size_t capacity = std::max(count + count / 2, least_capacity);
    if (count * sizeof(Index) > rows_.bytes() || !rows_) rows_ = Buffer(context_, capacity * sizeof(Index), "a list of rows");
    if (count * row_bytes > values_.bytes() || !values_) values_ = Buffer(context_, capacity * row_bytes, "rows that travel");
    raw_.resize(values_.bytes());
    context_->write(rows_, 0, count * sizeof(Index), all_rows_.data(), "uploading a list of rows");
    return count;
}

/// One channel block of all lists, between the fields and values_.
void RowTransfer::launch_lists(const char* name, const std::vector<FieldRows>& lists, std::size_t block, bool gathers) {
    const std::size_t local = std::min(largest_group, context_->device().max_work_group_size);
    Index first = 0;
    for (const FieldRows& list : lists) {
        Field& field = *list.field;
        const Index count = static_cast<Index>(list.rows->size());
        const cl_kernel kernel = context_->kernel("scatter", name, kernel_options(*context_, field.real(), field.blocks()[block].width, 1));
        const LaunchSize size{(count + local - 1) / local * local, local};
        if (gathers) launch(*context_, kernel, size, first, count, rows_, field.buffer(block), values_);
        else launch(*context_, kernel, size, first, count, rows_, values_, field.buffer(block));
        first += count;
    }
}

void RowTransfer::read(const std::vector<FieldRows>& lists, std::vector<double>& values) {
    const Field& like = *lists.front().field;
    const std::size_t count = prepare(lists);
    values.resize(count * like.channels());
    for (std::size_t b = 0; b < like.blocks().size(); ++b) {
        launch_lists("lcl_gather_rows", lists, b, true);
        context_->read(values_, 0, count * like.row_bytes(b), raw_.data(), "reading rows of a field");
        if (like.real() == Real::single) unpack<float>(raw_.data(), count, like.channels(), like.blocks()[b], values);
        else unpack<double>(raw_.data(), count, like.channels(), like.blocks()[b], values);
    }
}

void RowTransfer::write(const std::vector<FieldRows>& lists, const std::vector<double>& values) {
    const Field& like = *lists.front().field;
    const std::size_t count = prepare(lists);
    for (std::size_t b = 0; b < like.blocks().size(); ++b) {
        if (like.real() == Real::single) pack<float>(values, count, like.channels(), like.blocks()[b], raw_.data());
        else pack<double>(values, count, like.channels(), like.blocks()[b], raw_.data());
        context_->write(values_, 0, count * like.row_bytes(b), raw_.data(), "writing rows of a field");
        launch_lists("lcl_scatter_rows", lists, b, false);
    }
}

}  // namespace lcl
