// SPDX-License-Identifier: BSD-3-Clause
// The scalar types of PLY.
#pragma once

#include <cstddef>
#include <string_view>

namespace lcl {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct ScalarName {
    const char* name;
    Scalar scalar;
};

inline constexpr ScalarName scalar_names[] = {
    {"char", Scalar::int8},     {"int8", Scalar::int8},       {"uchar", Scalar::uint8},    {"uint8", Scalar::uint8},
    {"short", Scalar::int16},   {"int16", Scalar::int16},     {"ushort", Scalar::uint16},  {"uint16", Scalar::uint16},
    {"int", Scalar::int32},     {"int32", Scalar::int32},     {"uint", Scalar::uint32},    {"uint32", Scalar::uint32},
    {"float", Scalar::float32}, {"float32", Scalar::float32}, {"double", Scalar::float64}, {"float64", Scalar::float64}};

/// Null if there is no such type.
inline const ScalarName* find_scalar(std::string_view name) {
    for (const ScalarName& row : scalar_names)
        if (name == row.name) return &row;
    return nullptr;
}

inline std::size_t size_of(Scalar scalar) {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<int>(scalar)];
}

inline bool is_floating(Scalar scalar) { return scalar == Scalar::float32 || scalar == Scalar::float64; }

}  // namespace lcl
