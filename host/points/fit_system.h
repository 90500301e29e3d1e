// SPDX-License-Identifier: BSD-3-Clause
// The normal equations of fitting a limit surface to samples at known places, over the control points of the mesh.
#pragma once

#include <array>
#include <vector>

#include "host/evaluate/patch_rows.h"
#include "host/evaluate/patch_table.h"

namespace lcl {

/// Samples p_i with the places x_i at which the surface is to come near to them.
struct FitSamples {
    Places places;
    const double* points = nullptr;   ///< one a place (count x 3), model units
    const double* normals = nullptr;  ///< count x 3, unit, NaN where none counts; null: none
    double along = 1;                 ///< weight of distances along the surface, above 0; those along normals, and all where there is no normal, have 1
    std::array<double, 3> origin{};   ///< taken away from the points: the control points of the equations are those seen from there
};

/// N P = B, the minimum of  1/n sum_i (S(x_i) - p_i)^T M_i (S(x_i) - p_i) + W energy(P),  M_i = along E + (1 - along) n_i n_i^T. With along = 1 that is the
/// least distance of fixed pairs of points, as in Hoppe et al. 1994. Points that may slide along the surface, as closest points do, are met by along = 0: the
/// Gauss-Newton step for the distances themselves, which needs some damping.
/// N has blocks of 3 x 3, is symmetric and positive semidefinite; its blocks are those of vertices that share a patch.
class FitSystem {
public:
    static constexpr int block = 6;  ///< values of a symmetric block: xx, xy, xz, yy, yz, zz

    /// Keeps a reference. Time and memory linear in the mesh (some 10 kB a vertex where it is refined twice: Doo-Sabin, and Catmull-Clark on other faces than
    /// quads; else 5 kB), but that a vertex of valence k takes k^3.
    FitSystem(const PatchTable& table, double fair);

    /// Errors as locate(). Time linear in the samples, memory too: 32 bytes each. The same bits whatever the number of threads.
    void set_samples(const FitSamples& samples);
    /// Conjugate gradients, preconditioned by the inverses of the diagonal blocks, from `control` (point_count x 3) on, until the residual is `tolerance` times
    /// what it was. What N does not see stays as it is: with W = 0 vertices whose part of the surface has no samples; isolated ones always. Returns the number
    /// of iterations.
    int solve(std::vector<double>& control, double tolerance, int most_iterations) const;
    /// The mean over all patches of |S_xx|^2 + 2 |S_xy|^2 + |S_yy|^2 (host/points/bending.h), by parameters in which edges of the mesh have length 1, however
    /// often the table refined them. 0 for W = 0.
    double energy(const std::vector<double>& control) const;

    /// As they stand after set_samples: where the blocks of N's rows stand (columns ascending; no weights), the blocks, and B, point_count x 3.
    const Stencils& pattern() const { return pattern_; }
    const std::vector<double>& normal() const { return normal_; }
    const std::vector<double>& right() const { return right_; }

private:
    class LocalRows;
    struct LocalSystem;

    void find_pattern();
    void set_energy();
    void add_samples(const struct SortedSamples& sorted, const FitSamples& samples, Index patch, LocalRows& local, LocalSystem& out) const;
    template <class Make>
    void add(const std::vector<Index>& patches, const Make& make, std::size_t size, std::vector<double>& values);
    void scatter(const std::vector<LocalSystem>& systems, std::size_t size, std::vector<double>& values);
    std::vector<double> inverse_diagonal() const;
    void multiply(const std::vector<double>& x, std::vector<double>& y) const;

    const PatchTable& table_;
    PatchRows patch_rows_;
    double fair_;
    Stencils rows_;  ///< control points of patches over the mesh's points
    Stencils pattern_;
    std::vector<double> energy_;  ///< one number for each block, empty for W = 0
    std::vector<double> normal_;
    std::vector<double> right_;
};

}  // namespace lcl
