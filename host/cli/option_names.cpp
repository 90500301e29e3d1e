// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/option_names.h"

namespace lcl::cli {

const Names<lcl_scheme> scheme_names = {{"catmull-clark", LCL_SCHEME_CATMULL_CLARK}, {"loop", LCL_SCHEME_LOOP}, {"doo-sabin", LCL_SCHEME_DOO_SABIN}};
const Names<lcl_mask> mask_names = {{"catmull", LCL_MASK_CATMULL}, {"classic", LCL_MASK_CLASSIC}};
const Names<lcl_boundary> boundary_names = {
    {"edge-and-corner", LCL_BOUNDARY_EDGE_AND_CORNER}, {"edge-only", LCL_BOUNDARY_EDGE_ONLY}, {"fixed", LCL_BOUNDARY_FIXED}};
const Names<lcl_precision> precision_names = {{"single", LCL_PRECISION_SINGLE}, {"mixed", LCL_PRECISION_MIXED}, {"double", LCL_PRECISION_DOUBLE}};
const Names<lcl_solver> solver_names = {{"auto", LCL_SOLVER_AUTO},           {"pia", LCL_SOLVER_PIA}, {"wpia", LCL_SOLVER_WPIA},
                                        {"jacobi", LCL_SOLVER_JACOBI},       {"gs", LCL_SOLVER_GS},   {"gs-coloured", LCL_SOLVER_GS_COLOURED},
                                        {"chebyshev", LCL_SOLVER_CHEBYSHEV}, {"cg", LCL_SOLVER_CG}};
const Names<lcl_format> format_names = {{"obj", LCL_FORMAT_OBJ}, {"off", LCL_FORMAT_OFF}, {"ply", LCL_FORMAT_PLY}, {"stl", LCL_FORMAT_STL},
                                        {"om", LCL_FORMAT_OM},   {"xyz", LCL_FORMAT_XYZ}, {"csv", LCL_FORMAT_CSV}, {"pts", LCL_FORMAT_PTS}};
const Names<lcl_fit> fit_names = {{"interpolate", LCL_FIT_INTERPOLATE}, {"least-squares", LCL_FIT_LEAST_SQUARES}};
const Names<lcl_series> series_names = {{"representation", LCL_SERIES_REPRESENTATION}, {"interpolation", LCL_SERIES_INTERPOLATION}};
const Names<lcl_morph_path> path_names = {{"recursion", LCL_MORPH_RECURSION}, {"even", LCL_MORPH_EVEN}, {"linear", LCL_MORPH_LINEAR}};
const Names<bool> operator_names = {{"limit", false}, {"features", true}};

const char* scheme_name(lcl_scheme scheme) { return name_of(scheme_names, scheme); }

const char* mask_name(lcl_mask mask) { return name_of(mask_names, mask); }

const char* boundary_name(lcl_boundary boundary) { return name_of(boundary_names, boundary); }

const char* precision_name(lcl_precision precision) { return name_of(precision_names, precision); }

const char* solver_name(lcl_solver solver) { return name_of(solver_names, solver); }

const char* format_name(lcl_format format) { return name_of(format_names, format); }

const char* fit_name(lcl_fit fit) { return name_of(fit_names, fit); }

const char* series_name(lcl_series series) { return name_of(series_names, series); }

const char* path_name(lcl_morph_path path) { return name_of(path_names, path); }

}  // namespace lcl::cli
