// SPDX-License-Identifier: BSD-3-Clause
// The eigenstructure of a kind of patch.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "host/evaluate/patch_kind.h"

namespace lcl {

/// step^m C = sum over j of values[j]^m m^powers[j] (mode j) (projection row j) C, for every m >= 0 (0^0 = 1). Mode 0 is the constant: value 1, its projection
/// the limit mask of the extraordinary point; the modes that follow have values in descending order.
/// powers[j] is 1 in the chains of length two of the defective families (Loop, valence 3, eigenvalue 1/16; classic Doo-Sabin, 5 or more sides, 1/4), else 0.
struct Modes {
    Eigen::VectorXd values;                ///< M >= K
    std::vector<std::uint8_t> powers;      ///< M
    Eigen::MatrixXd projection;            ///< M x K
    std::array<Eigen::MatrixXd, 3> cells;  ///< each R x M: the modes as control points of cell k. Column 0 is exactly 1
    int count() const { return static_cast<int>(values.size()); }
};

/// By turns of the orbits (discrete Fourier transform) into small blocks, whose eigenvectors are carried on to the outer points; verified against what powers
/// of `step` make of scattered control points, to 1e-12 of the largest, for m up to 30. Nothing where the kind has no orbits, or where the verification fails
/// (a defective family that is not known): its powers serve then. Quadratic in the valence: about 1 ms for 50.
std::optional<Modes> find_modes(const PatchKind& kind);

/// The same, found once a process for kinds with the same matrices; null where there are none. Thread-safe.
std::shared_ptr<const Modes> modes_of(const PatchKind& kind);

}  // namespace lcl
