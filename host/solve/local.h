// SPDX-License-Identifier: BSD-3-Clause
// Updating a solution after an edit of few vertices. Entries of A^-1 decay exponentially with the distance (on regular meshes by 0.27 a ring, in general by at
// most (sqrt k - 1)/(sqrt k + 1), k = 1/lambda_min), so only the surroundings of the edit change by more than the tolerance.
#pragma once

#include "host/apply/row_transfer.h"
#include "host/solve/local_region.h"
#include "host/solve/solve.h"

namespace lcl {

/// New rows of M.
struct LocalEdit {
    std::vector<Index> rows;     ///< the plan's, each once
    std::vector<double> values;  ///< rows x channels, normalised
};

/// Over-relaxed Gauss-Seidel on the host, on the values that the fields hold, and only on rows whose residual is above the tolerance; where none was before,
/// none is afterwards, however often it is called: residuals are computed in double for the fields as they are (floats, if they hold floats), and the other
/// rows read nothing that has changed. Work, transfers and memory follow the rows it changes; 4 bytes a vertex are kept from the first call on.
class LocalSolver {
public:
    explicit LocalSolver(LimitSystem& system) : system_(system), region_(system.plan()), transfer_(system.A->shared_context()) {}

    /// Writes the rows into M and updates P, which solved A P = M before. M, P: single or full, of one shape and transform. The full solve, started from P,
    /// takes over on operators that are singular or indefinite and on rows without a scaling, where more than a sixteenth of the rows would have to be looked
    /// at, and where this iteration is slow. Until then both fields are as before, also if it throws. max_error: over all rows whose residual can have changed.
    /// Unsupported on operators with ghosts.
    SolveReport solve(const LocalEdit& edit, const Transform& transform, const SolveOptions& options, Field& M, Field& P);

private:
    static constexpr int width = 4;  // values that are worked on together
    bool start(const LocalEdit& edit, Field& M, Field& P);
    int first_rings() const;
    bool open_rings(int rings);
    bool open_rows(const std::vector<Index>& locals);
    bool is_too_large(std::size_t rows) const;
    void look_at_reached();
    void fetch();
    void settle_fixed_rows();
    bool relax(Monitor& monitor, bool is_automatic);
    void sweep();
    bool relax_row(Index local);
    void measure();
    void compute_residual(Index local);
    bool is_large(Index local) const;
    void queue_if_large(Index local);
    void subtract(double weight, const double* x, double* r) const;
    ResidualNorms largest(const std::vector<Index>& locals) const;
    double held(double value) const { return is_single_ ? static_cast<float>(value) : value; }  // what a field gives back of it
    bool is_fixed(Index local) const { return region_.rows()[local] < system_.plan().fixed.end_row(); }
    std::size_t at(Index local) const { return static_cast<std::size_t>(local) * stride_; }
    void write_back(const LocalEdit& edit, bool with_points, Field& M, Field& P);
    SolveReport conclude(const Monitor& monitor, double unit);
    std::string reason(int iterations) const;

    LimitSystem& system_;
    LocalRegion region_;
    RowTransfer transfer_;

    // Of one call; kept for their memory.
    Field* M_ = nullptr;
    Field* P_ = nullptr;
    int channels_ = 0, stride_ = 0;
    bool is_single_ = false, is_stuck_ = false;
    Target target_;
    double weight_ = 1;
    std::vector<double> m_, p_, r_;  // by local number, stride_ values each; r_: residuals times the region's scaling
    std::vector<double> change_, transferred_;
    std::vector<std::uint8_t> is_changed_, is_queued_;
    std::vector<Index> queue_, current_, closed_, list_m_, list_p_;
    std::size_t fetched_rows_ = 0, fetched_reached_ = 0, work_ = 0;
    double seconds_read_ = 0;
};

}  // namespace lcl
