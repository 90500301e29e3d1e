// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/patches.cl.h"

namespace lcl {
namespace {

constexpr int tip_depth = 200;  // limit tangents are read from this ring: what is left of other modes is below rounding
constexpr int box_spline[15 * 16] = {LCL_BOX_SPLINE};
constexpr int monomials[15][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}, {4, 0}, {3, 1}, {2, 2}, {1, 3}, {0, 4}};
constexpr int orders[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};  // of the derivatives by s and t in a jet

/// The uniform B-spline of a degree that begins at 0, at x, by the recursion of de Boor and Cox; `derivatives` times derived.
double b_spline(int degree, int derivatives, double x) {
    if (derivatives > 0) return b_spline(degree - 1, derivatives - 1, x) - b_spline(degree - 1, derivatives - 1, x - 1);
    if (degree == 0) return x >= 0 && x < 1 ? 1 : 0;
    return (x * b_spline(degree - 1, 0, x) + (degree + 1 - x) * b_spline(degree - 1, 0, x - 1)) / degree;
}

/// Weight of point i = 0 .. degree of an interval at t in [0, 1].
double spline_weight(int degree, int derivatives, int i, double t) {
    // At t = 1 the pieces of degree 0 belong to the next interval: the mirrored spline has the same values, and derivatives of changed sign.
    if (t > 0.5) return (derivatives == 1 ? -1 : 1) * spline_weight(degree, derivatives, degree - i, 1 - t);
    return b_spline(degree, derivatives, t + degree - i);
}

/// The derivative of x^n.
double power(int n, int derivatives, double x) {
    double factor = 1;
    for (; derivatives > 0; --derivatives) factor *= n--;
    return factor == 0 ? 0 : factor * std::pow(x, n);
}

double box_weight(const int (&order)[2], int r, double s, double t) {
    double sum = 0;
    for (int q = 0; q < 15; ++q) sum += box_spline[16 * q + r] * power(monomials[q][0], order[0], s) * power(monomials[q][1], order[1], t);
    return sum / 12;
}

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Jet by (s, t) of a regular patch.
Eigen::Matrix<double, 6, 3> regular_jet(Scheme scheme, const Points& control, double s, double t) {
    const std::vector<double> weights = regular_weights(scheme, s, t);
    return Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>>(weights.data(), 6, control.rows()) * control;
}

/// The limit mask of a kind's extraordinary point: the row to which the powers of its step tend.
Eigen::RowVectorXd limit_mask(const PatchKind& kind) {
    Eigen::MatrixXd powers = kind.step;
    for (int i = 0; i < 8; ++i) powers = (powers * powers).eval();
    return powers.row(0) / powers.row(0).sum();
}

/// Control points after `depth` steps of points whose limit is the origin; what rounding adds to the limit is taken away again.
Points subdivided(const PatchKind& kind, const Eigen::RowVectorXd& limit, Points points, int depth) {
    for (; depth > 0; --depth) {
        points = (kind.step * points).eval();
        points.rowwise() -= (limit * points).eval();
    }
    return points;
}

Eigen::Matrix<double, 6, 3> irregular_jet(Scheme scheme, const PatchKind& kind, const Points& control, double s, double t) {
    const Eigen::RowVectorXd limit = limit_mask(kind);
    const Eigen::RowVector3d tip = limit * control;
    const Points centred = control.rowwise() - tip;
    const double size = scheme == Scheme::loop ? s + t : std::max(s, t);
    Eigen::Matrix<double, 6, 3> jet;
    if (size == 0) {
        const Points deepest = subdivided(kind, limit, centred, tip_depth);
        jet.setConstant(std::numeric_limits<double>::quiet_NaN());
        jet.row(0) = tip;
        jet.row(1) = regular_jet(scheme, kind.cells[0] * deepest, 0, 0).row(1).normalized();
        jet.row(2) = regular_jet(scheme, kind.cells[2] * deepest, 0, 0).row(2).normalized();
        return jet;
    }
    const int depth = std::max(0, -std::ilogb(size) - 1);
    double scale = std::ldexp(1.0, depth + 1), x = scale * s, y = scale * t;
    int cell = 0;
    if (x >= 1) {
        cell = scheme != Scheme::loop && y >= 1 ? 1 : 0;
        x -= 1;
        y -= cell;
    } else if (y >= 1) {
        cell = 2;
        y -= 1;
    } else {
        cell = 1;
        x = 1 - x, y = 1 - y, scale = -scale;
    }
    jet = regular_jet(scheme, kind.cells[cell] * subdivided(kind, limit, centred, depth), x, y);
    for (int q = 0; q < 6; ++q) jet.row(q) *= std::pow(scale, orders[q][0] + orders[q][1]);
    jet.row(0) += tip;
    return jet;
}

/// From derivatives by (s, t) to those by (u, v).
Eigen::Matrix<double, 6, 3> turned(const ParameterTurn& turn, const Eigen::Matrix<double, 6, 3>& jet) {
    const double su = turn.su, tu = turn.tu, sv = turn.sv, tv = turn.tv;
    Eigen::Matrix<double, 6, 6> by;
    by << 1, 0, 0, 0, 0, 0,                            //
        0, su, tu, 0, 0, 0,                            //
        0, sv, tv, 0, 0, 0,                            //
        0, 0, 0, su * su, 2 * su * tu, tu * tu,        //
        0, 0, 0, su * sv, su * tv + tu * sv, tu * tv,  //
        0, 0, 0, sv * sv, 2 * sv * tv, tv * tv;
    Eigen::Matrix<double, 6, 3> out;
    for (int q = 0; q < 6; ++q) {  // not one product: NaN times 0 is NaN
        out.row(q).setZero();
        for (int p = 0; p < 6; ++p)
            if (by(q, p) != 0) out.row(q) += by(q, p) * jet.row(p);
    }
    return out;
}

}  // namespace

std::vector<double> regular_weights(Scheme scheme, double s, double t) {
    const int count = regular_point_count(scheme), degree = scheme == Scheme::catmull_clark ? 3 : 2;
    std::vector<double> weights;
    for (const auto& order : orders)
        for (int r = 0; r < count; ++r)
            weights.push_back(scheme == Scheme::loop
                                  ? box_weight(order, r, s, t)
                                  : spline_weight(degree, order[0], r % (degree + 1), s) * spline_weight(degree, order[1], r / (degree + 1), t));
    return weights;
}

SurfaceJet reference_jet(const PatchTable& table, const std::vector<double>& control, const PatchPlace& place) {
    const Index begin = table.patch_begin[place.patch], end = table.patch_begin[place.patch + 1];
    Points points(end - begin, 3);
    for (Index i = begin; i < end; ++i) points.row(i - begin) = Eigen::Map<const Eigen::RowVector3d>(&control[3 * static_cast<std::size_t>(table.control[i])]);
    const std::int32_t kind = table.kind[place.patch];
    const Eigen::Matrix<double, 6, 3> jet =
        turned(table.turns[place.turn],
               kind < 0 ? regular_jet(table.scheme, points, place.s, place.t) : irregular_jet(table.scheme, table.kinds[kind], points, place.s, place.t));
    SurfaceJet out;
    const bool is_tip = kind >= 0 && place.s == 0 && place.t == 0;
    for (int q = 0; q < 6; ++q) {
        const double length = is_tip && (q == 1 || q == 2) ? jet.row(q).norm() : 1;
        for (int c = 0; c < 3; ++c) out[q][c] = jet(q, c) / length;
    }
    return out;
}

}  // namespace lcl
