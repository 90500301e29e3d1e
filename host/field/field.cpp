// SPDX-License-Identifier: BSD-3-Clause
#include "host/field/field.h"

#include <array>
#include <string>

#include "host/parallel.h"

namespace lcl {
namespace {

constexpr std::size_t piece_rows = 131072;  // what one transfer carries while the next is converted

void split(double value, float& high, float& low) {
    high = static_cast<float>(value);
    low = static_cast<float>(value - high);
}

/// Waits for its events when it goes, so that memory declared before outlives transfers also when something throws.
struct Travelling {
    std::array<Event, 2> events;
    ~Travelling() {
        for (const Event& event : events) try {
                event.wait();
            } catch (...) {  // it has ended, which is all that matters here
            }
    }
};

}  // namespace

Field::Field(std::shared_ptr<Context> context, Index rows, int channels, Real real)
    : context_(std::move(context)), rows_(rows), channels_(channels), real_(real), blocks_(channel_blocks(channels)) {
    if (real == Real::full && !context_->device().has_double)
        throw Unsupported("double precision was asked for, and " + context_->device().name +
                          " has none: use mixed precision, which reaches the same tolerances");
    for (std::size_t b = 0; b < blocks_.size(); ++b)
        buffers_.emplace_back(context_, std::max<std::size_t>(1, rows_) * row_bytes(b),
                              "a field of " + std::to_string(rows) + " rows and " + std::to_string(blocks_[b].count) + " channels");
}

std::size_t Field::row_bytes(std::size_t block) const { return blocks_[block].width * (real_ == Real::single ? sizeof(float) : sizeof(double)); }

void Field::pack(const double* values, std::size_t count, std::size_t block, void* out) const {
    const ChannelBlock& b = blocks_[block];
    parallel_for(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (int c = 0; c < b.width; ++c) {
                const double value = c < b.count ? values[i * channels_ + b.first + c] : 0.0;
                if (real_ == Real::single) static_cast<float*>(out)[i * b.width + c] = static_cast<float>(value);
                else if (!is_pair()) static_cast<double*>(out)[i * b.width + c] = value;
                else split(value, static_cast<float*>(out)[i * 2 * b.width + c], static_cast<float*>(out)[(i * 2 + 1) * b.width + c]);
            }
    });
}

void Field::unpack(const void* in, std::size_t count, std::size_t block, double* values) const {
    const ChannelBlock& b = blocks_[block];
    parallel_for(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (int c = 0; c < b.count; ++c) {
                double& value = values[i * channels_ + b.first + c];
                if (real_ == Real::single) value = static_cast<const float*>(in)[i * b.width + c];
                else if (!is_pair()) value = static_cast<const double*>(in)[i * b.width + c];
                else value = static_cast<double>(static_cast<const float*>(in)[i * 2 * b.width + c]) + static_cast<const float*>(in)[(i * 2 + 1) * b.width + c];
            }
    });
}

void Field::upload(const double* values, Index first, Index count) {
    std::array<std::vector<unsigned char>, 2> staging;
    Travelling travelling;
    const Event before = context_->marker();
    int turn = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b)
        for (std::size_t begin = 0; begin < static_cast<std::size_t>(count); begin += piece_rows, turn ^= 1) {
            const std::size_t rows = std::min(piece_rows, count - begin);
            travelling.events[turn].wait();
            staging[turn].resize(rows * row_bytes(b));
            pack(values + begin * channels_, rows, b, staging[turn].data());
            travelling.events[turn] =
                context_->write_async(buffers_[b], (first + begin) * row_bytes(b), rows * row_bytes(b), staging[turn].data(), before, "uploading a field");
        }
    for (const Event& event : travelling.events) event.wait();
}

void Field::download(double* values, Index first, Index count) const {
    std::array<std::vector<unsigned char>, 2> staging;
    Travelling travelling;
    struct Piece {
        std::size_t block, begin, rows;
    };
    std::array<Piece, 2> pieces{};
    const Event before = context_->marker();
    const auto finish = [&](int turn) {
        if (pieces[turn].rows == 0) return;
        travelling.events[turn].wait();
        unpack(staging[turn].data(), pieces[turn].rows, pieces[turn].block, values + pieces[turn].begin * channels_);
    };
    int turn = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b)
        for (std::size_t begin = 0; begin < static_cast<std::size_t>(count); begin += piece_rows, turn ^= 1) {
            finish(turn);
            const std::size_t rows = std::min(piece_rows, count - begin);
            staging[turn].resize(rows * row_bytes(b));
            travelling.events[turn] =
                context_->read_async(buffers_[b], (first + begin) * row_bytes(b), rows * row_bytes(b), staging[turn].data(), before, "downloading a field");
            pieces[turn] = {b, begin, rows};
        }
    finish(turn);
    finish(turn ^ 1);
}

void Field::copy_from(const Field& other) {
    for (std::size_t b = 0; b < blocks_.size(); ++b) context_->copy(other.buffers_[b], 0, buffers_[b], 0, rows_ * row_bytes(b), "copying a field");
}

void Field::fill_zero() {
    for (const Buffer& buffer : buffers_) context_->fill_zero(buffer, "clearing a field");
}

std::string kernel_options(const Context& context, Real real, int width, int group) {
    const bool has_double = context.device().has_double;
    const bool is_double = real == Real::full || (real == Real::wide && has_double);
    std::string options =
        std::string("-D LCL_REAL=") + (is_double ? "double" : "float") + " -D LCL_WIDTH=" + std::to_string(width) + " -D LCL_GROUP=" + std::to_string(group);
    if (has_double) options += " -D LCL_HAS_DOUBLE";
    if (real == Real::wide && !has_double) options += " -D LCL_PAIR";
    return options;
}

}  // namespace lcl
