// SPDX-License-Identifier: BSD-3-Clause
// The subdivision schemes and their parameters.
#pragma once

#include <cstdint>
#include <vector>

#include "host/error.h"

namespace lcl {

enum class Scheme : std::uint8_t { catmull_clark, loop, doo_sabin };
enum class DooSabinMask : std::uint8_t {
    catmull,  ///< Doo-Sabin paper, chapter 4: 1/2 + 1/(4m), 1/8 + 1/(4m) for the two neighbours, 1/(4m) for the rest
    classic   ///< Doo & Sabin 1978: (m + 5)/(4m), (3 + 2 cos(2 pi j/m))/(4m)
};

struct SchemeOptions {
    Scheme scheme = Scheme::catmull_clark;
    DooSabinMask mask = DooSabinMask::catmull;
    double alpha = 0;                       ///< Catmull-Clark, 0 to 1: rule of the first refinement (mesh expansion paper)
    double lambda = 0;                      ///< two-phase blend ratio, 0 to 1 (Catmull-Clark only)
    std::vector<double> lambda_per_vertex;  ///< empty, or one ratio a vertex; rules over lambda

    double lambda_at(Index v) const { return lambda_per_vertex.empty() ? lambda : lambda_per_vertex[v]; }
    bool is_two_phase() const { return lambda != 0 || !lambda_per_vertex.empty(); }
};

const char* scheme_name(Scheme scheme);  ///< "catmull-clark", "loop", "doo-sabin"

}  // namespace lcl
