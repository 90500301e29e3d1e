// SPDX-License-Identifier: BSD-3-Clause
// Numbers as the shortest text that reads back the same, or as bytes in either order, collected in a buffer; rows of them by all cores.
#pragma once

#include <atomic>
#include <charconv>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <string_view>

#include "host/io/format.h"
#include "host/parallel.h"

namespace lcl {

/// `T`'s bytes turned round.
template <class T>
T swap_bytes(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

/// Collects output until it is passed on.
class OutputBuffer {
public:
    void pass_on(ByteSink& sink) {
        sink.write(bytes_.get(), size_);
        size_ = 0;
    }

    void character(char c) { *room(1) = c, ++size_; }

    void text(std::string_view text) {
        std::memcpy(room(text.size()), text.data(), text.size());
        size_ += text.size();
    }

    /// Shortest text of an integer, float or double.
    template <class Number>
    void number(Number value) {
        char* first = room(40);
        size_ += static_cast<std::size_t>(std::to_chars(first, first + 40, value).ptr - first);
    }

    /// The value's own bytes, turned round if `swap`.
    template <class T>
    void raw(T value, bool swap = false) {
        if (swap) value = swap_bytes(value);
        std::memcpy(room(sizeof(T)), &value, sizeof(T));
        size_ += sizeof(T);
    }

private:
    char* room(std::size_t size) {
        if (capacity_ - size_ < size) grow(size);
        return bytes_.get() + size_;
    }

    void grow(std::size_t size) {
        capacity_ = std::max<std::size_t>(2 * capacity_ + size, 4096);
        std::unique_ptr<char[]> larger(new char[capacity_]);
        if (size_ > 0) std::memcpy(larger.get(), bytes_.get(), size_);
        bytes_ = std::move(larger);
    }

    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0, capacity_ = 0;
};

/// Lets pieces that are made at once pass one after the other, in the order of their numbers.
class Turns {
public:
    /// Waits for the turn of `piece` and calls `pass`; false, and nothing is done, if another piece has failed.
    template <class Pass>
    bool take(std::size_t piece, const Pass& pass) {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] { return turn_ == piece || failed_; });
        if (failed_) return false;
        lock.unlock();
        pass();
        lock.lock();
        ++turn_;
        changed_.notify_all();
        return true;
    }

    void fail() {
        const std::lock_guard<std::mutex> lock(mutex_);
        failed_ = true;
        changed_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t turn_ = 0;
    bool failed_ = false;
};

/// Calls write_row(buffer, row) for the rows from 0 to count - 1, pieces of them on all cores at once, and passes the buffers on in the order of the rows.
template <class WriteRow>
void write_rows(ByteSink& sink, std::size_t count, const WriteRow& write_row) {
    constexpr std::size_t piece_rows = 4096;
    const std::size_t pieces = (count + piece_rows - 1) / piece_rows;
    std::atomic<std::size_t> next{0};
    Turns turns;
    const auto work = [&] {
        OutputBuffer out;
        for (std::size_t piece = next++; piece < pieces; piece = next++) {
            for (std::size_t row = piece * piece_rows; row < std::min(count, (piece + 1) * piece_rows); ++row) write_row(out, row);
            if (!turns.take(piece, [&] { out.pass_on(sink); })) return;
        }
    };
    const auto work_or_fail = [&](std::size_t, std::size_t) {
        try {
            work();
        } catch (...) {
            turns.fail();
            throw;
        }
    };
    parallel_for(std::min<std::size_t>(pieces, std::max(1u, std::thread::hardware_concurrency())), work_or_fail, 1);
}

}  // namespace lcl
