// SPDX-License-Identifier: BSD-3-Clause
// The step of a kind has the form [[S, 0], [S11, S12]], inner points first. S commutes with the turn that its orbits describe, so cosines and sines of one
// frequency over the orbits span spaces that it keeps: its eigenvectors come from blocks of one row an orbit, their inverse from the harmonics' orthogonality.
// S12 is small and taken as it is.
#include "host/evaluate/modes.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

namespace lcl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double two_pi = 6.283185307179586;
/// Eigenvalues that differ by less are equal. Of the schemes here, different ones are 1e-4 apart up to valence 1000 or more, equal ones computed to 1e-15.
constexpr double equal_values = 1e-9;

/// a = vectors diag(values) projection, projection the inverse of vectors.
struct Eigenbasis {
    VectorXd values;
    MatrixXd vectors, projection;
};

/// Of a small matrix with real eigenvalues, repeated ones allowed. Nothing where its eigenvectors do not span the space. Columns have the largest element 1.
std::optional<Eigenbasis> small_eigenbasis(const MatrixXd& a) {
    const Eigen::Index n = a.rows();
    Eigenbasis basis{VectorXd(n), MatrixXd(n, n), MatrixXd(n, n)};
    if (n == 0) return basis;
    const Eigen::VectorXcd found = Eigen::EigenSolver<MatrixXd>(a, false).eigenvalues();
    // Real parts: a double value of rounding may look like a pair; the caller's verification speaks the last word.
    VectorXd sorted = found.real();
    std::sort(sorted.data(), sorted.data() + n);
    for (Eigen::Index first = 0, end; first < n; first = end) {
        for (end = first + 1; end < n && sorted[end] - sorted[end - 1] < equal_values;) ++end;
        const double value = sorted.segment(first, end - first).mean();
        Eigen::FullPivLU<MatrixXd> lu(a - value * MatrixXd::Identity(n, n));
        lu.setThreshold(equal_values);
        if (lu.dimensionOfKernel() != end - first) return std::nullopt;
        basis.vectors.middleCols(first, end - first) = lu.kernel();
        basis.values.segment(first, end - first).setConstant(value);
    }
    for (Eigen::Index j = 0; j < n; ++j) {
        Eigen::Index largest;
        basis.vectors.col(j).cwiseAbs().maxCoeff(&largest);
        basis.vectors.col(j) /= double(basis.vectors(largest, j));
    }
    basis.projection = basis.vectors.fullPivLu().inverse();
    return basis;
}

/// The cosines or sines of a frequency on each orbit where they are not all zero: a column an orbit.
MatrixXd harmonics(const std::vector<Orbit>& orbits, Eigen::Index point_count, int frequency, bool sines) {
    MatrixXd columns = MatrixXd::Zero(point_count, static_cast<Eigen::Index>(orbits.size()));
    Eigen::Index count = 0;
    for (const Orbit& orbit : orbits) {
        if (2 * frequency > orbit.size) continue;
        auto column = columns.col(count).segment(orbit.first, orbit.size);
        for (int j = 0; j < orbit.size; ++j) {
            const double turn = std::fmod(frequency * (j + orbit.phase), orbit.size) / orbit.size;  // the angle is reduced before it is rounded
            column[j] = sines ? std::sin(two_pi * turn) : std::cos(two_pi * turn);
        }
        if (column.squaredNorm() > 0.25) ++count;  // their squares sum to size / 2, to size or to nothing
        else column.setZero();
    }
    return columns.leftCols(count);
}

/// What the step does to the coefficients of `columns`: it takes each to multiples of them, which one row of an orbit tells.
MatrixXd block_of(const MatrixXd& step, const MatrixXd& columns) {
    MatrixXd block(columns.cols(), columns.cols());
    for (Eigen::Index j = 0; j < columns.cols(); ++j) {
        Eigen::Index row;
        const double largest = columns.col(j).cwiseAbs().maxCoeff(&row);
        block.row(j) = step.row(row) * columns / (columns(row, j) < 0 ? -largest : largest);
    }
    return block;
}

/// The eigenvectors that are made of `columns`: block is what the step does to their coefficients.
void add_family(const MatrixXd& columns, const Eigenbasis& block, Eigen::Index& count, Eigenbasis& inner) {
    const Eigen::Index size = columns.cols();
    inner.values.segment(count, size) = block.values;
    inner.vectors.middleCols(count, size) = columns * block.vectors;
    const VectorXd squares = columns.colwise().squaredNorm();
    inner.projection.middleRows(count, size) = block.projection * squares.cwiseInverse().asDiagonal() * columns.transpose();
    count += size;
}

std::optional<Eigenbasis> inner_eigenbasis(const MatrixXd& step, const std::vector<Orbit>& orbits) {
    const Eigen::Index n = step.rows();
    Eigenbasis inner{VectorXd(n), MatrixXd(n, n), MatrixXd(n, n)};
    int turns = 1;
    for (const Orbit& orbit : orbits) turns = std::max(turns, orbit.size);
    Eigen::Index count = 0;
    for (int frequency = 0; 2 * frequency <= turns; ++frequency) {
        std::optional<Eigenbasis> block;
        for (const bool sines : {false, true}) {
            const MatrixXd columns = harmonics(orbits, n, frequency, sines);
            const Eigen::Index size = columns.cols();
            if (size == 0) continue;
            // A reflection turns cosines into sines, so both have one block, but where some of them vanish: at half the number of turns.
            if (!sines || 2 * frequency == turns) block = small_eigenbasis(block_of(step, columns));
            if (!block || block->values.size() != size || count + size > n) return std::nullopt;
            add_family(columns, *block, count, inner);
        }
    }
    if (count != n) return std::nullopt;
    return inner;
}

/// The constant comes first and exactly.
void put_constant_first(Eigenbasis& basis) {
    Eigen::Index constant;
    (basis.values.array() - 1).abs().minCoeff(&constant);
    basis.values[constant] = basis.values[0];
    basis.vectors.col(constant).swap(basis.vectors.col(0));
    basis.projection.row(constant).swap(basis.projection.row(0));
    basis.values[0] = 1;
    basis.vectors.col(0).setOnes();
    basis.projection.row(0) /= double(basis.projection.row(0).sum());
}

/// All points' modes; `coupling`(i, j): how much of outer mode i one step adds to inner mode j beside its own multiple, the chains of length two.
struct CoupledBasis {
    Eigenbasis all;
    MatrixXd coupling;
};

CoupledBasis carry_on(const PatchKind& kind, const Eigenbasis& inner, const Eigenbasis& outer) {
    const Eigen::Index n = inner.values.size(), m = outer.values.size(), k = n + m;
    // In the modes of S12 the equations (S12 - value) x_out = -S11 x_in stand alone.
    const MatrixXd pushed = outer.projection * (kind.step.bottomLeftCorner(m, n) * inner.vectors);
    MatrixXd carried = MatrixXd::Zero(m, n);
    CoupledBasis result{{VectorXd(k), MatrixXd::Zero(k, k), MatrixXd::Zero(k, k)}, MatrixXd::Zero(m, n)};
    for (Eigen::Index j = 0; j < n; ++j)
        for (Eigen::Index i = 0; i < m; ++i) {
            const double gap = inner.values[j] - outer.values[i];
            if (std::abs(gap) > equal_values) carried(i, j) = pushed(i, j) / gap;
            else if (std::abs(pushed(i, j)) > equal_values) result.coupling(i, j) = pushed(i, j);
        }
    Eigenbasis& all = result.all;
    all.values << inner.values, outer.values;
    all.vectors.topLeftCorner(n, n) = inner.vectors;
    all.vectors.bottomLeftCorner(m, n) = outer.vectors * carried;
    all.vectors.bottomRightCorner(m, m) = outer.vectors;
    all.vectors.col(0).setOnes();
    all.projection.topLeftCorner(n, n) = inner.projection;
    all.projection.bottomLeftCorner(m, n) = -carried * inner.projection;
    all.projection.bottomRightCorner(m, m) = outer.projection;
    return result;
}

/// step^m of b with step b = value b + a, step a = value a, is value^m b + m value^(m-1) a: a further mode of power 1, a's points and b's projection.
void append_chains(CoupledBasis& basis, std::vector<std::uint8_t>& powers) {
    const Eigen::Index m = basis.coupling.rows(), n = basis.coupling.cols(), k = n + m;
    Eigenbasis& all = basis.all;
    for (Eigen::Index i = 0; i < m; ++i) {
        if (basis.coupling.row(i).isZero(0)) continue;
        const Eigen::Index last = all.values.size();
        all.values.conservativeResize(last + 1);
        all.vectors.conservativeResize(k, last + 1);
        all.projection.conservativeResize(last + 1, k);
        all.values[last] = all.values[n + i];
        all.vectors.col(last) = all.vectors.col(n + i);
        all.projection.row(last) = basis.coupling.row(i) * all.projection.topRows(n) / all.values[n + i];
        powers.push_back(1);
    }
}

Modes sorted_modes(const PatchKind& kind, const Eigenbasis& basis, const std::vector<std::uint8_t>& powers, MatrixXd& vectors) {
    const Eigen::Index count = basis.values.size();
    std::vector<Eigen::Index> order(count);
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::stable_sort(order.begin() + 1, order.end(), [&](Eigen::Index a, Eigen::Index b) { return basis.values[a] > basis.values[b]; });
    Modes modes;
    modes.values.resize(count);
    modes.projection.resize(count, kind.point_count);
    vectors.resize(kind.point_count, count);
    for (Eigen::Index j = 0; j < count; ++j) {
        modes.values[j] = basis.values[order[j]];
        modes.powers.push_back(powers[order[j]]);
        modes.projection.row(j) = basis.projection.row(order[j]);
        vectors.col(j) = basis.vectors.col(order[j]);
    }
    for (int cell = 0; cell < 3; ++cell) {
        modes.cells[cell] = kind.cells[cell] * vectors;
        modes.cells[cell].col(0).setOnes();
    }
    return modes;
}

/// The modes do to a few scattered control points what the powers of the step do.
bool agree_with_powers(const PatchKind& kind, const Modes& modes, const MatrixXd& vectors) {
    constexpr int channels = 4, highest_power = 30;
    constexpr double tolerance = 1e-12;
    MatrixXd points(kind.point_count, channels);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        for (int c = 0; c < channels; ++c) points(i, c) = std::sin(static_cast<double>((i + 1) * (7 * c + 13) * (i + c + 1)));
    const MatrixXd coefficients = modes.projection * points;
    for (int m = 0; m <= highest_power; ++m) {
        VectorXd factors(modes.count());
        for (int j = 0; j < modes.count(); ++j) factors[j] = std::pow(modes.values[j], m) * std::pow(double(m), modes.powers[j]);
        const double error = (vectors * (factors.asDiagonal() * coefficients) - points).cwiseAbs().maxCoeff();
        if (!(error <= tolerance * points.cwiseAbs().maxCoeff())) return false;
        points = kind.step * points;
    }
    return true;
}

bool same_kind(const PatchKind& a, const PatchKind& b) {
    return a.point_count == b.point_count && a.step == b.step && a.orbits.size() == b.orbits.size() && a.cells[0].rows() == b.cells[0].rows() &&
           a.cells == b.cells;
}

}  // namespace

std::optional<Modes> find_modes(const PatchKind& kind) {
    Eigen::Index n = 0;
    for (const Orbit& orbit : kind.orbits) n += orbit.size;
    if (n == 0) return std::nullopt;
    const Eigen::Index m = kind.point_count - n;
    std::optional<Eigenbasis> inner = inner_eigenbasis(kind.step.topLeftCorner(n, n), kind.orbits);
    const std::optional<Eigenbasis> outer = small_eigenbasis(kind.step.bottomRightCorner(m, m));
    if (!inner || !outer) return std::nullopt;
    put_constant_first(*inner);
    CoupledBasis basis = carry_on(kind, *inner, *outer);
    std::vector<std::uint8_t> powers(kind.point_count, 0);
    append_chains(basis, powers);
    MatrixXd vectors;
    Modes modes = sorted_modes(kind, basis.all, powers, vectors);
    if (!agree_with_powers(kind, modes, vectors)) return std::nullopt;
    return modes;
}

std::shared_ptr<const Modes> modes_of(const PatchKind& kind) {
    struct Known {
        PatchKind kind;
        std::shared_ptr<const Modes> modes;
    };
    static std::mutex mutex;
    static std::vector<Known> all_known;
    if (kind.orbits.empty()) return nullptr;
    const std::lock_guard<std::mutex> lock(mutex);
    for (const Known& known : all_known)
        if (same_kind(known.kind, kind)) return known.modes;
    std::optional<Modes> found = find_modes(kind);
    std::shared_ptr<const Modes> modes = found ? std::make_shared<const Modes>(std::move(*found)) : nullptr;
    all_known.push_back({kind, modes});
    return modes;
}

}  // namespace lcl
