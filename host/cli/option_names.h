// SPDX-License-Identifier: BSD-3-Clause
// Choices by name, as the command line and the report have them.
#pragma once

#include <utility>
#include <vector>

#include <limitcl/limitcl.h>

namespace lcl::cli {

template <typename Value>
using Names = std::vector<std::pair<const char*, Value>>;

extern const Names<lcl_scheme> scheme_names;
extern const Names<lcl_mask> mask_names;
extern const Names<lcl_boundary> boundary_names;
extern const Names<lcl_precision> precision_names;
extern const Names<lcl_solver> solver_names;
extern const Names<lcl_format> format_names;  ///< of meshes and of points
extern const Names<lcl_fit> fit_names;
extern const Names<lcl_series> series_names;
extern const Names<lcl_morph_path> path_names;
extern const Names<bool> operator_names;  ///< is it the feature-preserving one

template <typename Value>
const char* name_of(const Names<Value>& names, Value value) {
    for (const auto& [name, of] : names) {
        if (of == value) return name;
    }
    return "default";
}

const char* scheme_name(lcl_scheme scheme);
const char* mask_name(lcl_mask mask);
const char* boundary_name(lcl_boundary boundary);
const char* precision_name(lcl_precision precision);
const char* solver_name(lcl_solver solver);
const char* format_name(lcl_format format);
const char* fit_name(lcl_fit fit);
const char* series_name(lcl_series series);
const char* path_name(lcl_morph_path path);

}  // namespace lcl::cli
