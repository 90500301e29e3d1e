// SPDX-License-Identifier: BSD-3-Clause
// n x c values on a device, in a plan's order and normalised.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "host/device/device.h"
#include "host/field/channels.h"

namespace lcl {

/// Number type of a field on the device.
enum class Real : std::uint8_t {
    single,  ///< float
    wide,    ///< the exact half of mixed precision: double where the device has it, else pairs of floats (48 bits)
    full     ///< double; refused without double precision
};

enum class RowFormat : std::uint8_t {
    floats,
    doubles,
    pairs  ///< a row of floats, then what they leave of the doubles
};

/// Rows are in the plan's order; the values are normalised by the caller's Transform.
class Field {
public:
    /// Allocates; values are undefined. OutOfMemory with the numbers; Unsupported for Real::full without double precision.
    Field(std::shared_ptr<Context> context, Index rows, int channels, Real real);

    Index rows() const { return rows_; }
    int channels() const { return channels_; }
    Real real() const { return real_; }
    const std::vector<ChannelBlock>& blocks() const { return blocks_; }
    Buffer& buffer(std::size_t block) { return buffers_[block]; }
    const Buffer& buffer(std::size_t block) const { return buffers_[block]; }
    std::size_t row_bytes(std::size_t block) const;

    /// How rows lie in the buffers.
    RowFormat format() const;

    enum class Way : std::uint8_t {
        mapped,  ///< the host works in the buffer itself: on CPUs
        staged   ///< through memory of the host, piece by piece, one piece being converted while another travels
    };
    /// fill(block, begin, rows, out) writes rows [first + begin, first + begin + rows) of a block as format() and row_bytes() have them.
    using Fill = std::function<void(std::size_t block, std::size_t begin, std::size_t rows, void* out)>;
    using Take = std::function<void(std::size_t block, std::size_t begin, std::size_t rows, const void* in)>;
    /// Rows [first, first + count) of all blocks, by the way that suits the device unless one is given. Waits.
    void write(Index first, Index count, const Fill& fill, std::optional<Way> way = {});
    void read(Index first, Index count, const Take& take, std::optional<Way> way = {}) const;

    /// Rows [first, first + count) from and to normalised doubles in the plan's order, `values` pointing at row `first`: count x channels.
    void upload(const double* values, Index first, Index count);
    void download(double* values, Index first, Index count) const;
    /// Copies all rows of a field of the same shape and type, on the device.
    void copy_from(const Field& other);
    void fill_zero();
    Context& context() const { return *context_; }

private:
    Way best_way() const;
    void write_staged(Index first, Index count, const Fill& fill);
    void read_staged(Index first, Index count, const Take& take) const;

    std::shared_ptr<Context> context_;
    Index rows_ = 0;
    int channels_ = 0;
    Real real_ = Real::single;
    std::vector<ChannelBlock> blocks_;
    std::vector<Buffer> buffers_;
};

/// Build options of kernels on rows of this type and width: "-D LCL_REAL=float -D LCL_WIDTH=4 ...". group: work-items that sweep a block.
std::string kernel_options(const Context& context, Real real, int width, int group);

}  // namespace lcl
