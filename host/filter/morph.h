// SPDX-License-Identifier: BSD-3-Clause
// Morphing by the filter D (mesh expansion paper, eq. 9; math.md section 6).
#pragma once

#include <functional>
#include <vector>

#include "host/apply/host_arrays.h"
#include "host/solve/limit_system.h"

namespace lcl {

enum class MorphPath { recursion, even, linear };  // order of lcl_morph_path

struct MorphOptions {
    Precision precision = Precision::mixed;
    MorphPath path = MorphPath::recursion;
    int frames = 10;               ///< N: frames 0 .. N
    std::vector<int> m{2};         ///< of the step to frame 1, 2, ..; the last is repeated
    std::vector<double> rho{0.5};  ///< likewise
};

/// frame(number, n x channels values, which it may change); false cancels.
using FrameSink = std::function<bool(int, double*)>;

/// One step on the device: difference becomes rho D difference, and frame to + difference. m + 1 passes; enqueued. InvalidArgument as check_morph.
void morph_field(LimitSystem& system, int m, double rho, const Field& target, Field& difference, Field& frame);

/// Frames from `from` to `to`: vertex_count rows of `channels`, stride apart. Frame 0 is `from` itself, and the last of even and linear ones `to`. m + 1 passes
/// a frame. InvalidArgument for options out of range, and for even frames on an operator without a scaling; Cancelled where the sink says so.
void morph_host(LimitSystem& system, const double* from, const double* to, std::size_t stride, int channels, const MorphOptions& options,
                const FrameSink& frame);

}  // namespace lcl
