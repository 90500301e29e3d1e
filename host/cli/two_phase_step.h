// SPDX-License-Identifier: BSD-3-Clause
// --normals, --handles, --refined, --fair and --map of interpolate: the refined control mesh M^1 of the two-phase scheme.
#pragma once

#include <string>
#include <vector>

#include "host/cli/failure.h"
#include "host/cli/scheme_choice.h"

namespace lcl::cli {

/// Options of the library with the arrays that they point to. Moving keeps the arrays where they are; copying would not.
struct TwoPhaseChoice {
    lcl_two_phase_options options = LCL_TWO_PHASE_OPTIONS_INIT;
    std::vector<double> normals, handles;
    std::vector<const char*> channels;

    TwoPhaseChoice() = default;
    TwoPhaseChoice(TwoPhaseChoice&&) = default;
    TwoPhaseChoice& operator=(TwoPhaseChoice&&) = default;
    TwoPhaseChoice(const TwoPhaseChoice&) = delete;
};

/// Reads the files of the options. `channels` has to outlive the result. Exit code 3 where a line is wrong, names a vertex outside the subset, or IN has no
/// normals.
TwoPhaseChoice choose_two_phase(Job& job, lcl_mesh mesh, const SchemeChoice& scheme, const std::vector<std::string>& channels);

/// A failure of lcl_two_phase_mesh: what is wrong with a file is named with the file.
Failure two_phase_failure(const Job& job, lcl_status status);

/// Report, summary and warnings.
void note_two_phase(Job& job, const lcl_two_phase_report& findings);
void say_two_phase(Job& job, lcl_mesh refined);

/// The CSV of --map.
void write_vertex_map(Job& job, lcl_mesh refined);

}  // namespace lcl::cli
