// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/bending.h"

#include <cmath>
#include <memory>
#include <vector>

#include "host/evaluate/modes.h"
#include "host/evaluate/patch_rows.h"

namespace lcl {
namespace {

using Eigen::MatrixXd;
using Lattice = Eigen::Matrix<double, Eigen::Dynamic, 2>;

// Exact for polynomials of degree 15 a variable: regular patches need 6. By characteristic maps integrands are rational: about 1e-10 of the energy is left.
constexpr int gauss_points = 8;
constexpr double same_value = 1e-9;  // of the two modes that make the tangents

struct Node {
    double s, t, weight;
};

/// Nodes and weights on [0, 1] are eigenvalues and eigenvectors of the matrix of the Legendre polynomials' recurrence (Golub & Welsch 1969).
std::vector<Node> quadrature(Scheme scheme) {
    MatrixXd recurrence = MatrixXd::Zero(gauss_points, gauss_points);
    for (int k = 1; k < gauss_points; ++k) recurrence(k, k - 1) = recurrence(k - 1, k) = k / std::sqrt(4.0 * k * k - 1);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(recurrence);
    const Eigen::VectorXd x = (solver.eigenvalues().array() + 1) / 2, weights = solver.eigenvectors().row(0).cwiseAbs2();
    std::vector<Node> nodes;
    for (int i = 0; i < gauss_points; ++i)
        for (int j = 0; j < gauss_points; ++j) {
            const double shrink = scheme == Scheme::loop ? 1 - x[i] : 1;  // the square made a triangle
            nodes.push_back({x[i], shrink * x[j], shrink * weights[i] * weights[j]});
        }
    return nodes;
}

/// Of a regular patch in (x, y).
double patch_area(Scheme scheme) { return scheme == Scheme::loop ? std::sqrt(3.0) / 4 : 1; }

/// Control points of the surface that is (x, y) itself: where they lie on the lattice, up to a translation.
Lattice lattice(Scheme scheme) {
    if (scheme == Scheme::loop) {
        constexpr int places[12][2] = {{0, -1}, {1, -1}, {2, -1}, {-1, 0}, {0, 0}, {1, 0}, {2, 0}, {-1, 1}, {0, 1}, {1, 1}, {-1, 2}, {0, 2}};
        Lattice points(12, 2);
        for (int r = 0; r < 12; ++r) points.row(r) << places[r][0] + places[r][1] / 2.0, std::sqrt(0.75) * places[r][1];
        return points;
    }
    const int size = scheme == Scheme::catmull_clark ? 4 : 3;
    Lattice points(size * size, 2);
    for (int r = 0; r < size * size; ++r) points.row(r) << r % size, r / size;
    return points;
}

struct CellIntegrals {
    double area = 0;
    MatrixXd bending;  ///< of H_xx H_xx + 2 H_xy H_xy + H_yy H_yy for each two functions
};

/// Over a regular patch of the plane, `map` its control points, of functions on it, theirs the columns of `functions`. Hessians H by the chain rule:
/// f_st.. = J^T H J + f_x x_st.. + f_y y_st..
CellIntegrals integrate(Scheme scheme, const Lattice& points, const MatrixXd& functions) {
    const Eigen::Index count = functions.rows();
    CellIntegrals sums{0, MatrixXd::Zero(functions.cols(), functions.cols())};
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> weights(6, count);
    for (const Node& node : quadrature(scheme)) {
        write_regular_rows(scheme, node.s, node.t, 6, weights.data());
        const Eigen::Matrix<double, 6, 2> map = weights * points;
        const MatrixXd jets = weights * functions;
        const Eigen::Matrix2d by = map.middleRows<2>(1).inverse();  // row s: (x_s, y_s); its inverse has rows x: (s_x, t_x)
        const MatrixXd second = jets.bottomRows(3) - map.bottomRows<3>() * (by * jets.middleRows(1, 2));
        Eigen::Matrix3d turn;
        turn << by(0, 0) * by(0, 0), 2 * by(0, 0) * by(0, 1), by(0, 1) * by(0, 1),                //
            by(0, 0) * by(1, 0), by(0, 0) * by(1, 1) + by(0, 1) * by(1, 0), by(0, 1) * by(1, 1),  //
            by(1, 0) * by(1, 0), 2 * by(1, 0) * by(1, 1), by(1, 1) * by(1, 1);
        const MatrixXd hessians = turn * second;
        const double area = node.weight / std::abs(by.determinant());
        sums.area += area;
        sums.bending += hessians.transpose() * Eigen::Vector3d(area, 2 * area, area).asDiagonal() * hessians;
    }
    return sums;
}

/// The sum over m of m^power ratio^m.
double series(double ratio, int power) {
    const double rest = 1 - ratio;
    if (power == 0) return 1 / rest;
    return power == 1 ? ratio / (rest * rest) : ratio * (1 + ratio) / (rest * rest * rest);
}

/// Ring m is ring 0 with (x, y) made value^m times smaller and mode i made values[i]^m m^powers[i] times as large, so its energy is
/// (values[i] values[j] / value^2)^m times that of ring 0. Modes 0 (constant), 1 and 2 (x and y) have none.
MatrixXd characteristic_bending(Scheme scheme, const Modes& modes) {
    const int count = modes.count(), rest = count - 3;
    const double value = modes.values[1];
    double area = 0;
    MatrixXd energy = MatrixXd::Zero(rest, rest);
    for (const MatrixXd& points : modes.cells) {
        const CellIntegrals ring = integrate(scheme, points.middleCols(1, 2), points.rightCols(rest));
        area += ring.area / (1 - value * value);
        energy += ring.bending;
    }
    for (int i = 0; i < rest; ++i)
        for (int j = 0; j < rest; ++j)
            energy(i, j) *= series(modes.values[i + 3] * modes.values[j + 3] / (value * value), modes.powers[i + 3] + modes.powers[j + 3]);
    // Lengths grow by sqrt(A / area), A that of a regular patch: second derivatives squared fall by (area / A)^2, and the mean divides by `area`.
    energy *= area / (patch_area(scheme) * patch_area(scheme));
    const MatrixXd projection = modes.projection.bottomRows(rest);
    return projection.transpose() * energy * projection;
}

MatrixXd outer_ring_bending(Scheme scheme, const PatchKind& kind) {
    const Lattice half = lattice(scheme) / 2;
    MatrixXd energy = MatrixXd::Zero(kind.point_count, kind.point_count);
    for (const MatrixXd& points : kind.cells) energy += integrate(scheme, half, points).bending;
    return energy / (0.75 * patch_area(scheme));
}

}  // namespace

MatrixXd regular_bending(Scheme scheme) {
    const int count = regular_point_count(scheme);
    return integrate(scheme, lattice(scheme), MatrixXd::Identity(count, count)).bending / patch_area(scheme);
}

MatrixXd irregular_bending(Scheme scheme, const PatchKind& kind) {
    const std::shared_ptr<const Modes> modes = modes_of(kind);
    const bool has_tangents = modes && modes->count() > 3 && modes->values[1] - modes->values[2] < same_value && modes->values[2] > modes->values[3];
    return has_tangents ? characteristic_bending(scheme, *modes) : outer_ring_bending(scheme, kind);
}

}  // namespace lcl
