// SPDX-License-Identifier: BSD-3-Clause
#include "tests/oracle/noise.h"

#include <array>
#include <cmath>
#include <string>

namespace oracle {
namespace {

/// The published permutation in hexadecimal, two digits a number.
const std::string digits =
    "97a0895b5a0f830dc95f6035c2e907e18c24671e458e086325f0150a17be0694"
    "f778ea4b001ac53e5efcdbcb75230b2039b12158ed953857ae147d88aba844af"
    "4aa547868b301ba64d929ee7536fe57a3cd385e6dc695c29372ef528f4668f36"
    "41193fa101d85049d14c84bbd05912a9c8c4878274bc9f56a4646dc6adba0340"
    "34d9e2fa7c7b05ca2693767eff5255d4cfce3be32f103a11b6bd1c2adfb7aad5"
    "77f898022c9aa346dd99659ba72bac09811627fd13626c6e4f71e0e8b2b97068"
    "daf661e4fb22f2c1eed2900cbfb3a2f1513391ebf90eef6b31c0d61fb5c76a9d"
    "b854ccb07379322d7f0496fe8aeccd5dde72431d1848f38d80c34e42d73d9cb4";

/// From the centre of a cube to the middles of its edges; the last four repeat a tetrahedron of them.
const int gradients[16][3] = {{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
                              {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};

long permuted(long n) {
    const long place = (n % 256 + 256) % 256;
    return std::stol(digits.substr(2 * static_cast<std::size_t>(place), 2), nullptr, 16);
}

double dot_at_corner(const std::array<long, 3>& corner, const double (&point)[3]) {
    const long hash = permuted(permuted(permuted(corner[0]) + corner[1]) + corner[2]);
    double dot = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) dot += gradients[hash % 16][axis] * (point[axis] - static_cast<double>(corner[axis]));
    return dot;
}

double fade(double t) { return 6 * std::pow(t, 5) - 15 * std::pow(t, 4) + 10 * std::pow(t, 3); }

}  // namespace

double improved_noise(double x, double y, double z) {
    const double point[3] = {x, y, z};
    const long cell[3] = {std::lround(std::floor(x)), std::lround(std::floor(y)), std::lround(std::floor(z))};
    double value = 0;
    for (long dx = 0; dx < 2; ++dx)
        for (long dy = 0; dy < 2; ++dy)
            for (long dz = 0; dz < 2; ++dz) {
                const double s = fade(x - static_cast<double>(cell[0])), t = fade(y - static_cast<double>(cell[1])), r = fade(z - static_cast<double>(cell[2]));
                value += (dx ? s : 1 - s) * (dy ? t : 1 - t) * (dz ? r : 1 - r) * dot_at_corner({cell[0] + dx, cell[1] + dy, cell[2] + dz}, point);
            }
    return value;
}

}  // namespace oracle
