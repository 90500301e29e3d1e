// SPDX-License-Identifier: BSD-3-Clause
#include "host/scheme/masks.h"

#include <Eigen/Dense>
#include <cmath>

#include "host/scheme/dart_steps.h"

namespace lcl {
namespace {

constexpr double pi = 3.14159265358979323846;

RingWeights catmull_clark_ring(double alpha, int n, bool quads) {
    const double corner = quads ? 1.0 : 4.0 / 3.0;  // 4 / face degree
    const double sum = n * (n + 5.0);
    return {(n * (n - 1 + alpha) + n * corner) / sum, (2 - alpha + 2 * corner) / sum, quads ? corner / sum : 0.0};
}

RingWeights doo_sabin_ring(DooSabinMask mask, int n, bool quads) {
    const int m = quads ? 4 : 3;
    return {doo_sabin_weight(mask, m, 0), 2 * doo_sabin_weight(mask, m, 1) / n, quads ? doo_sabin_weight(mask, m, 2) / n : 0.0};
}

double loop_square(int n) {
    const double root = 3.0 / 8 + std::cos(2 * pi / n) / 4;
    return root * root;
}

/// The affine solution of w S = w: the left eigenvector whose entries sum to 1.
std::vector<double> stationary_weights(const Eigen::MatrixXd& subdivision) {
    const Eigen::Index size = subdivision.rows();
    Eigen::MatrixXd system = subdivision.transpose() - Eigen::MatrixXd::Identity(size, size);
    system.row(0).setOnes();  // rows of S sum to 1, so one equation is redundant
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    right(0) = 1;
    const Eigen::VectorXd weights = system.partialPivLu().solve(right);
    return {weights.data(), weights.data() + size};
}

}  // namespace

RingWeights smooth_ring_weights(const SchemeOptions& options, int n, bool has_diagonals) {
    switch (options.scheme) {
        case Scheme::catmull_clark: return catmull_clark_ring(options.alpha, n, has_diagonals);
        case Scheme::loop: return {loop_limit_vertex_weight(n), (1 - loop_limit_vertex_weight(n)) / n, 0.0};
        case Scheme::doo_sabin: return doo_sabin_ring(options.mask, n, has_diagonals);
    }
    return {};
}

double loop_limit_vertex_weight(int n) { return 3 / (11 - 8 * (3.0 / 8 + loop_square(n))); }

double loop_refined_edge_weight(int n) { return (5.0 / 8 - loop_square(n)) / n; }

double doo_sabin_weight(DooSabinMask mask, int m, int j) {
    if (mask == DooSabinMask::classic) return j == 0 ? (m + 5.0) / (4.0 * m) : (3 + 2 * std::cos(2 * pi * j / m)) / (4.0 * m);
    const double rest = 1.0 / (4.0 * m);
    if (j == 0) return 0.5 + rest;
    return j == 1 || j == m - 1 ? 0.125 + rest : rest;
}

RingWeights curve_weights(Scheme scheme) { return scheme == Scheme::doo_sabin ? RingWeights{6.0 / 8, 1.0 / 8, 0} : RingWeights{4.0 / 6, 1.0 / 6, 0}; }

RingWeights blend(const RingWeights& weights, double lambda) {
    return {lambda + (1 - lambda) * weights.vertex, (1 - lambda) * weights.edge, (1 - lambda) * weights.diagonal};
}

double symmetric_scaling(Scheme scheme, int n, double lambda) {
    switch (scheme) {
        case Scheme::catmull_clark: return n * (n + 5.0) / (1 - lambda);
        case Scheme::loop: return n / (1 - loop_limit_vertex_weight(n));
        case Scheme::doo_sabin: return n;
    }
    return 0;
}

double lambda_min_bound(const SchemeOptions& options, int n, double lambda) {
    switch (options.scheme) {
        case Scheme::catmull_clark: return lambda + (1 - lambda) * (n - 3 + 2 * options.alpha) / (n + 5.0);
        case Scheme::loop: return (3 * loop_limit_vertex_weight(n) - 1) / 2;
        case Scheme::doo_sabin: return 0.25;
    }
    return 0;
}

Eigen::MatrixXd catmull_clark_dart_step(int n) {
    const int edges = 1, faces = 1 + n;  // places of E_0 and F_0
    Eigen::MatrixXd step = Eigen::MatrixXd::Zero(2 * n + 1, 2 * n + 1);
    for (int j = 0; j < n; ++j)
        for (const int i : {0, edges + j, edges + (j + 1) % n, faces + j}) step(faces + j, i) += 0.25;
    // The vertex and the edge points use the new face points: V' = ((n - 2) V)/n + (sum E + sum F')/n^2, E' = (V + E + F'_left + F'_right)/4.
    step(0, 0) = (n - 2.0) / n;
    for (int j = 0; j < n; ++j) {
        step(0, edges + j) += 1.0 / (n * n);
        step.row(0) += step.row(faces + j) / (n * n);
        step(edges + j, 0) += 0.25;
        step(edges + j, edges + j) += 0.25;
        step.row(edges + j) += (step.row(faces + j) + step.row(faces + (j + n - 1) % n)) / 4;
    }
    step.row(edges).setZero();
    step(edges, 0) = step(edges, edges) = 0.5;
    return step;
}

Eigen::MatrixXd loop_dart_step(int n) {
    Eigen::MatrixXd step = Eigen::MatrixXd::Zero(n + 1, n + 1);
    const double beta = loop_refined_edge_weight(n);
    step(0, 0) = 1 - n * beta;
    for (int j = 0; j < n; ++j) {
        step(0, 1 + j) += beta;
        step(1 + j, 0) += 3.0 / 8;
        step(1 + j, 1 + j) += 3.0 / 8;
        step(1 + j, 1 + (j + 1) % n) += 1.0 / 8;
        step(1 + j, 1 + (j + n - 1) % n) += 1.0 / 8;
    }
    step.row(1).setZero();
    step(1, 0) = step(1, 1) = 0.5;
    return step;
}

std::vector<double> catmull_clark_dart_weights(int n) { return stationary_weights(catmull_clark_dart_step(n)); }

std::vector<double> loop_dart_weights(int n) { return stationary_weights(loop_dart_step(n)); }

}  // namespace lcl
