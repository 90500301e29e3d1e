// SPDX-License-Identifier: BSD-3-Clause
#include "host/scheme/umbrella_masks.h"

#include "host/scheme/masks.h"
#include "host/scheme/tangent_masks.h"

namespace lcl {
namespace {

/// Limit point: (n^2 V + 4 sum E_j + sum F_j) / (n (n + 5)).
void set_smooth_limit(UmbrellaMask& mask, Index n) {
    const double whole = static_cast<double>(n) * (n + 5);
    mask.weights[0][0] = static_cast<double>(n) * n / whole;
    for (Index j = 0; j < n; ++j) mask.weights[1 + j][0] = 4 / whole, mask.weights[1 + n + j][0] = 1 / whole;
}

void set_tangent(UmbrellaMask& mask, int tangent, const TangentMask& weights) {
    mask.weights[0][tangent] = weights.vertex;
    for (std::size_t j = 0; j < weights.edges.size(); ++j) mask.weights[1 + j][tangent] = weights.edges[j];
    for (std::size_t j = 0; j < weights.faces.size(); ++j) mask.weights[1 + weights.edges.size() + j][tangent] = weights.faces[j];
}

void set_smooth_tangents(UmbrellaMask& mask, Index n) {
    const TangentMasks tangents = catmull_clark_tangents(n);
    set_tangent(mask, 1, tangents[0]);
    set_tangent(mask, 2, tangents[1]);
}

void set_curve_limit(UmbrellaMask& mask, Index first, Index second) {
    mask.weights[0][0] = 4.0 / 6;
    mask.weights[1 + first][0] = mask.weights[1 + second][0] = 1.0 / 6;
}

/// Along the curve E_0 - E_n, and across it.
void set_boundary_tangents(UmbrellaMask& mask, Index n) {
    mask.weights[1][1] = 1, mask.weights[1 + n][1] = -1;
    set_tangent(mask, 2, catmull_clark_across(n));
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
