// SPDX-License-Identifier: BSD-3-Clause
// Kinds of irregular patches as kernels/evaluate.cl takes them.
#pragma once

#include <vector>

#include "host/evaluate/patch_kind.h"

namespace lcl {

/// Control points of cell (m, k): P_r = c_0 + sum over j > 0 of cells[(k M + j) R + r] weights[m weight_stride + j] c_j, cells from m cell_stride on, with
/// c = projection C and c_0 the limit of the extraordinary point.
struct KindTable {
    int mode_count = 0;   ///< M
    int point_count = 0;  ///< K
    int depths = 0;       ///< m = 0 .. depths - 1
    int cell_stride = 0, weight_stride = 0;
    std::vector<double> projection;  ///< M x K
    std::vector<double> weights;     ///< (depths + 1) x M where weight_stride is M, those of the dominant modes alone last; else M
    std::vector<double> cells;       ///< (depths x) 3 x M x R
};

/// By the eigenstructure where the kind has one, else by powers of its step.
KindTable make_kind_table(const PatchKind& kind);

}  // namespace lcl
