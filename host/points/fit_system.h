// SPDX-License-Identifier: BSD-3-Clause
// The normal equations of fitting a limit surface to samples at known places, over the control points of the mesh.
#pragma once

#include <array>
#include <vector>

#include "host/evaluate/patch_rows.h"
#include "host/evaluate/patch_table.h"

namespace lcl {

/// N P = B, the minimum of  1/n sum_i |S(x_i) - p_i|^2 + W energy(P):  N = 1/n sum_i r_i^T r_i + W E, B = 1/n sum_i r_i^T p_i, r_i the row that gives S(x_i)
/// from the mesh's points. N is sparse, symmetric and positive semidefinite; its entries are those of vertices that share a patch.
class FitSystem {
public:
    /// Keeps a reference. Time and memory linear in the mesh (some 10 kB a vertex where it is refined twice: Doo-Sabin, and Catmull-Clark on other faces than
    /// quads; else 3 kB), but that a vertex of valence k takes k^3.
    FitSystem(const PatchTable& table, double fair);

    /// points: one a place (count x 3), model units, of which `origin` is taken away: then the control points of the equations are those seen from there.
    /// Errors as locate(). Time linear in the samples, memory too: 32 bytes each. The same bits whatever the number of threads.
    void set_samples(const Places& places, const double* points, const std::array<double, 3>& origin = {0, 0, 0});
    /// Conjugate gradients with Jacobi's preconditioner, from `control` (point_count x 3) on, until the residual is `tolerance` times what it was. What N does
    /// not see stays as it is: with W = 0 vertices whose part of the surface has no samples; isolated ones always. Returns the number of iterations.
    int solve(std::vector<double>& control, double tolerance, int most_iterations) const;
    /// The mean over all patches of |S_xx|^2 + 2 |S_xy|^2 + |S_yy|^2 (host/points/bending.h), by parameters in which edges of the mesh have length 1, however
    /// often the table refined them. 0 for W = 0.
    double energy(const std::vector<double>& control) const;

    /// As they stand after set_samples: rows of N (columns ascending), and B, point_count x 3.
    const Stencils& normal() const { return normal_; }
    const std::vector<double>& right() const { return right_; }

private:
    class LocalRows;
    struct LocalSystem;

    void find_pattern();
    void set_energy();
    template <class Make>
    void add(const std::vector<Index>& patches, const Make& make);
    void scatter(const std::vector<LocalSystem>& systems);
    void multiply(const std::vector<double>& values, const std::vector<double>& x, std::vector<double>& y) const;

    const PatchTable& table_;
    PatchRows patch_rows_;
    double fair_;
    Stencils rows_;               ///< control points of patches over the mesh's points
    Stencils normal_;             ///< N
    std::vector<double> energy_;  ///< weights of E in the places of N's, empty for W = 0
    std::vector<double> right_;
};

}  // namespace lcl
