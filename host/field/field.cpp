// SPDX-License-Identifier: BSD-3-Clause
#include "host/field/field.h"

#include <array>
#include <string>

#include "host/field/row_format.h"

namespace lcl {
namespace {

constexpr std::size_t piece_rows = 131072;  // what one transfer carries while the next is converted

/// One stretch of a block's rows on its way to the host.
struct Piece {
    std::size_t block = 0, begin = 0, rows = 0;
};

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

RowFormat Field::format() const {
    if (real_ == Real::single) return RowFormat::floats;
    return real_ == Real::wide && !context_->device().has_double ? RowFormat::pairs : RowFormat::doubles;
}

Field::Way Field::best_way() const { return context_->device().is_cpu ? Way::mapped : Way::staged; }

void Field::write(Index first, Index count, const Fill& fill, std::optional<Way> way) {
    if (way.value_or(best_way()) == Way::staged) return write_staged(first, count, fill);
    const Event before = context_->marker();
    for (std::size_t b = 0; count > 0 && b < blocks_.size(); ++b) {
        Mapping mapping = context_->map(buffers_[b], first * row_bytes(b), count * row_bytes(b), true, before, "uploading a field");
        fill(b, 0, count, mapping.data());
        mapping.unmap("uploading a field");
    }
}

void Field::read(Index first, Index count, const Take& take, std::optional<Way> way) const {
    if (way.value_or(best_way()) == Way::staged) return read_staged(first, count, take);
    const Event before = context_->marker();
    for (std::size_t b = 0; count > 0 && b < blocks_.size(); ++b) {
        Mapping mapping = context_->map(buffers_[b], first * row_bytes(b), count * row_bytes(b), false, before, "downloading a field");
        take(b, 0, count, mapping.data());
        mapping.unmap("downloading a field");
    }
}

void Field::write_staged(Index first, Index count, const Fill& fill) {
    std::array<Array<unsigned char>, 2> staging;
    Travelling travelling;
    const Event before = context_->marker();
    int turn = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b)
        for (std::size_t begin = 0; begin < static_cast<std::size_t>(count); begin += piece_rows, turn ^= 1) {
            const std::size_t rows = std::min(piece_rows, count - begin);
            travelling.events[turn].wait();
            staging[turn].resize(rows * row_bytes(b));
            fill(b, begin, rows, staging[turn].data());
            travelling.events[turn] =
                context_->write_async(buffers_[b], (first + begin) * row_bytes(b), rows * row_bytes(b), staging[turn].data(), before, "uploading a field");
        }
    for (const Event& event : travelling.events) event.wait();
}

void Field::read_staged(Index first, Index count, const Take& take) const {
    std::array<Array<unsigned char>, 2> staging;
    Travelling travelling;
    std::array<Piece, 2> pieces{};
    const Event before = context_->marker();
    const auto finish = [&](int turn) {
        if (pieces[turn].rows == 0) return;
        travelling.events[turn].wait();
        take(pieces[turn].block, pieces[turn].begin, pieces[turn].rows, staging[turn].data());
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

void Field::upload(const double* values, Index first, Index count) {
    write(first, count, [&](std::size_t b, std::size_t begin, std::size_t rows, void* out) {
        const double* const from = values + begin * channels_ + blocks_[b].first;
        pack_rows(format(), blocks_[b], rows, out, [&](std::size_t i, int c) { return from[i * channels_ + c]; });
    });
}

void Field::download(double* values, Index first, Index count) const {
    read(first, count, [&](std::size_t b, std::size_t begin, std::size_t rows, const void* in) {
        double* const to = values + begin * channels_ + blocks_[b].first;
        unpack_rows(format(), blocks_[b], rows, in, [&](std::size_t i, int c, double value) { to[i * channels_ + c] = value; });
    });
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
