// SPDX-License-Identifier: BSD-3-Clause
// Numbers as the shortest text that reads back the same, or as bytes in either order, collected in a large buffer.
#pragma once

#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

#include "host/io/format.h"

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

/// Collects output and passes it on in large pieces. Call flush() at the end; the destructor does not, as it could not report a failure.
class OutputBuffer {
public:
    explicit OutputBuffer(ByteSink& sink) : sink_(sink), bytes_(new char[capacity]) {}

    void flush() {
        sink_.write(bytes_.get(), size_);
        size_ = 0;
    }

    void character(char c) { *room(1) = c, ++size_; }

    void text(std::string_view text) {
        if (text.size() > capacity / 2) {
            flush();
            sink_.write(text.data(), text.size());
            return;
        }
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
    static constexpr std::size_t capacity = std::size_t(1) << 20;

    char* room(std::size_t size) {
        if (capacity - size_ < size) flush();
        return bytes_.get() + size_;
    }

    ByteSink& sink_;
    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0;
};

}  // namespace lcl
