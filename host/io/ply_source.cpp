// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/ply_source.h"

#include <algorithm>

namespace lcl {
namespace {

/// Bytes of a row; 0 where its lists say it.
std::size_t fixed_row_size(const PlyElement& element) {
    std::size_t size = 0;
    for (const PlyProperty& property : element.properties) {
        if (property.is_list) return 0;
        size += size_of(property.scalar);
    }
    return size;
}

}  // namespace

std::vector<RowRange<AsciiSource>> AsciiSource::cut(const PlyElement& element, const Splitting& splitting) {
    const std::size_t parts = splitting.parts_of(scan_.remaining());
    if (!cuts_) cuts_ = count_lines({scan_.at(), scan_.remaining()}, 0, {std::max<std::size_t>(1, splitting.smallest_part / 16), 16 * parts, 0});
    std::vector<RowRange<AsciiSource>> ranges;
    ranges.push_back({0, element.count, AsciiSource(scan_)});
    for (const LineCut& line : *cuts_) {
        const bool is_here = line.number > row_ && line.number - row_ < element.count;
        if (!is_here || line.number - row_ < element.count / parts * ranges.size()) continue;  // ranges of about the same size
        ranges.back().last = line.number - row_;
        ranges.push_back({line.number - row_, element.count, AsciiSource(scan_)});
        ranges.back().source.scan_.move_to(line.place);
    }
    row_ += element.count;
    return ranges;
}

void BinarySource::skip_row(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
        const std::int64_t length = property.is_list ? integer(property.count_scalar) : 1;
        const std::size_t size = size_of(property.scalar);
        if (length < 0 || static_cast<std::uint64_t>(length) > remaining() / size) fail("a row does not fit");
        at_ += static_cast<std::size_t>(length) * size;
    }
}

std::vector<RowRange<BinarySource>> BinarySource::cut(const PlyElement& element, const Splitting& splitting) const {
    const std::vector<RowRange<BinarySource>> whole{{0, element.count, *this}};
    const std::size_t count = splitting.parts_of(std::min(remaining(), element.count * 8));
    if (count == 1) return whole;
    const std::size_t row_size = fixed_row_size(element);
    std::vector<RowRange<BinarySource>> ranges;
    BinarySource at = *this;
    try {
        for (std::size_t i = 0, row = 0; i < count; ++i) {
            const std::size_t last = element.count / count * (i + 1) + element.count % count * (i + 1) / count;
            ranges.push_back({row, last, at});
            if (row_size > 0) at.at_ += std::min((last - row) * row_size, at.remaining()), row = last;
            for (; row < last; ++row) at.skip_row(element);
        }
    } catch (const BadInput&) {  // what is wrong is said where it is read
        return whole;
    }
    return ranges;
}

}  // namespace lcl
