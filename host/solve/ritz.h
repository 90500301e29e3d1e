// SPDX-License-Identifier: BSD-3-Clause
// A short Krylov run on the host, in double: what can be seen of the eigenvalues of rows of which nothing is proven.
#pragma once

#include <complex>
#include <vector>

#include "host/operator/plan.h"

namespace lcl {

/// An eigenvalue of A cut down to a Krylov space.
struct RitzValue {
    std::complex<double> value;
    double error = 0;  ///< the value speaks of A only as far as it lies outside an interval by more than this
};

/// Ritz values after some 30 steps (fewer where that is all there is, or where the vectors would need too much memory) from a start vector that is the same in
/// every run, over the rows that are not fixed. Empty where all are.
///
/// With a scaling (Lanczos in <., .>_D): Ritz values are quotients <x, A x>_D / <x, x>_D, which never lie outside the spectrum; `error` allows for the rounding
/// of the weights alone.
///
/// Without one (Arnoldi): they lie in the field of values of A, which may be much larger than the spectrum. But a Ritz value with vector y and residual
/// r = |A y - theta y| is an eigenvalue of a matrix at a distance of r from A, so an eigenvalue of A lies within about kappa r, kappa = |u| |s| / |u^H s| the
/// condition of theta by its left and right eigenvectors in the Hessenberg matrix (exact to first order; kappa of A itself is not at hand). The weights may
/// have been rounded to floats, and eigenvalues that are defective, which matrices with a real spectrum may have, split into complex ones by kappa times that:
/// error = kappa (10 r + 1e-6 |H|).
std::vector<RitzValue> ritz_values(const Plan& plan);

}  // namespace lcl
