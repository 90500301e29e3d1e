// SPDX-License-Identifier: BSD-3-Clause
// --scheme, --alpha, --mask, --lambda and --subset as the library takes them.
#pragma once

#include <vector>

#include "host/cli/job.h"

namespace lcl::cli {

/// Scheme options with the arrays that they point to. Moving keeps the arrays where they are; copying would not.
struct SchemeChoice {
    lcl_scheme_options options = LCL_SCHEME_OPTIONS_INIT;
    std::vector<double> lambda;
    std::vector<std::int32_t> subset;

    SchemeChoice() = default;
    SchemeChoice(SchemeChoice&&) = default;
    SchemeChoice(const SchemeChoice&) = delete;
};

/// The scheme of the options, or the one that the faces choose.
lcl_scheme default_scheme(const Options& options, lcl_mesh mesh);

/// Reads the files of the options, and refuses (exit code 3) a scheme that does not fit the mesh before a device is opened.
SchemeChoice choose_scheme(Job& job, lcl_mesh mesh);

/// --alpha auto asks the operator of IN, on a device that is opened where there is none yet: `scheme` then holds the number.
void resolve_alpha(Job& job, Context& context, lcl_mesh mesh, lcl_scheme_options& scheme);

/// The parameters of the report that depend on the scheme.
void note_scheme(Job& job, const lcl_scheme_options& scheme);
/// The same of an operator: alpha is the one that `auto` chose.
void note_scheme_in_use(Job& job, lcl_operator A);

/// "catmull-clark, alpha 0.5, boundary edge-and-corner"
void say_scheme(Job& job);

}  // namespace lcl::cli
