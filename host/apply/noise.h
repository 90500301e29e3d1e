// SPDX-License-Identifier: BSD-3-Clause
// Octaves of improved Perlin noise (Perlin, "Improving Noise", SIGGRAPH 2002) at points.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "host/field/field.h"

namespace lcl {

constexpr int most_octaves = 20;

/// From model units to the noise's own: p = scale (x - centre) + offset.
struct NoiseFrame {
    std::array<double, 3> centre{}, offset{};
    double scale = 1;
};

/// The offset of a seed, from 0 to 256 along each axis; the same on every machine. The noise is 0 at integer points, where all vertices of a regular mesh can
/// lie at once, so no offset may be near one, nor 2^i times the offset, which octave i sees. Binary digits after the point are chosen by hashing the seed, but
/// never three equal ones in a row: 2^i offset stays 1/7 (0.001001..) away from whole numbers in all octaves.
std::array<double, 3> noise_offset(std::uint32_t seed);

/// f(2^octave p_v) / 2^octave at every point v of `positions` (count x 3, model units), computed on the device in double where `real` asks for it and the
/// device has it, else in float. Device memory does not grow with the points. Unsupported: Real::full on a device without double precision.
std::vector<double> noise_octave(const std::shared_ptr<Context>& context, const NoiseFrame& frame, const std::vector<double>& positions, int octave, Real real);

/// f(q) in plain double on the host: what the kernel is held against.
double improved_noise(const std::array<double, 3>& q);

}  // namespace lcl
