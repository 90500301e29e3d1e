// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/noise.h"

#include <algorithm>
#include <cmath>

#include "host/parallel.h"
#include "kernels/noise.cl.h"

namespace lcl {
namespace {

constexpr std::uint8_t permutation[256] = {LCL_PERMUTATION};
constexpr std::size_t piece_points = 262144;  // what one launch computes: 10 MB on the device
constexpr std::size_t largest_group = 64;
constexpr int offset_digits = 44;  // after the point, eight before it: a double holds them with a bit to spare

/// SplitMix64 (Steele, Lea & Flood 2014): well mixed bits from neighbouring seeds.
std::uint64_t next_bits(std::uint64_t& state) {
    state += 0x9E3779B97F4A7C15u;
    std::uint64_t bits = state;
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
    return bits ^ (bits >> 31);
}

/// Points on their way to the kernel.
template <class Number>
struct Piece {
    std::vector<cl_uchar4> cells;
    std::vector<Number> fractions, values;

    explicit Piece(std::size_t points) : cells(points), fractions(3 * points), values(points) {}

    /// The point at `position` in units of the octave, taken apart in double.
    void set(std::size_t i, const NoiseFrame& frame, const double* position, int octave) {
        for (int axis = 0; axis < 3; ++axis) {
            const double q = std::ldexp(frame.scale * (position[axis] - frame.centre[axis]) + frame.offset[axis], octave);
            const double low = std::isfinite(q) ? std::floor(q) : 0;  // isolated vertices may be anywhere
            cells[i].s[axis] = static_cast<cl_uchar>(static_cast<int>(std::fmod(low, 256)) & 255);
            fractions[3 * i + axis] = std::isfinite(q) ? static_cast<Number>(q - low) : Number(0);
        }
    }
};

template <class Number>
std::vector<double> evaluate(const std::shared_ptr<Context>& context, cl_kernel kernel, const NoiseFrame& frame, const std::vector<double>& positions,
                             int octave) {
    const std::size_t count = positions.size() / 3, capacity = std::min(count, piece_points);
    const std::size_t local = std::min(largest_group, context->device().max_work_group_size);
    const Buffer cells(context, capacity * sizeof(cl_uchar4), "noise cells"), fractions(context, 3 * capacity * sizeof(Number), "places in noise cells"),
        values(context, capacity * sizeof(Number), "noise values");
    Piece<Number> piece(capacity);
    std::vector<double> out(count);
    for (std::size_t first = 0; first < count; first += capacity) {
        const std::size_t rows = std::min(capacity, count - first);
        parallel_for(rows, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) piece.set(i, frame, &positions[3 * (first + i)], octave);
        });
        context->write(cells, 0, rows * sizeof(cl_uchar4), piece.cells.data(), "uploading noise cells");
        context->write(fractions, 0, 3 * rows * sizeof(Number), piece.fractions.data(), "uploading places in noise cells");
        // f(2^octave p) / 2^octave
        launch(*context, kernel, {(rows + local - 1) / local * local, local}, static_cast<cl_int>(rows), static_cast<cl_int>(octave), cells, fractions, values);
        context->read(values, 0, rows * sizeof(Number), piece.values.data(), "reading noise");
        std::copy_n(piece.values.begin(), rows, out.begin() + static_cast<std::ptrdiff_t>(first));
    }
    return out;
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

std::array<double, 3> noise_offset(std::uint32_t seed) {
    std::array<double, 3> offset{};
    std::uint64_t state = seed;
    for (double& value : offset) {
        std::uint64_t bits = next_bits(state);
        std::uint64_t number = bits & 255;
        for (int digit = 0; digit < offset_digits; ++digit) {
            bits = digit % 32 == 0 ? next_bits(state) : bits >> 1;
            const bool must_change = digit >= 2 && (number & 1) == (number >> 1 & 1);
            number = 2 * number + (must_change ? ~number & 1 : bits & 1);
        }
        value = std::ldexp(static_cast<double>(number), -offset_digits);
    }
    return offset;
}

std::vector<double> noise_octave(const std::shared_ptr<Context>& context, const NoiseFrame& frame, const std::vector<double>& positions, int octave,
                                 Real real) {
    const bool is_double = real != Real::single && context->device().has_double;
    if (real == Real::full && !is_double) throw Unsupported("double precision was asked for, and " + context->device().name + " has none: use mixed precision");
    const cl_kernel kernel = context->kernel("noise", "lcl_noise", kernel_options(*context, is_double ? Real::full : Real::single, 1, 1));
    if (is_double) return evaluate<double>(context, kernel, frame, positions, octave);
    return evaluate<float>(context, kernel, frame, positions, octave);
}

double improved_noise(const std::array<double, 3>& q) {
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double from_corner[3], weight = 1;
        unsigned hash = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double lattice = std::floor(q[axis]) + (corner >> axis & 1);
            from_corner[axis] = q[axis] - lattice;
            weight *= 1 - fade(std::fabs(from_corner[axis]));
            hash = permutation[(hash + static_cast<unsigned>(std::fmod(lattice, 256) + 256)) & 255];
        }
        // The middles of the edges: signs of two coordinates, which are x and y, x and z or y and z; the last four of sixteen repeat some of them.
        const unsigned gradient = hash & 15;
        const int first = gradient < 8 ? 0 : 1, second = gradient < 4 ? 1 : gradient == 12 || gradient == 14 ? 0 : 2;
        sum += weight * ((gradient & 1 ? -from_corner[first] : from_corner[first]) + (gradient & 2 ? -from_corner[second] : from_corner[second]));
    }
    return sum;
}

}  // namespace lcl
