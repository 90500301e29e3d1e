// SPDX-License-Identifier: BSD-3-Clause
// The iterations for A x = m on a device, each until the monitor stops it. Residual r_k = m - A x_k; x_0 is what x holds.
#pragma once

#include <algorithm>
#include <vector>

#include "host/apply/device_operator.h"
#include "host/solve/monitor.h"

namespace lcl {

/// x += w r (PIA: w = 1, mesh expansion paper; W-PIA: Loop PIA paper) or x_i += r_i / A_ii (jacobi; two-phase paper, eq. 6). One pass an iteration.
void iterate_stationary(DeviceOperator& A, const Part& part, double weight, bool jacobi, const Field& m, Field& x, Monitor& monitor);

/// GS-PIA over a schedule (Loop PIA paper, eq. 7). Two passes an iteration: the second measures the residual.
void iterate_gauss_seidel(DeviceOperator& A, const Schedule& schedule, const Field& m, Field& x, Monitor& monitor);

/// The sweeps of the Chebyshev semi-iteration for a spectrum in [low, 1], three-term form. Eigenvalues between 0 and low converge too, only slower.
class ChebyshevSweeps {
public:
    explicit ChebyshevSweeps(double low) : theta_((1 + low) / 2), delta_(std::max((1 - low) / 2, 1e-12)) {}
    Sweep next();
    /// Sweeps after which no residual of the spectrum is larger than `gain` times the first; very many where gain is not above 0.
    int count_for(double gain) const;
    /// What one more sweep gains in the long run.
    double rate() const;

private:
    double theta_, delta_, rho_ = 0;
};

/// Chebyshev, as many sweeps in one go as its rate asks for from the residual `start` of x to the stage's target; one pass a sweep. Outcome::converged says
/// that the target should be met: the caller makes sure. y: another field of x's shape, overwritten.
void iterate_chebyshev(DeviceOperator& A, const Part& part, double low, const ResidualNorms& start, const Field& m, Field& x, Field& y, Monitor& monitor);

/// Coefficients of conjugate gradients, an entry an iteration, a value a channel: what a Lanczos estimate of the spectrum is made of.
struct LanczosCoefficients {
    std::vector<ChannelValues> alpha, beta;
};

/// Conjugate gradients in <., .>_D on a part that is self-adjoint under D; every channel by itself. Rows outside the part keep x. Outcome::indefinite where <p,
/// A p>_D <= 0 (with coefficients asked for it goes on, as Lanczos may). One pass an iteration, and some three passes' traffic beside it.
void iterate_conjugate_gradients(DeviceOperator& A, const Part& part, const Field& m, Field& x, Monitor& monitor, LanczosCoefficients* coefficients = nullptr);

/// Smallest eigenvalue of the Lanczos matrices that the first `steps` steps make, over all channels.
double smallest_ritz_value(const LanczosCoefficients& coefficients, int steps);

}  // namespace lcl
