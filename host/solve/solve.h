// SPDX-License-Identifier: BSD-3-Clause
// Solving A P = M: choice of the iteration, precision, certificate.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/apply/host_arrays.h"
#include "host/solve/limit_system.h"
#include "host/solve/monitor.h"

namespace lcl {

enum class Solver { automatic, pia, wpia, jacobi, gauss_seidel, gauss_seidel_coloured, chebyshev, conjugate_gradients };  // order of lcl_solver

struct SolveOptions {
    Solver solver = Solver::automatic;
    Precision precision = Precision::mixed;
    double tolerance = 1e-6;  ///< of E_k relative to diagonal; of further channels relative to their range
    int max_iterations = 200;
    int exact_sweeps = 0;                               ///< > 0: so many iterations, no test
    double weight = 0;                                  ///< W-PIA; 0: the best
    bool keep_going = false;                            ///< iterate although singular or indefinite
    bool certify = false;                               ///< fill surface_error_bound
    double diagonal = 0;                                ///< model units; 0: the mesh's, without one that of the box of M
    std::function<bool(int, double, double)> progress;  ///< (iteration, residual, target), model units; false cancels
};

enum class SolveStatus { converged, not_converged, singular, indefinite };

struct SolveReport {
    SolveStatus status = SolveStatus::not_converged;
    Solver solver = Solver::automatic;
    int iterations = 0;
    std::vector<double> residuals;   ///< E_0 .. E_iterations, model units
    double lambda_min = 0;           ///< NaN if none
    double max_error = 0;            ///< model units
    double channel_error = 0;        ///< further channels, relative to their ranges
    double surface_error_bound = 0;  ///< model units, NaN if none
    std::string message;
    std::vector<Index> vertices;
    double seconds_upload = 0, seconds_solve = 0, seconds_download = 0;
    Index changed_rows = 0;  ///< of P, by a local solve
};

/// What the tolerance refers to, model units. unit: 1 in the fields, the diagonal of the box of M.
double model_size(const LimitSystem& system, const SolveOptions& options, double unit);

/// InvalidArgument for a solver that needs a symmetric form which the operator does not have.
void require_symmetric_form(const LimitSystem& system, Solver solver);

/// P with A P = M through host memory. M: vertex_count rows of `channels`, stride apart. P: P_0 where warm_start, else written only; P may be M.
/// In P fixed and isolated rows hold M's values to the bit, warm start or not. Unsupported on operators with ghosts.
SolveReport solve_host(LimitSystem& system, const double* M, std::size_t stride, int channels, const SolveOptions& options, bool warm_start, double* P,
                       std::size_t P_stride);

/// The same on fields of one transform that stay on the device; P holds P_0 where warm_start. max_error is that of the values that P then
/// holds, computed on the device in double (or pairs of floats).
SolveReport solve_fields(LimitSystem& system, const Field& M, const Transform& transform, const SolveOptions& options, bool warm_start, Field& P);

}  // namespace lcl
