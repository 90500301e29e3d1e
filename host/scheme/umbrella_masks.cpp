// SPDX-License-Identifier: BSD-3-Clause
#include "host/scheme/umbrella_masks.h"

#include <cmath>

#include "host/scheme/masks.h"

namespace lcl {
namespace {

constexpr double pi = 3.14159265358979323846;

/// cos and sin of 2 pi j / n.
double cosine(Index j, Index n) { return std::cos(2 * pi * (j % n) / n); }
double sine(Index j, Index n) { return 2 * (j % n) % n == 0 ? 0 : std::sin(2 * pi * (j % n) / n); }

/// Limit point: (n^2 V + 4 sum E_j + sum F_j) / (n (n + 5)).
void set_smooth_limit(UmbrellaMask& mask, Index n) {
    const double whole = static_cast<double>(n) * (n + 5);
    mask.weights[0][0] = static_cast<double>(n) * n / whole;
    for (Index j = 0; j < n; ++j) mask.weights[1 + j][0] = 4 / whole, mask.weights[1 + n + j][0] = 1 / whole;
}

/// A_n cos(j t) on edges, cos(j t) + cos((j + 1) t) on faces, t = 2 pi / n; the second tangent with sines.
void set_smooth_tangents(UmbrellaMask& mask, Index n) {
    const double t = 2 * pi / n, a = 1 + std::cos(t) + std::cos(t / 2) * std::sqrt(2 * (9 + std::cos(t)));
    for (Index j = 0; j < n; ++j) {
        std::array<double, 3>&edge = mask.weights[1 + j], &face = mask.weights[1 + n + j];
        edge[1] = a * cosine(j, n), edge[2] = a * sine(j, n);
        face[1] = cosine(j, n) + cosine(j + 1, n), face[2] = sine(j, n) + sine(j + 1, n);
    }
}

void set_curve_limit(UmbrellaMask& mask, Index first, Index second) {
    mask.weights[0][0] = 4.0 / 6;
    mask.weights[1 + first][0] = mask.weights[1 + second][0] = 1.0 / 6;
}

/// The tangent along the curve is E_0 - E_n; that across it the left eigenvector of the umbrella's subdivision matrix for the eigenvalue mu, h = pi/n.
void set_boundary_tangents(UmbrellaMask& mask, Index n) {
    const double h = pi / n, mu = (5 + std::cos(h) + std::cos(h / 2) * std::sqrt(18 + 2 * std::cos(h))) / 16;
    const double s = std::cos(h / 2) / std::sin(h / 2), det = (mu - 1) * (mu - 0.25);
    mask.weights[1][1] = 1, mask.weights[1 + n][1] = -1;
    mask.weights[0][2] = ((mu - 0.5) * s * (6 * mu - 1) + mu * std::sin(h)) / det;
    mask.weights[1][2] = mask.weights[1 + n][2] = ((mu - 0.75) * mu * std::sin(h) + s * (6 * mu - 1) / 8) / det;
    for (Index j = 1; j < n; ++j) mask.weights[1 + j][2] = 4 * (4 * mu - 1) * std::sin(j * h);
    for (Index j = 0; j < n; ++j) mask.weights[2 + n + j][2] = std::sin(j * h) + std::sin((j + 1) * h);
}

double gram(const UmbrellaMask& mask, int a, int b) {
    double sum = 0;
    for (const std::array<double, 3>& weights : mask.weights) sum += weights[a] * weights[b];
    return sum;
}

void invert_gram(UmbrellaMask& mask) {
    const double aa = gram(mask, 0, 0);
    mask.inverse_square = 1 / aa;
    if (!mask.has_tangents) return;
    const double ab = gram(mask, 0, 1), ac = gram(mask, 0, 2), bb = gram(mask, 1, 1), bc = gram(mask, 1, 2), cc = gram(mask, 2, 2);
    const double from_bc = bb * cc - bc * bc, from_ab = ac * bc - ab * cc, from_ac = ab * bc - ac * bb;
    const double determinant = aa * from_bc + ab * from_ab + ac * from_ac;
    mask.inverse_gram = {from_bc, from_ab, from_ac, aa * cc - ac * ac, ab * ac - aa * bc, aa * bb - ab * ab};
    for (double& element : mask.inverse_gram) element /= determinant;
}

}  // namespace

UmbrellaMask umbrella_mask(UmbrellaKind kind, Index n, Index second) {
    UmbrellaMask mask;
    const Index edges = kind == UmbrellaKind::boundary ? n + 1 : n;
    mask.weights.assign(1 + static_cast<std::size_t>(edges) + n, {});
    switch (kind) {
        case UmbrellaKind::smooth:
            set_smooth_limit(mask, n);
            mask.has_tangents = n >= 3;
            if (mask.has_tangents) set_smooth_tangents(mask, n);
            break;
        case UmbrellaKind::boundary:
            set_curve_limit(mask, 0, n);
            mask.has_tangents = n >= 2 && n <= 4;
            if (mask.has_tangents) set_boundary_tangents(mask, n);
            break;
        case UmbrellaKind::crease: set_curve_limit(mask, 0, second); break;
        case UmbrellaKind::dart: {
            const std::vector<double> weights = catmull_clark_dart_weights(static_cast<int>(n));
            for (std::size_t k = 0; k < weights.size(); ++k) mask.weights[k][0] = weights[k];
            break;
        }
        case UmbrellaKind::fixed: mask.weights[0][0] = 1; break;
    }
    invert_gram(mask);
    return mask;
}

}  // namespace lcl
