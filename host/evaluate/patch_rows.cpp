// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/patch_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernels/patches.cl.h"

namespace lcl {
namespace {

constexpr int most_points = 16;                                                                          // of a regular patch
constexpr int orders[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};                           // of the derivatives by s and t
constexpr int monomial_count = 15, box_points = 12, box_spline[monomial_count * 16] = {LCL_BOX_SPLINE};  // rows of 16, four of them padding

/// Weights of the points of an interval of a uniform B-spline, and their first two derivatives.
using Basis = std::array<std::array<double, 4>, 3>;

Basis quadratic_basis(double t) {
    const double r = 1 - t;
    return {{{r * r / 2, 0.5 + t * r, t * t / 2, 0}, {-r, r - t, t, 0}, {1, -2, 1, 0}}};
}

Basis cubic_basis(double t) {
    const double r = 1 - t;
    return {{{r * r * r / 6, (4 - 3 * t * t * (1 + r)) / 6, (4 - 3 * r * r * (1 + t)) / 6, t * t * t / 6},
             {-r * r / 2, t * (3 * t - 4) / 2, r * (4 - 3 * r) / 2, t * t / 2},
             {r, 3 * t - 2, 3 * r - 2, t}}};
}

void write_products(const Basis& by_s, const Basis& by_t, int size, int count, double* rows) {
    for (int q = 0; q < count; ++q)
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) *rows++ = by_s[orders[q][0]][i] * by_t[orders[q][1]][j];
}

/// 1, s, t, s^2, st, t^2, .. of degree 4 at most and, by `order`, their derivatives.
std::array<double, monomial_count> monomials(double s, double t, const int (&order)[2]) {
    // d^k x^n = n (n - 1) .. x^(n - k)
    const auto powers = [](double x, int k) {
        const double x2 = x * x;
        if (k == 0) return std::array<double, 5>{1, x, x2, x2 * x, x2 * x2};
        if (k == 1) return std::array<double, 5>{0, 1, 2 * x, 3 * x2, 4 * x2 * x};
        return std::array<double, 5>{0, 0, 2, 6 * x, 12 * x2};
    };
    const std::array<double, 5> by_s = powers(s, order[0]), by_t = powers(t, order[1]);
    std::array<double, monomial_count> values;
    int q = 0;
    for (int degree = 0; degree <= 4; ++degree)
        for (int j = 0; j <= degree; ++j) values[q++] = by_s[degree - j] * by_t[j];
    return values;
}

void write_box_rows(double s, double t, int count, double* rows) {
    for (int q = 0; q < count; ++q, rows += box_points) {
        const std::array<double, monomial_count> values = monomials(s, t, orders[q]);
        std::fill_n(rows, box_points, 0.0);
        for (int m = 0; m < monomial_count; ++m)
            for (int r = 0; r < box_points; ++r) rows[r] += box_spline[16 * m + r] * values[m];
        for (int r = 0; r < box_points; ++r) rows[r] /= 12;
    }
}

/// Derivatives by (u, v) in place of those by (s, t).
void turn(const ParameterTurn& by, int count, int points, double* rows) {
    const double su = by.su, tu = by.tu, sv = by.sv, tv = by.tv;
    double *const s = rows + points, *const t = s + points;
    for (int i = 0; count >= 3 && i < points; ++i) {
        const double at_s = s[i], at_t = t[i];
        s[i] = su * at_s + tu * at_t;
        t[i] = sv * at_s + tv * at_t;
    }
    double *const ss = t + points, *const st = ss + points, *const tt = st + points;
    for (int i = 0; count == 6 && i < points; ++i) {
        const double at_ss = ss[i], at_st = st[i], at_tt = tt[i];
        ss[i] = su * su * at_ss + 2 * su * tu * at_st + tu * tu * at_tt;
        st[i] = su * sv * at_ss + (su * tv + tu * sv) * at_st + tu * tv * at_tt;
        tt[i] = sv * sv * at_ss + 2 * sv * tv * at_st + tv * tv * at_tt;
    }
}

/// The cell of an irregular patch in which a place other than (0, 0) lies.
struct Cell {
    int depth, k;
    double s, t;
    double scale;  ///< of first derivatives by the cell's parameters to those by the patch's
};

Cell find_cell(Scheme scheme, const PatchPlace& place) {
    const double size = scheme == Scheme::loop ? place.s + place.t : std::max(place.s, place.t);
    const int depth = std::max(0, -std::ilogb(size) - 1);
    const double scale = std::ldexp(1.0, depth + 1), s = scale * place.s, t = scale * place.t;
    if (s >= 1 && scheme != Scheme::loop && t >= 1) return {depth, 1, s - 1, t - 1, scale};
    if (s >= 1) return {depth, 0, s - 1, t, scale};
    if (t >= 1) return {depth, 2, s, t - 1, scale};
    return {depth, 1, 1 - s, 1 - t, -scale};
}

}  // namespace

void write_regular_rows(Scheme scheme, double s, double t, int count, double* rows) {
    switch (scheme) {
        case Scheme::catmull_clark: return write_products(cubic_basis(s), cubic_basis(t), 4, count, rows);
        case Scheme::loop: return write_box_rows(s, t, count, rows);
        case Scheme::doo_sabin: return write_products(quadratic_basis(s), quadratic_basis(t), 3, count, rows);
    }
}

PatchRows::PatchRows(const PatchTable& table) : table_(table) {
    for (const PatchKind& kind : table.kinds) kinds_.push_back(make_kind_table(kind));
}

void PatchRows::write(const PatchPlace& place, int count, double* rows) const {
    const std::int32_t kind = table_.kind[place.patch];
    if (kind < 0) write_regular_rows(table_.scheme, place.s, place.t, count, rows);
    else write_irregular(kinds_[kind], place, count, rows);
    turn(table_.turns[place.turn], count, point_count(place.patch), rows);
}

/// The cell's weights, on its control points as combinations of modes, as KindTable has them.
void PatchRows::write_irregular(const KindTable& kind, const PatchPlace& place, int count, double* rows) const {
    const int R = regular_point_count(table_.scheme), K = kind.point_count, M = kind.mode_count;
    std::copy_n(kind.projection.begin(), K, rows);
    const bool is_tip = place.s == 0 && place.t == 0;
    std::fill(rows + K, rows + count * K, is_tip ? std::numeric_limits<double>::quiet_NaN() : 0.0);
    if (is_tip) return;
    Cell cell = find_cell(table_.scheme, place);
    // Beyond the table the surface is a cone as far as one can tell.
    const int excess = std::max(0, cell.depth - (kind.depths - 1)), depth = cell.depth - excess;
    cell.scale = std::ldexp(cell.scale, -excess);
    double weights[6 * most_points];
    write_regular_rows(table_.scheme, cell.s, cell.t, count, weights);
    const double* const modes = kind.cells.data() + static_cast<std::size_t>(depth) * kind.cell_stride + static_cast<std::size_t>(cell.k) * M * R;
    const double* const factors = kind.weights.data() + static_cast<std::size_t>(depth) * kind.weight_stride;
    for (int q = 0; q < count; ++q, rows += K) {
        const int order = orders[q][0] + orders[q][1];
        const double factor = order == 0 ? std::ldexp(1.0, -excess) : std::pow(cell.scale, order);
        for (int j = 1; j < M; ++j) {
            double sum = 0;
            for (int r = 0; r < R; ++r) sum += weights[q * R + r] * modes[j * R + r];
            sum *= factor * factors[j];
            const double* const projection = &kind.projection[static_cast<std::size_t>(j) * K];
            for (int i = 0; i < K; ++i) rows[i] += sum * projection[i];
        }
    }
}

}  // namespace lcl
