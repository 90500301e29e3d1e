// SPDX-License-Identifier: BSD-3-Clause
// The command line as a struct. Only options.cpp sees the parser's library.
#pragma once

#include <optional>
#include <string>

#include <limitcl/limitcl.h>

namespace lcl::cli {

struct Options {
    std::string command;

    // files
    std::string input, output;                 ///< "-": standard streams
    lcl_format format = LCL_FORMAT_BY_ENDING;  ///< of standard streams
    std::string report;                        ///< empty: none; "-": standard output

    // scheme and sharp features
    lcl_scheme scheme = LCL_SCHEME_DEFAULT;  ///< as given, or as --alpha, --lambda, --mask choose it
    double alpha = 0.0;
    bool alpha_auto = false;
    lcl_mask mask = LCL_MASK_CATMULL;
    double lambda = 0.0;
    std::string lambda_file;  ///< not empty: one ratio a vertex, rules over lambda
    lcl_boundary boundary = LCL_BOUNDARY_DEFAULT;
    std::string creases_file, corners_file;
    double crease_angle = 0.0;  ///< degrees, 0: none

    // solving
    lcl_precision precision = LCL_PRECISION_MIXED;
    double tolerance = 1e-6;
    int max_iterations = 200;
    bool keep_going = false;
    std::string channels = "none";
    std::string device;  ///< empty: the library's default

    // text
    bool quiet = false;
    int verbosity = 0;
    bool no_progress = false;
    std::string color = "auto";

    // interpolate
    lcl_solver solver = LCL_SOLVER_AUTO;
    std::string subset_file;
    int sweeps = 0;  ///< 0: until the tolerance is met

    // refine
    int levels = 1;
    bool limit = false;
    std::string map_file;
};

/// Fills `options` from the arguments. Returns an exit code where the program is done (help, version), nothing where a command is to be run.
/// Throws Failure with exit code 2 on wrong usage; `options` then holds what was understood (for --color).
std::optional<int> parse_options(int argc, char** argv, Options& options);

/// Names as the command line has them.
const char* scheme_name(lcl_scheme scheme);
const char* mask_name(lcl_mask mask);
const char* boundary_name(lcl_boundary boundary);
const char* precision_name(lcl_precision precision);
const char* solver_name(lcl_solver solver);

}  // namespace lcl::cli
