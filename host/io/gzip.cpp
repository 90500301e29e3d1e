// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/gzip.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>

#include <zlib.h>

namespace lcl {
namespace {

constexpr int gzip_window = 15 + 16;  // zlib: the largest window, gzip framing
constexpr std::size_t largest_step = std::numeric_limits<uInt>::max() / 2;

Bytef* zlib_bytes(const char* bytes) { return reinterpret_cast<Bytef*>(const_cast<char*>(bytes)); }

struct Inflater {
    Inflater() {
        if (inflateInit2(&stream, gzip_window) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() { inflateEnd(&stream); }
    z_stream stream{};
};

/// The length of the unpacked text as the last four bytes tell it, which is right for one member below 4 GiB; bounded by what deflate can pack (1032 : 1).
std::size_t expected_size(const char* bytes, std::size_t size) {
    std::uint32_t told = 0;
    if (size >= 18) std::memcpy(&told, bytes + size - 4, 4);
    return std::min<std::size_t>(told, size * 1032) + 64;
}

void make_room(OwnedBytes& bytes, std::size_t& capacity) {
    if (bytes.size < capacity) return;
    std::unique_ptr<char[]> larger(new char[capacity * 2]);
    std::memcpy(larger.get(), bytes.data.get(), bytes.size);
    bytes.data = std::move(larger);
    capacity *= 2;
}

}  // namespace

bool is_gzip(const char* bytes, std::size_t size) {
    return size >= 2 && static_cast<unsigned char>(bytes[0]) == 0x1f && static_cast<unsigned char>(bytes[1]) == 0x8b;
}

OwnedBytes unpack_gzip(const char* bytes, std::size_t size, const std::string& name) {
    Inflater inflater;
    z_stream& stream = inflater.stream;
    std::size_t capacity = expected_size(bytes, size);
    OwnedBytes result{std::unique_ptr<char[]>(new char[capacity]), 0};
    std::size_t used = 0;
    for (;;) {
        make_room(result, capacity);
        const std::size_t input_step = std::min(size - used, largest_step), output_step = std::min(capacity - result.size, largest_step);
        stream.next_in = zlib_bytes(bytes) + used;
        stream.avail_in = static_cast<uInt>(input_step);
        stream.next_out = zlib_bytes(result.data.get()) + result.size;
        stream.avail_out = static_cast<uInt>(output_step);
        const int status = inflate(&stream, Z_NO_FLUSH);
        used += input_step - stream.avail_in;
        result.size += output_step - stream.avail_out;
        if (status == Z_MEM_ERROR) throw std::bad_alloc();
        if (status == Z_STREAM_END) {
            // Padding and other bytes behind the last member are ignored, as gzip does.
            if (!is_gzip(bytes + used, size - used)) return result;
            inflateReset(&stream);
        } else if (status == Z_BUF_ERROR && used == size) {
            throw BadInput(name + ": the gzip data ends too early (after " + std::to_string(size) + " bytes); copy or pack the file again");
        } else if (status != Z_OK && status != Z_BUF_ERROR) {
            throw BadInput(name + ": the gzip data is damaged near byte " + std::to_string(used) + "; copy or pack the file again");
        }
    }
}

struct GzipSink::State {
    z_stream stream{};
    char output[65536];
};

GzipSink::GzipSink(ByteSink& target) : state_(new State), target_(target) {
    if (deflateInit2(&state_->stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
}

GzipSink::~GzipSink() { deflateEnd(&state_->stream); }

void GzipSink::write(const char* bytes, std::size_t size) {
    while (size > 0) {
        const std::size_t step = std::min(size, largest_step);
        state_->stream.next_in = zlib_bytes(bytes);
        state_->stream.avail_in = static_cast<uInt>(step);
        pack(Z_NO_FLUSH);
        bytes += step;
        size -= step;
    }
}

void GzipSink::finish() {
    state_->stream.avail_in = 0;
    pack(Z_FINISH);
}

void GzipSink::pack(int flush) {
    z_stream& stream = state_->stream;
    do {
        stream.next_out = zlib_bytes(state_->output);
        stream.avail_out = sizeof(state_->output);
        deflate(&stream, flush);
        target_.write(state_->output, sizeof(state_->output) - stream.avail_out);
    } while (stream.avail_out == 0);
}

}  // namespace lcl
