// SPDX-License-Identifier: BSD-3-Clause
// Calls an engine: a polyhedral approximation of a point cloud.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <limitcl/limitcl_engine.h>

#include "host/mesh/point_cloud.h"
#include "host/points/mend.h"

namespace lcl {

using EngineOptions = std::vector<std::pair<std::string, std::string>>;

struct Approximation {
    RawTriangles raw;
    bool keeps_points = false;         ///< raw.points are those of the cloud
    std::vector<std::uint8_t> is_out;  ///< count of the cloud: 1 for outliers
    std::vector<std::string> warnings;
};

/// progress: fraction, negative where unknown; false stops (Cancelled). BadInput where the engine finds no surface or fails, InvalidArgument for its options,
/// Error for an engine that breaks its contract, OutOfMemory.
Approximation approximate(const lcl_engine& engine, const PointCloud& cloud, const EngineOptions& options, const std::function<bool(double)>& progress);

}  // namespace lcl
