// SPDX-License-Identifier: BSD-3-Clause
// The command line as a struct. Only options.cpp sees the parser's library.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <limitcl/limitcl.h>

#include "host/cli/option_values.h"

namespace lcl::cli {

struct Options {
    std::string command;
    std::set<std::string> given;  ///< names of the options that were given: "--alpha"

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
    int sweeps = 0;                              ///< 0: until the tolerance is met
    std::string normals;                         ///< a CSV, "mesh", or empty: none
    std::array<double, 2> handles = {1.0, 1.0};  ///< of convex and other vertices
    std::string handles_file;                    ///< not empty: one a vertex, rules over handles
    bool refined = false;
    double fair = 0.0;  ///< 0: none

    // limit
    bool limit_normals = false;

    // refine
    int levels = 1;
    bool limit = false;
    std::string map_file;

    // expand
    lcl_series series = LCL_SERIES_REPRESENTATION;
    int term = 0, sum = 0;  ///< which of these four rules, `given` tells
    Band band = {1, 3};     ///< sharpen too
    Equaliser equaliser;

    // spectrum
    int terms = 16;

    // denoise
    int m = 2, k = 3;
    bool plain = false;
    double strength = 0.5;  ///< rules over m and k where it is given
    bool keep_volume = false;
    std::string pin_file;
    bool feature_operator = false;

    // sharpen
    int sharpen_steps = 1;

    // morph: `input` is where it starts
    std::string target;
    FramePattern frame_pattern;  ///< of `output`
    int frames = 10;
    std::vector<int> morph_m = {2};
    std::vector<double> rho = {0.5};
    lcl_morph_path path = LCL_MORPH_RECURSION;

    // texture
    int octaves = 4;
    double frequency = 8.0;
    int texture_levels = 0;       ///< as given; 0: octaves - 1
    std::vector<double> colours;  ///< three numbers a colour; empty: the library's
    std::uint32_t seed = 0;
    bool on_mesh = false;

    // evaluate
    std::string places_file;
    int derivatives = 1;

    // closest
    std::string points_file;

    // surface: `input` holds points
    double fit_tolerance = 1e-3;  ///< of the points' distances, relative to the diagonal
    int most_vertices = 0;        ///< 0: as many as the tolerance takes
    lcl_fit fit = LCL_FIT_INTERPOLATE;
    double fit_fair = 1e-3;  ///< least squares
    std::string engine;      ///< empty: the first installed
    std::vector<std::pair<std::string, std::string>> engine_options;
    int fill_holes = 0;  ///< edges of the largest hole, 0: none

    bool has(const char* option) const { return given.count(option) > 0; }
};

/// Fills `options` from the arguments. Returns an exit code where the program is done (help, version), nothing where a command is to be run.
/// Throws Failure with exit code 2 on wrong usage; `options` then holds what was understood (for --color).
std::optional<int> parse_options(int argc, char** argv, Options& options);

}  // namespace lcl::cli
