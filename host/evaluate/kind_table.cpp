// SPDX-License-Identifier: BSD-3-Clause
#include "host/evaluate/kind_table.h"

#include <cmath>

#include "host/evaluate/modes.h"

namespace lcl {
namespace {

constexpr int mode_depths = 61;      // parameters down to 2^-61; 4^61, the factor of second derivatives, still is a float
constexpr double same_value = 1e-9;  // of the pair of modes that makes the tangents
constexpr int power_depths = 41;     // each takes memory; beyond 2^-41 the surface is a cone to double precision

void append(const Eigen::MatrixXd& matrix, std::vector<double>& out) {  // columns one after the other
    out.insert(out.end(), matrix.data(), matrix.data() + matrix.size());
}

void set_projection(const Eigen::MatrixXd& projection, KindTable& table) {
    table.mode_count = static_cast<int>(projection.rows());
    table.point_count = static_cast<int>(projection.cols());
    append(projection.transpose(), table.projection);
}

KindTable table_of(const Modes& modes) {
    KindTable table;
    set_projection(modes.projection, table);
    table.depths = mode_depths;
    table.weight_stride = table.mode_count;
    for (int m = 0; m < mode_depths; ++m)
        for (int j = 0; j < modes.count(); ++j) table.weights.push_back(std::pow(modes.values[j], m) * (modes.powers[j] != 0 ? m : 1));
    for (int j = 0; j < modes.count(); ++j) table.weights.push_back(j > 0 && modes.values[1] - modes.values[j] < same_value ? 1 : 0);
    for (const Eigen::MatrixXd& cell : modes.cells) append(cell, table.cells);
    return table;
}

/// The limit point and the control points seen from it as modes, with the powers of the step, which take all that is constant away, in the cells.
KindTable table_of_powers(const PatchKind& kind) {
    const int K = kind.point_count;
    Eigen::MatrixXd limit = kind.step;
    for (int i = 0; i < 8; ++i) limit = (limit * limit).eval();
    const Eigen::RowVectorXd mask = limit.row(0) / limit.row(0).sum();
    Eigen::MatrixXd projection(K + 1, K);
    projection.row(0) = mask;
    projection.bottomRows(K) = Eigen::MatrixXd::Identity(K, K).rowwise() - mask;
    KindTable table;
    set_projection(projection, table);
    table.depths = power_depths;
    table.weights.assign(table.mode_count, 1);
    const Eigen::MatrixXd first_column = Eigen::MatrixXd::Ones(kind.cells[0].rows(), 1);
    Eigen::MatrixXd power = projection.bottomRows(K);
    for (int m = 0; m < power_depths; ++m) {
        for (const Eigen::MatrixXd& cell : kind.cells) {
            append(first_column, table.cells);
            append(cell * power, table.cells);
        }
        power = (kind.step * power).eval();
        power.rowwise() -= (mask * power).eval();  // what rounding added
    }
    table.cell_stride = static_cast<int>(table.cells.size() / power_depths);
    return table;
}

}  // namespace

KindTable make_kind_table(const PatchKind& kind) {
    const std::shared_ptr<const Modes> modes = modes_of(kind);
    return modes ? table_of(*modes) : table_of_powers(kind);
}

}  // namespace lcl
