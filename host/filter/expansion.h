// SPDX-License-Identifier: BSD-3-Clause
// Mesh expansion: polynomials of E - A on values in host memory and on the device, and the energies of the terms.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/apply/host_arrays.h"
#include "host/filter/polynomial.h"
#include "host/solve/limit_system.h"

namespace lcl {

/// (passes done, of all); false cancels.
using PassProgress = std::function<bool(std::int64_t, std::int64_t)>;

/// Centre and scale of p(B) x for x of this one.
Transform transform_after(const Polynomial& p, Transform transform);

/// out = p(B) x; fields of one shape and type that differ. Enqueued; with progress it waits after every chain of passes. Cancelled where progress says so.
void filter_field(LimitSystem& system, const Polynomial& p, const Field& x, Field& out, const PassProgress& progress = {});

/// The same through host memory: vertex_count rows of `channels`, stride apart; out may be x. Vertices with A x = x are multiplied by p(0) in double, so that
/// they keep their bits where that is 1. out is written at the end only. BadInput as fit_transform.
void filter_host(LimitSystem& system, const Polynomial& p, const double* x, std::size_t stride, int channels, Precision precision, double* out,
                 std::size_t out_stride, const PassProgress& progress = {});

/// Energies of the terms 0 .. term_count - 1 of the representation series: term_count x channels, model units squared (math.md section 4). One pass a term.
/// InvalidArgument on operators without a scaling. x: its transform's units.
std::vector<double> term_energies(LimitSystem& system, const Field& x, const Transform& transform, int term_count);

}  // namespace lcl
