// SPDX-License-Identifier: BSD-3-Clause
// n x c values on a device, in a plan's order and normalised.
#pragma once

#include <memory>
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

    /// Rows [first, first + count) from and to normalised doubles in the plan's order, `values` pointing at row `first`: count x channels. Large uploads
    /// convert one piece while the piece before travels.
    void upload(const double* values, Index first, Index count);
    void download(double* values, Index first, Index count) const;
    /// Copies all rows of a field of the same shape and type, on the device.
    void copy_from(const Field& other);
    void fill_zero();
    Context& context() const { return *context_; }

private:
    bool is_pair() const { return real_ == Real::wide && !context_->device().has_double; }
    void pack(const double* values, std::size_t count, std::size_t block, void* out) const;
    void unpack(const void* in, std::size_t count, std::size_t block, double* values) const;

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
