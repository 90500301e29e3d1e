// SPDX-License-Identifier: BSD-3-Clause
#include "host/scheme/tangent_masks.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "host/scheme/dart_steps.h"
#include "host/scheme/masks.h"

namespace lcl {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A_n of the two-phase paper.
double edge_factor(int n) {
    const double cosine = std::cos(2 * pi / n);
    return 1 + cosine + std::cos(pi / n) * std::sqrt(2 * (9 + cosine));
}

/// factor cos(t (j + phase)), or sin, for j = 0 .. n - 1.
std::vector<double> waves(int n, double factor, double phase, bool sine) {
    std::vector<double> out(n);
    for (int j = 0; j < n; ++j) {
        const double angle = 2 * pi * (j + phase) / n;
        out[j] = factor * (sine ? std::sin(angle) : std::cos(angle));
    }
    return out;
}

/// The mirror image at E_0.
Eigen::VectorXd mirrored(const Eigen::VectorXd& weights, int n) {
    Eigen::VectorXd out = weights;
    for (int j = 0; j < n; ++j) out(1 + j) = weights(1 + (n - j) % n);
    for (Eigen::Index j = 0; j < weights.size() - 1 - n; ++j) out(1 + n + j) = weights(1 + n + (n - 1 - j));
    return out;
}

/// The left eigenvector of the largest eigenvalue below 1 among those that are symmetric to E_0: inverse iteration from just above it, where only antisymmetric
/// ones are nearer, which the mirror image removes. smooth: that of the smooth vertex, which bounds it, or 1/2 does. start: symmetric, its weights sum to 0.
Eigen::VectorXd symmetric_tangent(const Eigen::MatrixXd& subdivision, int n, double smooth, Eigen::VectorXd start) {
    const double shift = std::max(smooth, 0.5) + 1e-3 / (static_cast<double>(n) * n);
    const Eigen::PartialPivLU<Eigen::MatrixXd> solver(subdivision.transpose() - shift * Eigen::MatrixXd::Identity(subdivision.rows(), subdivision.cols()));
    Eigen::VectorXd weights = start.normalized();
    for (int i = 0; i < 100; ++i) {
        Eigen::VectorXd next = solver.solve(weights);
        next = (next + mirrored(next, n)).normalized();
        if (next.dot(weights) < 0) next = -next;
        const double change = (next - weights).norm();
        weights = next;
        if (change < 1e-15) break;
    }
    return weights.dot(start) < 0 ? Eigen::VectorXd(-weights) : weights;
}

TangentMask mask_of(const Eigen::VectorXd& weights, int n) {
    const double* const w = weights.data();
    return {w[0], {w + 1, w + 1 + n}, {w + 1 + n, w + weights.size()}};
}

Eigen::VectorXd vector_of(const TangentMask& mask) {
    Eigen::VectorXd out(1 + mask.edges.size() + mask.faces.size());
    out(0) = mask.vertex;
    std::copy(mask.edges.begin(), mask.edges.end(), out.data() + 1);
    std::copy(mask.faces.begin(), mask.faces.end(), out.data() + 1 + mask.edges.size());
    return out;
}

}  // namespace

TangentMasks catmull_clark_tangents(int n) {
    if (n == 2) return {{{0, {1, -1}, {0, 0}}, {0, {0, 0}, {1, -1}}}};
    // cos(j t) + cos((j+1) t) = 2 cos(t/2) cos((j + 1/2) t)
    const double face = 2 * std::cos(pi / n);
    return {{{0, waves(n, edge_factor(n), 0, false), waves(n, face, 0.5, false)}, {0, waves(n, edge_factor(n), 0, true), waves(n, face, 0.5, true)}}};
}

TangentMasks loop_tangents(int n) {
    if (n == 2) return {{{0, {1, -1}, {}}, {0, {0, 0}, {}}}};
    return {{{0, waves(n, 1, 0, false), {}}, {0, waves(n, 1, 0, true), {}}}};
}

TangentMasks catmull_clark_dart_tangents(int n) {
    const TangentMasks smooth = catmull_clark_tangents(n);
    const double cosine = std::cos(2 * pi / n), eigenvalue = (5 + cosine + std::cos(pi / n) * std::sqrt(18 + 2 * cosine)) / 16;
    return {mask_of(symmetric_tangent(catmull_clark_dart_step(n), n, eigenvalue, vector_of(smooth[0])), n), smooth[1]};
}

TangentMasks loop_dart_tangents(int n) {
    const TangentMasks smooth = loop_tangents(n);
    const double eigenvalue = 3.0 / 8 + std::cos(2 * pi / n) / 4;
    return {mask_of(symmetric_tangent(loop_dart_step(n), n, eigenvalue, vector_of(smooth[0])), n), smooth[1]};
}

// The sine half-wave between the two sharp edges, whose eigenvalue is mu, and what the curve itself (eigenvalues 1 and 1/4 among the symmetric ones) adds to
// it: h = pi/k, S = cot(h/2).
TangentMask catmull_clark_across(int k) {
    const double h = pi / k, cosine = std::cos(h), mu = (5 + cosine + std::cos(h / 2) * std::sqrt(18 + 2 * cosine)) / 16;
    const double S = 1 / std::tan(h / 2), det = (mu - 1) * (mu - 0.25);
    TangentMask mask;
    for (int i = 0; i <= k; ++i) mask.edges.push_back(4 * (4 * mu - 1) * std::sin(i * h));
    for (int i = 0; i < k; ++i) mask.faces.push_back(std::sin(i * h) + std::sin((i + 1) * h));
    mask.edges.front() = mask.edges.back() = ((mu - 0.75) * mu * std::sin(h) + S * (6 * mu - 1) / 8) / det;
    mask.vertex = ((mu - 0.5) * S * (6 * mu - 1) + mu * std::sin(h)) / det;
    return mask;
}

TangentMask loop_across(int k) {
    const double h = pi / k, mu = 3.0 / 8 + std::cos(h) / 4, S = 1 / std::tan(h / 2), det = (mu - 1) * (mu - 0.25);
    TangentMask mask;
    for (int i = 0; i <= k; ++i) mask.edges.push_back(std::sin(i * h));
    mask.edges.front() = mask.edges.back() = ((mu - 0.75) * std::sin(h) / 8 + 3 * S / 64) / det;
    mask.vertex = ((mu - 0.5) * 3 * S / 8 + std::sin(h) / 8) / det;
    return mask;
}

std::vector<double> ring_tangent_weights(const SchemeOptions& options, int n, bool has_diagonals) {
    const double half_turn = std::cos(pi / n);
    std::vector<double> weights;
    const auto add = [&](double factor, double phase) {
        const std::vector<double> cosines = waves(n, factor, phase, false), sines = waves(n, factor, phase, true);
        for (int j = 0; j < n; ++j) weights.insert(weights.end(), {cosines[j], sines[j]});
    };
    add(1, 0);
    if (!has_diagonals) return weights;  // of all schemes: what the other corners of triangles add is another multiple of the same waves
    // Doo-Sabin: sum cos((j + 1/2) t) (w_0 V + w_1 (E_j + E_(j+1)) + w_2 F_j) over the new points of the faces.
    if (options.scheme == Scheme::doo_sabin) add(doo_sabin_weight(options.mask, 4, 2) / (2 * doo_sabin_weight(options.mask, 4, 1) * half_turn), 0.5);
    else add(2 * half_turn / edge_factor(n), 0.5);
    return weights;
}

}  // namespace lcl
