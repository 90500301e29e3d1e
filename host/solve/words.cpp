// SPDX-License-Identifier: BSD-3-Clause
#include "host/solve/words.h"

namespace lcl {

const char* operator_name(const LimitSystem& system) { return system.origin == Origin::scheme ? "the limit operator" : "the operator"; }

const char* cure(const LimitSystem& system) {
    if (system.origin == Origin::rows) return "use t E + (1 - t) A for a t above 0, which has no eigenvalue below t";
    if (system.origin == Origin::features) return "use a larger diagonal factor";
    return system.scheme.scheme == Scheme::catmull_clark ? "use a larger alpha (0.5; alpha auto does so) or a lambda above 0"
                                                         : "use another scheme, or remove vertices of valence 2";
}

std::string why_not_symmetric(const LimitSystem& system) {
    const Plan& plan = system.plan();
    if (!plan.has_scaling) return "and these rows came without a scaling D that makes D A symmetric";
    return "and with darts (creases that end inside the surface, such as at vertex " + std::to_string(plan.vertex_of_row[plan.darts.first_row]) +
           ") there is none";
}

}  // namespace lcl
