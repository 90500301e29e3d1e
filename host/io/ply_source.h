// SPDX-License-Identifier: BSD-3-Clause
// The values of a PLY file's body, one after the other, and where its rows can be cut so that they are read at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "host/io/format.h"
#include "host/io/number_write.h"
#include "host/io/ply_types.h"
#include "host/io/text_scan.h"

namespace lcl {

struct PlyProperty {
    std::string name;
    Scalar scalar = Scalar::float64;
    bool is_list = false;
    Scalar count_scalar = Scalar::uint8;
    std::string type_name;
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
    const char* place = nullptr;  // its line in the header
};

/// Rows of an element, and the source that stands before the first of them.
template <class Source>
struct RowRange {
    std::size_t first, last;
    Source source;
};

/// Values of an ASCII body, row by row.
class AsciiSource {
public:
    explicit AsciiSource(const TextScanner& scan) : scan_(scan) {}

    /// The next element's rows in ranges that can be read at once. A row is a line, so that its number is known where lines are counted.
    std::vector<RowRange<AsciiSource>> cut(const PlyElement& element, const Splitting& splitting);
    void move_behind(const AsciiSource& read) { scan_.move_to(read.scan_.at()); }

    void begin_row() { scan_.skip_space(); }

    double scalar(Scalar) {
        scan_.skip_blanks();
        return scan_.number("a value");
    }

    std::int64_t integer(Scalar scalar) {
        scan_.skip_blanks();
        return is_floating(scalar) ? whole(scan_.number("an index")) : scan_.integer("an index or the length of a list");
    }

    bool take_indices(Scalar, std::size_t, std::vector<Index>&) const { return false; }

    void end_row() {
        scan_.skip_blanks();
        if (!scan_.at_line_end()) fail("the row has more values than the header announces; correct the header or the row");
        scan_.skip_line();
    }

    std::size_t least_size(Scalar) const { return 2; }               // "0 "
    std::size_t remaining() const { return scan_.remaining() + 1; }  // the last line may lack its end
    [[noreturn]] void fail(const std::string& sentence) const { scan_.fail(scan_.at(), sentence); }

private:
    std::int64_t whole(double value) const {
        if (!(std::fabs(value) < 9e15) || value != std::floor(value)) fail("an index is no whole number");
        return static_cast<std::int64_t>(value);
    }

    TextScanner scan_;
    std::optional<std::vector<LineCut>> cuts_;  // of the whole body, made when they are needed first
    std::size_t row_ = 0;                       // of the body, which the next element begins with
};

/// Values of a binary body.
class BinarySource {
public:
    BinarySource(const InputBytes& input, const char* at, bool swap) : input_(&input), at_(at), end_(input.data + input.size), swap_(swap) {}

    /// The next element's rows in ranges that can be read at once.
    std::vector<RowRange<BinarySource>> cut(const PlyElement& element, const Splitting& splitting) const;
    void move_behind(const BinarySource& read) { at_ = read.at_; }

    void begin_row() const {}
    void end_row() const {}

    double scalar(Scalar scalar) {
        switch (scalar) {
            case Scalar::int8: return take<std::int8_t>();
            case Scalar::uint8: return take<std::uint8_t>();
            case Scalar::int16: return take<std::int16_t>();
            case Scalar::uint16: return take<std::uint16_t>();
            case Scalar::int32: return take<std::int32_t>();
            case Scalar::uint32: return take<std::uint32_t>();
            case Scalar::float32: return static_cast<double>(take<float>());
            case Scalar::float64: break;
        }
        return take<double>();
    }

    std::int64_t integer(Scalar scalar_type) {
        switch (scalar_type) {
            case Scalar::uint8: return take<std::uint8_t>();
            case Scalar::int32: return take<std::int32_t>();
            case Scalar::uint32: return take<std::uint32_t>();
            default: break;
        }
        const double value = scalar(scalar_type);
        if (!(std::fabs(value) < 9e15) || value != std::floor(value)) fail("an index is no whole number");
        return static_cast<std::int64_t>(value);
    }

    /// Appends indices that lie here as they do in memory; false if they do not.
    bool take_indices(Scalar scalar, std::size_t count, std::vector<Index>& indices) {
        if (scalar != Scalar::int32 || swap_ || remaining() / sizeof(Index) < count) return false;
        const std::size_t size = indices.size();
        indices.resize(size + count);
        if (count > 0) std::memcpy(&indices[size], at_, count * sizeof(Index));
        at_ += count * sizeof(Index);
        return true;
    }

    std::size_t least_size(Scalar scalar) const { return size_of(scalar); }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
    [[noreturn]] void fail(const std::string& sentence) const {
        throw BadInput(input_->name + ": " + sentence + " (byte " + std::to_string(at_ - input_->data) + ")");
    }

private:
    void skip_row(const PlyElement& element);

    template <class T>
    T take() {
        T value;
        if (remaining() < sizeof(T)) fail("the file ends within its binary data");
        std::memcpy(&value, at_, sizeof(T));
        at_ += sizeof(T);
        return swap_ ? swap_bytes(value) : value;
    }

    const InputBytes* input_;
    const char *at_, *end_;
    bool swap_;
};

}  // namespace lcl
