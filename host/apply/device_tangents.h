// SPDX-License-Identifier: BSD-3-Clause
// Limit normals and tangents on a device.
#pragma once

#include <map>

#include "host/apply/device_operator.h"
#include "host/operator/tangent_plan.h"

namespace lcl {

/// A tangent plan's arrays beside those of an operator, which has to outlive this. Fields: three channels, of the operator, of one type; all calls return at
/// once but read_sides.
class DeviceTangents {
public:
    DeviceTangents(DeviceOperator& A, TangentPlan&& plan);

    const TangentPlan& plan() const { return plan_; }
    /// y = A x (where y is not null) and the unit normals of all rows, in one pass over smooth rings, and a launch for the other rows. x: scaled alike in all
    /// channels.
    void normals(const Field& x, Field* y, Field& normals);
    /// Orthonormal frames: normals, tangents, and normal x tangent.
    void frames(const Field& x, Field& normals, Field& tangents, Field& bitangents);
    /// Waits; the normals of the sides that the last call found: side_count x 3; 0 before any.
    std::vector<double> read_sides() const;

private:
    struct Weights {
        Buffer turns, stored;
    };
    const Weights& weights(Real real);
    Buffer upload(const void* data, std::size_t bytes, const char* what) const;
    template <class... Fields>
    void launch_sectors(const char* name, const Field& x, const Fields&... fields);

    DeviceOperator& A_;
    TangentPlan plan_;
    Buffer run_turns_, rows_, sector_offsets_, entry_offsets_, columns_;
    std::map<Real, Weights> weights_;
    std::optional<Field> sides_;  // of the last call
};

}  // namespace lcl
